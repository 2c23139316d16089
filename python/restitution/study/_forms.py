"""What a study takes from the statistics of a point by name: quantiles of p(ε | v), a density fitted."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import xarray as xr

from restitution._internal.arrays import reals
from restitution._internal.parameters import ParameterError, Problem, plain_number, wrong
from restitution.drop.run import Run
from restitution.drop.statistics import Edges
from restitution.study._tables import table, word

FAMILIES = ("asymmetric-laplace", "laplace", "gaussian", "logistic", "student-t", "cusp-mixture")
_CUSPED = ("asymmetric-laplace", "cusp-mixture")
_LEVELS = 33
_MOST_LEVELS = 10_001


class Form(Protocol):
    """Gives variables for the statistics of a run; those of real numbers then get standard errors."""

    @property
    def name(self) -> str:
        """The table of the study that asks for it."""

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of what it gives."""

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
    variables = ("restitution_quantile",)

    def table(self) -> dict[str, Any]:
        """Give the levels."""
        return {"levels": list(self.levels)}

    def __call__(self, run: Run, statistics: xr.Dataset) -> xr.Dataset:
        """Give ``restitution_quantile`` (velocity, level); NaN where there are too few impacts."""
        from restitution.distribution import quantiles

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

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the parameters, and of the distance."""
        return (*(f"fit_{name}" for name in _PARAMETERS[self.family]), "fit_distance")

    def table(self) -> dict[str, Any]:
        """Give the parameters as a file has them."""
        cusp = {"location": "normal"} if self.at_normal else {}
        return {"family": self.family, "velocity": list(self.velocity), **cusp}

    def __call__(self, run: Run, statistics: xr.Dataset) -> xr.Dataset:
        """Give ``fit_…`` for each parameter, and ``fit_distance``; NaN where no density can be fitted."""
        from restitution import fit
        from restitution.fit.source import counted

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
        found.append(read(tables[name], edges, run))
    return tuple(found)


def _learn(given: Any, edges: Edges, run: Run) -> Learn:
    levels = table("learn", given, ("levels",)).get("levels", _LEVELS)
    allowed = f"a number of levels in [2, {_MOST_LEVELS}], from 0 to 1, or increasing levels in [0, 1]"
    number = plain_number(levels)
    if isinstance(number, int) and 2 <= number <= _MOST_LEVELS:
        return Learn(tuple(np.linspace(0.0, 1.0, number).tolist()))
    probabilities = reals("learn.levels", levels, allowed, dimensions=(1,))
    within = bool(np.all((probabilities >= 0.0) & (probabilities <= 1.0)))
    if not 1 <= probabilities.size <= _MOST_LEVELS or not within or not np.all(np.diff(probabilities) > 0):
        raise ParameterError(wrong("learn.levels", levels, allowed))
    return Learn(tuple(probabilities.tolist()))


def _fit(given: Any, edges: Edges, run: Run) -> Fitted:
    own = table("fit", given, ("family", "velocity", "location"))
    family = word("fit.family", own.get("family", FAMILIES[0]), FAMILIES)
    if "velocity" not in own:
        raise ParameterError(
            Problem("fit.velocity", ": missing; must be edges of velocity bins, (low, high)")
        )
    low, high = _window(own["velocity"], edges)
    at_normal, location = "location" in own, own.get("location")
    if at_normal and (not isinstance(location, str) or location != "normal" or family not in _CUSPED):
        allowed = f"'normal', the law's ε_n, and for a family with a cusp: {' or '.join(_CUSPED)}"
        raise ParameterError(wrong("fit.location", location, allowed))
    if family == "cusp-mixture" and not at_normal:
        raise ParameterError(Problem("fit.location", ": missing; a cusp-mixture needs location = 'normal'"))
    if at_normal and not isinstance(run.law.normal, float):
        text = " = 'normal': must be left out; the law's ε_n depends on the speed"
        raise ParameterError(Problem("fit.location", text))
    return Fitted(family, (low, high), at_normal)


def _window(velocity: Any, edges: Edges) -> tuple[float, float]:
    """Take a window that whole bins make up."""
    bins = edges["velocity"]
    assert bins is not None
    allowed = "a pair (low, high) of edges of velocity bins, with low < high"
    ends = reals("fit.velocity", velocity, allowed, unit="m s-1", dimensions=(1,))
    closest = [np.abs(bins - end).min() for end in ends]
    if ends.shape != (2,) or not ends[0] < ends[1] or max(closest) > 1e-6 * (bins[1] - bins[0]):
        raise ParameterError(wrong("fit.velocity", velocity, allowed))
    return float(ends[0]), float(ends[1])
