"""The status of a study, read from its store."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from restitution._internal.files import path_from
from restitution.study._axes import design_again
from restitution.study._identity import identity, readable
from restitution.study._store import Store, need_zarr
from restitution.study._study import Study, study_of


@dataclass(frozen=True)
class Status:
    """What a store holds.

    Attributes
    ----------
    points, finished : int
        Points of the study, and those whose results are there.
    tasks, there : int
        The least number of tasks, and tasks that are there; among them those that were added for the
        standard error that is asked for.

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
    >>> print(rs.study.status(out))
    2 of 2 points finished (100 %); 2 tasks done, 2 at least
    """

    points: int
    finished: int
    tasks: int
    there: int

    def __str__(self) -> str:
        share = self.finished / self.points
        return (
            f"{self.finished} of {self.points} points finished ({100 * share:.0f} %); "
            f"{self.there} tasks done, {self.tasks} at least"
        )


def status(out: str | Path) -> Status:
    """Report the progress of a study from its store.

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
    >>> found = rs.sweep(study, out=out, shard=(1, 2))
    >>> rs.study.status(out).there  # of 2 tasks
    1
    """
    path = path_from("out", out)
    need_zarr(path)
    found = identity(path)
    with readable(path):
        batches = int(found["effort"]["batches"])
        store = Store(path, b"")
        points, marks = int(store.words.shape[0]), store.group["status"]
        if points < 1 or math.prod(marks.shape) != points:
            raise ValueError(f"tasks of {points} points, and the status of {math.prod(marks.shape)}")
        there = sum(len(store.there(point)) for point in store.points_there())
        finished = int(np.count_nonzero(np.asarray(marks[...]) == 1))
        return Status(points, finished, points * batches // store.task_batches, there)


def open_store(path: Path) -> xr.Dataset:
    """Open the results of a store.

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
    >>> rs.study.open_store(out)["mean_restitution"].dims
    ('normal', 'velocity')
    """
    path = path_from("path", path)
    need_zarr(path)
    from restitution.study._folder import Folder

    identity(path)
    with readable(path):
        found: xr.Dataset = xr.open_zarr(Folder(path, read_only=True), chunks=None)
    return found


def study_in(path: Path) -> Study:
    """Read a study back from its store."""
    whole = identity(path)
    with readable(path):
        found = {key: value for key, value in whole.items() if key != "physics"}
        if "measure" in found:
            found["measure"] = {key: found["measure"][key] for key in ("function", "of")}
        effort = dict(found["effort"])
        if not effort["until"]:
            del effort["most_particles"]
        if effort["velocities"] is None:
            del effort["velocities"]
    try:
        return study_of({**found, "sweep": design_again(found.get("sweep")), "effort": effort})
    except ValueError as error:
        raise ValueError(f"{path}: its study cannot be made again: {error}") from None
