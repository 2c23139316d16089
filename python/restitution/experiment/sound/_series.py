"""Series of impacts among candidates: each flight is shorter than the one before, by about the same ratio.

A series is followed to its end: later impacts are looked for where the flights before say they must be.
"""

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import IntArray
from restitution.experiment.sound._envelope import Envelope

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
_FAINT = 2.5
"""A rise of so many spreads is enough where an impact is expected."""
_STANDS_OUT = 1.3
"""If it also is so many times larger than any other in the flight before it."""
_TOLERANCE = 0.09
"""Part of a flight by which an impact may be early or late."""
_AS_LOUD = 0.85
"""A second sound whose rise is this part of the impact's is flagged as doubled."""
_LATER = 0.25
"""And which comes after this part of the flight, where no echo of plate or ball is expected."""


def best_series(
    times: Array, rewards: Array, jitter: float, longest: float = LONGEST_FLIGHT
) -> tuple[IntArray, float]:
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

    Returns
    -------
    tuple of ndarray and float
        Indices of the candidates in the chain, in the order of time, and its score: the sum of their rewards
        less what uneven ratios cost. If there is no chain, none and -inf.
    """
    n = times.size
    none = np.empty(0, dtype=np.int64), -np.inf
    if n < 3:
        return none
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
        return none
    j, k = divmod(int(np.argmax(chained)), n)
    members = [k, j]
    while parent[j, k] >= 0:
        i = int(parent[j, k])
        members.append(i)
        j, k = i, j
    return np.array(members[::-1]), float(chained.max())


def strongest(times: Array, rewards: Array) -> tuple[Array, Array]:
    """Keep the strongest candidates, in the order of time."""
    kept = np.sort(np.argsort(rewards)[-_MOST:])
    return times[kept], rewards[kept]


@dataclass(frozen=True)
class Track:
    """A series of impacts in an envelope; once it is followed, with what was faint, missed and doubled.

    Impacts are faint that were found only because they were expected, shape (n,). Missed is one after each of
    some impacts, and doubled are times of sounds as loud as an impact that belong to no series.
    """

    times: Array  # when the level rises, in s, shape (n,)
    worth: float  # of its impacts in the search
    envelope: Envelope  # of the band in which the series was found
    faint: npt.NDArray[np.bool_] = field(default_factory=lambda: np.empty(0, dtype=np.bool_))
    missed: IntArray = field(default_factory=lambda: np.empty(0, dtype=np.int64))
    doubled: Array = field(default_factory=lambda: np.empty(0))

    def levels_at(self, times: Array) -> Array:
        """Return the level in dB over the noise within a smoothing time after each of the times."""
        level, step = self.envelope.level, self.envelope.step
        reach = max(int(2.0 * self.envelope.width / step), 1)
        starts = np.clip((times / step).astype(np.int64), 0, level.size - 1)
        return np.array([level[start : start + reach].max() for start in starts])


def followed(track: Track, bands: list[Envelope]) -> Track:
    """Search for impacts after the last, band by band, and for missed and doubled ones within the series."""
    times, faint = list(track.times), [False] * track.times.size
    weak = [one.candidates(_FAINT) for one in bands]
    while (found := _next(np.array(times), track.envelope, bands, weak)) is not None:
        times.append(found)
        faint.append(True)
    heard = np.array(times)
    return replace(track, times=heard, faint=np.array(faint), missed=_missed(heard), doubled=_doubled(track))


def _ratio(times: Array) -> float:
    """Return the ratio of successive flights, the mean of the last few."""
    flights = np.diff(times[-7:])
    return float(np.exp(np.mean(np.log(flights[1:] / flights[:-1]))))


def _next(
    times: Array, own: Envelope, bands: list[Envelope], weak: list[tuple[Array, Array]]
) -> float | None:
    """Find the next impact where it is expected; None if nothing stands out there."""
    if times.size < 4:
        return None
    flight = (times[-1] - times[-2]) * min(_ratio(times), 1.0)
    best: tuple[float, float] | None = None
    for one, (candidates, rises) in zip(bands, weak, strict=True):
        if one.width > 0.35 * flight:
            continue
        window = max(_TOLERANCE * flight, one.width / 2.0)
        expected = times[-1] + flight
        near = np.abs(candidates - expected) < window
        # The flight before it, without the sound of the impact that began it.
        quiet = (candidates > times[-1] + max(0.25 * flight, one.width)) & (candidates < expected - window)
        if not near.any():
            continue
        rise = float(rises[near].max())
        other = float(rises[quiet].max()) if quiet.any() else 0.0
        strength = rise / max(one.spread, 0.8)
        if strength > _FAINT and rise > _STANDS_OUT * other and (best is None or strength > best[0]):
            best = (strength, float(candidates[near][np.argmax(rises[near])]))
    return None if best is None else best[1]


def _missed(times: Array) -> IntArray:
    """Find flights that are two in one, by how they compare with the one before."""
    flights = np.diff(times)
    if flights.size < 4:
        return np.empty(0, dtype=np.int64)
    ratios = flights[1:] / flights[:-1]
    typical = float(np.exp(np.median(np.log(ratios))))
    # One missed: the flight is (e + e²) of the one before.
    two = (np.abs(np.log(ratios / (typical + typical**2))) < 0.15) & (ratios > 1.15)
    return 1 + np.flatnonzero(two)


def _doubled(track: Track) -> Array:
    """Find sounds within the series that rise as far as the impact before them."""
    times, rises = track.envelope.candidates(_FAINT * 2.0)
    heard = track.times
    own = np.interp(heard, times, rises) if times.size else np.zeros(heard.size)
    found = []
    for place in range(heard.size - 1):
        flight = heard[place + 1] - heard[place]
        inside = (times > heard[place] + _LATER * flight) & (times < heard[place + 1] - _LATER * flight)
        loud = inside & (rises > _AS_LOUD * own[place])
        found.extend(times[loud].tolist())
    return np.array(found)
