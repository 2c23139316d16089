"""The flanks of p(ε | v) as functions of v: their slopes, how they grow, and where the form ends."""

from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from restitution._bins import centres, checked_edges
from restitution.fit._asymmetric import asymmetric_laplace
from restitution.fit._clusters import empirical
from restitution.fit._counts import Counts
from restitution.fit._result import Array, Fit

_SIDES = ("above", "below")
_LEAST = 30
"""Fewer samples in a velocity bin are not fitted."""


@dataclass(frozen=True)
class PowerLaw:
    """y = amplitude · v^exponent, fitted to ln y by weighted least squares.

    Attributes
    ----------
    exponent, amplitude : float
        The amplitude is y at 1 m/s.
    exponent_error, amplitude_error : float
        Standard errors over redrawn particles; nan for counts.
    misfit : float
        Root mean square distance of ln y from the line, in standard errors of ln y (nan for counts): about 1
        where a power law holds, larger where the double logarithmic plot is bent.
    """

    exponent: float
    exponent_error: float
    amplitude: float
    amplitude_error: float
    misfit: float


@dataclass(frozen=True)
class Slopes:
    """Asymmetric Laplace fits in bins of the impact velocity.

    Attributes
    ----------
    table : xarray.Dataset
        Over ``velocity``: ``location`` of the cusp, decay lengths ``above`` and ``below``, each with its
        standard error over redrawn particles (``above_error``, …); ``ks_distance`` of the fit; ``samples``,
        ``particles``. NaN where a bin has fewer than 30 samples.
    resampled : xarray.Dataset
        ``above`` and ``below`` over (``resample``, ``velocity``).
    """

    table: xr.Dataset
    resampled: xr.Dataset

    def power_law(self, side: str, low: float = 0.0, high: float = np.inf) -> PowerLaw:
        """Fit the growth of a flank, "above" or "below", over the velocity bins with centres in [low, high].

        Raises
        ------
        ValueError
            If there is no such side, or fewer than three bins have a fit there.
        """
        if side not in _SIDES:
            raise ValueError(f"side = {side!r}: must be 'above' or 'below'")
        v, y = self.table["velocity"].to_numpy(), self.table[side].to_numpy()
        chosen = (v >= low) & (v <= high) & (y > 0)
        if np.count_nonzero(chosen) < 3:
            raise ValueError(f"low = {low!r}, high = {high!r}: fewer than three bins have a fit there")
        error = self.table[f"{side}_error"].to_numpy()[chosen] / y[chosen]
        weight = 1.0 / error if np.all(np.isfinite(error) & (error > 0)) else np.ones_like(error)
        x = np.log(v[chosen])

        def line(values: Array) -> Array:
            return np.polyfit(x, np.log(values), 1, w=weight)

        exponent, intercept = line(y[chosen])
        residual = (np.log(y[chosen]) - exponent * x - intercept) / error
        again = self.resampled[side].to_numpy()[:, chosen]
        drawn = np.array([line(one) for one in again if np.all(one > 0)])
        spread = np.std(drawn, axis=0, ddof=1) if len(drawn) > 1 else np.full(2, np.nan)
        amplitude = float(np.exp(intercept))
        misfit = float(np.sqrt(np.sum(residual**2) / (x.size - 2)))
        return PowerLaw(float(exponent), float(spread[0]), amplitude, amplitude * float(spread[1]), misfit)

    def fails_below(self, distance: float = 0.05) -> float:
        """Give the speed above which no fit has a Kolmogorov–Smirnov distance larger than `distance`.

        It is the lower edge of a velocity bin, the last one for which this holds; nan if even the fastest bin
        is farther away. Any form fails a test of significance if the samples are many enough; a distance is
        how much it fails by.
        """
        far = ~(self.table["ks_distance"].to_numpy() <= distance)
        edges = self.table["velocity_edges"].to_numpy()
        first = int(np.flatnonzero(far)[-1]) + 1 if far.any() else 0
        return float(edges[first]) if first < far.size else np.nan


def slopes(
    data: xr.Dataset,
    velocity_bins: ArrayLike | None = None,
    *,
    location: float | None = None,
    resamples: int = 99,
    seed: int = 1,
) -> Slopes:
    """Fit the asymmetric Laplace density to ε in each bin of impact velocity, the paper's Fig. 4 for every v.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts as from `restitution.simulate`; or counts as from `restitution.statistics`, whose velocity
        bins are then used, and which have no particles to draw again: standard errors are nan.
    velocity_bins : array_like, shape (bins + 1,)
        Edges in m/s, uniform; not for counts.
    location : float, optional
        The cusp, e.g. the law's ε^n; fitted in each bin unless given.
    resamples, seed : int
        Of the bootstrap. The same particles are drawn again in all bins, so that errors are correlated as the
        slopes are.

    Raises
    ------
    ValueError
        If `velocity_bins` are missing, or given with counts.
    """
    if "count" in data:
        if velocity_bins is not None:
            raise ValueError("velocity_bins: counts have their own; leave it out")
        return _from_counts(data, location)
    if velocity_bins is None:
        raise ValueError("velocity_bins: missing; recorded impacts need edges in m/s")
    edges = checked_edges(velocity_bins, "velocity_bins")
    velocity, restitution = (
        data[name].transpose("particle", "impact").to_numpy() for name in ("impact_velocity", "restitution")
    )
    particles = velocity.shape[0]
    random = np.random.default_rng(seed)
    times = random.multinomial(particles, np.full(particles, 1.0 / particles), size=resamples)
    fits: list[Fit | None] = []
    drawn = np.full((resamples, edges.size - 1, 2), np.nan)
    errors = np.full((edges.size - 1, 3), np.nan)
    members = []
    for i in range(edges.size - 1):
        particle, column = np.nonzero((velocity >= edges[i]) & (velocity < edges[i + 1]))
        x = restitution[particle, column]
        members.append(np.unique(particle).size)
        if x.size < _LEAST:
            fits.append(None)
            continue
        order = np.argsort(x)
        x, particle = x[order], particle[order]
        fits.append(asymmetric_laplace(x, location))
        again = [asymmetric_laplace(np.repeat(x, row[particle]), location) for row in times]
        found = np.array([[one.parameters[name] for name in ("location", *_SIDES)] for one in again])
        errors[i], drawn[:, i] = found.std(axis=0, ddof=1), found[:, 1:]
    distances = []
    for i, one in enumerate(fits):
        here = restitution[(velocity >= edges[i]) & (velocity < edges[i + 1])]
        distances.append(np.nan if one is None else _distance(one, here))
    return _assembled(edges, fits, distances, errors, drawn, np.array(members))


def _from_counts(statistics: xr.Dataset, location: float | None) -> Slopes:
    edges = statistics["velocity_edges"].to_numpy()
    fits: list[Fit | None] = []
    distances = []
    for v in centres(edges):
        enough = int(statistics["number"].sel(velocity=v, method="nearest")) >= _LEAST
        counts = Counts.at(statistics, float(v)) if enough else None
        one = None if counts is None else asymmetric_laplace(counts, location)
        fits.append(one)
        near = np.nan
        if one is not None and counts is not None:
            near = float(np.max(np.abs(counts.cumulative() - one.cdf(counts.edges))))
        distances.append(near)
    rows = edges.size - 1
    return _assembled(
        edges, fits, distances, np.full((rows, 3), np.nan), np.empty((0, rows, 2)), np.full(rows, np.nan)
    )


def _distance(fit: Fit, samples: Array) -> float:
    x = np.sort(samples)
    below = fit.cdf(x)
    above = empirical(x, x)
    return float(max(np.max(above - below), np.max(below - above + 1.0 / x.size)))


def _assembled(
    edges: Array,
    fits: list[Fit | None],
    distances: list[float],
    errors: Array,
    drawn: Array,
    particles: Array,
) -> Slopes:
    names = ("location", *_SIDES)
    columns = {name: [np.nan if one is None else one.parameters[name] for one in fits] for name in names}
    columns |= {f"{name}_error": errors[:, i].tolist() for i, name in enumerate(names)}
    columns |= {"ks_distance": distances, "samples": [0 if one is None else one.samples for one in fits]}
    speed = {"velocity": ("velocity", centres(edges), {"units": "m s-1", "long_name": "impact velocity"})}
    table = xr.Dataset({name: ("velocity", values) for name, values in columns.items()}, coords=speed)
    table["particles"] = ("velocity", particles)
    table["velocity_edges"] = ("velocity_edge", edges, {"units": "m s-1"})
    resampled = xr.Dataset(
        {side: (("resample", "velocity"), drawn[:, :, i]) for i, side in enumerate(_SIDES)}, coords=speed
    )
    return Slopes(table, resampled)
