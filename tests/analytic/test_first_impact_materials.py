"""Coefficients of materials in the first impact: those of the core, and where they bend."""

from typing import Any

import numpy as np
import pytest

import restitution as rs
from restitution.analytic import first_impact
from restitution.analytic._disc import Disc
from restitution.analytic._normal import Fall, coefficient, kinks

SPEEDS = np.array([0.05, 0.3, 0.4999, 0.5001, 0.8, 0.95, 2.0, 40.0])
MATERIALS: dict[str, Any] = {
    "viscoelastic": rs.Viscoelastic(
        young_modulus=6e9, poisson_ratio=0.22, dissipation=1e-5, density=2500.0, radius=3e-3
    ),
    "plastic": rs.Plastic(yield_speed=0.5),
    "tabulated": rs.Tabulated(v=[0.1, 0.5, 1.0], e=[0.97, 0.8, 0.6]),
}


@pytest.mark.parametrize("name", MATERIALS)
def test_coefficients_of_materials_are_the_core_s(name: str) -> None:
    """Between their kinks, each by its formula as a function of v²; a disc holds what is near."""
    normal = MATERIALS[name]
    assert kinks(normal) == {"viscoelastic": (), "plastic": (0.5,), "tabulated": (0.1, 0.5, 1.0)}[name]
    for speed in SPEEDS:
        expected = float(normal(speed))
        assert float(coefficient(normal, speed * speed, speed)) == pytest.approx(expected, rel=2e-15, abs=0)
        disc = coefficient(normal, Disc(np.array([speed * speed]), np.array([1e-6])), speed)
        if isinstance(disc, Disc):
            assert abs(disc.centre[0] - expected) <= disc.radius[0] < 1e-3
    assert kinks(0.9) == ()
    assert coefficient(0.9, 1.0, 1.0) == 0.9


@pytest.mark.parametrize("name", MATERIALS)
def test_the_curve_bends_where_the_material_does(name: str) -> None:
    """ε = e - (1 + e)a²/(J + a²) without friction, with e at v² = 2g(H - h) by the core, for a spheroid.

    Its height h and arm a as in `_hull`. The speed goes from 0.44 to 0.63 m/s, past 0.5.
    """
    across, along, top, gravity = 5e-3, 1.5e-2, 0.025, 9.81
    body = rs.Spheroid(equatorial=across, polar=along)
    law = rs.Frictionless(normal=MATERIALS[name])
    theta = np.linspace(0.0, np.pi / 2, 401)
    sine, cosine = np.sin(theta), np.cos(theta)
    height = np.hypot(across * sine, along * cosine)
    arm = (along**2 - across**2) * sine * cosine / height
    speed = np.sqrt(2.0 * gravity * (top - height))
    assert speed.min() < 0.45
    assert speed.max() > 0.6
    coefficients = np.asarray(MATERIALS[name](speed))
    inertia = body.transverse_inertia / body.mass
    expected = coefficients - (1.0 + coefficients) * arm**2 / (inertia + arm**2)
    distribution = first_impact(body, law, release_height=top, gravity=gravity)
    np.testing.assert_allclose(distribution.restitution(cosine), expected, rtol=0, atol=4e-15)


def test_a_fall_is_faster_the_further_it_goes() -> None:
    """v² = 2g(H - h), and back."""
    fall = Fall(release_height=0.3, gravity=9.81)
    assert fall.squared_speed(0.1) == pytest.approx(2 * 9.81 * 0.2, rel=1e-15)
    assert fall.height(1.5) == pytest.approx(0.3 - 1.5**2 / (2 * 9.81), rel=1e-15)
