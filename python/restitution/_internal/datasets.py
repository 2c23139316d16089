"""Datasets from outside and as files; results that are equal by what they hold."""

import errno
import os
from collections.abc import Callable, Mapping, Set
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


class Content:
    """A frozen dataclass without its own equality: arrays and Datasets are compared number by number."""

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return same(self._compared(), other._compared())

    def __hash__(self) -> int:
        return hash((type(self), *map(_key, self._compared().values())))

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


def same(one: Any, other: Any) -> bool:
    """Whether two parts are of one kind and hold the same."""
    for kind, equal in _ALIKE.items():
        if isinstance(one, kind) or isinstance(other, kind):
            # What such a part says of one of another kind has no truth value, or a wrong one.
            return isinstance(one, kind) and isinstance(other, kind) and bool(equal(one, other))
    both_nan = isinstance(one, float) and isinstance(other, float) and one != one and other != other
    return both_nan or bool(one == other)


def _same_arrays(one: Any, other: Any) -> bool:
    return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=one.dtype.kind == "f")


def _same_mappings(one: Any, other: Any) -> bool:
    return one.keys() == other.keys() and all(same(part, other[name]) for name, part in one.items())


def _same_tuples(one: Any, other: Any) -> bool:
    return len(one) == len(other) and all(map(same, one, other))


_ALIKE: dict[type, Callable[[Any, Any], bool]] = {
    np.ndarray: _same_arrays,
    xr.Dataset: xr.Dataset.identical,
    xr.DataTree: xr.DataTree.identical,
    Mapping: _same_mappings,  # after those of xarray, which are mappings, too
    tuple: _same_tuples,
}


def _key(part: Any) -> Any:
    """Give what parts that are the same have in common, and can be hashed."""
    if isinstance(part, np.ndarray):
        return part.shape
    if isinstance(part, xr.Dataset):
        return tuple(sorted((str(name), size) for name, size in part.sizes.items()))
    if isinstance(part, xr.DataTree):
        return tuple((path, _key(node.dataset)) for path, node in part.subtree_with_keys)
    if isinstance(part, Mapping):
        return tuple((name, _key(value)) for name, value in sorted(part.items()))
    if isinstance(part, tuple):
        return tuple(map(_key, part))
    return "nan" if isinstance(part, float) and part != part else part


def load(path: Path) -> xr.Dataset:
    """Read a netCDF file; an OSError that names it if it cannot be read."""
    check_regular(path)
    try:
        with xr.open_dataset(path, engine="netcdf4") as data:
            check_room(str(path), data.nbytes)
            return data.load()
    except MemoryError:
        raise
    except OSError as error:  # of netCDF, which names the file in full, or not at all
        raise OSError(error.errno or errno.EIO, error.strerror or str(error), str(path)) from error
    except Exception as error:  # of netCDF, which raises many kinds for a damaged file
        raise OSError(errno.EIO, f"cannot be read as netCDF: {error}", str(path)) from error


def save(data: xr.Dataset, path: Path, *, replace: bool = False) -> None:
    """Write a netCDF file whole or not at all."""
    with whole_file(path, replace=replace) as draft:
        put(data, draft)


def put(data: xr.Dataset, draft: Path) -> None:
    """Write a netCDF file."""
    try:
        data.to_netcdf(draft, engine="netcdf4")
    except (RuntimeError, OSError) as error:  # of netCDF, which says neither where nor why
        _ask_for_room(draft, data.nbytes)
        raise OSError(errno.EIO, f"cannot be written: {error}", str(draft)) from error


_BESIDE = 2**20
"""Bytes that HDF5 keeps beside the numbers of a file, at most."""


def _ask_for_room(draft: Path, size: int) -> None:
    """Raise the system's own error where the disk is full, or files may not be so much larger."""
    if not hasattr(os, "posix_fallocate"):
        return
    try:
        with draft.open("ab") as file:
            # It may have failed in what HDF5 keeps beside the numbers, which itself would fit.
            os.posix_fallocate(file.fileno(), file.tell(), size + _BESIDE)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(draft)) from None


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


def check_variables(name: str, data: xr.Dataset, *variables: str) -> None:
    """Refuse a Dataset in which one of these variables, if it is there, says that it has other units."""
    for each in variables:
        if each in data:
            check_units(f"{name}.{each}", data[each], _UNITS.get(each, "1"))


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
    if not isinstance(data, xr.Dataset):
        raise ParameterError(wrong(name, data, f"a Dataset from {origin}"))
    missing = [each for each in dimensions if each not in data]
    if missing:
        raise ParameterError(Problem(name, f" lacks {', '.join(missing)}: must be a Dataset from {origin}"))
    check_variables(name, data, *dimensions)
    found = []
    for each, needed in dimensions.items():
        check_dimensions(f"{name}.{each}", data[each], needed)
        numbers = data[each].transpose(*needed).to_numpy()
        found.append(reals(f"{name}.{each}", numbers, "real numbers, NaN for none", finite=False))
    return tuple(found)


def check_dimensions(name: str, variable: xr.DataArray, needed: tuple[str, ...]) -> None:
    """Refuse a variable of other dimensions; their order does not matter."""
    if set(variable.dims) != set(needed):
        several = [each for each in ("body", "law") if each in variable.dims]
        one = f"; take one with sel({', '.join(f'{each}=...' for each in several)})" if several else ""
        text = f" has dimensions ({', '.join(map(str, variable.dims))}): must be ({', '.join(needed)}){one}"
        raise ParameterError(Problem(name, text))
