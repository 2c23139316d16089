"""Spinning and moving dumbbells beside a general integrator: quaternions, Euler's equations, events.

Nothing in `reference.initial_value` knows that the flight has a closed form. It is right to 1e-12 a
step, and its errors hardly add up. How they grow from impact to impact is seen from
a second run whose release is off by as much.
"""

from itertools import islice

import numpy as np
import pytest
from numpy.typing import NDArray

import restitution as rs
from reference import initial_value
from restitution.laws import Law

Array = NDArray[np.float64]

RADIUS, HEIGHT, GRAVITY, IMPACTS = 0.01, 0.06, 9.81, 4
ACCURACY = 1e-12
CASES = {
    # elongation, (ε_n, ε_t or None: frictionless), θ, φ, ω, v, α
    "twisted": (1.0, (0.9, 0.3), 0.8, 0.0, (0.0, 0.0, 30.0), (0.0, 0.0, 0.0), 0.0),
    "tumbling": (1.5, (0.8, 1.0), 1.3, 2.0, (20.0, -35.0, 0.0), (0.0, 0.0, 0.0), 0.0),
    "thrown": (0.5, (0.9, -0.5), 2.2, 4.0, (10.0, 25.0, -15.0), (0.4, -0.3, 0.5), 0.0),
    "thrown down": (1.8, (0.7, 0.0), 0.4, 1.0, (-40.0, 5.0, 10.0), (-0.2, 0.1, -0.6), 0.0),
    "inclined": (1.0, (0.8, 0.4), 1.0, 5.5, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.4),
    "everything": (1.2, (0.9, 0.5), 2.0, 3.0, (15.0, 20.0, 25.0), (0.3, 0.2, 0.4), 0.7),
    "smooth": (1.6, (0.9, None), 0.9, 1.5, (30.0, -10.0, 40.0), (0.1, 0.2, 0.0), 0.3),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_newton_euler_equations(
    case: tuple[float, tuple[float, float | None], float, float, Array, Array, float],
) -> None:
    """Four impacts, every recorded number."""
    elongation, (normal, tangential), angle, azimuth, spin, velocity, incline = case
    separation = elongation * RADIUS
    problem = initial_value.Problem(RADIUS, separation, normal, tangential, gravity=GRAVITY, incline=incline)

    def solved(off: float) -> Array:
        start = initial_value.released(
            angle + off, HEIGHT, np.array(velocity), np.array(spin) * (1.0 + off), azimuth
        )
        return np.array(list(islice(problem.bounce(start), IMPACTS)))

    law: Law = (
        rs.Frictionless(normal=normal)
        if tangential is None
        else rs.TangentialRestitution(normal=normal, tangential=tangential)
    )
    found = rs.simulate(
        rs.Dumbbell(radius=RADIUS, separation=separation),
        law,
        particles=1,
        impacts=IMPACTS,
        release_height=HEIGHT,
        gravity=GRAVITY,
        orientation=[[angle, azimuth]],
        spin=spin,
        release_velocity=velocity,
        incline=incline,
    ).isel(particle=0)
    mine = np.stack([found[name].values for name in initial_value.Impact._fields], axis=1)
    right = solved(0.0)
    growth = np.maximum.accumulate(np.abs(solved(ACCURACY) - right), axis=0)
    assert (growth < 1e-6).all(), "chaos parts the trajectories too early to compare"
    assert (np.abs(mine - right) <= 3.0 * growth + ACCURACY * np.abs(right)).all()


def test_a_thermal_spin_has_the_energy_of_its_temperature() -> None:
    """kT/2 for each of the three parts of the rotation, within four standard errors of 4000 particles."""
    kt = 1e-6
    for body in (rs.Dumbbell(radius=3e-3, separation=2e-3), rs.Ellipsoid(semi_axes=(1e-3, 2e-3, 3e-3))):
        spin = rs.RandomSpin.thermal(body, temperature=kt)
        law = rs.Frictionless(normal=0.9)
        data = rs.simulate(
            body, law, particles=4000, impacts=1, orientation="isotropic", spin=spin, record="state"
        )
        energy = rs.energy_budget(data).before.sel(energy="rotational").values[:, 0]
        assert abs(energy.mean() / (1.5 * kt) - 1.0) < 4.0 * np.sqrt(2.0 / 3.0 / 4000)
    with pytest.raises(ValueError, match="temperature = -1"):
        rs.RandomSpin.thermal(rs.Dumbbell(radius=3e-3, separation=2e-3), temperature=-1.0)
