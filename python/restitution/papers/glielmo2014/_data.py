"""Data of each figure: the runs, reduced to the numbers that are drawn."""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from restitution import analytic, fit
from restitution._internal.arrays import FloatArray
from restitution.drop.reduce import reduce, standard_errors
from restitution.papers.estimate import in_bins
from restitution.papers.figures import counted, recorded
from restitution.papers.glielmo2014._misprints import printed_density
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.histograms import density, design_effect, in_window, mesh

QUANTILES = (0.01, 0.5, 0.99)
"""Quantiles of restitution in the sensitivity figure of Fig. 2."""
# With fewer impacts than this in a velocity bin, its outer quantiles are no more than its extremes.
_FEWEST_FOR_QUANTILES = 200


def lattice(runs: Runs, s: Settings) -> xr.Dataset:
    """Figs. 2 and 3: counts on the lattices of impact velocity and restitution, and of it and E_rot/E_tot."""
    return runs.lattice.assign_attrs(counted(runs.lattice))


def slow(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 7: as Fig. 2 at low and negative impact velocity."""
    return runs.slow.assign_attrs(counted(runs.slow))


def restitution_histograms(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 4: density of restitution at each speed with its asymmetric Laplace fit to recorded impacts."""
    parts = []
    windows = zip(_at_speeds(runs), s.speed_windows, s.histogram_widths, strict=True)
    for found, window, width in windows:
        particle, values = in_window(runs.main, "restitution", window)
        edges = s.histogram_edges(width)
        fitted = fit.asymmetric_laplace(values)
        # The cusp itself is among the points, so that the curve does not cut it off.
        points = np.sort(np.append(np.linspace(edges[0], edges[-1], 400), fitted.parameters["location"]))
        together = round(width / s.finest)  # bins that are counted to one that is drawn
        half, middle = s.histogram_bins // 2 * together, found.sizes["restitution"] // 2
        fine = found["restitution_count"].to_numpy()[middle - half : middle + half]
        count = fine.reshape(-1, together).sum(axis=1)
        part = density(count, int(found["number"]), edges, design_effect(particle, values, edges))
        part["fit_point"] = ("point", points)
        part["fit_density"] = ("point", fitted.pdf(points))
        part["fit_number"] = values.size
        for name, value in fitted.parameters.items():
            part[f"fit_{name}"] = value
        parts.append(part)
    return _by_speed(parts, s).assign_attrs(recorded(runs.main), **counted(runs.windows))


def fraction_histograms(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 5: density of E_rot/E_tot at each speed."""
    edges = mesh(*s.fraction_range, s.fraction_mesh)
    parts = []
    for found, window in zip(_at_speeds(runs), s.speed_windows, strict=True):
        together = design_effect(*in_window(runs.main, "rotational_fraction", window), edges)
        count = found["fraction_count"].to_numpy()
        parts.append(density(count, int(found["number"]), edges, together))
    return _by_speed(parts, s).assign_attrs(recorded(runs.main), **counted(runs.windows))


def bead_deviation(runs: Runs, s: Settings) -> xr.Dataset:
    """Fig. 6: standard deviation of restitution against impact velocity, by elongation."""
    edges = mesh(*s.deviation_range, s.deviation_mesh)
    drawn = _deviations(runs.beads, "elongation", edges, runs.beads_counted)
    return drawn.assign_attrs(recorded(*runs.beads.values()) | counted(*runs.beads_counted.values()))


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
    # One impact a particle: all are independent.
    drawn = density(np.histogram(values, edges)[0], values.size, edges, 1.0)
    # Even steps of the angle crowd where the density diverges, at the upper end.
    points = exact.ppf(np.linspace(0.0, 1.0, 1002)[1:-1])
    drawn["point"] = ("point", points)
    drawn["exact_density"] = ("point", exact.pdf(points))
    drawn["printed_density"] = ("point", printed_density(points, body, s.first_law))
    chance = np.diff(exact.cdf(edges))
    deviation = np.sqrt(values.size * chance * (1 - chance))
    drawn["pull"] = ("bin", (drawn["impacts"].to_numpy() - values.size * chance) / deviation)
    drawn["negative"] = np.count_nonzero(values < 0) / values.size
    drawn["negative_exact"] = float(exact.cdf(0.0))
    return drawn.assign_attrs(recorded(runs.first))


def map_sensitivity(runs: Runs, s: Settings) -> xr.Dataset:
    """For the L/R of Fig. 2: quantiles of restitution against impact velocity, by radius and by height."""
    edges = mesh(*s.sensitivity_range, s.sensitivity_mesh)
    sides = []
    for axis, by in (("radius", runs.by_radius), ("height", runs.by_height)):
        found = [_quantiles(pair[s.elongation], edges) for pair in by.values()]
        sides.append(
            xr.concat(found, xr.DataArray(list(by), dims=axis, name=axis)).rename(quantile_value=f"by_{axis}")
        )
    return xr.merge(sides).assign_attrs(recorded(*_varied(runs, s.elongation)))


def deviation_sensitivity(runs: Runs, s: Settings) -> xr.Dataset:
    """For the lowest L/R of Fig. 6: standard deviation of restitution, by radius and by release height."""
    edges = mesh(*s.sensitivity_range, s.sensitivity_mesh)
    x = s.bead_elongations[0]
    sides = []
    for axis, by in (("radius", runs.by_radius), ("height", runs.by_height)):
        side = _deviations({value: pair[x] for value, pair in by.items()}, axis, edges)
        sides.append(side.rename({name: f"{name}_by_{axis}" for name in side.data_vars}))
    return xr.merge(sides).assign_attrs(recorded(*_varied(runs, x)))


def _varied(runs: Runs, elongation: float) -> list[xr.Dataset]:
    return [pair[elongation] for by in (runs.by_radius, runs.by_height) for pair in by.values()]


def _at_speeds(runs: Runs) -> list[xr.Dataset]:
    """Return what was counted in the window of each speed."""
    return [runs.windows.isel(velocity=k) for k in range(0, runs.windows.sizes["velocity"], 2)]


def _by_speed(parts: list[xr.Dataset], s: Settings) -> xr.Dataset:
    speed = xr.DataArray(list(s.speeds), dims="speed", name="speed", attrs={"units": "m s-1"})
    drawn = xr.concat(parts, speed)
    drawn["window"] = (("speed", "side"), np.array(s.speed_windows), {"units": "m s-1"})
    return drawn


def _deviations(
    by: Mapping[float, xr.Dataset],
    axis: str,
    edges: FloatArray,
    ensembles: Mapping[float, xr.Dataset] | None = None,
) -> xr.Dataset:
    """Give, in each velocity bin and for each run, the standard deviation of restitution and its error.

    Where more particles were counted than recorded, the deviation is that of all of them. Its error follows
    from the recorded ones: it falls as one over the root of the number of particles.
    """
    parts = []
    for value, data in by.items():
        found = reduce(data, edges, [0.0, 1.0]) if ensembles is None else ensembles[value]
        deviation, error = found["variance"] ** 0.5, standard_errors(data, edges)
        ratio = found.attrs["particles"] / data.attrs["particles"]
        parts.append(
            xr.Dataset(
                {
                    "deviation": deviation.assign_attrs(long_name="standard deviation of restitution"),
                    "deviation_error": error["deviation_standard_error"] / ratio**0.5,
                    "particles_recorded": error["particles"],
                }
            )
        )
    return xr.concat(parts, xr.DataArray(list(by), dims=axis, name=axis))


def _quantiles(data: xr.Dataset, edges: FloatArray) -> xr.Dataset:
    impacts = in_bins(data["impact_velocity"], edges)
    restitution = impacts.of(data["restitution"])
    found = np.full((len(QUANTILES), impacts.cells), np.nan)
    for k in range(impacts.cells):
        values = restitution[impacts.cell == k]
        if values.size >= _FEWEST_FOR_QUANTILES:
            found[:, k] = np.quantile(values, QUANTILES)
    return xr.Dataset(
        {"quantile_value": (("quantile", "velocity"), found)},
        coords={"quantile": list(QUANTILES), "velocity": 0.5 * (edges[:-1] + edges[1:])},
    )
