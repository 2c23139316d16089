"""Tables of a study as they come, from a file or from Python: their keys, and kinds of values in them."""

import math
from collections.abc import Callable, Collection, Mapping
from typing import Any

from restitution._internal.arrays import real
from restitution._internal.parameters import ParameterError, Problem, plain_number, shown, unknown, wrong

_DEEPEST = 8
"""Tables in tables that are looked into; those of a study are four deep."""

_LONGEST = 100
"""Letters of a key, which an error writes out; of a parameter, with the tables that it is in."""


def copied(name: str, value: Any, depth: int = 0) -> Any:
    """Copy a table with all tables in it; anything else stays what it is.

    Raises
    ------
    ParameterError
        If a key is no name, or tables are nested too deeply, as one that holds itself is.
    """
    if not isinstance(value, Mapping):
        return value
    if depth > _DEEPEST:
        raise ParameterError(Problem(name, f": must be at most {_DEEPEST} tables deep"))
    for key in value:
        if not isinstance(key, str) or len(key) > _LONGEST or not key.isprintable():
            allowed = f"keys must be strings of at most {_LONGEST} printable characters"
            raise ParameterError(Problem(name, f" has the key {shown(key)}: {allowed}"))
    return {
        key: copied(f"{name}.{key}" if depth > 0 else key, part, depth + 1) for key, part in value.items()
    }


def table(name: str, value: Any, keys: Collection[str]) -> Mapping[str, Any]:
    """Take a table of a study, which has no other keys."""
    if not isinstance(value, Mapping):
        raise ParameterError(wrong(name, value, f"a table [{name}]"))
    check_keys(name, value, keys, f"[{name}]")
    return value


def check_keys(name: str, value: Mapping[str, Any], keys: Collection[str], taker: str) -> None:
    """Refuse a key that is not among those that `taker` takes."""
    for stranger in value:
        if stranger not in keys:
            raise ParameterError(unknown(stranger, taker, keys, prefix=f"{name}."))


def word(name: str, value: Any, words: Collection[str]) -> str:
    """Take one of several words."""
    if not isinstance(value, str) or value not in words:
        raise ParameterError(wrong(name, value, " or ".join(map(repr, words))))
    return str(value)


def number(name: str, value: Any, allowed: str, good: Callable[[float], bool] = math.isfinite) -> int | float:
    """Take a number for which `good` holds; a whole one stays one, and has the digest that it always had."""
    checked, plain = real(name, value, allowed, good), plain_number(value)
    return plain if isinstance(plain, int) else checked
