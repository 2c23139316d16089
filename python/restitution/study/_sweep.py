"""`sweep`: a study from its file to its results."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import xarray as xr

from restitution._internal.arrays import flag
from restitution._internal.files import ZARR, check_name, path_from
from restitution._internal.parameters import ParameterError, wrong
from restitution._internal.process import tell as say
from restitution._internal.resources import bar as bar_of
from restitution.study._create import create_or_open
from restitution.study._drive import Driver, Progress
from restitution.study._estimate import estimate
from restitution.study._identity import check
from restitution.study._point import count, point_of, with_template
from restitution.study._status import open_store
from restitution.study._store import Store, need_zarr
from restitution.study._study import Study, study_of
from restitution.study.engines import engine, width


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
    resumes a study that was stopped, for whatever reason; tasks that are missing or damaged are computed
    again. The result has the same bits as that of an uninterrupted study, whatever the engine, the number of
    workers and the order in which they finish. Several calls may work on one store at a time.

    Parameters
    ----------
    study : str, Path or mapping
        A TOML file or its tables; docs/studies.md has all of them. In a mapping ``body`` and ``law`` may be a
        body and a law, and ``measure`` a function of a Dataset.
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
        Show an estimate of the cost and a progress bar on standard error.

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
    need_zarr(path, width(client, threads))
    if path.exists():
        check(path, wanted)
    else:
        check_name("out", path, ZARR)
    with engine(client, threads) as work:
        if progress:
            say(str(estimate(wanted, max(1, work.room // 2 - 1), len(points))))
        store, template = opened(path, wanted)
        with _bar(len(points) * wanted.effort.block_tasks, show=progress) as tell:
            driver = Driver(wanted, store, work, template, points, tell=tell)
            driver.run(writes=shard is None)
    return open_store(path)


def _shard(shard: tuple[int, int] | None, points: int) -> Sequence[int]:
    if shard is None:
        return range(points)
    good = isinstance(shard, tuple | list) and len(shard) == 2 and all(type(n) is int for n in shard)
    if not good or not 1 <= shard[0] <= shard[1]:
        raise ParameterError(wrong("shard", shard, "(i, n) with 1 <= i <= n"))
    return range(shard[0] - 1, points, shard[1])


def opened(path: Path, wanted: Study) -> tuple[Store, xr.Dataset | None]:
    """Open the store of a study or make it; give what a measure of recorded impacts gives, too."""
    first = with_template(point_of(wanted, 0))
    words = count(first, (0, 1), None).size
    store, _ = create_or_open(path, wanted, words)
    return store, first.template


@contextmanager
def _bar(total: int, *, show: bool) -> Iterator[Any]:
    if not show:
        yield None
        return
    with bar_of(show=True, total=total, desc="sweep", unit=" tasks", smoothing=0.05) as bar:

        def tell(progress: Progress) -> None:
            bar.total = progress.tasks
            # The time left follows from what was computed, not from what was there.
            bar.initial = progress.resumed
            more = {"points": f"{progress.ended}/{progress.points}", "resumed": progress.resumed}
            if progress.damaged:
                more["damaged"] = progress.damaged
            bar.set_postfix(more, refresh=False)
            bar.update(progress.computed + progress.resumed - bar.n)

        yield tell
