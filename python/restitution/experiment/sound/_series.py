"""Series of impacts among candidates: each flight is shorter than the one before, by about the same ratio."""

from dataclasses import dataclass

import numpy as np

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import IntArray

LONGEST_FLIGHT = 2.5
"""In s; 7.6 m high."""
LEAST_RATIO, LARGEST_RATIO = 0.25, 1.04
"""Of successive flights; a non-spherical body may fly longer after an impact, by a little."""
_LOOSENESS = 0.05
"""Standard deviation of the logarithm of a ratio about the ratio before it."""
_SKIP_COST = 6.0
"""A missed impact takes this from the score of a series."""
_MOST = 500
"""Candidates that are looked at, the strongest."""


@dataclass(frozen=True)
class Series:
    """Candidates that follow one another like impacts."""

    members: IntArray  # indices of the candidates, in the order of time
    score: float  # sum of their rewards less what uneven ratios cost


def best_series(
    times: Array, rewards: Array, jitter: float, longest: float = LONGEST_FLIGHT
) -> Series | None:
    """Find the chain of candidates with the highest score.

    Dynamic programming over pairs of successive impacts: the best chain that ends with the pair (j, k)
    comes from the best that ends with a pair (i, j), if (t_k - t_j)/(t_j - t_i) is a ratio that may follow
    the one before.

    Parameters
    ----------
    times, rewards : ndarray, shape (n,)
        Candidates in the order of time, and what each is worth, > 0.
    jitter : float
        Standard error of their times, in s.
    longest : float
        Flights last at most so long, in s.
    """
    n = times.size
    if n < 3:
        return None
    score = np.full((n, n), -np.inf)
    ratio = np.full((n, n), np.nan)
    parent = np.full((n, n), -1, dtype=np.int64)
    # The flight that ended with the second of a pair: not their distance, where one between was missed.
    ended = times[None, :] - times[:, None]
    for j in range(n):
        nexts = np.arange(j + 1, np.searchsorted(times, times[j] + longest, side="right"))
        nexts = nexts[times[nexts] - times[j] > 4.0 * jitter]
        if not nexts.size:
            continue
        flights = times[nexts] - times[j]
        score[j, nexts] = rewards[j] + rewards[nexts]
        before = np.arange(np.searchsorted(times, times[j] - longest), j)
        before = before[np.isfinite(score[before, j])]
        if not before.size:
            continue
        last = ended[before, j]
        whole = flights[None, :] / last[:, None]
        expected = ratio[before, j][:, None]
        # Two flights in one have the ratio e + e² to the one before.
        split = 0.5 * (np.sqrt(1.0 + 4.0 * whole) - 1.0)
        skipped = (whole > 1.1 * LARGEST_RATIO) & ~np.isnan(expected)
        quotient = np.where(skipped, split, whole)
        allowed = (quotient > LEAST_RATIO) & (quotient < LARGEST_RATIO)
        logarithm = np.log(np.where(allowed, quotient, 1.0))
        variance = _LOOSENESS**2 + 6.0 * (jitter / np.minimum(flights[None, :], last[:, None])) ** 2
        change = np.where(np.isnan(expected), 0.0, logarithm - expected)
        cost = 0.5 * change**2 / variance
        worth = rewards[nexts][None, :] * (1.0 - cost / 8.0) - np.where(skipped, _SKIP_COST, 0.0)
        gain = np.where(allowed & (cost < 8.0), score[before, j][:, None] + worth, -np.inf)
        best = np.argmax(gain, axis=0)
        value = gain[best, np.arange(nexts.size)]
        better = value > score[j, nexts]
        chosen = nexts[better]
        score[j, chosen] = value[better]
        parent[j, chosen] = before[best[better]]
        # A ratio that is followed slowly forgets the jitter of each.
        old = expected[best[better], 0]
        new = logarithm[best[better], np.flatnonzero(better)]
        two = skipped[best[better], np.flatnonzero(better)]
        step = np.exp(new)
        ended[j, chosen] *= np.where(two, step / (1.0 + step), 1.0)
        ratio[j, chosen] = np.where(np.isnan(old), new, 0.6 * old + 0.4 * new)
    chained = np.where(parent >= 0, score, -np.inf)
    if not np.isfinite(chained.max()):
        return None
    j, k = divmod(int(np.argmax(chained)), n)
    members = [k, j]
    while parent[j, k] >= 0:
        i = int(parent[j, k])
        members.append(i)
        j, k = i, j
    return Series(np.array(members[::-1]), float(chained.max()))


def strongest(times: Array, rewards: Array) -> tuple[Array, Array]:
    """Keep the strongest candidates, in the order of time."""
    kept = np.sort(np.argsort(rewards)[-_MOST:])
    return times[kept], rewards[kept]
