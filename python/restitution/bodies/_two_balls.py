"""A parameter that the two spheres of a body share, or that each has its own of."""

from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError, ValidationInfo

from restitution._internal.parameters import Allowed, Number, ParameterError, wrong

_POSITIVE = "a finite number > 0"
_ALLOWED = f"{_POSITIVE} (or one for each sphere)"
_number = TypeAdapter(Annotated[Number, Field(gt=0)])


def _positive(value: Any) -> float | None:
    try:
        return _number.validate_python(value)
    except ValidationError:
        return None


def one_or_two(name: str, value: Any, allowed: str) -> float | tuple[float, float]:
    """Take a positive number, or two."""
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


def _checked(value: Any, info: ValidationInfo) -> float | tuple[float, float]:
    return one_or_two(str(info.field_name), value, _ALLOWED)


PositivePair = Annotated[float | tuple[float, float], Allowed(_ALLOWED), BeforeValidator(_checked)]
"""One positive number for both spheres, or a pair: that of sphere 1 and that of sphere 2."""


def both(value: float | tuple[float, float]) -> tuple[float, float]:
    """Return one value for each sphere."""
    return value if isinstance(value, tuple) else (value, value)
