"""Results that compare and hash by what they hold, with NaN equal to NaN, also after a journey by pickle."""

from collections.abc import Callable, Mapping, Set
from dataclasses import fields
from functools import cached_property
from inspect import getattr_static
from types import MappingProxyType
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.parameters import ParameterError, Problem


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
