"""Reading of a store: progress of its study, results, a learned distribution, the study itself."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from restitution._internal.arrays import real, whole
from restitution._internal.files import path_from
from restitution._internal.parameters import ParameterError, Problem
from restitution.distribution import FluctuatingRestitution
from restitution.drop.dataset import attributes
from restitution.study._axes import design_again
from restitution.study._identity import Refused, identity, readable
from restitution.study._store import Store, need_zarr
from restitution.study._study import Study, study_of

_POOLED = "release_height"


@dataclass(frozen=True)
class Status:
    """Progress of a study.

    Attributes
    ----------
    points, finished : int
        Points of the study, and those whose results are there.
    tasks : int or None
        Tasks of the study; None where particles are added until a standard error is reached.
    there : int
        Tasks that are done.

    Examples
    --------
    >>> import restitution as rs
    >>> print(rs.study.Status(points=2, finished=2, tasks=2, there=2))  # as `status` finds it
    2 of 2 points are finished (100 %), and 2 of 2 tasks are done.
    """

    points: int
    finished: int
    tasks: int | None
    there: int

    def __str__(self) -> str:
        share = self.finished / self.points
        of = "" if self.tasks is None else f" of {self.tasks}"
        points = f"{self.finished} of {self.points} points are finished ({100 * share:.0f} %)"
        rest = " Run the sweep again to finish them." if self.there == self.tasks and share < 1.0 else ""
        return f"{points}, and {self.there}{of} tasks are done.{rest}"


def status(out: str | Path) -> Status:
    """Report the progress of a study from its store.

    Examples
    --------
    >>> import tempfile
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    >>> study = {"body": body, "law": law, "sweep": {"law.normal": [0.8, 0.9]}, "first_impact": {}}
    >>> out = tempfile.mkdtemp() + "/study.zarr"
    >>> found = rs.sweep(study, out=out, shard=(1, 2))
    >>> rs.study.status(out).there  # of 2 tasks
    1
    """
    path = path_from("out", out)
    need_zarr()
    found = identity(path)
    with readable(path):
        effort, store = found["effort"], Store(path)
        points, marks = int(store.words.shape[0]), store.group["status"]
        if points < 1 or math.prod(marks.shape) != points:
            raise ValueError(f"tasks of {points} points, and the status of {math.prod(marks.shape)}")
        finished = int(np.count_nonzero(np.asarray(marks[...]) == 1))
        tasks = None if effort["until"] else points * int(effort["batches"]) // store.task_batches
        return Status(points, finished, tasks, store.number_there())


def open_store(path: str | Path) -> xr.Dataset:
    """Open the results of a store.

    Examples
    --------
    >>> import tempfile
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    >>> study = {"body": body, "law": law, "sweep": {"law.normal": [0.8, 0.9]}, "first_impact": {}}
    >>> out = tempfile.mkdtemp() + "/study.zarr"
    >>> found = rs.sweep(study, out=out)
    >>> rs.study.open_store(out)["first_impact_mean"].dims
    ('normal',)
    """
    path = path_from("path", path)
    need_zarr()
    identity(path)
    with readable(path):
        found: xr.Dataset = xr.open_zarr(path, chunks=None)
    return found


def learned(out: str | Path, **values: float) -> FluctuatingRestitution:
    """Learn p(ε | v) from the statistics of a point.

    Parameters
    ----------
    out : str or Path
        The store of a study with statistics by impact velocity.
    **values : float
        Parameters of the point by their names in the store; the nearest point is taken. Of a design that is
        no grid, ``point`` is its number. Where heights of release are varied, ``release_height`` may be left
        out: the impacts of all of them then count, so that no speed is without impacts.

    Returns
    -------
    FluctuatingRestitution
        With the parameters of the point in the attributes of its ``data``.

    Raises
    ------
    ValueError
        If a parameter is missing or unknown, the point is not finished, or has too few impacts, as at speeds
        that no impact has after a fall from a single height.

    Examples
    --------
    >>> import tempfile
    >>> import restitution as rs
    >>> study = {
    ...     "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
    ...     "law": rs.TangentialRestitution(normal=0.98),
    ...     "run": {"particles": 512, "impacts": 50},
    ...     "statistics": {"velocity_bins": {"from": 0.2, "to": 1.0, "bins": 4},
    ...                    "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 400}},
    ...     "sweep": {"law.normal": [0.9, 0.98]},
    ... }
    >>> out = tempfile.mkdtemp() + "/study.zarr"
    >>> found = rs.sweep(study, out=out)
    >>> dist = rs.study.learned(out, normal=0.98)
    >>> bool(0.9 < dist.mean(0.5) < 1.0)
    True
    """
    path = path_from("out", out)
    study, data = study_in(path), open_store(path)
    design = study.design
    needed = set(design.dims) - {_POOLED}
    if not needed <= set(values) <= set(design.dims):
        text = f" of {', '.join(values)}: must be those of {', '.join(design.dims)}"
        raise ParameterError(Problem("values", text))
    if "restitution_count" not in data:
        raise ParameterError(Problem("out", f" = {str(out)!r}: must be the store of a study with statistics"))
    place = {name: _nearest(data, name, values[name]) for name in design.dims if name in values}
    with readable(path):
        chosen = data.isel(place).load()
    if not bool((chosen["status"] == 1).all()):
        raise ParameterError(Problem("values", f" = {values}: must be those of a finished point"))
    run = study.run(int(np.ravel_multi_index([place.get(name, 0) for name in design.dims], design.shape)))
    run = run.model_copy(update={"particles": int(chosen["particles"].sum())})
    attrs = attributes(run, "")
    if _POOLED in chosen.dims:
        attrs[_POOLED] = chosen[_POOLED].to_numpy()
        chosen = _pooled(chosen)
    chosen.attrs = attrs
    try:
        return FluctuatingRestitution.from_statistics(chosen)
    except ValueError as error:
        told = f"{path}: nothing can be learned from it: {error}"
        if isinstance(run.release_height, float) and np.ndim(attrs[_POOLED]) == 0:
            told += "; after a fall from a single height many speeds have no impacts"
            told += ": set run.release_height = { lowest = ..., highest = ... } in the study"
        raise Refused(told) from error


def _nearest(data: xr.Dataset, name: str, value: float) -> int:
    """Find the point that is closest along a dimension."""
    value = real(name, value, "a finite number", unit=str(data[name].attrs.get("units", "1")))
    index = data.indexes.get(name)
    if index is None:
        return whole(name, int(value) if value.is_integer() else value, 0, data.sizes[name] - 1)
    return int(index.get_indexer([value], method="nearest")[0])


def _pooled(points: xr.Dataset) -> xr.Dataset:
    """Add what was counted at several heights of release; extremes are those of all."""
    counts = ["restitution_count", "restitution_underflow", "restitution_overflow"]
    found = points[counts].sum(_POOLED)
    extremes = {"minimum": points["minimum"].min(_POOLED), "maximum": points["maximum"].max(_POOLED)}
    return found.assign(extremes).assign(restitution_edges=points["restitution_edges"])


def study_in(path: Path) -> Study:
    """Read a study back from its store."""
    said = identity(path)
    with readable(path):
        found = {key: value for key, value in said.items() if key != "physics"}
        if "measure" in found:
            found["measure"] = {key: found["measure"][key] for key in ("function", "of")}
        found["effort"] = dict(found["effort"])
    try:
        return study_of({**found, "sweep": design_again(found.get("sweep"))})
    except ValueError as error:
        raise ValueError(f"{path}: its study cannot be made again: {error}") from None
