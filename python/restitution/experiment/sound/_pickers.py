"""Onsets: the moment at which a sound begins, by several rules, in one band of frequency."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.signal import butter, firwin, resample_poly, sosfilt

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import IntArray

Picker = Callable[[Array], Array]
"""Windows, shape (m, n), to the place of the onset in each, in samples, shape (m,)."""

_SHARE = 0.3
"""Of the peak, the level of the threshold."""
_ROUNDS = 3
"""In which the mean waveform and the shifts to it are found."""
_POINTS = 8.0
"""Points to a period of the highest frequency at which a band is looked at."""
_LEAST_LEAD, _LEAD = 0.4e-3, 0.5
_LEAST_TAIL, _TAIL = 1.2e-3, 3.0
"""Window of the rules around the onset: at least this time in s, and so many periods of the band."""


class Band:
    """A recording in one band of frequency, filtered causally, for no sound precedes its cause.

    Attributes
    ----------
    name : str
        Its frequencies.
    lead, tail : float
        How far before and after an onset rules look, in s.
    independent : float
        Half the number of independent values in this time.
    rate : float
        Points per second of its windows.
    """

    def __init__(self, samples: Array, rate: float, band: tuple[float, float]) -> None:
        low, high = band
        self.name = f"{low:g} to {high:g} Hz"
        middle = np.sqrt(low * high)
        self.lead, self.tail = max(_LEAST_LEAD, _LEAD / middle), max(_LEAST_TAIL, _TAIL / middle)
        self.independent = (high - low) * (self.lead + self.tail)
        self._own = rate
        self._up, self._down = max(math.ceil(_POINTS * high / rate), 1), max(int(rate / (_POINTS * high)), 1)
        self.rate = rate * self._up / self._down
        most = max(self._up, self._down)
        # As resample_poly makes them, once.
        self._taps: Any = firwin(20 * most + 1, 1.0 / most, window=("kaiser", 5.0)) if most > 1 else None
        self._signal = np.asarray(sosfilt(butter(2, band, "bandpass", fs=rate, output="sos"), samples))

    @property
    def points(self) -> tuple[int, int]:
        """Points of a window before and after an onset."""
        return round(self.lead * self.rate), round(self.tail * self.rate)

    def windows(self, begins: Array, length: float) -> tuple[Array, Array]:
        """Cut out windows of one length in s; return them, shape (m, n), and when each begins, in s."""
        first = np.round(begins * self._own).astype(np.int64)
        places = np.clip(first[:, None] + np.arange(round(length * self._own) + 1), 0, self._signal.size - 1)
        rows = self._signal[places]
        if self._up != self._down:
            rows = resample_poly(rows, self._up, self._down, axis=1, window=self._taps)
        return rows, first / self._own


def _summit(values: Array, place: IntArray) -> Array:
    """Return the summit of the parabola through the largest value of each row and its neighbours."""
    rows = np.arange(len(values))
    inner = np.clip(place, 1, values.shape[1] - 2)
    left, middle, right = (values[rows, inner + step] for step in (-1, 0, 1))
    bend = left - 2.0 * middle + right
    shift = np.where(bend < 0.0, 0.5 * (left - right) / np.where(bend < 0.0, bend, -1.0), 0.0)
    return np.asarray(place + np.where(inner == place, np.clip(shift, -0.5, 0.5), 0.0))


def _threshold(windows: Array) -> Array:
    """Find where the sound first reaches a share of its peak."""
    size = np.abs(windows)
    level = _SHARE * size.max(axis=1)
    first = np.argmax(size >= level[:, None], axis=1)
    rows, before = np.arange(len(size)), np.maximum(first - 1, 0)
    below, above = size[rows, before], size[rows, first]
    return np.asarray(first - np.where(first > 0, (above - level) / np.maximum(above - below, 1e-300), 0.0))


def _peak(windows: Array) -> Array:
    size = np.abs(windows)
    return _summit(size, np.argmax(size, axis=1))


def _akaike(windows: Array) -> Array:
    """Find where two pieces of noise of different strength part best, up to the peak (Maeda 1985).

    AIC(k) = k ln var(x[:k]) + (N - k - 1) ln var(x[k:]).
    """
    n = np.maximum(np.argmax(np.abs(windows), axis=1) + 1, 8)[:, None]
    k = np.arange(2, windows.shape[1] - 2)[None, :]
    sums, squares = np.cumsum(windows, axis=1), np.cumsum(windows**2, axis=1)
    whole, power = (np.take_along_axis(values, n - 1, axis=1) for values in (sums, squares))
    rest = np.maximum(n - k, 1)
    left = squares[:, 1:-3] / k - (sums[:, 1:-3] / k) ** 2
    right = (power - squares[:, 1:-3]) / rest - ((whole - sums[:, 1:-3]) / rest) ** 2
    tiny = 1e-12 * power / n + 1e-300
    criterion = k * np.log(np.maximum(left, 0.0) + tiny) + (rest - 1) * np.log(np.maximum(right, 0.0) + tiny)
    criterion = np.where(k < n - 2, criterion, 1e300)
    return 2.0 + _summit(-criterion, np.argmin(criterion, axis=1))


RULES: dict[str, Picker] = {
    f"{100 * _SHARE:.0f} % of the peak": _threshold,
    "peak": _peak,
    "Akaike's criterion": _akaike,
}
"""Rules that look at one impact at a time."""
_SILENT = 0.05
"""Share of the energy of a sound by which that of any piece is taken to be larger in a correlation."""
MATCHED = "matched waveform"
"""The rule that looks at all impacts at once."""


class Matched:
    """The rule that shifts a sound to where it is most like the mean of all.

    Parameters
    ----------
    part : Band
        In which the sounds are.
    windows : list of ndarray
        The sound of each impact. The loud ones count most in the mean.
    onsets : ndarray
        Where in its window each begins, nearly, in points.
    """

    def __init__(self, part: Band, windows: list[Array], onsets: Array) -> None:
        self._lead, tail = part.points
        length = self._lead + tail
        for _ in range(_ROUNDS):
            whole = np.round(onsets).astype(int) - self._lead
            starts = np.clip(whole, 0, [one.size - length for one in windows])
            pieces = [one[at : at + length] for one, at in zip(windows, starts, strict=True)]
            self._mean = np.mean(pieces, axis=0)
            onsets = np.array([self(one[None, :])[0] for one in windows])

    def __call__(self, windows: Array) -> Array:
        """Pick the onset in each window; shape (m, n) to (m,)."""
        product = np.array([np.correlate(one, self._mean, "valid") for one in windows])
        return _summit(product, np.argmax(product, axis=1)) + self._lead

    def likeness(self, window: Array) -> tuple[Array, Array]:
        """Return onsets, in points, and ln(1 - r²), r > 0 being the correlation with the mean."""
        energy = np.convolve(window**2, np.ones(self._mean.size), "valid")
        # In digital silence the first wave of a sound is like anything.
        size = np.sqrt((energy + _SILENT * energy.max()) * np.sum(self._mean**2))
        r = np.maximum(np.correlate(window, self._mean, "valid"), 0.0) / np.maximum(size, 1e-300)
        return self._lead + np.arange(r.size), np.log1p(-(np.minimum(r, 1.0 - 1e-9) ** 2))


def by_power(part: Band, windows: Array, noise: Array, onsets: Array) -> tuple[Array, Array]:
    """Pick onsets of sounds that differ, each noise whose power rises and falls as the mean of all does.

    Of Gaussian noise of the power V(t) the logarithm of the likelihood is -½ Σ (ln V + x²/V) over independent
    points. V is the mean over all sounds, each where its own likelihood says that it is.

    Parameters
    ----------
    part : Band
    windows : ndarray, shape (m, n)
    noise : ndarray, shape (m,)
        Its mean power in each window.
    onsets : ndarray, shape (m,)
        Where each sound begins, nearly, in points.

    Returns
    -------
    tuple of ndarray
        Mean and variance of the onset, all places being as likely before, in points.
    """
    lead, tail = (round(time * part.rate) for time in (_LEAST_LEAD, _LEAST_TAIL))
    spectrum = np.mean(np.abs(np.fft.rfft(windows)) ** 2, axis=0)
    # Half the number of independent values in a point.
    independent = 1.0 / np.sum((spectrum / spectrum.sum()) ** 2) / windows.shape[1]
    power = windows**2
    pieces = np.lib.stride_tricks.sliding_window_view(power, lead + tail, axis=1)
    places = np.arange(pieces.shape[1])
    likely = 1.0 * (places == np.clip(np.round(onsets) - lead, 0, places[-1])[:, None])
    loud = np.einsum("mk,mkj->m", likely, pieces)[:, None] / (lead + tail)
    below = np.cumsum(np.pad(power, ((0, 0), (1, 0))), axis=1)
    before, after = below[:, places], below[:, -1:] - below[:, places + lead + tail]
    quiet = noise[:, None]
    for _ in range(2 * _ROUNDS):
        mean = np.einsum("mk,mkj->j", likely / loud, pieces) / len(windows)
        model = loud * gaussian_filter1d(mean, 0.5 / independent) + quiet
        late = model[:, -1:]
        surprise = np.einsum("mkj,mj->mk", pieces, 1.0 / model) + np.log(model).sum(axis=1)[:, None]
        surprise += before / quiet + places * np.log(quiet) + after / late - places * np.log(late)
        likely = np.exp(-independent * (surprise - surprise.min(axis=1)[:, None]))
        likely /= likely.sum(axis=1)[:, None]
    found = likely @ places
    return found + lead, likely @ places**2.0 - found**2
