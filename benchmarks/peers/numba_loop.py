"""An event-driven loop as an expert would write it with Numba: planar, scalar, and the same eight columns.

From rest the motion stays in one vertical plane, so the state is (z, v_x, v_z, e_x, e_z, ω). The next contact
is found with steps that cannot pass the first root: no gap is bent more than M = g + (L/2)ω², so it stays
positive for τ = (f' + √(f'² + 2Mf))/M; while the centre of mass is above R + L/2 the parabola alone may give
a longer step. Arithmetic is strict (no fastmath).
"""

from functools import partial
from math import atan2, cos, sin, sqrt

import numba
import numpy as np

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


def _flight(
    radius: float, arm: float, g: float, z0: float, v0: float, x0: float, y0: float, spin: float, hit: int
) -> tuple[float, float, float, float, int]:
    """Duration, v_z, e_x, e_z at the next contact, and the sphere that touches (+1 at +L/2, or -1)."""
    touching = 1e-14 * radius
    reach = radius + arm
    bend = g + arm * spin * spin
    per_bend, per_g = 1.0 / bend, 1.0 / g
    time, z, v, x, y = 0.0, z0, v0, x0, y0
    skip = hit  # the sphere just hit has gap 0 and rises
    while True:
        rate, lift = -arm * spin * x, arm * y
        plus_rate, minus_rate = v + rate, v - rate
        plus = z - radius + lift if skip <= 0 else 0.0
        minus = z - radius - lift if skip >= 0 else 0.0
        if plus <= touching and plus_rate < 0.0 and skip <= 0:
            return time, v, x, y, 1
        if minus <= touching and minus_rate < 0.0 and skip >= 0:
            return time, v, x, y, -1
        step = per_bend * min(
            plus_rate + sqrt(plus_rate * plus_rate + 2.0 * bend * max(plus, 0.0)),
            minus_rate + sqrt(minus_rate * minus_rate + 2.0 * bend * max(minus, 0.0)),
        )
        if z > reach:
            step = max(step, per_g * (v + sqrt(v * v + 2.0 * g * (z - reach))))
        if time + step == time:  # closer than the clock resolves
            return time, v, x, y, 1 if plus < minus else -1
        skip = 0
        time += step
        z = z0 + (v0 - 0.5 * g * time) * time
        v = v0 - g * time
        c, s = cos(spin * time), sin(spin * time)
        x, y = x0 * c + y0 * s, y0 * c - x0 * s


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
            duration, vz, x, y, hit = flight(radius, arm, g, z, vz, x, y, spin, hit)
            clock += duration
            rx, rz = hit * arm * x, hit * arm * y - radius  # (6)
            jx = (tangential - 1.0) * (vx + spin * rz)  # left side of (10)
            jz = -(1.0 + normal) * (vz - spin * rx)
            d = 1.0 / (inertia + rx * rx + rz * rz)
            px = ((inertia + rx * rx) * jx + rx * rz * jz) * d  # (14), for any ε^t
            pz = ((inertia + rz * rz) * jz + rx * rz * jx) * d
            rotation = inertia * spin * spin
            energy = rotation + vx * vx + vz * vz
            fall = -vz
            vx, vz, spin = vx + px, vz + pz, spin + (rz * px - rx * pz) / inertia  # (11)
            z = radius - hit * arm * y
            columns[0, p, k] = clock
            columns[1, p, k] = fall
            columns[2, p, k] = vz
            columns[3, p, k] = vz / fall  # (1)
            columns[4, p, k] = rotation / energy  # (12)
            columns[5, p, k] = (inertia * spin * spin + vx * vx + vz * vz) / energy
            columns[6, p, k] = atan2(abs(x), y)
            contact[p, k] = 1 if hit > 0 else 2


flight = numba.njit(error_model="numpy", inline="always")(_flight)
serial = numba.njit(error_model="numpy")(_loop)
parallel = numba.njit(error_model="numpy", parallel=True)(_loop)


def run(work: Work, angles: Array, threads: int) -> Records:
    columns = np.empty((len(FLOATS), angles.size, work.impacts))
    contact = np.empty((angles.size, work.impacts), np.int8)
    q = work.separation / work.radius
    mass = 4 / 3 + q - q**3 / 12  # (A3) over πρR³
    inertia = (8 / 15 + 3 / 4 * q + q**2 / 3 + q**3 / 24 + q**5 / 960) / mass * work.radius**2  # (A8)
    if threads > 1:
        numba.set_num_threads(threads)
    (serial if threads == 1 else parallel)(
        work.radius,
        work.separation / 2,
        inertia,
        work.normal,
        work.tangential,
        work.gravity,
        work.release_height,
        angles,
        columns,
        contact,
    )
    return {**dict(zip(FLOATS, columns, strict=True)), "contact": contact}


def rows() -> list[Peer]:
    threads = [1, 2] if numba.get_num_threads() > 1 else [1]
    return [Peer(f"Numba loop, {n} thread{'s' * (n > 1)}", partial(run, threads=n)) for n in threads]
