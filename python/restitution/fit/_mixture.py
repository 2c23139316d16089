"""A cusp on a broad background: two exponentials that meet at ε_n, mixed with a Gaussian."""

from __future__ import annotations

from dataclasses import dataclass
from math import log
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy import optimize, special, stats

from restitution._internal.datasets import Content
from restitution.fit._asymmetric import asymmetric_laplace, frozen
from restitution.fit._counts import Counts, fit_counts, fitted
from restitution.fit._result import Array, Fit, drawn, draws
from restitution.fit.source import Samples, Window, cusp, taken

_NARROWEST = 1e-3
"""Least width of a part, over the spread of the samples: a narrower Gaussian would sit on one sample."""
_BOUNDS = [(-12.0, 12.0), *[(log(_NARROWEST), 7.0)] * 2, (-10.0, 10.0), (log(_NARROWEST), 7.0)]
"""Of a point of `_search`."""
_SPREAD_OUT = 2000
"""Samples that stand for counts where the search begins."""


@dataclass(frozen=True, eq=False)
class Mixture(Content):
    """A share of one distribution and the rest of another, with the methods that fits need.

    Parameters
    ----------
    share : float
        Of the first.
    first, second : frozen scipy.stats distribution
    """

    share: float
    first: Any
    second: Any

    def _compared(self) -> dict[str, Any]:
        # SciPy's distributions are equal to themselves alone.
        parts = {
            name: (type(one.dist), one.args, one.kwds)
            for name, one in (("first", self.first), ("second", self.second))
        }
        return {"share": self.share, **parts}

    def _both(self, what: str, x: ArrayLike) -> Array:
        one, other = (getattr(part, what)(x) for part in (self.first, self.second))
        return np.asarray(self.share * one + (1.0 - self.share) * other)

    def pdf(self, x: ArrayLike) -> Array:
        """Return the probability density."""
        return self._both("pdf", x)

    def logpdf(self, x: ArrayLike) -> Array:
        """Return the logarithm of the density, also where that underflows."""
        logs = np.array([self.first.logpdf(x), self.second.logpdf(x)])
        with np.errstate(divide="ignore"):
            weights = np.log([self.share, 1.0 - self.share]).reshape(2, *[1] * (logs.ndim - 1))
        return np.asarray(special.logsumexp(logs + weights, axis=0))

    def cdf(self, x: ArrayLike) -> Array:
        """Return the probability of a value up to x."""
        return self._both("cdf", x)

    def sf(self, x: ArrayLike) -> Array:
        """Return the probability of a larger value."""
        return self._both("sf", x)

    def ppf(self, q: ArrayLike) -> Array:
        """Return the quantile, by bisection between the quantiles of the parts."""
        levels = np.asarray(q, dtype=np.float64)
        ends = np.array([self.first.ppf(levels), self.second.ppf(levels)])
        low, high = ends.min(axis=0), ends.max(axis=0)
        for _ in range(200):
            middle = 0.5 * (low + high)
            below = self.cdf(middle) < levels
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        return np.asarray(0.5 * (low + high))

    def rvs(self, size: int, random_state: np.random.Generator) -> Array:
        """Draw independent values, shape (size,)."""
        chosen = draws(random_state.random, size) < self.share
        first, second = (drawn(part, size, random_state) for part in (self.first, self.second))
        return np.asarray(np.where(chosen, first, second))


def cusp_mixture(samples: Samples, location: float, *, velocity: Window | None = None) -> Fit:
    """Fit p = s p_cusp + (1 - s) p_Gauss: an asymmetric Laplace density with a fixed cusp, and a Gaussian.

    Where impacts of particles that hardly rotate, all near ε_n, are mixed with others, either form alone
    fails. The likelihood is maximised by a quasi-Newton method with its exact gradient, from two starts.

    Parameters
    ----------
    samples : array_like, Counts or xarray.Dataset
    velocity : float or tuple of two floats, optional
        As in `asymmetric_laplace`.
    location : float
        The cusp, e.g. the law's ε_n.

    Returns
    -------
    Fit
        With parameters ``share`` s, ``location``, ``above`` and ``below`` (of the cusp), ``mean`` and
        ``deviation`` (of the Gaussian).

    Raises
    ------
    ValueError
        As `asymmetric_laplace`, or if there are fewer than six samples.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> random = np.random.default_rng(1)
    >>> x = np.concatenate([random.laplace(0.98, 0.01, 1000), random.normal(0.9, 0.1, 3000)])
    >>> 0.2 < fit.cusp_mixture(x, 0.98).parameters["share"] < 0.3
    True
    """
    location = cusp(location)
    x = taken(samples, velocity, location)
    if isinstance(x, Counts):
        return _from_counts(x, location)
    if x.size < 6:
        raise ValueError(f"samples: {x.size} value(s); five parameters need at least six")
    spread = _spread(x, location)
    distribution, parameters = _made(_search(x, spread, location), spread, location)
    return fitted("cusp mixture", x, distribution, fixed=1, **parameters)


def _spread(x: Array, location: float) -> float:
    return float(np.std(x)) or abs(float(x[0]) - location)


def _search(x: Array, spread: float, location: float) -> Array:
    """Maximise the likelihood: logit of the share, ln of the widths, the Gaussian's mean."""
    start = asymmetric_laplace(x, location).parameters
    widths = [log(max(start[side] / spread, 10 * _NARROWEST)) for side in ("above", "below")]
    centre = (float(np.mean(x)) - location) / spread
    starts = [[0.0, *widths, centre, 0.3], [0.0, *(w - 1.0 for w in widths), centre, -0.5]]
    y = (x - location) / spread
    found = [
        optimize.minimize(_cost, point, args=(y,), jac=True, method="L-BFGS-B", bounds=_BOUNDS)
        for point in starts
    ]
    return np.asarray(min(found, key=lambda one: float(one.fun)).x)


def _cost(point: Array, y: Array) -> tuple[float, Array]:
    """Return -mean ln p of y, distances from the cusp over the spread, and its gradient."""
    share = special.expit(point[0])
    a, b, deviation = np.exp(point[[1, 2, 4]])
    up, down = np.maximum(y, 0.0), np.maximum(-y, 0.0)
    cusp = -up / a - down / b - log(a + b)
    z = (y - point[3]) / deviation
    gauss = -0.5 * z * z - log(deviation) - 0.5 * log(2 * np.pi)
    odds = special.logit(share) + cusp - gauss
    part = special.expit(odds)  # probability that a sample belongs to the cusp
    loglikelihood = np.mean(np.log1p(-share) + gauss + np.logaddexp(0.0, odds))
    slopes = [
        part - share,
        part * (up / a - a / (a + b)),
        part * (down / b - b / (a + b)),
        (1.0 - part) * z / deviation,
        (1.0 - part) * (z * z - 1.0),
    ]
    return -float(loglikelihood), -np.mean(slopes, axis=1)


def _made(point: Array, spread: float, location: float) -> tuple[Any, dict[str, float]]:
    """Make the distribution of a point of `_search`."""
    share = float(special.expit(point[0]))
    a, b, deviation = (float(x) for x in spread * np.exp(point[[1, 2, 4]]))
    mean = location + spread * float(point[3])
    density = Mixture(share, frozen(1.0, location, a, b), stats.norm(mean, deviation))
    named = {"above": a, "below": b, "mean": mean, "deviation": deviation}
    return density, {"share": share, "location": location, **named}


def _from_counts(counts: Counts, location: float) -> Fit:
    """Start where samples spread evenly inside the bins have their maximum: there are others, lower ones."""
    x = counts.quantile((np.arange(_SPREAD_OUT) + 0.5) / _SPREAD_OUT)
    spread = _spread(x, location)

    def make(point: Array, _median: float, _spread: float) -> tuple[Any, dict[str, float]]:
        return _made(np.clip(point, *np.transpose(_BOUNDS)), spread, location)

    return fit_counts("cusp mixture", counts, make, _search(x, spread, location), fixed=1)
