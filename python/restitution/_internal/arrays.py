"""Numbers from outside, checked in one place: real, unmasked, without units; the error names the argument."""

import math
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from operator import index
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

FARTHEST = 1e100
"""Of any edge, so that widths and centres are finite."""
T = TypeVar("T")

_MOST_COUNTED = 2.0**53
"""Beyond it doubles do not count."""
_QUANTITY = ("to_value", "dimensionality")
"""Attributes that identify the quantities of astropy, unyt and pint, whose units NumPy drops silently."""


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

    Parameters
    ----------
    name : str
        Of the argument, for the error.
    value : Any
        A number, an array, or anything that NumPy makes real numbers of. Booleans, complex numbers, dates,
        strings, objects, masked values and quantities with units are refused, inside lists too.
    allowed : str
        What is allowed, in words.
    unit : str, optional
        What the numbers are in, for `check_units`; None where that does not matter.
    dimensions : collection of int, optional
        Numbers of dimensions that are allowed.
    finite : bool
        Whether NaN and infinities are refused.

    Raises
    ------
    ParameterError
        Naming the argument, or the first element of it, that is wrong.
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
    except Exception:  # lists of different lengths, or whatever the object itself raises
        good, reason, numbers = False, "", np.empty(0)
    if not good:
        raise ParameterError(wrong(name, value, f"{allowed}; it {reason}" if reason else allowed))
    if finite:
        check_each(name, numbers, np.isfinite(numbers), allowed)
    return numbers


def _parts(value: Any) -> Iterator[Any]:
    """Yield a value and what is in it, if it is a list of anything but plain numbers."""
    yield value
    if isinstance(value, list | tuple) and not set(map(type, value)) <= {float, int}:
        for part in value:
            yield from _parts(part)


def _stray(value: Any) -> str:
    """Say what NumPy would silently convert to a number, or drop."""
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


def whole(name: str, value: Any, least: int, most: int | None = None) -> int:
    """Take a whole number in [least, most]."""
    allowed = f"a whole number >= {least}" if most is None else f"a whole number in [{least}, {most}]"
    check_units(name, value, "1")
    plain = plain_number(value)
    try:
        number = index(plain)
    except Exception:  # whatever the object raises
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


def check_shapes(**arrays: np.ndarray) -> None:
    """Refuse arrays whose shapes do not broadcast, naming them all."""
    try:
        np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        given = ", ".join(f"{name} of shape {array.shape}" for name, array in arrays.items() if array.ndim)
        names = ", ".join(name for name, array in arrays.items() if array.ndim)
        raise ParameterError(Problem(names, f": {given}; must broadcast to one shape")) from None


def several(name: str, value: Any, allowed: str, take: Callable[[int, Any], T]) -> list[T]:
    """Take one after the other what can be gone through, with the number of each, and stop at a wrong one."""
    try:
        return [take(number, one) for number, one in enumerate(value)]
    except (ParameterError, MemoryError):  # of one of them, or of what makes them
        raise
    except Exception as error:  # whatever the object raises
        raise ParameterError(wrong(name, value, allowed)) from error


def function(name: str, value: Any) -> Callable[[float], float]:
    """Take a function of one number; what it raises, or gives that is no number, names it."""
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


def generator(name: str, seed: Any) -> np.random.Generator:
    """Take a seed, or the generator itself."""
    if isinstance(seed, np.random.Generator):
        return seed
    try:
        return np.random.default_rng(whole(name, seed, 0))
    except ParameterError:
        allowed = "a whole number >= 0 or a numpy.random.Generator"
        raise ParameterError(wrong(name, seed, allowed)) from None


def check_each(name: str, array: FloatArray, good: npt.NDArray[np.bool_], allowed: str) -> None:
    """Name the first element that is not good."""
    if not good.all():
        at = tuple(int(i) for i in np.argwhere(~good)[0])
        place = f"[{', '.join(map(str, at))}]" if at else ""
        raise ParameterError(wrong(f"{name}{place}", float(array[at]), allowed))


def check_counts(name: str, counts: FloatArray) -> None:
    """Name the first that is no whole number, or is so large that doubles do not count."""
    good = (counts >= 0) & (counts <= _MOST_COUNTED) & (counts == np.rint(counts))
    check_each(name, counts, good, "a whole number in [0, 2**53]")


def _per_second(short: str, *long: str) -> set[str]:
    exponents = ("s-1", "s^-1", "s**-1", "s⁻¹")
    found = {f"{short}{sign}{one}" for one in exponents for sign in (" ", ".", "·", "*")}
    return found | {f"{short}/s", f"{short} / s"} | {f"{one} / second" for one in long}


_SPELLINGS = {
    "m": {"m", "meter", "meters", "metre", "metres"},
    "m s-1": _per_second("m", "meter", "metre"),
    "rad": {"rad", "radian", "radians"},
    "rad s-1": _per_second("rad", "radian") | {"s-1", "1/s"},
    "s": {"s", "sec", "second", "seconds"},
    "Hz": {"Hz", "hertz", "s-1", "1/s"},
    "1": {"1", "", "dimensionless"},
}


def check_units(name: str, value: Any, unit: str) -> None:
    """Refuse what says in an attribute ``units``, as arrays of xarray can, that it is in others.

    `unit` is written as by the CF conventions. What says nothing is taken to be in it.
    """
    attributes = getattr(value, "attrs", None)
    said = attributes.get("units") if isinstance(attributes, Mapping) else None
    if said is not None and str(said).strip() not in _SPELLINGS.get(unit, {unit}):
        text = (
            f" has units {shown(said)}: must be in {unit}; drop_attrs() removes units that xarray handed on"
        )
        raise ParameterError(Problem(name, text))
