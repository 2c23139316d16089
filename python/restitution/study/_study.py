"""A study, checked: a run, what is varied in it, what is measured, and with what effort."""

import hashlib
import inspect
import json
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import Any, cast

import xarray as xr

from restitution._internal.arrays import whole, word
from restitution._internal.files import path_from
from restitution._internal.parameters import (
    ParameterError,
    Parameters,
    Problem,
    in_terms_of,
    shown,
    unknown,
    wrong,
)
from restitution.bodies import AnyBody, RoughSphere
from restitution.drop.bins import edges_from
from restitution.drop.release import RandomHeight
from restitution.drop.run import Run
from restitution.drop.statistics import Edges, edges_of
from restitution.drop.toml import bodies_of, run_of, table_of, tables_in, tables_of
from restitution.laws import Material
from restitution.study._axes import Design, design
from restitution.study._tables import Effort, Forms, copied, effort, forms_of, table, with_errors

Measure = Callable[[xr.Dataset], xr.Dataset]
"""A function of what `restitution.statistics` or `restitution.simulate` returns."""

_OF = ("statistics", "simulate")
_TABLES = ("body", "law", "run", "sweep", "statistics", "learn", "fit", "measure", "first_impact", "effort")


@dataclass(frozen=True, eq=False)
class Study:
    """Description of a study. Two studies with the same `identity` have the same results, to the bit.

    Attributes
    ----------
    bodies : dict of str to body
        The bodies of the first axis by their names, where there are several.
    base : Run
        The run at the first point.
    design : Design
        The points.
    edges : dict or None
        Bins of the impacts that are counted, as `restitution.drop.statistics.edges_of` gives them.
    forms : dict of str to Learn or Fitted
        What is taken from the statistics of a point by name: quantiles, a fit.
    measure : callable or None
        A function of a Dataset that is measured besides.
    of : {"statistics", "simulate"}
        What it is a function of.
    first_impact : bool
        Whether mean and standard deviation of the first impact are worked out from their closed form.
    effort : Effort
        How many particles at each point, and in how many batches.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    >>> study = {"body": body, "law": law, "sweep": {"law.normal": [0.8, 0.9]}, "first_impact": {}}
    >>> rs.study.study_of(study).design.points
    2
    """

    bodies: Mapping[str, AnyBody]
    base: Run
    design: Design
    edges: Edges | None
    forms: Forms
    measure: Measure | None
    of: str
    first_impact: bool
    effort: Effort

    def run(self, point: int) -> Run:
        """Return the run at a point; raises a ValueError if its parameters do not go together."""
        values = self.design.values(whole("point", point, 0, self.design.points - 1))
        base = self.base
        if self.bodies and "body" in values:
            base = base.model_copy(update={"body": [*self.bodies.values()][int(values.pop("body"))]})
        try:
            return _changed(base, values)
        except ParameterError as error:
            here = self.where(point)
            raise ParameterError(*(Problem(f"{here}: ", str(one)) for one in error.problems)) from None

    def where(self, point: int) -> str:
        """Name a point by what is varied, in an error."""
        values: dict[str, Any] = dict(self.design.values(point))
        if self.bodies:
            values["body"] = [*self.bodies][int(values["body"])]
        return "at " + ", ".join(f"{key} = {value!r}" for key, value in values.items())

    @cached_property
    def identity(self) -> dict[str, Any]:
        """Everything that the results depend on, as plain values."""
        found = tables_of(self.base)
        if self.bodies:
            found["body"] = [{"name": name, **table_of(one)} for name, one in self.bodies.items()]
        varied = {axis.parameter: list(axis.values) for axis in self.design.axes}
        found["sweep"] = {"design": self.design.kind, **varied}
        if self.edges:
            bins = {f"{name}_bins": own.tolist() for name, own in self.edges.items() if own is not None}
            found["statistics"] = bins
        found |= {name: form.model_dump(mode="json", exclude_none=True) for name, form in self.forms.items()}
        if self.measure:
            found["measure"] = {"of": self.of, **_named(self.measure)}
        if self.first_impact:
            found["first_impact"] = {}
        return found | {"effort": self.effort.table()}

    @cached_property
    def digest(self) -> bytes:
        """SHA-256 of `identity`."""
        return hashlib.sha256(json.dumps(self.identity, sort_keys=True).encode()).digest()

    def __eq__(self, other: object) -> bool:
        return self.digest == other.digest if isinstance(other, Study) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.digest)


def study_of(source: Any) -> Study:
    """Make a study of a TOML file or of tables.

    Parameters
    ----------
    source : str, Path or mapping
        A file, or the same tables as a mapping, in which ``body`` and ``law`` may be a body and a law, and
        ``measure`` a function.

    Raises
    ------
    ValueError
        Naming everything that is wrong.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    >>> study = {"body": body, "law": law, "sweep": {"law.normal": [0.8, 0.9]}, "first_impact": {}}
    >>> wanted = rs.study.study_of(study)
    >>> wanted.base.particles, wanted.design.points
    (1000, 2)
    """
    if isinstance(source, Study):
        return source
    if isinstance(source, str | Path):
        return _study(tables_in(path_from("study", source)), str(source))
    if isinstance(source, Mapping):
        return _study(source, "study")
    raise ParameterError(wrong("study", source, "a path of a TOML file, or its tables as a mapping"))


@contextmanager
def _naming(source: str) -> Iterator[None]:
    """Begin each line of an error with the name of the file."""
    try:
        yield
    except ValueError as error:
        problems = error.problems if isinstance(error, ParameterError) else [error]
        raise ValueError("\n".join(f"{source}: {problem}" for problem in problems)) from None


def _study(given: Mapping[str, Any], source: str) -> Study:
    """Read the tables one after the other, what is measured after the run that it is measured of."""
    with _naming(source):
        tables = copied("study", given)
        for name in tables:
            if name not in _TABLES:
                raise ParameterError(unknown(name, "a study", _TABLES))
        own = {name: tables.pop(name) for name in _TABLES[3:] if name in tables}
        bodies = _bodies(tables, source)
        points = own.get("sweep", {})
        if not isinstance(points, Design):  # as a store has it
            run = tables.get("run")
            points = design(points, run.get("seed", 1) if isinstance(run, dict) else 1, len(bodies))
        plain = {
            name: table_of(table) if isinstance(table, Parameters) else table
            for name, table in tables.items()
        }
        for parameter, value in points.values(0).items():
            if parameter != "body" or not bodies:
                _set(plain, parameter, value)
    base = run_of(plain, source)
    with _naming(source):
        measure, of = _measure(own.get("measure"))
        edges = _edges(own["statistics"]) if "statistics" in own else None
        forms = forms_of(own, edges, base)
        first = _first_impact(own, base, [*bodies.values()] or [base.body])
        if measure is not None and of == "statistics" and edges is None:
            raise ParameterError(Problem("statistics", ": missing; the measure is a function of them"))
        if edges is None and measure is None and not first:
            needed = "[statistics], [measure] or [first_impact]"
            raise ParameterError(Problem("statistics", f": nothing is measured; there must be {needed}"))
        amount = effort(own.get("effort", {}), base)
        if measure is None:  # else its own variables are known when it has been called
            amount.check(with_errors(edges, forms.values()))
        found = Study(bodies, base, points, edges, forms, measure, of, first, amount)
        for point in range(points.points):
            found.run(point)
    return found


def _bodies(tables: dict[str, Any], source: str) -> dict[str, AnyBody]:
    """Make the bodies of a list, or of a mapping with their names, and leave the first in the tables."""
    given = tables.get("body")
    if isinstance(given, list | tuple):
        each = {f"body {i}": one for i, one in enumerate(given, start=1)}
    elif isinstance(given, Mapping) and given and all(isinstance(one, AnyBody) for one in given.values()):
        each = dict(given)
    else:
        return {}
    rows = [
        {"name": name, **table_of(one)} if isinstance(one, AnyBody) else one for name, one in each.items()
    ]
    found = bodies_of(rows, source)
    if len(found) < 2:
        raise ParameterError(wrong("body", given, "a body, or two or more"))
    tables["body"] = next(iter(found.values()))
    return found


def _first_impact(own: Mapping[str, Any], run: Run, bodies: list[AnyBody]) -> bool:
    """Read ``[first_impact]``, which is an empty table."""
    if "first_impact" not in own:
        return False
    given = own["first_impact"]
    if not isinstance(given, Mapping) or len(given) > 0:
        raise ParameterError(wrong("first_impact", given, "an empty table"))
    for body in bodies:
        if isinstance(body, RoughSphere) and isinstance(body.heights, tuple):
            allowed = "one number, for the closed form of [first_impact]"
            raise ParameterError(wrong("body.heights", body.heights, allowed))
    if isinstance(run.release_height, RandomHeight) and isinstance(run.standard_law.normal, Material):
        allowed = "a number, for the closed form of [first_impact] where the coefficient varies"
        raise ParameterError(wrong("run.release_height", run.release_height, allowed))
    return True


def _set(tables: dict[str, Any], parameter: str, value: float) -> None:
    """Set a value in a table, which need not name it yet."""
    *parts, last = parameter.split(".")
    if not parts or parts[0] not in _TABLES[:3]:
        allowed = "the table and the name of a parameter of [body], [law] or [run], as body.separation"
        raise ParameterError(Problem("sweep", f'."{parameter}": must be {allowed}'))
    _put(tables, [*parts, last], value, parameter)


def _put(into: Any, names: list[str], value: float, parameter: str) -> Any:
    """Set a value in a table, or by its number from 0 in a list, as body.semi_axes.2."""
    if not names:
        return value
    name, *rest = names
    if isinstance(into, list | tuple) and name in map(str, range(len(into))):
        return [_put(one, rest, value, parameter) if str(i) == name else one for i, one in enumerate(into)]
    if not isinstance(into, dict):
        outer = parameter.split(".")[-len(names) - 1]
        text = f": {outer} is {shown(into)} and has no parameters"
        raise ParameterError(Problem(f"sweep.{parameter}", text))
    into[name] = _put(into.get(name, {}) if rest else None, rest, value, parameter)
    return into


def _changed(run: Run, values: Mapping[str, float]) -> Run:
    """Make a run with other values, checked as any other."""
    tree: dict[str, Any] = {"run": {}}
    for parameter, value in values.items():
        _set(tree, parameter, value)
    own = tree.pop("run")
    return cast(Run, _with(run, tree | own))


def _with(parameters: Any, changes: Mapping[str, Any]) -> Any:
    """Make parameters with other values, of which tables are those of parameters within, or of a list."""
    if isinstance(parameters, tuple):
        places = {int(name): value for name, value in changes.items()}
        each = ((one, places.get(i, one)) for i, one in enumerate(parameters))
        return tuple(_with(one, value) if isinstance(value, dict) else value for one, value in each)
    fields = {name: getattr(parameters, name) for name in type(parameters).model_fields}
    for name, value in changes.items():
        fields[name] = _with(fields[name], value) if isinstance(value, dict) else value
    return type(parameters)(**fields)


def _edges(given: Any) -> Edges:
    """Read ``[statistics]``."""
    names = ("velocity_bins", "restitution_bins", "fraction_bins")
    spans = tuple(name.replace("_bins", "_range") for name in names)
    own = table("statistics", given, (*names, *spans))
    if "restitution_bins" not in own:
        text = ": missing; must be { from, to, bins } or edges"
        raise ParameterError(Problem("statistics.restitution_bins", text))
    bins = {"velocity_bins": None, "fraction_bins": {"from": 0.0, "to": 1.0, "bins": 50}, **own}
    return edges_of(
        *(_bins(name, bins[name], own.get(span)) for name, span in zip(names, spans, strict=True))
    )


def _bins(name: str, value: Any, span: Any) -> Any:
    """Return edges, written as such, as a number with a range, or as a table."""
    if not isinstance(value, Mapping):
        return None if value is None and span is None else edges_from(value, span, name)
    if span is not None:
        kind = name.removesuffix("_bins")
        raise ParameterError(wrong(f"statistics.{kind}_range", span, f"left out: {name} has its own ends"))
    if set(value) != {"from", "to", "bins"}:
        allowed = "{ from, to, bins } with bins >= 1, or edges"
        raise ParameterError(wrong(f"statistics.{name}", value, allowed))
    number = whole(f"statistics.{name}.bins", value["bins"], 1)
    with in_terms_of(**{f"statistics.{name}": value}):
        return edges_from(number, (value["from"], value["to"]), name)


def _measure(given: Any) -> tuple[Measure | None, str]:
    """Read ``[measure]``: a function, or its name in a file."""
    if given is None:
        return None, _OF[0]
    if callable(given):
        return given, _OF[0]
    own = table("measure", given, ("function", "of"))
    of, function = word("measure.of", own.get("of", _OF[0]), _OF), own.get("function")
    if isinstance(function, str):
        module, _, name = function.partition(":")
        try:
            function = getattr(import_module(module), name)
        except (Exception, SystemExit) as error:  # any error of the imported module
            said = " ".join(str(error).split())[:200]
            text = f"{said}; must be 'module:function', importable where the study runs"
            raise ParameterError(Problem("measure.function", f" = {shown(function)}: {text}")) from None
    if not callable(function):
        raise ParameterError(wrong("measure.function", function, "'module:function', or a function"))
    return function, of


def _named(function: Any) -> dict[str, str]:
    """Identify a function by its place and its code."""
    name = (
        f"{getattr(function, '__module__', '')}:{getattr(function, '__qualname__', type(function).__name__)}"
    )
    try:
        text = inspect.getsource(function)
    except (OSError, TypeError):
        text = repr(getattr(getattr(function, "__code__", None), "co_code", ""))
    return {"function": name, "source": hashlib.sha256(text.encode()).hexdigest()}
