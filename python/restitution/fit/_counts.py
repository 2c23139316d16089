"""Binned counts in the place of samples, and the fit that maximises their likelihood."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, TypeAlias

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy import optimize

from restitution._internal.arrays import real, reals, whole
from restitution._internal.datasets import Content
from restitution._internal.parameters import ParameterError, wrong
from restitution.drop.bins import increasing_edges
from restitution.drop.recorded import check_counts, counted
from restitution.fit._result import Array, Fit, in_parts

Maker: TypeAlias = Callable[[Array, float, float], tuple[Any, dict[str, float]]]
"""From an unbounded point, the median and the spread to a distribution and its parameters."""


class Unfrozen:
    """A distribution of SciPy's with its parameters, which takes longer to freeze than to evaluate."""

    def __init__(self, family: Any, *values: float, **where: float) -> None:
        self._family, self._values, self._where = family, values, where

    def cdf(self, x: Array) -> Any:
        """Return the probability below x."""
        return self._family.cdf(x, *self._values, **self._where)

    def sf(self, x: Array) -> Any:
        """Return the probability above x."""
        return self._family.sf(x, *self._values, **self._where)

    def frozen(self) -> Any:
        """Freeze it."""
        return self._family(*self._values, **self._where)


_IMPOSSIBLE = 1e-300
"""Probability of a bin where the distribution says 0: the likelihood must stay a number to be maximised."""


@dataclass(frozen=True, eq=False)
class Counts(Content):
    """Number of samples in each bin, which every fit accepts in place of the samples.

    Parameters
    ----------
    edges : ndarray, shape (bins + 1,)
        Strictly increasing, finite; the bins may have any width.
    count : ndarray, shape (bins,)
        Samples in each bin, whole numbers >= 0.
    below, above : int, default 0
        Samples below the first and above the last edge.

    Raises
    ------
    ValueError
        If shapes, edges or counts are not as they must be, or fewer than two bins are filled.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).laplace(0.98, 0.03, 1000)
    >>> count, edges = np.histogram(x, bins=np.linspace(0.7, 1.3, 61))
    >>> counts = fit.Counts(edges, count, below=int((x < 0.7).sum()), above=int((x > 1.3).sum()))
    >>> bool(abs(fit.laplace(counts).parameters["scale"] - fit.laplace(x).parameters["scale"]) < 1e-3)
    True
    """

    edges: Array
    count: Array
    below: int = 0
    above: int = 0

    def __post_init__(self) -> None:
        edges = increasing_edges(self.edges, "edges")
        allowed = f"a 1-D array of {edges.size - 1} counts >= 0, one for each bin"
        count = np.array(reals("count", self.count, allowed, dimensions=(1,)))
        if count.size != edges.size - 1:
            raise ParameterError(wrong("count", self.count, allowed))
        check_counts("count", count)
        below, above = (whole(name, getattr(self, name), 0, 2**53) for name in ("below", "above"))
        numbers = np.concatenate([[below], count, [above]])
        if np.count_nonzero(numbers) < 2:
            raise ValueError(
                f"count: {np.count_nonzero(numbers)} bin(s) filled; the likelihood of a scale has no maximum"
            )
        for array in (edges, count):
            array.flags.writeable = False
        for name, value in (("edges", edges), ("count", count), ("below", below), ("above", above)):
            object.__setattr__(self, name, value)

    @classmethod
    def at(cls, statistics: xr.Dataset, velocity: float) -> Counts:
        """Take the counts of the velocity bin that holds `velocity`, in m/s, from `restitution.statistics`.

        Raises
        ------
        ValueError
            If no velocity bin holds it.
        """
        statistics = counted("statistics", statistics)
        speed = "a speed in m/s, in one of the velocity bins"
        velocity = real("velocity", velocity, speed, unit="m s-1")
        edges = statistics["velocity_edges"].to_numpy()
        row = int(np.searchsorted(edges, velocity, side="right")) - 1
        if not 0 <= row < edges.size - 1:
            raise ValueError(f"velocity = {velocity!r}: must be in [{edges[0]}, {edges[-1]}) m/s, the bins")
        return of_bins(statistics, slice(row, row + 1))

    @property
    def total(self) -> int:
        """Number of samples."""
        return int(self.count.sum() + self.below + self.above)

    @property
    def all(self) -> Array:
        """Counts with those below first and those above last, shape (bins + 2,)."""
        return np.concatenate([[self.below], self.count, [self.above]])

    def cumulative(self) -> Array:
        """Return the share of the samples below each edge, shape (bins + 1,)."""
        return np.asarray(np.cumsum(self.all)[:-1] / self.total)

    def logshare(self, distribution: Any) -> Array:
        """Return ln of the probability of each bin, the open ones first and last, shape (bins + 2,)."""
        if not all(callable(getattr(distribution, name, None)) for name in ("cdf", "sf")):
            allowed = "a distribution, with methods cdf and sf"
            raise ParameterError(wrong("distribution", distribution, allowed))
        below, above = distribution.cdf(self.edges), distribution.sf(self.edges)
        # Differences of the smaller of both, where nothing cancels.
        inner = np.where(below[1:] < 0.5, np.diff(below), -np.diff(above))
        share = np.concatenate([[below[0]], inner, [above[-1]]])
        return np.asarray(np.log(np.maximum(share, _IMPOSSIBLE)))

    def loglikelihood(self, distribution: Any) -> float:
        """Return ln of the probability of the counts, without terms independent of the distribution."""
        return float(self.all @ self.logshare(distribution))

    def quantile(self, q: Array | list[float]) -> Array:
        """Return quantiles, linear inside the bins, the outermost edges for the open ones; shape of `q`."""
        return np.asarray(
            np.interp(reals("q", q, "probabilities", finite=False), self.cumulative(), self.edges)
        )


def of_bins(statistics: xr.Dataset, rows: slice) -> Counts:
    """Take the counts of some velocity bins together."""
    below, count, above = (
        statistics[f"restitution_{name}"].isel(velocity=rows).sum("velocity").to_numpy()
        for name in ("underflow", "count", "overflow")
    )
    return Counts(statistics["restitution_edges"].to_numpy(), count, int(below), int(above))


def fit_counts(family: str, counts: Counts, make: Maker, start: ArrayLike, *, fixed: int = 0) -> Fit:
    """Maximise the likelihood of binned counts, Σ c_j ln(F(e_(j+1)) - F(e_j)), both open bins included.

    `make` makes the distribution of an unbounded point; `fixed` parameters were not fitted.

    Raises
    ------
    ValueError
        If no more bins are filled than there are parameters to fit: many densities then share a maximum.
    """
    point = np.asarray(start, dtype=np.float64)
    filled = np.count_nonzero(counts.all)
    if filled <= point.size:
        raise ValueError(
            f"count: {filled} bins are filled; {point.size} parameters need at least {point.size + 1}, "
            "give narrower bins"
        )
    low, median, high = (float(x) for x in counts.quantile([0.16, 0.5, 0.84]))
    spread = max((high - low) / 2.0, float(np.diff(counts.edges).min()))

    def cost(point: Array) -> float:
        return -counts.loglikelihood(make(point, median, spread)[0]) / counts.total

    # A simplex comes near the maximum from afar, a quasi-Newton method finds it. Where the slope is below
    # 1e-6 a step would gain less than 1e-12, near what rounding leaves of the cost.
    near = optimize.minimize(
        cost,
        point,
        method="Nelder-Mead",
        options={
            "initial_simplex": np.vstack([point, point + 0.5 * np.eye(point.size)]),
            "xatol": 1e-3,
            "fatol": 1e-8,
            "maxiter": 4000,
        },
    ).x
    point = optimize.minimize(cost, near, method="BFGS", jac="3-point", options={"gtol": 1e-6}).x
    distribution, parameters = make(point, median, spread)
    if isinstance(distribution, Unfrozen):
        distribution = distribution.frozen()
    return fitted(family, counts, distribution, fixed=fixed, **parameters)


def fitted(
    family: str, samples: Array | Counts, distribution: Any, *, fixed: int = 0, **parameters: float
) -> Fit:
    """Make the result for a density fitted to samples or counts; `fixed` parameters were not fitted."""
    return Fit(
        family=family,
        parameters=MappingProxyType({name: float(value) for name, value in parameters.items()}),
        free_parameters=len(parameters) - fixed,
        samples=samples.total if isinstance(samples, Counts) else samples.size,
        loglikelihood=loglikelihood(distribution, samples),
        distribution=distribution,
    )


def loglikelihood(distribution: Any, samples: Array | Counts) -> float:
    """Return the natural logarithm of the likelihood of samples or counts."""
    if isinstance(samples, Counts):
        return samples.loglikelihood(distribution)
    with np.errstate(over="ignore"):  # of a sample so far off that its density is 0
        return float(np.sum(in_parts(distribution.logpdf, samples)))
