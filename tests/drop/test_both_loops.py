"""Bodies of revolution in both loops: in lanes, which know their axis, and one at a time as any body."""

from typing import Any

import numpy as np
import pytest

import restitution as rs

R = 3e-3


def clump(body: Any, *balls: tuple[float, float]) -> rs.Clump:
    """Give balls, places on the axis and radii, mass and inertia of a body, so that only loops differ."""
    spheres = [(0.0, 0.0, place, radius) for place, radius in balls]
    return rs.Clump(
        spheres=spheres,
        density=body.mass / rs.Clump(spheres=spheres, density=1.0).mass,
        inertia=np.diag([body.transverse_inertia] * 2 + [body.axial_inertia]).tolist(),
        centre=(0.0, 0.0, getattr(body, "centre_of_mass", 0.0)),
    )


def pairs() -> list[tuple[Any, Any]]:
    """Bodies with an axis, and the same without."""
    equal = rs.Dumbbell(radius=R, separation=0.7 * R)
    unequal = rs.Dumbbell(radius=(R, 0.6 * R), separation=R, density=(2500.0, 4000.0))
    capsule = rs.Spherocylinder(radius=R, separation=R)
    loaded = rs.LoadedSphere(radius=R, density=2500.0, load=2e-4, offset=0.5 * R)
    return [
        (equal, clump(equal, (0.35 * R, R), (-0.35 * R, R))),
        (unequal, clump(unequal, (0.5 * R, R), (-0.5 * R, 0.6 * R))),
        (capsule, clump(capsule, (0.5 * R, R), (-0.5 * R, R))),
        (loaded, clump(loaded, (0.0, R))),
        (rs.Spheroid(equatorial=R, polar=0.4 * R), rs.Ellipsoid(semi_axes=(R, R, 0.4 * R))),
        (rs.Spheroid(equatorial=R, polar=2.5 * R), rs.Ellipsoid(semi_axes=(R, R, 2.5 * R))),
    ]


@pytest.mark.parametrize("pair", pairs(), ids=lambda pair: type(pair[0]).__name__)
@pytest.mark.parametrize(
    "law",
    [
        rs.Frictionless(normal=0.9),
        rs.TangentialRestitution(normal=0.9, tangential=-0.5),
        rs.Coulomb(normal=0.9, friction=0.05),
        rs.Coulomb(normal=0.9, friction=0.5, hypothesis="poisson"),
        rs.ChatterjeeRuina(normal=0.9, tangential=0.3, friction=0.2),
    ],
    ids=lambda law: type(law).__name__,
)
def test_both_loops_have_the_same_impacts(pair: tuple[Any, Any], law: Any) -> None:
    """The attitudes and spins drawn are the same, and so are the impacts, but for rounding as it grows."""
    settings: dict[str, Any] = {
        "particles": 30,
        "impacts": 3,
        "release_height": 0.05,
        "orientation": "isotropic",
        "spin": rs.RandomSpin(rate=(5.0, 80.0)),
        "release_velocity": (0.2, 0.1, 0.0),
        "incline": 0.1,
        "seed": 1,
    }
    lanes, single = (rs.simulate(body, law, **settings) for body in pair)
    for name in ("time", "impact_velocity", "restitution", "rotational_fraction", "energy_ratio"):
        np.testing.assert_allclose(single[name], lanes[name], rtol=1e-9, atol=1e-9, err_msg=name)
