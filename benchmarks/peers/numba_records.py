"""The planar loop in Numba with every impact kept: the same eight columns as `simulate`."""

from functools import partial
from math import atan2, cos, sin

import numba
import numpy as np

from benchmarks.peers.numba_planar import compiled, impulse, longest_steps
from benchmarks.work import Array, Peer, Records, Work

FLOATS = (
    "time",
    "impact_velocity",
    "rebound_velocity",
    "restitution",
    "rotational_fraction",
    "energy_ratio",
    "angle",
)


def _loop(
    radius: float,
    arm: float,
    inertia: float,
    normal: float,
    tangential: float,
    g: float,
    height: float,
    angles: Array,
    columns: Array,
    contact: np.ndarray[tuple[int, int], np.dtype[np.int8]],
) -> None:
    """Fill `columns` (7, particle, impact) and `contact`."""
    for p in numba.prange(angles.size):
        x, y = sin(angles[p]), cos(angles[p])
        z, vx, vz, spin, clock, hit = height, 0.0, 0.0, 0.0, 0.0, 0
        for k in range(contact.shape[1]):
            duration, vz, x, y, hit = longest_steps(radius, arm, g, z, vz, x, y, spin, hit)
            clock += duration
            rotation = inertia * spin * spin
            energy = rotation + vx * vx + vz * vz
            fall = -vz
            vx, vz, spin = impulse(radius, arm, inertia, normal, tangential, vx, vz, x, y, spin, hit)
            z = radius - hit * arm * y
            columns[0, p, k] = clock
            columns[1, p, k] = fall
            columns[2, p, k] = vz
            columns[3, p, k] = vz / fall  # (1)
            columns[4, p, k] = rotation / energy  # (12)
            columns[5, p, k] = (inertia * spin * spin + vx * vx + vz * vz) / energy
            columns[6, p, k] = atan2(abs(x), y)
            contact[p, k] = 1 if hit > 0 else 2


serial = compiled(_loop)
parallel = numba.njit(error_model="numpy", parallel=True)(_loop)


def run(work: Work, angles: Array, threads: int) -> Records:
    columns = np.empty((len(FLOATS), angles.size, work.impacts))
    contact = np.empty((angles.size, work.impacts), np.int8)
    if threads > 1:
        numba.set_num_threads(threads)
    (serial if threads == 1 else parallel)(
        work.radius,
        work.separation / 2,
        work.inertia,
        work.normal,
        work.tangential,
        work.gravity,
        work.release_height,
        angles,
        columns,
        contact,
    )
    return {**dict(zip(FLOATS, columns, strict=True)), "contact": contact}


def rows() -> list[Peer[Records]]:
    threads = [1, 2] if numba.get_num_threads() > 1 else [1]
    return [Peer(f"Numba records, {n} thread{'s' * (n > 1)}", partial(run, threads=n)) for n in threads]
