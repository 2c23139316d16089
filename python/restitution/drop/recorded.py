"""Datasets from outside, checked in one place: recorded impacts, and counts in bins."""

import math
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray, check_each, check_units, real, reals
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.drop.bins import increasing_edges

RECORDS = ("particle", "impact")
"""Dimensions of what is recorded of each impact."""
_RUN = "restitution.simulate"
_UNITS = {
    "m": "position height release_height",
    "s": "time uncertainty",
    "rad": "angle release_angle release_azimuth",
    "m s-1": "impact_velocity impact_velocity_error rebound_velocity velocity velocity_before velocity_after "
    "velocity_edges",
    "rad s-1": "release_spin angular_velocity_before angular_velocity_after",
}
"""Variables of Datasets by unit; all others are pure numbers."""


def variables(
    name: str, data: Any, origin: str, dimensions: Mapping[str, tuple[str, ...]]
) -> tuple[FloatArray, ...]:
    """Take variables of a Dataset as arrays of these dimensions, in their order.

    `origin` says what such a Dataset comes from. A ParameterError says what is wrong: no Dataset, a variable
    that is missing, or one of other dimensions, in other units or of no real numbers.
    """
    check_has(name, data, f"a Dataset from {origin}", dimensions)
    found = []
    for each, needed in dimensions.items():
        check_dimensions(f"{name}.{each}", data[each], needed)
        numbers = data[each].transpose(*needed).to_numpy()
        found.append(reals(f"{name}.{each}", numbers, "real numbers, NaN for none", finite=False))
    return tuple(found)


def check_has(name: str, data: Any, allowed: str, needed: Iterable[str]) -> None:
    """Refuse what is no Dataset, lacks a variable, or has one in other units."""
    if not isinstance(data, xr.Dataset):
        raise ParameterError(wrong(name, data, allowed))
    missing = [each for each in needed if each not in data]
    if missing:
        raise ParameterError(Problem(name, f" lacks {', '.join(missing)}: must be {allowed}"))
    check_variables(name, data, *needed)


def check_variables(name: str, data: xr.Dataset, *variables: str) -> None:
    """Refuse a Dataset in which one of these variables, if it is there, says that it has other units."""
    for each in variables:
        if each in data:
            unit = next((unit for unit, names in _UNITS.items() if each in names.split()), "1")
            check_units(f"{name}.{each}", data[each], unit)


def check_dimensions(name: str, variable: xr.DataArray, needed: tuple[str, ...]) -> None:
    """Refuse a variable of other dimensions; their order does not matter."""
    if set(variable.dims) != set(needed):
        several = [each for each in ("body", "law") if each in variable.dims]
        one = f"; take one with sel({', '.join(f'{each}=...' for each in several)})" if several else ""
        text = f" has dimensions ({', '.join(map(str, variable.dims))}): must be ({', '.join(needed)}){one}"
        raise ParameterError(Problem(name, text))


def records(name: str, data: Any, *names: str) -> tuple[FloatArray, ...]:
    """Take variables of recorded impacts, each of shape (particles, impacts)."""
    return variables(name, data, _RUN, dict.fromkeys(names, RECORDS))


def check_filled(name: str, records: FloatArray) -> None:
    """Refuse recorded impacts of no particle, or of no impact."""
    if records.size == 0:
        particles, impacts = records.shape
        text = f" has {particles} particles of {impacts} impacts: must have at least one of both"
        raise ParameterError(Problem(name, text))


def check_successive(name: str, data: xr.Dataset, *, start: int | None = None) -> None:
    """Refuse impacts that do not follow one another, as their numbers in the coordinate ``impact`` say.

    Without that coordinate they are all impacts of a run only where they are as many as its attribute
    ``impacts`` says. `start` is the number that the first must have, if any.
    """
    if "impact" not in data.coords:
        every = data.attrs.get("impacts")
        if not isinstance(every, int | np.integer) or every != data.sizes["impact"]:
            text = " lacks the coordinate impact: must have the numbers of its impacts"
            raise ParameterError(Problem(name, text))
        return
    rule = "whole numbers >= 0 that rise by one from impact to impact"
    check_dimensions(f"{name}.impact", data["impact"], ("impact",))
    numbers = reals(f"{name}.impact", data["impact"].to_numpy(), rule)
    if numbers.size == 0:
        return
    first = max(0.0, np.rint(numbers[0])) if start is None else float(start)
    if start is not None:
        rule += f", from {start}, the first after the release"
    check_each(f"{name}.impact", numbers, numbers == first + np.arange(numbers.size), rule)


def check_frame(name: str, data: xr.Dataset) -> None:
    """Refuse vectors whose components are not those in the frame of the plane, and parts of quaternions."""
    for each, letters in (("component", "xyz"), ("quaternion", "wxyz")):
        if each in data.dims and (each not in data.coords or data[each].to_numpy().tolist() != [*letters]):
            raise ParameterError(wrong(f"{name}.{each}", data[each].to_numpy(), ", ".join(letters)))


def attribute(
    name: str,
    data: xr.Dataset,
    key: str,
    allowed: str,
    good: Callable[[float], bool] = math.isfinite,
) -> float:
    """Take a number that is an attribute of a Dataset from `restitution.simulate`."""
    if key not in data.attrs:
        text = f" lacks the attribute {key}: must be a Dataset from {_RUN}"
        raise ParameterError(Problem(name, text))
    return real(f"{name}.{key}", data.attrs[key], allowed, good)


def pull(name: str, data: xr.Dataset) -> tuple[float, float]:
    """Take gravity in m/s² and the incline in rad of a run."""
    gravity = attribute(name, data, "gravity", "a finite number > 0", lambda g: 0.0 < g < math.inf)
    if "incline" not in data.attrs:
        return gravity, 0.0
    return gravity, attribute(
        name, data, "incline", "a finite number in [0, π/2)", lambda a: 0.0 <= a < math.pi / 2
    )


def released_from(name: str, data: xr.Dataset) -> FloatArray:
    """Take heights of release in m: one for each particle, or one for all, of shape ()."""
    if "release_height" in data:
        needed = tuple(each for each in ("particle",) if each in data.dims)
        (heights,) = variables(name, data, _RUN, {"release_height": needed})
        allowed = "finite numbers"
        check_each(f"{name}.release_height", heights, np.isfinite(heights), allowed)
        return heights
    return np.asarray(attribute(name, data, "release_height", "a finite number"))


def check_counts(name: str, counts: FloatArray) -> None:
    """Name the first value that is no whole number, or is too large for doubles to count exactly."""
    good = (counts >= 0) & (counts <= 2.0**53) & (counts == np.rint(counts))
    check_each(name, counts, good, "a whole number in [0, 2**53]")


_OF_BINS = {
    "velocity": ("velocity",),
    "velocity_edges": ("velocity_edge",),
    "restitution_count": ("velocity", "restitution"),
    "restitution_edges": ("restitution_edge",),
    "fraction_count": ("velocity", "fraction"),
    "fraction_edges": ("fraction_edge",),
}
"""Dimensions of what statistics hold; everything else is over velocity."""
LATTICE = (
    "restitution_count",
    "velocity_edges",
    "restitution_edges",
    "restitution_underflow",
    "restitution_overflow",
)
"""Counts by velocity bin and restitution bin, with their edges."""
_COUNTS = ("_count", "_underflow", "_overflow", "number")


def counted(name: str, data: xr.Dataset, names: tuple[str, ...] = LATTICE) -> xr.Dataset:
    """Take statistics in bins of velocity that have these variables.

    Velocity is the first dimension of what is returned, bins of restitution or fraction are the last. Edges
    must increase and fit, counts be whole numbers in [0, 2**53], and other variables real numbers.
    """
    origin = "a Dataset from restitution.statistics or reduce, by velocity"
    if not all(each in _OF_BINS or each.endswith(_COUNTS) for each in names):
        origin += "; counts_only=True leaves the moments out"
    check_has(name, data, origin, names)
    for each in names:
        check_dimensions(f"{name}.{each}", data[each], _OF_BINS.get(each, ("velocity",)))
    for each in names:
        variable = data[each]
        if each.endswith("_edges"):
            increasing_edges(variable, f"{name}.{each}")
            bins = data.sizes.get(each.removesuffix("_edges"), 0)
            if variable.size != bins + 1:
                text = f" has {variable.size} edges: must be one more than the {bins} bins"
                raise ParameterError(Problem(f"{name}.{each}", text))
        elif each.endswith(_COUNTS):
            counts = reals(f"{name}.{each}", variable.to_numpy(), "whole numbers in [0, 2**53]")
            check_counts(f"{name}.{each}", counts)
        else:
            reals(f"{name}.{each}", variable.to_numpy(), "real numbers, NaN for none", finite=False)
    if "velocity" in names and "velocity_edges" in names:
        speeds, edges = data["velocity"].to_numpy(), data["velocity_edges"].to_numpy()
        inside = (speeds >= edges[:-1]) & (speeds <= edges[1:])
        check_each(f"{name}.velocity", speeds, inside, "the middles of the velocity bins")
    return data.transpose("velocity", ..., "restitution", "fraction", missing_dims="ignore")
