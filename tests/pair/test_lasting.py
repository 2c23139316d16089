"""Lasting contacts of bodies that slide on each other without friction, against a closed form."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import quad

import restitution as rs

A, B = 2.0, 1.0
BODY = rs.Spheroid(equatorial=B, polar=A, density=1.0 / rs.Spheroid(equatorial=B, polar=A, density=1.0).mass)
J = (A**2 + B**2) / 5.0


def height(angle: float) -> tuple[float, float]:
    """Return h of the centre over the plane that touches, the axis at an angle to it, and dh/d(angle)."""
    h = np.sqrt(B**2 + (A**2 - B**2) * np.sin(angle) ** 2)
    return h, (A**2 - B**2) * np.sin(angle) * np.cos(angle) / h


def state(angle: float, speed: float, turning: float, before: float, *, mirrored: bool) -> Any:
    """Return the bodies a time before the axis is at this angle, over a plane or mirrored in it."""
    z, start = height(angle)[0] - speed * before, angle - turning * before
    # The axis, z of the body, is turned about -y from x; the mirror image turns the other way.
    rows = []
    for side in (1.0, -1.0)[: 1 + mirrored]:
        half = 0.5 * (0.5 * np.pi - side * start)
        rows.append(
            [
                [0, 0, side * z],
                [0, 0, side * speed],
                [0, -side * turning, 0],
                [np.cos(half), 0, np.sin(half), 0],
            ]
        )
    if not mirrored:
        rows.append([[0, 0, 0], [0, 0, 0], [0, 0, 0], [1, 0, 0, 0]])
    names = ("position", "velocity", "angular_velocity", "attitude")
    return xr.Dataset(
        {
            name: (
                ("encounter", "particle", "quaternion" if name == "attitude" else "component"),
                np.array([[row[k] for row in rows]], float),
            )
            for k, name in enumerate(names)
        }
    )


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize(
    ("angle", "speed", "turning"), [(0.3, -1.5, -1.0), (0.2, -2.5, -3.0), (-0.1, -0.3, -0.7)]
)
def test_a_spheroid_slides_over_its_flat_side(
    angle: float, speed: float, turning: float, mirrored: bool
) -> None:
    """On a plane or its mirror image, with z = h(angle): (J + m h'^2) w^2 stays until h'' = 0."""
    slope = height(angle)[1]
    pulse = -(speed - slope * turning) / (1.0 + slope**2 / J)
    energy = (J + slope**2) * (turning - slope * pulse / J) ** 2
    inflection = np.arcsin(np.sqrt(B / (A + B)))
    leaves = height(-inflection)[1]
    final = -np.sqrt(energy / (J + leaves**2))
    lasts = quad(lambda x: np.sqrt((J + height(x)[1] ** 2) / energy), -inflection, angle)[0]
    away = (A - height(inflection)[0]) / (leaves * final)
    other = BODY if mirrored else rs.Plane()
    given = state(angle, speed, turning, 0.01, mirrored=mirrored)
    found = rs.pair.encounters(BODY, other, rs.Frictionless(normal=0.0), states=given, record="contacts")
    assert found.ending.attrs["flag_meanings"].split()[int(found.ending[0])] == "lasted"
    assert float(found.velocity_after[0, 0, 2]) == pytest.approx(leaves * final, rel=1e-7)
    assert float(found.angular_velocity_after[0, 0, 1]) == pytest.approx(-final, rel=1e-7)
    assert float(found.duration[0]) == pytest.approx(0.01 + lasts + away, rel=1e-6)
    assert found.contacts[0] == 1 == np.isfinite(found.time[0]).sum()


def test_lasting_contacts_of_long_spheroids() -> None:
    """Momentum and angular momentum stay, energy never grows; with friction the same is a collapse."""
    body = rs.Spheroid(equatorial=1e-3, polar=3e-3)
    options: Any = {
        "encounters": 2000,
        "translational_temperature": 1e-8,
        "rotational_temperature": 1e-8,
        "seed": 1,
    }
    found = rs.pair.encounters(body, body, rs.Frictionless(normal=0.5), record="state", **options)
    meanings = found.ending.attrs["flag_meanings"].split()
    lasted = found.isel(encounter=np.flatnonzero(found.ending == meanings.index("lasted")))
    # 2.7 % of the encounters with contact collapse.
    number = lasted.sizes["encounter"]
    assert abs(number - 0.027 * (found.contacts > 0).sum()) < 4 * np.sqrt(number)
    assert not (found.ending == meanings.index("collapse")).any()
    assert (lasted.restitution_energy < 1.0).all()

    def momenta(when: str) -> tuple[Any, Any]:
        v, place = lasted[f"velocity_{when}"].to_numpy(), lasted[f"position_{when}"].to_numpy()
        spin, q = lasted[f"angular_velocity_{when}"].to_numpy(), lasted[f"attitude_{when}"].to_numpy()
        w, x, y, z = np.moveaxis(q, -1, 0)
        axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x**2 + y**2)], axis=-1)
        along = np.sum(axis * spin, axis=-1, keepdims=True)
        turning = (
            body.transverse_inertia * spin + (body.axial_inertia - body.transverse_inertia) * along * axis
        )
        return body.mass * v.sum(axis=1), (body.mass * np.cross(place, v) + turning).sum(axis=1)

    for before, after in zip(momenta("before"), momenta("after"), strict=True):
        np.testing.assert_allclose(after, before, atol=1e-9 * np.abs(before).max())
    law = rs.Coulomb(normal=0.5, friction=0.0)
    rough = rs.pair.encounters(body, body, law, **options)
    assert (rough.ending == meanings.index("collapse")).sum() == lasted.sizes["encounter"]
