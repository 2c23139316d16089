"""`simulate`, impact by impact, beside the two references.

Errors grow with every impact, so no fixed tolerance can be right. The yardstick is measured: the fifty-digit
reference runs once as it is, and again with its state changed just before each impact by what one rounding to
double precision may do (`rounded`). The largest departure of those runs so far is what the model itself makes
of unavoidable rounding; the engine, which rounds some dozens of times an impact, must stay within `MARGIN` of
it. The comparison ends where chaos parts the trajectories (`PARTED`).
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import islice, product

import numpy as np
import pytest
from numpy.typing import NDArray

import restitution as rs
from reference import initial_value
from reference.arithmetic import Real, Vector, dot, mp, rotated, scaled
from reference.flight import Flight
from reference.multiprecision import Impact, Law, bounce
from reference.top import Body, State

Array = NDArray[np.float64]

GRAVITY = 9.81
ULP = 2.0**-52
MARGIN = 20.0  # the engine rounds some dozens of times an impact; measured: at most 5
# A recorded value adds its own rounding. v_G' = v_G + P/m cancels, at ε_n = 0.4 to 1/3.5 of P/m, and a
# ratio of energies doubles that; measured: at most 7 units.
RECORDED = 16 * ULP
PARTED = 1e-6  # of the largest value of a variable in the trajectory
NOISY_RUNS = 2
IMPACT, REBOUND, RESTITUTION = (
    Impact._fields.index(name) for name in ("impact_velocity", "rebound_velocity", "restitution")
)
# Eq. 1 diverges where v_G^n passes 0, which would spoil the yardstick: the two velocities are compared,
# and ε is held to their quotient.
COMPARED = [column for column in range(len(Impact._fields)) if column != RESTITUTION]

ELONGATIONS = (1e-3, 0.01, 0.1, 0.5, 1.0, 2.0, 3.0)
NORMAL = (0.4, 0.9, 0.98, 1.0)
TANGENTIAL = (-1.0, 0.0, 0.5, 1.0)
RIGHT = np.pi / 2
AWKWARD = (1e-9, 1e-3, 0.7, RIGHT - 1e-3, RIGHT - 1e-9, RIGHT + 1e-9, RIGHT + 1e-3, np.pi - 1e-9)
# Every elongation meets every ε_n and every ε_n every ε_t; the angles, two a case, take turns.
CASES = [
    (elongation, normal, TANGENTIAL[(i + j) % 4], [AWKWARD[(2 * i + 3 * j + k) % 8] for k in (0, 5)])
    for (i, elongation), (j, normal) in product(enumerate(ELONGATIONS), enumerate(NORMAL))
]


def rounded(rng: np.random.Generator) -> Callable[[State, Flight], State]:
    """Work out what one rounding in each quantity does to the state just before an impact.

    Velocities, spin and axis change by half a unit in the last place of each component, up or down, and so do
    the angle turned in the flight and its duration. The moment of contact moves because the gap is a
    difference of heights up to that of the highest point of the flight.
    """

    def unit() -> Real:
        return mp.mpf(rng.choice((-0.5, 0.5))) * ULP

    def off(a: Vector) -> Vector:
        return (a[0] * (1 + unit()), a[1] * (1 + unit()), a[2] * (1 + unit()))

    def disturb(state: State, flight: Flight) -> State:
        body, start, g = flight.body, flight.start, flight.gravity
        duration = state.time - start.time
        highest = start.height + max(start.velocity[2], 0) ** 2 / (2 * g)
        _, rate = min(flight.gaps(duration).values(), key=lambda gap_and_rate: abs(gap_and_rate[0]))
        state = state.after(duration * unit() + highest / rate * unit(), body, g)
        axis = off(rotated(state.axis, state.precession(body), duration * unit()))
        axis = scaled(1 / mp.sqrt(dot(axis, axis)), axis)
        return replace(state, velocity=off(state.velocity), axis=axis, spin=off(state.spin))

    return disturb


def followed(body: Body, law: Law, start: State, impacts: int, seed: int | None = None) -> Array:
    """The reference's impacts as (impact, variable) in the order of `Impact`; rounded if there is a seed."""
    disturb = {} if seed is None else {"disturb": rounded(np.random.default_rng(seed))}
    path = islice(bounce(body, law, start, GRAVITY, **disturb), impacts)
    return np.array([[float(value) for value in impact] for impact in path])


def simulated(
    elongation: float,
    normal: float,
    tangential: float,
    angles: Sequence[float],
    impacts: int,
    radius: float,
    height: float,
) -> Array:
    """The engine's impacts as (particle, impact, variable)."""
    data = rs.simulate(
        rs.Dumbbell(radius=radius, separation=elongation * radius),
        rs.TangentialRestitution(normal=normal, tangential=tangential),
        particles=len(angles),
        impacts=impacts,
        release_height=height,
        gravity=GRAVITY,
        orientation=np.array(angles),
    )
    return np.stack([data[name].values.astype(float) for name in Impact._fields], axis=-1)


def assert_follows(
    elongation: float,
    normal: float,
    tangential: float,
    angles: Sequence[float],
    *,
    radius: float = 0.01,
    height: float = 0.06,
    impacts: int = 12,
    at_least: int = 10,
) -> None:
    """Compare with the fifty-digit reference until chaos parts them, for `at_least` so many impacts."""
    body, law = Body.dumbbell(radius, elongation * radius), Law(mp.mpf(normal), mp.mpf(tangential))
    every = simulated(elongation, normal, tangential, angles, impacts, radius, height)
    for angle, mine in zip(angles, every, strict=True):
        start = State.released(angle, height)
        exact = followed(body, law, start, impacts)
        noisy = np.stack([followed(body, law, start, impacts, seed) for seed in range(NOISY_RUNS)])
        growth = np.maximum.accumulate(np.abs(noisy - exact).max(axis=0), axis=0)

        together = (MARGIN * growth <= PARTED * np.abs(exact).max(axis=0))[:, COMPARED].all(axis=1)
        compared = impacts if together.all() else int(together.argmin())
        assert compared >= at_least, f"angle {angle}: chaos parts the trajectories after {compared} impacts"
        mine, exact, growth = mine[:compared], exact[:compared], growth[:compared]
        np.testing.assert_allclose(mine[:, RESTITUTION], mine[:, REBOUND] / mine[:, IMPACT], rtol=2 * ULP)
        error, allowed = np.abs(mine - exact), MARGIN * growth + RECORDED * np.abs(exact)
        wrong = [(k, v) for k, v in np.argwhere(~(error <= allowed)) if v in COMPARED]
        assert not wrong, f"angle {angle}\n" + "\n".join(
            f"impact {k}, {Impact._fields[v]}: {mine[k, v]!r}, not {exact[k, v]!r} ± {allowed[k, v]:.1e}"
            for k, v in wrong
        )


@pytest.mark.parametrize(("elongation", "normal", "tangential", "angles"), CASES)
def test_awkward_angles_for_every_shape_and_law(
    elongation: float, normal: float, tangential: float, angles: list[float]
) -> None:
    """Nearly vertical: hardly any lever arm. Nearly horizontal: both spheres touch almost at once."""
    assert_follows(elongation, normal, tangential, angles)


def test_a_long_fall() -> None:
    """From 100 m a body of 3 mm arrives with 44 m/s: heights are 30 000 times its size, errors grow fast."""
    assert_follows(0.1, 0.98, 1.0, [1e-3, 0.7, RIGHT - 1e-3], radius=3e-3, height=100.0, at_least=3)


@pytest.mark.parametrize("angle", [1e-3, 0.7, RIGHT - 1e-9])
def test_a_hardly_visible_fall(angle: float) -> None:
    """A micrometre under the lower sphere: short flights, and many impacts in a row on one side."""
    elongation, radius = 0.5, 0.01
    height = radius * (1.0 + elongation / 2.0 * np.cos(angle)) + 1e-6
    assert_follows(elongation, 0.9, 1.0, [angle], radius=radius, height=height)


@pytest.mark.parametrize(
    ("elongation", "normal", "tangential", "angle"),
    [(0.1, 0.98, 1.0, 1.0), (0.5, 0.9, 0.5, 0.4), (1.0, 0.9, 0.0, 2.0), (1.5, 0.6, -1.0, 0.7)],
)
def test_newton_euler_equations(elongation: float, normal: float, tangential: float, angle: float) -> None:
    """A general integrator, event location and nine equations an impact give the same six impacts.

    The integrator is right to 1e-12 a step, and takes up to a hundred steps a flight: 1e-10. How that grows
    is seen from a second run, released at an angle that is 1e-10 off.
    """
    impacts, radius, height, accuracy = 6, 0.01, 0.06, 1e-10
    problem = initial_value.Problem(radius, elongation * radius, normal, tangential, gravity=GRAVITY)

    def solved(release: float) -> Array:
        return np.array(list(islice(problem.bounce(initial_value.released(release, height)), impacts)))

    right = solved(angle)
    growth = np.maximum.accumulate(np.abs(solved(angle + accuracy) - right), axis=0)
    mine = simulated(elongation, normal, tangential, [angle], impacts, radius, height)[0]
    assert (growth < 1e-5).all(), "chaos parts the trajectories too early to compare"
    assert (np.abs(mine - right) <= growth + accuracy * np.abs(right)).all()
