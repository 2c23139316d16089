"""Datasets from outside and as files; results that are equal by what they hold."""

import errno
import os
from collections.abc import Mapping, Set
from dataclasses import fields
from functools import cached_property
from inspect import getattr_static
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.files import check_regular, whole_file
from restitution._internal.parameters import ParameterError, Problem
from restitution._internal.process import undisturbed
from restitution._internal.resources import check_room

_BESIDE = 2**20  # bytes that HDF5 keeps beside the numbers of a file, at most


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
        """Pickle a read-only view of a dictionary as the dictionary."""
        views = {name: dict(v) for name, v in self.__dict__.items() if isinstance(v, MappingProxyType)}
        return self.__dict__ | views

    def __setstate__(self, state: dict[str, Any]) -> None:
        check_state(type(self), {one.name for one in fields(self)}, state)  # type: ignore[arg-type]
        views = {name: MappingProxyType(v) for name, v in state.items() if isinstance(v, dict)}
        self.__dict__.update(state | views)
        if again := getattr(self, "__post_init__", None):
            again()

    def _compared(self) -> dict[str, Any]:
        return {one.name: getattr(self, one.name) for one in fields(self) if one.compare}  # type: ignore[arg-type]


def same(one: Any, other: Any) -> bool:
    """Compare two parts: True if they are of one type and have equal values."""
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


def check_state(kind: type, wanted: Set[str], state: Mapping[str, Any]) -> None:
    """Refuse what a pickle holds if another version made it, whose class had other fields."""
    kept = {name for name in state if isinstance(getattr_static(kind, name, None), cached_property)}
    if other := wanted ^ (state.keys() - kept):
        text = f": pickled by another version, whose {kind.__name__} differs in {', '.join(sorted(other))}"
        raise ParameterError(Problem(kind.__name__, f"{text}; make it again"))


def load(path: Path) -> xr.Dataset:
    """Read a netCDF file; an OSError that names it if it cannot be read."""
    check_regular(path)
    try:
        # netCDF4 swallows the exception of a signal that comes while it reads.
        with undisturbed(), xr.open_dataset(path, engine="netcdf4") as data:
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
