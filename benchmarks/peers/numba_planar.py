"""The planar motion as an expert would write it with Numba: scalar, with strict arithmetic (no fastmath).

From rest the motion stays in one vertical plane, so the state is (z, v_x, v_z, e_x, e_z, ω), and e turns at a
constant rate. There are two ways to find the next contact, neither of which can pass it; both take the state
and the sphere just hit (+1 at +L/2, -1, or 0 for none) and return the duration, v_z, e_x, e_z and the sphere
that touches.

No gap is bent more than M = g + (L/2)ω², so it stays positive for τ = (f' + √(f'² + 2Mf))/M. While the centre
of mass is above R + L/2, neither sphere can reach the plane.
"""

from math import cos, sin, sqrt

import numba

Flight = tuple[float, float, float, float, int]
compiled = numba.njit(error_model="numpy")
inlined = numba.njit(error_model="numpy", inline="always")


@inlined
def longest_steps(
    radius: float, arm: float, g: float, z0: float, v0: float, x0: float, y0: float, spin: float, hit: int
) -> Flight:
    """At each step the longer of two: the certified one, and the parabola's down to R + L/2."""
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


@inlined
def jump_then_steps(
    radius: float, arm: float, g: float, z0: float, v0: float, x0: float, y0: float, spin: float, hit: int
) -> Flight:
    """Certified steps alone, but for one jump over the time that the centre of mass spends out of reach."""
    touching = 1e-14 * radius
    bend = g + arm * spin * spin
    per_bend = 1.0 / bend
    above = v0 * v0 + 2.0 * g * (z0 - radius - arm)
    up = down = 0.0
    if above > 0.0:
        up, down = (v0 - sqrt(above)) / g, (v0 + sqrt(above)) / g
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
        if time + step == time:  # closer than the clock resolves
            return time, v, x, y, 1 if plus < minus else -1
        skip = 0
        time += step
        if up <= time < down:
            time = down
        z = z0 + (v0 - 0.5 * g * time) * time
        v = v0 - g * time
        c, s = cos(spin * time), sin(spin * time)
        x, y = x0 * c + y0 * s, y0 * c - x0 * s


@inlined
def impulse(
    radius: float,
    arm: float,
    inertia: float,
    normal: float,
    tangential: float,
    vx: float,
    vz: float,
    x: float,
    y: float,
    spin: float,
    hit: int,
) -> tuple[float, float, float]:
    """v_x, v_z and ω after the impact; `inertia` is J_xx over the mass."""
    rx, rz = hit * arm * x, hit * arm * y - radius  # (6)
    jx = (tangential - 1.0) * (vx + spin * rz)  # left side of (10)
    jz = -(1.0 + normal) * (vz - spin * rx)
    d = 1.0 / (inertia + rx * rx + rz * rz)
    px = ((inertia + rx * rx) * jx + rx * rz * jz) * d  # (14), for any ε^t
    pz = ((inertia + rz * rz) * jz + rx * rz * jx) * d
    return vx + px, vz + pz, spin + (rz * px - rx * pz) / inertia  # (11)
