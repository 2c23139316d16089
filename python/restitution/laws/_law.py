"""The base of every law: the normal coefficient, and how a law is written down."""

from abc import abstractmethod
from functools import cached_property
from typing import Annotated, Any

from pydantic import Field

from restitution import _core
from restitution._internal.described import Described
from restitution._internal.parameters import Number, ParameterError, Parameters, wrong
from restitution.laws._materials import Material, NormalCoefficient, Scattered

Friction = Annotated[Number, Field(ge=0, le=_core.MOST_FRICTION)]
"""μ; the bound keeps products of it finite, and nothing slips long before."""


class CollisionLaw(Parameters):
    """A collision law, of the package or of one's own."""

    @property
    @abstractmethod
    def compiled(self) -> _core.Law:
        """The law as the core knows it."""

    @abstractmethod
    def attributes(self) -> dict[str, Any]:
        """Return what a result says of the law besides its kind, as plain values."""


class Law(Described, CollisionLaw):
    """A collision law of the package: the impulse as a function of the contact velocity.

    Parameters
    ----------
    normal : float, material or callable
        Normal coefficient of restitution ε_n, in [0, 1], or a material that gives it for the normal speed at
        which the contact point approaches the plane. A function of one speed in m/s becomes
        `Tabulated.from_function` of it, to 1e-6 up to 100 m/s.
    """

    normal: NormalCoefficient

    @cached_property
    def compiled(self) -> _core.Law:
        """The law as the core knows it, made and checked once."""
        normal = self.normal.compiled if isinstance(self.normal, Material) else self.normal
        return _core.law(type(self).__name__, normal, self._arguments())

    @property
    def constant(self) -> float:
        """ε_n where it is a number.

        Raises
        ------
        ValueError
            If it depends on the speed, or scatters.
        """
        if isinstance(self.normal, Material):
            raise ParameterError(wrong("normal", self.normal, "a number, the same at every impact"))
        return self.normal

    def attributes(self) -> dict[str, Any]:
        """Return every parameter under its own name, those of a material after `normal_`, as plain values."""
        normal = self.normal
        return self.model_dump() | (normal.attributes() if isinstance(normal, Material) else {})


def check_steady(law: Law) -> None:
    """Refuse a law whose coefficient scatters, where that has no meaning or is what is sought."""
    if isinstance(law.normal, Scattered):
        raise ParameterError(wrong("law.normal", law.normal, "a coefficient that does not scatter"))
