"""Statistics of recorded impacts, and their standard errors.

Bins are half-open, ``lo <= x < hi``, and compared with the very edges that were given. What falls outside
is counted too, so that for the impacts that happened

``impacts = velocity_underflow + velocity_overflow + sum(number + undefined)``,
``number = sum(count) + restitution_underflow + restitution_overflow``, and
``number = sum(fraction_count) + fraction_underflow + fraction_overflow`` in every velocity bin.
"""

from __future__ import annotations

from collections.abc import Hashable
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._core import CREATES_ENERGY
from restitution._internal.arrays import FloatArray, IntArray, whole
from restitution.drop.batches import BATCHES, batches_of, origin
from restitution.drop.batches import standard_errors as standard_errors_of
from restitution.drop.bins import (
    FRACTION_BINS,
    LARGEST,
    all_edges_from,
    by_velocity,
    centres,
    increasing_edges,
)
from restitution.drop.dataset import labelled
from restitution.drop.energy import LEDGER, by_row, ledger_of
from restitution.drop.recorded import records


def reduce(
    data: xr.Dataset,
    velocity_bins: npt.ArrayLike,
    restitution_bins: npt.ArrayLike,
    fraction_bins: npt.ArrayLike = FRACTION_BINS,
    *,
    velocity_range: tuple[float, float] | None = None,
    restitution_range: tuple[float, float] | None = None,
    fraction_range: tuple[float, float] | None = None,
    batches: int = BATCHES,
) -> xr.Dataset:
    """Count impacts on the (impact velocity, restitution) lattice and take moments in each velocity bin.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts as from `restitution.simulate`. An impact happened where ``impact_velocity`` is not NaN.
    velocity_bins, restitution_bins, fraction_bins, velocity_range, restitution_range, fraction_range
        As in `restitution.statistics`.
    batches : int
        Batches of particles whose scatter gives the standard errors of the moments, as there; the attribute
        ``standard_errors`` says how they were found, or why there are none.

    Returns
    -------
    xarray.Dataset
        Coordinates ``velocity``, ``restitution``, ``fraction`` (bin centres); ``velocity_edges``,
        ``restitution_edges``, ``fraction_edges``; int64 grids ``restitution_count`` (velocity,
        restitution) and ``fraction_count`` (velocity, fraction).

        For each velocity bin, over all its finite restitutions whether or not they lie inside
        ``restitution_bins``: ``number``, ``mean_restitution``, ``variance`` (divided by the number, not by
        the number less one), ``skewness``, ``kurtosis`` (Pearson's: 3 for a Gaussian, 6 for a symmetric
        Laplace distribution), ``minimum``, ``maximum``, and ``mean_fraction``. Where a bin is empty they are
        NaN; skewness and kurtosis also where all values are equal.

        Over all impacts of the bin: ``energy_created``, the number of those that multiplied the kinetic
        energy by more than 1 + 1e-12, and ``largest_energy_ratio``, the largest factor of these, NaN where
        there are none.

        Left out of the grids, and counted: ``velocity_underflow``, ``velocity_overflow``; for each
        velocity bin ``restitution_underflow``, ``restitution_overflow``, ``fraction_underflow``,
        ``fraction_overflow``, and ``undefined``, the impacts whose restitution or E_rot/E_tot is not
        finite (v = 0 in Eq. 1) or at least 2³³ in magnitude, which enter no other number of their bin.

    Raises
    ------
    ValueError
        If bins are not one-dimensional, finite and strictly increasing; or data lack a variable.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> data = rs.simulate(rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98),
    ...                    particles=50, impacts=100)
    >>> found = rs.reduce(data, np.linspace(0.0, 1.2, 13), np.linspace(-1.0, 3.0, 401))
    >>> int(found["number"].sum() + found["velocity_overflow"])
    5000
    """
    velocity, restitution, fraction = all_edges_from(
        velocity_bins=(velocity_bins, velocity_range),
        restitution_bins=(restitution_bins, restitution_range),
        fraction_bins=(fraction_bins, fraction_range),
    )
    velocity_edges = increasing_edges(velocity, "velocity_bins")
    columns = {
        "restitution": increasing_edges(restitution, "restitution_bins"),
        "fraction": increasing_edges(fraction, "fraction_bins"),
    }
    batches = whole("batches", batches, 1)
    names = ("impact_velocity", "restitution", "rotational_fraction", "energy_ratio")
    velocity, restitution, fraction, energy = (column.ravel() for column in records("data", data, *names))
    parts = batches_of(data.sizes["particle"], batches)
    happened = ~np.isnan(velocity)
    particle = np.repeat(np.arange(data.sizes["particle"]), data.sizes["impact"])[happened]
    velocity, restitution, fraction, energy = (
        column[happened] for column in (velocity, restitution, fraction, energy)
    )
    # Rows as in the core: below, the bins, above.
    rows = velocity_edges.size + 1
    row = _bin(velocity, velocity_edges) + 1
    defined = (np.abs(restitution) < LARGEST) & (np.abs(fraction) < LARGEST)
    counts = {
        "restitution_count": _grid(row, restitution, defined, rows, columns["restitution"]),
        "fraction_count": _grid(row, fraction, defined, rows, columns["fraction"]),
    }
    of_all = ledger_of(velocity, restitution, energy)
    created = energy > CREATES_ENERGY
    largest = np.zeros(rows)
    np.maximum.at(largest, row[created], energy[created])
    gains = _counts(row[created], rows)
    row, restitution, fraction = row[defined], restitution[defined], fraction[defined]
    moments = {**_moments(restitution, row, rows), "mean_fraction": _mean(fraction, row, rows)}
    more = by_row("velocity", gains[1:-1], largest[1:-1])
    if len(parts) > 1:
        batch = np.searchsorted([last for _, last in parts], particle[defined], side="right")
        cells = (batch * rows + row, rows * len(parts))
        single = _moments(restitution, *cells) | {"mean_fraction": _mean(fraction, *cells)}
        single["number"] = _counts(*cells).astype(np.float64)
        shaped = {name: values.reshape(len(parts), rows)[:, 1:-1] for name, values in single.items()}
        each = [{name: values[i] for name, values in shaped.items()} for i in range(len(parts))]
        more |= standard_errors_of(each, "velocity")
    number = counts["restitution_count"][:, :-1].sum(axis=1)
    found = by_velocity(counts, number, moments, velocity_edges, columns, more)
    content = "statistics of restitution in bins of impact velocity, bins lo <= x < hi"
    how = origin(len(parts), data.sizes["particle"], batches)
    about = _without_ledger(data) | of_all
    return found.assign_attrs(about, content=content, standard_errors=how)


def standard_errors(data: xr.Dataset, velocity_bins: npt.ArrayLike, *, block: int = 1024) -> xr.Dataset:
    """Return cluster-robust standard errors of the mean and variance of restitution in each velocity bin.

    Impacts of one particle are correlated, those of different particles are not, so each particle is one
    draw. The errors are linearised: with ψ the influence of one impact (ε − mean, or (ε − mean)² −
    variance) and Ψ_i its sum over the impacts of particle i in the bin, the standard error is √(m/(m−1)
    Σ_i Ψ_i²)/number, m being the number of particles with an impact in the bin. That of the standard
    deviation σ is that of the variance over 2σ.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts as from `restitution.simulate`, dimensions (particle, impact).
    velocity_bins : array_like, shape (nv + 1,)
        As in `reduce`.
    block : int, default 1024
        Particles taken at a time; bounds the memory and changes nothing else but the rounding.

    Returns
    -------
    xarray.Dataset
        In each velocity bin ``mean_standard_error``, ``variance_standard_error``,
        ``deviation_standard_error`` (NaN where fewer than two particles contribute; the last also where
        the variance is 0) and ``particles`` (m).
    """
    edges = increasing_edges(velocity_bins, "velocity_bins")
    nv = edges.size - 1
    block = whole("block", block, 1)
    names = ("impact_velocity", "restitution", "rotational_fraction")
    velocity, restitution, fraction = records("data", data, *names)
    bins = _bin(velocity, edges)
    defined = (np.abs(restitution) < LARGEST) & (np.abs(fraction) < LARGEST)
    kept = (bins >= 0) & (bins < nv) & defined
    pooled = _moments(restitution[kept], bins[kept], nv)
    mean, variance = pooled["mean_restitution"], pooled["variance"]
    number = _counts(bins[kept], nv)

    particles = np.zeros(nv, np.int64)
    squares = np.zeros((2, nv))
    for start in range(0, velocity.shape[0], block):
        chosen = kept[start : start + block]
        b = bins[start : start + block][chosen]
        deviation = restitution[start : start + block][chosen] - mean[b]
        cell = np.nonzero(chosen)[0] * nv + b
        shape = (chosen.shape[0], nv)
        particles += np.count_nonzero(_counts(cell, shape[0] * nv).reshape(shape), axis=0)
        for k, influence in enumerate((deviation, deviation**2 - variance[b])):
            sums = np.bincount(cell, weights=influence, minlength=shape[0] * nv).reshape(shape)
            squares[k] += np.sum(sums**2, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        correction = np.where(particles > 1, particles / (particles - 1.0), np.nan)
        errors = np.sqrt(correction * squares) / number
        deviation_error = np.where(variance > 0, errors[1] / (2 * np.sqrt(variance)), np.nan)
    text = "cluster-robust standard error of the {} of restitution; a particle is a cluster"
    about = {
        "mean_standard_error": ("velocity", errors[0], text.format("mean"), None),
        "variance_standard_error": ("velocity", errors[1], text.format("variance"), None),
        "deviation_standard_error": ("velocity", deviation_error, text.format("standard deviation"), None),
        "particles": ("velocity", particles, "particles with an impact in the bin", None),
    }
    rows = {"velocity": ("velocity", centres(edges), {"units": "m s-1", "long_name": "impact velocity"})}
    return xr.Dataset(labelled(about), rows, _without_ledger(data))


def _without_ledger(data: xr.Dataset) -> dict[Hashable, Any]:
    """Return the attributes of impacts without those on energy, which belong to the whole run."""
    return {name: value for name, value in data.attrs.items() if name not in LEDGER}


def _bin(values: FloatArray, edges: FloatArray) -> IntArray:
    """Index of the bin: -1 below the first edge, the number of bins from the last edge on (and for NaN)."""
    return np.searchsorted(edges, values, side="right").astype(np.int64) - 1


def _counts(index: IntArray, size: int) -> IntArray:
    return np.bincount(index, minlength=size).astype(np.int64)


def _grid(
    row: IntArray, values: FloatArray, defined: npt.NDArray[np.bool_], rows: int, edges: FloatArray
) -> IntArray:
    """Count in rows and columns: below the bins, the bins, above, undefined; shape (rows, bins + 3)."""
    columns = edges.size + 2
    column = np.where(defined, _bin(values, edges) + 1, columns - 1)
    return _counts(row * columns + column, rows * columns).reshape(rows, columns)


def _mean(values: FloatArray, bins: IntArray, size: int) -> FloatArray:
    with np.errstate(invalid="ignore", over="ignore"):
        return np.bincount(bins, weights=values, minlength=size) / np.bincount(bins, minlength=size)


def _moments(values: FloatArray, bins: IntArray, size: int) -> dict[str, FloatArray]:
    """Return the moments about the mean of each bin, in two passes so that nothing cancels."""
    empty = np.bincount(bins, minlength=size) == 0
    minimum, maximum = np.full(size, np.inf), np.full(size, -np.inf)
    np.minimum.at(minimum, bins, values)
    np.maximum.at(maximum, bins, values)
    minimum[empty] = maximum[empty] = np.nan
    # Rounding may carry a mean past the extremes; equal values must have exactly their value as mean.
    mean = np.clip(_mean(values, bins, size), minimum, maximum)
    # Values that differ by their rounding alone are equal, as they are in the sums of `statistics`.
    rounding = 16.0 * np.finfo(np.float64).eps * np.maximum(np.abs(minimum), np.abs(maximum))
    equal = maximum - minimum <= rounding
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        deviation = np.where(equal[bins], 0.0, values - mean[bins])
        square = deviation * deviation
        m2, m3, m4 = (_mean(power, bins, size) for power in (square, square * deviation, square * square))
        skewness, kurtosis = m3 / m2**1.5, m4 / m2**2
    return {
        "mean_restitution": mean,
        "variance": m2,
        "skewness": skewness,
        "kurtosis": kurtosis,
        "minimum": minimum,
        "maximum": maximum,
    }
