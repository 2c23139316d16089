"""One measured series or several, as fits and figures take them."""

from collections.abc import Iterable
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import check_each
from restitution._internal.parameters import ParameterError, wrong
from restitution.drop.recorded import variables

USUAL_BETWEEN = 3e-3
"""Half of all plates and hands differ by less in ε: the scale of a half-Cauchy prior (Gelman, 2006)."""


def series_of(data: Any, *needed: str) -> dict[str, xr.Dataset]:
    """Take a Dataset of `flight.restitution`, or several, by what errors call them.

    Raises
    ------
    ParameterError
        If one of them is none, lacks a variable that is needed or has it in other units, of other dimensions
        or of no real numbers, or an error that is negative, or there is none.
    """
    several = [data]
    if isinstance(data, Iterable) and not isinstance(data, xr.Dataset):
        try:
            several = list(data)
        except Exception:  # the object may raise anything
            several = []
    if not several or not all(isinstance(one, xr.Dataset) for one in several):
        raise ParameterError(wrong("data", data, "a Dataset of flight.restitution, or several"))
    named = {"data": data} if isinstance(data, xr.Dataset) else {}
    named = named or {f"data[{k}]": one for k, one in enumerate(several)}
    pairs = ("impact", "other_impact")
    dimensions = {each: pairs if each.endswith("_covariance") else pairs[:1] for each in needed}
    for name, one in named.items():
        for each, values in zip(needed, variables(name, one, "flight.restitution", dimensions), strict=True):
            check_each(f"{name}.{each}", values, ~np.isinf(values), "finite, or NaN for what is not known")
            if each.endswith("_error"):
                check_each(f"{name}.{each}", values, ~(values < 0.0), "a standard error >= 0, or NaN")
    return named
