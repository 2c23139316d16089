"""Statistics of a run of any size, in memory that the bins alone decide."""

from typing import Any, Literal

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution import _core
from restitution._bins import FRACTION_BINS, assemble, by_velocity, checked_edges
from restitution._dataset import STOP_REASONS, attributes
from restitution._energy import by_row, ledger, warn
from restitution._release import RandomSpin
from restitution._resources import available_memory, checked_threads, progress_bar
from restitution._run import Run
from restitution._simulate import SimulationInterrupted
from restitution.bodies import Body
from restitution.laws import Law

_MOMENTS = ("mean", "variance", "skewness", "kurtosis", "minimum", "maximum", "mean_fraction")


def statistics(
    body: Body,
    law: Law,
    *,
    particles: int = 1000,
    impacts: int = 400,
    release_height: float = 0.06,
    gravity: float = 9.81,
    orientation: Literal["uniform-angle", "isotropic"] | npt.ArrayLike = "uniform-angle",
    spin: npt.ArrayLike | RandomSpin | None = None,
    velocity: npt.ArrayLike | None = None,
    incline: float = 0.0,
    minimum_speed: float = 0.0,
    seed: int = 1,
    threads: int | None = None,
    velocity_bins: npt.ArrayLike | None,
    restitution_bins: npt.ArrayLike,
    fraction_bins: npt.ArrayLike = FRACTION_BINS,
    counts_only: bool = False,
    progress: bool = False,
) -> xr.Dataset:
    """Drop an ensemble and keep only the statistics of its impacts.

    The impacts are those that `restitution.simulate` would return for the same arguments, to the bit. They
    are counted as they happen: memory does not grow with the number of particles. Counts and sums are whole
    numbers, so that the result depends neither on the threads nor on their timing.

    Parameters
    ----------
    body, law, particles, impacts, release_height, gravity, orientation, spin, velocity, incline
        As in `restitution.simulate`.
    minimum_speed, seed, threads
        Likewise.
    velocity_bins : array_like, shape (nv + 1,), or None
        Edges of the impact velocity bins in m/s; finite, strictly increasing, uniform. With None the rows are
        the numbers of the impacts instead, dimension ``impact``.
    restitution_bins : array_like, shape (nr + 1,)
        Edges of the restitution bins, likewise.
    fraction_bins : array_like, shape (nf + 1,)
        Edges of the bins of E_rot/E_tot (Eq. 12), likewise; 50 bins on [0, 1) unless told.
    counts_only : bool
        Leave out the moments, the extremes and E_rot/E_tot: what remains are the counts of restitution, which
        is what p(ε | v) is made of, and the energy. It takes a quarter less time.
    progress : bool
        Show a progress bar on standard error.

    Returns
    -------
    xarray.Dataset
        As from `restitution.reduce`, and ``particles_ended`` (stop_reason), the number of particles by stop
        reason. Over all impacts, in the bins or not, the attributes ``energy_created_impacts``,
        ``energy_created_share`` and ``largest_energy_ratio``, as from `simulate`. The moments rest on exact
        sums of ε - ε^n rounded to 2⁻²⁴ ≈ 6e-8.

    Raises
    ------
    ValueError
        Naming the argument that is wrong.
    SimulationInterrupted
        On Ctrl-C; its ``data`` holds the statistics of the impacts so far.

    Warns
    -----
    EnergyWarning
        Once, if impacts created kinetic energy; see docs/energy.md.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    >>> law = rs.TangentialRestitution(normal=0.98)
    >>> found = rs.statistics(body, law, particles=50, velocity_bins=np.linspace(0.0, 1.2, 13),
    ...                       restitution_bins=np.linspace(-1.0, 3.0, 401))
    >>> found["count"].dims
    ('velocity', 'restitution')
    """
    run = Run(
        body=body,
        law=law,
        particles=particles,
        impacts=impacts,
        release_height=release_height,
        gravity=gravity,
        orientation=orientation,
        spin=spin,
        velocity=velocity,
        incline=incline,
        minimum_speed=minimum_speed,
        seed=seed,
    )
    if not isinstance(counts_only, bool | np.bool_):
        raise ValueError(f"counts_only = {counts_only!r}: must be True or False")
    columns = {"restitution": checked_edges(restitution_bins, "restitution_bins")}
    if not counts_only:
        columns["fraction"] = checked_edges(fraction_bins, "fraction_bins")
    velocity = None if velocity_bins is None else checked_edges(velocity_bins, "velocity_bins")
    number = checked_threads(threads)
    height = run.impacts if velocity is None else velocity.size + 1
    _check_memory(height, sum(edges.size + 2 for edges in columns.values()), number)
    with progress_bar("statistics", run.particles, "particles", show=progress) as tell:
        table, interrupted = _core.statistics(
            run.parameters(), velocity, columns["restitution"], columns.get("fraction"), number, tell
        )
    counts = {"count": table["count"]}
    if not counts_only:
        counts["fraction_count"] = table["fraction_count"]
    moments = {name: table[name] for name in (() if counts_only else _MOMENTS)}
    more: dict[str, Any] = {
        "stop_reason": ("stop_reason", list(STOP_REASONS)),
        "particles_ended": (
            "stop_reason",
            table["stops"],
            {"long_name": "particles by the reason why they ended"},
        ),
    }
    created, largest = table["energy_created"], table["largest_energy_ratio"]
    if velocity is None:
        rows = xr.Variable("impact", np.arange(run.impacts), {"long_name": "number of the impact, from 0"})
        more |= by_row("impact", created, largest)
        found = assemble(counts, moments, rows, columns, more)
    else:  # the outer rows are beyond the bins
        more |= by_row("velocity", created[1:-1], largest[1:-1])
        found = by_velocity(counts, moments, velocity, columns, more)
    found.attrs = attributes(run, "Statistics of the impacts of bouncing aspherical particles")
    found.attrs |= ledger(
        int(table["count"].sum()),
        int(table["energy_created"].sum()),
        float(table["largest_energy_ratio"].max()),
    )
    if interrupted:
        raise SimulationInterrupted(found.assign_attrs(incomplete="interrupted by the user"))
    warn(found)
    return found


def _check_memory(rows: int, columns: int, threads: int) -> None:
    """Refuse grids that the machine cannot hold: 12 bytes a site and 400 a row a thread, and the total."""
    copies = (threads or _core.build_info()["threads"]) + 1
    needed = copies * rows * (12 * columns + 400)
    if needed > available_memory():
        raise ValueError(
            f"velocity_bins, restitution_bins, fraction_bins: {rows:,} rows of {columns:,} sites in "
            f"{copies} copies take {needed / 1e9:.3g} GB: must be at most {available_memory() / 1e9:.3g} GB, "
            "what this machine has"
        )
