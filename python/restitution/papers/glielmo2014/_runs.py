"""The simulations behind the paper's figures."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray
from restitution.papers import runs
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.histograms import mesh
from restitution.papers.runs import Runner

# Sensitivity runs keep what is drawn and why each trajectory ended, half the memory.
_KEPT = ["impact_velocity", "restitution", "rotational_fraction", "energy_ratio", "impacts", "stop_reason"]


@dataclass(frozen=True, eq=False)
class Runs(runs.Runs):
    """All data: recorded, or counted without being kept."""

    main: xr.Dataset  # L/R = 0.1, release angle uniform: fits and standard errors of Figs. 4 and 5
    beads: Mapping[float, xr.Dataset]  # by L/R (0.01 and 0.02): standard errors of Fig. 6
    first: xr.Dataset  # L = 2R, ε_n = 0.4, one impact: Fig. 9
    isotropic: xr.Dataset  # as `main` with isotropic release orientation
    energy: Mapping[float, xr.Dataset]  # by L/R: as `main` for other elongations
    # [radius][L/R] and [height][L/R] (m) for the L/R of Fig. 2 and the first of Fig. 6
    by_radius: Mapping[float, Mapping[float, xr.Dataset]]
    by_height: Mapping[float, Mapping[float, xr.Dataset]]
    # The ensembles that `main` and `beads` are the first particles of, counted in the bins of
    lattice: xr.Dataset  # Figs. 2 and 3
    slow: xr.Dataset  # Fig. 7
    windows: xr.Dataset  # Figs. 4 and 5, one lattice for all speeds: every other bin is a window
    beads_counted: Mapping[float, xr.Dataset]  # Fig. 6, by L/R


def number(s: Settings) -> int:
    """Return the number of runs that `simulate` makes."""
    return 6 + 2 * len(s.bead_elongations) + len(s.energy_elongations) + 2 * len(s.radii + s.heights)


def simulate(s: Settings, impacts: int, runner: Runner) -> Runs:
    """Run every simulation that the figures and the claims need.

    So many impacts are counted for each of Figs. 2-5 and 7 and each curve of Fig. 6, and at most
    ``s.recorded_impacts`` of them recorded in the main run. A few more are made of both, because the end of a
    trajectory is not known beforehand. Secondary runs have their own fixed sizes.
    """

    def drop(
        name: str, elongation: float, each: int, *, radius: float = s.radius, **other: Any
    ) -> xr.Dataset:
        usual: dict[str, Any] = {
            "law": s.law,
            "particles": s.secondary_particles,
            "release_height": s.release_height,
            "gravity": s.gravity,
            "orientation": s.orientation,
        }
        return runner.record(name, s.body(elongation, radius), impacts=each, **(usual | other))

    def pair(name: str, **other: float) -> dict[float, xr.Dataset]:
        found = {}
        for x in (s.elongation, s.bead_elongations[0]):
            data = drop(f"{name}, L/R {x:g}", x, s.sensitivity_impacts_per_particle, **other)
            found[x] = data[_KEPT].copy(deep=True)  # a part would keep the whole alive
        return found

    def count(recorded: xr.Dataset, elongation: float, mean: int, *edges: FloatArray) -> xr.Dataset:
        return runner.count(
            recorded,
            s.body(elongation),
            s.law,
            particles=ceil(impacts / mean),
            velocity_bins=edges[0],
            restitution_bins=edges[1],
            fraction_bins=mesh(*s.fraction_range, s.fraction_mesh),
        )

    each = s.impacts_per_particle
    few = s.bead_impacts_per_particle
    first = drop("first", s.first_elongation, 1, particles=s.first_particles, law=s.first_law)
    particles = ceil(min(impacts, s.recorded_impacts) / s.mean_impacts)
    main = drop("main", s.elongation, each, particles=particles)
    beads = {x: drop(f"beads, L/R {x:g}", x, few) for x in s.bead_elongations}
    drawn = mesh(*s.restitution_range, s.restitution_mesh)
    slow = (
        mesh(*s.low_velocity_range, s.velocity_mesh),
        mesh(*s.low_restitution_range, s.restitution_mesh),
    )
    # Every other bin of velocity is a window; those of restitution are fine enough for all histograms.
    fine = s.histogram_edges(s.finest, round(max(s.histogram_widths) / s.finest))
    deviations = mesh(*s.deviation_range, s.deviation_mesh)
    return Runs(
        seed=runner.seed,
        asked=impacts,
        main=main,
        beads=beads,
        first=first,
        isotropic=drop("isotropic", s.elongation, each, orientation="isotropic"),
        energy={x: drop(f"energy, L/R {x:g}", x, each) for x in s.energy_elongations},
        by_radius={r: pair(f"radius {r:g} m", radius=r) for r in s.radii},
        by_height={h: pair(f"height {h:g} m", release_height=h) for h in s.heights},
        lattice=count(main, s.elongation, s.mean_impacts, mesh(*s.velocity_range, s.velocity_mesh), drawn),
        slow=count(main, s.elongation, s.mean_impacts, *slow),
        windows=count(main, s.elongation, s.mean_impacts, np.ravel(s.speed_windows), fine),
        beads_counted={x: count(data, x, few, deviations, drawn) for x, data in beads.items()},
    )
