"""Superellipsoids in pairs: as ellipsoids, and where they touch by the implicit equation of their surface."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import restitution as rs

ELASTIC = rs.Frictionless(normal=1.0)
AXES = (1.0, 0.8, 1.4)
EXPONENTS = [(4.0, 3.0), (8.0, 8.0), (1.5, 1.3), (7.0, 2.0)]


def body_of(exponents: Any, axes: Any = AXES) -> rs.Superellipsoid:
    unit = rs.Superellipsoid(semi_axes=axes, exponents=exponents, density=1.0)
    return rs.Superellipsoid(semi_axes=axes, exponents=exponents, density=1.0 / unit.mass)


def encounters(body: Any, other: Any, count: int, law: Any = ELASTIC, **options: Any) -> Any:
    options = {"translational_temperature": 1.0, "rotational_temperature": 1.0, "seed": 3} | options
    return rs.pair.encounters(body, other, law, encounters=count, record="contacts", **options)


def turned(data: Any, particle: int) -> Rotation:
    """From the axes of a body to those of space, before."""
    return Rotation.from_quat(data.attitude_before[:, particle].to_numpy(), scalar_first=True)


def surface(point: Any, axes: Any, exponents: Any) -> tuple[Any, Any]:
    """F + 1 of the implicit equation, of degree 1 in the place, and its unit gradient."""
    (x, y, z), (first, second) = np.abs(point) / axes, exponents
    level = (x**second + y**second) ** (1 / second)
    size = (level**first + z**first) ** (1 / first)
    across = (level / size) ** (first - 1)
    parts = np.array(
        [
            across * (x / level) ** (second - 1),
            across * (y / level) ** (second - 1),
            (z / size) ** (first - 1),
        ]
    )
    gradient = np.sign(point) * parts / axes
    return size, gradient / np.linalg.norm(gradient)


def test_exponents_of_two_are_an_ellipsoid() -> None:
    exact = rs.Ellipsoid(semi_axes=AXES, density=1.0 / rs.Ellipsoid(semi_axes=AXES, density=1.0).mass)
    one = body_of((2.0, 2.0))
    found, known = encounters(one, one, 300), encounters(exact, exact, 300)
    assert (found.contacts == known.contacts).all()
    for name in ("time", "point", "impulse", "velocity_after", "angular_velocity_after"):
        np.testing.assert_allclose(found[name], known[name], rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("exponents", EXPONENTS)
def test_what_touches_has_a_point_and_a_normal_in_common(exponents: Any) -> None:
    """Two convex bodies touch where both have a point with opposite normals; before they are apart."""
    body, other = body_of(exponents), body_of((3.0, 5.0), (1.2, 1.2, 0.6))
    data = encounters(body, other, 60, rotational_temperature=0.0)
    hits = np.flatnonzero(data.contacts > 0)
    assert 20 < len(hits) < 60
    axes = [(AXES, exponents), ((1.2, 1.2, 0.6), (3.0, 5.0))]
    for k in hits:
        time = float(data["time"][k, 0])
        normals = []
        for i, (own, powers) in enumerate(axes):
            place = data.position_before[k, i].to_numpy() + time * data.velocity_before[k, i].to_numpy()
            arm = turned(data, i)[k].inv().apply(data.point[k, 0].to_numpy() - place)
            size, normal = surface(arm, own, powers)
            # The last step leaves a gap of 2^-52 of the size; powers multiply the rounding of logarithms.
            assert size == pytest.approx(1.0, abs=1e-11)
            normals.append(turned(data, i)[k].apply(normal))
        normal = data.normal[k, 0].to_numpy()
        assert normals[1] @ normal == pytest.approx(1.0, abs=1e-6)
        assert normals[0] @ normal == pytest.approx(-1.0, abs=1e-6)


def support(directions: Any, axes: Any, exponents: Any) -> Any:
    """The norm that is dual to that of the surface (O. Hölder)."""
    p, q = (n / (n - 1) for n in exponents)
    x, y, z = np.abs(directions * axes).T
    return ((x**q + y**q) ** (p / q) + z**p) ** (1 / p)


def test_those_that_miss_are_parted_by_a_plane() -> None:
    exponents = (6.0, 4.0)
    body = body_of(exponents)
    data = encounters(body, body, 30, rotational_temperature=0.0)
    rng = np.random.default_rng(1)
    directions = rng.normal(size=(40_000, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    misses = np.flatnonzero(data.contacts == 0)
    assert len(misses) > 5
    for k in misses:
        sizes = sum(support(turned(data, i)[k].inv().apply(directions), AXES, exponents) for i in (0, 1))
        apart, speed = (
            data[f"{name}_before"][k, 0] - data[f"{name}_before"][k, 1] for name in ("position", "velocity")
        )
        for time in np.linspace(0.0, float(data.duration[k]), 40):
            width = (directions @ (apart + time * speed).to_numpy() - sizes).max()
            # The nearest of so many directions is off by some .01, which costs the square of it.
            assert width > -1e-3


@pytest.mark.parametrize("exponents", EXPONENTS)
def test_energy_and_momenta_are_kept(exponents: Any) -> None:
    """Of turning bodies, whose contacts need the search with rotation."""
    body = body_of(exponents)
    data = encounters(body, body, 200)
    energies = [
        (data[f"translational_energy_{when}"] + data[f"rotational_energy_{when}"]).sum("particle")
        for when in ("before", "after")
    ]
    np.testing.assert_allclose(energies[1], energies[0], rtol=1e-11)
    momenta = [data[f"velocity_{when}"].sum("particle") for when in ("before", "after")]
    np.testing.assert_allclose(momenta[1], momenta[0], atol=1e-12)


def test_on_a_plane_it_is_the_first_impact() -> None:
    body = body_of((5.0, 3.0))
    data = encounters(body, rs.Plane(), 50, rotational_temperature=0.0)
    for k in range(50):
        up = turned(data, 0)[k].inv().apply([0.0, 0, 1])
        height = float(data.position_before[k, 0, 2])
        speed = -float(data.velocity_before[k, 0, 2])
        exact = (height - support(up[np.newaxis], AXES, (5.0, 3.0))[0]) / speed
        assert float(data["time"][k, 0]) == pytest.approx(exact, rel=1e-12)
