"""A learned distribution from counts on a lattice of impact velocity and restitution."""

import numpy as np
import xarray as xr

from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.distribution._nodes import LEAST_IMPACTS, POINT
from restitution.distribution._store import of_histograms
from restitution.distribution._table import Floats, Histogram
from restitution.drop.recorded import LATTICE, counted

_EXTREMES = ("minimum", "maximum")


def from_statistics(statistics: xr.Dataset) -> xr.Dataset:
    """Make the Dataset of a distribution; see `FluctuatingRestitution.from_statistics`."""
    needed: tuple[str, ...] = (*LATTICE, "velocity", *_EXTREMES)
    if isinstance(statistics, xr.Dataset) and "velocity_edges" not in statistics:
        needed = tuple(name for name in needed if name != "velocity_edges")  # points of a study have none
    statistics = counted("statistics", statistics, needed)
    if "source" not in statistics.attrs:
        text = " lacks the attribute source: must be from restitution.statistics or reduce"
        raise ParameterError(Problem("statistics", text))
    counts, number = _counts(statistics)
    velocity = statistics["velocity"].to_numpy()
    kept = np.flatnonzero((number >= LEAST_IMPACTS) & (velocity > 0))
    if kept.size < 2:
        raise ValueError(
            f"statistics: {kept.size} velocity bins have {LEAST_IMPACTS} impacts; at least two are needed"
        )
    rows = np.arange(kept[0], kept[-1] + 1)
    poor = rows[number[rows] < LEAST_IMPACTS]
    if poor.size:
        raise ValueError(
            f"statistics: {number[poor[0]]:.0f} impacts in the velocity bin at {velocity[poor[0]]:.4g} m/s; "
            f"bins between others must have at least {LEAST_IMPACTS}"
        )
    edges = statistics["restitution_edges"].to_numpy()
    _check_extremes(statistics, counts, edges)
    extremes = [statistics[name].to_numpy() for name in _EXTREMES]
    histograms = [_histogram(counts[row], edges, *(float(e[row]) for e in extremes)) for row in rows]
    attrs = {key: value for key, value in statistics.attrs.items() if key != "content"} | {
        "title": "Distribution of the coefficient of restitution at given impact velocity",
        "standard_errors": "none: counts do not say which particle an impact belongs to",
    }
    return of_histograms(velocity[rows], histograms, number[rows], attrs)


def quantiles(statistics: xr.Dataset, levels: Floats) -> Floats:
    """Return quantiles of restitution in each velocity bin, shape (velocities, levels).

    They are those of the learned distribution at the middle of the bin; NaN where there are fewer impacts
    than it needs.
    """
    counts, number = _counts(statistics)
    edges = statistics["restitution_edges"].to_numpy()
    extremes = [statistics[name].to_numpy() for name in _EXTREMES]
    found = np.full((number.size, levels.size), np.nan)
    for row in np.flatnonzero(number >= LEAST_IMPACTS):
        histogram = _histogram(counts[row], edges, *(float(e[row]) for e in extremes))
        found[row] = np.interp(levels, histogram.cumulative, histogram.edges)
    return found


def _counts(statistics: xr.Dataset) -> tuple[Floats, Floats]:
    """Return the counts of each velocity bin with those beyond the bins first and last, and their sum."""
    names = ("restitution_underflow", "restitution_count", "restitution_overflow")
    below, inside, above = (statistics[name].to_numpy() for name in names)
    counts = np.concatenate([below[:, None], inside, above[:, None]], axis=1).astype(np.float64)
    return counts, counts.sum(axis=1)


def _check_extremes(statistics: xr.Dataset, counts: Floats, edges: Floats) -> None:
    """Refuse a smallest or largest restitution that is not in the first or last bin that holds any."""
    ends = np.concatenate([[-np.inf], edges, [np.inf]])
    filled = counts > 0
    first = np.argmax(filled, axis=1)
    last = filled.shape[1] - 1 - np.argmax(filled[:, ::-1], axis=1)
    for name, at in zip(_EXTREMES, (first, last), strict=True):
        values = statistics[name].to_numpy()
        inside = np.isfinite(values) & (values >= ends[at]) & (values <= ends[at + 1])
        for row in np.flatnonzero(filled.any(axis=1) & ~inside)[:1]:
            allowed = f"in [{ends[at[row]]:g}, {ends[at[row] + 1]:g}], the outermost bin that holds impacts"
            raise ParameterError(wrong(f"statistics.{name}[{row}]", float(values[row]), allowed))


def _histogram(count: Floats, edges: Floats, minimum: float, maximum: float) -> Histogram:
    """Thin the bins of a row to equal probability, halving towards the tails; no edge moves."""
    if maximum - minimum < POINT:
        return Histogram(
            np.array([minimum, max(maximum, np.nextafter(minimum, np.inf))]), np.array([0.0, 1.0])
        )
    filled = np.flatnonzero(count)
    low, high = int(filled[0]), int(filled[-1]) + 1
    inner = edges[low : high - 1]
    cumulative = np.concatenate([[0.0], np.cumsum(count[low:high]) / count.sum()])
    cumulative[-1] = 1.0
    # The outermost bins that hold anything end at the extremes.
    top = max(maximum, np.nextafter(inner[-1], np.inf)) if inner.size else maximum
    all_edges = np.concatenate([[minimum], inner, [top]])
    bins = max(8, int(2.0 * count.sum() ** (1 / 3)))  # Rice's rule
    tails = 0.5 ** np.arange(1, 64) / bins
    levels = np.concatenate([tails[::-1], np.arange(1, bins) / bins, 1.0 - tails[tails > 1e-15]])
    chosen = np.unique(np.concatenate([[0], np.searchsorted(cumulative, levels), [cumulative.size - 1]]))
    return Histogram(all_edges[chosen], cumulative[chosen])
