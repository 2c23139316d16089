"""What is varied in a study: values of named parameters, on a grid or spread over their ranges."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from restitution._internal.arrays import whole
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.study._tables import check_keys, number, word

_VALUES = (
    "a list of different numbers, or a table { from, to, points } with finite from < to"
    ' and perhaps scale = "linear" or "log"'
)
_KEYS = ("from", "to", "scale")
_SCALES = ("linear", "log")
DESIGNS = ("grid", "latin-hypercube", "sobol")
_MOST_POINTS = 10_000_000

# Dimensions and variables that results have of their own.
_TAKEN = [
    "release_velocity",
    "restitution",
    "fraction",
    "impact",
    "stop_reason",
    "point",
    "batch",
    "status",
    "particles",
    "digest",
    "level",
    "number",
    "variance",
    "density",
    "skewness",
    "kurtosis",
    "minimum",
    "maximum",
    "undefined",
]


@dataclass(frozen=True)
class Axis:
    """One parameter that is varied.

    Attributes
    ----------
    parameter : str
        Its place in a file: ``body.separation``.
    name : str
        What it is called in the results.
    values : tuple of float
        In increasing or any other order; of a design that is not a grid those of all points.
    """

    parameter: str
    name: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class Design:
    """The points of a study.

    Attributes
    ----------
    kind : str
        One of `DESIGNS`.
    axes : tuple of Axis
        With a grid, the points are all combinations, the last axis varying fastest.
    """

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
        """Parameters of a point by their place in a file."""
        place = self.place(point)
        index = place if self.kind == "grid" else place * len(self.axes)
        return {axis.parameter: axis.values[i] for axis, i in zip(self.axes, index, strict=True)}


def design(table: Any, seed: Any) -> Design:
    """Make the points of the table ``[sweep]``.

    Parameters
    ----------
    table : mapping
        Parameters by their place, ``"body.separation"``, each with a list of values or ``{from, to, points,
        scale}``; and perhaps ``design``, with the number of ``points`` if it is not a grid.
    seed : int
        Seed of a design that is drawn.

    Raises
    ------
    ValueError
        If a value is not allowed.
    """
    if not isinstance(table, Mapping):
        raise ParameterError(wrong("sweep", table, "a table [sweep]"))
    options = {key: table[key] for key in ("design", "points") if key in table}
    kind = word("sweep.design", options.get("design", "grid"), DESIGNS)
    varied = _each_once({key: value for key, value in table.items() if key not in options})
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
            raise ParameterError(
                wrong("sweep.points", points, "a power of 2, or a Sobol set loses its balance")
            )
        unit = _spread(kind, points, len(varied), whole("run.seed", seed, 0, 2**64 - 1))
        axes = tuple(
            Axis(key, name, tuple(_between(key, varied[key], unit[:, i]).tolist()))
            for i, (key, name) in enumerate(names.items())
        )
    found = Design(kind, axes)
    if found.points > _MOST_POINTS:
        raise ParameterError(Problem("sweep", f": {found.points:,} points: must be at most {_MOST_POINTS:,}"))
    return found


def design_again(table: Any) -> Design:
    """Make the points of `Study.identity` again, which has the values of those that were drawn."""
    if not isinstance(table, Mapping):
        raise ParameterError(wrong("sweep", table, "a table [sweep]"))
    kind = word("sweep.design", table.get("design"), DESIGNS)
    varied = {key: value for key, value in table.items() if key != "design"}
    axes = tuple(Axis(key, name, _on_grid(key, varied[key])) for key, name in _names(list(varied)).items())
    sizes = {len(axis.values) for axis in axes}
    if not sizes or (kind != "grid" and len(sizes) > 1):
        raise ParameterError(wrong("sweep", table, "parameters, with a value of each for every point"))
    return Design(kind, axes)


def _each_once(table: Mapping[str, Any]) -> dict[str, Any]:
    """Name what is varied by its place, and refuse what would replace something else that is asked for."""
    varied: dict[str, Any] = {}
    for key, value in _varied(table):
        if key in varied:
            text = ": is there twice; must be there once, in quotes or as a table"
            raise ParameterError(Problem(f"sweep.{key}", text))
        varied[key] = value
    for key in varied:
        parts = key.split(".")
        for outer in (".".join(parts[:i]) for i in range(1, len(parts))):
            if outer in varied:
                text = f": must be left out, or sweep.{outer}, which it is a part of"
                raise ParameterError(Problem(f"sweep.{key}", text))
    return varied


def _varied(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Flatten tables, so that quoted and bare keys mean the same; an empty one is a wrong value."""
    for key, value in table.items():
        if isinstance(value, Mapping) and value and not set(value) & {"from", "to"}:
            yield from _varied(value, f"{prefix}{key}.")
        else:
            yield prefix + key, value


def _names(parameters: list[str]) -> dict[str, str]:
    """Name each parameter by its last word, or by all of them where that is taken."""
    last = [parameter.rpartition(".")[2] for parameter in parameters]
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


def _between(key: str, value: Any, unit: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Map [0, 1] to the range of a parameter, its ends to its ends exactly."""
    if not isinstance(value, Mapping):
        raise ParameterError(
            wrong(f"sweep.{key}", value, "a table { from, to } in a design that is not a grid")
        )
    check_keys(f"sweep.{key}", value, _KEYS, f"sweep.{key}")
    low, high = _numbers(key, value, (value.get("from"), value.get("to")))
    if not low < high:
        raise ParameterError(wrong(f"sweep.{key}", value, _VALUES))
    scale = word(f"sweep.{key}.scale", value.get("scale", "linear"), _SCALES)
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


def _spread(kind: str, number: int, dimensions: int, seed: int) -> npt.NDArray[np.float64]:
    from scipy.stats import qmc

    random = np.random.default_rng(seed)
    if kind == "sobol":
        return np.asarray(qmc.Sobol(dimensions, rng=random).random(number))
    return np.asarray(qmc.LatinHypercube(dimensions, rng=random).random(number))
