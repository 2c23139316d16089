"""What is varied in a study: values of named parameters, on a grid or spread over their ranges."""

import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from restitution._parameters import ParameterError, Problem, _plain_number, unknown, wrong

_VALUES = (
    "a list of different numbers, or a table { from, to, points } with finite from < to"
    ' and perhaps scale = "linear" or "log"'
)
_KEYS = ("from", "to", "points", "scale")
_SCALES = ("linear", "log")
DESIGNS = ("grid", "latin-hypercube", "sobol")
_MOST_POINTS = 10_000_000
_LARGEST = sys.float_info.max
_DEEPEST = 8

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


def design(table: Mapping[str, Any], seed: int) -> Design:
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
    kind = options.get("design", "grid")
    if not isinstance(kind, str) or kind not in DESIGNS:
        raise ParameterError(wrong("sweep.design", kind, " or ".join(map(repr, DESIGNS))))
    varied: dict[str, Any] = {}
    for key, value in _varied({key: value for key, value in table.items() if key not in options}):
        if key in varied:
            raise ParameterError(Problem(f'sweep."{key}"', ": is there twice, quoted and as a table"))
        varied[key] = value
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
        number = options.get("points")
        if not isinstance(number, int) or isinstance(number, bool) or not 1 <= number <= _MOST_POINTS:
            raise ParameterError(wrong("sweep.points", number, f"a whole number in [1, {_MOST_POINTS:,}]"))
        if kind == "sobol" and number & (number - 1):
            raise ParameterError(
                wrong("sweep.points", number, "a power of 2, or a Sobol set loses its balance")
            )
        unit = _spread(kind, number, len(varied), seed)
        axes = tuple(
            Axis(key, name, tuple(_between(key, varied[key], unit[:, i]).tolist()))
            for i, (key, name) in enumerate(names.items())
        )
    found = Design(kind, axes)
    if found.points > _MOST_POINTS:
        raise ParameterError(Problem("sweep", f": {found.points:,} points: must be at most {_MOST_POINTS:,}"))
    return found


def _varied(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Flatten tables, so that quoted and bare keys mean the same."""
    for key, value in table.items():
        if not isinstance(key, str):
            raise ParameterError(unknown(key, "[sweep]", ("parameters",), prefix=f"sweep.{prefix}"))
        if prefix.count(".") > _DEEPEST:
            raise ParameterError(Problem(f"sweep.{prefix}", ": tables in tables; parameters have few words"))
        if isinstance(value, Mapping) and not set(value) & {"from", "to"}:
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
    if isinstance(value, Mapping):
        number = value.get("points")
        if not isinstance(number, int) or isinstance(number, bool) or not 2 <= number <= _MOST_POINTS:
            allowed = f"a whole number in [2, {_MOST_POINTS:,}]"
            raise ParameterError(wrong(f"sweep.{key}.points", number, allowed))
        spread = tuple(_between(key, value, np.linspace(0.0, 1.0, number)).tolist())
        if len(set(spread)) < number:
            allowed = f"so far apart that {number} values differ in 15 digits"
            raise ParameterError(wrong(f"sweep.{key}", dict(value), allowed))
        return spread
    # Durations would become whole numbers.
    numbers = isinstance(value, np.ndarray) and value.dtype.kind in "iuf"
    values = value.tolist() if numbers else value
    good = isinstance(values, list | tuple) and len(values) > 0 and all(map(_is_number, values))
    # Axes of results are doubles.
    if not good or len(set(map(float, values))) < len(values) or any(float(x) != x for x in values):
        raise ParameterError(wrong(f"sweep.{key}", value, _VALUES))
    return tuple(_plain_number(number) for number in values)


def _between(key: str, value: Any, unit: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Map [0, 1] to the range of a parameter, its ends to its ends exactly."""
    if not isinstance(value, Mapping):
        raise ParameterError(
            wrong(f"sweep.{key}", value, "a table { from, to } in a design that is not a grid")
        )
    for stranger in set(value) - set(_KEYS):
        raise ParameterError(unknown(stranger, f"sweep.{key}", _KEYS, prefix=f"sweep.{key}."))
    low: Any = value.get("from")
    high: Any = value.get("to")
    scale = value.get("scale", "linear")
    if not (_is_number(low) and _is_number(high) and low < high and math.isfinite(float(high) - float(low))):
        raise ParameterError(wrong(f"sweep.{key}", dict(value), _VALUES))
    if not isinstance(scale, str) or scale not in _SCALES:
        raise ParameterError(wrong(f"sweep.{key}.scale", scale, " or ".join(map(repr, _SCALES))))
    if scale == "log" and low <= 0:
        raise ParameterError(wrong(f"sweep.{key}.from", low, "> 0 where the scale is logarithmic"))
    inside = low * (high / low) ** unit if scale == "log" else low + (high - low) * unit
    # Fifteen digits, so that a value reads as it was meant and is the same on every platform.
    rounded = np.array([float(f"{x:.15g}") for x in inside])
    return np.where(unit == 0.0, low, np.where(unit == 1.0, high, rounded))


def _spread(kind: str, number: int, dimensions: int, seed: int) -> npt.NDArray[np.float64]:
    from scipy.stats import qmc

    random = np.random.default_rng(seed)
    if kind == "sobol":
        return np.asarray(qmc.Sobol(dimensions, rng=random).random(number))
    return np.asarray(qmc.LatinHypercube(dimensions, rng=random).random(number))


def _is_number(value: Any) -> bool:
    value = _plain_number(value)
    if not isinstance(value, int | float) or isinstance(value, bool):
        return False
    return abs(value) <= _LARGEST
