"""How stores of several machines become one."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from restitution._internal.arrays import several
from restitution._internal.files import ZARR, check_name, path_from
from restitution._internal.parameters import ParameterError, Problem, shown, wrong
from restitution.study._drive import Driver
from restitution.study._identity import check
from restitution.study._layout import check_layout
from restitution.study._status import Status, status, study_in
from restitution.study._store import Store, need_zarr
from restitution.study._study import Study, study_of
from restitution.study._sweep import opened
from restitution.study.engines import engine, width


def merge(
    out: str | Path, parts: Sequence[str | Path] = (), *, study: Any = None, threads: int | None = None
) -> Status:
    """Put the tasks of several stores into one, and work out the results of all points that are complete.

    Parameters
    ----------
    out : str or Path
        The store; it is made if it is not there. One that several shards wrote to needs no other parts.
    parts : sequence of str or Path
        Other stores of the same study; they are left as they are. What is damaged in them is left out.
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
    >>> study = {
    ...     "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
    ...     "law": rs.TangentialRestitution(normal=0.98),
    ...     "run": {"particles": 32, "impacts": 50},
    ...     "statistics": {"velocity_bins": {"from": 0.0, "to": 1.1, "bins": 11},
    ...                    "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 40}},
    ...     "sweep": {"law.normal": [0.9, 0.98]},
    ... }
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
    need_zarr(path, width(None, threads))
    if not path.exists() and not others:
        raise ParameterError(Problem("out", f" = {shown(out)}: there is no such store, and no parts for it"))
    if not path.exists():
        check_name("out", path, ZARR)
    wanted = study_of(study if study is not None else study_in(path if path.exists() else others[0]))
    for part in others:
        check(part, wanted)
    store, template = opened(path, wanted)
    for part in others:
        other = Store(part, wanted.digest)
        check_layout(part, other.group, wanted, store.words.shape[2])
        _copy(other, store, wanted)
    points = range(wanted.design.points)
    with engine(None, threads) as work:
        Driver(wanted, store, work, template, points, compute=False).run(writes=True)
    return status(path)


def _copy(part: Store, store: Store, wanted: Study) -> None:
    """Copy the tasks that are undamaged in one store and not in the other."""
    number = wanted.effort.task_batches
    for point in range(wanted.design.points):
        for task in sorted(part.there(point)):
            first = task * number
            if task in store.there(point) and store.valid(point, first, number).all():
                continue
            rows, good, _ = part.read(point, first, number)
            if good.all():
                store.write(point, first, rows)
