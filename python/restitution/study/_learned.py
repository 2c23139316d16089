"""A store as a catalogue of learned distributions."""

from pathlib import Path

import numpy as np
import xarray as xr

from restitution._internal.arrays import real, whole
from restitution._internal.files import path_from
from restitution._internal.parameters import ParameterError, Problem
from restitution.distribution import FluctuatingRestitution
from restitution.drop.dataset import attributes
from restitution.study._identity import Refused, readable
from restitution.study._status import open_store, study_in

_POOLED = "release_height"


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
        If a parameter is missing or unknown, the point is not finished, or has too few impacts.

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
    >>> study["run"] = {"particles": 512, "impacts": 50}
    >>> study["statistics"] = {"velocity_bins": {"from": 0.2, "to": 1.0, "bins": 4},
    ...                        "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 400}}
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
        raise ParameterError(
            Problem("values", f" of {', '.join(values)}: must be those of {', '.join(design.dims)}")
        )
    if "restitution_count" not in data:
        raise ParameterError(Problem("out", f" = {str(out)!r}: must be the store of a study with statistics"))
    place = {
        name: _nearest(data, name, real(name, values[name], "a finite number", unit=_unit(data, name)))
        for name in design.dims
        if name in values
    }
    with readable(path):
        chosen = data.isel(place).load()
    if not bool((chosen["status"] == 1).all()):
        raise ParameterError(Problem("values", f" = {values}: must be those of a finished point"))
    at = [place.get(name, 0) for name in design.dims]
    run = study.run(int(np.ravel_multi_index(at, design.shape)))
    run = run.model_copy(update={"particles": int(chosen["particles"].sum())})
    attrs = attributes(run, "")
    if _POOLED in chosen.dims:
        attrs[_POOLED] = chosen[_POOLED].to_numpy()
        chosen = _pooled(chosen)
    chosen.attrs = attrs
    try:
        return FluctuatingRestitution.from_statistics(chosen)
    except ValueError as error:
        raise Refused(f"{path}: nothing can be learned from it: {error}") from error


def _nearest(data: xr.Dataset, name: str, value: float) -> int:
    index = data.indexes.get(name)
    if index is None:
        return whole(name, int(value) if value.is_integer() else value, 0, data.sizes[name] - 1)
    return int(index.get_indexer([value], method="nearest")[0])


def _unit(data: xr.Dataset, name: str) -> str:
    return str(data[name].attrs.get("units", "1"))


def _pooled(points: xr.Dataset) -> xr.Dataset:
    """Add what was counted at several heights of release; extremes are those of all."""
    counts = ["restitution_count", "restitution_underflow", "restitution_overflow"]
    found = points[counts].sum(_POOLED)
    extremes = {"minimum": points["minimum"].min(_POOLED), "maximum": points["maximum"].max(_POOLED)}
    return found.assign(extremes).assign(restitution_edges=points["restitution_edges"])
