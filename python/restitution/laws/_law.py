"""The base of every law: the normal coefficient, and how a law is written down."""

from abc import abstractmethod
from functools import cached_property
from typing import Annotated, Any, Self

from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError, model_validator

from restitution import _core
from restitution._internal.parameters import Allowed, Number, ParameterError, Parameters, wrong
from restitution.laws._materials import Material, Plastic, Tabulated, Viscoelastic, tabulated

NORMAL = "a real number in [0, 1], a Viscoelastic, Plastic or Tabulated, or a function of the speed"
_number = TypeAdapter(Annotated[Number, Field(ge=0, le=1)])


def _normal(value: Any) -> Any:
    if isinstance(value, Material):
        return value
    if callable(value) and not isinstance(value, type):
        return tabulated("normal", value)
    try:
        return _number.validate_python(value)
    except ValidationError:
        raise ParameterError(wrong("normal", value, NORMAL)) from None


NormalCoefficient = Annotated[
    float | Viscoelastic | Plastic | Tabulated, BeforeValidator(_normal), Allowed(NORMAL)
]
"""ε_n: a number, or a function of the speed."""

Friction = Annotated[Number, Field(ge=0, le=_core.MOST_FRICTION)]
"""μ; the bound keeps products of it finite, and nothing slips long before."""


class Law(Parameters):
    """A collision law: the impulse as a function of the contact velocity.

    Parameters
    ----------
    normal : float, Viscoelastic, Plastic, Tabulated or callable
        Normal coefficient of restitution ε_n, in [0, 1], or a material that gives it for the normal speed at
        which the contact point approaches the plane. A function of one speed in m/s becomes
        `Tabulated.from_function` of it, to 1e-6 up to 100 m/s.
    """

    normal: NormalCoefficient

    @abstractmethod
    def _compile(self, normal: float | _core.Material) -> _core.Law:
        """Make the law as the core knows it, with the normal coefficient as the core knows that."""

    @cached_property
    def compiled(self) -> _core.Law:
        """The law as the core knows it, made and checked once."""
        return self._compile(self.normal.compiled if isinstance(self.normal, Material) else self.normal)

    @model_validator(mode="after")
    def _is_possible(self) -> Self:
        _ = self.compiled
        return self

    @property
    def constant(self) -> float:
        """ε_n where it is a number.

        Raises
        ------
        ValueError
            If it depends on the speed.
        """
        if isinstance(self.normal, Material):
            raise ParameterError(wrong("normal", self.normal, "a number, the same at every speed"))
        return self.normal

    def attributes(self) -> dict[str, Any]:
        """Return every parameter under its own name, those of a material after `normal_`, as plain values."""
        material = self.normal
        if not isinstance(material, Material):
            return self.model_dump()
        parts = {f"normal_{name}": value for name, value in material.model_dump().items()}
        return self.model_dump() | {"normal": type(material).__name__} | parts
