"""Impacts that scatter about a coefficient, for fits that are worked out again in loops."""

from typing import Any

import numpy as np
import xarray as xr
from scipy import stats

EDGES = [0.2, 0.3, 0.5, 0.9, 1.2]


def impacts(particles: int = 40, each: int = 30, seed: int = 2) -> xr.Dataset:
    """Give impacts of any speed, some at the edges of the bins, some without a coefficient or a contact."""
    rng = np.random.default_rng(seed)
    shape = (particles, each)
    velocity = rng.uniform(0.1, 1.0, shape)
    at_edges = rng.random(shape) < 0.1
    velocity[at_edges] = rng.choice(EDGES, np.count_nonzero(at_edges))
    restitution = rng.normal(0.9, 0.1, shape) + 0.05 * rng.normal(size=(particles, 1))
    restitution[rng.random(shape) < 0.05] = np.nan
    contact = rng.integers(0, 3, shape).astype(np.int8)
    dims = ("particle", "impact")
    return xr.Dataset(
        {
            "impact_velocity": (dims, velocity),
            "restitution": (dims, restitution),
            "contact": (dims, contact),
        },
        coords={"impact": np.arange(each)},
        attrs={"law": "any"},
    )


def distance(samples: Any, one: Any) -> float:
    return float(stats.kstest(samples, one.cdf).statistic)
