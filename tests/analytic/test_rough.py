"""Rough spheres: contacts, p(ε | v) and the spin they gather, against spheres that fall and spin.

`reference.rough` finds contacts on a grid of times and solves impulses as linear systems. Where a test takes
five standard errors its false alarms have a probability of 6e-7; Kolmogorov tests have 1e-5.
"""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad
from scipy.stats import kstest

import restitution as rs
from reference.rough import Rough, hits, rebound
from restitution.analytic import RoughContact, rough_contact, rough_impact, rough_spin

SMOOTH = rs.Frictionless(normal=0.9)
PAPER = rs.TangentialRestitution(normal=0.9)
RARE = 1e-5


def spins(number: int, deviation: float, seed: int) -> NDArray[np.float64]:
    random = np.random.default_rng(seed).normal(0.0, deviation, (number, 3))
    random[:, 2] = 0.0
    return random


def contact_of(body: Rough) -> RoughContact:
    how = {"mean_height": body.height} if body.exponential else {"height": body.height}
    return rough_contact(radius=1.0, asperities=body.asperities, asperity_radius=body.asperity_radius, **how)


@pytest.mark.parametrize("number", [1, 3, 100, 10_000])
def test_the_angle_of_the_contact(number: int) -> None:
    """(1): P(cos a < x) = ((1 + x)/2)^N of an asperity, given that the sphere itself does not touch; (3)."""
    body = Rough(number, 0.3, 0.3 if number < 100 else 0.02)
    met = hits(body, np.zeros((3000, 3)), seed=number)
    centre = 1.0 + body.height - body.asperity_radius
    cosine = (-met.arm[~met.itself, 2] - body.asperity_radius) / centre
    exact = contact_of(body)
    assert abs(met.itself.mean() - exact.sphere) <= 5.0 * np.sqrt(exact.sphere / 3000)
    assert exact.sphere == pytest.approx((1.0 - body.height / (2.0 * centre)) ** number)
    found = kstest(cosine, lambda x: (((1 + x) / 2) ** number - exact.sphere) / (1.0 - exact.sphere))
    assert found.pvalue > RARE


@pytest.mark.parametrize(("number", "height"), [(1, 0.1), (7, 0.02), (1000, 0.3), (10**6, 1e-5)])
def test_the_mean_square_by_quadrature(number: int, height: float) -> None:
    """(2) is the integral of sin² a over (1), down to where the sphere touches."""
    body = Rough(number, 0.4, height)
    least = 1.0 - height / (1.0 + height - 0.4)
    integral, _ = quad(
        lambda t: (1 - (1 - t) ** 2) * number / 2 * (1 - t / 2) ** (number - 1),
        0.0,
        1.0 - least,
        points=[min(1.0 - least, 10.0 / number)],
        epsabs=0.0,
        limit=200,
    )
    assert contact_of(body).mean_square == pytest.approx(integral, rel=1e-9)
    every = rough_contact(radius=1.0, asperities=number, asperity_radius=0.6, height=1.2)
    if every.sphere == 0.0:
        assert every.mean_square == pytest.approx(4 * number / ((number + 1) * (number + 2)))


@pytest.mark.parametrize("number", [1000, 20_000])
def test_exponential_heights(number: int) -> None:
    """(4), (5): R a²/2 of an asperity that touches is exponential with the mean height, whatever N."""
    body = Rough(number, 0.05, 1e-3, exponential=True)
    met = hits(body, np.zeros((1000, 3)), seed=number)
    exact = contact_of(body)
    assert abs(met.itself.mean() - exact.sphere) <= 5.0 * np.sqrt(exact.sphere / 1000)
    square = met.arm[:, 0] ** 2 + met.arm[:, 1] ** 2
    error = square.std() / np.sqrt(square.size)
    assert abs(square.mean() - exact.mean_square) < 5.0 * error + 10.0 * body.height * exact.mean_square
    assert kstest(square[~met.itself] / (2.0 * body.height), "expon").pvalue > RARE


def lowest(number: float, draw: Any, reach: float, spheres: int, seed: int) -> NDArray[np.float64]:
    """Return R a²/2 of the asperity that reaches lowest and its level -g, in units of R; shape (spheres, 2).

    At rest: a Poisson process of areas, N/2 to the unit, each with a height.
    """
    random = np.random.default_rng(seed)
    found = []
    for _ in range(spheres):
        area = random.uniform(0.0, reach, random.poisson(0.5 * number * reach))
        level = draw(random, area.size) - area
        found.append((area[level.argmax()], level.max()))
    return np.array(found)


def test_normal_heights() -> None:
    """They scatter as exponential ones of the height h_0 of docs/rough.md do, which is 3 % too much here."""
    s, number, spheres = 1e-3, 1e5, 2000
    area, _ = lowest(number, lambda random, n: random.normal(0.0, s, n), 4e-3, spheres, 5).T
    height = s
    for _ in range(50):
        height = s / np.sqrt(2.0 * np.log(0.5 * number * height))
    assert abs(area.mean() - height / 1.026) < 5.0 * area.std() / np.sqrt(spheres)


def test_heights_of_a_power_law() -> None:
    """P(h > t) = (t/t_0)^-α: the excess over the level is Pareto's, and the level grows as N^(1/(α - 1))."""
    exponent, least, spheres = 4.0, 1e-4, 1500
    levels = []
    for number in (3e5, 3e6):
        draw = lambda random, n: least * random.random(n) ** (-1.0 / exponent)  # noqa: E731
        area, level = lowest(number, draw, 5e-3, spheres, 6).T
        assert kstest(area / level, lambda x: 1.0 - (1.0 + x) ** -exponent).pvalue > RARE
        levels.append(level)
    ratio = np.log(np.mean(levels[1]) / np.mean(levels[0])) / np.log(10.0)
    error = np.hypot(*(one.std() / one.mean() for one in levels)) / np.sqrt(spheres) / np.log(10.0)
    assert abs(ratio - 1.0 / (exponent - 1.0)) < 5.0 * error


@pytest.mark.parametrize(("law", "tangential"), [(SMOOTH, None), (PAPER, 1.0)])
def test_a_given_spin_shifts_the_mean_and_hardly_skews(law: Any, tangential: float | None) -> None:
    """(7), (8) at fixed ω: mean, σ and third moment, where the flux would skew if the loss did not."""
    body, ratio, number = Rough(10_000, 0.01, 0.01), 4.0, 8_000
    spin = np.zeros((number, 3))
    spin[:, 0] = ratio
    kappa = 2.5 if tangential is None else 1.0 / 1.4
    q, loss = ratio * np.sqrt(2.0 / body.asperities), 2.0 * kappa / body.asperities
    e, _ = rebound(body, hits(body, spin, seed=11), law.normal, tangential)
    y = (e - law.normal) / (1.0 + law.normal)
    assert abs(y.mean() - (q**2 - 2.0 * loss)) < 5.0 * y.std() / np.sqrt(number) + 3.0 * q**4
    assert abs(y.std() / q - 1.0) < 5.0 / np.sqrt(2.0 * number) + q**2
    third = ((y - y.mean()) ** 3).mean() / q**3
    assert abs(third + 6.0 * loss / q) < 5.0 * np.sqrt(15.0 / number) + 3.0 * q**3


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    ("ratio", "law", "tangential"), [(0.5, SMOOTH, None), (1.0, PAPER, 1.0), (3.0, SMOOTH, None)]
)
def test_gaussian_spins_make_an_asymmetric_laplace_density(
    ratio: float, law: Any, tangential: float | None, seed: int
) -> None:
    """(11): a Kolmogorov test of 2000 impacts of moving spheres, and mean and σ to five standard errors."""
    body, number = Rough(10_000, 0.01, 0.01), 2000
    e, _ = rebound(body, hits(body, spins(number, ratio, seed), seed), law.normal, tangential)
    exact = rough_impact(law, contact_of(body), speed=1.0, spin=ratio, radius=1.0)
    assert abs(e.mean() - exact.mean()) < 5.0 * e.std() / np.sqrt(number)
    assert abs(e.std() / exact.std() - 1.0) < 5.0 * np.sqrt(5.0 / (4.0 * number))  # kurtosis 6
    assert kstest(e, exact.cdf).pvalue > RARE


def test_the_flank_of_spinning_spheres_is_longer_above() -> None:
    """The sign of the asymmetry: spin that is fast against the fall, J<ω²>/2 over mv²; and its absence."""
    body, number = Rough(10_000, 0.01, 0.01), 2_500
    contact = contact_of(body)
    fast = rough_impact(SMOOTH, contact, speed=1.0, spin=8.0, radius=1.0)
    slow = rough_impact(SMOOTH, contact, speed=1.0, spin=0.5, radius=1.0)
    balanced = rough_impact(SMOOTH, contact, speed=1.0, spin=np.sqrt(2.5), radius=1.0)
    assert fast.stats("s") > 0.2 > -0.2 > slow.stats("s")
    assert balanced.stats("s") == pytest.approx(0.0, abs=1e-9)
    e, _ = rebound(body, hits(body, spins(number, 8.0, 5), 5), 0.9, None)
    share = (e > 0.9).mean()  # P(ε > ε_n) = a/(a + b), 0.5 for a density that is not shifted
    assert share - 0.5 > 5.0 * 0.5 / np.sqrt(number)
    assert abs(share - fast.sf(0.9)) < 5.0 * 0.5 / np.sqrt(number)


def test_without_spin_it_is_a_one_sided_exponential() -> None:
    """(6): <ε_n - ε> = (1 + ε_n) κ <sin² a>, and ε from rest of 4000 spheres."""
    body = Rough(10_000, 0.01, 0.01)
    exact = rough_impact(PAPER, contact_of(body), speed=1.0, spin=0.0, radius=1.0)
    assert 0.9 - exact.mean() == pytest.approx(1.9 / 1.4 * 4.0 / 10_000, rel=1e-3)
    assert exact.sf(0.9) < 1e-5
    e, _ = rebound(body, hits(body, np.zeros((4000, 3)), 3), 0.9, 1.0)
    assert kstest(0.9 - e, lambda x: 1.0 - exact.cdf(0.9 - x)).pvalue > RARE


@pytest.mark.parametrize(("law", "tangential"), [(SMOOTH, None), (PAPER, 1.0)])
def test_the_spin_gathered_since_the_release(law: Any, tangential: float | None) -> None:
    """(12): kicks of eight impacts of 1000 spheres, each impact at speed 1 in units of its own."""
    body, number, impacts = Rough(100_000, 0.003, 0.003), 1000, 8
    spin = np.zeros((number, 3))
    for impact in range(impacts):
        _, spin = rebound(body, hits(body, spin, 40 + impact), law.normal, tangential)
        spin /= law.normal  # of the next impact, whose speed is ε_n times this one's
        spin[:, 2] = 0.0
    how = {"speed": law.normal**impacts, "release_speed": 1.0, "radius": 1.0}
    exact = rough_spin(law, contact_of(body), **how) / law.normal**impacts
    found = np.sqrt(0.5 * np.mean(spin[:, 0] ** 2 + spin[:, 1] ** 2))
    assert abs(found / exact - 1.0) < 5.0 / np.sqrt(4.0 * number) + 1e-3


def test_a_spin_is_braked_by_its_own_contacts() -> None:
    """(12), its γ: what 8000 spheres that spin as fast as they fall keep of ω, to five standard errors."""
    body, number = Rough(3000, 0.02, 0.02), 8000
    spin = np.zeros((number, 3))
    spin[:, 0] = 3.0
    _, after = rebound(body, hits(body, spin, 90), 0.9, None)
    lost = 1.0 - after[:, 0] / 3.0
    gamma = 2.5 * 1.9 * 4.0 / 3000
    assert abs(lost.mean() - gamma) < 5.0 * lost.std() / np.sqrt(number) + 0.05 * gamma


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"asperities": 0}, "asperities = 0: must be a whole number in"),
        ({"asperity_radius": 2.0}, "asperity_radius = 2.0: must be in"),
        ({"height": -0.1}, "height = -0.1: must be in"),
        ({"height": None}, "height: missing"),
        ({"mean_height": 1e-3}, "mean_height = 0.001: must be left out"),
        ({"height": None, "mean_height": 0.1}, "mean_height = 0.1: must be in"),
        ({"radius": -1.0}, "radius = -1.0"),
    ],
)
def test_bad_contacts(change: dict[str, Any], text: str) -> None:
    good = {"radius": 1.0, "asperities": 100, "asperity_radius": 0.1, "height": 0.1}
    with pytest.raises(ValueError, match=text):
        rough_contact(**(good | change))


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"law": rs.Coulomb(normal=0.9, friction=0.1)}, "law = "),
        ({"law": rs.TangentialRestitution(normal=0.9, tangential=0.5)}, "law = "),
        ({"contact": 0.1}, "contact = 0.1"),
        ({"contact": RoughContact(mean_square=0.1, sphere=0.5)}, "contact = "),
        ({"speed": 0.0}, "speed = 0.0"),
        ({"spin": -1.0}, "spin = -1.0"),
        ({"spin": 1e9}, "spin = 1000000000.0: must be such that the density is narrow"),
        ({"inertia": 1.0}, "inertia = 1.0"),
    ],
)
def test_bad_impacts(change: dict[str, Any], text: str) -> None:
    good: dict[str, Any] = {
        "law": SMOOTH,
        "contact": RoughContact(mean_square=1e-4, sphere=0.0),
        "speed": 1.0,
        "spin": 1.0,
        "radius": 1.0,
    }
    with pytest.raises(ValueError, match=text):
        rough_impact(**(good | change))


def test_bad_falls() -> None:
    contact = RoughContact(mean_square=1e-4, sphere=0.0)
    with pytest.raises(ValueError, match=r"contact = .*: must be one with mean_square below 0.0947"):
        rough_spin(
            SMOOTH, RoughContact(mean_square=0.2, sphere=0.0), speed=0.5, release_speed=1.0, radius=1.0
        )
    with pytest.raises(ValueError, match=r"speed = 2.0: must be in \(0, 1.0\]"):
        rough_spin(SMOOTH, contact, speed=2.0, release_speed=1.0, radius=1.0)
    with pytest.raises(ValueError, match="law = "):
        rough_spin(rs.Frictionless(normal=1.0), contact, speed=0.5, release_speed=1.0, radius=1.0)


ROUGH = {"radius": 1.0, "asperities": 2000, "asperity_radius": 0.05, "heights": 0.01}
LAWS = [
    (SMOOTH, None),
    (PAPER, 1.0),
    (rs.Coulomb(normal=0.9, friction=0.3), 1.0),
    (rs.ChatterjeeRuina(normal=0.9, tangential=0.9, friction=0.3), 1.0),
]


@pytest.mark.parametrize(
    ("number", "height", "law", "tangential"),
    # At the large angles of few asperities friction reaches its limit.
    [(4, 0.1, *law) for law in LAWS[:2]] + [(300, 0.02, *law) for law in LAWS] + [(2000, 0.01, *LAWS[0])],
)
def test_the_first_impact_of_rough_spheres(
    number: int, height: float, law: Any, tangential: float | None
) -> None:
    """Spheres at rest over the plane, some of which touch themselves: the law of large angles, too."""
    body = rs.RoughSphere(**(ROUGH | {"asperities": number, "heights": height}))
    exact: Any = rs.analytic.first_impact(body, law)
    met = hits(Rough(number, 0.05, height), np.zeros((2000, 3)), 70 + number)
    e, _ = rebound(Rough(number, 0.05, height), met, 0.9, tangential)
    assert abs(e.mean() - exact.mean()) < 5.0 * e.std() / np.sqrt(e.size) + 1e-12
    low, high = exact.support()
    assert low - 1e-12 < e.min() <= e.max() < high + 1e-12
    assert abs((e > 0.9 - 1e-12).mean() - exact._sphere) < 5.0 * np.sqrt(exact._sphere / e.size) + 1e-3
    rest = np.where(e > 0.9 - 1e-12, 0.9, e)
    assert kstest(rest[rest < 0.9], lambda x: exact.cdf(x) / (1.0 - exact._sphere)).pvalue > RARE


@pytest.mark.parametrize("number", [1, 30, 10**4, 10**5])
@pytest.mark.parametrize("law", [one for one, _ in LAWS])
def test_the_methods_of_a_first_impact_agree(number: int, law: Any) -> None:
    """Moments are those of the quantiles; density, quantile and draws are of one distribution."""
    exact = rs.analytic.first_impact(rs.RoughSphere(**(ROUGH | {"asperities": number})), law)
    t, weight = np.polynomial.legendre.leggauss(400)
    u = 0.5 * (1.0 + t)
    e = exact.ppf(u)
    mean = float(0.5 * weight @ e)
    assert exact.mean() == pytest.approx(mean, rel=1e-5)
    assert 0.9 - exact.mean() == pytest.approx(0.9 - mean, rel=2e-2)
    inside = e[(e < exact.support()[1] - 1e-14) & (e > exact.support()[0])][20::80]
    if inside.size:
        step = 1e-4 * (exact.support()[1] - inside)
        slope = (exact.cdf(inside + step) - exact.cdf(inside - step)) / (2.0 * step)
        assert exact.pdf(inside) == pytest.approx(slope, rel=1e-4)
        assert exact.cdf(inside) + exact.sf(inside) == pytest.approx(1.0)
    draws = exact.rvs(size=4000, random_state=1)
    assert abs(draws.mean() - exact.mean()) < 5.0 * exact.std() / np.sqrt(4000) + 1e-12
    assert exact.expect() == pytest.approx(exact.mean(), rel=1e-6)
    assert exact.stats("v")[0] == pytest.approx(exact.std() ** 2)


def test_many_asperities_make_the_one_sided_exponential() -> None:
    """(6): mean and deviation of the loss are both (1 + ε_n) κ 4/N."""
    exact = rs.analytic.first_impact(rs.RoughSphere(**(ROUGH | {"asperities": 10**6})), SMOOTH)
    centre = 1.0 + 0.01 - 0.05
    loss = 1.9 * 2.5 * centre**2 * 4e-6
    assert 0.9 - exact.mean() == pytest.approx(loss, rel=1e-4)
    assert exact.std() == pytest.approx(loss, rel=1e-4)
    assert exact.entropy() == pytest.approx(1.0 + np.log(loss), rel=1e-4)
    assert exact.stats("sk") == pytest.approx((-2.0, 9.0), rel=1e-3)


def test_material_and_threshold_of_a_rough_sphere() -> None:
    body = rs.RoughSphere(**(ROUGH | {"asperities": 50}))
    material = rs.Plastic(yield_speed=0.5)
    plastic = rs.Frictionless(normal=material)
    fast = rs.analytic.first_impact(body, plastic, release_height=3.0, gravity=9.81)
    assert fast.support()[1] == pytest.approx(material(np.sqrt(2 * 9.81 * 2.0)), rel=0.01)
    # Without friction a²/J at the greatest angle, where the sphere touches too: cos a = 1 - h/R_c.
    threshold = 0.96**2 * (1.0 - (1.0 - 0.01 / 0.96) ** 2) / 0.4
    assert rs.analytic.negative_threshold(body, SMOOTH) == pytest.approx(threshold)
    with pytest.raises(ValueError, match=r"body\.heights = "):
        rs.analytic.first_impact(rs.RoughSphere(**(ROUGH | {"heights": ("exponential", 0.01)})), SMOOTH)


def test_the_first_impact_of_one_surface_or_of_any() -> None:
    """Two surfaces differ from their mean, and this one is as 20,000 falls say; any surface has no seed."""
    how: dict[str, Any] = {"radius": 3e-3, "asperities": 30, "asperity_radius": 3e-4}
    first, second = (rs.RoughSphere(**how, seed=seed) for seed in (2, 3))
    own = rs.analytic.first_impact(first, SMOOTH, surface="own")
    every = rs.analytic.first_impact(first, SMOOTH)
    assert every.mean() == rs.analytic.first_impact(second, SMOOTH).mean()
    assert "seed" not in repr(every)
    assert "seed=2" in repr(own)
    fallen = rs.simulate(first, SMOOTH, particles=20_000, impacts=1).restitution.values.ravel()
    error = fallen.std() / np.sqrt(fallen.size)
    assert abs(fallen.mean() - own.mean()) < 4.0 * error < abs(fallen.mean() - every.mean())
    with pytest.raises(ValueError, match="surface = 'all': must be 'any' or 'own'"):
        rs.analytic.first_impact(first, SMOOTH, surface="all")  # type: ignore[arg-type]
