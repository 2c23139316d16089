"""One measured series or several, as fits and figures take them."""

from collections.abc import Iterable
from typing import Any

import xarray as xr

from restitution._parameters import ParameterError, wrong


def series_of(data: Any, *needed: str) -> list[xr.Dataset]:
    """Take a Dataset of `flight.restitution`, or several.

    Raises
    ------
    ParameterError
        If one of them is none, lacks a variable that is needed, or there is none at all.
    """
    several = [data]
    if isinstance(data, Iterable) and not isinstance(data, xr.Dataset):
        try:
            several = list(data)
        except Exception:  # whatever the object raises
            several = []
    for one in several:
        measured = isinstance(one, xr.Dataset) and "gravity" in one.attrs
        if not measured or any(name not in one for name in needed):
            several = []
    if not several:
        raise ParameterError(wrong("data", data, "a Dataset of flight.restitution, or several"))
    return several
