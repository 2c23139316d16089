"""The likelihood of several drops whose parameters differ.

The parameter of drop i is θ_i = μ + τ z_i with standard normal z_i, as of other plates or other places of a
plate. With L_i(θ) the likelihood of the numbers of drop i alone,

    L(μ | τ) = Π_i ∫ L_i(θ) N(θ; μ, τ²) dθ,    L(μ) = ∫ L(μ | τ) p(τ) dτ,

p(τ) the half-Cauchy prior of `restitution.flight.fit`. With one drop τ is not inferred, and L = L_1.
"""

import math
from collections.abc import Sequence

import numpy as np
from scipy.special import logsumexp, ndtr

from restitution._internal.arrays import FloatArray as Array
from restitution.experiment.flight.chain import USUAL_BETWEEN
from restitution.experiment.inference._likelihood import IMPOSSIBLE, Density
from restitution.experiment.inference._series import Series


def usual_between(series: Sequence[Series]) -> float:
    """Return the scale of the prior of τ in units of the parameter."""
    return USUAL_BETWEEN / float(np.mean([np.abs(one.slopes).mean() for one in series]))


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
