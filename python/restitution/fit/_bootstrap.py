"""Standard errors, confidence bands and information criteria from resampled particles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import log
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from restitution._internal.arrays import generator, real, whole, word
from restitution._internal.datasets import Content
from restitution._internal.text import table, value, with_error
from restitution.fit._clusters import MOST_RESAMPLES, begun, refitted
from restitution.fit._counts import loglikelihood
from restitution.fit._result import Array, Fit
from restitution.fit.source import Parts, Window


@dataclass(frozen=True, eq=False)
class Bootstrap(Content):
    """A fit with what it becomes when particles are drawn again with replacement.

    Attributes
    ----------
    fit : Fit
        Of the samples themselves.
    resampled : tuple of Fit
        Of the samples of redrawn particles.
    clusters : int
        Number of particles.
    effective_parameters : float
        The penalty tr(J H⁻¹) of Takeuchi's criterion, estimated as the mean of 2[ln L(θ) - ln L(θ*)] over the
        resampled fits θ*, with L the likelihood of the samples. It is the number of free parameters where the
        samples are independent and the family is right, and grows with the correlation inside particles.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).laplace(0.98, 0.03, 1000)
    >>> found = fit.bootstrap(fit.laplace, x, resamples=20)
    >>> found.clusters, len(found.resampled)
    (1000, 20)
    """

    fit: Fit
    resampled: tuple[Fit, ...]
    clusters: int
    effective_parameters: float

    def __str__(self) -> str:
        return f"{self.fit.family}, {self.clusters} particles: " + ", ".join(
            map(" = ".join, self._estimates())
        )

    def _repr_html_(self) -> str:
        rows = [*self._estimates(), ("samples", str(self.fit.samples)), ("particles", str(self.clusters))]
        rows += [("AIC", value(self.aic)), ("BIC", value(self.bic))]
        return table(f"{self.fit.family}, standard errors from {len(self.resampled)} resamples", rows)

    def to_latex(self) -> str:
        """Write a LaTeX table of the parameters with their standard errors, for the package booktabs."""
        return self.fit.to_latex(self.standard_errors)

    def _estimates(self) -> list[tuple[str, str]]:
        errors = self.standard_errors
        return [(name, with_error(x, errors[name])) for name, x in self.fit.parameters.items()]

    @property
    def standard_errors(self) -> dict[str, float]:
        """Standard error of each parameter, 0 of one that was given."""
        drawn = {name: self.draws(name) for name in self.fit.parameters}
        return {name: float(np.std(x, ddof=1)) if np.ptp(x) else 0.0 for name, x in drawn.items()}

    def draws(self, name: str) -> Array:
        """Return a parameter of all resampled fits, shape (resamples,)."""
        word("name", name, self.fit.parameters)
        return np.array([one.parameters[name] for one in self.resampled])

    def interval(self, name: str, confidence: float = 0.95) -> tuple[float, float]:
        """Return the percentile interval of a parameter."""
        low, high = np.quantile(self.draws(name), _levels(confidence))
        return float(low), float(high)

    def band(self, x: ArrayLike, confidence: float = 0.95) -> tuple[Array, Array]:
        """Return the pointwise percentile band of the fitted density at `x`; two arrays of its shape."""
        low, high = np.quantile([one.pdf(x) for one in self.resampled], _levels(confidence), axis=0)
        return low, high

    @property
    def effective_samples(self) -> float:
        """Number of independent samples that would determine the parameters equally well: n k/tr(J H⁻¹).

        n samples and k free parameters; tr(J H⁻¹)/k is the design effect, the mean factor by which the
        correlation inside particles multiplies the variance of an estimate.
        """
        return self.fit.samples * self.fit.free_parameters / self.effective_parameters

    @property
    def aic(self) -> float:
        """2 tr(J H⁻¹) - 2 ln L, Akaike's criterion for samples correlated inside particles.

        C. Varin and P. Vidoni, Biometrika 92, 519 (2005): ln L, which takes the samples for independent, is a
        composite likelihood, and its optimism is that trace.
        """
        return 2 * self.effective_parameters - 2 * self.fit.loglikelihood

    @property
    def bic(self) -> float:
        """tr(J H⁻¹) ln(particles) - 2 ln L; X. Gao and P. X.-K. Song, J. Am. Stat. Assoc. 105, 1531 (2010).

        Its n is the number of particles, the draws that are independent; the impacts in each, and how much
        they repeat each other, enter through the trace. `Fit.bic` takes every impact for a particle.
        """
        return self.effective_parameters * log(self.clusters) - 2 * self.fit.loglikelihood


def bootstrap(
    family: Callable[..., Fit],
    samples: Parts,
    clusters: ArrayLike | None = None,
    *,
    velocity: Window | None = None,
    resamples: int = 199,
    seed: int = 1,
    **keywords: Any,
) -> Bootstrap:
    """Fit the samples, and again the samples of redrawn particles.

    Parameters
    ----------
    family : callable
        A fit of this package, such as `asymmetric_laplace`, or any function from samples to a `Fit`.
    samples : array_like, xarray.Dataset or sequence of Counts or xarray.Dataset
        Values; impacts as from `restitution.simulate`, whose particles are known; or the counts, or
        statistics, of independent runs, which take the place of particles.
    clusters : array_like of int, shape (n,), optional
        Number of the particle that each value is from; without it every value is a particle of its own.
    velocity : float or tuple of two floats, optional
        For a Dataset, as in `asymmetric_laplace`.
    resamples : int, default 199
    seed : int, default 1
    **keywords
        Of the family, such as ``location=0.98``.

    Raises
    ------
    ValueError
        As the fit does, if labels do not match, there are fewer than two particles or too few to fit when
        drawn again, or ``resamples < 2``.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).laplace(0.98, 0.03, 4000)
    >>> found = fit.bootstrap(fit.laplace, x, clusters=np.arange(4000) // 10, resamples=50)
    >>> low, high = found.interval("scale")
    >>> bool(low < 0.03 < high)
    True
    """
    resamples = whole("resamples", resamples, 2, MOST_RESAMPLES)
    random = generator("seed", seed)
    family, source, pool, fit = begun(family, keywords, samples, clusters, velocity)
    again = tuple(refitted(family, source, random)[1] for _ in range(resamples))
    losses = [fit.loglikelihood - loglikelihood(one.distribution, pool) for one in again]
    return Bootstrap(fit, again, source.number, float(2.0 * np.mean(losses)))


def _levels(confidence: float) -> list[float]:
    confidence = real("confidence", confidence, "a number in (0, 1)", lambda share: 0.0 < share < 1.0)
    return [0.5 * (1.0 - confidence), 0.5 * (1.0 + confidence)]
