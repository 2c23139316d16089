"""The speeds of Figs. 4 and 5: one lattice fine enough for all of them, so that one run counts for all."""

from collections.abc import Iterable, Iterator

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray, IntArray
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.histograms import mesh


def histogram_edges(s: Settings, width: float) -> FloatArray:
    """Return edges of Fig. 4's histogram with bins of this width, half of them on either side of ε_n."""
    half = s.histogram_bins // 2
    return s.normal + width * np.arange(-half, half + 1, dtype=np.float64)


def lattice(s: Settings) -> tuple[FloatArray, FloatArray]:
    """Return edges of velocity (m/s) and restitution among which are those of every window and histogram."""
    windows = np.ravel(s.speed_windows)
    widths = s.histogram_widths
    bins = s.histogram_bins // 2 * round(max(widths) / _finest(widths))
    steps = np.arange(-bins, bins + 1, dtype=np.float64)
    return mesh(windows.min(), windows.max(), _finest(windows)), s.normal + _finest(widths) * steps


def at_speeds(counted: xr.Dataset, s: Settings) -> Iterator[xr.Dataset]:
    """From statistics on the `lattice`, yield the counts of the impacts in the window of each speed."""
    edges = counted["velocity_edges"].to_numpy()
    for window in s.speed_windows:
        low, high = (int(np.argmin(np.abs(edges - v))) for v in window)
        inside = counted[["restitution_count", "fraction_count", "number"]].isel(velocity=slice(low, high))
        yield inside.sum("velocity")


def coarse(count: IntArray, s: Settings, width: float) -> IntArray:
    """Put the bins of the `lattice` together to those of `histogram_edges`."""
    many = round(width / _finest(s.histogram_widths))
    half, middle = s.histogram_bins // 2 * many, count.size // 2
    summed: IntArray = count[middle - half : middle + half].reshape(-1, many).sum(axis=1)
    return summed


def _finest(values: Iterable[float]) -> float:
    """Return the largest step of which all values are multiples, if all are whole millionths."""
    return float(np.gcd.reduce(np.rint(1e6 * np.array(list(values))).astype(np.int64))) / 1e6
