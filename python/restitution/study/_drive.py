"""Tasks of a study and its driver: what a worker does, which tasks are to be done, what the store shows."""

import errno
import hashlib
import os
import random
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from queue import Empty, SimpleQueue
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution.study._axes import Design
from restitution.study._point import Point, Tell, count, evaluate, point_of
from restitution.study._store import Store, large, small
from restitution.study._study import Study
from restitution.study._tables import Effort
from restitution.study.engines import Engine

_CONTINUES = "what is finished is in the store, and the same command continues"
_SHARE = 20  # what is found is written out so seldom that it takes a twentieth of the time


class Stopped(Exception):
    """The study was asked to stop."""


@dataclass(frozen=True)
class Ended:
    """The end of a point: tasks that are damaged, that it needs more particles, or what was found.

    Larger variables are written by the worker; of points whose results are there nothing is found.
    """

    damaged: list[int] = field(default_factory=list)
    enough: bool = True
    found: xr.Dataset | None = None
    digest: bytes = b""


def run_task(path: str, point: Point, number: int, stop: threading.Event | None = None) -> bool:
    """Count a range of particles of a point and commit it; return whether that had been done already."""
    store = _open(path, point.digest)
    if store.has(point.number, number):
        return True
    first = number * point.study.effort.task_batches
    batches = range(first, first + point.study.effort.task_batches)
    tell = _teller(stop)
    store.write(
        point.number, first, np.stack([count(point, point.study.effort.part(b), tell) for b in batches])
    )
    return False


def end_point(path: str, point: Point, design: Design, blocks: int, known: bytes, small_ones: bytes) -> Ended:
    """Work out the results of a point, after a look whether all of its tasks are there and undamaged.

    If they have been worked out before, `known` is the digest that they have in the store, else empty, and
    `small_ones` that of the smaller variables as the driver has read them.
    """
    store, effort, place = _open(path, point.digest), point.study.effort, design.place(point.number)
    rows, good, counted = store.read(point.number, 0, blocks * effort.batches)
    if not good.all():
        return Ended(damaged=sorted({int(i) // effort.task_batches for i in np.flatnonzero(~good)}))
    if known:
        there = store.read_large(store.large_arrays(design), place)
        if there is not None and _digest(counted, digest_of(there), small_ones) == known:
            return Ended()
    found = evaluate(point, rows)
    if not effort.is_enough(found, blocks):
        return Ended(enough=False)
    store.ensure(found, design)
    store.write_large(found, place)
    values = {str(name): variable.to_numpy() for name, variable in found.variables.items()}
    digests = (digest_of({name: values[name] for name in names}) for names in (large(found), small(found)))
    return Ended(found=found.drop_vars(large(found)), digest=_digest(counted, *digests))


def digest_of(arrays: Mapping[str, npt.NDArray[Any]]) -> bytes:
    """Return a digest of names and values."""
    digest = hashlib.blake2b(digest_size=32)
    for name in sorted(arrays):
        digest.update(name.encode())
        digest.update(np.ascontiguousarray(arrays[name]).tobytes())
    return digest.digest()


def _digest(*parts: bytes) -> bytes:
    return hashlib.blake2b(b"".join(parts), digest_size=32).digest()


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


@dataclass
class Progress:
    """Points and tasks, as far as they are known, those that ended, and of tasks what was found of them."""

    points: int
    tasks: int
    ended: int = 0
    computed: int = 0
    resumed: int = 0
    damaged: int = 0


@dataclass
class _Open:
    """A point under way: its blocks of particles, the digest that it has in the results, and its tasks."""

    point: Point
    blocks: int
    known: bytes
    waiting: set[int] = field(default_factory=set)
    done: set[int] = field(default_factory=set)
    damaged: set[int] = field(default_factory=set)


@dataclass
class Driver:
    """Brings points of a study to their end: all, or those of a shard.

    Tasks that are missing are computed unless `compute` is False; `template` is what a measure of recorded
    impacts gives. After every task `tell` is called with the progress.
    """

    study: Study
    store: Store
    engine: Engine
    template: xr.Dataset | None
    points: Sequence[int]
    compute: bool = True
    tell: Callable[[Progress], None] | None = None

    def __post_init__(self) -> None:
        self.progress = Progress(len(self.points), len(self.points) * self.study.effort.block_tasks)
        self.table = Table(self.study.design, self.store)
        # Jobs are a point and the number of its task, or None for its end.
        self._ready: deque[tuple[_Open, int | None]] = deque()
        self._under_way: dict[Future[Any], tuple[_Open, int | None]] = {}
        self._ended: SimpleQueue[Future[Any]] = SimpleQueue()

    def run(self, *, writes: bool) -> None:
        """Run all tasks; with `writes` results are gathered, else they are left to a merge."""
        with _first_at(self.store) as alone:
            waiting = iter(self.points if alone else random.sample(self.points, len(self.points)))
            shown, pause = time.monotonic(), 0.0
            try:
                while self._fill(waiting):
                    done = self._wait()
                    for future in done:
                        self._take(*self._under_way.pop(future), future)
                    # The clock decides nothing but when to write out.
                    due = not 0.0 <= time.monotonic() - shown < max(10.0, _SHARE * pause)
                    if writes and alone and done and due:
                        start = time.monotonic()
                        self.table.write()
                        shown = time.monotonic()
                        pause = shown - start
            except BaseException:
                self.engine.stop()
                raise
            finally:
                if writes:
                    self.table.write()

    def _wait(self) -> "list[Future[Any]]":
        """Return the tasks that have ended since; none after a second.

        `concurrent.futures.wait` takes a lock of each future, and a signal between two of them leaves it
        locked: the worker then waits for ever, and who stops the workers for the worker.
        """
        found: list[Future[Any]] = []
        with suppress(Empty):
            found.append(self._ended.get(timeout=1.0))
            while True:
                found.append(self._ended.get_nowait())
        return found

    def _fill(self, waiting: Iterator[int]) -> bool:
        """Submit as many jobs as there is room for; return whether any is running."""
        room = self.engine.room
        while len(self._under_way) < room:
            if not self._ready:
                number = next(waiting, None)
                if number is None:
                    break
                self._begin(number)
                continue
            opened, task = self._ready.popleft()
            try:
                future = self._submit(opened, task)
            except RuntimeError as error:  # no thread is to be had, or the scheduler of a client is gone
                raise RuntimeError(f"{error}; {_CONTINUES}") from None
            self._under_way[future] = opened, task
            future.add_done_callback(self._ended.put)
        return bool(self._under_way)

    def _submit(self, opened: _Open, task: int | None) -> "Future[Any]":
        path, point, design = str(self.store.path), opened.point, self.study.design
        if task is not None:
            return self.engine.submit(run_task, path, point, task, stoppable=True)
        small_ones = self.table.digest(point.number) if opened.known else b""
        return self.engine.submit(end_point, path, point, design, opened.blocks, opened.known, small_ones)

    def _begin(self, number: int) -> None:
        known, blocks = self.table.known(number, self.study.effort)
        self.progress.tasks += (blocks - 1) * self.study.effort.block_tasks
        if number == self.points[0]:  # is worked out again, to look at what all points have in common
            known = b""
        opened = _Open(point_of(self.study, number, self.template), blocks, known)
        self._need(opened, self.store.there(number))

    def _need(self, opened: _Open, there: set[int]) -> None:
        """Submit the tasks that a point lacks, or end the point if it lacks none."""
        needed = set(range(opened.blocks * self.study.effort.block_tasks))
        self.progress.resumed += len((needed & there) - opened.done)
        opened.done |= needed & there
        lacking = needed - opened.done
        if not lacking:
            self._ready.appendleft((opened, None))
        elif self.compute:
            opened.waiting = lacking
            self._ready.extendleft((opened, task) for task in sorted(lacking, reverse=True))

    def _take(self, opened: _Open, task: int | None, future: "Future[Any]") -> None:
        """Store the result of a worker."""
        try:
            result = future.result()
        except (CancelledError, Stopped):
            raise RuntimeError(f"the tasks were given up; {_CONTINUES}") from None
        except ValueError as error:
            raise ValueError(f"{self.study.where(opened.point.number)}: {error}") from error
        if task is None:
            self._end(opened, result)
        else:
            opened.waiting.discard(task)
            opened.done.add(task)
            self.progress.resumed += result
            self.progress.computed += not result
            if not opened.waiting:
                self._need(opened, set())
        if self.tell is not None:
            self.tell(self.progress)

    def _end(self, opened: _Open, ended: Ended) -> None:
        number, damaged = opened.point.number, set(ended.damaged)
        opened.known = b""
        if damaged:
            if self.compute and damaged & opened.damaged:
                file = self.store.file(number, min(damaged & opened.damaged))
                raise OSError(errno.EIO, f"damaged when it was read back; {_CONTINUES}", str(file))
            opened.damaged |= damaged
            self.progress.damaged += len(self.store.there(number) & damaged)
            self.progress.resumed -= len(opened.done & damaged)
            opened.done -= damaged
            self._need(opened, set())
        elif not ended.enough:
            self.progress.tasks += opened.blocks * self.study.effort.block_tasks
            opened.blocks *= 2
            self._need(opened, self.store.there(number))
        else:
            self.progress.ended += 1
            if ended.found is not None:
                self.table.set(number, ended.found, ended.digest)


class Table:
    """The smaller variables of all points, in memory until they are written out together."""

    def __init__(self, design: Design, store: Store) -> None:
        self.design, self.store = design, store
        self._template: xr.Dataset | None = None
        self._values = store.read_small(design)  # what cannot be read is worked out again
        self._changed = False

    def known(self, point: int, effort: Effort) -> tuple[bytes, int]:
        """Return the digest of a point that is finished, and its number of blocks."""
        values = self._values
        if not {"status", "digest", "particles"} <= values.keys() or values["status"][point] != 1:
            return b"", 1
        blocks = int(values["particles"][point]) // effort.particles
        good = 1 <= blocks <= effort.blocks
        return (values["digest"][point].tobytes(), blocks) if good else (b"", 1)

    def digest(self, point: int) -> bytes:
        """Return the digest of the results of a point."""
        extra = ("status", "digest")
        return digest_of({name: values[point] for name, values in self._values.items() if name not in extra})

    def set(self, point: int, found: xr.Dataset, digest: bytes) -> None:
        """Store the results of a point."""
        words = np.frombuffer(digest, np.uint64)
        if self._template is None:
            about = {"long_name": "digest of the results of the point and of the counts behind them"}
            self._template = found.assign(digest=("digest_word", words, about))
            self.store.ensure(self._template, self.design)
        for name in small(found):
            self._put(name, point, found.variables[name].to_numpy())
        self._put("digest", point, words)
        self._put("status", point, np.array(1, np.uint8))

    def _put(self, name: str, point: int, value: npt.NDArray[Any]) -> None:
        there = self._values.get(name)
        if there is None or there.shape[1:] != value.shape:
            fill = np.nan if value.dtype.kind == "f" else 0
            there = self._values[name] = np.full((self.design.points, *value.shape), fill, value.dtype)
            self._changed = True
        if there[point].tobytes() != value.tobytes():
            there[point] = value
            self._changed = True

    def write(self) -> None:
        """Write everything out, if anything has changed."""
        if self._changed:
            self.store.write_small(self._values)
            self._changed = False


@contextmanager
def _first_at(store: Store) -> Iterator[bool]:
    """Find out whether no other driver of this machine works on the store.

    Two begin with different points, and one alone writes out results meanwhile. Nothing else depends on it:
    each looks whether a task is there before it begins it, and both write the same bits.
    """
    try:
        import fcntl
    except ImportError:  # Windows
        yield True
        return
    handle = os.open(store.path, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        alone = True
    except OSError:
        alone = False
    try:
        yield alone
    finally:
        os.close(handle)
