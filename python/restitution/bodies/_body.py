"""What every shape has."""

from abc import abstractmethod
from typing import Self

from pydantic import model_validator

from restitution import _core
from restitution._parameters import ParameterError, Parameters, Problem, shown


class Body(Parameters):
    """A homogeneous or loaded body of revolution, in SI units.

    Its symmetry axis makes the angle θ with the plane normal. A shape says how the core makes it; mass and
    inertia follow.
    """

    @property
    @abstractmethod
    def solid(self) -> _core.Solid:
        """The body as the core knows it."""

    @model_validator(mode="after")
    def _is_possible(self) -> Self:
        try:
            _ = self.solid
        except ValueError as error:
            _, _, allowed = str(error).partition(": ")
            if "overflow" not in allowed:
                raise
            first, *others = type(self).model_fields
            given = "".join(f", {name} = {shown(getattr(self, name))}" for name in others)
            text = f" = {shown(getattr(self, first))}{given}: {allowed}"
            raise ParameterError(Problem(first, text)) from None
        return self

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
