"""Datasets from outside and as files; results that are equal by what they hold."""

import errno
import os
from collections.abc import Iterable, Mapping, Set
from dataclasses import fields
from functools import cached_property
from inspect import getattr_static
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray, check_units, reals
from restitution._internal.files import check_regular, whole_file
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution._internal.resources import check_room

_BESIDE = 2**20
"""Bytes that HDF5 keeps beside the numbers of a file, at most."""
_UNITS = {
    "m": "position height release_height",
    "s": "time uncertainty",
    "rad": "angle release_angle release_azimuth",
    "m s-1": "impact_velocity impact_velocity_error rebound_velocity velocity velocity_before velocity_after "
    "velocity_edges",
    "rad s-1": "release_spin angular_velocity_before angular_velocity_after",
}
"""Which variables of Datasets are in these units; all others are pure numbers."""


class Content:
    """A frozen dataclass without its own equality: arrays and Datasets are compared number by number.

    NaN is equal to NaN, also after a journey by pickle.
    """

    def __eq__(self, other: object) -> bool:
        return same(self._compared(), other._compared()) if type(other) is type(self) else NotImplemented

    def __hash__(self) -> int:
        plain = (part for part in self._compared().values() if isinstance(part, str | float | int))
        return hash((type(self), *(part for part in plain if part == part)))

    def __getstate__(self) -> dict[str, Any]:
        """Let a read-only view of a dictionary travel as the dictionary."""
        views = {name: dict(v) for name, v in self.__dict__.items() if isinstance(v, MappingProxyType)}
        return self.__dict__ | views

    def __setstate__(self, state: dict[str, Any]) -> None:
        check_state(self, state)
        views = {name: MappingProxyType(v) for name, v in state.items() if isinstance(v, dict)}
        self.__dict__.update(state | views)
        if again := getattr(self, "__post_init__", None):
            again()

    def _compared(self) -> dict[str, Any]:
        return {one.name: getattr(self, one.name) for one in fields(self) if one.compare}  # type: ignore[arg-type]


def same(one: Any, other: Any) -> bool:
    """Whether two parts are of one kind and hold the same."""
    kinds = (xr.Dataset, xr.DataTree, np.ndarray, Mapping, tuple)
    if any(isinstance(one, kind) != isinstance(other, kind) for kind in kinds):
        return False  # what such a part says of one of another kind has no truth value, or a wrong one
    match one:
        case xr.Dataset() | xr.DataTree():
            return one.identical(other)
        case np.ndarray():
            return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=one.dtype.kind == "f")
        case Mapping():
            return one.keys() == other.keys() and all(same(part, other[name]) for name, part in one.items())
        case tuple():
            return len(one) == len(other) and all(map(same, one, other))
    return bool(one == other) or bool(one != one and other != other)


def check_state(thing: Any, state: Mapping[str, Any]) -> None:
    """Refuse what a pickle of a dataclass holds if the class had other fields in the version that made it."""
    kind = type(thing)
    kept = {name for name in state if isinstance(getattr_static(kind, name, None), cached_property)}
    check_names(kind, {one.name for one in fields(kind)}, state.keys() - kept)


def check_names(kind: type, wanted: Set[str], found: Set[str]) -> None:
    """Refuse what a pickle holds if it is not what this version of a class keeps there."""
    if other := wanted ^ found:
        text = f": pickled by another version, whose {kind.__name__} differs in {', '.join(sorted(other))}"
        raise ParameterError(Problem(kind.__name__, f"{text}; make it again"))


def load(path: Path) -> xr.Dataset:
    """Read a netCDF file; an OSError that names it if it cannot be read."""
    check_regular(path)
    try:
        with xr.open_dataset(path, engine="netcdf4") as data:
            check_room(str(path), data.nbytes)
            return data.load()
    except MemoryError:
        raise
    except Exception as error:  # of netCDF, which raises many kinds for a damaged file
        known = isinstance(error, OSError) and error.strerror  # it names the file in full, or not at all
        raise OSError(errno.EIO, known or f"cannot be read as netCDF: {error}", str(path)) from error


def save(data: xr.Dataset, path: Path, *, replace: bool = False) -> None:
    """Write a netCDF file whole or not at all."""
    with whole_file(path, replace=replace) as draft:
        put(data, draft)


def put(data: xr.Dataset, draft: Path) -> None:
    """Write a netCDF file."""
    try:
        data.to_netcdf(draft, engine="netcdf4")
    except (RuntimeError, OSError) as error:  # of netCDF, which says neither where nor why
        if hasattr(os, "posix_fallocate"):
            with draft.open("ab") as file:  # the system says whether the disk is full
                os.posix_fallocate(file.fileno(), file.tell(), data.nbytes + _BESIDE)
        raise OSError(errno.EIO, f"cannot be written: {error}", str(draft)) from error


def variables(
    name: str, data: Any, origin: str, dimensions: Mapping[str, tuple[str, ...]]
) -> tuple[FloatArray, ...]:
    """Take variables of a Dataset as arrays of these dimensions, in their order.

    Parameters
    ----------
    name : str
        Of the argument, for the error.
    data : Any
        What was given.
    origin : str
        What such a Dataset comes from, for the error.
    dimensions : mapping of str to tuple of str
        Of each variable that is needed.

    Raises
    ------
    ParameterError
        If `data` is not a Dataset, lacks a variable, or has one of other dimensions, in other units or of
        no real numbers.
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
