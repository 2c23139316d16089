"""What each figure shows, reduced from the runs to the numbers that are drawn."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution import analytic, fit
from restitution._reduce import reduce, standard_errors
from restitution.paper._misprints import printed_density
from restitution.paper._runs import Runs
from restitution.paper._settings import Settings

FloatArray = npt.NDArray[np.float64]

QUANTILES = (0.01, 0.5, 0.99)
"""Quantiles of restitution in the sensitivity figure of Fig. 2."""
# With fewer impacts than this in a velocity bin, its outer quantiles are no more than its extremes.
_FEWEST_FOR_QUANTILES = 200


def mesh(low: float, high: float, step: float) -> FloatArray:
    """Edges of the lattice with origin 0 and this step, from `low` to `high`, shape (n + 1,)."""
    return step * np.arange(round(low / step), round(high / step) + 1, dtype=np.float64)


def restitution_map(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 2: ``count`` on the lattice of impact velocity and restitution."""
    velocity = mesh(*s.velocity_range, s.velocity_mesh)
    restitution = mesh(*s.restitution_range, s.restitution_mesh)
    return reduce(runs.main, velocity, restitution).assign_attrs(_about(runs.main))


def fraction_map(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 3: ``fraction_count`` on the lattice of impact velocity and E_rot/E_tot."""
    velocity = mesh(*s.velocity_range, s.velocity_mesh)
    restitution = mesh(*s.restitution_range, s.restitution_mesh)
    fraction = mesh(*s.fraction_range, s.fraction_mesh)
    return reduce(runs.main, velocity, restitution, fraction).assign_attrs(_about(runs.main))


def low_velocity_map(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 7: as Fig. 2 at low and negative impact velocity."""
    velocity = mesh(*s.low_velocity_range, s.velocity_mesh)
    restitution = mesh(*s.low_restitution_range, s.restitution_mesh)
    return reduce(runs.main, velocity, restitution).assign_attrs(_about(runs.main))


def restitution_histograms(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 4: density of restitution at each speed with its asymmetric Laplace fit."""
    parts = []
    for window, width in zip(s.speed_windows, s.histogram_widths, strict=True):
        particle, values = _window(runs.main, "restitution", window)
        half = s.histogram_bins // 2
        edges = s.normal + width * np.arange(-half, half + 1, dtype=np.float64)
        fitted = fit.asymmetric_laplace(values)
        # The cusp itself is among the points, lest the curve cut it off.
        points = np.sort(np.append(np.linspace(edges[0], edges[-1], 400), fitted.parameters["location"]))
        part = _histogram(particle, values, edges)
        part["fit_point"] = ("point", points)
        part["fit_density"] = ("point", fitted.pdf(points))
        for name, value in fitted.parameters.items():
            part[f"fit_{name}"] = value
        parts.append(part)
    return _by_speed(parts, s).assign_attrs(_about(runs.main))


def fraction_histograms(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 5: density of E_rot/E_tot at each speed."""
    edges = mesh(*s.fraction_range, s.fraction_mesh)
    parts = [
        _histogram(*_window(runs.main, "rotational_fraction", window), edges) for window in s.speed_windows
    ]
    return _by_speed(parts, s).assign_attrs(_about(runs.main))


def bead_deviation(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 6: standard deviation of restitution against impact velocity, by elongation."""
    return _deviations(runs.beads, "elongation", mesh(*s.deviation_range, s.deviation_mesh))


def first_impact(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 9: density of restitution at the first impact, simulated, and by Eq. 21 as printed and right."""
    body = s.body(s.first_elongation)
    exact = analytic.first_impact(body, s.first_law)
    low, high = exact.support()
    step = s.first_mesh
    # Bins end where the density does, with room for the rounding of a simulated value.
    edges = high - step * np.arange(np.ceil((high - low) / step), -0.5, -1)
    edges[0], edges[-1] = low - 1e-12, high + 1e-12
    values = runs.first["restitution"].to_numpy().ravel()
    drawn = _histogram(np.arange(values.size), values, edges)
    # Even steps of the angle crowd where the density diverges, at the upper end.
    points = exact.ppf(np.linspace(0.0, 1.0, 1002)[1:-1])
    drawn["point"] = ("point", points)
    drawn["exact_density"] = ("point", exact.pdf(points))
    drawn["printed_density"] = ("point", printed_density(points, body, s.first_law))
    chance = np.diff(exact.cdf(edges))
    deviation = np.sqrt(values.size * chance * (1 - chance))
    drawn["pull"] = ("bin", (drawn["count"].to_numpy() - values.size * chance) / deviation)
    drawn["negative"] = np.count_nonzero(values < 0) / values.size
    drawn["negative_exact"] = float(exact.cdf(0.0))
    return drawn.assign_attrs(_about(runs.first))


def map_sensitivity(runs: Runs, s: Settings) -> xr.Dataset:
    """For the L/R of Fig. 2: quantiles of restitution against impact velocity, by radius and by height."""
    edges = mesh(*s.sensitivity_range, s.sensitivity_mesh)
    sides = []
    for axis, by in (("radius", runs.by_radius), ("height", runs.by_height)):
        found = [_quantiles(pair[s.elongation], edges) for pair in by.values()]
        sides.append(
            xr.concat(found, xr.DataArray(list(by), dims=axis, name=axis)).rename(quantile_value=f"by_{axis}")
        )
    return xr.merge(sides).assign_attrs(_about(*_varied(runs, s.elongation)))


def deviation_sensitivity(runs: Runs, s: Settings) -> xr.Dataset:
    """For the lowest L/R of Fig. 6: standard deviation of restitution, by radius and by release height."""
    edges = mesh(*s.sensitivity_range, s.sensitivity_mesh)
    x = s.bead_elongations[0]
    sides = []
    for axis, by in (("radius", runs.by_radius), ("height", runs.by_height)):
        side = _deviations({value: pair[x] for value, pair in by.items()}, axis, edges)
        sides.append(side.rename({name: f"{name}_by_{axis}" for name in side.data_vars}))
    return xr.merge(sides, combine_attrs="override").assign_attrs(_about(*_varied(runs, x)))


def _about(*runs: xr.Dataset) -> dict[str, Any]:
    """Attributes for a caption: what all runs have in common, their seeds, and how many impacts they hold."""
    common = {
        name: value
        for name, value in runs[0].attrs.items()
        if name not in ("seed", "run") and all(run.attrs[name] == value for run in runs)
    }
    return {
        **common,
        "seeds": [int(run.attrs["seed"]) for run in runs],
        "particles": runs[0].sizes["particle"],
        "impacts_recorded": int(sum(run["impacts"].sum() for run in runs)),
    }


def _varied(runs: Runs, elongation: float) -> list[xr.Dataset]:
    return [pair[elongation] for by in (runs.by_radius, runs.by_height) for pair in by.values()]


def _window(
    data: xr.Dataset, name: str, window: tuple[float, float]
) -> tuple[npt.NDArray[np.int64], FloatArray]:
    """Particle and value of `name` for each impact with impact velocity in [lo, hi), both of shape (n,)."""
    velocity = data["impact_velocity"].to_numpy()
    particle, impact = np.nonzero((velocity >= window[0]) & (velocity < window[1]))
    return particle, data[name].to_numpy()[particle, impact]


def _histogram(particle: npt.NDArray[np.int64], values: FloatArray, edges: FloatArray) -> xr.Dataset:
    """Density in half-open bins, with its standard error when the impacts of one particle are correlated."""
    bins = np.searchsorted(edges, values, side="right") - 1
    size = edges.size - 1
    inside = (bins >= 0) & (bins < size)
    cell, each = np.unique(particle[inside] * size + bins[inside], return_counts=True)
    count = np.bincount(cell % size, weights=each, minlength=size)
    error = np.sqrt(np.bincount(cell % size, weights=each.astype(np.float64) ** 2, minlength=size))
    scale = 1 / (values.size * np.diff(edges))
    return xr.Dataset(
        {
            "edges": ("edge", edges),
            "count": ("bin", count.astype(np.int64)),
            "density": ("bin", count * scale, {"long_name": "probability density"}),
            "density_error": ("bin", error * scale, {"long_name": "standard error, a particle is a cluster"}),
            "number": values.size,
            "outside": np.count_nonzero(~inside),
        }
    )


def _by_speed(parts: list[xr.Dataset], s: Settings) -> xr.Dataset:
    speed = xr.DataArray(list(s.speeds), dims="speed", name="speed", attrs={"units": "m s-1"})
    drawn = xr.concat(parts, speed)
    drawn["window"] = (("speed", "side"), np.array(s.speed_windows), {"units": "m s-1"})
    return drawn


def _deviations(by: Mapping[float, xr.Dataset], axis: str, edges: FloatArray) -> xr.Dataset:
    """Give, in each velocity bin and for each run, the standard deviation of restitution and its error."""
    parts = []
    for data in by.values():
        variance = reduce(data, edges, [0.0, 1.0])["variance"]
        error = standard_errors(data, edges)
        parts.append(
            xr.Dataset(
                {
                    "deviation": (variance**0.5).assign_attrs(long_name="standard deviation of restitution"),
                    "deviation_error": error["deviation_standard_error"],
                    "particles": error["particles"],
                }
            )
        )
    joined = xr.concat(parts, xr.DataArray(list(by), dims=axis, name=axis))
    return joined.assign_attrs(_about(*by.values()))


def _quantiles(data: xr.Dataset, edges: FloatArray) -> xr.Dataset:
    velocity, restitution = (data[name].to_numpy().ravel() for name in ("impact_velocity", "restitution"))
    bins = np.searchsorted(edges, velocity, side="right") - 1
    found = np.full((len(QUANTILES), edges.size - 1), np.nan)
    for k in range(edges.size - 1):
        values = restitution[bins == k]
        if values.size >= _FEWEST_FOR_QUANTILES:
            found[:, k] = np.quantile(values, QUANTILES)
    return xr.Dataset(
        {"quantile_value": (("quantile", "velocity"), found)},
        coords={"quantile": list(QUANTILES), "velocity": 0.5 * (edges[:-1] + edges[1:])},
    )
