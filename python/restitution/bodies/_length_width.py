"""Length and width as callipers give them, checked."""

from typing import Annotated

from pydantic import Field

from restitution._internal.parameters import Number, ParameterError, Parameters, wrong


class LengthWidth(Parameters):
    """Length along the symmetry axis and width across it, in m."""

    length: Annotated[Number, Field(gt=0, description="m")]
    width: Annotated[Number, Field(gt=0, description="m")]

    def elongated(self) -> "LengthWidth":
        """Return these sizes, or raise `ValueError` if the length is below the width."""
        if self.length < self.width:
            raise ParameterError(wrong("length", self.length, f">= width = {self.width!r} (m)"))
        return self
