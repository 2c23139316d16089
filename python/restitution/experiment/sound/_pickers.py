"""Onsets: the moment at which a sound begins, by several rules."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.signal import butter, sosfilt

from restitution.experiment.sound._scatter import Scatter, scatter

Array = npt.NDArray[np.float64]
Whole = npt.NDArray[np.int64]

_HIGH_PASSES = (0.0, 200.0, 800.0, 2500.0, 7000.0)
"""Corner frequencies in Hz that are tried, 0 being none; those beyond the rate are left out."""
_THRESHOLDS = (0.1, 0.3, 0.5)
"""Shares of the peak."""


@dataclass(frozen=True)
class Picks:
    """Times in samples by one rule.

    Attributes
    ----------
    rule, filter : str
        What the rule was, and of which part of the sound.
    times : ndarray, shape (n,)
        In samples, with fractions.
    places : ndarray of int, shape (n,)
        Number of each impact in its series, those that were missed counted.
    scatter : Scatter or None
        About a smooth law, in samples; None if there are too few.
    """

    rule: str
    filter: str
    times: Array
    places: Whole
    scatter: Scatter | None

    def __str__(self) -> str:
        return f"{self.rule}, {self.filter}"


def pick(
    parts: list[tuple[str, Array]],
    rate: float,
    begins: Whole,
    ends: Whole,
    places: Whole,
    onsets: Array | None = None,
) -> list[Picks]:
    """Pick the onset in each window by every rule.

    Parameters
    ----------
    parts : list of str and ndarray, shape (n,)
        The recording, filtered in several ways.
    rate : float
        Samples per second.
    begins, ends : ndarray of int, shape (m,)
        Windows, one for each impact, as indices of samples.
    places : ndarray of int, shape (m,)
        Number of each impact in its series, those that were missed counted.
    onsets : ndarray, shape (m,), optional
        Onsets that are nearly right, in samples, from which waveforms are matched.
    """
    found: list[Picks] = []
    for name, filtered in parts:
        windows = [filtered[begin:end] for begin, end in zip(begins, ends, strict=True)]
        for rule, picker in _RULES.items():
            times = begins + np.array([picker(window) for window in windows])
            found.append(Picks(rule, name, times, places, scatter(times, places)))
        base = found[-len(_RULES)].times if onsets is None else onsets
        times = _matched(filtered, base, int(1.5e-3 * rate), int(0.5e-3 * rate))
        found.append(Picks("matched waveform", name, times, places, scatter(times, places)))

    return found


def variants(samples: Array, rate: float, band: tuple[float, float]) -> list[tuple[str, Array]]:
    """Filter causally: no sound begins before its cause. The last is the band of the series, in Hz."""
    found = [("unfiltered", samples)]
    for corner in _HIGH_PASSES[1:]:
        if corner < 0.3 * rate:
            found.append(
                (
                    f"above {corner:g} Hz",
                    sosfilt(butter(2, corner, "highpass", fs=rate, output="sos"), samples),
                )
            )
    low, high = band
    name = f"{low:g} to {high:g} Hz"
    found.append((name, sosfilt(butter(2, band, "bandpass", fs=rate, output="sos"), samples)))
    return found


def _crossing(values: Array, level: float) -> float:
    """Return the first place, with fraction, at which values reach a level."""
    first = int(np.argmax(values >= level))
    if first == 0:
        return 0.0
    below, above = values[first - 1], values[first]
    return first - 1 + float((level - below) / (above - below))


def _threshold(share: float) -> Callable[[Array], float]:
    def picker(window: Array) -> float:
        size = np.abs(window)
        return _crossing(size, share * float(size.max()))

    return picker


def _peak(window: Array) -> float:
    """Place of the largest size, by the parabola through it and its neighbours."""
    size = np.abs(window)
    place = int(np.argmax(size))
    return place + _summit(size, place)


def _summit(values: Array, place: int) -> float:
    if not 0 < place < values.size - 1:
        return 0.0
    left, middle, right = values[place - 1 : place + 2]
    bend = left - 2.0 * middle + right
    return float(0.5 * (left - right) / bend) if bend < 0.0 else 0.0


def _energy(window: Array) -> float:
    """Find the time by which a tenth of the energy up to the peak has arrived."""
    energy = np.cumsum(window[: int(np.argmax(np.abs(window))) + 1] ** 2)
    return _crossing(energy, 0.1 * float(energy[-1]))


def _akaike(window: Array) -> float:
    """Find where two pieces of noise of different strength part best, up to the peak (Maeda 1985).

    AIC(k) = k ln var(x[:k]) + (N - k - 1) ln var(x[k:]).
    """
    part = window[: max(int(np.argmax(np.abs(window))) + 1, 8)]
    n = part.size
    k = np.arange(2, n - 2)
    if not k.size:
        return float(np.argmax(np.abs(window)))
    sums, squares = np.cumsum(part), np.cumsum(part**2)
    left = squares[k - 1] / k - (sums[k - 1] / k) ** 2
    rest = n - k
    right = (squares[-1] - squares[k - 1]) / rest - ((sums[-1] - sums[k - 1]) / rest) ** 2
    tiny = 1e-12 * max(float(squares[-1]) / n, 1e-30)
    criterion = k * np.log(left + tiny) + (rest - 1) * np.log(right + tiny)
    place = int(np.argmin(criterion))
    return float(k[place]) + _summit(-criterion, place)


_RULES: dict[str, Callable[[Array], float]] = {
    "30 % of the peak": _threshold(0.3),
    "10 % of the peak": _threshold(0.1),
    "50 % of the peak": _threshold(0.5),
    "peak": _peak,
    "tenth of the energy": _energy,
    "Akaike's criterion": _akaike,
}


def _matched(signal: Array, base: Array, length: int, reach: int) -> Array:
    """Shift each onset to where the sound after it is most like the mean of all."""
    before = length // 4
    size = length + before
    starts = np.round(base).astype(np.int64) - before
    if size < 8 or starts.size < 3:
        return base
    padded = np.pad(signal, (reach + size, reach + size + length))
    starts = starts + reach + size
    pieces = np.array([padded[start : start + size] for start in starts])
    scale = np.sqrt(np.sum(pieces**2, axis=1, keepdims=True))
    template = np.mean(pieces / np.maximum(scale, 1e-30), axis=0)
    shifts = np.zeros(starts.size)
    for _ in range(2):
        aligned = []
        for number, start in enumerate(starts):
            around = padded[start - reach : start + size + reach]
            likeness = np.correlate(around, template, mode="valid")
            place = int(np.argmax(likeness))
            shifts[number] = place + _summit(likeness, place) - reach
            piece = padded[start + place - reach : start + place - reach + size]
            aligned.append(piece / max(float(np.sqrt(np.sum(piece**2))), 1e-30))
        template = np.mean(aligned, axis=0)
    return np.asarray(np.round(base) + shifts)
