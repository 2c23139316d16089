"""Statistics of a run of any size, in memory that depends on the bins alone."""

from __future__ import annotations

from typing import Any, TypeAlias, Unpack

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution import _core
from restitution._core import STOP_REASONS
from restitution._internal.arrays import flag, whole
from restitution._internal.parameters import Problem, TooLargeError
from restitution._internal.resources import available_memory, checked_threads, progress_bar
from restitution.bodies import AnyBody
from restitution.drop.batches import BATCHES, batches_of, origin, standard_errors
from restitution.drop.bins import FRACTION_BINS, all_edges_from, assemble, by_velocity, increasing_edges
from restitution.drop.budget import budget_by_row
from restitution.drop.dataset import attributes
from restitution.drop.energy import by_row, ledger, warn
from restitution.drop.run import Run, RunArguments, takes_run
from restitution.drop.simulate import SimulationInterrupted
from restitution.laws import CollisionLaw

Edges: TypeAlias = dict[str, npt.NDArray[np.float64] | None]
"""Edges of the bins of ``velocity`` or None, of ``restitution``, and of ``fraction`` or None."""
Table: TypeAlias = dict[str, npt.NDArray[Any]]
"""Counts and measured values, by the names of the core."""

_SAME = ("variance", "skewness", "kurtosis", "minimum", "maximum", "mean_fraction")
MOMENTS = {"mean_restitution": "mean", **{name: name for name in _SAME}}
"""Names of the moments in the result and in the core; `mean` is taken, as a method of Dataset."""


@takes_run(RunArguments)
def statistics(
    body: AnyBody,
    law: CollisionLaw,
    *,
    threads: int | None = None,
    velocity_bins: npt.ArrayLike | None,
    velocity_range: tuple[float, float] | None = None,
    restitution_bins: npt.ArrayLike,
    restitution_range: tuple[float, float] | None = None,
    fraction_bins: npt.ArrayLike = FRACTION_BINS,
    fraction_range: tuple[float, float] | None = None,
    counts_only: bool = False,
    batches: int = BATCHES,
    energy_budget: bool = False,
    progress: bool = False,
    **run: Unpack[RunArguments],
) -> xr.Dataset:
    """Drop an ensemble and keep only the statistics of its impacts.

    The impacts are those that `restitution.simulate` would return for the same arguments, to the bit. They
    are counted as they happen: memory does not grow with the number of particles. Counts and sums are whole
    numbers, so that the result depends neither on the threads nor on their timing.

    Parameters
    ----------
    body, law, threads
        As in `restitution.simulate`.
    %(run)s
    velocity_bins : int, array_like of shape (nv + 1,), or None
        Edges of the impact velocity bins in m/s, finite and strictly increasing, of any widths; or their
        number, with ``velocity_range`` (low, high), as `numpy.histogram` takes them. With None the rows are
        the numbers of the impacts instead, dimension ``impact``.
    restitution_bins : int or array_like, shape (nr + 1,)
        Edges of the restitution bins, or their number with ``restitution_range``, as above.
    fraction_bins : int or array_like, shape (nf + 1,)
        Edges of the bins of E_rot/E_tot (Eq. 12), or their number with ``fraction_range``; 50 bins
        on [0, 1) by default.
    counts_only : bool
        Leave out the moments, the extremes and E_rot/E_tot: what remains are the counts of restitution, which
        is what p(ε | v) is made of, and the energy. It takes a quarter less time.
    batches : int
        Batches of particles whose scatter gives the standard errors of the moments; 1 leaves the errors out
        and saves some milliseconds a batch. With fewer than two particles a batch there are no errors. The
        attribute ``standard_errors`` says how they were found, or why there are none.
    energy_budget : bool
        Also the mean energies, vertical, sideways and of rotation, and their changes by the impacts, for
        which the run is followed a second time.
    progress : bool
        Show a progress bar on standard error.

    Returns
    -------
    xarray.Dataset
        As from `restitution.reduce`; the standard errors of the moments in each row, which are called
        ``mean_restitution_error`` and so on; and ``particles_ended`` (stop_reason), the number of particles
        by stop reason. Over all impacts, in the bins or not, the attributes ``energy_created_impacts``,
        ``energy_created_share`` and ``largest_energy_ratio``, as from `simulate`. The moments rest on exact
        sums of ε - ε_n rounded to 2⁻²⁴ ≈ 6e-8, or to 2⁻²⁰ ≈ 1e-6 where it exceeds 2.

        With ``energy_budget`` in each row and by kind, dimension ``energy`` as in `energy_budget`, means in
        J: ``energy_before`` and ``energy_change`` of all impacts, ``energy_change_above_one`` of the
        ``above_one`` impacts with ε > 1; and of these ``paid_by_rotation``, the share of rotation in what
        rotation and sideways motion lost together. Their standard errors end in ``_error``.

    Raises
    ------
    ValueError
        Naming the argument that is wrong.
    SimulationInterrupted
        On Ctrl-C; its ``data`` holds the statistics of the impacts so far.

    Warns
    -----
    EnergyWarning, PullWarning
        Once each, if impacts created kinetic energy (docs/energy.md), or let the plane pull.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    >>> law = rs.TangentialRestitution(normal=0.98)
    >>> found = rs.statistics(body, law, particles=50, velocity_bins=np.linspace(0.0, 1.2, 13),
    ...                       restitution_bins=np.linspace(-1.0, 3.0, 401))
    >>> found["restitution_count"].dims
    ('velocity', 'restitution')
    """
    ensemble = Run.called("statistics", body, law, run)
    counts_only, batches = flag("counts_only", counts_only), whole("batches", batches, 1)
    budget = flag("energy_budget", energy_budget)
    velocity, restitution, fraction = all_edges_from(
        velocity_bins=(velocity_bins, velocity_range),
        restitution_bins=(restitution_bins, restitution_range),
        fraction_bins=(fraction_bins, fraction_range),
    )
    edges = edges_of(velocity, restitution, None if counts_only else fraction)
    number = checked_threads(threads)
    parts = batches_of(ensemble.particles, 1 if counts_only else batches)
    _check_memory(ensemble, edges, number, len(parts))
    with progress_bar("statistics", ensemble.particles, "particles", show=progress) as tell:
        table, each, interrupted = _core.statistics(ensemble.parameters(), edges, number, tell, parts)
    found = dataset_of(ensemble, edges, table)
    rows: list[dict[str, Any]] = []
    if len(each) > 1:  # one batch has no scatter
        inner = slice(None) if edges["velocity"] is None else slice(1, -1)
        names = MOMENTS | {"number": "number"}
        rows = [{name: one[key][inner] for name, key in names.items()} for one in each]
        row = "impact" if edges["velocity"] is None else "velocity"
        found = found.assign(standard_errors(rows, row))
    why = "none: counts_only leaves the moments out" if counts_only else None
    found.attrs["standard_errors"] = why or origin(len(rows), ensemble.particles, batches)
    if budget and not interrupted:
        try:
            found = found.assign(budget_by_row(ensemble, edges["velocity"], number, parts))
        except KeyboardInterrupt as stopped:
            interrupted = stopped
    if interrupted:
        raise SimulationInterrupted(found.assign_attrs(incomplete="interrupted by the user")) from interrupted
    warn(found)
    return found


def edges_of(
    velocity_bins: npt.ArrayLike | None, restitution_bins: npt.ArrayLike, fraction_bins: npt.ArrayLike | None
) -> Edges:
    """Check the bins and name them as the core does."""
    return {
        "velocity": None if velocity_bins is None else increasing_edges(velocity_bins, "velocity_bins"),
        "restitution": increasing_edges(restitution_bins, "restitution_bins"),
        "fraction": None if fraction_bins is None else increasing_edges(fraction_bins, "fraction_bins"),
    }


def dataset_of(run: Run, edges: Edges, table: Table) -> xr.Dataset:
    """Lay out what was counted as `statistics` returns it. The counts are never summed: that takes long."""
    columns = {name: own for name, own in edges.items() if name != "velocity" and own is not None}
    counts = {"restitution_count": table["count"]}
    number = table["number"]
    moments = {}
    if "fraction" in columns:
        counts["fraction_count"] = table["fraction_count"]
        moments = {name: table[key] for name, key in MOMENTS.items()}
    more: dict[str, Any] = {
        "stop_reason": ("stop_reason", list(STOP_REASONS)),
        "particles_ended": (
            "stop_reason",
            table["stops"],
            {"long_name": "particles by the reason why they ended"},
        ),
    }
    created, largest = table["energy_created"], table["largest_energy_ratio"]
    velocity = edges["velocity"]
    if velocity is None:
        rows = xr.Variable("impact", np.arange(run.impacts), {"long_name": "number of the impact, from 0"})
        more |= by_row("impact", created, largest)
        found = assemble(counts, number, moments, rows, columns, more)
    else:  # the outer rows are beyond the bins
        more |= by_row("velocity", created[1:-1], largest[1:-1])
        found = by_velocity(counts, number, moments, velocity, columns, more)
    found.attrs = attributes(run, "Statistics of the impacts of bouncing aspherical particles")
    all_impacts = int(number.sum() + table["count"][:, -1].sum())
    found.attrs |= ledger(all_impacts, int(created.sum()), float(largest.max()), int(table["pulls"]))
    return found


def _check_memory(run: Run, edges: Edges, threads: int, batches: int) -> None:
    """Refuse grids that this process cannot hold.

    A site takes 8 bytes, and 4 more a thread; a row 400, as many a thread, and 200 a batch.
    """
    velocity = edges["velocity"]
    rows = run.impacts if velocity is None else velocity.size + 1
    columns = sum(own.size + 2 for name, own in edges.items() if name != "velocity" and own is not None)
    copies = threads or _core.build_info()["threads"]
    needed = rows * ((8 + 4 * copies) * columns + 400 * (1 + copies) + 200 * batches)
    available = available_memory()
    if needed > available:
        text = (
            f": {rows:,} rows of {columns:,} sites, counted by {copies} threads, take {needed / 1e9:.3g} GB: "
            f"must be at most {available / 1e9:.3g} GB, what this process can have"
        )
        raise TooLargeError(Problem("velocity_bins, restitution_bins, fraction_bins", text))
