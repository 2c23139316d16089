"""The yardstick: the planar loop in Numba, one thread; impacts are counted on the lattice, none is kept."""

from collections.abc import Callable
from functools import partial
from math import cos, sin
from typing import Any

import numpy as np

from benchmarks.peers.numba_planar import (
    Flight,
    compiled,
    expand_the_last,
    impulse,
    inlined,
    jump_then_steps,
    longest_steps,
)
from benchmarks.work import Array, Counts, Grid, Peer, Work


@inlined
def place(value: float, low: float, per_mesh: float, bins: int) -> int:
    """Index of the bin, from 1; 0 below the bins, `bins` + 1 from their end on."""
    position = (value - low) * per_mesh
    if position >= bins:
        return bins + 1
    return int(position) + 1 if position >= 0.0 else 0


def loop(flight: Callable[..., Flight]) -> Any:
    """The loop with one way to find the next contact."""

    @compiled
    def count(
        radius: float,
        arm: float,
        inertia: float,
        normal: float,
        tangential: float,
        g: float,
        height: float,
        angles: Array,
        impacts: int,
        per_velocity: float,
        low: float,
        per_restitution: float,
        counts: Counts,
    ) -> None:
        """Add to `counts`, which has one row and column more on either side than the lattice."""
        rows, columns = counts.shape[0] - 2, counts.shape[1] - 2
        for p in range(angles.size):
            x, y = sin(angles[p]), cos(angles[p])
            z, vx, vz, spin, hit = height, 0.0, 0.0, 0.0, 0
            for _ in range(impacts):
                _, vz, x, y, hit = flight(radius, arm, g, z, vz, x, y, spin, hit)
                fall = -vz
                vx, vz, spin = impulse(radius, arm, inertia, normal, tangential, vx, vz, x, y, spin, hit)
                z = radius - hit * arm * y
                row = place(fall, 0.0, per_velocity, rows)
                counts[row, place(vz / fall, low, per_restitution, columns)] += 1  # (1)

    return count


def run(work: Work, angles: Array, count: Any) -> Grid:
    lattice = work.lattice
    counts = np.zeros((lattice.velocity_bins + 2, lattice.restitution_bins + 2), np.int64)
    count(
        work.radius,
        work.separation / 2,
        work.inertia,
        work.normal,
        work.tangential,
        work.gravity,
        work.release_height,
        angles,
        work.impacts,
        1.0 / lattice.velocity_mesh,
        lattice.restitution_low,
        1.0 / lattice.restitution_mesh,
        counts,
    )
    return Grid(counts[1:-1, 1:-1], int(counts.sum()))


def rows() -> list[Peer[Grid]]:
    """The yardstick first."""
    return [
        Peer("Numba grid, our search", partial(run, count=loop(expand_the_last))),
        Peer("Numba grid, longest steps", partial(run, count=loop(longest_steps))),
        Peer("Numba grid, jump and steps", partial(run, count=loop(jump_then_steps))),
    ]
