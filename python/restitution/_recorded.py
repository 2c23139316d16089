"""Datasets from outside, checked in one place: recorded impacts, and counts in bins."""

from typing import Any

import numpy as np
import xarray as xr

from restitution._arrays import FloatArray, check_counts, reals
from restitution._bins import increasing_edges
from restitution._parameters import ParameterError, Problem, wrong
from restitution._units import check_variables


def records(name: str, data: Any, *names: str) -> tuple[FloatArray, ...]:
    """Take variables of recorded impacts, each of shape (particles, impacts).

    Raises
    ------
    ParameterError
        If `data` is not a Dataset, lacks a variable, or has one of other dimensions, in other units or of
        no real numbers.
    """
    if not isinstance(data, xr.Dataset):
        raise ParameterError(wrong(name, data, "a Dataset from restitution.simulate"))
    missing = [each for each in names if each not in data]
    if missing:
        text = f" lacks {', '.join(missing)}: must be a Dataset from restitution.simulate"
        raise ParameterError(Problem(name, text))
    check_variables(name, data, *names)
    found = []
    for each in names:
        variable = data[each]
        if set(variable.dims) != {"particle", "impact"}:
            text = f" has dimensions ({', '.join(map(str, variable.dims))}): must be (particle, impact)"
            raise ParameterError(Problem(f"{name}.{each}", text))
        numbers = variable.transpose("particle", "impact").to_numpy()
        found.append(reals(f"{name}.{each}", numbers, "real numbers, NaN for none", finite=False))
    return tuple(found)


def first_impact_of(name: str, data: xr.Dataset) -> int:
    """Give the number of the first impact of a Dataset, whose others must follow one another.

    The number is the coordinate ``impact``, which selecting impacts keeps; without it they count from 0.

    Raises
    ------
    ParameterError
        If some impacts between the first and the last are not there.
    """
    if "impact" not in data.coords or not data.sizes["impact"]:
        return 0
    allowed = "numbers of impacts that follow one another"
    number = reals(f"{name}.impact", data["impact"].to_numpy(), allowed, dimensions=(1,))
    if not np.all(np.diff(number) == 1.0) or number[0] < 0.0 or number[0] != np.rint(number[0]):
        raise ParameterError(wrong(f"{name}.impact", number, allowed))
    return int(number[0])


_COUNTED = {
    "restitution_count": ("velocity", "restitution"),
    "velocity_edges": ("velocity_edge",),
    "restitution_edges": ("restitution_edge",),
    "restitution_underflow": ("velocity",),
    "restitution_overflow": ("velocity",),
}


def counted(name: str, data: Any, *, spans: bool = True) -> xr.Dataset:
    """Take counts by velocity bin and restitution bin, with their edges, of velocity where `spans` asks.

    Raises
    ------
    ParameterError
        If `data` is not a Dataset, lacks a variable, has one of other dimensions, edges that do not
        increase or do not fit, or counts that are not whole numbers in [0, 2**53].
    """
    if not isinstance(data, xr.Dataset):
        raise ParameterError(wrong(name, data, "a Dataset from restitution.statistics or reduce"))
    wanted = {each: own for each, own in _COUNTED.items() if spans or each != "velocity_edges"}
    missing = [each for each in wanted if each not in data]
    if missing:
        text = f" lacks {', '.join(missing)}: must be from restitution.statistics or reduce, by velocity"
        raise ParameterError(Problem(name, text))
    check_variables(name, data, *wanted)
    for each, dimensions in wanted.items():
        variable = data[each]
        if set(variable.dims) != set(dimensions):
            needed = ", ".join(dimensions)
            text = f" has dimensions ({', '.join(map(str, variable.dims))}): must be ({needed})"
            raise ParameterError(Problem(f"{name}.{each}", text))
        if each.endswith("_edges"):
            increasing_edges(variable, f"{name}.{each}")
            bins = data.sizes[each.removesuffix("_edges")]
            if variable.size != bins + 1:
                text = f" has {variable.size} edges: must be one more than the {bins} bins"
                raise ParameterError(Problem(f"{name}.{each}", text))
        else:
            counts = reals(f"{name}.{each}", variable.to_numpy(), "whole numbers in [0, 2**53]")
            check_counts(f"{name}.{each}", counts)
    return data.transpose("velocity", ..., "restitution", missing_dims="ignore")
