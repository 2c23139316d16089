"""The driver of a study: which tasks are to be done, which points have ended, what the store shows."""

import errno
import os
import random
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from queue import Empty, SimpleQueue
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.files import remove_old_drafts
from restitution.study._axes import Design
from restitution.study._effort import Effort
from restitution.study._point import Point, point_of
from restitution.study._store import Store, small
from restitution.study._study import Study
from restitution.study._work import End, Ended, Stopped, Task, digest_of, end_point, run_task
from restitution.study.engines import Engine

Tell = Callable[["Progress"], None]

_CONTINUES = "what is finished is in the store, and the same command continues"
_ATTEMPTS = 3
"""So often a task is done that is read back damaged: what spoils it is the disk, or another program."""
_SHARE = 20
"""What is found is written out so seldom that it takes a twentieth of the time."""


@dataclass
class Progress:
    """What has been done.

    Attributes
    ----------
    points, tasks : int
        Of the study, as far as is known: points that need more particles add tasks.
    ended, computed, resumed, damaged : int
        Points that are finished; tasks that were computed, that were there already, and, of those computed,
        that stood there damaged.
    """

    points: int
    tasks: int
    ended: int = 0
    computed: int = 0
    resumed: int = 0
    damaged: int = 0


@dataclass
class _Open:
    """A point under way."""

    point: Point
    blocks: int = 1
    waiting: set[int] = field(default_factory=set)
    done: set[int] = field(default_factory=set)
    damaged: Counter[int] = field(default_factory=Counter)


class Driver:
    """Brings a study to its end.

    Parameters
    ----------
    study : Study
        The study.
    store : Store
        Its store.
    engine : Engine
        Who does the work.
    template : xarray.Dataset or None
        What a measure of recorded impacts gives.
    points : sequence of int
        Points that this driver is to bring to their end; all, or those of a shard.
    compute : bool
        Whether tasks that are missing are computed, or their points left.
    tell : callable or None
        Called with the progress after every task.
    """

    def __init__(
        self,
        study: Study,
        store: Store,
        engine: Engine,
        template: xr.Dataset | None,
        points: Sequence[int],
        *,
        compute: bool = True,
        tell: Tell | None = None,
    ) -> None:
        self.study, self.store, self.engine, self.template = study, store, engine, template
        self.points, self.compute, self._tell = points, compute, tell
        self.progress = Progress(len(points), len(points) * study.effort.block_tasks)
        self.table = Table(study.design, store)
        self._ready: deque[tuple[_Open, Task | End]] = deque()
        self._under_way: dict[Future[Any], tuple[_Open, Task | End]] = {}
        self._ended: SimpleQueue[Future[Any]] = SimpleQueue()

    def run(self, *, writes: bool) -> None:
        """Do all that is to be done; `writes` says whether results are gathered, or left to a merge."""
        with _first_at(self.store) as alone:
            if alone:
                remove_old_drafts(self.store.path)
            waiting = iter(self.points if alone else random.sample(self.points, len(self.points)))
            shown = time.monotonic()
            pause = 0.0
            try:
                while self._fill(waiting):
                    done = self._wait()
                    for future in done:
                        opened, job = self._under_way.pop(future)
                        self._take(opened, job, future)
                    # The clock decides nothing but when to write out.
                    if (
                        writes
                        and alone
                        and done
                        and not 0.0 <= time.monotonic() - shown < max(10.0, _SHARE * pause)
                    ):
                        start = time.monotonic()
                        self.table.write()
                        shown = time.monotonic()
                        pause = shown - start
            except BaseException:
                self.engine.stop()
                if writes:
                    self.table.write()
                raise
            if writes:
                self.table.write()

    def _wait(self) -> "list[Future[Any]]":
        """Give what has ended since; nothing after a second.

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
        """Submit as many tasks as there is room for; return whether any is running."""
        room = self.engine.room
        while len(self._under_way) < room:
            if not self._ready:
                number = next(waiting, None)
                if number is None:
                    break
                self._begin(number)
                continue
            opened, job = self._ready.popleft()
            try:
                future = self._submit(job)
            except RuntimeError as error:  # of a client whose scheduler is gone
                raise RuntimeError(f"{error}; {_CONTINUES}") from None
            self._under_way[future] = opened, job
            future.add_done_callback(self._ended.put)
        return bool(self._under_way)

    def _submit(self, job: Task | End) -> "Future[Any]":
        path = str(self.store.path)
        if isinstance(job, Task):
            return self.engine.submit(run_task, path, job, stoppable=True)
        return self.engine.submit(end_point, path, job, self.study.design)

    def _begin(self, number: int) -> None:
        opened = _Open(point_of(self.study, number, self.template))
        there = self.store.there(number)
        known, blocks = self.table.known(number, self.study.effort)
        if number == self.points[0]:  # is worked out again, to look at what all points have in common
            known = b""
        if known:
            opened.blocks = blocks
            self.progress.tasks += (blocks - 1) * self.study.effort.block_tasks
        self._need(opened, there, known)

    def _need(self, opened: _Open, there: set[int], known: bytes = b"") -> None:
        """Have the tasks done that a point lacks, or end it if it lacks none."""
        needed = set(range(opened.blocks * self.study.effort.block_tasks))
        self.progress.resumed += len((needed & there) - opened.done)
        opened.done |= needed & there
        lacking = needed - opened.done
        if not lacking:
            place = self.study.design.place(opened.point.number)
            small = self.table.digest(opened.point.number) if known else b""
            self._ready.appendleft((opened, End(opened.point, place, opened.blocks, known, small)))
        elif self.compute:
            opened.waiting = lacking
            self._ready.extendleft(
                (opened, Task(opened.point, number)) for number in sorted(lacking, reverse=True)
            )

    def _take(self, opened: _Open, job: Task | End, future: "Future[Any]") -> None:
        """Take what a worker has done."""
        try:
            result = future.result()
        except (CancelledError, Stopped):
            raise RuntimeError(f"the tasks were given up; {_CONTINUES}") from None
        except ValueError as error:
            here = ", ".join(
                f"{k} = {v:.6g}" for k, v in self.study.design.values(opened.point.number).items()
            )
            raise ValueError(f"at {here}: {error}") from error
        if isinstance(job, Task):
            opened.waiting.discard(job.number)
            opened.done.add(job.number)
            if result:
                self.progress.resumed += 1
            else:
                self.progress.computed += 1
            if not opened.waiting:
                self._need(opened, set())
        else:
            self._end(opened, result)
        if self._tell is not None:
            self._tell(self.progress)

    def _end(self, opened: _Open, ended: Ended) -> None:
        effort = self.study.effort
        if ended.damaged:
            there = self.store.there(opened.point.number)
            self.progress.damaged += len(there & set(ended.damaged))
            self.progress.resumed -= len(opened.done & set(ended.damaged))
            opened.done -= set(ended.damaged)
            opened.damaged.update(ended.damaged)
            for task, times in opened.damaged.items():
                if self.compute and times > _ATTEMPTS:
                    file, found = self.store.fault(opened.point.number, task)
                    text = f"written {_ATTEMPTS} times, and damaged when it was read back ({found})"
                    raise OSError(errno.EIO, f"{text}; {_CONTINUES}", str(file))
            self._need(opened, set())
        elif not ended.enough:
            self.progress.tasks += opened.blocks * effort.block_tasks
            opened.blocks *= 2
            self._need(opened, self.store.there(opened.point.number))
        else:
            self.progress.ended += 1
            if ended.found is not None:
                self.table.set(opened.point.number, ended.found, ended.digest)


class Table:
    """The smaller variables of all points, in memory until they are written out together."""

    def __init__(self, design: Design, store: Store) -> None:
        self.design, self.store = design, store
        self._template: xr.Dataset | None = None
        self._values: dict[str, npt.NDArray[Any]] = {}
        self._changed = False
        self._read()

    def _read(self) -> None:
        """Take what the store shows; what cannot be read is worked out again."""
        own = len(self.design.shape)
        shape = self.design.shape
        coordinates = {axis.name for axis in self.design.axes}
        big = set(self.store.large_arrays(self.design))
        for name, array in self.store.arrays():
            if (
                name in big
                or name in coordinates
                or array.shape[:own] != shape
                or not _by_point(array, self.design)
            ):
                continue
            try:
                values = np.asarray(array[...])
            except PermissionError:
                raise
            except Exception:  # cut or spoilt, in any way that a decoder can tell
                continue
            self._values[name] = values.reshape(self.design.points, *array.shape[own:])

    def known(self, point: int, effort: Effort) -> tuple[bytes, int]:
        """Give the digest of a point that is finished, and its number of blocks."""
        values = self._values
        if (
            not all(name in values for name in ("status", "digest", "particles"))
            or values["status"][point] != 1
        ):
            return b"", 1
        blocks = int(values["particles"][point]) // effort.particles
        good = 1 <= blocks <= effort.blocks
        return (values["digest"][point].tobytes(), blocks) if good else (b"", 1)

    def digest(self, point: int) -> bytes:
        """Give the digest of what is known of a point."""
        extra = ("status", "digest")
        return digest_of({name: values[point] for name, values in self._values.items() if name not in extra})

    def set(self, point: int, found: xr.Dataset, digest: bytes) -> None:
        """Take what was found at a point."""
        marks = {"digest": np.frombuffer(digest, np.uint64)}
        if self._template is None:
            about = {"long_name": "digest of the results of the point and of what they rest on"}
            self._template = found.assign(digest=("digest_word", marks["digest"], about))
            self.store.ensure(self._template, self.design)
            self.store.restore(found, self.design)
        for name in small(found):
            self._put(name, point, found.variables[name].to_numpy())
        self._put("digest", point, marks["digest"])
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
        """Write everything out, the marks of what is finished last."""
        if not self._changed:
            return
        for name in sorted(self._values, key=lambda name: (name == "status", name)):
            array = self.store.group[name]
            array[...] = self._values[name].reshape(array.shape)
        self.store.consolidate()
        self._changed = False


def _by_point(array: Any, design: Design) -> bool:
    names = array.metadata.dimension_names or ()
    return tuple(names[: len(design.dims)]) == design.dims


@contextmanager
def _first_at(store: Store) -> Iterator[bool]:
    """Whether no other driver of this machine works on the store: two then begin with different points.

    Nothing else depends on it: each looks whether a task is there before it begins it, and both write the
    same bits.
    """
    try:
        import fcntl
    except ImportError:
        yield True
        return
    handle = os.open(store.path, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            alone = True
        except OSError:
            alone = False
        yield alone
    finally:
        os.close(handle)
