"""The bouncing dumbbell in three dimensions with fifty digits: slow, plain, and as literal as can be."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

from reference.arithmetic import Real, Vector, add, cross, dot, mp, scaled, vector
from reference.flight import Flight
from reference.top import Body, State


@dataclass(frozen=True)
class Law:
    """The coefficients ε_n and ε_t of Eq. 9."""

    normal: Real
    tangential: Real


def collide(body: Body, law: Law, state: State, sign: int) -> tuple[State, Vector]:
    """The state after an impact of sphere `sign`, and the impulse P/m: Eq. 10 as a linear system, Eq. 11."""
    n = vector((0, 0, 1))
    arm = add(scaled(sign * body.arm, state.axis), n, -body.radius)  # r_c (6)
    contact = add(state.velocity, cross(state.spin, arm))  # v_c (7)
    normal = scaled(dot(contact, n), n)  # (8)
    tangential = add(contact, normal, -1)
    change = add(scaled(-(law.normal + 1), normal), tangential, law.tangential - 1)  # left side of (10)
    _, inverse = body.inertia(state.axis)
    skew = mp.matrix([[0, -arm[2], arm[1]], [arm[2], 0, -arm[0]], [-arm[1], arm[0], 0]])  # [r]x = r × x
    mobility = mp.eye(3) + skew.T * inverse * skew  # right side of (10): (J⁻¹(r×P))×r = [r]ᵀJ⁻¹[r] P
    impulse = vector(mp.lu_solve(mobility, mp.matrix(change)))
    twist = vector(inverse * (skew * mp.matrix(impulse)))
    after = replace(state, velocity=add(state.velocity, impulse), spin=add(state.spin, twist))  # (11)
    return after, impulse


class Impact(NamedTuple):
    """One impact, under the names of the variables that `restitution.simulate` returns."""

    time: Real
    impact_velocity: Real
    rebound_velocity: Real
    restitution: Real
    rotational_fraction: Real
    energy_ratio: Real
    angle: Real
    contact: int


def bounce(
    body: Body,
    law: Law,
    state: State,
    gravity: float,
    disturb: Callable[[State, "Flight"], State] = lambda state, flight: state,
) -> Iterator[Impact]:
    """All impacts from `state` on, without end.

    `disturb` may change the state just before each impact, to measure how errors grow. The height is taken
    from the contact, z = R ∓ (L/2) e_z, so that the sphere touches the plane whatever was changed.
    """
    g = mp.mpf(gravity)
    while True:
        flight = Flight(body, state, g)
        time, sign = flight.first_contact()
        before = disturb(state.after(time, body, g), flight)
        before = replace(before, height=body.radius - sign * body.arm * before.axis[2])
        state, _ = collide(body, law, before, sign)
        fall, rebound, energy = -before.velocity[2], state.velocity[2], before.kinetic_energy(body)
        yield Impact(
            before.time,
            fall,
            rebound,
            rebound / fall,  # (1)
            before.rotational_energy(body) / energy,  # (12)
            state.kinetic_energy(body) / energy,
            mp.atan2(mp.hypot(before.axis[0], before.axis[1]), before.axis[2]),
            1 if sign > 0 else 2,
        )
