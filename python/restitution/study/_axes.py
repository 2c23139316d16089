"""Axes of a study: values of named parameters, on a grid or spread over their ranges."""

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from restitution._internal.arrays import FloatArray, whole, word
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.study._tables import number, table

_VALUES = (
    "a list of different numbers, or a table { from, to, points } with finite from < to"
    ' and perhaps scale = "linear" or "log"'
)
DESIGNS = ("grid", "latin-hypercube", "sobol")
_MOST_POINTS = 10_000_000

# Dimensions and variables that results have of their own.
_TAKEN = {
    *("release_velocity", "restitution", "fraction", "impact", "stop_reason", "point", "batch", "status"),
    *("particles", "digest", "level", "number", "variance", "density", "skewness", "kurtosis"),
    *("minimum", "maximum", "undefined"),
}


@dataclass(frozen=True)
class Axis:
    """One parameter that is varied: its place in a file, as ``body.separation``, its name in the results.

    Its values are those of all points where the design is not a grid.
    """

    parameter: str
    name: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class Design:
    """The points of a study; on a grid they are all combinations, the last axis varying fastest."""

    kind: str
    axes: tuple[Axis, ...]

    @property
    def dims(self) -> tuple[str, ...]:
        """Dimensions of the points in the results."""
        return tuple(axis.name for axis in self.axes) if self.kind == "grid" else ("point",)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each dimension."""
        sizes = tuple(len(axis.values) for axis in self.axes)
        return sizes if self.kind == "grid" else sizes[:1]

    @property
    def points(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    def place(self, point: int) -> tuple[int, ...]:
        """Index of a point along each dimension."""
        return tuple(int(i) for i in np.unravel_index(point, self.shape))

    def values(self, point: int) -> dict[str, float]:
        """Return parameters of a point by their place in a file."""
        place = self.place(point)
        index = place if self.kind == "grid" else place * len(self.axes)
        return {axis.parameter: axis.values[i] for axis, i in zip(self.axes, index, strict=True)}


def design(given: Any, seed: Any, bodies: int = 0) -> Design:
    """Make the points of the table ``[sweep]``; the seed is that of a design that is drawn.

    Where there are several bodies, their numbers from 0 are the first axis.

    Parameters are named by their place, each with a list of values or ``{from, to, points, scale}``; a design
    that is not a grid has a number of ``points`` for all of them.
    """
    if not isinstance(given, Mapping):
        raise ParameterError(wrong("sweep", given, "a table [sweep]"))
    options = {key: given[key] for key in ("design", "points") if key in given}
    kind = word("sweep.design", options.get("design", "grid"), DESIGNS)
    if bodies:
        if kind != "grid":
            raise ParameterError(wrong("sweep.design", kind, "'grid', because there are several bodies"))
        if "body" in given:
            text = ": must be left out, because there are several bodies"
            raise ParameterError(Problem("sweep.body", text))
        given = {"body": list(range(bodies)), **given}
    varied = _each_once({key: value for key, value in given.items() if key not in options})
    if not varied:
        text = ': nothing is varied; name parameters, as in "body.separation" = [3e-5, 1e-4]'
        raise ParameterError(Problem("sweep", text))
    names = _names(list(varied))
    if kind == "grid":
        if "points" in options:
            text = ": is for design = 'latin-hypercube' or 'sobol'; on a grid each parameter has its own"
            raise ParameterError(Problem("sweep.points", text))
        axes = tuple(Axis(key, name, _on_grid(key, varied[key])) for key, name in names.items())
    else:
        points = whole("sweep.points", options.get("points"), 1, _MOST_POINTS)
        if kind == "sobol" and points & (points - 1):
            allowed = "a power of 2, for which a Sobol set is balanced"
            raise ParameterError(wrong("sweep.points", points, allowed))
        unit = _spread(kind, points, len(varied), whole("run.seed", seed, 0, 2**64 - 1))
        axes = tuple(
            Axis(key, name, tuple(_between(key, varied[key], unit[:, i]).tolist()))
            for i, (key, name) in enumerate(names.items())
        )
    found = Design(kind, axes)
    if found.points > _MOST_POINTS:
        raise ParameterError(Problem("sweep", f": {found.points:,} points: must be at most {_MOST_POINTS:,}"))
    return found


def design_again(given: Any) -> Design:
    """Make the points of `Study.identity` again, which has the values of those that were drawn."""
    if not isinstance(given, Mapping):
        raise ParameterError(wrong("sweep", given, "a table [sweep]"))
    kind = word("sweep.design", given.get("design"), DESIGNS)
    varied = {key: value for key, value in given.items() if key != "design"}
    axes = tuple(Axis(key, name, _on_grid(key, varied[key])) for key, name in _names(list(varied)).items())
    sizes = {len(axis.values) for axis in axes}
    if not sizes or (kind != "grid" and len(sizes) > 1):
        raise ParameterError(wrong("sweep", given, "parameters, with a value of each for every point"))
    return Design(kind, axes)


def _each_once(given: Mapping[str, Any]) -> dict[str, Any]:
    """Name varied parameters by their place, and refuse one that would replace another value in use."""
    varied: dict[str, Any] = {}
    for key, value in _varied(given):
        if key in varied:
            text = ": appears twice; must appear once, in quotes or as a table"
            raise ParameterError(Problem(f"sweep.{key}", text))
        varied[key] = value
    for outer in varied:
        for key in varied:
            if key.startswith(f"{outer}."):
                text = f": must be left out, or sweep.{outer}, which it is a part of"
                raise ParameterError(Problem(f"sweep.{key}", text))
    return varied


def _varied(given: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Flatten tables, so that quoted and bare keys mean the same; an empty one is a wrong value."""
    for key, value in given.items():
        if isinstance(value, Mapping) and value and not set(value) & {"from", "to"}:
            yield from _varied(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def _names(parameters: list[str]) -> dict[str, str]:
    """Name each parameter by its last word, or by all of them where that is taken."""
    # An element of a list with its list: semi_axes_2 for body.semi_axes.2.
    last = [re.findall(r"[^.]*(?:\.\d+)*$", one)[0].replace(".", "_") for one in parameters]
    return {
        parameter: parameter.replace(".", "_") if short in _TAKEN or last.count(short) > 1 else short
        for parameter, short in zip(parameters, last, strict=True)
    }


def _on_grid(key: str, value: Any) -> tuple[float, ...]:
    if isinstance(value, Mapping) and value:
        points = whole(f"sweep.{key}.points", value.get("points"), 2, _MOST_POINTS)
        ends = {name: part for name, part in value.items() if name != "points"}
        return tuple(_between(key, ends, np.linspace(0.0, 1.0, points)).tolist())
    array = isinstance(value, np.ndarray) and value.ndim == 1 and value.dtype.kind in "iuf"
    listed = array or isinstance(value, list | tuple)
    if listed and len(value) > _MOST_POINTS:
        text = f" has {len(value):,} values: must have at most {_MOST_POINTS:,}"
        raise ParameterError(Problem(f"sweep.{key}", text))
    values = _numbers(key, value, tuple(value) if listed else ())
    if not values or len(set(values)) < len(values):
        raise ParameterError(wrong(f"sweep.{key}", value, _VALUES))
    for i, one in enumerate(values):
        if int(one) != int(float(one)):
            allowed = "a number that a double, as in the results, holds exactly: a whole one up to 2**53"
            raise ParameterError(wrong(f"sweep.{key}[{i}]", one, allowed))
    return values


def _numbers(key: str, value: Any, given: tuple[Any, ...]) -> tuple[int | float, ...]:
    """Take numbers that `value` holds."""
    try:
        return tuple(number(f"sweep.{key}", one, _VALUES) for one in given)
    except ParameterError:
        raise ParameterError(wrong(f"sweep.{key}", value, _VALUES)) from None


def _between(key: str, value: Any, unit: FloatArray) -> FloatArray:
    """Map [0, 1] to the range of a parameter, its ends to its ends exactly."""
    if not isinstance(value, Mapping):
        allowed = "a table { from, to } in a design that is not a grid"
        raise ParameterError(wrong(f"sweep.{key}", value, allowed))
    table(f"sweep.{key}", value, ("from", "to", "scale"))
    low, high = _numbers(key, value, (value.get("from"), value.get("to")))
    if not low < high:
        raise ParameterError(wrong(f"sweep.{key}", value, _VALUES))
    scale = word(f"sweep.{key}.scale", value.get("scale", "linear"), ("linear", "log"))
    if scale == "log" and low <= 0:
        raise ParameterError(wrong(f"sweep.{key}.from", low, "> 0 where the scale is logarithmic"))
    width = high / low if scale == "log" else high - low
    if not math.isfinite(width):
        allowed = "such that to - from, or on a logarithmic scale to / from, is finite"
        raise ParameterError(wrong(f"sweep.{key}", value, allowed))
    inside = low * width**unit if scale == "log" else low + width * unit
    # Fifteen digits, so that a value reads as it was meant and is the same on every platform.
    rounded = np.array([float(f"{x:.15g}") for x in inside])
    found = np.where(unit == 0.0, low, np.where(unit == 1.0, high, rounded))
    if not np.all(np.diff(found[np.argsort(unit)]) > 0):
        allowed = f"so far apart that its {unit.size} points differ in 15 digits"
        raise ParameterError(wrong(f"sweep.{key}", value, allowed))
    return found


def _spread(kind: str, number: int, dimensions: int, seed: int) -> FloatArray:
    from scipy.stats import qmc

    sampler = qmc.Sobol if kind == "sobol" else qmc.LatinHypercube
    return np.asarray(sampler(dimensions, rng=np.random.default_rng(seed)).random(number))
