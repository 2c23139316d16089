"""Goodness of a fit, and comparison of two fits to the same samples."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import erfc, inf, sqrt
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from restitution._internal.arrays import generator, whole
from restitution._internal.datasets import Content
from restitution._internal.parameters import ParameterError, wrong
from restitution._internal.text import table, value, with_error
from restitution.fit._clusters import MOST_RESAMPLES, Clustered, begun, clustered, refitted
from restitution.fit._counts import Counts
from restitution.fit._result import Array, Fit
from restitution.fit.source import Parts, Window


@dataclass(frozen=True, eq=False)
class Goodness(Content):
    """Goodness of a fit, with p-values by bootstrap.

    Attributes
    ----------
    fit : Fit
    kolmogorov_smirnov, anderson_darling : float
        The statistics D = sup|F_n − F| and A².
    kolmogorov_smirnov_p, anderson_darling_p : float
        Share of refitted draws (the samples themselves counted in) whose statistic is as large. Never below
        1/(resamples + 1).
    resamples : int

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).laplace(0.98, 0.03, 300)
    >>> found = fit.goodness(fit.gaussian, x, resamples=19)
    >>> found.anderson_darling_p  # as small as 19 draws can tell
    0.05
    """

    fit: Fit
    kolmogorov_smirnov: float
    kolmogorov_smirnov_p: float
    anderson_darling: float
    anderson_darling_p: float
    resamples: int

    def __str__(self) -> str:
        return (
            f"{self.fit.family}: D = {self.kolmogorov_smirnov:.4g}, p = {self.kolmogorov_smirnov_p:.2g}; "
            f"A² = {self.anderson_darling:.4g}, p = {self.anderson_darling_p:.2g}"
        )

    def _repr_html_(self) -> str:
        rows = [
            ("Kolmogorov-Smirnov D", value(self.kolmogorov_smirnov)),
            ("p (D)", f"{self.kolmogorov_smirnov_p:.2g}"),
            ("Anderson-Darling A²", value(self.anderson_darling)),
            ("p (A²)", f"{self.anderson_darling_p:.2g}"),
            ("resamples", str(self.resamples)),
        ]
        return table(f"{self.fit.family}, goodness of fit", rows)


def goodness(
    family: Callable[..., Fit],
    samples: Parts,
    *,
    clusters: ArrayLike | None = None,
    velocity: Window | None = None,
    resamples: int = 199,
    seed: int = 1,
    **keywords: Any,
) -> Goodness:
    """Fit `samples` and test the fit.

    The distances of samples and fit are compared with those of other samples that follow the fit, each fitted
    again: a fitted density lies closer to its samples than the true one does. Samples that are independent
    are drawn from the fit.

    With `clusters` the samples of a particle may be correlated in any way. Each sample is then replaced by
    the quantile of the fit at its rank, so that together they follow the fit and depend on each other as
    before, and particles of these are drawn again with replacement. Of counts the edges take the place of the
    samples.

    Parameters
    ----------
    family, samples, clusters, velocity, seed, **keywords
        As in `bootstrap`; values without `clusters` must be statistically INDEPENDENT.
    resamples : int, default 199
        Draws for the bootstrap, ≥ 1; the p-value has the resolution 1/(resamples + 1).

    Raises
    ------
    ValueError
        As the fit does, if `resamples` < 1, or labels do not match.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).laplace(0.98, 0.03, 300)
    >>> right, wrong = (fit.goodness(family, x, resamples=19) for family in (fit.laplace, fit.gaussian))
    >>> right.kolmogorov_smirnov_p > wrong.kolmogorov_smirnov_p
    True
    """
    resamples = whole("resamples", resamples, 1, MOST_RESAMPLES)
    random = generator("seed", seed)
    family, source, pool, fit = begun(family, keywords, samples, clusters, velocity)
    observed, reached = distances(fit, pool), np.ones(2)
    null = None if source.number == fit.samples else source.following(fit, random)
    for _ in range(resamples):
        if null:
            again, refit = refitted(family, null, random)
        else:
            again = fit.rvs(fit.samples, random)
            refit = family(again)
        reached += distances(refit, again) >= observed
    ks_p, ad_p = reached / (resamples + 1)
    return Goodness(fit, float(observed[0]), float(ks_p), float(observed[1]), float(ad_p), resamples)


def distances(fit: Fit, samples: Array | Counts) -> Array:
    """Kolmogorov–Smirnov D and Anderson–Darling A² of samples and fit, shape (2,); of counts, at edges."""
    if isinstance(samples, Counts):
        share = fit.cdf(samples.edges)
        gap = samples.cumulative() - share
        weight = np.diff(share, prepend=0.0) / np.maximum(share * (1.0 - share), 1e-12)
        return np.array([np.max(np.abs(gap)), samples.total * np.sum(gap**2 * weight)])
    x = np.sort(samples)
    n, rank = x.size, np.arange(1, x.size + 1)
    below, above = fit.cdf(x), np.asarray(fit.distribution.sf(x))
    ks = max(float(np.max(rank / n - below)), float(np.max(below - (rank - 1) / n)))
    # A sample that the fit holds impossible would make A² infinite: the floor makes it merely very large.
    logs = np.log(np.maximum(below, 1e-300)) + np.log(np.maximum(above[::-1], 1e-300))
    return np.array([ks, -n - float(np.sum((2 * rank - 1) * logs)) / n])


@dataclass(frozen=True, eq=False)
class Comparison(Content):
    """Two fits of the same samples compared by Vuong's test (Econometrica 57, 307 (1989)).

    Attributes
    ----------
    difference : float
        Mean of ln p_first − ln p_second per sample; positive where the first is better.
    standard_error : float
        Of `difference`.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).laplace(0.98, 0.03, 1000)
    >>> found = fit.compare(fit.laplace(x), fit.gaussian(x), x)
    >>> found.difference > 3 * found.standard_error  # Laplace's density is the better one
    True
    """

    difference: float
    standard_error: float

    def __str__(self) -> str:
        return f"ln L per sample: {with_error(self.difference, self.standard_error)}; p = {self.p:.2g}"

    def _repr_html_(self) -> str:
        rows = [
            ("difference of ln L per sample", with_error(self.difference, self.standard_error)),
            ("z", value(self.z)),
            ("p", f"{self.p:.2g}"),
        ]
        return table("Two fits compared by Vuong's test", rows)

    @property
    def z(self) -> float:
        """Difference in standard errors; standard normal where two non-nested fits are equally far off."""
        if self.standard_error == 0:
            return 0.0 if self.difference == 0 else inf if self.difference > 0 else -inf
        return self.difference / self.standard_error

    @property
    def p(self) -> float:
        """Two-sided p-value of `z`."""
        return erfc(abs(self.z) / sqrt(2))


def compare(
    first: Fit,
    second: Fit,
    samples: Parts,
    clusters: ArrayLike | None = None,
    *,
    velocity: Window | None = None,
) -> Comparison:
    """Compare two fits by their log-likelihood per sample.

    Parameters
    ----------
    first, second : Fit
        Fits of `samples`.
    samples, clusters, velocity
        As in `bootstrap`. Samples of one particle may be correlated in any way, those of two are taken as
        independent; values without `clusters` all are.

    Raises
    ------
    ValueError
        As `bootstrap`.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).normal(0.98, 0.03, 1000)
    >>> fit.compare(fit.laplace(x), fit.gaussian(x), x).difference < 0
    True
    """
    for name, given in (("first", first), ("second", second)):
        if not isinstance(given, Fit):
            raise ParameterError(wrong(name, given, "a Fit"))
    source = clustered(samples, clusters, velocity)
    if isinstance(source, Clustered):
        difference = first.logpdf(source.samples) - second.logpdf(source.samples)
        mean = float(np.mean(difference))
        sums, size = np.add.reduceat(difference - mean, source.start[:-1]), difference.size
    else:
        pool = source.pool()
        gain = pool.logshare(first.distribution) - pool.logshare(second.distribution)
        mean = float(pool.all @ gain) / pool.total
        sums, size = source.counts @ (gain - mean), pool.total
    groups = source.number
    return Comparison(mean, float(np.sqrt(np.sum(sums**2) * groups / (groups - 1))) / size)
