"""The choice among the rules for onsets: by what they say of one another, and by the noise at each impact."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import nnls

from restitution._internal.arrays import FloatArray as Array
from restitution.experiment.sound._envelope import bands, rounding
from restitution.experiment.sound._pickers import MATCHED, RULES, Band, Matched, Picker, by_power

_DRAWS = 24
"""Excerpts of the noise with which each rule is tried at each impact."""
_CLEAR = 6
"""Impacts, the clearest, whose sounds are added to the excerpts."""
_LOST = 0.1
"""Share of the excerpts in which a rule goes astray from which on its time is doubted."""
_HIDDEN = 0.45
"""Part of its reach that the error of a time has if noise hides the impact; of any time within, 0.58."""
_FAR_OFF = 6.0
"""Standard errors by which a time must be off to be doubted."""
_CLEAREST = 5e-4
"""Noise, over the loudest sample of the impacts, that every recording is given. Of a low tone a band far
above has only what its filter leaks: in silence it would be heard there, and taken for another sound."""
_LOUD = 3e-3
"""Time in s after an impact in which its sound is loud."""
_READING = 0.01
"""Points by which a parabola through three of the eight points of a period is off its summit, at most."""
_REACH, _MOST_REACH = 0.1e-3, 3e-3
"""Time in s on either side of an impact in which it is looked for once rules agree where it is; at most."""
_TINY = 1e-18
"""A variance in s² that matters to no time, 1 ns squared."""


class Choice(NamedTuple):
    """The rule that is trusted, and the time in s of each impact by it."""

    rule: str  # what it is, and in which band
    times: Array
    errors: Array  # standard errors of the times, in s
    doubtful: npt.NDArray[np.bool_]  # which times the other rules contradict, or noise hides


@dataclass(frozen=True)
class _Picks:
    """Times of all impacts by one rule in one band, in s, and what noise does to them."""

    rule: str
    band: str
    times: Array
    noise: Array  # variance by noise in s², of the times that do not go astray
    whole: Array  # of all times
    lost: Array  # share of times that go astray, to another wave of the sound or into the noise

    def beside(self, other: Array) -> Array:
        """Return the times with the delay of others."""
        return np.asarray(self.times - np.median(self.times - other))


def choose(samples: Array, rate: float, times: Array, before: Array, after: Array) -> Choice:
    """Pick onsets by every rule, and choose the one that the others and the noise say is best.

    Parameters
    ----------
    samples : ndarray, shape (m,)
        The recording.
    rate : float
        Samples per second.
    times, before, after : ndarray, shape (n,)
        When the level rises at each impact, and how far before and after that its onset may be, in s.
    """
    heard = (times[:, None] * rate).astype(np.int64) + np.arange(int(_LOUD * rate))
    loudest = np.abs(samples[np.clip(heard, 0, samples.size - 1)]).max()
    hiss = max(np.sqrt(rounding(samples)), _CLEAREST * loudest)
    samples = samples + hiss * np.random.default_rng(0).standard_normal(samples.size)
    parts = [Band(samples, rate, band) for band in bands(rate)[1:]]
    places = _Places(times, before, after)
    rough = [picks for part in parts for picks in places.picked(part)]
    own, between = _variances(rough)
    best = int(np.argmin(own))
    allies = np.argsort(between[best])[:2]
    three = np.array([rough[one].beside(rough[best].times) for one in (best, *allies)])
    middle = np.median(three, axis=0)
    delays = [float(np.median(picks.times - middle)) for picks in rough if picks.rule == MATCHED]
    spread = float(np.sqrt(between[best, allies].mean()))
    if rough[best].rule == MATCHED:
        middle = places.together(parts, delays)
        spread = 1.4826 * float(np.median(np.abs(middle - np.median(three, axis=0))))
    reach = min(_REACH + 6.0 * spread, _MOST_REACH)
    alone = np.all(np.abs(three - middle) > reach, axis=0)
    fine = [
        picks
        for part, delay in zip(parts, delays, strict=True)
        for picks in _tried(part, middle + delay, reach)
    ]
    own, _ = _variances(fine)
    whole = own[:, None] + np.array([picks.whole for picks in fine]) + _TINY
    order = np.argsort(np.mean(np.log(whole), axis=1))
    chosen = fine[order[0]]
    if chosen.rule != MATCHED:
        together = _of_all(Band(samples, rate, bands(rate)[0]), middle, reach)
        if np.mean(np.log(together.whole)) < np.mean(np.log(whole[order[0]])):
            chosen = together
            fine.append(chosen)
            own, whole = np.append(own, 0.0), np.vstack([whole, chosen.whole])
            order = np.concatenate([[len(fine) - 1], order])
    errors = np.sqrt(own[order[0]] + chosen.noise + _TINY)
    off, error = _beside_others([fine[one] for one in order], own[order])
    lost = (chosen.lost > _LOST) | (errors > _HIDDEN * reach)
    doubtful = lost | alone | (np.abs(off) > _FAR_OFF * error)
    errors = np.where(doubtful, np.maximum(np.sqrt(whole[order[0]]), np.abs(off)), errors)
    return Choice(f"{chosen.rule}, {chosen.band}", chosen.times, errors, doubtful)


class _Places:
    """Wide windows in which the impacts are; the mean sound of each band is found in them."""

    def __init__(self, times: Array, before: Array, after: Array) -> None:
        self._begins, self._lengths = times - before, before + after
        self._matched: dict[str, Matched] = {}

    def _windows(self, part: Band, delay: float = 0.0) -> tuple[list[Array], Array]:
        """Cut out the sound of each impact, and when each window begins."""
        cut = [
            part.windows(np.array([begin + delay - part.lead]), length + part.lead + part.tail)
            for begin, length in zip(self._begins, self._lengths, strict=True)
        ]
        return [rows[0] for rows, _ in cut], np.array([begin[0] for _, begin in cut])

    def picked(self, part: Band) -> list[_Picks]:
        """Pick onsets by every rule."""
        windows, begins = self._windows(part)
        found = {
            rule: np.array([picker(one[None, :])[0] for one in windows]) for rule, picker in RULES.items()
        }
        same = self._matched[part.name] = Matched(part, windows, next(iter(found.values())))
        found[MATCHED] = np.array([same(one[None, :])[0] for one in windows])
        none = np.zeros(begins.size)
        return [
            _Picks(rule, part.name, begins + places / part.rate, none, none, none)
            for rule, places in found.items()
        ]

    def together(self, parts: list[Band], delays: list[float]) -> Array:
        """Find where the sound is most like its mean in all bands together.

        A band of width B has 2 B T independent numbers in a time T. If they are normal, and the loudness
        of the sound and of the noise are not known, the logarithm of their likelihood is -B T ln(1 - r²).
        """
        step = 1.0 / max(part.rate for part in parts)
        grids = [
            begin + np.arange(0.0, length, step)
            for begin, length in zip(self._begins, self._lengths, strict=True)
        ]
        scores = [np.zeros(grid.size) for grid in grids]
        for part, delay in zip(parts, delays, strict=True):
            matched = self._matched[part.name]
            for window, begin, grid, score in zip(*self._windows(part, delay), grids, scores, strict=True):
                onsets, likeness = matched.likeness(window)
                score -= part.independent * np.interp(grid, begin + onsets / part.rate - delay, likeness)
        return np.array([grid[np.argmax(score)] for grid, score in zip(grids, scores, strict=True)])


def _tried(part: Band, times: Array, reach: float) -> list[_Picks]:
    """Pick onsets in narrow windows, and try each rule on clear sounds in the noise before each impact."""
    length = 2.0 * reach + part.lead + part.tail
    first = times - reach - part.lead
    windows, begins = part.windows(first, length)
    rng = np.random.default_rng(0)
    gaps = np.diff(times, prepend=2.0 * times[0] - times[1])
    starts = (first - length)[:, None] - 0.3 * gaps[:, None] * rng.random((times.size, _DRAWS))
    noise = part.windows(starts.ravel(), length)[0].reshape(times.size, _DRAWS, -1)
    power, of_noise = np.mean(windows**2, axis=1), np.mean(noise**2, axis=(1, 2))
    loudness = np.sqrt(np.maximum(power - of_noise, 1e-4 * power))
    clear = np.argsort(loudness / np.sqrt(of_noise + 1e-300))[::-1][:_CLEAR]
    models = clear[np.arange(_DRAWS) % clear.size]
    factors = loudness[:, None] / np.maximum(loudness[models], 1e-300)
    tried = (windows[models] * factors[:, :, None] + noise).reshape(times.size * _DRAWS, -1)
    pickers: dict[str, Picker] = RULES | {MATCHED: Matched(part, list(windows), (times - begins) * part.rate)}
    found = []
    for rule, picker in pickers.items():
        places = picker(windows)
        off = (picker(tried).reshape(times.size, _DRAWS) - places[models]) / part.rate
        off -= np.median(off, axis=1, keepdims=True)
        # Of normal numbers, three quarters are within 1.15 standard deviations.
        inside = np.abs(off) <= 5.0 / 1.15 * np.quantile(np.abs(off), 0.75, axis=1, keepdims=True)
        reading = (_READING / part.rate) ** 2
        noise_variance = reading + np.sum(inside * off**2, axis=1) / np.maximum(inside.sum(axis=1) - 1, 1)
        whole, lost = reading + np.sum(off**2, axis=1) / (_DRAWS - 1), 1.0 - inside.mean(axis=1)
        # At the edge of its window a rule has found nothing.
        early, late = part.points if rule == MATCHED else (2, 2)
        pinned = (places < early + 1.0) | (places > windows.shape[1] - late - 2.0)
        found.append(
            _Picks(
                rule,
                part.name,
                begins + places / part.rate,
                np.where(pinned, reach**2, noise_variance),
                np.where(pinned, reach**2, whole),
                np.where(pinned, 1.0, lost),
            )
        )
    return found


def _of_all(part: Band, times: Array, reach: float) -> _Picks:
    """Pick onsets by the power in all bands together; how well is known from its likelihood."""
    windows, begins = part.windows(times - reach - 1.5e-3, 2.0 * reach + 4e-3)
    silence, _ = part.windows(times - 2.0 * reach - 5e-3, reach + 3e-3)
    places, variances = by_power(part, windows, np.mean(silence**2, axis=1), (times - begins) * part.rate)
    variance = variances / part.rate**2
    none = np.zeros(times.size)
    return _Picks("mean power", part.name, begins + places / part.rate, variance, variance, none)


def _variances(found: list[_Picks]) -> tuple[Array, Array]:
    """Separate the variances of rules, besides that by noise, by their differences (three-cornered hat).

    Noise, and how the sound differs between impacts, are independent in bands that have no frequency in
    common: the difference of two rules in different bands has the sum of their variances.

    Returns
    -------
    tuple of ndarray
        The variance of each, in s², and those of the differences, infinite in one band.
    """
    bands = np.array([picks.band for picks in found])
    times, noises = np.array([picks.times for picks in found]), np.array([picks.noise for picks in found])
    number, count = times.shape
    one, other = np.nonzero(np.triu(bands[:, None] != bands))
    noise = noises[one] + noises[other]
    variance = _excess(times[one] - times[other], noise)
    error = variance + np.median(noise, axis=1) + _TINY
    between, known_to = np.full((number, number), np.inf), np.full((number, number), np.inf)
    between[one, other] = between[other, one] = variance
    known_to[one, other] = known_to[other, one] = error
    rows = np.zeros((one.size, number))
    rows[np.arange(one.size), one] = rows[np.arange(one.size), other] = 1.0 / error
    # Errors are √(2/n) of that. Where nothing tells the two apart that agree best, each has half, give or
    # take half.
    nearest = np.argmin(known_to, axis=1)
    every = np.arange(number)
    weight = np.sqrt(2.0 / count) / known_to[every, nearest]
    right = np.concatenate([variance / error, weight * between[every, nearest]])
    own, _ = nnls(np.vstack([rows, np.diag(2.0 * weight)]), right)
    return own, between


def _excess(differences: Array, noise: Array) -> Array:
    """Return the variance of each row beyond that by noise; values that are far off count as five off."""
    off = differences - np.median(differences, axis=1, keepdims=True)
    middle = (1.4826 * np.median(np.abs(off), axis=1, keepdims=True)) ** 2
    count = off.shape[1]
    size = np.minimum(off**2, 25.0 * (middle + noise)) * count / (count - 1)
    variance = np.mean(size, axis=1)
    for _ in range(20):
        weight = 1.0 / (variance[:, None] + noise + _TINY) ** 2
        variance = np.sum(weight * (size - noise), axis=1) / np.sum(weight, axis=1)
        variance = np.maximum(variance, 0.0)
    return np.asarray(variance)


def _beside_others(found: list[_Picks], own: Array) -> tuple[Array, Array]:
    """Compare the times of the first with the mean of the first of each other band; return off and error."""
    first = {picks.band: place for place, picks in reversed(list(enumerate(found)))}
    chosen, others = found[0], [place for band, place in first.items() if band != found[0].band]
    times = np.array([found[one].beside(chosen.times) for one in others])
    weights = np.array([1.0 / (own[one] + found[one].noise + _TINY) for one in others])
    weights *= np.where([found[one].lost > _LOST for one in others], 1e-3, 1.0)
    off = chosen.times - np.sum(weights * times, axis=0) / np.sum(weights, axis=0)
    error = np.sqrt(own[0] + chosen.noise + 1.0 / np.sum(weights, axis=0))
    return off - np.median(off), error
