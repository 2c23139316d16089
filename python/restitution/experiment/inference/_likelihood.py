"""The likelihood of the numbers of a series, from simulated series with the same errors, and of several.

Of several drops the parameters differ: that of drop i is θ_i = μ + τ z_i with standard normal z_i, as of
other plates or other places of a plate. With L_i(θ) the likelihood of the numbers of drop i alone,

    L(μ | τ) = Π_i ∫ L_i(θ) N(θ; μ, τ²) dθ,    L(μ) = ∫ L(μ | τ) p(τ) dτ,

p(τ) the half-Cauchy prior of `restitution.flight.fit`. With one drop τ is not inferred, and L = L_1.
"""

import math
from collections.abc import Sequence

import numpy as np
from scipy.special import logsumexp, ndtr

from restitution._internal.arrays import FloatArray as Array
from restitution.experiment.inference._series import Drops, Series

_FEWEST = 50
"""Simulated series that a density needs; where fewer could be measured it is taken to be 0."""
_STRAY = 0.02
"""Weight of a wide Gaussian, three times as wide, so that no density is 0."""
_COMPARED = 4
"""Of the numbers of a series, those whose density this is; the others are for the predictive check."""
_REACH, _NODES = 6.0, 121
"""Standard deviations on both sides that nodes of a likelihood reach, and their number."""
IMPOSSIBLE = -1e4
"""Logarithm of a likelihood that is none."""


class Density:
    """A kernel density estimate that keeps mean and covariance (West, J. R. Stat. Soc. B 55, 409 (1993)).

    The first number, the parameter less its true value, is taken over the scatter of its series, as Student's
    t is, and that of the series observed; as it has wide flanks where the shape scatters ε, by its arsinh in
    units of its quartiles.
    """

    def __init__(self, drops: Drops, truth: float, observed: Array) -> None:
        self.enough = len(drops.statistics) >= _FEWEST
        if not self.enough:
            return
        samples = drops.statistics[:, :_COMPARED].copy()
        self.share = drops.share
        self.all = drops.statistics
        # The second and third are logarithms of squares.
        scatter = np.exp(0.25 * (samples[:, 1:3] - observed[1:3]).sum(axis=1))
        off = (samples[:, 0] - truth) / scatter
        low, self.middle, high = np.quantile(off, (0.25, 0.5, 0.75))
        self.scale = max((high - low) / 1.349, 1e-15)
        samples[:, 0] = np.arcsinh((off - self.middle) / self.scale)
        n, d = samples.shape
        self.mean = samples.mean(axis=0)
        self.root = np.linalg.cholesky(np.cov(samples, rowvar=False) + 1e-12 * np.eye(d))
        white = np.linalg.solve(self.root, (samples - self.mean).T).T
        self.width = (4.0 / (d + 2.0)) ** (1.0 / (d + 4.0)) * n ** (-1.0 / (d + 4.0))
        self.points = math.sqrt(1.0 - self.width**2) * white
        self.norm = -0.5 * d * math.log(2.0 * math.pi) - float(np.log(np.diag(self.root)).sum())

    def beyond(self, numbers: Array) -> Array:
        """Return how probable each of four signs of another cause would be, were this the ball.

        The shares of simulated series whose scatter, early and late, is farther from the usual, by the
        distance of Mahalanobis; whose scatter grows less; whose largest residual is larger; and whose
        residuals have more of a trend with the speed.
        """
        if not self.enough:
            return np.zeros(4)
        _, early, late, _, largest, trend = self.all.T
        scatter = self.all[:, 1:3]
        root = np.linalg.cholesky(np.cov(scatter, rowvar=False))
        off = np.linalg.solve(root, (np.vstack([numbers[1:3], scatter]) - scatter.mean(axis=0)).T)
        distance = np.sum(off**2, axis=0)
        signs = [
            distance[1:] >= distance[0],
            late - early <= numbers[2] - numbers[1],
            largest >= numbers[4],
            np.abs(trend) >= abs(numbers[5]),
        ]
        return np.asarray(np.mean(signs, axis=1))

    def truths(self, numbers: Array, offsets: Array) -> Array:
        """Return true parameters that are off the likeliest by so many of its scales."""
        return np.asarray(numbers[0] - self.middle + self.scale * offsets)

    def nodes(self, numbers: Array) -> Array:
        """Return true parameters, increasing, between which the likelihood is nearly linear."""
        away = self.root[0, 0] * np.linspace(-_REACH, _REACH, _NODES)
        return self.truths(numbers, np.sinh(away - self.mean[0]))

    def __call__(self, numbers: Array, truths: Array) -> Array:
        """Return ln p of the numbers, were these the true parameters, shape (m,)."""
        if not self.enough:
            return np.full(truths.shape, IMPOSSIBLE)
        u, white, kernels, nearest = self._kernels(numbers, truths)
        d = white.shape[1]
        core = np.log(kernels.mean(axis=1)) - 0.5 * nearest / self.width**2 - d * math.log(self.width)
        wide = -0.5 * np.sum(white**2, axis=1) / 9.0 - d * math.log(3.0)
        both = np.logaddexp(math.log(1.0 - _STRAY) + core, math.log(_STRAY) + wide)
        # dy/ds of the arsinh.
        jacobian = -np.log(self.scale * np.sqrt(1.0 + u**2))
        return np.asarray(np.maximum(both + self.norm + jacobian + math.log(self.share), IMPOSSIBLE))

    def variance(self, numbers: Array) -> float:
        """Return the variance of ln p at the likeliest parameter if other series had been simulated.

        It is Σw²/(Σw)² of the kernels w, one over the number of series that count.
        """
        truths = self.nodes(numbers)
        _, _, (kernels,), _ = self._kernels(numbers, truths[[np.argmax(self(numbers, truths))]])
        return float(np.sum(kernels**2) / np.sum(kernels) ** 2)

    def _kernels(self, numbers: Array, truths: Array) -> tuple[Array, Array, Array, Array]:
        """Return the scaled parameter, all numbers whitened, kernels over the largest, and its distance²."""
        u = (numbers[0] - truths - self.middle) / self.scale
        at = np.column_stack([np.arcsinh(u), np.tile(numbers[1:_COMPARED], (u.size, 1))])
        white = np.linalg.solve(self.root, (at - self.mean).T).T
        distance = (
            np.sum(white**2, axis=1)[:, None] - 2.0 * white @ self.points.T + np.sum(self.points**2, axis=1)
        )
        nearest = distance.min(axis=1)
        return u, white, np.exp((nearest[:, None] - distance) / (2.0 * self.width**2)), nearest


def scatters_between(usual: float, narrow: float) -> tuple[Array, Array]:
    """Return values of τ and their prior probabilities.

    They are 0 and in steps of a factor of 2 at most, from a fifth of the smallest scale of a likelihood to
    where the prior leaves 2 %, which counts as the last.
    """
    low, high = 0.2 * min(narrow, usual), 30.0 * usual
    taus = np.append(0.0, np.geomspace(low, high, 1 + math.ceil(math.log2(high / low))))
    below = 2.0 / math.pi * np.arctan(taus / usual)
    half = 0.5 * np.diff(below)
    weights = np.append(half, 1.0 - below[-1])
    weights[1:] += half
    return taus, weights


def together(densities: Sequence[Density], series: Sequence[Series], means: Array, scatters: Array) -> Array:
    """Return ln L(μ | τ), shape (scatters, means)."""
    total = np.zeros((scatters.size, means.size))
    for density, one in zip(densities, series, strict=True):
        total[0] += density(one.observed, means)
        if density.enough and scatters.size > 1:
            nodes = density.nodes(one.observed)
            total[1:] += smoothed(nodes, density(one.observed, nodes), means, scatters[1:])
        else:
            total[1:] += IMPOSSIBLE
    return total


def smoothed(nodes: Array, logs: Array, means: Array, scatters: Array) -> Array:
    """Return ln of a likelihood convolved with Gaussians of these widths > 0, shape (scatters, means).

    It is linear between increasing nodes, and 0 at the ends: a sum of triangles, each a second difference of
    |z|/2. That function convolved is |z|/2 + τ φ(z/τ) - |z| Φ(-|z|/τ), and so nothing is left to quadrature.
    """
    off = np.abs(means[:, None] - nodes)
    u = off / scatters[:, None, None]
    gauss = np.exp(-0.5 * u**2) / math.sqrt(2.0 * math.pi)
    kernel = 0.5 * off + scatters[:, None, None] * gauss - off * ndtr(-u)
    triangles = np.diff(np.diff(kernel, axis=-1) / np.diff(nodes), axis=-1)
    largest = logs.max()
    value = np.maximum(triangles, 0.0) @ np.exp(logs[1:-1] - largest)
    return np.asarray(np.maximum(np.log(np.maximum(value, 1e-300)) + largest, IMPOSSIBLE))


def averaged(logs: Array, weights: Array) -> Array:
    """Return ln L(μ) from ln L(μ | τ)."""
    return np.asarray(logsumexp(logs, axis=0, b=weights[:, None]))
