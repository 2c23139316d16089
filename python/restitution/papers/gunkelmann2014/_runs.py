"""The simulations behind the figures and claims."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil
from typing import Any

import xarray as xr

from restitution.bodies import AnyBody
from restitution.papers import runs
from restitution.papers.gunkelmann2014._settings import Settings
from restitution.papers.histograms import mesh
from restitution.papers.runs import Runner


@dataclass(frozen=True, eq=False)
class Runs(runs.Runs):
    """All data: recorded, or counted without being kept."""

    main: xr.Dataset  # random heights
    dumbbell: xr.Dataset  # as `main`, the dumbbell
    by_number: Mapping[int, xr.Dataset]  # by N, equal heights
    by_height: Mapping[float, xr.Dataset]  # by the mean height, random heights
    lattice: xr.Dataset  # the ensemble that `main` is the first particles of, counted


def number(s: Settings) -> int:
    """Return the number of runs that `simulate` makes."""
    return 3 + len(s.numbers) + len(s.mean_heights)


def simulate(s: Settings, impacts: int, runner: Runner) -> Runs:
    """Run every simulation that figures and claims need, with so many impacts in the counted one."""

    def drop(name: str, body: AnyBody, **other: Any) -> xr.Dataset:
        usual: dict[str, Any] = {
            "particles": s.secondary_particles,
            "impacts": s.impacts_per_particle,
            "release_height": s.release_height,
            "gravity": s.gravity,
            "orientation": "isotropic",
        }
        return runner.record(name, body, s.law, **(usual | other))

    particles = ceil(min(impacts, s.recorded_impacts) / s.impacts_per_particle)
    main = drop("main", s.body(), particles=particles)
    return Runs(
        seed=runner.seed,
        asked=impacts,
        main=main,
        dumbbell=drop("dumbbell", s.dumbbell, impacts=4 * s.impacts_per_particle),
        by_number={n: drop(f"N {n:g}", s.body(asperities=n)) for n in s.numbers},
        by_height={h: drop(f"mean height {h:g} m", s.body(mean_height=h)) for h in s.mean_heights},
        lattice=runner.count(
            main,
            s.body(),
            s.law,
            particles=ceil(impacts / s.impacts_per_particle),
            velocity_bins=mesh(*s.velocity_range, s.velocity_mesh),
            restitution_bins=mesh(*s.restitution_range, s.restitution_mesh),
        ),
    )
