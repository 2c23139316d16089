"""Length and width as callipers give them, checked."""

from typing import Annotated

from pydantic import Field

from restitution._internal.parameters import Number, Parameters


class LengthWidth(Parameters):
    """Length along the symmetry axis and width across it, in m."""

    length: Annotated[Number, Field(gt=0, description="m")]
    width: Annotated[Number, Field(gt=0, description="m")]
