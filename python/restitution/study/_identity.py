"""Identity of a store: the study and the version of the physics that it was made for."""

import hashlib
import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from restitution import _core, laws
from restitution._internal.files import there
from restitution._internal.parameters import ParameterError
from restitution.bodies import KINDS, RIGID
from restitution.drop.dataset import version_here
from restitution.drop.run import Run
from restitution.study._study import Study

_NAME = "restitution_study"  # of the attribute
_MOST_LINES = 12  # of what differs between two studies


class Refused(ValueError):
    """A store that belongs to something else, or is damaged.

    Examples
    --------
    >>> import tempfile
    >>> import restitution as rs
    >>> try:
    ...     rs.study.status(tempfile.mkdtemp())
    ... except rs.study.Refused as error:
    ...     print("not the store of a study")
    not the store of a study
    """


@cache
def fingerprint() -> dict[str, str]:
    """Return the version, and SHA-256 of what the impacts of short runs of every body and law add up to.

    Takes milliseconds. Runs at rest and with spin go through all engines of the core; bodies are full and
    hollow, and rigid with every kind of surface.
    """
    edges = {
        "velocity": np.linspace(0.0, 1.2, 9),
        "restitution": np.linspace(-1.0, 3.0, 41),
        "fraction": np.linspace(0.0, 1.0, 11),
    }
    digest = hashlib.sha256()
    rigid = (kind.example() for kind in RIGID if kind.entry())
    bodies = [*(kind.example(wall=wall) for wall in (None, 4e-4) for kind in KINDS), *rigid]
    for law in [kind.example(normal=0.9) for kind in laws.KINDS]:
        for body in bodies:
            for spin in ((0.0, 0.0, 0.0), (30.0, 20.0, 10.0)):
                run = Run(body=body, law=law, particles=4, impacts=12, spin=spin)
                histogram, _ = _core.histogram(run.parameters(), edges, 1, None)
                digest.update(histogram.words().tobytes())
    return {"version": version_here(), "runs": digest.hexdigest()}


def attribute(study: Study) -> dict[str, str]:
    """Return the attribute by which a store says whose it is; as text, which netCDF takes too."""
    return {_NAME: json.dumps(_wanted(study))}


def identity(path: Path) -> dict[str, Any]:
    """Read what a store says that it is."""
    try:
        found = json.loads(json.loads((path / "zarr.json").read_text("utf-8"))["attributes"][_NAME])
    except PermissionError:
        raise
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        found = None
    if not there(path):
        raise Refused(f"{path}: does not exist; must be the store of a study")
    if not isinstance(found, dict):
        raise Refused(f"{path}: is not the store of a study, or its zarr.json is damaged; give another path")
    return found


def check(path: Path, study: Study) -> None:
    """Refuse a store that does not belong to a study, and say what differs."""
    differences = list(_differences(identity(path), _wanted(study)))
    if not differences:
        return
    lines = [f"  {name}: {there} in the store, {here} here" for name, there, here in differences]
    if len(lines) > _MOST_LINES:
        lines[_MOST_LINES:] = [f"  and {len(lines) - _MOST_LINES} more"]
    physics = any(name.startswith("physics") for name, _, _ in differences)
    advice = "install that version to go on with it, or " if physics else ""
    told = f"{path}: is the store of another study; {advice}write to a new store. What differs:"
    raise Refused("\n".join([told, *lines]))


@contextmanager
def readable(path: Path) -> Iterator[None]:
    """Name the store in the error if it cannot be read or written; of a damaged one Zarr raises anything."""
    try:
        yield
    except (Refused, ParameterError, MemoryError):
        raise
    except Exception as error:
        if not isinstance(error, OSError) or error.errno is None:  # of Zarr, and not of the system
            raise Refused(f"{path}: is damaged ({type(error).__name__}: {error})") from error
        if error.filename is None or str(error.filename).endswith(".partial"):  # a draft of Zarr
            raise OSError(error.errno, error.strerror, str(path)) from error
        raise


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
