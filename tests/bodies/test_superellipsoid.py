"""Superellipsoids: mass and inertia in closed form, their support function, and their bounces."""

from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import beta
from scipy.stats import kstest

import restitution as rs

EXPONENTS = [(2.0, 2.0), (1.1, 1.1), (1.5, 4.0), (6.0, 3.0), (20.0, 2.0), (100.0, 100.0)]
AXES = (3e-3, 2e-3, 1e-3)


def implicit(points: Any, exponents: tuple[float, float]) -> Any:
    """(|x/a|^n2 + |y/b|^n2)^(n1/n2) + |z/c|^n1 - 1."""
    n1, n2 = exponents
    x, y, z = np.moveaxis(np.abs(points / np.array(AXES)), -1, 0)
    return (x**n2 + y**n2) ** (n1 / n2) + z**n1 - 1.0


@pytest.mark.parametrize("exponents", EXPONENTS)
def test_mass_and_inertia_are_those_of_slices(exponents: tuple[float, float]) -> None:
    """A slice is a superellipse; its area and moments are integrals of Dirichlet, and those over z, too."""
    n1, n2 = exponents
    a, b, c = AXES
    # ∫∫ |x|^(p-1) |y|^(q-1) over a quarter of |x|^n + |y|^n <= 1 is B(p/n, q/n)/(n (p + q)).
    area = 4 * a * b * beta(1 / n2, 1 / n2) / (2 * n2)
    second = 4 * a * b * beta(3 / n2, 1 / n2) / (4 * n2)
    # A slice at z = c t is smaller by (1 - t^n1)^(1/n1); ∫ t^p (1 - t^n)^(q/n) dt = B((p + 1)/n, q/n + 1)/n.
    power = {
        (p, q): 2 * c * beta((p + 1) / n1, q / n1 + 1) / n1 for p, q in ((0.0, 2.0), (0.0, 4.0), (2.0, 2.0))
    }
    mass = 1000.0 * area * power[0.0, 2.0]
    xx, yy = (1000.0 * second * axis**2 * power[0.0, 4.0] for axis in (a, b))
    zz = 1000.0 * area * c**2 * power[2.0, 2.0]
    body = rs.Superellipsoid(semi_axes=AXES, exponents=exponents, density=1000.0)
    assert body.mass == pytest.approx(mass, rel=1e-13)
    np.testing.assert_allclose(body.inertia_tensor, np.diag([yy + zz, zz + xx, xx + yy]), rtol=1e-13)


@pytest.mark.parametrize("exponents", EXPONENTS[1:])
def test_the_support_is_the_largest_projection(exponents: tuple[float, float]) -> None:
    """By a search over the surface, in spherical angles."""
    body = rs.Superellipsoid(semi_axes=AXES, exponents=exponents)
    normals = np.random.default_rng(3).normal(size=(12, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    found = body.compiled.supports(normals)

    def place(angles: Any) -> Any:
        ray = np.stack(
            [np.sin(angles[0]) * np.cos(angles[1]), np.sin(angles[0]) * np.sin(angles[1]), np.cos(angles[0])]
        )
        # Along a ray the function of the surface is a power: with n1 it is homogeneous.
        return ray * (1.0 + implicit(ray, exponents)) ** (-1.0 / exponents[0])

    grid = np.stack(np.meshgrid(np.linspace(0.01, 3.13, 80), np.linspace(-3.1, 3.1, 80)), axis=-1).reshape(
        -1, 2
    )
    surface = np.array([place(pair) for pair in grid])
    for normal, distance in zip(normals, found, strict=True):
        start = grid[np.argmax(surface @ normal)]

        def away(pair: Any, u: Any = normal) -> float:
            return -1e3 * float(place(pair) @ u)

        options: Any = {"xatol": 1e-12, "fatol": 1e-14, "maxfev": 2000}
        best = minimize(away, start, method="Nelder-Mead", options=options)
        assert -1e-3 * best.fun == pytest.approx(distance, rel=1e-8)
        assert distance <= body.compiled.farthest() * (1.0 + 1e-12)


def test_with_exponents_2_it_is_an_ellipsoid() -> None:
    run: dict[str, Any] = {"particles": 200, "impacts": 3, "spin": (20.0, -10.0, 30.0), "record": "state"}
    law = rs.Coulomb(normal=0.8, friction=0.3)
    one = rs.simulate(rs.Superellipsoid(semi_axes=AXES, exponents=(2, 2)), law, **run)
    other = rs.simulate(rs.Ellipsoid(semi_axes=AXES), law, **run)
    apart = np.abs(one.restitution - other.restitution)
    assert (apart.max("particle") < [1e-12, 1e-7, 1e-6]).all()
    assert (apart.median("particle") < 1e-12).all()


@pytest.mark.parametrize("exponents", EXPONENTS[1:])
def test_nothing_passes_the_plane_and_energy_is_kept(exponents: tuple[float, float]) -> None:
    body = rs.Superellipsoid(semi_axes=AXES, exponents=exponents)
    law = rs.Coulomb(normal=0.9, friction=0.3)
    spin = rs.RandomSpin(rate=(0.0, 300.0))
    data = rs.simulate(body, law, particles=20, impacts=15, spin=spin, seed=4, record="state")
    assert (data.energy_ratio.fillna(1.0) <= 1.0 + 1e-12).all()
    for particle in range(3):
        times = np.linspace(0.0, float(data.time[particle].max()), 800)
        path = rs.trajectory(data, particle, times)
        w, x, y, z = path.attitude.to_numpy().T
        up = np.stack([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)], axis=1)
        low = body.compiled.supports(np.ascontiguousarray(-up))
        assert (path.position[:, 2].to_numpy() - low).min() > -1e-12 * max(AXES)


@pytest.mark.parametrize("seed", [1, 2])
def test_with_large_exponents_it_bounces_like_a_box(seed: int) -> None:
    """The mean of the first ε of both, within their standard errors and the roundness of the edges."""
    law = rs.Frictionless(normal=0.9)
    box = rs.Box(2 * AXES[0], 2 * AXES[1], 2 * AXES[2])
    round_box = rs.Superellipsoid(semi_axes=AXES, exponents=(100, 100))
    found = [rs.simulate(body, law, particles=4000, impacts=1, seed=seed) for body in (box, round_box)]
    means = [float(data.restitution.mean()) for data in found]
    error = np.hypot(*(float(data.restitution.std()) / 4000**0.5 for data in found))
    assert abs(means[0] - means[1]) < 4 * error + 0.01


def test_its_first_impact_from_rest_is_that_of_samples() -> None:
    """Also of one whose centre of mass is given; Kolmogorov and Smirnov, at the level of 1/1000."""
    law = rs.Coulomb(normal=0.8, friction=0.3)
    tensor = rs.Superellipsoid(semi_axes=AXES, exponents=(4, 3)).inertia_tensor
    body = rs.Superellipsoid(semi_axes=AXES, exponents=(4, 3), inertia=tensor, centre=(3e-4, 2e-4, 1e-4))
    exact = rs.analytic.first_impact(body, law)
    assert exact.cdf_error < 2e-3
    for seed in (1, 2):
        found = rs.simulate(body, law, particles=4000, impacts=1, seed=seed).restitution.to_numpy().ravel()
        assert kstest(found, exact.cdf).pvalue > 1e-3


@pytest.mark.parametrize("exponents", [(1.0, 2.0), (2.0, 101.0), (np.nan, 2.0), 2.0, (2.0, 2.0, 2.0), "ab"])
def test_impossible_exponents(exponents: Any) -> None:
    with pytest.raises(ValueError, match=r"exponents.*two numbers"):
        rs.Superellipsoid(semi_axes=AXES, exponents=exponents)
