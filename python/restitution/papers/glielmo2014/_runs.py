"""The simulations behind the paper's figures."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import ceil

import numpy as np
import xarray as xr

import restitution as rs
from restitution._internal.resources import bar as bar_of
from restitution.drop.energy import reported_elsewhere
from restitution.laws import TangentialRestitution
from restitution.papers.glielmo2014._counted import Counted, count_all
from restitution.papers.glielmo2014._settings import Settings

# Sensitivity runs keep what is drawn and why each trajectory ended, half the memory.
_KEPT = ("impact_velocity", "restitution", "rotational_fraction", "energy_ratio", "impacts", "stop_reason")


@dataclass(frozen=True)
class Runs:
    """All data: recorded as from `restitution.simulate`, or counted. A Dataset's attrs hold its own seed.

    Attributes
    ----------
    main
        L/R = 0.1, release angle uniform: fits and standard errors of Figs. 4 and 5.
    beads
        By L/R (0.01 and 0.02): standard errors of Fig. 6.
    first
        L = 2R, ε_n = 0.4, one impact: Fig. 9.
    isotropic
        As `main` with isotropic release orientation.
    energy
        By L/R: as `main` for other elongations.
    by_radius, by_height
        ``[radius][L/R]`` and ``[height][L/R]`` (m) for the L/R of Fig. 2 and the first of Fig. 6; only
        some of the variables.
    counted
        Figs. 2, 3, 4, 5, 6, 7: the ensembles that `main` and `beads` are the first particles of.
    seed
        The seed that those of all runs derive from.
    """

    main: xr.Dataset
    beads: Mapping[float, xr.Dataset]
    first: xr.Dataset
    isotropic: xr.Dataset
    energy: Mapping[float, xr.Dataset]
    by_radius: Mapping[float, Mapping[float, xr.Dataset]]
    by_height: Mapping[float, Mapping[float, xr.Dataset]]
    counted: Counted
    seed: int

    def seeds(self) -> dict[str, int]:
        """Seed of every recorded run by the run's name; what is counted has the seed of its recorded part."""
        return {str(data.attrs["run"]): int(data.attrs["seed"]) for data in self._all()}

    def _all(self) -> list[xr.Dataset]:
        varied = [
            data for by in (self.by_radius, self.by_height) for pair in by.values() for data in pair.values()
        ]
        return [self.main, *self.beads.values(), self.first, self.isotropic, *self.energy.values(), *varied]


def derived_seed(seed: int, name: str) -> int:
    """Seed in [0, 2⁶³) of the run called `name`, which no other run's name or presence changes.

    Raises
    ------
    ValueError
        If `seed` is not in [0, 2⁶⁴).
    """
    if not 0 <= seed < 2**64:
        raise ValueError(f"seed = {seed}: must be in [0, 2**64)")
    sequence = np.random.SeedSequence(seed, spawn_key=tuple(name.encode()))
    return int(sequence.generate_state(1, np.uint64)[0] >> np.uint64(1))


def check_impacts(settings: Settings, impacts: int) -> None:
    """Raise `ValueError` if these are fewer impacts than in the paper."""
    least = settings.least_impacts
    if impacts < least:
        raise ValueError(f"impacts = {impacts}: must be at least {least}, the number of impacts in Fig. 2")


@reported_elsewhere()  # by the claim on dissipation
def simulate_all(
    settings: Settings, impacts: int, seed: int, threads: int | None = None, progress: bool = True
) -> Runs:
    """Run every simulation that the figures and the claims need.

    Parameters
    ----------
    settings : Settings
        What to simulate.
    impacts : int
        Impacts to count for each of Figs. 2-5 and 7 and each curve of Fig. 6, at least
        ``settings.least_impacts`` (400 000, the paper's number). At most ``settings.recorded_impacts`` of
        them are recorded in the main run. A few more are made of both, because the end of a
        trajectory is not known beforehand. Secondary runs have their own fixed sizes (see `Settings`).
    seed : int
        Seed of everything; each run derives its own from it and its name.
    threads : int, optional
        As in `restitution.simulate`.
    progress : bool
        Whether to show a progress bar.

    Returns
    -------
    Runs

    Raises
    ------
    ValueError
        If `impacts` is below ``settings.least_impacts``.
    """
    check_impacts(settings, impacts)
    s = settings
    number = 6 + 2 * len(s.bead_elongations) + len(s.energy_elongations)
    number += 2 * (len(s.radii) + len(s.heights))
    with bar_of(show=progress, total=number, desc="simulations", unit="run", leave=False) as bar:

        def drop(
            name: str,
            elongation: float,
            *,
            each: int,
            particles: int = s.secondary_particles,
            law: TangentialRestitution = s.law,
            orientation: str = s.orientation,
            radius: float = s.radius,
            height: float = s.release_height,
        ) -> xr.Dataset:
            data = rs.simulate(
                s.body(elongation, radius),
                law,
                particles=particles,
                impacts=each,
                release_height=height,
                gravity=s.gravity,
                orientation=orientation,
                seed=derived_seed(seed, name),
                threads=threads,
            )
            bar.update()
            return data.assign_attrs(run=name)

        def pair(
            name: str, radius: float = s.radius, height: float = s.release_height
        ) -> dict[float, xr.Dataset]:
            each = s.sensitivity_impacts_per_particle
            # A deep copy, lest the part keep the whole alive.
            return {
                x: drop(f"{name}, L/R {x:g}", x, each=each, radius=radius, height=height)[list(_KEPT)].copy(
                    deep=True
                )
                for x in (s.elongation, s.bead_elongations[0])
            }

        each = s.impacts_per_particle
        first = drop("first", s.first_elongation, each=1, particles=s.first_particles, law=s.first_law)
        recorded = min(impacts, s.recorded_impacts)
        main = drop("main", s.elongation, each=each, particles=ceil(recorded / s.mean_impacts))
        beads = {
            x: drop(f"beads, L/R {x:g}", x, each=s.bead_impacts_per_particle) for x in s.bead_elongations
        }
        return Runs(
            main=main,
            beads=beads,
            first=first,
            isotropic=drop("isotropic", s.elongation, each=each, orientation="isotropic"),
            energy={x: drop(f"energy, L/R {x:g}", x, each=each) for x in s.energy_elongations},
            by_radius={r: pair(f"radius {r:g} m", radius=r) for r in s.radii},
            by_height={h: pair(f"height {h:g} m", height=h) for h in s.heights},
            counted=count_all(s, impacts, main, beads, threads, bar.update),
            seed=seed,
        )
