"""Solids of revolution: mass by quadrature, contacts beside dense sampling, first impacts in closed form."""

from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.integrate import quad

import restitution as rs
from restitution.bodies import RigidBody

Array = npt.NDArray[np.float64]

VASE = np.array([(0, 2), (1, 3.5), (2.5, 1), (4, 1), (5, 2.5), (5.5, 0)]) * 1e-3
EGG: dict[str, float] = {"length": 5.7e-3, "width": 4.4e-3, "blunt_end": 2.0e-3, "tip": 1.4e-3}
BODIES: dict[str, RigidBody] = {
    "coin": rs.Cylinder(radius=4e-3, height=6e-4),
    "rod": rs.Cylinder(radius=1e-3, height=8e-3),
    "ring": rs.Ring(outer=4e-3, inner=2.5e-3, height=1.5e-3),
    "cone": rs.Revolution(profile=[(0, 4e-3), (9e-3, 0)]),
    "vase": rs.Revolution(profile=VASE),
    "bead": rs.TruncatedCone(base=4e-3, top=2.5e-3, height=3e-3),
    "egg": rs.Egg(**EGG),
}


def outline(name: str) -> Array:
    """Points (z, r) of the outline, all that can touch among them."""
    body = BODIES[name]
    if isinstance(body, rs.Egg):
        return egg_outline(body, 4001)
    if isinstance(body, rs.Revolution):
        return np.array(body.profile)
    if isinstance(body, rs.TruncatedCone):
        return np.array([(0.0, body.base), (body.height, body.top)])
    assert isinstance(body, rs.Cylinder | rs.Ring)
    radius = body.radius if isinstance(body, rs.Cylinder) else body.outer
    return np.array([(-0.5 * body.height, radius), (0.5 * body.height, radius)])


def egg_outline(egg: rs.Egg, count: int) -> Array:
    """By the tangency of three circles, from another root finder than the core's closed form."""
    from scipy.optimize import brentq

    half, blunt, tip = 0.5 * egg.width, egg.blunt_end, egg.tip

    def gap(radius: float) -> float:
        level = [np.sqrt(max((radius - end) ** 2 - (radius - half) ** 2, 0.0)) for end in (blunt, tip)]
        return float(sum(level) - (egg.length - blunt - tip))

    radius = brentq(gap, half, 1e3 * egg.length, xtol=1e-18, rtol=1e-15)
    middle = blunt + np.sqrt(max((radius - blunt) ** 2 - (radius - half) ** 2, 0.0))
    angles = np.pi * (np.arange(count) + 0.5) / count
    circles = ((egg.length - tip, 0.0, tip), (middle, half - radius, radius), (blunt, 0.0, blunt))
    normals = np.stack([np.cos(angles), np.sin(angles)])
    first = np.arctan2(radius - half, egg.length - tip - middle)
    last = np.arctan2(radius - half, blunt - middle)
    which = np.where(angles < first, 0, np.where(angles < last, 1, 2))
    centre = np.array(circles)[which]
    return np.stack([centre[:, 0] + centre[:, 2] * normals[0], centre[:, 1] + centre[:, 2] * normals[1]], 1)


def integrals(profile: Array) -> tuple[float, float, float, float]:
    """Volume, centre, and moments about it across the axis and along it, by adaptive quadrature."""
    z, r = profile.T

    def over(function: Any) -> float:
        parts = [
            quad(lambda x: function(x, np.interp(x, z, r)), a, b, epsabs=0.0, epsrel=1e-13)[0]
            for a, b in pairwise(z)
        ]
        return float(np.sum(parts))

    volume = over(lambda _, r: np.pi * r**2)
    centre = over(lambda z, r: np.pi * r**2 * z) / volume
    axial = over(lambda _, r: 0.5 * np.pi * r**4)
    return volume, centre, 0.5 * axial + over(lambda z, r: np.pi * r**2 * (z - centre) ** 2), axial


def check_mass(body: RigidBody, expected: tuple[float, float, float, float], rtol: float = 1e-12) -> None:
    volume, centre, across, axial = (np.array(expected) * (2500.0, 1.0, 2500.0, 2500.0)).tolist()
    assert body.mass == pytest.approx(volume, rel=rtol)
    assert body.centre_of_mass == pytest.approx([0.0, 0.0, centre], rel=rtol, abs=1e-17)
    assert body.inertia_tensor == pytest.approx(np.diag([across, across, axial]), rel=rtol)


def test_mass_and_inertia_are_those_of_the_slices() -> None:
    check_mass(BODIES["vase"], integrals(VASE))
    check_mass(rs.Revolution(profile=VASE[::-1]), integrals(VASE))
    check_mass(BODIES["bead"], integrals(outline("bead")))
    cone, (h, r) = BODIES["cone"], (9e-3, 4e-3)
    mass = 2500.0 * np.pi * r * r * h / 3
    across = mass * (3 / 20 * r * r + 3 / 80 * h * h)
    assert cone.mass == pytest.approx(mass, rel=1e-15)
    assert cone.centre_of_mass[2] == pytest.approx(h / 4, rel=1e-15)
    assert cone.principal_moments == pytest.approx([across, across, 0.3 * mass * r * r], rel=1e-14)
    ring = rs.Ring(outer=4e-3, inner=2.5e-3, height=1.5e-3)
    mass, squares = ring.mass, 16e-6 + 6.25e-6
    assert mass == pytest.approx(2500.0 * np.pi * (16e-6 - 6.25e-6) * 1.5e-3, rel=1e-14)
    across = mass * (squares / 4 + 2.25e-6 / 12)
    assert ring.principal_moments == pytest.approx([across, across, mass * squares / 2], rel=1e-14)


@pytest.mark.parametrize(
    ("blunt", "tip"), [(2.0e-3, 1.4e-3), (2.2e-3, 0.7e-3), (1.4e-3, 2.0e-3), (1e-3, 1e-3)]
)
def test_an_egg_is_made_of_three_tangent_circles(blunt: float, tip: float) -> None:
    """Its outline is as long and as wide as it is to be, and mass and inertia are those of its slices."""
    egg = rs.Egg(length=5.7e-3, width=4.4e-3, blunt_end=blunt, tip=tip)
    points = egg_outline(egg, 200001)[::-1]
    assert points[:, 1].max() == pytest.approx(0.5 * egg.width, rel=1e-9)
    slope = np.diff(points[:, 1]) / np.diff(points[:, 0])
    assert (np.diff(slope) < 0.0).all()
    z, r = points.T
    dz, square = np.gradient(z), r * r
    volume = float(np.pi * np.sum(square * dz))
    centre = float(np.pi * np.sum(z * square * dz)) / volume
    axial = float(0.5 * np.pi * np.sum(square**2 * dz))
    across = 0.5 * axial + float(np.pi * np.sum((z - centre) ** 2 * square * dz))
    check_mass(egg, (volume, centre, across, axial), rtol=1e-8)


@pytest.mark.parametrize("name", BODIES)
def test_no_flight_passes_the_plane(name: str) -> None:
    """The axis turns about the angular momentum with Λ/J, J the moment across it; the rest follows."""
    body, profile = BODIES[name], outline(name)
    run: dict[str, Any] = {
        "particles": 30,
        "impacts": 25,
        "spin": rs.RandomSpin(rate=(0.0, 300.0)),
        "seed": 5,
    }
    data = rs.simulate(body, rs.Coulomb(normal=0.9, friction=0.2), record="state", **run)
    assert (data.energy_ratio.fillna(1.0) <= 1.0 + 1e-12).all()
    moments = body.principal_moments
    axis = turned(data.attitude.to_numpy(), np.array([0.0, 0.0, 1.0]))
    omega = data.angular_velocity_after.to_numpy()
    axial = (omega * axis).sum(-1, keepdims=True) * axis
    momentum = moments[0] * (omega - axial) + moments[2] * axial
    rate = np.linalg.norm(momentum, axis=-1) / moments[0]
    duration = np.diff(data.time.to_numpy(), axis=1)
    flown = np.isfinite(duration)
    start = (axis[:, :-1][flown], momentum[:, :-1][flown], rate[:, :-1][flown])
    height, speed = data.position.to_numpy()[..., 2], data.velocity_after.to_numpy()[..., 2]
    z, r = (profile - [body.centre_of_mass[2], 0.0]).T
    z, r = z[:: max(1, len(z) // 400)], r[:: max(1, len(r) // 400)]
    size = np.hypot(z, r).max()
    ends: list[Array] = []
    for share in np.linspace(0.0, 1.0, 201):
        t = share * duration[flown]
        along = rotated(start[0], start[1], start[2] * t)[:, 2:]
        level = np.sqrt(np.maximum(1.0 - along**2, 0.0))
        falling = height[:, :-1][flown] + t * (speed[:, :-1][flown] - 0.5 * 9.81 * t)
        gap = falling + (z * along - r * level).min(axis=1)
        assert gap.min() > -1e-11 * size
        ends.append(gap)
    # Of smooth outlines the samples are a little inside.
    assert ends[-1].max() < (1e-11 if name != "egg" else 1e-4) * size


def rotated(v: Array, about: Array, angle: Array) -> Array:
    """By Rodrigues' formula."""
    n = about / np.linalg.norm(about, axis=-1, keepdims=True)
    cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
    along = (n * v).sum(-1, keepdims=True) * n
    result: Array = along + cosine * (v - along) + sine * np.cross(n, v)
    return result


def turned(q: Array, v: Array) -> Array:
    """A vector of the body in space."""
    twice = 2.0 * np.cross(q[..., 1:], v)
    result: Array = v + q[..., :1] * twice + np.cross(q[..., 1:], twice)
    return result


def tilted(angles: Array) -> Array:
    """Attitudes with the axis at these angles to the normal."""
    return np.stack([np.cos(angles / 2), np.zeros_like(angles), np.sin(angles / 2), np.zeros_like(angles)], 1)


def first(body: RigidBody, angles: Array, e: float) -> Array:
    run = rs.simulate(
        body,
        rs.Frictionless(normal=e),
        particles=angles.size,
        impacts=1,
        release_height=0.02,
        orientation=tilted(angles),
    )
    return np.asarray(run.restitution.to_numpy()[:, 0])


@pytest.mark.parametrize("name", ["coin", "rod"])
def test_the_first_impact_of_a_cylinder_from_rest(name: str) -> None:
    """ε = −1 + (1 + e)/(1 + m x²/J), x = R cos θ − H/2 sin θ the lever arm of the lowest point."""
    body, e = BODIES[name], 0.7
    assert isinstance(body, rs.Cylinder)
    angles = np.linspace(1e-6, np.pi / 2 - 1e-6, 301)
    x = body.radius * np.cos(angles) - 0.5 * body.height * np.sin(angles)
    expected = -1.0 + (1.0 + e) / (1.0 + body.mass * x**2 / body.principal_moments[0])
    assert first(body, angles, e) == pytest.approx(expected, abs=1e-13)


def test_the_first_impact_of_an_egg_from_rest() -> None:
    """The lever arm is the slope of the height at which the egg stands, by differences of the outline's."""
    egg, e = BODIES["egg"], 0.7
    points = outline("egg") - [egg.centre_of_mass[2], 0.0]
    angles = np.linspace(0.05, np.pi - 0.05, 101)

    def stands(angles: Array) -> Array:
        heights = points @ np.stack([np.cos(angles), -np.sin(angles)])
        return np.asarray(-heights.min(axis=0))

    x = (stands(angles + 1e-3) - stands(angles - 1e-3)) / 2e-3
    expected = -1.0 + (1.0 + e) / (1.0 + egg.mass * x**2 / egg.principal_moments[0])
    # The curvature jumps where the arcs meet.
    assert first(egg, angles, e) == pytest.approx(expected, abs=1e-4)


def test_many_rims_become_an_ellipsoid() -> None:
    """The point of contact is off by half a step of the profile, of size π/n, and the mass by its square."""
    a, c, count = 2e-3, 3e-3, 400
    angles = np.pi * np.arange(count + 1) / count
    rims = rs.Revolution(profile=np.stack([-c * np.cos(angles), np.abs(a * np.sin(angles))], axis=1))
    smooth = rs.Ellipsoid(semi_axes=(a, a, c))
    assert rims.mass == pytest.approx(smooth.mass, rel=(np.pi / count) ** 2)
    assert rims.principal_moments == pytest.approx(smooth.principal_moments, rel=2 * (np.pi / count) ** 2)
    tilts = np.linspace(0.1, 3.0, 60)
    off = np.abs(first(rims, tilts, 0.9) - first(smooth, tilts, 0.9))
    assert off.max() < 2 * np.pi / count


@pytest.mark.parametrize(("blunt", "tip"), [(2e-3, 1.5e-3), (1.5e-3, 2e-3), (1.8e-3, 1.2e-3)])
def test_an_egg_as_wide_as_long_is_a_sphere(blunt: float, tip: float) -> None:
    sphere = rs.Egg(length=4e-3, width=4e-3, blunt_end=blunt, tip=tip)
    assert sphere.mass == pytest.approx(2500.0 * 4 / 3 * np.pi * 8e-9, rel=1e-13)
    assert first(sphere, np.linspace(0.1, 3.0, 60), 0.9) == pytest.approx(0.9, abs=1e-12)


def test_a_coin_that_lands_flat() -> None:
    """It bounces like a point; with friction and a throw it rattles from edge to edge."""
    coin = BODIES["coin"]
    flat = np.array([[1.0, 0.0, 0.0, 0.0]])
    run: dict[str, Any] = {"particles": 1, "impacts": 30, "orientation": flat}
    data = rs.simulate(coin, rs.Frictionless(normal=0.8), **run)
    assert data.restitution.to_numpy() == pytest.approx(0.8, rel=1e-12)
    law = rs.Coulomb(normal=0.8, friction=0.1)
    thrown = rs.simulate(coin, law, release_velocity=(0.2, 0.0, 0.0), **run)
    assert (thrown.energy_ratio.fillna(1.0) <= 1.0 + 1e-12).all()
    assert int(thrown.impacts[0]) > 1


def test_contact_numbers_the_rims_of_the_hull() -> None:
    body = BODIES["vase"]
    assert isinstance(body, rs.Revolution)
    assert body.rims == pytest.approx(1e-3 * np.array([(5.5, 0), (5, 2.5), (1, 3.5), (0, 2)]), abs=1e-18)
    upside_down = np.array([[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]])
    run = rs.simulate(body, rs.Frictionless(normal=0.5), particles=2, impacts=1, orientation=upside_down)
    assert run.contact.to_numpy()[:, 0].tolist() == [1, 4]


@pytest.mark.parametrize(
    ("kind", "given", "message"),
    [
        (rs.Revolution, {"profile": [(0, 1e-3)]}, "profile"),
        (rs.Revolution, {"profile": [(0, 1e-3, 1), (1e-3, 0, 1)]}, "profile"),
        (rs.Revolution, {"profile": [(0, 1e-3), (1e-3, -1e-4)]}, r"profile\[1, 1\] = -0.0001"),
        (rs.Revolution, {"profile": [(0, 0), (1e-3, 0)]}, "profile"),
        (rs.Revolution, {"profile": [(0, 1e-3), (0, 2e-3)]}, "profile"),
        (rs.Revolution, {"profile": [(0, 1), (2, 1), (1, 2), (1, 0)]}, "points 0 and 2 cross"),
        (rs.Cylinder, {"radius": 0.0, "height": 1e-3}, "radius = 0.0"),
        (
            rs.Ring,
            {"outer": 1e-3, "inner": 1e-3, "height": 1e-3},
            "inner = 0.001, outer = 0.001: must be less than outer",
        ),
        (rs.Egg, EGG | {"width": 6e-3}, "width = 0.006, length = 0.0057: must be"),
        (rs.Egg, EGG | {"tip": 3e-3}, "tip = 0.003, width = 0.0044: must be"),
        (rs.Egg, {"length": 5e-3, "width": 4e-3, "blunt_end": 2e-3, "tip": 2e-3}, "tip"),
    ],
)
def test_solids_that_cannot_be_are_refused_by_name(kind: Any, given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        kind(**given)
