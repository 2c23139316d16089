"""One point of a study: its batches, and what follows from them, with standard errors."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution import _core
from restitution._core import STOP_REASONS
from restitution._internal.arrays import FloatArray
from restitution._internal.process import uninterrupted
from restitution.bodies import Body, RigidBody
from restitution.drop.dataset import dataset
from restitution.drop.energy import PULLING
from restitution.drop.run import Run
from restitution.drop.statistics import MOMENTS, Edges, Table, dataset_of
from restitution.study._axes import Design
from restitution.study._study import Study
from restitution.study._tables import DERIVED, MOVED, with_errors

Words = npt.NDArray[np.uint64]
Tell = Callable[[int], None]


@dataclass(frozen=True)
class Point:
    """One point of a study, as a worker needs it: its number in the design, its run and the measure.

    The study is without the other points, of which there may be millions; the digest is that of the whole
    one. The template is what a measure of recorded impacts gives: names, dimensions and coordinates.
    """

    number: int
    run: Run
    study: Study
    digest: bytes
    template: xr.Dataset | None = None

    @property
    def edges(self) -> Edges | None:
        """Bins of the study."""
        return self.study.edges and _own_arrays(self.study.edges)

    @property
    def records(self) -> bool:
        """True if the measure is one of recorded impacts."""
        return self.study.measure is not None and self.study.of == "simulate"


def point_of(study: Study, number: int, template: xr.Dataset | None = None) -> Point:
    """Take a point out of a study."""
    alone = replace(study, design=Design("grid", ()))
    return Point(number, study.run(number), alone, study.digest, template)


def with_template(point: Point) -> Point:
    """Find out what a measure gives, from the first two particles, and whether it has what is waited for."""
    study = point.study
    if study.measure is None or not (point.records or study.effort.until):
        return point
    if point.records:
        template = _measured(point, _recorded(point, (0, 2), None))
        names, point = list(template.data_vars), replace(point, template=template)
    else:
        assert point.edges is not None
        histogram = _core.Histogram.read(point.run.parameters(), point.edges, count(point, (0, 2)))
        names = _real(_measured(point, _statistics(point, histogram)))
    study.effort.check([*with_errors(study.edges, study.forms.values()), *map(str, names)])
    return point


def count(point: Point, part: tuple[int, int], tell: Tell | None = None) -> Words:
    """Run the particles of a part, and store the sums over their impacts."""
    words, edges = list[Words](), point.edges
    if edges is not None:
        counted = uninterrupted(*_core.histogram(_parameters(point.run, part), edges, 1, tell, part))
        words.append(counted.words())
    if point.records:
        found = _measured(point, _recorded(point, part, tell))
        words += [_values(found, name).ravel().view(np.uint64) for name in sorted(map(str, found.data_vars))]
    return np.concatenate(words or [np.zeros(1, np.uint64)])  # a task has a chunk if nothing is counted, too


def evaluate(point: Point, rows: Words) -> xr.Dataset:
    """Return all results at a point, from its batches.

    Standard errors are those of a jackknife: the batches make groups, each group is left out in turn, and
    √((G - 1)/G Σ (θ_g - <θ>)²) is the standard error of θ over G groups. Batches share no particle, so that
    impacts of one particle may be correlated as they like.

    A row is what `count` gave for a batch; batch b belongs to group b mod G.
    """
    groups, edges = point.study.effort.batches, point.edges
    found = xr.Dataset()
    recorded = {} if point.template is None else point.template.data_vars
    start = rows.shape[1] - sum(variable.size for variable in recorded.values())
    if edges is not None:
        parameters = point.run.parameters()
        histograms = [_core.Histogram.read(parameters, edges, row) for row in rows[:, :start]]
        by_group = [_sum(histograms[g::groups]) for g in range(groups)]
        without = [_sum(by_group[:g] + by_group[g + 1 :]) for g in range(groups)]
        found = _with_errors(point, _sum(by_group), without)
    if point.template is not None:
        found = found.merge(_means(point.template, rows[:, start:], groups))
    if point.study.first_impact:
        found = found.merge(_first_impact(point.run))
    particles = np.int64(point.study.effort.part(len(rows) - 1)[1])
    found = found.assign(particles=((), particles, {"long_name": "particles of the point"}))
    found.attrs = {}
    return found


def _sum(histograms: Sequence[_core.Histogram]) -> _core.Histogram:
    return histograms[0].merged(histograms[1:])


def _parameters(run: Run, part: tuple[int, int]) -> dict[str, Any]:
    return _own_arrays(run.parameters()) | {"particles": max(run.particles, part[1])}


def _own_arrays(values: Mapping[str, Any]) -> dict[str, Any]:
    """Copy arrays: those of a message that they came in need not lie as the core needs."""
    return {name: np.array(own) if isinstance(own, np.ndarray) else own for name, own in values.items()}


def _recorded(point: Point, part: tuple[int, int], tell: Tell | None) -> xr.Dataset:
    table = uninterrupted(*_core.simulate(_parameters(point.run, part), 1, tell, part))
    return dataset(point.run.model_copy(update={"particles": part[1] - part[0]}), table)


def _measured(point: Point, data: xr.Dataset) -> xr.Dataset:
    assert point.study.measure is not None
    found = point.study.measure(data)
    if not isinstance(found, xr.Dataset) or not found.data_vars:
        raise ValueError(f"measure: gave {type(found).__name__}: must give an xarray.Dataset with variables")
    if point.template is not None:
        same = {name: (v.dims, v.shape) for name, v in found.data_vars.items()}
        if same != {name: (v.dims, v.shape) for name, v in point.template.data_vars.items()}:
            text = "must give the same variables, of the same shapes, for every part of every run"
            raise ValueError(f"measure: {text}")
    return found


def _real(measured: xr.Dataset) -> list[Hashable]:
    """Name the floating-point variables, which are those with standard errors."""
    return [name for name, variable in measured.data_vars.items() if variable.dtype.kind == "f"]


def _values(found: xr.Dataset, name: str) -> FloatArray:
    return np.asarray(found[name].to_numpy(), dtype=np.float64, order="C")


def _statistics(point: Point, histogram: _core.Histogram) -> xr.Dataset:
    assert point.study.edges is not None
    return dataset_of(point.run, point.study.edges, histogram.table())


def _with_errors(point: Point, total: _core.Histogram, without: Sequence[_core.Histogram]) -> xr.Dataset:
    edges = point.study.edges
    assert edges is not None
    statistics = _statistics(point, total)
    row = str(statistics["number"].dims[0])
    values = _derived(total.table(), edges)
    errors = _errors([_derived(histogram.table(), edges) for histogram in without])
    found: dict[Hashable, Any] = {}
    for name, value in values.items():
        dims = (row, "restitution")[: value.ndim]
        about = {"long_name": DERIVED[name]} if name in DERIVED else statistics.variables[name].attrs
        found[name] = (dims, value, about)
        found[f"{name}_error"] = (dims, errors[name], _about_error(name, about))
    codes = np.arange(len(STOP_REASONS), dtype=np.int8)
    meanings = {"flag_values": codes.tolist(), "flag_meanings": " ".join(STOP_REASONS)}
    coordinates = {name: statistics.variables[name] for name in statistics.coords if name != "stop_reason"}
    own = {name: v for name, v in statistics.variables.items() if name not in statistics.coords}
    pulls = np.int64(statistics.attrs.get("pulling_impacts", 0))
    own["pulling_impacts"] = xr.Variable((), pulls, {"long_name": PULLING})
    # All at once: adding to a Dataset takes as long as making one.
    result = xr.Dataset(own | found, coordinates | {"stop_reason": ("stop_reason", codes, meanings)})
    measures = [partial(form, point.run) for form in point.study.forms.values()]
    if point.study.measure is not None and not point.records:
        measures.append(partial(_measured, point))
    parts = [_statistics(point, histogram) for histogram in without] if measures else []
    for measure in measures:
        measured, left = measure(statistics), [measure(part) for part in parts]
        real = _real(measured)
        spread = _errors([{str(name): _values(part, str(name)) for name in real} for part in left])
        for key in real:
            error = xr.Variable(measured[key].dims, spread[str(key)], _about_error(key, measured[key].attrs))
            measured = measured.assign({f"{key}_error": error})
        result = result.merge(measured, join="exact", compat="equals")
    return result


def _derived(table: Table, edges: Edges) -> dict[str, FloatArray]:
    """Return the variables that have a standard error, by row."""
    inner = slice(None) if edges["velocity"] is None else slice(1, -1)
    count, bins = table["count"][inner], edges["restitution"]
    assert bins is not None
    with np.errstate(invalid="ignore", divide="ignore"):
        found = {"density": count[:, 1:-2] / table["number"][inner][:, None] / np.diff(bins)}
    if edges["fraction"] is not None:
        found |= {name: table[key][inner] for name, key in MOMENTS.items() if name in MOVED}
        found["std_restitution"] = np.sqrt(found["variance"])
        found["second_moment"] = found["variance"] + found["mean_restitution"] ** 2
    return found


def _errors(parts: Sequence[dict[str, FloatArray]]) -> dict[str, FloatArray]:
    """Return the standard errors of a jackknife from the estimates with one group left out."""
    found = {}
    for name in parts[0]:
        left = np.stack([part[name] for part in parts])
        left -= left.mean(axis=0)
        found[name] = np.sqrt((len(parts) - 1) / len(parts) * np.einsum("i...,i...->...", left, left))
    return found


def _means(template: xr.Dataset, rows: Words, groups: int) -> xr.Dataset:
    """Return means over batches of recorded impacts, and their standard errors over groups."""
    found, start = {}, 0
    for name in sorted(map(str, template.data_vars)):
        variable = template[name]
        values = np.ascontiguousarray(rows[:, start : start + variable.size]).view(np.float64)
        start += variable.size
        by_group = np.stack([values[g::groups].mean(axis=0) for g in range(groups)]).reshape(
            groups, *variable.shape
        )
        found[name] = (variable.dims, by_group.mean(axis=0), variable.attrs)
        error = by_group.std(axis=0, ddof=1) / np.sqrt(groups)
        found[f"{name}_error"] = (variable.dims, error, _about_error(name, variable.attrs))
    return xr.Dataset(found, template.coords)


def _about_error(name: Hashable, about: Mapping[Any, Any]) -> dict[str, Any]:
    """Describe the standard error of a variable, which has the unit of the variable."""
    unit = {"units": about["units"]} if "units" in about else {}
    return {"long_name": f"standard error of {about.get('long_name', name)}", **unit}


def _first_impact(run: Run) -> xr.Dataset:
    """Return mean and standard deviation of the first impact from their closed form."""
    from restitution.analytic import first_impact

    assert isinstance(run.body, Body | RigidBody)
    fall = {"release_height": run.release_height, "gravity": run.gravity}
    varies = not isinstance(run.standard_law.normal, float)
    law = first_impact(run.body, run.standard_law, orientation=run.orientation, **(fall if varies else {}))
    mean = {"long_name": "mean restitution of the first impact"}
    std = {"long_name": "standard deviation of the restitution of the first impact"}
    values = {"mean": ((), float(law.mean()), mean), "std": ((), float(law.std()), std)}
    return xr.Dataset({f"first_impact_{name}": value for name, value in values.items()})
