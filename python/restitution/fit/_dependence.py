"""Dependence of successive impacts: autocorrelation, alternation between the spheres, runs of one sphere."""

from __future__ import annotations

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from scipy import stats

from restitution._internal.arrays import whole
from restitution.drop.bins import centres, increasing_edges
from restitution.drop.recorded import check_successive, records
from restitution.fit._result import Array


def dependence(data: xr.Dataset, velocity_bins: ArrayLike, *, lags: int = 5) -> xr.Dataset:
    """Measure how successive impacts of a particle depend on each other, in bins of the impact velocity.

    The paper ascribes the end of the exponential form at low speed to correlated impacts; this measures
    them. Each ε is replaced by its rank u among those of the same velocity bin, so that a change with v alone
    does not count as correlation.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts as from `restitution.simulate`.
    velocity_bins : array_like, shape (bins + 1,)
        Edges in m/s, strictly increasing. A pair of impacts belongs to the bin of its first; the second may
        be in any.
    lags : int, default 5
        Largest number of impacts from one to the other.

    Returns
    -------
    xarray.Dataset
        Over ``velocity``: ``autocorrelation`` (velocity, lag) of u; ``alternation``, the share of impacts
        after which the other sphere touches, where independence would have ½ by symmetry; ``crossing``, the
        share after which ε changes to the other side of its median, ½ if independent; ``run``, the mean
        number of impacts in a row on one side of the median, 1/crossing; each with its standard error over
        particles (``autocorrelation_error``, …); ``pairs``, the number of successive impacts behind them.

    Raises
    ------
    ValueError
        If `velocity_bins` are not as they must be, ``lags < 1``, data lack a variable, or their impacts do
        not follow one another, as the coordinate ``impact`` says.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.simulate(rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98),
    ...                    particles=50, impacts=100)
    >>> found = rs.fit.dependence(data, [0.2, 0.4, 0.8], lags=3)
    >>> found["autocorrelation"].dims
    ('velocity', 'lag')
    """
    lags = whole("lags", lags, 1, 10_000)
    edges = increasing_edges(velocity_bins, "velocity_bins")
    velocity, restitution, contact = records("data", data, "impact_velocity", "restitution", "contact")
    check_successive("data", data)
    rows = edges.size - 1
    row = np.searchsorted(edges, velocity, side="right") - 1
    row[~((velocity >= edges[0]) & (velocity < edges[-1]) & np.isfinite(restitution))] = -1
    u = _ranks(restitution, row, rows)
    scaled = (u - 0.5) * np.sqrt(12.0)  # of variance 1

    correlations = [
        _mean(scaled[:, :-lag] * scaled[:, lag:], row[:, :-lag], rows) for lag in range(1, lags + 1)
    ]
    later = np.isfinite(u[:, 1:])
    crossing = np.where(later, (u[:, :-1] < 0.5) != (u[:, 1:] < 0.5), np.nan)
    touched = (contact[:, :-1] > 0) & (contact[:, 1:] > 0)
    other = np.where(touched, contact[:, :-1] != contact[:, 1:], np.nan)
    change, change_error, pairs = _mean(crossing, row[:, :-1], rows)
    swap, swap_error, _ = _mean(other, row[:, :-1], rows)
    with np.errstate(divide="ignore", invalid="ignore"):
        run, run_error = 1.0 / change, change_error / change**2
    lag_axis = ("velocity", "lag")
    return xr.Dataset(
        {
            "autocorrelation": (lag_axis, np.stack([one[0] for one in correlations], axis=1)),
            "autocorrelation_error": (lag_axis, np.stack([one[1] for one in correlations], axis=1)),
            "alternation": ("velocity", swap),
            "alternation_error": ("velocity", swap_error),
            "crossing": ("velocity", change),
            "crossing_error": ("velocity", change_error),
            "run": ("velocity", run),
            "run_error": ("velocity", run_error),
            "pairs": ("velocity", pairs),
        },
        coords={
            "velocity": ("velocity", centres(edges), {"units": "m s-1", "long_name": "impact velocity"}),
            "lag": np.arange(1, lags + 1),
        },
        attrs=dict(data.attrs),
    )


def _ranks(values: Array, row: NDArray[np.int64], rows: int) -> Array:
    """Rank of each value in its row, in (0, 1), the mean of theirs where values are equal; NaN outside."""
    u = np.full(values.shape, np.nan)
    for i in range(rows):
        here = row == i
        if here.any():
            u[here] = (stats.rankdata(values[here]) - 0.5) / np.count_nonzero(here)
    return u


def _mean(values: Array, row: NDArray[np.int64], rows: int) -> tuple[Array, Array, NDArray[np.int64]]:
    """Average the finite values in each row, with the standard error over particles and the number."""
    used = np.isfinite(values) & (row >= 0)
    particle = np.nonzero(used)[0]
    size = values.shape[0] * rows
    cell = particle * rows + row[used]
    shape = (values.shape[0], rows)
    sums = np.bincount(cell, weights=values[used], minlength=size).reshape(shape)
    numbers = np.bincount(cell, minlength=size).reshape(shape)
    total = numbers.sum(axis=0)
    contributing = np.count_nonzero(numbers, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = sums.sum(axis=0) / total
        correction = np.where(contributing > 1, contributing / (contributing - 1.0), np.nan)
        error = np.sqrt(correction * np.sum((sums - mean * numbers) ** 2, axis=0)) / total
    return mean, error, total
