"""The speeds of Figs. 4 and 5: one lattice fine enough for all of them, so that one run counts for all."""

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray, IntArray
from restitution.papers.glielmo2014._settings import Settings


def histogram_edges(s: Settings, width: float) -> FloatArray:
    """Return edges of Fig. 4's histogram with bins of this width, half of them on either side of ε_n."""
    half = s.histogram_bins // 2
    return s.normal + width * np.arange(-half, half + 1, dtype=np.float64)


def lattice(s: Settings) -> tuple[FloatArray, FloatArray]:
    """Return edges of velocity (m/s), every other bin of which is a window, and those of all histograms."""
    bins = s.histogram_bins // 2 * round(max(s.histogram_widths) / _finest(s))
    steps = np.arange(-bins, bins + 1, dtype=np.float64)
    return np.ravel(s.speed_windows), s.normal + _finest(s) * steps


def at_speeds(counted: xr.Dataset) -> list[xr.Dataset]:
    """From statistics on the `lattice`, return those of the impacts in the window of each speed."""
    return [counted.isel(velocity=k) for k in range(0, counted.sizes["velocity"], 2)]


def coarse(count: IntArray, s: Settings, width: float) -> IntArray:
    """Put the bins of the `lattice` together to those of `histogram_edges`."""
    many = round(width / _finest(s))
    half, middle = s.histogram_bins // 2 * many, count.size // 2
    summed: IntArray = count[middle - half : middle + half].reshape(-1, many).sum(axis=1)
    return summed


def _finest(s: Settings) -> float:
    """Return the largest step of which all widths are multiples, if all are whole millionths."""
    return float(np.gcd.reduce(np.rint(1e6 * np.array(s.histogram_widths)).astype(np.int64))) / 1e6
