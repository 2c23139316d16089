"""What a worker does, in whatever process and on whatever machine it is: a task, or the end of a point."""

import hashlib
import threading
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution.study._axes import Design
from restitution.study._point import Point, Tell, count, evaluate
from restitution.study._store import Store, common, large, small

Arrays = dict[str, npt.NDArray[Any]]


class Stopped(Exception):
    """The study was asked to stop."""


@dataclass(frozen=True)
class Task:
    """A point and a range of its particles.

    Attributes
    ----------
    point : Point
        The point.
    number : int
        Which of its tasks.
    """

    point: Point
    number: int


@dataclass(frozen=True)
class End:
    """What is to be worked out when all tasks of a point are there.

    Attributes
    ----------
    point : Point
        The point.
    place : tuple of int
        Where it is in the results.
    blocks : int
        How many blocks of particles it has.
    known : bytes
        Digest that it has in the results, if it has been worked out before; else empty.
    small : bytes
        Digest of what of the results the driver has read.
    """

    point: Point
    place: tuple[int, ...]
    blocks: int
    known: bytes = b""
    small: bytes = b""


@dataclass(frozen=True)
class Ended:
    """What became of it.

    Attributes
    ----------
    damaged : list of int
        Tasks that are missing or damaged; then there is nothing else.
    unchanged : bool
        Whether the results that are there are those of the tasks that are there.
    enough : bool
        Whether the point has as many particles as it needs.
    found : xarray.Dataset or None
        The smaller variables; the larger ones are written.
    digest : bytes
        Digest of everything that was found.
    """

    damaged: list[int] = field(default_factory=list)
    unchanged: bool = False
    enough: bool = True
    found: xr.Dataset | None = None
    digest: bytes = b""


def run_task(path: str, task: Task, stop: threading.Event | None = None) -> bool:
    """Count a range of particles and commit it; return whether that had been done already."""
    store = _open(path, task.point.study)
    point, effort = task.point, task.point.effort
    number = effort.task_batches
    first = task.number * number
    if task.number in store.there(point.number) and store.valid(point.number, first, number).all():
        return True
    tell = _teller(stop)
    rows = [count(point, effort.part(batch), tell) for batch in range(first, first + number)]
    store.write(point.number, first, np.stack(rows))
    return False


def end_point(path: str, end: End, design: Design) -> Ended:
    """Work out the results of a point, after a look whether all of its tasks are there and undamaged."""
    store = _open(path, end.point.study)
    effort = end.point.effort
    rows, good, counted = store.read(end.point.number, 0, end.blocks * effort.batches)
    if not good.all():
        return Ended(damaged=sorted({int(i) // effort.task_batches for i in np.flatnonzero(~good)}))
    if end.known:
        there = store.read_large(store.large_arrays(design), end.place)
        if there is not None and _digest(counted, digest_of(there), end.small) == end.known:
            return Ended(unchanged=True)
    found = evaluate(end.point, rows)
    if not effort.is_enough(found, end.blocks):
        return Ended(enough=False)
    store.ensure(found, design)
    store.write_large(found, end.place)
    kept = found[small(found) + common(found)]
    digest = _digest(
        counted, digest_of(_arrays(found, large(found))), digest_of(_arrays(found, small(found)))
    )
    return Ended(found=kept, digest=digest)


def digest_of(arrays: Arrays) -> bytes:
    """Give a digest of names and values."""
    digest = hashlib.blake2b(digest_size=32)
    for name in sorted(arrays):
        digest.update(name.encode())
        digest.update(np.ascontiguousarray(arrays[name]).tobytes())
    return digest.digest()


def _digest(counted: bytes, large_ones: bytes, small_ones: bytes) -> bytes:
    return hashlib.blake2b(counted + large_ones + small_ones, digest_size=32).digest()


def _arrays(found: xr.Dataset, names: list[str]) -> Arrays:
    return {name: found.variables[name].to_numpy() for name in names}


@lru_cache(maxsize=4)
def _open(path: str, study: bytes) -> Store:
    try:
        return Store(Path(path), study)
    except FileNotFoundError as error:
        raise FileNotFoundError(
            error.errno, "not found by a worker; the store must be where all workers reach it", path
        ) from None


def _teller(stop: threading.Event | None) -> Tell | None:
    if stop is None:
        return None

    def tell(_: int) -> None:
        if stop.is_set():
            raise Stopped

    return tell
