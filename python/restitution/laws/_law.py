"""What all laws have in common: the normal coefficient, and how a law is written down."""

from typing import Annotated, Any

from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError

from restitution._parameters import Allowed, Number, ParameterError, Parameters, wrong
from restitution.laws._materials import Material, Plastic, Tabulated, Viscoelastic

_NORMAL = "a real number in [0, 1] or a Viscoelastic, Plastic or Tabulated"
_number = TypeAdapter(Annotated[Number, Field(ge=0, le=1)])


def _normal(value: Any) -> Any:
    if isinstance(value, Material):
        return value
    try:
        return _number.validate_python(value)
    except ValidationError:
        raise ParameterError(wrong("normal", value, _NORMAL)) from None


NormalCoefficient = Annotated[
    float | Viscoelastic | Plastic | Tabulated, BeforeValidator(_normal), Allowed(_NORMAL)
]
"""ε^n: a number, or a function of the speed."""

Friction = Annotated[Number, Field(ge=0, le=1e100)]
"""μ; the bound keeps products of it finite, and nothing slips long before."""


class Law(Parameters):
    """A collision law: what an impact does.

    Parameters
    ----------
    normal : float, Viscoelastic, Plastic or Tabulated
        Normal coefficient of restitution ε^n, in [0, 1], or a material that gives it for the normal speed at
        which the contact point approaches the plane.
    """

    normal: NormalCoefficient

    @property
    def constant(self) -> float:
        """ε^n where it is a number.

        Raises
        ------
        ValueError
            If it depends on the speed.
        """
        if isinstance(self.normal, Material):
            raise ParameterError(wrong("normal", self.normal, "a number, the same at every speed"))
        return self.normal

    def parameters(self) -> dict[str, Any]:
        """Name every parameter as the core does."""
        return {"type": type(self).__name__, **self.model_dump()}

    def attributes(self) -> dict[str, Any]:
        """Every parameter under its own name, those of a material after `normal_`, as plain values."""
        material = self.normal
        if not isinstance(material, Material):
            return self.model_dump()
        parts = {f"normal_{name}": value for name, value in material.model_dump().items()}
        return self.model_dump() | {"normal": type(material).__name__} | parts
