"""Asymmetric densities with a cusp: the Laplace distribution, fitted exactly, and its generalisation."""

from __future__ import annotations

from math import exp, log, sqrt
from typing import Any

import numpy as np
from scipy import optimize, special, stats

from restitution.fit._counts import Counts, Unfrozen, fit_counts, fitted
from restitution.fit._result import Array, Fit
from restitution.fit.source import Samples, Window, cusp, taken


def asymmetric_laplace(
    samples: Samples, location: float | None = None, *, velocity: Window | None = None
) -> Fit:
    """Fit p(x) = exp(−(x−m)/a)/(a+b) for x ≥ m, exp(−(m−x)/b)/(a+b) for x < m; exact maximum likelihood.

    The paper's "two exponential functions" (Sec. III, Fig. 4). With S⁺ = Σ(x−m)⁺ and S⁻ = Σ(m−x)⁺ the
    log-likelihood −n ln(a+b) − S⁺/a − S⁻/b is largest at a = √S⁺(√S⁺+√S⁻)/n, b = √S⁻(√S⁺+√S⁻)/n, where it
    is −n ln[(√S⁺+√S⁻)²/n] − n. Between two neighbouring samples S⁺ and S⁻ are linear in m, so √S⁺+√S⁻ is
    concave there and its minimum over m lies at a sample: one pass over the sorted samples finds it.

    Parameters
    ----------
    samples : array_like, Counts or xarray.Dataset
        Values, any shape, n ≥ 1, finite, not all equal (to `location`, if that is given); impacts as from
        `restitution.simulate`, of which those in the window `velocity` are taken; or binned counts, as
        `Counts` or as from `restitution.statistics`, for which the likelihood of the bins, Σ c_j ln ∫_j p dx
        with an open bin at either end, is maximised numerically.
    location : float, optional
        The cusp m, e.g. the law's ε_n; fitted if left out.
    velocity : float or tuple of two floats, optional
        For a Dataset, in m/s: the window (low, high) of the impact velocity, low ≤ v < high; for statistics a
        number too, which means the velocity bin that holds it. A window of statistics must end at edges.

    Returns
    -------
    Fit
        With parameters ``location`` m, ``above`` a and ``below`` b, in the unit of the samples; b = 0 (or
        a = 0) is the one-sided exponential.

    Raises
    ------
    ValueError
        If the samples are empty, not finite or without spread, no more bins are filled than there are
        parameters, the location is not finite, or the velocity is missing, superfluous or not in the data.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.simulate(rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98),
    ...                    particles=200, impacts=150)
    >>> found = rs.fit.asymmetric_laplace(data, location=0.98, velocity=(0.38, 0.42))
    >>> 0.02 < found.parameters["above"] < 0.03
    True
    """
    location = None if location is None else cusp(location)
    x = taken(samples, velocity, location)
    if isinstance(x, Counts):
        return _counted("asymmetric Laplace", x, location, 1.0)
    if location is None:
        m, above, below = _best_cusp(np.sort(x))
    else:
        m = location
        above, below = float(np.sum(np.maximum(x - m, 0))), float(np.sum(np.maximum(m - x, 0)))
    total = sqrt(above) + sqrt(below)
    a, b = sqrt(above) * total / x.size, sqrt(below) * total / x.size
    named = {"location": m, "above": a, "below": b}
    return fitted("asymmetric Laplace", x, frozen(1.0, m, a, b), fixed=int(location is not None), **named)


def _best_cusp(x: Array) -> tuple[float, float, float]:
    """Find the cusp among the sorted samples, with S⁺ and S⁻ there.

    Both sums grow by steps (samples passed) × (gap) ≥ 0, so nothing cancels.
    """
    gap, passed = np.diff(x), np.arange(1, x.size)
    below = np.concatenate(([0.0], np.cumsum(passed * gap)))
    above = np.concatenate((np.cumsum(passed * gap[::-1])[::-1], [0.0]))
    best = int(np.argmin(np.sqrt(above) + np.sqrt(below)))
    return float(x[best]), float(above[best]), float(below[best])


def asymmetric_power(
    samples: Samples, location: float | None = None, *, velocity: Window | None = None
) -> Fit:
    """Fit p(x) = k/((a+b) Γ(1/k)) exp(−|x−m|^k/w^k) with w = a above and w = b below the cusp m.

    It holds the asymmetric Laplace (``exponent`` k = 1), the generalised normal (a = b) and the Gaussian
    (a = b, k = 2), so k says how far the flanks are from exponential. For given m and k, with T± = Σ|x−m|^k
    on either side and s = (T⁺)^(1/(k+1)) + (T⁻)^(1/(k+1)), the likelihood is largest where a : b are as the
    terms of s and a + b = s (ks/n)^(1/k); it is then n ln k − n ln Γ(1/k) − n ln(a+b) − n/k, and m, unless it
    is given, and 0.5 ≤ k ≤ 20 are searched for.

    Returns
    -------
    Fit
        With parameters ``location`` m, ``above`` a, ``below`` b and ``exponent`` k.

    Raises
    ------
    ValueError
        As `asymmetric_laplace`.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).normal(0.98, 0.03, 4000)
    >>> 1.8 < fit.asymmetric_power(x).parameters["exponent"] < 2.2  # a Gaussian's is 2
    True
    """
    location = None if location is None else cusp(location)
    x = taken(samples, velocity, location)
    if isinstance(x, Counts):
        return _counted("asymmetric power", x, location, None)
    start = asymmetric_laplace(x, location).parameters["location"]
    spread = float(np.mean(np.abs(x - start)))
    y = (x - start) / spread

    def widths(m: float, k: float) -> tuple[float, float]:
        power = np.abs(y - m) ** k
        above = float(np.sum(power, where=y > m)) ** (1 / (k + 1))
        below = float(np.sum(power, where=y < m)) ** (1 / (k + 1))
        factor = (k * (above + below) / y.size) ** (1 / k)
        return above * factor, below * factor

    def cost(point: Array) -> float:
        k = exp(point[1])
        return log(sum(widths(point[0], k))) + float(special.gammaln(1 / k)) - log(k) + 1 / k

    # Below k = 1/2 the cusp is so sharp that the likelihood has a spike at every sample.
    reach = 3.0 if location is None else 0.0
    found = optimize.minimize(
        cost,
        [0.0, 0.0],
        method="Nelder-Mead",
        bounds=[(-reach, reach), (log(0.5), log(20.0))],
        options={"initial_simplex": [[0, 0], [reach / 15, 0], [0, 0.3]], "xatol": 1e-5, "fatol": 1e-10},
    )
    m, k = start + spread * float(found.x[0]), exp(found.x[1])
    a, b = (spread * width for width in widths(float(found.x[0]), k))
    named = {"location": m, "above": a, "below": b, "exponent": k}
    return fitted("asymmetric power", x, frozen(k, m, a, b), fixed=int(location is not None), **named)


def _counted(family: str, counts: Counts, location: float | None, exponent: float | None) -> Fit:
    """Fit binned counts; what is not None is fixed."""

    def make(point: Array, median: float, spread: float) -> tuple[Unfrozen, dict[str, float]]:
        a, b = (float(width) for width in spread * np.exp(np.clip(point[:2], -20.0, 20.0)))
        rest = list(point[2:])
        m = median + spread * float(rest.pop(0)) if location is None else float(location)
        k = float(np.clip(exp(min(rest.pop(0), 3.0)), 0.5, 20.0)) if exponent is None else exponent
        named = {"location": m, "above": a, "below": b, **({"exponent": k} if exponent is None else {})}
        return unfrozen(k, m, a, b), named

    start = np.zeros(2 + (location is None) + (exponent is None))
    return fit_counts(family, counts, make, start, fixed=int(location is not None))


class _AsymmetricPower(stats.rv_continuous):
    """The density above in SciPy's form: m = 0, a = 1/κ, b = κ (as in `scipy.stats.laplace_asymmetric`)."""

    def _argcheck(self, k: Array, kappa: Array) -> Any:  # type: ignore[override]
        return (k > 0) & (kappa > 0)

    def _logpdf(self, x: Array, k: Array, kappa: Array) -> Any:  # type: ignore[override]
        width = np.where(x < 0, kappa, 1 / kappa)
        return np.log(k) - np.log(kappa + 1 / kappa) - special.gammaln(1 / k) - (np.abs(x) / width) ** k

    def _pdf(self, x: Array, k: Array, kappa: Array) -> Any:  # type: ignore[override]
        return np.exp(self._logpdf(x, k, kappa))

    def _cdf(self, x: Array, k: Array, kappa: Array) -> Any:  # type: ignore[override]
        below, above = kappa**2 / (1 + kappa**2), 1 / (1 + kappa**2)
        left = special.gammaincc(1 / k, (np.maximum(-x, 0) / kappa) ** k)
        right = special.gammaincc(1 / k, (np.maximum(x, 0) * kappa) ** k)
        return np.where(x < 0, below * left, 1 - above * right)

    def _sf(self, x: Array, k: Array, kappa: Array) -> Any:  # type: ignore[override]
        return self._cdf(-x, k, 1 / kappa)

    def _ppf(self, q: Array, k: Array, kappa: Array) -> Any:  # type: ignore[override]
        below, above = kappa**2 / (1 + kappa**2), 1 / (1 + kappa**2)
        left = -kappa * special.gammainccinv(1 / k, np.minimum(q / below, 1)) ** (1 / k)
        right = special.gammainccinv(1 / k, np.minimum((1 - q) / above, 1)) ** (1 / k) / kappa
        return np.where(q < below, left, right)


_POWER = _AsymmetricPower(name="asymmetric_power", shapes="k, kappa")


def unfrozen(k: float, m: float, a: float, b: float) -> Unfrozen:
    """Make the distribution; an empty side gets a width far too small to matter in floating point."""
    a, b = max(a, 1e-100 * b), max(b, 1e-100 * a)
    return Unfrozen(_POWER, k, sqrt(b / a), loc=m, scale=sqrt(a) * sqrt(b))


def frozen(k: float, m: float, a: float, b: float) -> Any:
    """Freeze it."""
    return unfrozen(k, m, a, b).frozen()
