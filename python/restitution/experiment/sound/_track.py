"""A series followed to its end: later impacts are looked for where the flights before say they must be."""

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import IntArray
from restitution.experiment.sound._envelope import Envelope

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
