"""Data of each figure: the runs, reduced to the numbers that are drawn."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from restitution import fit
from restitution.analytic import RoughContact
from restitution.papers.estimate import Array, Estimate, Impacts
from restitution.papers.figures import counted, recorded
from restitution.papers.gunkelmann2014._runs import Runs
from restitution.papers.gunkelmann2014._settings import Settings
from restitution.papers.histograms import density, design_effect, in_window
from restitution.papers.trend import falling


def lattice(runs: Runs, s: Settings) -> xr.Dataset:
    """Count the impacts on the lattice of impact velocity and restitution."""
    return runs.lattice.assign_attrs(counted(runs.lattice))


def densities(runs: Runs, s: Settings) -> xr.Dataset:
    """Bin the restitution at each speed, with its asymmetric Laplace fit, and the closed form."""
    parts = []
    for speed, window in zip(s.speeds, s.speed_windows, strict=True):
        particle, values = in_window(runs.main, "restitution", window)
        edges = s.normal + 6.0 * values.std() * np.linspace(-1.0, 1.0, s.histogram_bins + 1)
        count, _ = np.histogram(values, edges)
        part = density(count, values.size, edges, design_effect(particle, values, edges))
        fitted = fit.asymmetric_laplace(values)
        points = np.sort(np.append(np.linspace(edges[0], edges[-1], 400), fitted.parameters["location"]))
        part["point"] = ("at", points)
        part["fit_density"] = ("at", fitted.pdf(points))
        part["closed_density"] = ("at", s.density(speed).pdf(points))
        for name, value in fitted.parameters.items():
            part[f"fit_{name}"] = value
        parts.append(part)
    speeds = xr.DataArray(list(s.speeds), dims="speed", name="speed", attrs={"units": "m s-1"})
    return xr.concat(parts, speeds).assign_attrs(recorded(runs.main))


def deviations(runs: Runs, s: Settings) -> xr.Dataset:
    """Return σ against impact velocity, by number and by mean height, and the closed forms."""
    return _curves(runs, s, "restitution", Impacts.deviations, lambda v, at: float(s.density(v, at).std()))


def rotation(runs: Runs, s: Settings) -> xr.Dataset:
    """Return the mean rotational share against impact velocity, by number and by mean height."""
    return _curves(runs, s, "rotational_fraction", Impacts.means, s.mean_share)


def _curves(
    runs: Runs,
    s: Settings,
    of: str,
    measure: Callable[[Impacts, Array], Estimate],
    closed: Callable[[float, RoughContact], float],
) -> xr.Dataset:
    """Measure every run of both sets in bins of impact velocity, and evaluate the closed form there."""

    def side(by: Mapping[Any, xr.Dataset], contact: Callable[[Any], RoughContact], axis: str) -> xr.Dataset:
        parts = []
        for value, data in by.items():
            bins = falling(data, s.velocity_range[0], s.curve_bins)
            found = measure(bins.impacts, bins.impacts.of(data[of]))
            exact = [closed(v, contact(value)) for v in bins.speeds]
            parts.append(
                xr.Dataset(
                    {
                        f"velocity_by_{axis}": ("bin", bins.speeds, {"units": "m s-1"}),
                        f"by_{axis}": ("bin", found.value),
                        f"error_by_{axis}": ("bin", found.error),
                        f"closed_by_{axis}": ("bin", exact),
                    }
                )
            )
        return xr.concat(parts, xr.DataArray(list(by), dims=axis, name=axis))

    sides = [
        side(runs.by_number, lambda n: s.contact(asperities=n), "number"),
        side(runs.by_height, lambda h: s.contact(mean_height=h), "height"),
    ]
    return xr.merge(sides).assign_attrs(recorded(*runs.by_number.values(), *runs.by_height.values()))
