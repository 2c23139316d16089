"""The laws of granular kinetic theory for spheres, by their own formulas.

Walton's parameters e, μ, β₀ (O. R. Walton, R. L. Braun, J. Rheol. 30, 949 (1986)) are `ChatterjeeRuina`;
constant roughness β (J. T. Jenkins, M. W. Richman, Phys. Fluids 28, 3485 (1985); C. K. K. Lun, J. Fluid Mech.
233, 539 (1991)) is `TangentialRestitution` with ε_t = -β.
"""

from typing import Any

import numpy as np
import pytest

import restitution as rs

R = 3e-3
SPHERES = {
    "full": rs.Dumbbell(radius=R, separation=0.0),
    "shell": rs.Dumbbell(radius=R, separation=0.0, wall=2e-4),
}
RUN: dict[str, Any] = {
    "particles": 300,
    "impacts": 3,
    "spin": rs.RandomSpin(rate=(0.0, 600.0)),
    "release_velocity": (0.6, 0.2, 0.0),
    "record": "state",
}


def velocities(data: Any) -> tuple[Any, ...]:
    """Normal and tangential velocities of the contact before and after."""
    arm = np.array([0.0, 0.0, -R])
    contact = [
        data[f"velocity_{when}"].values + np.cross(data[f"angular_velocity_{when}"].values, arm)
        for when in ("before", "after")
    ]
    return contact[0][..., 2], contact[0][..., :2], contact[1][..., 2], contact[1][..., :2]


@pytest.mark.parametrize("sphere", SPHERES)
@pytest.mark.parametrize(("e", "friction", "beta"), [(0.9, 0.1, 0.4), (0.7, 0.05, -0.2), (0.8, 0.05, 1.0)])
def test_walton(sphere: str, e: float, friction: float, beta: float) -> None:
    """Sliding and sticking impacts both occur; 1e-13 m/s is rounding of velocities of 1 m/s."""
    body = SPHERES[sphere]
    data = rs.simulate(body, rs.ChatterjeeRuina(normal=e, tangential=beta, friction=friction), **RUN)
    normal, slip, rebound, left = velocities(data)
    size = np.linalg.norm(slip, axis=-1)
    cone = 1.0 + body.mass * R**2 / body.transverse_inertia
    sliding = -1.0 + friction * (1.0 + e) * cone * np.abs(normal) / size
    assert 0.02 < np.mean(sliding < beta) < 0.98
    np.testing.assert_allclose(left, -np.minimum(beta, sliding)[..., None] * slip, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(rebound, -e * normal, rtol=0.0, atol=1e-13)


@pytest.mark.parametrize("sphere", SPHERES)
@pytest.mark.parametrize("roughness", [-1.0, -0.3, 0.0, 0.5, 1.0])
def test_constant_roughness(sphere: str, roughness: float) -> None:
    law = rs.TangentialRestitution(normal=0.9, tangential=-roughness)
    normal, slip, rebound, left = velocities(rs.simulate(SPHERES[sphere], law, **RUN))
    np.testing.assert_allclose(left, -roughness * slip, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(rebound, -0.9 * normal, rtol=0.0, atol=1e-13)
