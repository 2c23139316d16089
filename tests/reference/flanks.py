"""Samples of ε with known flanks, known correlation inside particles, known growth with the speed."""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy import stats

from restitution import fit
from restitution.fit import Counts, Fit

Array = NDArray[np.float64]

CUSP, ABOVE, BELOW = 0.98, 0.02, 0.05


def flanks(u: Array) -> Array:
    """Quantiles of the asymmetric Laplace density with the parameters above."""
    split = BELOW / (ABOVE + BELOW)
    with np.errstate(divide="ignore"):
        low = CUSP + BELOW * np.log(u / split)
        high = CUSP - ABOVE * np.log((1 - u) / (1 - split))
    return np.where(u < split, low, high)


def correlated(particles: int, each: int, seed: int, correlation: float = 0.8) -> tuple[Array, Array]:
    """Asymmetric Laplace samples with Gaussian scores correlated inside a particle; and the particles."""
    rng = np.random.default_rng(seed)
    common = rng.normal(size=(particles, 1))
    score = np.sqrt(correlation) * common + np.sqrt(1 - correlation) * rng.normal(size=(particles, each))
    x = flanks(stats.norm.cdf(score))
    return x.ravel(), np.repeat(np.arange(particles), each)


def mixed(n: int, seed: int) -> Array:
    """Three tenths of the flanks, seven tenths of a Gaussian."""
    rng = np.random.default_rng(seed)
    return np.where(
        rng.random(n) < 0.3, CUSP + 0.2 * (flanks(rng.random(n)) - CUSP), rng.normal(0.95, 0.06, n)
    )


def binned(x: Array, edges: Array) -> Counts:
    return Counts(
        edges,
        np.histogram(x[x < edges[-1]], edges)[0],
        int(np.sum(x < edges[0])),
        int(np.sum(x >= edges[-1])),
    )


def at_cusp(samples: Any, **window: Any) -> Fit:
    """Fit the cusp mixture as the other families are called."""
    return fit.cusp_mixture(samples, CUSP, **window)


def scaled_flanks(particles: int, seed: int) -> xr.Dataset:
    """Impacts at random speeds with flanks that grow as 0.01/v (above) and 0.02 v^-1.5 (below)."""
    rng = np.random.default_rng(seed)
    v = rng.uniform(0.1, 0.5, (particles, 60))
    above, below = 0.01 / v, 0.02 * v**-1.5
    up = rng.random(v.shape) < above / (above + below)
    e = CUSP + np.where(up, rng.exponential(above), -rng.exponential(below))
    return xr.Dataset(
        {
            "impact_velocity": (("particle", "impact"), v),
            "restitution": (("particle", "impact"), e),
            "rotational_fraction": (("particle", "impact"), np.full_like(v, 0.5)),
            "energy_ratio": (("particle", "impact"), np.full_like(v, 0.9)),
        }
    )
