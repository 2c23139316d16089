"""Units that arrays say that they have, as those of xarray can: others than ours are refused."""

from collections import UserList, deque
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from restitution._internal.parameters import ParameterError, Problem, shown

if TYPE_CHECKING:
    import xarray as xr


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

_DEEPEST = 2
"""Lists in lists that are looked into; no table of ours has more."""


def check_units(name: str, value: Any, unit: str, depth: int = 0) -> None:
    """Refuse an array whose attribute ``units``, as of xarray, is another; one without is taken to have ours.

    So are the arrays in a list.

    Parameters
    ----------
    name : str
        Of the argument, for the error.
    value : Any
        Anything; what has no attributes passes.
    unit : str
        What its numbers must be in, as the CF conventions write it.
    depth : int
        Of lists that `value` is in.

    Raises
    ------
    ParameterError
        With the units that it has.
    """
    attributes = getattr(value, "attrs", None)
    said = attributes.get("units") if isinstance(attributes, Mapping) else None
    if said is not None and str(said).strip() not in _SPELLINGS.get(unit, {unit}):
        text = (
            f" has units {shown(said)}: must be in {unit}; drop_attrs() removes units that xarray handed on"
        )
        raise ParameterError(Problem(name, text))
    if depth < _DEEPEST and isinstance(value, list | tuple | deque | UserList):
        for part in () if set(map(type, value)) <= {float, int} else value:
            check_units(name, part, unit, depth + 1)


_UNITS = {
    "time": "s",
    "uncertainty": "s",
    "position": "m",
    "height": "m",
    "release_height": "m",
    "angle": "rad",
    "release_angle": "rad",
    "release_azimuth": "rad",
    "release_spin": "rad s-1",
    "angular_velocity_before": "rad s-1",
    "angular_velocity_after": "rad s-1",
    "impact_velocity": "m s-1",
    "impact_velocity_error": "m s-1",
    "rebound_velocity": "m s-1",
    "velocity_before": "m s-1",
    "velocity_after": "m s-1",
    "velocity": "m s-1",
    "velocity_edges": "m s-1",
}
"""Of the variables of our Datasets; of those that are not here, 1."""


def check_variables(name: str, data: "xr.Dataset", *variables: str) -> None:
    """Refuse a Dataset in which one of these variables, if it is there, says that it has other units."""
    for each in variables:
        if each in data:
            check_units(f"{name}.{each}", data[each], _UNITS.get(each, "1"))
