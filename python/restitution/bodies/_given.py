"""Parameters of several bodies of revolution: a wall, moments of inertia, numbers of one sphere or two."""

from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError, ValidationInfo

from restitution._internal.parameters import Allowed, Number, ParameterError, wrong

_POSITIVE = "a finite number > 0"
_EACH = f"{_POSITIVE} (or one for each sphere)"
_MOMENTS = "(transverse, axial), each > 0 in kg m², or one number for both, or None"
_number = TypeAdapter(Annotated[Number, Field(gt=0)])


def _positive(value: Any) -> float | None:
    try:
        return _number.validate_python(value)
    except ValidationError:
        return None


def _one_or_two(allowed: str, *, or_none: bool = False) -> BeforeValidator:
    """Take a positive number, or two."""

    def checked(value: Any, about: ValidationInfo) -> float | tuple[float, float] | None:
        if value is None and or_none:
            return None
        name = str(about.field_name)
        if isinstance(value, np.ndarray) and value.shape == (2,):
            value = value.tolist()
        if not (isinstance(value, list | tuple) and len(value) == 2):
            number = _positive(value)
            if number is None:
                raise ParameterError(wrong(name, value, allowed))
            return number
        numbers = [_positive(part) for part in value]
        problems = [
            wrong(f"{name}[{index}]", part, _POSITIVE)
            for index, (part, number) in enumerate(zip(value, numbers, strict=True))
            if number is None
        ]
        if problems:
            raise ParameterError(*problems)
        one, two = (number for number in numbers if number is not None)
        return one, two

    return BeforeValidator(checked)


PositivePair = Annotated[float | tuple[float, float], Allowed(_EACH), _one_or_two(_EACH)]
"""One positive number for both spheres, or a pair: that of sphere 1 and that of sphere 2."""
Moments = Annotated[
    float | tuple[float, float] | None,
    Allowed(_MOMENTS),
    _one_or_two(_MOMENTS, or_none=True),
    Field(description="kg m²"),
]
"""Moments of inertia across and about the axis; None for those of the matter."""
Wall = Annotated[Number | None, Field(gt=0, description="m"), Allowed("a finite number > 0 (m), or None")]
"""Thickness of the wall of a hollow body; None of a full one."""
