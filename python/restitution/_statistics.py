"""Statistics of the coefficient of restitution at given impact velocity: counts, moments, standard errors.

Bins are half-open, ``lo <= x < hi``, and compared with the very edges that were given. What falls outside
is counted too, so that for the impacts that happened

``impacts = velocity_underflow + velocity_overflow + sum(number + undefined)``,
``number = sum(count) + restitution_underflow + restitution_overflow``, and
``number = sum(fraction_count) + fraction_underflow + fraction_overflow`` in every velocity bin.
"""

from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._run import Orientation
from restitution.bodies import Dumbbell
from restitution.laws import TangentialRestitution

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

FRACTION_BINS: FloatArray = np.linspace(0.0, 1.0, 51)
FRACTION_BINS.flags.writeable = False


def statistics(
    body: Dumbbell,
    law: TangentialRestitution,
    *,
    particles: int = 1000,
    impacts: int = 400,
    release_height: float = 0.06,
    gravity: float = 9.81,
    orientation: Orientation | npt.ArrayLike = "uniform-angle",
    minimum_speed: float = 0.0,
    seed: int = 1,
    threads: int | None = None,
    velocity_bins: npt.ArrayLike,
    restitution_bins: npt.ArrayLike,
    fraction_bins: npt.ArrayLike = FRACTION_BINS,
    progress: bool = False,
) -> xr.Dataset:
    """Drop an ensemble and keep only the statistics of its impacts.

    Takes the arguments of `restitution.simulate` and the bins of `reduce`, and returns what `reduce` would
    return for that ensemble.

    Parameters
    ----------
    body, law, particles, impacts, release_height, gravity, orientation, minimum_speed, seed, threads
        As in `restitution.simulate`.
    velocity_bins, restitution_bins, fraction_bins
        As in `reduce`.
    progress : bool, default False
        As in `restitution.simulate`.

    Returns
    -------
    xarray.Dataset
        As from `reduce`.

    Raises
    ------
    ValueError
        Naming the argument that is wrong.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    >>> law = rs.TangentialRestitution(normal=0.98)
    >>> found = rs.statistics(body, law, particles=50, velocity_bins=np.linspace(0.0, 1.2, 13),
    ...                    restitution_bins=np.linspace(-1.0, 3.0, 401))
    >>> found["count"].dims
    ('velocity', 'restitution')
    """
    from restitution import simulate

    edges = {
        "velocity_bins": _edges(velocity_bins, "velocity_bins"),
        "restitution_bins": _edges(restitution_bins, "restitution_bins"),
        "fraction_bins": _edges(fraction_bins, "fraction_bins"),
    }
    data = simulate(
        body,
        law,
        particles=particles,
        impacts=impacts,
        release_height=release_height,
        gravity=gravity,
        orientation=orientation,
        minimum_speed=minimum_speed,
        seed=seed,
        threads=threads,
        progress=progress,
    )
    return reduce(data, **edges)


def reduce(
    data: xr.Dataset,
    velocity_bins: npt.ArrayLike,
    restitution_bins: npt.ArrayLike,
    fraction_bins: npt.ArrayLike = FRACTION_BINS,
) -> xr.Dataset:
    """Count impacts on the (impact velocity, restitution) lattice and take moments in each velocity bin.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts as from `restitution.simulate`. An impact happened where ``impact_velocity`` is not NaN.
    velocity_bins : array_like, shape (nv + 1,)
        Edges of the impact velocity bins in m/s; finite, strictly increasing, uniform.
    restitution_bins : array_like, shape (nr + 1,)
        Edges of the restitution bins, likewise.
    fraction_bins : array_like, shape (nf + 1,)
        Edges of the bins of E_rot/E_tot (Eq. 12), likewise; 50 bins on [0, 1) unless told.

    Returns
    -------
    xarray.Dataset
        Coordinates ``velocity``, ``restitution``, ``fraction`` (bin centres); ``velocity_edges``,
        ``restitution_edges``, ``fraction_edges``; int64 grids ``count`` (velocity, restitution) and
        ``fraction_count`` (velocity, fraction).

        For each velocity bin, over all its finite restitutions whether or not they lie inside
        ``restitution_bins``: ``number``, ``mean``, ``variance`` (divided by the number, not by the number
        less one), ``skewness``, ``kurtosis`` (Pearson's: 3 for a Gaussian, 6 for a symmetric Laplace
        distribution), ``minimum``, ``maximum``, and ``mean_fraction``. Where a bin is empty they are NaN;
        skewness and kurtosis also where all values are equal.

        Left out of the grids, and counted: ``velocity_underflow``, ``velocity_overflow``; for each
        velocity bin ``restitution_underflow``, ``restitution_overflow``, ``fraction_underflow``,
        ``fraction_overflow``, and ``undefined``, the impacts whose restitution or fraction is not finite
        (v = 0 in Eq. 1), which enter no other number of their bin.

    Raises
    ------
    ValueError
        If bins are not one-dimensional, finite, strictly increasing and uniform; or data lack a variable.
    """
    v_edges = _edges(velocity_bins, "velocity_bins")
    e_edges = _edges(restitution_bins, "restitution_bins")
    f_edges = _edges(fraction_bins, "fraction_bins")
    velocity, restitution, fraction = _impacts(data, "impact_velocity", "restitution", "rotational_fraction")
    nv, ne, nf = v_edges.size - 1, e_edges.size - 1, f_edges.size - 1

    happened = ~np.isnan(velocity)
    bins = _bin(velocity, v_edges)
    inside = happened & (bins >= 0) & (bins < nv)
    finite = np.isfinite(restitution) & np.isfinite(fraction)
    undefined = _tally(bins[inside & ~finite], nv)
    kept = inside & finite
    bins, restitution, fraction = bins[kept], restitution[kept], fraction[kept]
    count = _histogram(bins, _bin(restitution, e_edges), nv, ne)
    fraction_count = _histogram(bins, _bin(fraction, f_edges), nv, nf)

    per_bin: dict[str, tuple[npt.NDArray[Any], str]] = {
        "number": (_tally(bins, nv), "impacts with finite restitution and rotational fraction"),
        "undefined": (undefined, "impacts whose restitution or rotational fraction is not finite"),
        "restitution_underflow": (count[:, 0], "impacts below the restitution bins"),
        "restitution_overflow": (count[:, -1], "impacts above the restitution bins"),
        "fraction_underflow": (fraction_count[:, 0], "impacts below the fraction bins"),
        "fraction_overflow": (fraction_count[:, -1], "impacts above the fraction bins"),
        "mean_fraction": (_mean(fraction, bins, nv), "mean of E_rot/E_tot before the impact"),
        **_moments(restitution, bins, nv),
    }
    grids = {
        "count": (("velocity", "restitution"), count[:, 1:-1], {"long_name": "impacts in the site"}),
        "fraction_count": (
            ("velocity", "fraction"),
            fraction_count[:, 1:-1],
            {"long_name": "impacts in the site"},
        ),
    }
    below = int(np.count_nonzero(happened & (velocity < v_edges[0])))
    above = int(np.count_nonzero(happened & (velocity >= v_edges[-1])))
    return xr.Dataset(
        grids
        | {name: ("velocity", values, {"long_name": text}) for name, (values, text) in per_bin.items()}
        | {
            "velocity_underflow": ((), np.int64(below), {"long_name": "impacts below the velocity bins"}),
            "velocity_overflow": ((), np.int64(above), {"long_name": "impacts above the velocity bins"}),
            "velocity_edges": ("velocity_edge", v_edges, {"units": "m s-1"}),
            "restitution_edges": ("restitution_edge", e_edges, {"units": "1"}),
            "fraction_edges": ("fraction_edge", f_edges, {"units": "1"}),
        },
        coords={
            "velocity": ("velocity", _centres(v_edges), {"units": "m s-1", "long_name": "impact velocity"}),
            "restitution": (
                "restitution",
                _centres(e_edges),
                {"units": "1", "long_name": "restitution (Eq. 1)"},
            ),
            "fraction": ("fraction", _centres(f_edges), {"units": "1", "long_name": "E_rot/E_tot (Eq. 12)"}),
        },
        attrs={
            **data.attrs,
            "content": "statistics of restitution in bins of impact velocity, bins lo <= x < hi",
        },
    )


def standard_errors(data: xr.Dataset, velocity_bins: npt.ArrayLike, *, block: int = 1024) -> xr.Dataset:
    """Give cluster-robust standard errors of the mean and variance of restitution in each velocity bin.

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
    edges = _edges(velocity_bins, "velocity_bins")
    nv = edges.size - 1
    columns = data[["impact_velocity", "restitution", "rotational_fraction"]].transpose("particle", "impact")
    velocity, restitution, fraction = (columns[name].to_numpy() for name in columns.data_vars)
    bins = _bin(velocity, edges)
    kept = (bins >= 0) & (bins < nv) & np.isfinite(restitution) & np.isfinite(fraction)
    pooled = _moments(restitution[kept], bins[kept], nv)
    mean, variance = pooled["mean"][0], pooled["variance"][0]
    number = _tally(bins[kept], nv)

    particles = np.zeros(nv, np.int64)
    squares = np.zeros((2, nv))
    for start in range(0, velocity.shape[0], block):
        chosen = kept[start : start + block]
        b = bins[start : start + block][chosen]
        deviation = restitution[start : start + block][chosen] - mean[b]
        cell = np.nonzero(chosen)[0] * nv + b
        shape = (chosen.shape[0], nv)
        particles += np.count_nonzero(_tally(cell, shape[0] * nv).reshape(shape), axis=0)
        for k, influence in enumerate((deviation, deviation**2 - variance[b])):
            sums = np.bincount(cell, weights=influence, minlength=shape[0] * nv).reshape(shape)
            squares[k] += np.sum(sums**2, axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        correction = np.where(particles > 1, particles / (particles - 1.0), np.nan)
        errors = np.sqrt(correction * squares) / number
        deviation_error = np.where(variance > 0, errors[1] / (2 * np.sqrt(variance)), np.nan)
    text = "cluster-robust standard error of the {} of restitution; a particle is a cluster"
    return xr.Dataset(
        {
            "mean_standard_error": ("velocity", errors[0], {"long_name": text.format("mean")}),
            "variance_standard_error": ("velocity", errors[1], {"long_name": text.format("variance")}),
            "deviation_standard_error": (
                "velocity",
                deviation_error,
                {"long_name": text.format("standard deviation")},
            ),
            "particles": ("velocity", particles, {"long_name": "particles with an impact in the bin"}),
        },
        coords={
            "velocity": ("velocity", _centres(edges), {"units": "m s-1", "long_name": "impact velocity"})
        },
        attrs=dict(data.attrs),
    )


def _edges(bins: npt.ArrayLike, name: str) -> FloatArray:
    edges = np.array(bins, dtype=np.float64)
    if edges.ndim != 1 or edges.size < 2:
        raise ValueError(f"{name} has shape {edges.shape}: needs one dimension and at least two edges")
    if not np.all(np.isfinite(edges)):
        raise ValueError(f"{name} holds {edges[~np.isfinite(edges)][0]}: edges must be finite")
    widths = np.diff(edges)
    if not np.all(widths > 0):
        at = int(np.argmin(widths > 0))
        raise ValueError(f"{name} goes from {edges[at]} to {edges[at + 1]}: edges must increase strictly")
    # Room for edges that were rounded once each, as by linspace or arange, and no more.
    allowed = 1e-9 * widths.mean() + 8 * np.spacing(np.abs(edges).max())
    if np.ptp(widths) > allowed:
        raise ValueError(f"{name} has widths from {widths.min()} to {widths.max()}: bins must be uniform")
    return edges


def _impacts(data: xr.Dataset, *names: str) -> tuple[FloatArray, ...]:
    missing = [name for name in names if name not in data]
    if missing:
        raise ValueError(f"data lacks {', '.join(missing)}: give a Dataset as from restitution.simulate")
    return tuple(data[name].to_numpy().ravel() for name in names)


def _centres(edges: FloatArray) -> FloatArray:
    return 0.5 * (edges[:-1] + edges[1:])


def _bin(values: FloatArray, edges: FloatArray) -> IntArray:
    """Index of the bin: -1 below the first edge, the number of bins from the last edge on (and for NaN)."""
    return np.searchsorted(edges, values, side="right").astype(np.int64) - 1


def _tally(index: IntArray, size: int) -> IntArray:
    return np.bincount(index, minlength=size).astype(np.int64)


def _histogram(row: IntArray, column: IntArray, rows: int, columns: int) -> IntArray:
    """Count pairs, shape (rows, columns + 2): the first column is the underflow, the last the overflow."""
    return _tally(row * (columns + 2) + column + 1, rows * (columns + 2)).reshape(rows, columns + 2)


def _mean(values: FloatArray, bins: IntArray, size: int) -> FloatArray:
    with np.errstate(invalid="ignore", over="ignore"):
        return np.bincount(bins, weights=values, minlength=size) / np.bincount(bins, minlength=size)


def _moments(values: FloatArray, bins: IntArray, size: int) -> dict[str, tuple[FloatArray, str]]:
    """Moments about the mean of each bin, in two passes so that nothing cancels."""
    empty = np.bincount(bins, minlength=size) == 0
    minimum, maximum = np.full(size, np.inf), np.full(size, -np.inf)
    np.minimum.at(minimum, bins, values)
    np.maximum.at(maximum, bins, values)
    minimum[empty] = maximum[empty] = np.nan
    # Rounding may carry a mean past the extremes; equal values must have exactly their value as mean.
    mean = np.clip(_mean(values, bins, size), minimum, maximum)
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        deviation = values - mean[bins]
        square = deviation * deviation
        m2, m3, m4 = (_mean(power, bins, size) for power in (square, square * deviation, square * square))
        skewness, kurtosis = m3 / m2**1.5, m4 / m2**2
    return {
        "mean": (mean, "mean of restitution"),
        "variance": (m2, "variance of restitution, sum of squares over the number"),
        "skewness": (skewness, "skewness of restitution"),
        "kurtosis": (kurtosis, "kurtosis of restitution, Pearson's: 3 for a Gaussian"),
        "minimum": (minimum, "smallest restitution"),
        "maximum": (maximum, "largest restitution"),
    }
