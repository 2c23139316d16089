"""Impacts that are counted as they happen, any number of them, and not kept."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import ceil

import xarray as xr

import restitution as rs
from restitution.drop.energy import reported_elsewhere
from restitution.papers.glielmo2014 import _windows as windows
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.glielmo2014._windows import FloatArray, mesh


@dataclass(frozen=True)
class Counted:
    """Statistics of ensembles whose first particles are recorded, as from `restitution.statistics`.

    Attributes
    ----------
    lattice
        The main ensemble on the lattices of Figs. 2 and 3.
    slow
        The main ensemble on the lattice of Fig. 7.
    windows
        The main ensemble on the lattice from which Figs. 4 and 5 are put together.
    beads
        By L/R: in the velocity bins of Fig. 6.
    asked
        The number of impacts asked for in each ensemble.
    """

    lattice: xr.Dataset
    slow: xr.Dataset
    windows: xr.Dataset
    beads: Mapping[float, xr.Dataset]
    asked: int

    def ensembles(self) -> list[xr.Dataset]:
        """Statistics of each ensemble, once."""
        return [self.lattice, *self.beads.values()]


def impacts_counted(counted: xr.Dataset) -> int:
    """Give the number of impacts behind statistics, in the bins or not."""
    inside = counted["number"].sum() + counted["undefined"].sum()
    return int(inside + counted["velocity_underflow"] + counted["velocity_overflow"])


@reported_elsewhere()  # by the claim on dissipation
def count_all(
    settings: Settings,
    impacts: int,
    main: xr.Dataset,
    beads: Mapping[float, xr.Dataset],
    threads: int | None = None,
    done: Callable[[], object] = lambda: None,
) -> Counted:
    """Count the impacts of the ensembles that recorded runs begin.

    Parameters
    ----------
    settings : Settings
        What was simulated, and the bins.
    impacts : int
        Impacts to count in each ensemble. A few more are counted, because it is not known beforehand when a
        trajectory ends.
    main, beads
        The recorded runs, as in `Runs`. With their seeds, their particles are the first of those counted.
    threads : int, optional
        As in `restitution.statistics`.
    done : callable
        Called after each of the ``3 + len(beads)`` runs.
    """
    s = settings

    def count(
        recorded: xr.Dataset, elongation: float, mean: int, velocity: FloatArray, restitution: FloatArray
    ) -> xr.Dataset:
        found = rs.statistics(
            s.body(elongation),
            s.law,
            particles=max(ceil(impacts / mean), recorded.sizes["particle"]),
            impacts=recorded.attrs["impacts"],
            release_height=s.release_height,
            gravity=s.gravity,
            orientation=s.orientation,
            seed=recorded.attrs["seed"],
            threads=threads,
            batches=1,
            velocity_bins=velocity,
            restitution_bins=restitution,
            fraction_bins=mesh(*s.fraction_range, s.fraction_mesh),
        )
        done()
        return found.assign_attrs(run=f"{recorded.attrs['run']}, counted")

    def count_main(velocity: FloatArray, restitution: FloatArray) -> xr.Dataset:
        return count(main, s.elongation, s.mean_impacts, velocity, restitution)

    return Counted(
        lattice=count_main(
            mesh(*s.velocity_range, s.velocity_mesh), mesh(*s.restitution_range, s.restitution_mesh)
        ),
        slow=count_main(
            mesh(*s.low_velocity_range, s.velocity_mesh), mesh(*s.low_restitution_range, s.restitution_mesh)
        ),
        windows=count_main(*windows.lattice(s)),
        beads={
            x: count(
                data,
                x,
                s.bead_impacts_per_particle,
                mesh(*s.deviation_range, s.deviation_mesh),
                mesh(*s.restitution_range, s.restitution_mesh),
            )
            for x, data in beads.items()
        },
        asked=impacts,
    )
