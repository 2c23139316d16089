"""Numbers from outside, checked in one place: real, unmasked, without units; the error names the argument."""

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from operator import index, lt
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt

from restitution._internal.parameters import (
    ParameterError,
    Problem,
    TooLargeError,
    plain_number,
    shown,
    wrong,
)

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

FARTHEST = 1e100  # of any edge, so that widths and centres are finite
T = TypeVar("T")

_QUANTITY = ("to_value", "dimensionality")  # of astropy, unyt and pint, whose units NumPy drops silently


def reals(
    name: str,
    value: Any,
    allowed: str,
    *,
    unit: str | None = "1",
    dimensions: Collection[int] | None = None,
    finite: bool = True,
) -> FloatArray:
    """Take an array of real numbers as doubles, without a copy where it is one already.

    Booleans, complex numbers, dates, strings, objects, masked values and quantities with units are refused,
    inside lists too; NaN and infinities where they are to be `finite`. `unit` is what the numbers are in, for
    `check_units` (None: any), `dimensions` how many dimensions there may be.
    """
    try:
        reason = next(filter(None, map(_stray, _parts(value))), "")
        for part in _parts(value) if unit is not None and not reason else ():
            check_units(name, part, unit or "")
        found = np.asarray(value)
        good = not reason and found.dtype.kind in "iuf" and (dimensions is None or found.ndim in dimensions)
        with np.errstate(over="ignore"):  # of extended precision, to infinity
            numbers = np.asarray(found, dtype=np.float64, order="C") if good else np.empty(0)
    except ParameterError:
        raise
    except MemoryError as error:
        allowed = "as many numbers as this process has the memory for"
        raise TooLargeError(wrong(name, value, allowed)) from error
    except Exception:  # lists of different lengths, or any error of the object itself
        good, reason, numbers = False, "", np.empty(0)
    if not good:
        raise ParameterError(wrong(name, value, f"{allowed}; it {reason}" if reason else allowed))
    if finite:
        check_each(name, numbers, np.isfinite(numbers), allowed)
    return numbers


def _parts(value: Any) -> Iterator[Any]:
    """Yield a value and the elements in it, if it is a list of anything but plain numbers."""
    yield value
    if isinstance(value, list | tuple) and not set(map(type, value)) <= {float, int}:
        for part in value:
            yield from _parts(part)


def _stray(value: Any) -> str:
    """Name a kind of value that NumPy would silently convert to a number, or drop."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        return "holds masked values"
    if isinstance(value, bool) or getattr(getattr(value, "dtype", None), "kind", "") == "b":
        return "holds True or False"
    if isinstance(value, bytes | bytearray):
        return "holds bytes"
    return "has units of its own" if any(hasattr(value, name) for name in _QUANTITY) else ""


def real(
    name: str, value: Any, allowed: str, good: Callable[[float], bool] = math.isfinite, *, unit: str = "1"
) -> float:
    """Take one number, in this unit, for which `good` holds."""
    number = float(reals(name, value, allowed, unit=unit, dimensions=(0,), finite=False))
    if not good(number):
        raise ParameterError(wrong(name, value, allowed))
    return number


def positive(name: str, value: Any, unit: str) -> float:
    """Take a finite number > 0 in this unit."""
    return real(name, value, f"a finite number > 0, in {unit}", lambda x: 0.0 < x < math.inf, unit=unit)


def pair(
    name: str, value: Any, allowed: str, good: Callable[[float, float], bool] = lt, *, unit: str | None = "1"
) -> tuple[float, float]:
    """Take two numbers, in this unit, for which `good` holds: unless given, the first is the lower one."""
    ends = reals(name, value, allowed, unit=unit, dimensions=(1,), finite=False)
    if ends.shape != (2,) or not good(*ends.tolist()):
        raise ParameterError(wrong(name, value, allowed))
    return float(ends[0]), float(ends[1])


def whole(name: str, value: Any, least: int, most: int | None = None) -> int:
    """Take a whole number in [least, most]."""
    allowed = f"a whole number >= {least}" if most is None else f"a whole number in [{least}, {most}]"
    check_units(name, value, "1")
    plain = plain_number(value)
    try:
        number = index(plain)
    except Exception:  # any error of the object
        raise ParameterError(wrong(name, value, allowed)) from None
    stray = isinstance(plain, bool) or np.ma.is_masked(plain)
    if stray or number < least or (most is not None and number > most):
        raise ParameterError(wrong(name, value, allowed))
    return number


def shape(name: str, value: Any) -> tuple[int, ...]:
    """Take the shape of an array: a whole number, or a tuple of them."""
    try:
        return tuple(whole(name, one, 0) for one in (value if isinstance(value, Iterable) else (value,)))
    except (ParameterError, TypeError):  # TypeError: of an array without dimensions
        raise ParameterError(wrong(name, value, "a whole number >= 0 or a tuple of them")) from None


def several(name: str, value: Any, allowed: str, take: Callable[[int, Any], T]) -> list[T]:
    """Take the elements of an iterable with their numbers, up to a wrong one, which is an error."""
    try:
        return [take(number, one) for number, one in enumerate(value)]
    except (ParameterError, MemoryError):  # of one of them, or of what makes them
        raise
    except Exception as error:  # any error of the object
        raise ParameterError(wrong(name, value, allowed)) from error


def function(name: str, value: Any) -> Callable[[float], float]:
    """Check a function of one number; an error that it raises, or a value that is no number, names it."""
    if not callable(value):
        raise ParameterError(wrong(name, value, "a function of one number"))

    def at(x: float) -> float:
        try:
            return float(value(x))
        except Exception as error:
            text = f" gave {type(error).__name__}: {error} at {x!r}: must give a number"
            raise ParameterError(Problem(name, text)) from error

    return at


def flag(name: str, value: Any) -> bool:
    """Take True or False."""
    if not isinstance(value, bool | np.bool_):
        raise ParameterError(wrong(name, value, "True or False"))
    return bool(value)


def word(name: str, value: Any, words: Collection[str]) -> str:
    """Take one of several words."""
    if not isinstance(value, str) or value not in words:
        raise ParameterError(wrong(name, value, either(words)))
    return str(value)


def either(words: Collection[str]) -> str:
    """Name words that are allowed."""
    return " or ".join(map(repr, words))


def generator(name: str, seed: Any) -> np.random.Generator:
    """Take a seed, or the generator itself."""
    try:
        return seed if isinstance(seed, np.random.Generator) else np.random.default_rng(whole(name, seed, 0))
    except ParameterError:
        allowed = "a whole number >= 0 or a numpy.random.Generator"
        raise ParameterError(wrong(name, seed, allowed)) from None


def check_each(name: str, array: FloatArray, good: npt.NDArray[np.bool_], allowed: str) -> None:
    """Name the first element that is not good."""
    if not good.all():
        at = tuple(int(i) for i in np.argwhere(~good)[0])
        place = f"[{', '.join(map(str, at))}]" if at else ""
        raise ParameterError(wrong(f"{name}{place}", float(array[at]), allowed))


_NAMES = {
    **dict.fromkeys(("meter", "meters", "metre", "metres"), "m"),
    **dict.fromkeys(("sec", "second", "seconds"), "s"),
    **dict.fromkeys(("radian", "radians"), "rad"),
    "hertz": "Hz",
    "dimensionless": "1",
}


def _spelt(units: str) -> str:
    """Spell units as the CF conventions do: m s-1 for m/s, m·s⁻¹, m s**-1 and metre / second."""
    plain = re.sub(r"\s*/\s*(\w+)", r" \1-1", re.sub(r"\^|\*\*", "", units.replace("⁻¹", "-1")))
    words = re.sub(r"[^\W\d]+", lambda word: _NAMES.get(word[0], word[0]), plain)
    return " ".join(re.sub(r"[·.*]", " ", words).split()).replace("1 s-1", "s-1") or "1"


def check_units(name: str, value: Any, unit: str) -> None:
    """Refuse what says in an attribute ``units``, as arrays of xarray can, that it is in others.

    `unit` is written as by the CF conventions. What says nothing is taken to be in it.
    """
    attributes = getattr(value, "attrs", None)
    said = attributes.get("units") if isinstance(attributes, Mapping) else None
    alike = {unit, "s-1"} if unit in ("rad s-1", "Hz") else {unit}
    if said is not None and _spelt(str(said)) not in alike:
        text = f" has units {shown(said)}: must be in {unit}; drop_attrs() removes units that xarray copied"
        raise ParameterError(Problem(name, text))
