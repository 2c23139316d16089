"""Standard errors of moments: a run is counted in batches of particles, and each is left out in turn."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np

from restitution._internal.arrays import FloatArray
from restitution._internal.parameters import shown

BATCHES = 16
"""Default number of batches. n of them make the standard errors uncertain by 1/√(2(n - 1)), here 18 %."""
_NAMES = ("mean_restitution", "variance", "skewness", "kurtosis", "mean_fraction")


def batches_of(particles: int, batches: int) -> list[tuple[int, int]]:
    """Divide particles into batches [first, end) of at least two, or one of all where they are too few."""
    number = 1 if particles < 2 * batches else batches
    ends = [particles * k // number for k in range(number + 1)]
    return list(pairwise(ends))


def origin(found: int, particles: int, batches: int) -> str:
    """Say how standard errors over so many batches were found, or why there are none."""
    if found > 1:
        return f"jackknife over {found} batches of particles"
    if batches == 1:
        return "none: a single batch was asked for"
    if particles < 2 * batches:
        return f"none: {particles} particles are fewer than two for each of {shown(batches)} batches"
    return "none: interrupted before the second batch"


def standard_errors(parts: Sequence[dict[str, FloatArray]], row: str) -> dict[str, Any]:
    """Return the standard errors of the moments in each row, by the jackknife over batches of particles.

    The impacts of a particle are correlated, particles are not. With θ_(b) a moment of all batches but b the
    error is √((n - 1)/n Σ_b (θ_(b) - θ̄)²) (B. Efron, The Jackknife, the Bootstrap and Other Resampling Plans,
    SIAM 1982), for moments that are not sums over particles as well. Each of `parts` has ``number`` and the
    moments of a batch, shape (rows,); each error is a variable over `row`.
    """
    n = np.array([part["number"] for part in parts], dtype=np.float64)
    mean, variance, skewness, kurtosis, fraction = (
        np.nan_to_num([part[name] for part in parts]) for name in _NAMES
    )
    second = n * variance
    third, fourth = second * np.sqrt(variance) * skewness, second * variance * kurtosis
    found = []
    for left_out in range(len(parts)):
        kept = np.arange(len(parts)) != left_out
        with np.errstate(divide="ignore", invalid="ignore"):
            total = n[kept].sum(axis=0)
            centre = (n * mean)[kept].sum(axis=0) / total
            d = mean - centre
            m2 = (second + n * d**2)[kept].sum(axis=0) / total
            m3 = (third + 3.0 * d * second + n * d**3)[kept].sum(axis=0) / total
            m4 = (fourth + 4.0 * d * third + 6.0 * d**2 * second + n * d**4)[kept].sum(axis=0) / total
            share = (n * fraction)[kept].sum(axis=0) / total
            found.append([centre, m2, m3 / m2**1.5, m4 / m2**2, share])
    estimates = np.array(found)
    size = len(parts)
    with np.errstate(invalid="ignore"):
        # A row that one batch alone has met is 0/0 without that one: it leaves nothing to compare.
        errors = np.sqrt((size - 1.0) * estimates.var(axis=0))
    text = "standard error of {} over {} batches of particles; NaN where fewer than two have an impact"
    return {
        f"{name}_error": (row, values, {"long_name": text.format(name, size)})
        for name, values in zip(_NAMES, errors, strict=True)
    }
