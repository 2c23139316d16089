"""Every impact of every particle, as an xarray Dataset."""

from __future__ import annotations

from typing import Literal, TypeAlias, Unpack, get_args

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution import _core
from restitution._internal.arrays import either, word
from restitution._internal.parameters import ParameterError, wrong
from restitution._internal.process import uninterrupted
from restitution._internal.resources import check_size, checked_threads, progress_bar
from restitution.bodies import AnyBody
from restitution.drop import clusters, energy
from restitution.drop.dataset import dataset
from restitution.drop.resting import settling_height
from restitution.drop.run import Run, RunArguments, takes_run
from restitution.drop.trajectory import with_positions
from restitution.laws import CollisionLaw

Record: TypeAlias = Literal["impacts", "state"]
Until: TypeAlias = Literal["settled"]
POSITION = 24
"""Bytes of a position."""


class SimulationInterrupted(KeyboardInterrupt):
    """Ctrl-C during `simulate`; `data` holds what was finished.

    Attributes
    ----------
    data : xarray.Dataset
        As `simulate` returns it, with the particles that were begun; those that were cut short have the stop
        reason ``interrupted``.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    >>> try:
    ...     data = rs.simulate(body, law, particles=10)
    ... except rs.SimulationInterrupted as stopped:
    ...     data = stopped.data  # what Ctrl-C left
    """

    def __init__(self, data: xr.Dataset) -> None:
        super().__init__("interrupted; the impacts so far are in the exception's `data`")
        self.data = data


@takes_run(RunArguments)
def simulate(
    body: AnyBody,
    law: CollisionLaw,
    *,
    record: Record = "impacts",
    until: Until | None = None,
    threads: int | None = None,
    progress: bool = False,
    **run: Unpack[RunArguments],
) -> xr.Dataset:
    """Drop particles and record every impact with the plane (the paper's Sec. III, steps 1-7).

    Parameters
    ----------
    body : Dumbbell or another body
        The body that is dropped.
    law : Law or CustomLaw
        The collision law.
    %(run)s
    record : {"impacts", "state"}
        With "state" also the full state at each impact, in 144 bytes more.
    until : {"settled"}, optional
        Ends a particle also when its energy is below every pass out of a potential well of its body, so that
        it comes to rest in the well where it is (stop reason ``settled``): `resting` says in which. For the
        bodies that `resting` takes, over a level plane, under a law that cannot create energy.
    threads : int, optional
        Number of threads; one for each core if not given.
    progress : bool
        Show a progress bar on standard error.

    Returns
    -------
    xarray.Dataset
        Dimensions (particle, impact). Variables over both: ``time``, ``impact_velocity``,
        ``rebound_velocity``, ``restitution``, ``rotational_fraction``, ``energy_ratio``, ``angle`` (float64,
        NaN where the impact never happened) and ``contact`` (which sphere touched, or which half of a
        spheroid); where ε_n depends on the speed also ``microscopic``, its value at the speed of the
        contact. Over particles: ``impacts``, ``stop_reason``, ``release_angle``; where heights are
        drawn also ``release_height``; with spin, release velocity or
        incline also ``release_azimuth`` and, over (particle, component), ``release_spin``.
        A rigid body of any shape has no ``angle``, ``release_angle`` and ``release_azimuth``; its ``contact``
        is the number of the sphere, vertex or arc that touched, from 1, and ``release_attitude``, over
        (particle, quaternion), says how it was released. With
        ``record="state"`` also, over (particle, impact, component), ``position`` and ``axis`` at the impact,
        or ``attitude``, the quaternion (w, x, y, z) that turns the axes of the body to those of space,
        which both stay through it, ``velocity_before``, ``velocity_after``, ``angular_velocity_before`` and
        ``angular_velocity_after``; `trajectory` makes of them the motion between impacts. Units are in the
        variables' attributes, all parameters in the Dataset's, as are ``energy_created_impacts``, the
        number of impacts that multiplied the kinetic energy by more than 1 + 1e-12, their share of all
        impacts, ``energy_created_share``, and if there are any ``largest_energy_ratio`` and
        ``pulling_impacts``, those in which the law let the plane pull.

    Raises
    ------
    ValueError
        If a parameter is out of range; the message names it, its value and what is allowed.
    NumericalError
        If the engine cannot follow a particle; the message says how to reproduce it.
    SimulationInterrupted
        On Ctrl-C; a `KeyboardInterrupt` that carries the impacts so far.

    Warns
    -----
    EnergyWarning, PullWarning
        Once each, if impacts created kinetic energy (docs/energy.md), or let the plane pull.

    Notes
    -----
    Two spheres that touch the plane at the same instant (axis exactly horizontal) are hit one after the
    other, as two impacts with no flight time between; so are four corners of a box that lands flat. A
    ClusterWarning says so of a run with given orientations, and `clusters` gives ε of such impacts together.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    >>> law = rs.TangentialRestitution(normal=0.98)
    >>> data = rs.simulate(body, law, particles=10, impacts=20)
    >>> dict(data.sizes)
    {'particle': 10, 'impact': 20}
    >>> bool((data.restitution.isel(impact=0) <= 0.98).all())
    True
    """
    checked = Run.called("simulate", body, law, run)
    data = simulate_run(checked, threads=threads, progress=progress, record=record, until=until)
    energy.warn(data)
    if checked.orientations is not None:  # no random attitude lands flat
        clusters.warn(data)
    return data


def simulate_run(
    run: Run,
    *,
    threads: int | None = None,
    progress: bool = False,
    record: Record = "impacts",
    until: Until | None = None,
) -> xr.Dataset:
    """`simulate` for parameters that are already checked."""
    number = checked_threads(threads)
    state = word("record", record, get_args(Record)) == "state"
    columns = _core.columns(run.body.compiled, run.law.compiled, state)
    if until is not None and not (isinstance(until, str) and until in get_args(Until)):
        raise ParameterError(wrong("until", until, f"{either(get_args(Until))}, or left out"))
    settled = settling_height(run) if until else 0.0
    room, rows = _core.bytes_per_impact(columns) + state * POSITION, run.particles * run.impacts
    check_size("particles * impacts", rows, rows, room, "impacts")
    with progress_bar("simulate", run.particles, "particles", show=progress) as tell:
        parameters = run.parameters() | {"settled": settled}
        table, interrupted = _core.simulate(parameters, number, tell, columns=columns)
    data = dataset(run, table)
    if until:
        data = data.assign_attrs(until=until, settling_height=settled)
    if state:
        data = with_positions(data)
    if interrupted:
        raise SimulationInterrupted(data) from interrupted
    return data


def times_of_impacts(run: Run) -> npt.NDArray[np.float64]:
    """Return the times alone, shape (particles, impacts), for thousands of small runs that fit in memory.

    NaN where an impact never happened. A Dataset of 200 particles takes ten times as long as their motion.
    """
    table = uninterrupted(*_core.simulate(run.parameters(), 0, None, columns=["time"]))
    return table["time"][1]
