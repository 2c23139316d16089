"""Motion in space as an expert would write it with Numba: scalar, with strict arithmetic (no fastmath).

The state is (z, v, e, Λ/J_xx) with vectors as three numbers. The axis turns about the angular momentum at
the rate Ω = |Λ|/J_xx, so that e_z = c + a cos Ωt + b sin Ωt: the search for the next contact needs one sine
and one cosine a step. Certified steps, and one jump over the time out of reach.
"""

from math import cos, hypot, sin, sqrt

from benchmarks.peers.numba_planar import compiled, inlined

Three = tuple[float, float, float]


@inlined
def dot(a: Three, b: Three) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inlined
def cross(a: Three, b: Three) -> Three:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inlined
def along(a: Three, factor: float, b: Three) -> Three:
    """a + factor b."""
    return a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]


@inlined
def swing(e: Three, turn: Three) -> tuple[float, float, float, float]:
    """Ω, c, a and b of e_z = c + a cos Ωt + b sin Ωt."""
    rate = sqrt(dot(turn, turn))
    if rate == 0.0:
        return 0.0, e[2], 0.0, 0.0
    inverse = 1.0 / rate
    constant = dot(turn, e) * turn[2] * inverse * inverse
    return rate, constant, e[2] - constant, cross(turn, e)[2] * inverse


@inlined
def turned(e: Three, turn: Three, rate: float, time: float) -> Three:
    """The axis after a time, by Rodrigues' formula."""
    if rate == 0.0:
        return e
    about = along((0.0, 0.0, 0.0), 1.0 / rate, turn)
    c, s = cos(rate * time), sin(rate * time)
    first = along((c * e[0], c * e[1], c * e[2]), s, cross(about, e))
    return along(first, (1.0 - c) * dot(about, e), about)


@compiled
def dumbbell_contact(
    radius: float, arm: float, g: float, z0: float, v0: float, e: Three, turn: Three, hit: int
) -> tuple[float, int]:
    """Duration, and the sphere that touches (+1 or -1); `hit` is the sphere just hit, or 0."""
    touching = 1e-14 * radius
    rate, constant, a, b = swing(e, turn)
    amplitude = hypot(a, b)
    bend = g + arm * amplitude * rate * rate
    per_bend = 1.0 / bend
    up, down = out_of_reach(g, z0 - radius - arm * min(abs(constant) + amplitude, 1.0), v0)
    time, skip = 0.0, hit
    while True:
        c, s = cos(rate * time), sin(rate * time)
        lift, turning = arm * (constant + a * c + b * s), arm * rate * (b * c - a * s)
        z, v = z0 - radius + (v0 - 0.5 * g * time) * time, v0 - g * time
        plus = z + lift if skip <= 0 else 0.0  # the sphere just hit has gap 0 and rises
        minus = z - lift if skip >= 0 else 0.0
        plus_rate, minus_rate = v + turning, v - turning
        if plus <= touching and plus_rate < 0.0 and skip <= 0:
            return time, 1
        if minus <= touching and minus_rate < 0.0 and skip >= 0:
            return time, -1
        step = per_bend * min(
            plus_rate + sqrt(plus_rate * plus_rate + 2.0 * bend * max(plus, 0.0)),
            minus_rate + sqrt(minus_rate * minus_rate + 2.0 * bend * max(minus, 0.0)),
        )
        if time + step == time:  # closer than the clock resolves
            return time, 1 if plus < minus else -1
        skip = 0
        time += step
        if up <= time < down:
            time = down


@compiled
def spheroid_contact(
    equatorial: float, polar: float, g: float, z0: float, v0: float, e: Three, turn: Three, hit: int
) -> float:
    """Duration; h² = a² + (c² - a²)e_z² is the height of the centre over the lowest point."""
    square, excess = equatorial * equatorial, polar * polar - equatorial * equatorial
    touching = 1e-14 * max(equatorial, polar)
    rate, constant, a, b = swing(e, turn)
    amplitude = hypot(a, b)
    reach = min(abs(constant) + amplitude, 1.0)
    widest = sqrt(square + excess * reach * reach)
    bend = g + abs(excess) * amplitude * reach * rate * rate / min(widest, equatorial)
    per_bend = 1.0 / bend
    up, down = out_of_reach(g, z0 - max(widest, equatorial), v0)
    time, skip = 0.0, hit
    while True:
        c, s = cos(rate * time), sin(rate * time)
        tilt, turning = constant + a * c + b * s, rate * (b * c - a * s)
        height = sqrt(square + excess * tilt * tilt)
        gap = 0.0 if skip else z0 + (v0 - 0.5 * g * time) * time - height
        closing = v0 - g * time - excess * tilt * turning / height
        if gap <= touching and closing < 0.0 and not skip:
            return time
        step = per_bend * (closing + sqrt(closing * closing + 2.0 * bend * max(gap, 0.0)))
        if time + step == time:  # closer than the clock resolves
            return time
        skip = 0
        time += step
        if up <= time < down:
            time = down


@inlined
def out_of_reach(g: float, above: float, v0: float) -> tuple[float, float]:
    """From when to when the centre of mass is higher than anything can reach; (0, 0) if never."""
    square = v0 * v0 + 2.0 * g * above
    if square > 0.0:
        return (v0 - sqrt(square)) / g, (v0 + sqrt(square)) / g
    return 0.0, 0.0


@inlined
def contact(
    e: Three, v: Three, turn: Three, place: float, radius: float, across: float, axial: float
) -> tuple[Three, Three, Three, tuple[float, float, float, float]]:
    """A ball around a point of the axis touches: u, r_c, v_c along (n, u, w), and K_nn, K_uu, K_ww, K_nu."""
    sine = hypot(e[0], e[1])
    u = (e[0] / sine, e[1] / sine, 0.0) if sine > 0.0 else (1.0, 0.0, 0.0)
    r = (place * e[0], place * e[1], place * e[2] - radius)  # (6)
    spin = along(turn, (across / axial - 1.0) * dot(turn, e), e)
    slip = along(v, 1.0, cross(spin, r))  # (7)
    rn, ru = r[2], place * sine
    twist, roll = radius * e[2] - place, radius * sine
    k = (
        1.0 + ru * ru / across,
        1.0 + rn * rn / across,
        1.0 + twist * twist / across + roll * roll / axial,
        -rn * ru / across,
    )
    return u, r, (slip[2], dot(slip, u), slip[1] * u[0] - slip[0] * u[1]), k


@inlined
def struck(
    v: Three, turn: Three, u: Three, r: Three, across: float, normal: float, along_u: float, along_w: float
) -> tuple[Three, Three]:
    """v and Λ/J_xx after an impulse with these components along n, u and w (11)."""
    p = (along_u * u[0] - along_w * u[1], along_u * u[1] + along_w * u[0], normal)
    return along(v, 1.0, p), along(turn, 1.0 / across, cross(r, p))
