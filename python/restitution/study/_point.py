"""One point of a study: its batches, and what follows from them, with standard errors."""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution import _core
from restitution._core import STOP_REASONS
from restitution.drop.dataset import dataset
from restitution.drop.run import Run
from restitution.drop.statistics import MOMENTS, Edges, Table, dataset_of
from restitution.study._effort import Effort
from restitution.study._forms import Form
from restitution.study._named import DERIVED, MOVED, with_errors
from restitution.study._study import Measure, Study

FloatArray = npt.NDArray[np.float64]
Words = npt.NDArray[np.uint64]
Tell = Callable[[int], None]


@dataclass(frozen=True)
class Point:
    """What a worker needs to know of a point.

    Attributes
    ----------
    number : int
        Which one, in the order of the design.
    study : bytes
        The digest of the study.
    template : xarray.Dataset or None
        What the measure gives, if it is one of recorded impacts: names, dimensions and coordinates.
    run, edges, forms, measure, of, first_impact, effort
        As in a `Study`.
    """

    number: int
    study: bytes
    run: Run
    edges: Edges | None
    forms: tuple[Form, ...]
    measure: Measure | None
    of: str
    first_impact: bool
    effort: Effort
    template: xr.Dataset | None

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Take arrays out of the message that they came in, where they need not lie as the core needs."""
        edges = state["edges"]
        copied = edges and {name: None if own is None else np.array(own) for name, own in edges.items()}
        self.__dict__.update(state | {"edges": copied})

    @property
    def records(self) -> bool:
        """Whether the measure is one of recorded impacts."""
        return self.measure is not None and self.of == "simulate"


def point_of(study: Study, number: int, template: xr.Dataset | None = None) -> Point:
    """Take a point out of a study."""
    return Point(
        number=number,
        study=study.digest,
        run=study.run(number),
        edges=study.edges,
        forms=study.forms,
        measure=study.measure,
        of=study.of,
        first_impact=study.first_impact,
        effort=study.effort,
        template=template,
    )


def with_template(point: Point) -> Point:
    """Find out what a measure of recorded impacts gives, from the first two particles.

    Raises
    ------
    ParameterError
        If a standard error is asked for of what has none; a measure has to be called to know what it gives.
    """
    if point.measure is None or not (point.records or point.effort.until):
        return point
    if point.records:
        template = _measured(point, _recorded(point, (0, 2), None))
        names, found = list(template.data_vars), replace(point, template=template)
    else:
        names, found = _real(_measured(point, _statistics_of(point, count(point, (0, 2))))), point
    point.effort.check([*with_errors(point.edges, point.forms), *map(str, names)])
    return found


def count(point: Point, part: tuple[int, int], tell: Tell | None = None) -> Words:
    """Drop the particles of a part, and write down what their impacts add up to."""
    words = [np.empty(0, np.uint64)]
    if point.edges is not None:
        tally, interrupted = _core.tally(_parameters(point.run, part), point.edges, 1, tell, part)
        if interrupted:
            raise KeyboardInterrupt from interrupted
        words.append(tally.words())
    if point.records:
        found = _measured(point, _recorded(point, part, tell))
        words += [_values(found, name).ravel().view(np.uint64) for name in sorted(map(str, found.data_vars))]
    return np.concatenate(words)


def evaluate(point: Point, rows: Words) -> xr.Dataset:
    """Give everything that is measured at a point, from its batches.

    Standard errors are those of a jackknife: the batches make groups, each group is left out in turn, and
    √((G - 1)/G Σ (θ_g - <θ>)²) is the standard error of θ over G groups. Batches share no particle, so that
    impacts of one particle may be correlated as they like.

    Parameters
    ----------
    point : Point
        The point.
    rows : ndarray of uint64, shape (batches, words)
        What `count` gave for each; batch b belongs to group b mod G.
    """
    groups = point.effort.batches
    found = xr.Dataset()
    start = rows.shape[1] - _recorded_words(point)
    if point.edges is not None:
        parameters = point.run.parameters()
        tallies = [_core.Tally.read(parameters, point.edges, row) for row in rows[:, :start]]
        by_group = [tallies[g].merged(tallies[g + groups :: groups]) for g in range(groups)]
        total = by_group[0].merged(by_group[1:])
        without = [
            by_group[g - 1].merged([t for i, t in enumerate(by_group) if i not in (g, g - 1)])
            if g
            else by_group[1].merged(by_group[2:])
            for g in range(groups)
        ]
        found = _with_errors(point, total, without)
    if point.template is not None:
        found = found.merge(_means(point.template, rows[:, start:], groups))
    if point.first_impact:
        found = found.merge(_first_impact(point.run))
    particles = np.int64(point.effort.part(len(rows) - 1)[1])
    found = found.assign(particles=((), particles, {"long_name": "particles of the point"}))
    found.attrs = {}
    return found


def _parameters(run: Run, part: tuple[int, int]) -> dict[str, Any]:
    parameters = {
        name: np.array(value) if isinstance(value, np.ndarray) else value
        for name, value in run.parameters().items()
    }
    return {**parameters, "particles": max(run.particles, part[1])}


def _recorded(point: Point, part: tuple[int, int], tell: Tell | None) -> xr.Dataset:
    table, interrupted = _core.simulate(_parameters(point.run, part), 1, tell, part)
    if interrupted:
        raise KeyboardInterrupt from interrupted
    return dataset(point.run.model_copy(update={"particles": part[1] - part[0]}), table)


def _measured(point: Point, data: xr.Dataset) -> xr.Dataset:
    assert point.measure is not None
    found = point.measure(data)
    if not isinstance(found, xr.Dataset) or not found.data_vars:
        raise ValueError(f"measure: gave {type(found).__name__}: must give an xarray.Dataset with variables")
    if point.template is not None and point.of == "simulate":
        same = {name: (v.dims, v.shape) for name, v in found.data_vars.items()}
        if same != {name: (v.dims, v.shape) for name, v in point.template.data_vars.items()}:
            raise ValueError(
                "measure: must give the same variables, of the same shapes, for every part of every run"
            )
    return found


def _real(measured: xr.Dataset) -> list[Hashable]:
    """Name what gets standard errors of what a form or a measure of statistics gives."""
    return [name for name, variable in measured.data_vars.items() if variable.dtype.kind == "f"]


def _statistics_of(point: Point, words: Words) -> xr.Dataset:
    assert point.edges is not None
    tally = _core.Tally.read(point.run.parameters(), point.edges, words)
    return dataset_of(point.run, point.edges, tally.table())


def _values(found: xr.Dataset, name: str) -> npt.NDArray[np.float64]:
    return np.asarray(found[name].to_numpy(), dtype=np.float64, order="C")


def _recorded_words(point: Point) -> int:
    """Words of a measure of recorded impacts, which stand after those of the tally."""
    return (
        0 if point.template is None else sum(variable.size for variable in point.template.data_vars.values())
    )


def _with_errors(point: Point, total: _core.Tally, without: Sequence[_core.Tally]) -> xr.Dataset:
    assert point.edges is not None
    table = total.table()
    statistics = dataset_of(point.run, point.edges, table)
    row = str(statistics["number"].dims[0])
    values = _derived(table, point.edges)
    errors = _errors([_derived(tally.table(), point.edges) for tally in without])
    found: dict[Hashable, Any] = {}
    for name, value in values.items():
        dims = (row, "restitution")[: value.ndim]
        about = {"long_name": DERIVED[name]} if name in DERIVED else statistics.variables[name].attrs
        found[name] = (dims, value, about)
        found[f"{name}_error"] = (
            dims,
            errors[name],
            {"long_name": f"standard error of {about['long_name']}"},
        )
    codes = np.arange(len(STOP_REASONS), dtype=np.int8)
    meanings = {"flag_values": codes.tolist(), "flag_meanings": " ".join(STOP_REASONS)}
    coordinates = {name: statistics.variables[name] for name in statistics.coords if name != "stop_reason"}
    own = {name: v for name, v in statistics.variables.items() if name not in statistics.coords}
    # All at once: adding to a Dataset takes as long as making one.
    result = xr.Dataset(own | found, coordinates | {"stop_reason": ("stop_reason", codes, meanings)})
    measures = [partial(form, point.run) for form in point.forms]
    if point.measure is not None and not point.records:
        measures.append(partial(_measured, point))
    parts = [dataset_of(point.run, point.edges, tally.table()) for tally in without] if measures else []
    for measure in measures:
        measured, left = measure(statistics), [measure(part) for part in parts]
        real = _real(measured)
        spread = _errors([{str(name): _values(part, str(name)) for name in real} for part in left])
        errors_of = {
            f"{name}_error": (measured[name].dims, spread[str(name)], _about_error(measured[name]))
            for name in real
        }
        result = result.merge(measured.assign(errors_of), join="exact", compat="equals")
    return result


def _derived(table: Table, edges: Edges) -> dict[str, FloatArray]:
    """Give what has a standard error, by row."""
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
    """Give the standard errors of a jackknife from the estimates with one group left out."""
    found = {}
    for name in parts[0]:
        left = np.stack([part[name] for part in parts])
        left -= left.mean(axis=0)
        found[name] = np.sqrt((len(parts) - 1) / len(parts) * np.einsum("i...,i...->...", left, left))
    return found


def _means(template: xr.Dataset, rows: Words, groups: int) -> xr.Dataset:
    """Give means over batches of recorded impacts, and their standard errors over groups."""
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
        found[f"{name}_error"] = (variable.dims, error, _about_error(variable))
    return xr.Dataset(found, template.coords)


def _about_error(variable: xr.DataArray) -> dict[str, Any]:
    about = {"long_name": f"standard error of {variable.attrs.get('long_name', variable.name)}"}
    return about | {key: variable.attrs[key] for key in ("units",) if key in variable.attrs}


def _first_impact(run: Run) -> xr.Dataset:
    from restitution.analytic import first_impact

    fall = (
        {}
        if isinstance(run.law.normal, float)
        else {"release_height": run.release_height, "gravity": run.gravity}
    )
    law = first_impact(run.body, run.law, orientation=run.orientation, **fall)
    return xr.Dataset(
        {
            "first_impact_mean": (
                (),
                float(law.mean()),
                {"long_name": "mean restitution of the first impact"},
            ),
            "first_impact_std": (
                (),
                float(law.std()),
                {"long_name": "standard deviation of the restitution of the first impact"},
            ),
        }
    )
