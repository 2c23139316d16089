"""Envelopes of the sound in bands of frequency, and their rate of growth."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d, uniform_filter1d
from scipy.signal import butter, find_peaks, sosfilt

from restitution._internal.arrays import FloatArray as Array

BANDS = ((40.0, 160.0), (160.0, 640.0), (640.0, 2560.0), (2560.0, 9000.0), (9000.0, 20000.0))
"""Bands in Hz that are looked at, besides the whole; those beyond the rate are left out."""
_SHORTEST = 0.8e-3
"""An envelope is smoothed over a period of the lowest frequency of its band, or this time in s if longer."""
_FLOOR = 0.2
"""Quantile of the envelope that is taken for noise."""
_APART = 2.5
"""Candidates are at least so many smoothing times apart."""


@dataclass(frozen=True)
class Envelope:
    """Measure the rise of the level of a band."""

    band: tuple[float, float]  # its frequencies in Hz
    step: float  # time between values, in s
    level: Array  # in dB over the noise, >= 0
    rise: Array  # level just after a time over the mean level before it, in dB
    spread: float  # of rises of noise and ringing, in dB: 1.4826 times the median of positive ones
    width: float  # smoothing time in s

    def candidates(self, least: float) -> tuple[Array, Array]:
        """Return times in s and rises in dB of all maxima of the rise over `least` times the spread."""
        apart = max(int(_APART * self.width / self.step), 1)
        peaks, _ = find_peaks(self.rise, height=least * self.spread, distance=apart)
        return np.asarray(peaks * self.step, dtype=np.float64), self.rise[peaks]


def bands(rate: float) -> list[tuple[float, float]]:
    """Return the bands that a rate in Hz leaves."""
    top = 0.45 * rate
    inside = [(low, min(high, top)) for low, high in BANDS if low < 0.6 * top]
    return [(inside[0][0], top), *inside]


def rounding(samples: Array) -> float:
    """Return the power of the noise of rounding to the recording's depth: a twelfth of a step squared."""
    steps = np.diff(np.unique(samples))
    return max(float(steps.min()) ** 2 / 12.0 if steps.size else 0.0, 1e-30)


def envelope(samples: Array, rate: float, band: tuple[float, float], least: float) -> Envelope:
    """Follow the level of a band, causally; its noise has the power `least` or more."""
    sections = butter(2, band, "bandpass", fs=rate, output="sos")
    power = sosfilt(sections, samples) ** 2
    width = max(1.0 / band[0], _SHORTEST)
    # The whole band: its shortest parts count.
    if band[1] > 40.0 * band[0]:
        width = 4.0 * _SHORTEST
    skip = max(int(width * rate / 8.0), 1)
    size = max(int(width * rate), 1)
    smooth = uniform_filter1d(power, size, mode="nearest")[::skip]
    step = skip / rate
    floor = max(float(np.quantile(smooth, _FLOOR)), 1e-7 * float(smooth.max()), least)
    level = 10.0 * np.log10(1.0 + smooth / floor)
    half = max(round(0.5 * width / step), 1)
    # Before: the highest of three smoothing times; after: the highest within one.
    past = uniform_filter1d(maximum_filter1d(level, 2 * half + 1), 4 * half + 1)
    before = np.roll(past, 4 * half)
    before[: 4 * half] = past[0]
    after = np.roll(maximum_filter1d(level, 2 * half + 1), -half)
    after[-half:] = level[-1]
    rise = np.maximum(after - before, 0.0)
    positive = rise[rise > 0.0]
    spread = max(1.4826 * float(np.median(positive)), 0.3) if positive.size else 0.3
    return Envelope(band, step, level, rise, spread, width)
