"""The planar motion as an expert would write it with Numba: scalar, with strict arithmetic (no fastmath).

From rest the motion stays in one vertical plane, so the state is (z, v_x, v_z, e_x, e_z, ω), and e turns at a
constant rate. There are three ways to find the next contact, none of which can pass it; all take the state
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
def moved(
    g: float, z0: float, v0: float, x0: float, y0: float, spin: float, time: float
) -> tuple[float, float, float, float]:
    """z, v_z, e_x and e_z after a time."""
    c, s = cos(spin * time), sin(spin * time)
    return z0 + (v0 - 0.5 * g * time) * time, v0 - g * time, x0 * c + y0 * s, y0 * c - x0 * s


@inlined
def out_of_reach(radius: float, arm: float, g: float, z0: float, v0: float) -> tuple[float, float]:
    """From when to when the centre of mass is above R + L/2; (0, 0) if never."""
    above = v0 * v0 + 2.0 * g * (z0 - radius - arm)
    if above > 0.0:
        return (v0 - sqrt(above)) / g, (v0 + sqrt(above)) / g
    return 0.0, 0.0


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
        z, v, x, y = moved(g, z0, v0, x0, y0, spin, time)


@inlined
def jump_then_steps(
    radius: float, arm: float, g: float, z0: float, v0: float, x0: float, y0: float, spin: float, hit: int
) -> Flight:
    """Certified steps alone, but for one jump over the time that the centre of mass spends out of reach."""
    touching = 1e-14 * radius
    bend = g + arm * spin * spin
    per_bend = 1.0 / bend
    up, down = out_of_reach(radius, arm, g, z0, v0)
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
        z, v, x, y = moved(g, z0, v0, x0, y0, spin, time)


@inlined
def expand_the_last(
    radius: float, arm: float, g: float, z0: float, v0: float, x0: float, y0: float, spin: float, hit: int
) -> Flight:
    """The jump, a certified step, then two expansions, or further steps: as this package does it."""
    touching = 1e-14 * radius
    square = spin * spin
    sway = arm * square
    bend = g + sway
    per_bend = 1.0 / bend
    up, down = out_of_reach(radius, arm, g, z0, v0)
    rate, lift = -arm * spin * x0, arm * y0
    plus = z0 - radius + lift if hit <= 0 else 0.0  # the sphere just hit has gap 0 and rises
    minus = z0 - radius - lift if hit >= 0 else 0.0
    other = plus if hit < 0 else minus
    if hit != 0 and other <= touching and v0 - hit * rate < 0.0:
        return 0.0, v0, x0, y0, -hit
    time = per_bend * min(
        v0 + rate + sqrt((v0 + rate) ** 2 + 2.0 * bend * max(plus, 0.0)),
        v0 - rate + sqrt((v0 - rate) ** 2 + 2.0 * bend * max(minus, 0.0)),
    )
    while True:
        if up <= time < down:
            time = down
        z, v, x, y = moved(g, z0, v0, x0, y0, spin, time)
        # The lower bound of the lower sphere reaches zero first, unless the axis swings through the level.
        turning = -spin * x
        level = turning * ((z - radius) * turning - v * y) - 0.5 * bend * (y * y)
        side = arm if (turning if level >= 0.0 else y) < 0.0 else -arm
        gap, closing = max(z - radius + side * y, 0.0), v + side * turning
        root = sqrt(closing * closing + 2.0 * bend * gap)
        touched = 1 if side > 0.0 else -1
        if gap <= touching and closing < 0.0:
            return time, v, x, y, touched
        step = 2.0 * gap / (root - closing) if closing < 0.0 else per_bend * (closing + root)
        if closing < 0.0:
            second, third = -side * square * y, -side * square * turning
            slack = second + sway
            left = 0.5 * step * step * (slack + step * (third / 3.0 - step * square * second / 12.0))
            inverse = 1.0 / (root - step * (slack + 0.5 * third * step))
            newton = left * inverse
            ahead = step + newton * (1.0 + 0.5 * (second - g + step * third) * newton * inverse)
            a = spin * ahead
            b = a * a
            s = a + a * b * (-1 / 6 + b * (1 / 120 + b * (-1 / 5040 + b * (1 / 362880 - b / 39916800))))
            c = 1.0 + b * (
                -0.5 + b * (1 / 24 + b * (-1 / 720 + b * (1 / 40320 + b * (-1 / 3628800 + b / 479001600))))
            )
            x, y = x * c + y * s, y * c - x * s
            there = time + ahead
            v = v0 - g * there
            closing = v - side * spin * x
            inverse = -1.0 / closing
            newton = (z0 + (v0 - 0.5 * g * there) * there - radius + side * y) * inverse
            rest = newton * (1.0 + 0.5 * (-side * square * y - g) * newton * inverse)
            little = spin * rest
            c = 1.0 - 0.5 * little * little
            x, y = x * c + y * little, y * c - x * little
            late = ahead - step + rest
            first = 0.5 * bend * ahead + closing <= 0.0 and 0.5 * step <= ahead and abs(a) <= 0.5
            if first and abs(newton) <= step / 262144.0 and -2.0 * side * y >= 0.5 * sway * late * late:
                return there + rest, v0 - g * (there + rest), x, y, touched
        if time + step == time:  # closer than the clock resolves
            return time, v, x, y, touched
        time += step


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
    px = ((inertia + rx * rx) * jx + rx * rz * jz) * d  # (14), for any ε_t
    pz = ((inertia + rz * rz) * jz + rx * rz * jx) * d
    return vx + px, vz + pz, spin + (rz * px - rx * pz) / inertia  # (11)
