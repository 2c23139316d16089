"""Tasks of a study and its driver: what a worker does, which tasks are to be done, what the store shows."""

import hashlib
import os
import random
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
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

from restitution._internal.files import there
from restitution.study._axes import Design
from restitution.study._point import Point, count, evaluate, point_of
from restitution.study._store import Store, large, small
from restitution.study._study import Study
from restitution.study._tables import Effort
from restitution.study.engines import Engine

_CONTINUES = "what is finished is in the store, and the same command continues"
_SHARE = 20  # what is found is written out so seldom that it takes a twentieth of the time


class Stopped(Exception):
    """The study was asked to stop."""


def run_task(path: str, point: Point, number: int, stop: threading.Event | None) -> bool:
    """Count a range of particles of a point and commit it; return whether that had been done already."""
    store = _open(path, point.digest)
    if there(store.file(point.number, number)):
        return True
    first = number * point.study.effort.task_batches
    batches = range(first, first + point.study.effort.task_batches)

    def tell(_: int) -> None:
        if stop is not None and stop.is_set():
            raise Stopped

    rows = [count(point, point.study.effort.part(batch), tell) for batch in batches]
    store.write(point.number, first, np.stack(rows))
    return False


def end_point(path: str, point: Point, design: Design, blocks: int) -> xr.Dataset | None:
    """Work out the results of a point, and write the larger ones; None if it needs more particles."""
    store, effort, place = _open(path, point.digest), point.study.effort, design.place(point.number)
    found = evaluate(point, store.read(point.number, 0, blocks * effort.batches))
    if not effort.is_enough(found, blocks):
        return None
    store.ensure(found, design)
    store.write_large(found, place)
    return found.drop_vars(large(found))


@lru_cache(maxsize=4)
def _open(path: str, _: bytes) -> Store:
    """Open the store of the study that has this digest."""
    try:
        return Store(Path(path))
    except FileNotFoundError as error:
        raise FileNotFoundError(
            error.errno, "not found by a worker; the store must be where all workers reach it", path
        ) from None


@dataclass
class Progress:
    """Points and tasks, as far as they are known, those that ended, and of tasks what was found of them."""

    points: int
    tasks: int
    ended: int = 0
    computed: int = 0
    resumed: int = 0


@dataclass
class _Open:
    """A point under way: its blocks of particles, and the tasks that it waits for."""

    point: Point
    blocks: int
    waiting: set[int] = field(default_factory=set)


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
                if self.engine.event is not None:
                    self.engine.event.set()
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
            path, point, submit = str(self.store.path), opened.point, self.engine.executor.submit
            try:
                if task is None:
                    future: Future[Any] = submit(end_point, path, point, self.study.design, opened.blocks)
                else:
                    future = submit(run_task, path, point, task, self.engine.event)
            except RuntimeError as error:  # no thread is to be had, or the scheduler of a client is gone
                raise RuntimeError(f"{error}; {_CONTINUES}") from None
            self._under_way[future] = opened, task
            future.add_done_callback(self._ended.put)
        return bool(self._under_way)

    def _begin(self, number: int) -> None:
        finished = self.table.finished(number, self.study.effort)
        blocks, there = max(1, finished), self.store.there(number)
        self.progress.tasks += (blocks - 1) * self.study.effort.block_tasks
        tasks = range(blocks * self.study.effort.block_tasks)
        # The first one is worked out again, to look at what all points have in common.
        if finished and number != self.points[0] and there.issuperset(tasks):
            self.progress.resumed += len(tasks)
            self.progress.ended += 1
        else:
            self._need(_Open(point_of(self.study, number, self.template), blocks), tasks, there)

    def _need(self, opened: _Open, tasks: range, there: set[int]) -> None:
        """Submit those of these tasks of a point that are not there, or end the point if all are."""
        opened.waiting = set(tasks) - there
        self.progress.resumed += len(tasks) - len(opened.waiting)
        if not opened.waiting:
            self._ready.appendleft((opened, None))
        elif self.compute:
            self._ready.extendleft((opened, task) for task in sorted(opened.waiting, reverse=True))

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
            self.progress.resumed += result
            self.progress.computed += not result
            if not opened.waiting:
                self._ready.appendleft((opened, None))
        if self.tell is not None:
            self.tell(self.progress)

    def _end(self, opened: _Open, found: xr.Dataset | None) -> None:
        number = opened.point.number
        if found is None:
            done = opened.blocks * self.study.effort.block_tasks
            self.progress.tasks += done
            opened.blocks *= 2
            self._need(opened, range(done, 2 * done), self.store.there(number))
        else:
            self.progress.ended += 1
            self.table.set(number, found)


class Table:
    """The smaller variables of all points, in memory until they are written out together.

    Two drivers may write theirs at a time: the digest of a point says whether what is there belongs together.
    """

    def __init__(self, design: Design, store: Store) -> None:
        self.design, self.store = design, store
        self._template: xr.Dataset | None = None
        self._values = store.read_small(design)
        self._changed = False

    def finished(self, point: int, effort: Effort) -> int:
        """Return the number of blocks of a point that is finished, else 0."""
        values = self._values
        if not {"status", "digest", "particles"} <= values.keys() or values["status"][point] != 1:
            return 0
        if values["digest"][point].tobytes() != self._digest(point):
            return 0
        return int(values["particles"][point]) // effort.particles

    def _digest(self, point: int) -> bytes:
        digest = hashlib.blake2b(digest_size=32)
        for name in sorted(self._values.keys() - {"status", "digest"}):
            digest.update(name.encode() + np.ascontiguousarray(self._values[name][point]).tobytes())
        return digest.digest()

    def set(self, point: int, found: xr.Dataset) -> None:
        """Store the results of a point."""
        if self._template is None:
            about = {"long_name": "digest of the results of the point"}
            self._template = found.assign(digest=("digest_word", np.zeros(4, np.uint64), about))
            self.store.ensure(self._template, self.design)
        for name in small(found):
            self._put(name, point, found.variables[name].to_numpy())
        self._put("digest", point, np.frombuffer(self._digest(point), np.uint64))
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
    if sys.platform == "win32":
        yield True
        return
    import fcntl

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
