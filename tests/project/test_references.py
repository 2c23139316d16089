"""The references are held to the physics before anything is compared with them."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from reference import friction, initial_value
from reference.arithmetic import Real, Vector, add, cross, dot, mp, scaled, vector
from reference.flight import Flight
from reference.multiprecision import Law, bounce, collide
from reference.top import Body, State

G = mp.mpf("9.81")
EXACT = mp.mpf(10) ** -45  # five digits of the fifty are left to rounding


def random_states(count: int) -> Iterator[tuple[Body, State]]:
    """Spinning, moving bodies of every elongation, high enough not to touch."""
    rng = np.random.default_rng(20141120)
    for _ in range(count):
        body = Body.dumbbell(0.01, 0.01 * rng.uniform(0.01, 3.0))
        yield body, State.released(rng.uniform(0, np.pi), 0.06, rng.normal(0, 1, 3), rng.normal(0, 60, 3))


def angular_momentum(body: Body, state: State) -> Vector:
    tensor, _ = body.inertia(state.axis)
    return vector(tensor * mp.matrix(state.spin))


def contact_velocity(body: Body, state: State, sign: int) -> tuple[Vector, Vector]:
    arm = add(scaled(sign * body.arm, state.axis), vector((0, 0, -body.radius)))
    return arm, add(state.velocity, cross(state.spin, arm))


def length(a: Vector) -> Real:
    return mp.sqrt(dot(a, a))


@pytest.mark.parametrize("elongation", ["0", "0.1", "1", "1.9", "2", "3"])
def test_quadrature_gives_the_closed_forms_of_the_inertia(elongation: str) -> None:
    """(A8), (A5) with L⁵/160, over (A3); two full spheres and Steiner's theorem from L = 2R on."""
    body = Body.dumbbell(1.0, float(elongation))
    x = mp.mpf(float(elongation))
    if x < 2:
        mass = mp.mpf(4) / 3 + x - x**3 / 12
        across = (mp.mpf(8) / 15 + x * 3 / 4 + x**2 / 3 + x**3 / 24 + x**5 / 960) / mass
        along = (mp.mpf(8) / 15 + x / 2 - x**3 / 12 + x**5 / 160) / mass
    else:
        along = mp.mpf(2) / 5
        across = along + (x / 2) ** 2
    assert abs(body.transverse - across) < EXACT
    assert abs(body.axial - along) < EXACT


def test_the_axis_follows_the_angular_velocity() -> None:
    """de/dt = ω × e, and Jω is conserved: the equations of motion, differentiated numerically."""
    for body, state in random_states(5):
        for time in (mp.mpf(0), mp.mpf("0.037")):
            there = state.after(time, body, G)
            turning = cross(there.spin, there.axis)
            step = mp.mpf(10) ** -12  # the central difference is off by about (Ω step)²Ω
            ahead, behind = (state.after(time + h, body, G).axis for h in (step, -step))
            rate = scaled(1 / (2 * step), add(ahead, behind, -1))
            assert length(add(rate, turning, -1)) < (length(state.spin) * step) ** 2 * length(state.spin)
            before, after = angular_momentum(body, state), angular_momentum(body, there)
            assert length(add(after, before, -1)) < EXACT * length(before)
            assert abs(there.rotational_energy(body) / state.rotational_energy(body) - 1) < EXACT


def test_the_impulse_does_the_work_that_the_energy_changes_by() -> None:
    """ΔE = P·(v_c + v_c')/2 for any law; Eq. 9 for the contact; the spin changes by r × P alone."""
    law = Law(mp.mpf("0.7"), mp.mpf("-0.3"))
    for body, state in random_states(10):
        for sign in (1, -1):
            after, impulse = collide(body, law, state, sign)
            arm, before = contact_velocity(body, state, sign)
            _, left = contact_velocity(body, after, sign)
            work = dot(impulse, add(before, left)) / 2
            energy = state.kinetic_energy(body)
            assert abs(after.kinetic_energy(body) - energy - work) < EXACT * energy
            wanted = (law.tangential * before[0], law.tangential * before[1], -law.normal * before[2])
            assert length(add(left, wanted, -1)) < EXACT * length(before)
            twist = add(angular_momentum(body, after), angular_momentum(body, state), -1)
            assert length(add(twist, cross(arm, impulse), -1)) < EXACT * length(twist)


def test_first_contact_is_the_first() -> None:
    """No sphere is below the plane at any of 2000 earlier times, one touches at the contact, and it falls."""
    for body, state in random_states(6):
        flight = Flight(body, state, G)
        time, sign = flight.first_contact()
        gap, rate = flight.gaps(time)[sign]
        assert abs(gap) < EXACT
        assert rate < 0
        times = np.linspace(0.0, float(time), 2000, endpoint=False)
        phase = float(flight.rate) * times
        lift = float(flight.mean) + float(flight.cosine) * np.cos(phase) + float(flight.sine) * np.sin(phase)
        height = float(flight.height(0)) + float(state.velocity[2]) * times - float(G) / 2 * times**2
        assert (height - float(body.arm) * np.abs(lift) > 0.0).all()


@pytest.mark.parametrize("elongation", [0.1, 1.0, 2.0])
@pytest.mark.parametrize("angle", [1e-9, 0.4, 1.5, 2.5, 3.0])
def test_first_impact_from_rest_is_equation_17(elongation: float, angle: float) -> None:
    """The lower sphere touches, so cos θ of Eq. 17 is |cos θ|; the fall lasts √(2 depth/g)."""
    body, law = Body.dumbbell(0.01, 0.01 * elongation), Law(mp.mpf(0.4), mp.mpf(1))
    impact = next(bounce(body, law, State.released(angle, 0.06), 9.81))
    r, separation, c = body.radius, 2 * body.arm, abs(mp.cos(mp.mpf(angle)))
    j = 4 * body.transverse + 4 * separation * r * c + 4 * r**2
    epsilon = -1 + (1 + law.normal) * (j + separation**2 * c**2) / (j + separation**2)  # (17)
    fall = mp.sqrt(2 * (mp.mpf(0.06) - r - body.arm * c) / mp.mpf(9.81))
    assert abs(impact.restitution - epsilon) < EXACT
    assert abs(impact.time - fall) < EXACT
    assert impact.contact == (2 if angle < np.pi / 2 else 1)


@pytest.mark.parametrize(
    ("elongation", "normal", "tangential", "velocity", "spin"),
    [
        (0.1, 0.98, 1.0, (0, 0, 0), (0, 0, 0)),
        (0.5, 0.9, 0.5, (0.1, 0.2, -0.3), (20, 10, -30)),
        (1.5, 0.6, -1.0, (0.1, 0.2, -0.3), (20, 10, -30)),
    ],
)
def test_the_two_references_agree(
    elongation: float,
    normal: float,
    tangential: float,
    velocity: tuple[float, float, float],
    spin: tuple[float, float, float],
) -> None:
    """Exact precession against Euler's equations, first root against event location, 3 x 3 against 9 x 9.

    The tolerance is a hundred times the integrator's for each of six impacts, which covers the measured
    growth of errors (below 10 an impact at these parameters while |ε| < 10).
    """
    impacts = 6
    body, law = Body.dumbbell(0.01, 0.01 * elongation), Law(mp.mpf(normal), mp.mpf(tangential))
    exact = bounce(body, law, State.released(0.7, 0.06, velocity, spin), 9.81)
    problem = initial_value.Problem(0.01, 0.01 * elongation, normal, tangential)
    start = initial_value.released(0.7, 0.06, np.array(velocity, float), np.array(spin, float))
    for one, other in zip(islice(exact, impacts), islice(problem.bounce(start), impacts), strict=True):
        assert one.contact == other.contact
        np.testing.assert_allclose(
            np.array(other[:7]), np.array([float(x) for x in one[:7]]), rtol=1e-10, atol=1e-12
        )


def test_friction_for_any_matrix_has_thirty_digits() -> None:
    """DOP853 beside Taylor series, `friction/reference.py` of the core; four are pressed twice."""
    path = Path(__file__).parents[2] / "crates/core/tests/friction/any.txt"
    for line in path.read_text(encoding="utf-8").splitlines():
        hypothesis, *numbers = line.split()
        xx, yy, nn, xy, nx, ny, x, y, n, mu, normal, *expected = map(float, numbers)
        matrix = np.array([(nn, nx, ny), (nx, xx, xy), (ny, xy, yy)])
        found = friction.follow(matrix, np.array([n, x, y]), normal, mu, hypothesis)
        size = float(np.linalg.norm(expected))
        np.testing.assert_allclose(found, np.roll(expected, 1), rtol=0, atol=3e-12 * size)
