"""The first impact of bodies of any shape: beside the engine, bodies of revolution, and quadrature."""

import pickle
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy import stats
from scipy.integrate import dblquad
from scipy.spatial.transform import Rotation

import restitution as rs
from reference.first_impacts import RANDOM, beside_lattices, full_matrix
from restitution.analytic import FirstImpact, first_impact, negative_threshold
from restitution.analytic._normal import Fall
from restitution.analytic._rigid_first import RigidFirstImpact
from restitution.bodies import AnyBody

Floats = npt.NDArray[np.float64]

LAWS: dict[str, rs.laws.Law] = {
    "frictionless": rs.Frictionless(normal=0.7),
    "paper": rs.TangentialRestitution(normal=0.7, tangential=0.3),
    "Coulomb": rs.Coulomb(normal=0.7, friction=0.15),
    "Chatterjee-Ruina": rs.ChatterjeeRuina(normal=0.3, tangential=0.9, friction=0.5),
}
CORNER = [(0, 0, 0), (6e-3, 0, 0), (0, 4e-3, 0), (1e-3, 0, 5e-3)]
BALLS = [
    (0, 0, 1e-3, 2e-3),
    (1e-3, 0, -1e-3, 1.5e-3),
    (0, 2e-3, 0, 1e-3),
    (-1e-3, -1e-3, 0, 1.2e-3),
]
BODIES: dict[str, Any] = {
    "box": rs.Box(a=1e-2, b=2e-2, c=3e-2),
    "corner": rs.ConvexPolyhedron(CORNER),
    "mesh": rs.Mesh(vertices=CORNER, triangles=[(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]),
    "die": rs.Die(faces=20, edge=1e-2),
    "clump": rs.Clump(spheres=BALLS),
    "pebble": rs.Ellipsoid(semi_axes=(1e-3, 3e-3, 2e-3)),
    "rough": rs.Rough(rs.Dumbbell(radius=3e-3, separation=3e-3), asperities=8, asperity_radius=1e-3),
}


LEVEL = 1e-6
"""Probability of a false alarm of each Kolmogorov–Smirnov test."""


@lru_cache
def first(body: str, law: str) -> FirstImpact:
    return first_impact(BODIES[body], LAWS[law])


def dropped(body: AnyBody, law: rs.laws.Law, number: int, seed: int, **fall: Any) -> Any:
    height: dict[str, Any] = {"release_height": 4.0 * body.compiled.farthest()} | fall
    return rs.simulate(body, law, particles=number, impacts=1, seed=seed, threads=1, **height)


def normals(run: Any) -> Floats:
    """Plane normals in the axes of the body."""
    turned = Rotation.from_quat(np.roll(run.release_attitude.values, -1, axis=1))
    return np.asarray(turned.inv().apply([0.0, 0.0, 1.0]))


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("body", BODIES)
def test_each_attitude_is_the_engine_s(body: str, law: str) -> None:
    """ε of a direction of the plane, beside the contact and the response of the core."""
    # Made without a distribution, which takes seconds.
    one = RigidFirstImpact(BODIES[body], LAWS[law], "isotropic", Fall(release_height=1.0, gravity=1.0))
    run = dropped(BODIES[body], LAWS[law], 300, 4)
    np.testing.assert_allclose(one.at(3.0 * normals(run)), run.restitution.values[:, 0], rtol=0.0, atol=2e-12)


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    ("body", "law"),
    [("box", "frictionless"), ("clump", "Coulomb"), ("box", "Chatterjee-Ruina"), ("rough", "paper")],
)
def test_the_engine_s_impacts_follow_the_distribution(body: str, law: str, seed: int) -> None:
    found = dropped(BODIES[body], LAWS[law], 20_000, seed).restitution.values[:, 0]
    assert stats.kstest(found, first(body, law).cdf).pvalue > LEVEL


@pytest.mark.parametrize("law", ["frictionless", "paper"])
def test_a_box_beside_the_full_matrix(law: str) -> None:
    """5000 random directions and nothing of the package: one ε each, and their distribution."""
    up = Rotation.random(5000, random_state=7).apply([0.0, 0.0, 1.0])
    inertia = np.diag([4 + 9, 1 + 9, 1 + 4]) / 12.0  # of edges 1, 2, 3, over the mass
    expected = full_matrix(-np.sign(up) * [0.5, 1.0, 1.5], inertia, LAWS[law], up)
    one = RigidFirstImpact(BODIES["box"], LAWS[law], "isotropic", Fall(release_height=1.0, gravity=1.0))
    np.testing.assert_allclose(one.at(up), expected, rtol=0.0, atol=1e-13)
    if law == "frictionless":
        assert stats.kstest(expected, first("box", law).cdf).pvalue > LEVEL


@pytest.mark.parametrize(
    ("body", "law", "seed"),
    [
        ("clump", LAWS["frictionless"], 1),
        ("equal balls", LAWS["paper"], 2),
        ("polyhedron", LAWS["Chatterjee-Ruina"], 3),
        ("plate", LAWS["Coulomb"], 4),
        ("needle", rs.ChatterjeeRuina(normal=0.8, tangential=-0.2, friction=0.05), 7),
        ("superellipsoid", LAWS["paper"], 8),
    ],
)
def test_the_error_of_the_distribution_function_is_what_it_says(body: str, law: Any, seed: int) -> None:
    off, own, stated = beside_lattices(RANDOM[body](np.random.default_rng(seed)), law, 250_000, seed)
    assert off < stated + own


NARROW: dict[str, tuple[Any, str]] = {
    "nearly a ball": (rs.Clump(spheres=[(0, 0, 0, 1), (0, 0, 1, 0.05), (0.9, 0.3, 0.2, 0.1)]), "Coulomb"),
    "octahedron": (
        rs.Superellipsoid(semi_axes=(1.0, 0.8, 0.6), exponents=(1.1, 1.1)),
        "Chatterjee-Ruina",
    ),
}


@pytest.mark.parametrize("name", NARROW)
def test_bodies_on_which_little_has_most_of_the_distribution(name: str) -> None:
    """Most ε of the ball are within 1e-6, and the edges of the octahedron are narrow."""
    body, law = NARROW[name]
    assert first_impact(body, LAWS[law]).cdf_error < 3e-3


def test_moments_of_a_box_beside_a_double_integral() -> None:
    """In an octant of directions the corner (a, b, c)/2 touches; without friction ε = 1.7/K_nn - 1."""
    corner = np.array([0.5, 1.0, 1.5])
    moments = np.array([4 + 9, 1 + 9, 1 + 4]) / 12.0

    def power(angle: float, height: float, order: int) -> float:
        side = np.sqrt(1.0 - height * height)
        arm = np.cross(corner, [side * np.cos(angle), side * np.sin(angle), height])
        return float((1.7 / (1.0 + np.sum(arm * arm / moments)) - 1.0) ** order * 2.0 / np.pi)

    mean, square = (
        dblquad(power, 0.0, 1.0, 0.0, 0.5 * np.pi, args=(order,), epsabs=1e-10)[0] for order in (1, 2)
    )
    distribution = first("box", "frictionless")
    assert distribution.mean() == pytest.approx(mean, abs=1e-7)
    assert distribution.var() == pytest.approx(square - mean**2, abs=1e-7)


SHAPES: dict[str, tuple[Any, Any]] = {
    "two balls": (
        rs.Clump(spheres=[(0, 0, 1e-3, 2e-3), (0, 0, -1e-3, 2e-3)]),
        rs.Dumbbell(radius=2e-3, separation=2e-3),
    ),
    "unequal balls": (
        rs.Clump(spheres=[(0, 0, 0, 2e-3), (0, 0, 2e-3, 1.2e-3)]),
        rs.Dumbbell(radius=(2e-3, 1.2e-3), separation=2e-3),
    ),
    "ellipsoid": (
        rs.Ellipsoid(semi_axes=(2e-3, 3e-3, 2e-3)),
        rs.Spheroid(equatorial=2e-3, polar=3e-3),
    ),
}


@pytest.mark.parametrize(
    ("shape", "law", "close"),
    [
        ("two balls", "Coulomb", 1e-6),
        ("ellipsoid", "frictionless", 1e-6),
        pytest.param("unequal balls", "frictionless", 1e-4, marks=pytest.mark.slow),
    ],
)
def test_bodies_that_have_an_axis_after_all(shape: str, law: str, close: float) -> None:
    """The closed form in θ, to the error that is stated, and its moments, as docs/first-impact.md says."""
    body, same = SHAPES[shape]
    found, exact = first_impact(body, LAWS[law]), first_impact(same, LAWS[law], "isotropic")
    assert found.cdf_error < 2e-3
    x = np.concatenate([np.linspace(*exact.support(), 500), exact.ppf(np.linspace(0.0, 1.0, 500))])
    assert np.abs(found.cdf(x) - exact.cdf(x)).max() < found.cdf_error
    assert found.support() == pytest.approx(exact.support(), abs=1e-9)
    assert found.mean() == pytest.approx(exact.mean(), abs=close)
    assert found.std() == pytest.approx(exact.std(), abs=close)
    assert found.entropy() == pytest.approx(exact.entropy(), abs=5e-3)
    inner = exact.ppf(np.linspace(0.05, 0.95, 10))
    np.testing.assert_allclose(found.pdf(inner), exact.pdf(inner), rtol=0.05)


TURNED: dict[str, Any] = {
    "coin": rs.Cylinder(radius=1e-2, height=2e-3),
    "washer": rs.Ring(outer=1e-2, inner=6e-3, height=4e-3),
    "cone": rs.Revolution(profile=[(0, 4e-3), (12e-3, 0)]),
    "egg": rs.Egg(length=57e-3, width=44e-3, blunt_end=20e-3, tip=14e-3),
    "blunt egg": rs.Egg(length=57e-3, width=44e-3, blunt_end=22e-3, tip=14e-3),
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("body", TURNED)
def test_solids_of_revolution_have_the_closed_form_in_the_angle(body: str, law: str) -> None:
    distribution = first_impact(TURNED[body], LAWS[law])
    assert distribution.orientation == "isotropic"
    assert distribution.cdf_error == 0.0
    run = dropped(TURNED[body], LAWS[law], 4000, 3)
    found = run.restitution.values[:, 0]
    np.testing.assert_allclose(distribution.at(normals(run)), found, rtol=0.0, atol=1e-11)
    assert stats.kstest(found, distribution.cdf).pvalue > LEVEL


def test_the_threshold_of_a_long_rod_is_that_of_a_rim() -> None:
    """Without friction it is max a²/J, a = H/2 sin θ - R cos θ at the lower rim, J = R²/4 + H²/12."""
    law = LAWS["frictionless"]
    rod = rs.Cylinder(radius=1.0, height=6.0)
    assert negative_threshold(rod, law) == pytest.approx(9.0 / (0.25 + 3.0), rel=1e-12)  # level
    with pytest.raises(ValueError, match=r"^body = Box"):
        negative_threshold(BODIES["box"], law)


def test_a_coefficient_that_depends_on_the_speed() -> None:
    """ε_n is that of the speed after the fall, which differs with the attitude."""
    law = rs.Coulomb(normal=rs.Plastic(yield_speed=0.05), friction=0.2)
    fall: dict[str, Any] = {"release_height": 0.03, "gravity": 9.81}
    distribution = first_impact(BODIES["box"], law, **fall)
    run = dropped(BODIES["box"], law, 5000, 5, **fall)
    found = run.restitution.values[:, 0]
    np.testing.assert_allclose(distribution.at(normals(run)), found, rtol=0.0, atol=1e-11)
    assert stats.kstest(found, distribution.cdf).pvalue > LEVEL


def test_a_ball_about_the_centre_of_mass_has_a_probability_of_its_own() -> None:
    """A ball with a knob on either side: the caps 2π(1 - cos α), cos α = (R - r)/s, are the knobs'."""
    balls = [(0, 0, 0, 2.0), (0, 0, 2.0, 0.5), (0, 0, -2.0, 0.5)]
    distribution = first_impact(rs.Clump(spheres=balls), LAWS["frictionless"])
    share = 0.75
    assert distribution.sf(0.7 - 1e-9) == pytest.approx(share, abs=distribution.cdf_error)
    assert distribution.support()[1] == pytest.approx(0.7, abs=1e-15)
    assert distribution.median() == pytest.approx(0.7, abs=1e-15)
    assert distribution.entropy() == -np.inf
    assert distribution.expect() == pytest.approx(distribution.mean(), abs=1e-4)


def test_it_is_used_like_the_others() -> None:
    distribution = first("box", "Chatterjee-Ruina")
    low, high = distribution.support()
    x = np.linspace(low, high, 2001)
    assert np.all(np.diff(distribution.cdf(x)) >= 0.0)
    assert np.array_equal(distribution.cdf([-np.inf, low, high, np.inf]), [0, 0, 1, 1])
    assert np.array_equal(distribution.pdf([low - 1e-9, high + 1e-9]), [0, 0])
    assert np.isnan([distribution.cdf(np.nan), distribution.ppf(1.5), distribution.pdf(np.nan)]).all()
    assert distribution.ppf([0.0, 1.0]) == pytest.approx([low, high], abs=1e-12)
    q = np.linspace(0.01, 0.99, 99)
    assert distribution.cdf(distribution.ppf(q)) == pytest.approx(q, abs=1e-12)
    assert distribution.isf(q) == pytest.approx(distribution.ppf(1.0 - q), abs=1e-12)
    assert distribution.expect() == pytest.approx(distribution.mean(), abs=1e-4)
    assert distribution.expect(lambda _: 1.0, lb=0.0) == pytest.approx(distribution.sf(0.0), abs=1e-3)
    mean, variance, skewness, kurtosis = distribution.stats("mvsk")
    draws = distribution.rvs(20_000, random_state=3)
    assert stats.kstest(draws, distribution.cdf).pvalue > LEVEL
    assert draws.mean() == pytest.approx(mean, abs=6.0 * np.sqrt(variance / 20_000))
    assert stats.skew(draws) == pytest.approx(skewness, abs=0.1)
    assert stats.kurtosis(draws, fisher=False) == pytest.approx(kurtosis, abs=0.1)
    assert distribution.moment(2) == pytest.approx(variance + mean**2, rel=1e-12)
    above = np.asarray(distribution.rvs(20_000, random_state=4)) > 0.3
    assert distribution.probability_above_normal == pytest.approx(above.mean(), abs=0.02)
    assert first("clump", "Coulomb").probability_above_normal == 0.0
    assert pickle.loads(pickle.dumps(distribution)).mean() == mean


def test_a_study_has_it_beside_its_statistics(tmp_path: Path) -> None:
    body, law = TURNED["coin"], LAWS["Coulomb"]
    study = {"body": body, "law": law, "sweep": {"body.height": [2e-3, 4e-3]}, "first_impact": {}}
    bins = {"velocity_bins": [0.0, 1.0], "restitution_bins": [-1.0, 1.0]}
    found = rs.sweep(study | {"run": {"particles": 10, "impacts": 2}, "statistics": bins}, out=tmp_path / "s")
    assert found.first_impact_mean.values[0] == first_impact(body, law).mean()


def test_what_it_refuses_says_what_is_allowed() -> None:
    box, law = BODIES["box"], LAWS["paper"]
    with pytest.raises(ValueError, match=r"^orientation = 'uniform-angle': must be 'isotropic'"):
        first_impact(box, law, "uniform-angle")
    with pytest.raises(ValueError, match=r"^orientation = 'uniform-angle': must be 'isotropic'"):
        first_impact(TURNED["coin"], law, "uniform-angle")
    with pytest.raises(ValueError, match=r"^body = .*restitution varies by 1e-09 at least; here by"):
        first_impact(rs.Ellipsoid(semi_axes=(1e-3, 1e-3, 1e-3)), law)
    with pytest.raises(ValueError, match=r"^body = .*restitution varies by 1e-09 at least; here by"):
        first_impact(rs.Clump(spheres=[(0, 0, 0, 1e-3)]), law)
    with pytest.raises(ValueError, match=r"^release_height"):
        first_impact(box, law, release_height=1.0)
    with pytest.raises(ValueError, match=r"^body = .* one with an axis"):
        first("box", "frictionless").restitution(0.5)
    with pytest.raises(ValueError, match=r"^normal = "):
        first("box", "frictionless").at([0.0, 0.0, 0.0])
