"""The energy budget of impacts: what each kind of motion has before and after, and who pays for ε > 1."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from restitution import _core
from restitution._internal.arrays import FloatArray, reals
from restitution._internal.process import uninterrupted
from restitution.bodies import RigidBody
from restitution.drop.dataset import inertia_of, labelled
from restitution.drop.recorded import RECORDS, attribute, check_frame, variables
from restitution.drop.resting import in_body
from restitution.drop.run import Run

KINDS = ("vertical", "sideways", "rotational")
"""The kinds of motion: of the centre of mass along the plane normal and along the plane, and about it."""
_STATES = ("velocity_before", "velocity_after", "angular_velocity_before", "angular_velocity_after")
_BLOCK = 1_000_000
"""Impacts whose states are held at a time."""


def energy_budget(data: xr.Dataset) -> xr.Dataset:
    """Return the kinetic energies before and after each impact: vertical, sideways and of rotation.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts from `restitution.simulate` with ``record="state"``.

    Returns
    -------
    xarray.Dataset
        Over (particle, impact, energy) ``before`` and ``after`` in J, NaN where the impact never happened;
        ``energy`` names the kinds: ``vertical``, of the centre of mass along the plane normal, ``sideways``,
        along the plane, and ``rotational``, about the centre of mass. Their sum over ``energy`` is the
        kinetic energy.

    Raises
    ------
    ValueError
        If data lack a state, or mass and moments of inertia.

    Examples
    --------
    Who pays where a body leaves faster than it came? Here rotation does less than sideways motion:

    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    >>> data = rs.simulate(body, law, particles=100, impacts=60, record="state")
    >>> budget = rs.energy_budget(data)
    >>> change = (budget.after - budget.before).where(data.restitution > 1).sum(("particle", "impact"))
    >>> vertical, sideways, rotational = change.values
    >>> bool(vertical > 0 > rotational > sideways)
    True
    """
    vectors = dict.fromkeys(_STATES, (*RECORDS, "component"))
    own = {"attitude": (*RECORDS, "quaternion")} if "attitude" in getattr(data, "variables", ()) else {}
    own = own or {"axis": (*RECORDS, "component")}
    states = variables("data", data, 'restitution.simulate(..., record="state")', vectors | own)
    check_frame("data", data)
    mass = attribute("data", data, "mass", "a finite number > 0", lambda m: 0.0 < m < np.inf)
    about = {
        when: ((*RECORDS, "energy"), energies, f"kinetic energy {when} the impact", "J")
        for when, energies in zip(("before", "after"), _energies(mass, data.attrs, states), strict=True)
    }
    coordinates: dict[str, Any] = {name: data[name] for name in RECORDS if name in data.coords}
    return xr.Dataset(labelled(about), coordinates | {"energy": list(KINDS)}, data.attrs)


def _energies(
    mass: float, inertia: Mapping[str, Any], states: Sequence[FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Return the energies in J before and after, shape (..., 3), of states as in `energy_budget`."""
    before, after, spin_before, spin_after, pose = states
    if pose.shape[-1] == 4:
        principal, axes = (
            reals(f"data.{name}", inertia.get(name), f"{count} finite numbers", dimensions=(1,))
            for name, count in (("principal_moments", 3), ("principal_axes", 4))
        )

        def rotation(spin: FloatArray) -> FloatArray:
            own = in_body(axes, in_body(pose, spin))
            return np.asarray(np.sum(principal * own * own, axis=-1))
    else:
        across, along = inertia["transverse_inertia"], inertia["axial_inertia"]

        def rotation(spin: FloatArray) -> FloatArray:
            parallel = np.sum(spin * pose, axis=-1, keepdims=True) * pose
            square = (np.sum(part * part, axis=-1) for part in (parallel, spin - parallel))
            return np.asarray(along * next(square) + across * next(square))

    def one(velocity: FloatArray, spin: FloatArray) -> FloatArray:
        x, y, z = np.moveaxis(velocity * velocity, -1, 0)
        return np.asarray(0.5 * np.stack([mass * z, mass * (x + y), rotation(spin)], axis=-1))

    return one(before, spin_before), one(after, spin_after)


_MEANS = {
    "energy_before": ("mean kinetic energy before the impact", "J"),
    "energy_change": ("mean change of the kinetic energy by the impact", "J"),
    "energy_change_above_one": ("the same, of the impacts with restitution > 1", "J"),
    "paid_by_rotation": (
        "share of rotation in what rotation and sideways motion lost in the impacts with restitution > 1",
        "1",
    ),
}
"""The quantities, and their units."""


def budget_by_row(
    run: Run, velocity_edges: FloatArray | None, threads: int, batches: Sequence[tuple[int, int]]
) -> dict[str, Any]:
    """Return the budget of the impacts of a run in its rows, with standard errors over batches of particles.

    The run is followed once more, in blocks of particles, whose states are not kept. Rows are bins of impact
    velocity, or with None numbers of the impacts.
    """
    rows = run.impacts if velocity_edges is None else velocity_edges.size - 1
    row = "impact" if velocity_edges is None else "velocity"
    parts = [_sums(run, velocity_edges, rows, threads, first, end) for first, end in batches]
    size = len(parts)
    total = sum(parts[1:], parts[0])
    with np.errstate(divide="ignore", invalid="ignore"):
        found = _means(total)
        left_out = [_means(total - part) for part in parts] if size > 1 else []
    about: dict[str, Any] = {
        "energy": ("energy", list(KINDS), "kind of motion", None),
        "above_one": (row, total[:, 1, 3].astype(np.int64), "impacts with restitution > 1", None),
    }
    for name, values in found.items():
        dims, (text, unit) = (row, "energy")[: values.ndim], _MEANS[name]
        about[name] = (dims, values, text, unit)
        if left_out:
            # The jackknife, as in `batches`.
            error = np.sqrt((size - 1.0) * np.var([one[name] for one in left_out], axis=0))
            text = f"standard error of {name} over {size} batches of particles"
            about[f"{name}_error"] = (dims, error, text, unit)
    return labelled(about)


def _means(sums: FloatArray) -> dict[str, FloatArray]:
    """Return the means of sums as `_sums` gives them."""
    every, above, before = (sums[:, k, :3] / sums[:, k, 3:] for k in range(3))
    paid = above[:, 2] / (above[:, 1] + above[:, 2])
    return {
        "energy_before": before,
        "energy_change": every,
        "energy_change_above_one": above,
        "paid_by_rotation": paid,
    }


def _sums(
    run: Run, velocity_edges: FloatArray | None, rows: int, threads: int, first: int, end: int
) -> FloatArray:
    """Return sums over the impacts in each row, shape (rows, 3, 4): energies by kind, and their number.

    They are of the changes, of the changes where restitution > 1, and of the energies before.
    """
    body = run.body
    pose = "attitude" if isinstance(body, RigidBody) else "axis"
    columns = ["impact_velocity", "restitution", *_STATES, pose]
    inertia = inertia_of(body)
    block = max(1, _BLOCK // run.impacts)
    found = np.zeros((rows, 3, 4))
    for start in range(first, end, block):
        part = (start, min(start + block, end))
        table = uninterrupted(*_core.simulate(run.parameters(), threads, None, part=part, columns=columns))
        velocity, restitution, *states = (table[name][1] for name in columns)
        before, after = _energies(body.mass, inertia, states)
        if velocity_edges is None:
            place = np.broadcast_to(np.arange(velocity.shape[1]), velocity.shape)
        else:
            place = np.searchsorted(velocity_edges, velocity, side="right") - 1
        inside = np.isfinite(velocity) & (place >= 0) & (place < rows)
        above = inside & (restitution > 1.0)
        for k, (kept, energies) in enumerate(
            ((inside, after - before), (above, after - before), (inside, before))
        ):
            at = place[kept]
            for i, weights in enumerate((*np.moveaxis(energies[kept], -1, 0), None)):
                found[:, k, i] += np.bincount(at, weights=weights, minlength=rows)
    return found
