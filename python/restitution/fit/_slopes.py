"""The flanks of p(ε | v) as functions of v: their slopes, how they grow, and where the form ends."""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from restitution._internal.arrays import generator, real, whole, word
from restitution._internal.datasets import Content
from restitution._internal.resources import check_size
from restitution.drop.bins import LARGEST, centres, increasing_edges
from restitution.drop.recorded import LATTICE, check_filled, counted, records
from restitution.fit._asymmetric import asymmetric_laplace
from restitution.fit._clusters import MOST_RESAMPLES
from restitution.fit._counts import Counts
from restitution.fit._judgement import distances
from restitution.fit._result import Array, Fit

_SIDES = ("above", "below")
_NAMES = ("location", *_SIDES)
_LEAST = 30
"""A velocity bin with fewer samples is not fitted."""
_FEWEST = 10
"""Nor is one with fewer particles, whose redrawn samples say nothing about the error."""


@dataclass(frozen=True, eq=False)
class PowerLaw(Content):
    """y = amplitude · x^exponent, fitted to ln y by weighted least squares.

    Attributes
    ----------
    exponent, amplitude : float
        The amplitude is y at x = 1.
    exponent_error, amplitude_error : float
        Standard errors over resampled particles.
    scatter : float
        Root mean square distance of ln y from the line: the relative error that the law makes.
    misfit : float
        The same in standard errors of ln y: about 1 where a power law holds, larger where the double
        logarithmic plot is bent.
    without_errors : str
        Why both errors and the misfit are nan; empty where they are known.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> data = rs.simulate(rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98),
    ...                    particles=200, impacts=150)
    >>> found = rs.fit.slopes(data, np.geomspace(0.2, 0.9, 5), location=0.98, resamples=19)

    >>> found.power_law("above").exponent < 0  # the flanks are steeper where the ball is faster
    True
    """

    exponent: float
    exponent_error: float
    amplitude: float
    amplitude_error: float
    scatter: float
    misfit: float
    without_errors: str = ""


@dataclass(frozen=True, eq=False)
class Slopes(Content):
    """Asymmetric Laplace fits in bins of the impact velocity.

    Attributes
    ----------
    table : xarray.Dataset
        Over ``velocity``: ``location`` of the cusp, decay lengths ``above`` and ``below``, each with its
        standard error over resampled particles (``above_error``, …); ``ks_distance`` of the fit;
        ``samples``, ``particles``. The attribute ``standard_errors`` says where the errors come from, or
        why there are none. NaN where a bin has fewer than 30 samples or 10 particles, or
        no more filled bins of counts than parameters.
    resampled : xarray.Dataset
        ``above`` and ``below`` over (``resample``, ``velocity``).

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> data = rs.simulate(rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98),
    ...                    particles=200, impacts=150)
    >>> found = rs.fit.slopes(data, np.geomspace(0.2, 0.9, 5), location=0.98, resamples=19)

    >>> found.table["above_error"].dims, found.resampled["above"].dims
    (('velocity',), ('resample', 'velocity'))
    """

    table: xr.Dataset
    resampled: xr.Dataset

    def _repr_html_(self) -> str:
        return str(self.table._repr_html_())

    def power_law(
        self, side: str, low: float = 0.0, high: float = np.inf, *, release_speed: float | None = None
    ) -> PowerLaw:
        """Fit the growth of a flank, "above" or "below", over the velocity bins with centres in [low, high].

        Parameters
        ----------
        side : str
        low, high : float
            In m/s.
        release_speed : float, optional
            Speed v₀ of the first impact, in m/s. The law is then one in x = √(v₀²/v² − 1) and not in x = v.
            Impacts that are independent kick the spin ω at random by δω ∝ v, so that ⟨ω²⟩ grows by ∝ v² an
            impact while v falls by (1 − ε_n)v: ⟨ω²⟩ ∝ v₀² − v². The flanks, ∝ ω/v, then have exponent 1 in x.

        Raises
        ------
        ValueError
            If there is no such side, fewer than three bins have a fit there, or ``release_speed`` is not
            above them.
        """
        word("side", side, _SIDES)
        speed = "a speed in m/s"
        low, high = (
            real(name, given, speed, lambda v: not isnan(v), unit="m s-1")
            for name, given in (("low", low), ("high", high))
        )
        if release_speed is not None:
            release_speed = real("release_speed", release_speed, "a finite speed in m/s", unit="m s-1")
        v, y = self.table["velocity"].to_numpy(), self.table[side].to_numpy()
        chosen = (v >= low) & (v <= high) & (y > 0)
        if np.count_nonzero(chosen) < 3:
            raise ValueError(f"low = {low!r}, high = {high!r}: fewer than three bins have a fit there")
        v, y = v[chosen], y[chosen]
        if release_speed is not None and not release_speed > v.max():
            raise ValueError(
                f"release_speed = {release_speed!r}: must be above {v.max():g} m/s, the fastest bin"
            )
        x = np.log(v)
        if release_speed is not None:  # ln √(v₀²/v² − 1), for any speeds
            x = np.log(release_speed) - x + 0.5 * np.log1p(-((v / release_speed) ** 2))
        error = self.table[f"{side}_error"].to_numpy()[chosen] / y
        known = bool(np.all(np.isfinite(error) & (error > 0)))
        weight = 1.0 / error if known else np.ones_like(error)

        def line(values: Array) -> Array:
            return np.polyfit(x, np.log(values), 1, w=weight)

        exponent, intercept = line(y)
        residual = np.log(y) - exponent * x - intercept
        again = self.resampled[side].to_numpy()[:, chosen]
        drawn = np.array([line(one) for one in again if np.all(one > 0)])
        spread = np.std(drawn, axis=0, ddof=1) if len(drawn) > 1 else np.full(2, np.nan)
        amplitude = float(np.exp(intercept))
        origin = str(self.table.attrs["standard_errors"])
        return PowerLaw(
            exponent=float(exponent),
            exponent_error=float(spread[0]),
            amplitude=amplitude,
            amplitude_error=amplitude * float(spread[1]),
            scatter=float(np.sqrt(np.sum(residual**2) / (x.size - 2))),
            misfit=float(np.sqrt(np.sum((residual * weight) ** 2) / (x.size - 2))) if known else np.nan,
            without_errors="" if len(drawn) > 1 else origin,
        )

    def fails_below(self, distance: float = 0.03, high: float = np.inf) -> float:
        """Return the speed above which no fit has a Kolmogorov–Smirnov distance larger than `distance`.

        It is the lower edge of a velocity bin, the last one for which this holds; nan if even the fastest bin
        is farther away. Any form fails a test of significance if the samples are many enough; a distance is
        how much it fails by. Of sets of a thousand independent samples of the form itself one in twenty lies
        farther than 0.03 from its own fit.

        Parameters
        ----------
        distance : float
        high : float
            Velocity bins with centres above are left out, in m/s: those of the first impacts, for instance,
            whose density is not that of an ensemble but follows from the release.
        """
        distance = real("distance", distance, "a number", lambda d: not isnan(d))
        high = real("high", high, "a speed in m/s", lambda v: not isnan(v), unit="m s-1")
        used = self.table["velocity"].to_numpy() <= high
        far = ~(self.table["ks_distance"].to_numpy()[used] <= distance)
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
        bins are then used. They do not say which particle an impact belongs to, so that there are no
        standard errors.
    velocity_bins : array_like, shape (bins + 1,)
        Edges in m/s, strictly increasing; not for counts. Bins of a constant ratio, `numpy.geomspace`, hold
        about as many impacts each, for the speed falls by a share at every impact.
    location : float, optional
        The cusp, e.g. the law's ε_n; fitted in each bin unless given.
    resamples : int, default 99
        At least 2.
    seed : int
        Of the bootstrap. The same particles are drawn again in all bins, so that errors are correlated as the
        slopes are.

    Raises
    ------
    ValueError
        If `velocity_bins` are missing, or given with counts, or ``resamples < 2``.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> data = rs.simulate(rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98),
    ...                    particles=200, impacts=150)
    >>> found = rs.fit.slopes(data, np.geomspace(0.2, 0.9, 5), location=0.98, resamples=19)

    >>> bool((found.table["above"] > 0).all())
    True
    """
    resamples = whole("resamples", resamples, 2, MOST_RESAMPLES)
    random = generator("seed", seed)
    if location is not None:
        location = real("location", location, "a finite number")
    if isinstance(data, xr.Dataset) and "restitution_count" in data:
        if velocity_bins is not None:
            raise ValueError("velocity_bins: counts have their own; leave it out")
        return _from_counts(data, location)
    if velocity_bins is None:
        raise ValueError("velocity_bins: missing; recorded impacts need edges in m/s")
    edges = increasing_edges(velocity_bins, "velocity_bins")
    velocity, restitution = records("data", data, "impact_velocity", "restitution")
    check_filled("data", velocity)
    particles = velocity.shape[0]
    rows = edges.size - 1
    check_size("resamples", resamples, resamples, 2 * 8 * len(_NAMES) * rows, "draws")
    fits: list[Fit | None] = [None] * rows
    near, members = np.full(rows, np.nan), np.zeros(rows)
    drawn = np.full((rows, resamples, len(_NAMES)), np.nan)
    fitted: dict[int, tuple[NDArray[np.intp], Array]] = {}
    for i in range(rows):
        inside = (velocity >= edges[i]) & (velocity < edges[i + 1]) & (np.abs(restitution) < LARGEST)
        particle, x = np.nonzero(inside)[0], restitution[inside]
        members[i] = np.unique(particle).size
        order = np.argsort(x)
        particle, x = particle[order], x[order]
        if x.size < _LEAST or members[i] < _FEWEST or x[0] == x[-1]:
            continue
        one = asymmetric_laplace(x, location)
        fits[i], near[i] = one, distances(one, x)[0]
        fitted[i] = particle, x
    equal = np.full(particles, 1.0 / particles)
    for k in range(resamples):  # one after the other: all take room for resamples times particles
        times = random.multinomial(particles, equal)
        for i, (particle, x) in fitted.items():
            drawn[i, k] = _again(x, times[particle], location)
    return _assembled(edges, fits, near, drawn, members)


def _again(x: Array, times: NDArray[np.int64], location: float | None) -> list[float]:
    again = np.repeat(x, times)
    if again.size == 0 or again[0] == again[-1]:
        return [np.nan] * len(_NAMES)
    parameters = asymmetric_laplace(again, location).parameters
    return [parameters[name] for name in _NAMES]


def _deviation(drawn: Array) -> Array:
    """Take the standard deviation of what was drawn and is not nan, shape (names,)."""
    known = drawn[np.isfinite(drawn[:, 0])]
    return known.std(axis=0, ddof=1) if len(known) > 1 else np.full(drawn.shape[1], np.nan)


def _from_counts(statistics: xr.Dataset, location: float | None) -> Slopes:
    if "velocity_edges" not in statistics:
        raise ValueError("data: statistics without velocity bins; give velocity_bins to `statistics`")
    statistics = counted("data", statistics, (*LATTICE, "number"))
    edges = statistics["velocity_edges"].to_numpy()
    rows = edges.size - 1
    fits: list[Fit | None] = [None] * rows
    near = np.full(rows, np.nan)
    free = len(_NAMES) - (location is not None)
    outside = ("restitution_underflow", "restitution_overflow")
    filled = sum(statistics[name].to_numpy() > 0 for name in outside)
    filled += np.count_nonzero(statistics["restitution_count"].transpose("velocity", "restitution"), axis=1)
    for i in np.flatnonzero((statistics["number"].to_numpy() >= _LEAST) & (filled > free)):
        counts = Counts.at(statistics, float(edges[i]))
        one = asymmetric_laplace(counts, location)
        fits[i], near[i] = one, float(np.max(np.abs(counts.cumulative() - one.cdf(counts.edges))))
    return _assembled(edges, fits, near, np.empty((rows, 0, len(_NAMES))), np.full(rows, np.nan))


def _assembled(edges: Array, fits: list[Fit | None], near: Array, drawn: Array, particles: Array) -> Slopes:
    # A draw without any of the bin's particles leaves nan.
    errors = np.array([_deviation(one) for one in drawn])
    columns = {name: [np.nan if one is None else one.parameters[name] for one in fits] for name in _NAMES}
    columns |= {f"{name}_error": errors[:, i].tolist() for i, name in enumerate(_NAMES)}
    columns |= {"ks_distance": near.tolist(), "samples": [0 if one is None else one.samples for one in fits]}
    speed = {"velocity": ("velocity", centres(edges), {"units": "m s-1", "long_name": "impact velocity"})}
    table = xr.Dataset({name: ("velocity", values) for name, values in columns.items()}, coords=speed)
    table["particles"] = ("velocity", particles)
    table["velocity_edges"] = ("velocity_edge", edges, {"units": "m s-1"})
    by_particle = "over resampled particles"
    none = "unknown: counts do not say which particle an impact belongs to"
    table.attrs["standard_errors"] = by_particle if drawn.shape[1] else none
    resampled = xr.Dataset(
        {name: (("velocity", "resample"), drawn[:, :, i]) for i, name in enumerate(_NAMES)}, coords=speed
    )
    return Slopes(table, resampled.transpose("resample", "velocity"))
