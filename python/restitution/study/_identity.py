"""Whose store it is: the study and the version of the physics that it was made for, as the store says."""

import errno
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from restitution._internal.files import check_regular, content
from restitution._internal.parameters import ParameterError
from restitution.study._physics import fingerprint
from restitution.study._study import Study

_NAME = "restitution_study"
"""Of the attribute."""


class Refused(ValueError):
    """A store that belongs to something else.

    Examples
    --------
    >>> import tempfile
    >>> import restitution as rs
    >>> study = {
    ...     "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
    ...     "law": rs.TangentialRestitution(normal=0.98),
    ...     "run": {"particles": 32, "impacts": 50},
    ...     "statistics": {"velocity_bins": {"from": 0.0, "to": 1.1, "bins": 11},
    ...                    "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 40}},
    ...     "sweep": {"law.normal": [0.9, 0.98]},
    ... }
    >>> out = tempfile.mkdtemp() + "/study.zarr"
    >>> found = rs.sweep(study, out=out)
    >>> study["run"] = {"particles": 64, "impacts": 50}
    >>> try:
    ...     rs.sweep(study, out=out)
    ... except rs.study.Refused as error:
    ...     print("another study")
    another study
    """


def attribute(study: Study) -> dict[str, str]:
    """Return the attribute by which a store says whose it is; as text, which netCDF takes too."""
    return {_NAME: json.dumps(_wanted(study))}


@contextmanager
def threads_for(path: Path) -> Iterator[None]:
    """Name the store where the system gives no thread, of which Zarr needs some to read or write anything."""
    try:
        yield
    except RuntimeError as error:
        if "new thread" not in str(error):
            raise
        raise OSError(errno.EAGAIN, "the system gives no thread to work on it", str(path)) from error


@contextmanager
def readable(path: Path) -> Iterator[None]:
    """Name the store if it cannot be read: a damaged one makes Zarr and its decoders raise anything."""
    try:
        with threads_for(path):
            yield
    except (Refused, ParameterError, MemoryError):
        raise
    except Exception as error:
        if isinstance(error, OSError) and error.errno is not None:  # of the system, and not of Zarr
            raise
        raise Refused(f"{path}: is damaged ({type(error).__name__}: {error})") from error


def check(path: Path, study: Study) -> None:
    """Refuse a store that does not belong to a study, and say what differs."""
    found = identity(path)
    wanted = _wanted(study)
    differences = list(_differences(found, wanted))
    if not differences:
        return
    most = 12
    lines = [f"  {name}: {there} in the store, {here} here" for name, there, here in differences[:most]]
    if len(differences) > most:
        lines.append(f"  and {len(differences) - most} more")
    physics = any(name.startswith("physics") for name, _, _ in differences)
    advice = (
        "install that version to go on with it, or write to a new store"
        if physics
        else "write to a new store"
    )
    raise Refused(f"{path}: is the store of another study; {advice}. What differs:\n" + "\n".join(lines))


def identity(path: Path) -> dict[str, Any]:
    """Read what a store says that it is."""
    try:
        check_regular(path / "zarr.json")
        text = content(path / "zarr.json").decode()
        found = json.loads(json.loads(text)["attributes"][_NAME])
    except PermissionError:
        raise
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        raise Refused(
            f"{path}: is not the store of a study, or its zarr.json is damaged; give another path"
        ) from None
    if not isinstance(found, dict):
        raise Refused(f"{path}: is not the store of a study; give another path")
    return found


def _wanted(study: Study) -> dict[str, Any]:
    plain: dict[str, Any] = json.loads(json.dumps({"physics": fingerprint(), **study.identity}))
    return plain


def _differences(there: Any, here: Any, name: str = "") -> Iterator[tuple[str, str, str]]:
    if isinstance(there, Mapping) and isinstance(here, Mapping):
        for key in sorted(set(there) | set(here)):
            yield from _differences(there.get(key), here.get(key), f"{name}.{key}" if name else key)
    elif there != here:
        yield name, _short(there), _short(here)


def _short(value: Any) -> str:
    text = "nothing" if value is None else json.dumps(value)
    return text if len(text) <= 60 else f"{text[:40]} … {text[-12:]}"
