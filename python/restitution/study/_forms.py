"""What a study takes from the statistics of a point by name: quantiles of p(ε | v), a density fitted."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import xarray as xr

from restitution._parameters import ParameterError, Problem, unknown, wrong
from restitution._run import Run
from restitution._statistics import Edges

FAMILIES = ("asymmetric-laplace", "laplace", "gaussian", "logistic", "student-t", "cusp-mixture")
_CUSPED = ("asymmetric-laplace", "cusp-mixture")
_LEVELS = 33
_MOST_LEVELS = 10_001


class Form(Protocol):
    """Gives variables for the statistics of a run; those of real numbers then get standard errors."""

    @property
    def name(self) -> str:
        """The table of the study that asks for it."""

    def table(self) -> dict[str, Any]:
        """Everything that it depends on, as plain values."""

    def __call__(self, run: Run, statistics: xr.Dataset) -> xr.Dataset:
        """Measure."""


@dataclass(frozen=True)
class Learn:
    """The learned distribution of every impact velocity bin, as quantiles.

    Attributes
    ----------
    levels : tuple of float
        Probabilities, increasing, in [0, 1].
    """

    levels: tuple[float, ...]
    name = "learn"

    def table(self) -> dict[str, Any]:
        """Give the levels."""
        return {"levels": list(self.levels)}

    def __call__(self, run: Run, statistics: xr.Dataset) -> xr.Dataset:
        """Give ``restitution_quantile`` (velocity, level); NaN where there are too few impacts."""
        from restitution.distribution._from_statistics import quantiles

        level = xr.Variable("level", np.array(self.levels), {"long_name": "probability of a smaller one"})
        about = {"long_name": "quantile of restitution"}
        values = quantiles(statistics, np.array(self.levels))
        return xr.Dataset(
            {"restitution_quantile": (("velocity", "level"), values, about)},
            {"level": level, "velocity": statistics["velocity"]},
        )


@dataclass(frozen=True)
class Fitted:
    """A density fitted to the impacts of a window of impact velocity.

    Attributes
    ----------
    family : str
        One of `FAMILIES`.
    velocity : tuple of two floats
        Edges of velocity bins, in m/s.
    at_normal : bool
        Whether the cusp is at the law's ε_n; else it is fitted.
    """

    family: str
    velocity: tuple[float, float]
    at_normal: bool
    name = "fit"

    def table(self) -> dict[str, Any]:
        """Give the parameters as a file has them."""
        cusp = {"location": "normal"} if self.at_normal else {}
        return {"family": self.family, "velocity": list(self.velocity), **cusp}

    def __call__(self, run: Run, statistics: xr.Dataset) -> xr.Dataset:
        """Give ``fit_…`` for each parameter, and ``fit_distance``; NaN where no density can be fitted."""
        from restitution import fit
        from restitution.fit._source import counted

        location = {"location": run.law.normal} if self.at_normal else {}
        function = getattr(fit, self.family.replace("-", "_"))
        words = {name: f"{name} of the {self.family} density" for name in _PARAMETERS[self.family]}
        try:
            found = function(statistics, velocity=self.velocity, **location)
            counts = counted(statistics, self.velocity)
            distance = float(np.abs(counts.cumulative() - found.cdf(counts.edges)).max())
            values = {name: float(found.parameters[name]) for name in words}
        except ValueError:  # a body may be so round that all impacts are in a bin or two
            distance, values = np.nan, dict.fromkeys(words, np.nan)
        variables = {f"fit_{name}": ((), values[name], {"long_name": text}) for name, text in words.items()}
        about = {"long_name": "largest difference of the cumulative shares, at the edges of bins"}
        return xr.Dataset(variables | {"fit_distance": ((), distance, about)})


_PARAMETERS = {
    "asymmetric-laplace": ("location", "above", "below"),
    "laplace": ("location", "scale"),
    "gaussian": ("mean", "deviation"),
    "logistic": ("location", "scale"),
    "student-t": ("degrees", "location", "scale"),
    "cusp-mixture": ("share", "location", "above", "below", "mean", "deviation"),
}


def forms_of(tables: Mapping[str, Any], edges: Edges | None, run: Run) -> tuple[Form, ...]:
    """Read ``[learn]`` and ``[fit]``.

    Raises
    ------
    ParameterError
        If a value is not allowed, or there are no statistics by impact velocity to take it from.
    """
    found: list[Form] = []
    for name, read in (("learn", _learn), ("fit", _fit)):
        if name not in tables:
            continue
        if edges is None or edges["velocity"] is None:
            text = f": missing; [{name}] is taken from statistics by impact velocity"
            raise ParameterError(Problem("statistics.velocity_bins", text))
        if not isinstance(tables[name], Mapping):
            raise ParameterError(wrong(name, tables[name], f"a table [{name}]"))
        found.append(read(tables[name], edges, run))
    return tuple(found)


def _learn(table: Mapping[str, Any], edges: Edges, run: Run) -> Learn:
    _known(table, "learn", ("levels",))
    levels = table.get("levels", _LEVELS)
    allowed = f"a number of levels in [2, {_MOST_LEVELS}], from 0 to 1, or increasing levels in [0, 1]"
    if isinstance(levels, int) and not isinstance(levels, bool):
        if not 2 <= levels <= _MOST_LEVELS:
            raise ParameterError(wrong("learn.levels", levels, allowed))
        return Learn(tuple(np.linspace(0.0, 1.0, levels).tolist()))
    try:
        given = np.array(levels, dtype=np.float64)
    except (TypeError, ValueError):
        given = np.empty(0)
    good = given.ndim == 1 and 1 <= given.size <= _MOST_LEVELS and bool(np.all(np.diff(given) > 0))
    if not good or given[0] < 0.0 or given[-1] > 1.0:
        raise ParameterError(wrong("learn.levels", levels, allowed))
    return Learn(tuple(given.tolist()))


def _fit(table: Mapping[str, Any], edges: Edges, run: Run) -> Fitted:
    from restitution.fit._source import window

    _known(table, "fit", ("family", "velocity", "location"))
    family = table.get("family", FAMILIES[0])
    if family not in FAMILIES:
        raise ParameterError(wrong("fit.family", family, " or ".join(map(repr, FAMILIES))))
    if "velocity" not in table:
        raise ParameterError(
            Problem("fit.velocity", ": missing; must be edges of velocity bins, (low, high)")
        )
    low, high = window(table["velocity"])
    bins = edges["velocity"]
    assert bins is not None
    if not all(np.isclose(bins, end, rtol=0.0, atol=1e-6 * (bins[1] - bins[0])).any() for end in (low, high)):
        raise ParameterError(
            wrong("fit.velocity", table["velocity"], "a pair (low, high) of edges of velocity bins")
        )
    at_normal = "location" in table
    if at_normal and (table["location"] != "normal" or family not in _CUSPED):
        allowed = f"'normal', the law's ε_n, and for a family with a cusp: {' or '.join(_CUSPED)}"
        raise ParameterError(wrong("fit.location", table["location"], allowed))
    if family == "cusp-mixture" and not at_normal:
        raise ParameterError(Problem("fit.location", ": missing; a cusp-mixture needs location = 'normal'"))
    if at_normal and not isinstance(run.law.normal, float):
        text = " = 'normal': must be left out; the law's ε_n depends on the speed"
        raise ParameterError(Problem("fit.location", text))
    return Fitted(family, (low, high), at_normal)


def _known(table: Mapping[str, Any], name: str, names: tuple[str, ...]) -> None:
    for stranger in set(table) - set(names):
        raise ParameterError(unknown(stranger, f"[{name}]", names, prefix=f"{name}."))
