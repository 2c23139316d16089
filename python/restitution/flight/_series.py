"""One measured series or several, as fits and figures take them."""

from collections.abc import Iterable
from typing import Any

import xarray as xr

from restitution._parameters import ParameterError, wrong
from restitution._units import check_variables


def series_of(data: Any, *needed: str) -> list[xr.Dataset]:
    """Take a Dataset of `flight.restitution`, or several.

    Raises
    ------
    ParameterError
        If one of them is none, lacks a variable that is needed or has it in other units, or there is none.
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
    for one in several:
        check_variables("data", one, *needed)
    return several
