"""The wall of a hollow body, and moments of inertia that are given instead of those of its matter."""

from typing import Annotated, Any

from pydantic import BeforeValidator, Field, ValidationInfo

from restitution._internal.parameters import Allowed, Number
from restitution.bodies._two_balls import one_or_two

_MOMENTS = "(transverse, axial), each > 0 in kg m², or one number for both, or None"


def _checked(value: Any, info: ValidationInfo) -> float | tuple[float, float] | None:
    return None if value is None else one_or_two(str(info.field_name), value, _MOMENTS)


Wall = Annotated[Number | None, Field(gt=0, description="m"), Allowed("a finite number > 0 (m), or None")]
"""Thickness of the wall of a hollow body; None of a full one."""
Moments = Annotated[
    float | tuple[float, float] | None,
    Allowed(_MOMENTS),
    BeforeValidator(_checked),
    Field(description="kg m²"),
]
"""Moments of inertia across and about the axis; None for those of the matter."""
