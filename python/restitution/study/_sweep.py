"""`sweep` and `merge`: a study from its file to its results, on one machine or many; `estimate`: its cost."""

import random
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import flag, several, whole
from restitution._internal.files import ZARR, path_for, path_from, there
from restitution._internal.parameters import ParameterError, Problem, shown, wrong
from restitution._internal.resources import bar as bar_of
from restitution.study._axes import Design
from restitution.study._drive import Driver, Progress
from restitution.study._identity import check
from restitution.study._point import count, point_of, with_template
from restitution.study._results import Status, open_store, status, study_in
from restitution.study._store import Store, create_or_open, need_zarr
from restitution.study._study import Study, study_of
from restitution.study.engines import engine

# Of an estimate: points that are tried at first; seconds in which particles of a point are timed, in which
# all particles of these points must be done to be tried whole, and after which no more points are tried.
_POINTS, _ENOUGH, _WHOLE, _LONG = 12, 0.05, 2.0, 1.0


def sweep(
    study: Any,
    out: str | Path = "study.zarr",
    client: Any = None,
    *,
    threads: int | None = None,
    shard: tuple[int, int] | None = None,
    progress: bool = False,
) -> xr.Dataset:
    """Run a study: a run whose parameters are varied, and what is measured at every point.

    Every task, a point and a range of its particles, is in the store as soon as it is done. The same call
    resumes a study that was stopped for any reason. What is damaged is named in an error; delete it, and the
    same call computes it again. The result has the same bits as that of an uninterrupted study, for any
    engine, number of workers and order in which they finish. Several calls may work on one store at a time.

    Parameters
    ----------
    study : str, Path or mapping
        A TOML file or its tables; docs/studies.md has all of them. In a mapping ``body`` and ``law`` may be a
        body and a law, and ``measure`` a function of a Dataset. Several bodies, tables ``[[body]]`` with
        names, in a mapping a list or ``{name: body}``, are an axis themselves: ``body``, their numbers from
        0, whose names are in its attributes.
    out : str or Path
        The store, a directory in Zarr format 3.
    client : distributed.Client, optional
        A Dask cluster, whose workers must reach `out` under the same path. Without it, threads of this
        machine.
    threads : int, optional
        Number of threads of this machine; one per core by default. Never changes the result.
    shard : (int, int), optional
        (3, 64) computes the third of 64 parts of the points, without a scheduler; `merge` joins them.
    progress : bool
        Show a progress bar on standard error, with the time that is left.

    Returns
    -------
    xarray.Dataset
        Opened, not loaded. A numeric dimension for each parameter that is varied, or ``point`` if the design
        is not a grid; ``status`` shows which points are finished, ``particles`` how many particles each has.
        What is measured has a variable ``…_error`` beside it, its standard error: of a jackknife over groups
        of particles. With statistics, all that `restitution.statistics` returns and ``std_restitution``,
        ``second_moment`` (<ε²>) and ``density``.

    Raises
    ------
    ValueError
        Naming everything that is wrong with the study; or if `out` is the store of another study or of
        another version of the physics, with what differs.
    OSError
        If the store cannot be written, as when the disk is full. What is finished stays.

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
    ...     "sweep": {"body.separation": [1e-4, 3e-4], "law.normal": [0.9, 0.98]},
    ... }
    >>> found = rs.sweep(study, out=tempfile.mkdtemp() + "/study.zarr")
    >>> found["std_restitution"].dims
    ('separation', 'normal', 'velocity')
    """
    progress = flag("progress", progress)
    wanted = study_of(study)
    points = _shard(shard, wanted.design.points)
    path = path_from("out", out)
    need_zarr()
    if there(path):
        check(path, wanted)
    else:
        path_for("out", path, ZARR)
    with engine(client, threads) as work:
        store, template = opened(path, wanted)
        with _bar(len(points) * wanted.effort.block_tasks, show=progress) as tell:
            Driver(wanted, store, work, template, points, tell=tell).run(writes=shard is None)
    return open_store(path)


def merge(
    out: str | Path, parts: Sequence[str | Path] = (), *, study: Any = None, threads: int | None = None
) -> Status:
    """Merge the tasks of several stores into one, and compute the results of all points that are complete.

    Parameters
    ----------
    out : str or Path
        The store; it is made if it is not there. One that several shards wrote to needs no other parts.
    parts : sequence of str or Path
        Other stores of the same study; they are left as they are.
    study : optional
        As in `sweep`; needed where the study has a function that no file can name.
    threads : int, optional
        As in `sweep`.

    Returns
    -------
    Status
        What the store holds now.

    Raises
    ------
    ValueError
        If the stores are not of one study and one version of the physics, with what differs.

    Examples
    --------
    >>> import tempfile
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    >>> study = {"body": body, "law": law, "sweep": {"law.normal": [0.8, 0.9]}, "first_impact": {}}
    >>> folder = tempfile.mkdtemp()
    >>> parts = [f"{folder}/{number}.zarr" for number in (1, 2)]
    >>> for number, part in enumerate(parts, start=1):  # as on two machines
    ...     found = rs.sweep(study, out=part, shard=(number, 2))
    >>> rs.study.merge(folder + "/both.zarr", parts).finished
    2
    """
    if isinstance(parts, str | bytes) or not isinstance(parts, Sequence):
        raise ParameterError(wrong("parts", parts, "a list of paths"))
    path = path_from("out", out)
    others = several("parts", parts, "a list of paths", lambda i, part: path_from(f"parts[{i}]", part))
    need_zarr()
    if not there(path):
        if not others:
            text = f" = {shown(str(out))}: there is no such store, and no parts for it"
            raise ParameterError(Problem("out", text))
        path_for("out", path, ZARR)
    wanted = study_of(study if study is not None else study_in(path if there(path) else others[0]))
    for part in others:
        check(part, wanted)
    points = range(wanted.design.points)
    with engine(None, threads) as work:
        store, template = opened(path, wanted)
        for part in others:
            other = Store(part)
            other.check_layout(wanted, store.words.shape[2])
            _copy(other, store, wanted)
        Driver(wanted, store, work, template, points, compute=False).run(writes=True)
    return status(path)


def opened(path: Path, wanted: Study) -> tuple[Store, xr.Dataset | None]:
    """Open the store of a study or make it; give what a measure of recorded impacts gives, too."""
    first = with_template(point_of(wanted, 0))
    words = count(first, (0, 1)).size
    return create_or_open(path, wanted, words), first.template


def _shard(shard: tuple[int, int] | None, points: int) -> Sequence[int]:
    """Take the points of a shard."""
    if shard is None:
        return range(points)
    good = isinstance(shard, tuple | list) and len(shard) == 2 and all(type(n) is int for n in shard)
    if not good or not 1 <= shard[0] <= shard[1]:
        raise ParameterError(wrong("shard", shard, "(i, n) with 1 <= i <= n"))
    return range(shard[0] - 1, points, shard[1])


def _copy(part: Store, store: Store, wanted: Study) -> None:
    """Copy the tasks that are in one store and not in the other."""
    number = wanted.effort.task_batches
    for point in range(wanted.design.points):
        for task in sorted(part.there(point) - store.there(point)):
            store.write(point, task * number, part.read(point, task * number, number))


@contextmanager
def _bar(total: int, *, show: bool) -> Iterator[Callable[[Progress], None]]:
    """Show a bar of the tasks; yield what takes the progress."""
    with bar_of(show=show, total=total, desc="sweep", unit=" tasks", smoothing=0.05) as bar:

        def tell(progress: Progress) -> None:
            bar.total = progress.tasks
            # The time left follows from what was computed, not from what was there.
            bar.initial = progress.resumed
            points = f"{progress.ended}/{progress.points}"
            bar.set_postfix(points=points, resumed=progress.resumed, refresh=False)
            bar.update(progress.computed + progress.resumed - bar.n)

        yield tell


@dataclass(frozen=True)
class Estimate:
    """The cost of a study.

    Attributes
    ----------
    points, tasks, particles : int
        Of all points; with `until`, what each of them begins with.
    seconds : float
        Processor time of these particles, on a machine like this one.
    threads : int
        Threads that will share it.
    store : int or None
        Bytes of the store; None where a point is too large to be tried whole.
    most : int
        How many times as many particles a point may get until a standard error is reached.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    >>> study = {"body": body, "law": law, "sweep": {"law.normal": [0.8, 0.9]}, "first_impact": {}}
    >>> cost = rs.study.estimate(rs.study.study_of(study), threads=2)
    >>> cost.points, cost.particles, cost.seconds > 0
    (2, 2000, True)
    """

    points: int
    tasks: int
    particles: int
    seconds: float
    threads: int
    store: int | None
    most: int

    def __str__(self) -> str:
        size = "" if self.store is None else f" The store takes {self.store / 1e6:.2g} MB."
        more = f", and at most {self.most} times as many until the standard error is reached"
        share = f", which {self.threads} threads share" if self.threads > 1 else ""
        return (
            f"The study has {self.points} points in {self.tasks} tasks, with {self.particles} particles"
            f"{more if self.most > 1 else ''}.\n"
            f"These take {duration(self.seconds)} of processor time{share}.{size}"
        )


def estimate(study: Study, threads: int) -> Estimate:
    """Try a few points, spread over the design, in a store that is thrown away.

    Parameters
    ----------
    study : Study
        The study.
    threads : int
        Threads that will share the work.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    >>> study = {"body": body, "law": law, "sweep": {"law.normal": [0.8, 0.9]}, "first_impact": {}}
    >>> rs.study.estimate(rs.study.study_of(study), threads=2).points
    2
    """
    if not isinstance(study, Study):
        raise ParameterError(wrong("study", study, "a Study, as from study_of"))
    threads = whole("threads", threads, 1)
    need_zarr()
    points, particles = study.design.points, study.effort.particles
    tried = min(points, _POINTS)
    each = float(np.mean([_particle(_some(study, tried), number) for number in range(tried)]))
    given = study.base.orientations is not None or study.base.spins is not None  # one for each particle
    whole_ones = given or tried * particles * each < _WHOLE
    some = particles if whole_ones else max(2 * study.effort.batches, int(_WHOLE / (tried * each)))
    _done(_some(study, 1), some)  # the first one loads what all need
    first, _, _ = _done(_some(study, 1), some)
    seconds, results, other = _done(_some(study, tried), some)
    while seconds - first < _LONG and tried < points:
        tried = min(points, 3 * tried)
        seconds, results, other = _done(_some(study, tried), some)
    more = max(0.0, seconds - first) / max(1, tried - 1) + each * (particles - some)
    return Estimate(
        points=points,
        tasks=points * study.effort.block_tasks,
        particles=points * particles,
        seconds=first + each * (particles - some) + (points - 1) * more,
        threads=threads,
        store=round(results * points / tried + other) if whole_ones else None,
        most=study.effort.blocks,
    )


def _some(study: Study, number: int) -> Study:
    """Make a study of points that are chosen by chance, the same ones always."""
    design = study.design
    chosen = [design.values(i) for i in random.Random(1).sample(range(design.points), number)]
    axes = (replace(axis, values=tuple(one[axis.parameter] for one in chosen)) for axis in design.axes)
    return replace(study, design=Design("points", tuple(axes)))


def _particle(study: Study, number: int) -> float:
    """Return the processor time of a particle of a point."""
    point, particles = with_template(point_of(study, number)), 2
    while True:
        start = time.process_time()
        count(point, (0, particles))
        took = time.process_time() - start
        if took >= _ENOUGH or particles == study.effort.particles:
            return took / particles
        particles = min(study.effort.particles, 4 * particles)


def _done(study: Study, particles: int) -> tuple[float, int, int]:
    """Run a study with so many particles; return processor time, bytes of results and of all else."""
    effort = replace(study.effort, particles=particles, blocks=1, until=())
    study = replace(study, base=study.base.model_copy(update={"particles": particles}), effort=effort)
    with tempfile.TemporaryDirectory() as folder, engine(None, 1) as work:
        path = Path(folder) / "study.zarr"
        start = time.process_time()
        store, template = opened(path, study)
        Driver(study, store, work, template, range(study.design.points)).run(writes=True)
        took = time.process_time() - start
        sizes = {file: file.stat().st_size for file in path.rglob("*") if file.is_file()}
        other = sum(size for file, size in sizes.items() if file.name == "zarr.json")
        return took, sum(sizes.values()) - other, other


def duration(seconds: float) -> str:
    """Write a time as a person would."""
    for unit, size in (("d", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.2g} s" if seconds < 100 else f"{seconds:.0f} s"
