"""Kinetic theory of a gas of aspherical bodies beside numbers, formulas and integrals from elsewhere."""

from typing import Any

import numpy as np
import pytest
from scipy.stats import qmc

import restitution as rs
from reference.convex import area_and_mean_radius
from restitution.bodies import AnyBody
from restitution.gas import theory
from restitution.gas.theory._surface import surface

ELASTIC = rs.Frictionless(normal=1.0)
MASS = 4.0 / 3.0 * np.pi
EQUAL = {"translational_temperature": 1.0, "rotational_temperature": 1.0}


def unit(body: AnyBody) -> float:
    """∮√K dA in units of the body's mass, the integral of the rate of contacts in equilibrium."""
    found = surface(body, 24)
    return float(found.area @ np.sqrt(2.0 + body.mass * found.turning))


def dumbbell(elongation: float) -> rs.Dumbbell:
    return rs.Dumbbell(radius=1.0, separation=elongation, density=1.0)


# Of a program in C++ that follows encounters, and of quadratures of its author, in units R = m = 1.
CONTACTS = {
    "spheres": (dumbbell(0.0), 71.086127),
    "nearly round dumbbells": (dumbbell(0.1), 74.8100282),
    "dumbbells": (dumbbell(1.0), 121.4752259),
    "spheroids": (rs.Spheroid(equatorial=1.0, polar=2.0, density=1.0, inertia=(2 * MASS,) * 2), 157.0410992),
    "ellipsoids": (
        rs.Ellipsoid(semi_axes=(1.0, 2.0, 1.0), density=1.0, inertia=2 * MASS * np.eye(3)),
        157.0410992,
    ),
}


@pytest.mark.parametrize("name", CONTACTS)
def test_contacts_in_equilibrium(name: str) -> None:
    body, expected = CONTACTS[name]
    assert unit(body) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(
    "body", [rs.Spherocylinder(radius=1.0, separation=3.0), rs.Spheroid(equatorial=1.0, polar=2.5)]
)
def test_area_of_contact_of_convex_bodies(body: Any) -> None:
    """The kinematic formula for the surface of the sum of two convex bodies, 2S + 8πR²."""
    area, radius = area_and_mean_radius(body)
    assert surface(body, 24).area.sum() == pytest.approx(2 * area + 8 * np.pi * radius**2, rel=1e-9)


@pytest.mark.parametrize("elongation", [0.1, 0.5, 1.0, 2.0])
def test_open_directions_of_dumbbells(elongation: float) -> None:
    """The same average by a million points at random, each with the three conditions as they stand."""
    body, reach = dumbbell(elongation), elongation / 4
    values = []
    for seed in range(8):
        u = qmc.Sobol(3, seed=seed).random(2**17)
        x, y, cosine = 2 * u[:, 0] - 1, 2 * u[:, 1] - 1, np.cos(2 * np.pi * u[:, 2])
        between = x * y + np.sqrt((1 - x * x) * (1 - y * y)) * cosine
        free = (x + reach > 0) & (y + reach > 0) & (x + y + 2 * reach * (1 + between) > 0)
        turning = elongation**2 / 4 * (2 - x * x - y * y) / body.transverse_inertia * body.mass
        values.append(64 * np.pi * (free * np.sqrt(2 + turning)).mean())
    error = np.std(values, ddof=1) / np.sqrt(8)
    assert abs(np.mean(values) - unit(body)) < 5 * error
    assert error < 1e-3 * unit(body)


@pytest.mark.parametrize("body", [dumbbell(1.0), rs.Spherocylinder(radius=1.0, separation=1.0)])
def test_balance_at_equal_temperatures(body: Any) -> None:
    found = theory.rates(body, ELASTIC, **EQUAL)
    assert abs(found.translational) < 1e-12 * found.contacts
    assert abs(found.rotational) < 1e-12 * found.contacts
    assert found.error < 1e-6


def test_elastic_exchange_keeps_the_energy() -> None:
    """-38.485 of dumbbells L/R = 2 at T_rot = 2T_tr; a Monte Carlo integral gave -38.479."""
    body = rs.Dumbbell(radius=1.0, separation=2.0, density=3 / (8 * np.pi))
    found = theory.rates(body, ELASTIC, translational_temperature=1.0, rotational_temperature=2.0)
    assert found.translational == pytest.approx(-found.rotational, rel=1e-12)
    assert found.rotational == pytest.approx(-38.479, rel=3e-4)


def test_spheres_cool_as_haff_says() -> None:
    """dT/dt = -(ν/3)(1 - ε²)T."""
    body = dumbbell(0.0)
    law = rs.Frictionless(normal=0.9)
    found = theory.rates(body, law, **EQUAL, number_density=3.0)
    assert found.translational / 1.5 == pytest.approx(-found.contacts * (1 - 0.81) / 3, rel=1e-12)
    assert abs(found.rotational) < 1e-30 * found.contacts
    tau = theory.haff_time(body, law, translational_temperature=1.0, number_density=3.0)
    data = theory.cooling(body, law, times=[tau, 9 * tau], number_density=3.0, **EQUAL)
    np.testing.assert_allclose(data["translational_temperature"], [0.25, 0.01], rtol=1e-8)


@pytest.mark.parametrize(("normal", "beta"), [(0.9, 0.5), (0.9, -0.5), (0.7, 0.1), (1.0, 0.0)])
def test_rough_spheres(normal: float, beta: float) -> None:
    """The ratio of the temperatures in closed form (Huthmann and Zippelius 1997)."""
    law = rs.TangentialRestitution(normal=normal, tangential=-beta)
    q = 0.4
    eta = q * (1 + beta) / (2 * (1 + q))
    a, b, c = (1 - normal**2) / 4 + eta * (1 - eta), eta**2 / q, eta / q * (1 - eta / q)
    expected = ((a - c) + np.sqrt((a - c) ** 2 + 4 * b**2)) / (2 * b)
    assert theory.steady_ratio(dumbbell(0.0), law) == pytest.approx(expected, rel=1e-10)


def test_perfectly_rough_elastic_spheres_share_their_energy() -> None:
    law = rs.TangentialRestitution(normal=1.0, tangential=-1.0)
    found = theory.rates(dumbbell(0.0), law, **EQUAL)
    assert abs(found.translational) + abs(found.rotational) < 1e-12 * found.contacts


def test_the_limit_of_round_bodies_is_singular() -> None:
    """(12/5)(R/L)²(1 - ε)/(1 + ε), and nearly all energy then leaves by -(1 + ε)mL²/6J a contact.

    Both to the order (1 - ε)/20 that the flux of the contacts adds, whose variance of b is a tenth of <b>².
    """
    normal = 0.99
    law = rs.Frictionless(normal=normal)
    body = dumbbell(1e-3)
    ratio = theory.steady_ratio(body, law)
    assert ratio == pytest.approx(12 / 5 * 1e6 * (1 - normal) / (1 + normal), rel=1e-3)
    found = theory.rates(body, law, translational_temperature=1.0, rotational_temperature=ratio)
    loss = -(1 + normal) * body.mass * body.separation**2 / (6 * body.transverse_inertia)
    assert found.rotational / ratio / found.contacts == pytest.approx(loss, rel=1e-3)


def test_elastic_bodies_share_their_energy() -> None:
    assert theory.steady_ratio(dumbbell(1.0), ELASTIC) == pytest.approx(1.0, rel=1e-9)


def test_cooling_ends_at_the_steady_ratio_by_haffs_law() -> None:
    body, law = rs.Spheroid(equatorial=1.0, polar=2.0, density=1.0), rs.Frictionless(normal=0.8)
    tau = theory.haff_time(body, law, translational_temperature=1.0)
    times = tau * np.array([0.0, 1e3, 1e4])
    data = theory.cooling(body, law, times=times, translational_temperature=1.0, rotational_temperature=1e-9)
    ratio = data["rotational_temperature"] / data["translational_temperature"]
    assert float(ratio[-1]) == pytest.approx(theory.steady_ratio(body, law), rel=1e-6)
    fall = np.log(data["translational_temperature"][2] / data["translational_temperature"][1])
    assert float(fall) == pytest.approx(-2 * np.log(10), rel=1e-2)
    slope = np.gradient(data["contacts"], data["time"])
    assert float(slope[0]) < theory.rates(body, law, **EQUAL).contacts


REFUSED = {
    "body": (rs.Dumbbell(radius=1.0, separation=3.0), ELASTIC, {}),
    "law": (dumbbell(1.0), rs.Coulomb(normal=0.9, friction=0.3), {}),
    "translational_temperature": (dumbbell(1.0), ELASTIC, {"translational_temperature": -1.0}),
    "rotational_temperature": (dumbbell(1.0), ELASTIC, {"rotational_temperature": 0.0}),
    "number_density": (dumbbell(1.0), ELASTIC, {"number_density": np.inf}),
}


@pytest.mark.parametrize("name", REFUSED)
def test_refused_by_name(name: str) -> None:
    body, law, other = REFUSED[name]
    with pytest.raises(ValueError, match=f"^{name}"):
        theory.rates(body, law, **EQUAL | other)


def test_smooth_spheres_have_no_steady_ratio() -> None:
    with pytest.raises(ValueError, match=r"^body = .*keeps its spin"):
        theory.steady_ratio(dumbbell(0.0), ELASTIC)
    with pytest.raises(ValueError, match=r"^times"):
        theory.cooling(dumbbell(0.0), ELASTIC, times=[2.0, 1.0], **EQUAL)
