"""The base of every shape: mass, inertia, and the compiled body."""

from abc import abstractmethod
from collections.abc import Iterator
from functools import cached_property
from typing import Self

from pydantic import model_validator

from restitution import _core
from restitution._internal import text as _text
from restitution._internal.parameters import ParameterError, Parameters, Problem, shown


class Body(Parameters):
    """A homogeneous or loaded body of revolution, in SI units.

    Its symmetry axis makes the angle θ with the plane normal. A shape says how the core makes it; mass and
    inertia follow.
    """

    @abstractmethod
    def _compile(self) -> _core.Solid:
        """Make the body as the core knows it."""

    @cached_property
    def solid(self) -> _core.Solid:
        """The body as the core knows it, made and checked once."""
        return self._compile()

    @model_validator(mode="after")
    def _is_possible(self) -> Self:
        try:
            _ = self.solid
        except _core.MagnitudeError as error:
            first, *others = type(self).model_fields
            given = "".join(f", {name} = {shown(getattr(self, name))}" for name in others)
            text = f" = {shown(getattr(self, first))}{given}: must be {error.allowed}"
            raise ParameterError(Problem(first, text)) from None
        return self

    def _rows(self) -> Iterator[tuple[str, str]]:
        yield from super()._rows()
        yield "mass", _text.value(self.mass, "kg")
        yield "transverse_inertia", _text.value(self.transverse_inertia, "kg m²")
        yield "axial_inertia", _text.value(self.axial_inertia, "kg m²")

    @property
    def mass(self) -> float:
        """Mass m in kg."""
        return self.solid.mass

    @property
    def transverse_inertia(self) -> float:
        """Moment of inertia J_xx across the symmetry axis, through the centre of mass, in kg m²."""
        return self.solid.transverse_inertia

    @property
    def axial_inertia(self) -> float:
        """Moment of inertia J_zz about the symmetry axis, in kg m²."""
        return self.solid.axial_inertia
