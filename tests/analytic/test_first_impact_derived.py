"""The closed forms of the first impact derived again: by algebra, by other means and with many digits."""

from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp
from numpy.typing import NDArray

import restitution as rs
from reference.arithmetic import mp
from restitution.analytic import first_impact, negative_threshold
from restitution.analytic._branched import BranchedFirstImpact
from restitution.analytic._hull import Ball, Band, Ellipsoid
from restitution.analytic._impulse import Impulse
from restitution.analytic._normal import Fall
from restitution.bodies import Body
from restitution.laws import Law

Floats = NDArray[np.float64]

a, h, j, mu = sp.symbols("a h J mu", positive=True)
e, p = sp.symbols("e p", real=True)

# Speed 1, mass 1: the velocity of the point of contact after an impulse in the plane.
NORMAL, TANGENT = sp.symbols("P_n P_t", real=True)
TWIST = (a * NORMAL + h * TANGENT) / j  # (P × r)/J, counted such that both arms are positive
AFTER = (-1 + NORMAL + a * TWIST, TANGENT + h * TWIST)


def restitution(conditions: list[Any]) -> Any:
    """ε = P_n - 1 of the impulse that fulfils two conditions."""
    solution = sp.solve(conditions, [NORMAL, TANGENT], dict=True)[0]
    return sp.simplify(solution[NORMAL] - 1)


FREE = restitution([AFTER[0] - e, TANGENT])
STUCK = restitution([AFTER[0] - e, AFTER[1]])
SLIDING = restitution([AFTER[0] - e, TANGENT + mu * NORMAL])


def evaluated(law: Law, mode: Any, inertia: float, normal: float, height: float, arm: float) -> float:
    return normal - float(Impulse(law, inertia).loss(mode, normal, height, arm))


def test_every_mode_of_the_contact_solves_the_impulse_equations() -> None:
    """Free, stuck and sliding impulses by algebra, at numbers that have nothing in common."""
    coulomb = rs.Coulomb(normal=0.5, friction=0.3)
    for numbers in ((0.4, 0.7, 1.1, 0.9), (0.05, 0.0, 0.6, 0.2), (1.3, 1.0, 0.31, 1.7)):
        inertia, normal, height, arm = numbers
        at = {j: inertia, e: normal, h: height, a: arm, mu: 0.3}
        for mode, expected in (("free", FREE), ("stuck", STUCK), ("sliding", SLIDING)):
            value = evaluated(coulomb, mode, *numbers)
            assert value == pytest.approx(float(expected.subs(at)), rel=0, abs=2e-15 * (1 + abs(value)))


def test_thresholds_are_where_the_restitution_vanishes() -> None:
    """ε = ε_n - λ = 0 for ε_n at the threshold, in every mode."""
    laws: dict[Any, Law] = {
        "free": rs.Frictionless(normal=0.5),
        "stuck": rs.TangentialRestitution(normal=0.5),
        "sliding": rs.Coulomb(normal=0.5, friction=0.3),
        "part": rs.ChatterjeeRuina(normal=0.5, tangential=0.6, friction=0.3),
    }
    for mode, law in laws.items():
        for inertia, height, arm in ((0.4, 1.1, 0.9), (0.05, 0.6, 0.2), (1.3, 0.31, 1.7)):
            threshold = float(Impulse(law, inertia).threshold(mode, height, arm))
            assert evaluated(law, mode, inertia, threshold, height, arm) == pytest.approx(0.0, abs=4e-15)


HULLS = (
    *(Ball(1.0, -0.6), Ball(0.7, 0.9), Ellipsoid(1.0, 3.0), Ellipsoid(3.0, 1.0)),
    *(Band(0.0, -0.6, 0.8), Band(2.0, 0.3, -0.5)),
)


@pytest.mark.parametrize("hull", HULLS)
def test_the_angle_follows_from_the_height(hull: Any) -> None:
    """And there is none for heights that a body never has, or always."""
    for theta in (0.0, 0.3, 1.1, 1.5):
        height, _ = hull.contact(np.sin(theta), np.cos(theta))
        found = hull.cosines(float(height))
        assert min(abs(cosine - np.cos(theta)) for cosine in found) < 1e-13
    assert all(abs(cosine) > 1.0 for cosine in hull.cosines(3.1))
    assert Ball(1.0, 0.0).cosines(1.0) == Band(1.0, 0.0, 0.0).cosines(1.0) == ()
    assert Ellipsoid(1.0, 1.0).cosines(1.0) == ()


def test_coulomb_sticks_or_slides_from_the_start_and_either_way_loses() -> None:
    """Friction that sticking needs is P_t/P_n = ah/(J + h²); at that limit both modes agree; ε <= ε_n."""
    solution = sp.solve([AFTER[0] - e, AFTER[1]], [NORMAL, TANGENT], dict=True)[0]
    needed = sp.simplify(-solution[TANGENT] / solution[NORMAL])
    assert sp.simplify(needed - a * h / (j + h**2)) == 0
    assert sp.simplify(SLIDING.subs(mu, needed) - STUCK) == 0
    # Sliding, μ < ah/(J + h²), the loss (1 + e)(a² - μah)/(J + a² - μah) has a² - μah > a²J/(J + h²).
    assert sp.simplify(a**2 - needed * a * h - a**2 * j / (j + h**2)) == 0
    assert sp.simplify(e - SLIDING - (1 + e) * (a**2 - mu * a * h) / (j + a**2 - mu * a * h)) == 0


def test_chatterjee_and_ruina_inside_the_cone_and_on_it() -> None:
    """From their definition: (1 + e)P_I + κ(P_II - P_I); on the cone it is Coulomb's sliding contact."""
    kappa = sp.symbols("kappa", real=True)
    frictionless = sp.solve([AFTER[0], TANGENT], [NORMAL, TANGENT], dict=True)[0]
    sticking = sp.solve([AFTER[0], AFTER[1]], [NORMAL, TANGENT], dict=True)[0]
    normal = (1 + e) * frictionless[NORMAL] + kappa * (sticking[NORMAL] - frictionless[NORMAL])
    along = kappa * sticking[TANGENT]
    on_cone = sp.solve(along + mu * normal, kappa)[0]
    assert sp.simplify(normal.subs(kappa, on_cone) - 1 - SLIDING) == 0
    assert sp.simplify(normal.subs(kappa, 1 + e) - 1 - STUCK) == 0
    law = rs.ChatterjeeRuina(normal=0.5, tangential=0.6, friction=0.3)
    for numbers in ((0.4, 0.7, 1.1, 0.9), (0.05, 0.0, 0.6, 0.2), (1.3, 1.0, 0.31, 1.7)):
        at = {j: numbers[0], e: numbers[1], h: numbers[2], a: numbers[3], mu: 0.3, kappa: 1.6}
        assert evaluated(law, "part", *numbers) == pytest.approx(float(normal.subs(at)) - 1, abs=2e-15)
        margin = float(Impulse(law, numbers[0]).margin(*numbers[1:]))
        assert (margin > 0) == (float(-along.subs(at)) > 0.3 * float(normal.subs(at)))
        raised = float(Impulse(law, numbers[0]).raised("part", *numbers[1:]))
        assert (raised > 0) == (float(normal.subs(at)) - 1 > numbers[1])


def test_the_paper_s_thresholds() -> None:
    """L = 2R, J = 7R²/5: ε = 0 at e = a²/(J + h²) = 5/12 and, without friction, a²/J = 5/7."""
    touching = {a: 1, h: 1, j: sp.Rational(7, 5)}
    assert sp.solve(STUCK, e)[0].subs(touching) == sp.Rational(5, 12)
    assert sp.solve(FREE, e)[0].subs(touching) == sp.Rational(5, 7)
    assert sp.simplify(sp.solve(STUCK, e)[0] - a**2 / (j + h**2)) == 0
    assert sp.simplify(sp.solve(FREE, e)[0] - a**2 / j) == 0
    body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    paper, free = rs.TangentialRestitution(normal=0.1), rs.Frictionless(normal=0.1)
    assert negative_threshold(body, paper) == pytest.approx(5 / 12, rel=1e-15)
    assert negative_threshold(body, free) == pytest.approx(5 / 7, rel=1e-15)


PAPER, FREE_LAW = rs.TangentialRestitution(normal=0.1), rs.Frictionless(normal=0.1)


def test_thresholds_of_long_bodies() -> None:
    """Dumbbells reach 1 at L → ∞ only. A spherocylinder passes 1, and goes to 3.

    It passes 1 where L³ - 9L/2 - 16/5 = 0 without friction, and L³ - 21L/2 - 56/5 = 0 under the paper's law,
    L in units of R: L²/4 = J, and L²/4 = J + R².
    """
    length = sp.symbols("L", positive=True)
    mass = sp.Rational(4, 3) + length
    inertia = (sp.Rational(8, 15) + 3 * length / 4 + length**2 / 3 + length**3 / 12) / mass
    assert sp.limit(length**2 / (4 * inertia), length, sp.oo) == 3
    for law, extra, cubic in (
        (FREE_LAW, 0, length**3 - sp.Rational(9, 2) * length - sp.Rational(16, 5)),
        (PAPER, 1, length**3 - sp.Rational(21, 2) * length - sp.Rational(56, 5)),
    ):
        condition = sp.cancel(mass * (length**2 / 4 - inertia - extra))
        assert sp.expand(6 * condition - cubic) == 0
        crossing = max(float(sp.re(root)) for root in sp.Poly(cubic).nroots())
        for factor, beyond in ((1 - 1e-12, False), (1 + 1e-12, True)):
            body = rs.Spherocylinder(radius=1.0, separation=crossing * factor)
            assert (negative_threshold(body, law) > 1) == beyond
    lengths = np.geomspace(1e-3, 1e4, 60)
    for law in (PAPER, FREE_LAW):
        values = [negative_threshold(rs.Dumbbell(radius=1.0, separation=x), law) for x in lengths]
        assert np.all(np.diff(values) > 0)
        assert 1 - 1e-6 < values[-1] < 1


@pytest.mark.parametrize("aspect", [1e-3, 0.1, 0.5, 0.9, 1.1, 2.0, 3.0, 40.0, 1000.0])
def test_thresholds_of_spheroids(aspect: float) -> None:
    """5(k - 1)²/(k² + 1) without friction, and the greatest (y - 1)(k² - y)/(y(J + y)) under the paper's law.

    With y = h² the lever arm is a² = (y - 1)(k² - y)/y, and the maximum is where (J + S)y² = 2k²y + k²J,
    S = 1 + k² = 5J. Oblate and prolate bodies have the same. From k = 2 on, ε < 0 occurs whatever ε_n.
    """
    y, k = sp.symbols("y k", positive=True)
    moment, total = (1 + k**2) / 5, 1 + k**2
    function = (y - 1) * (k**2 - y) / (y * (moment + y))
    numerator = sp.numer(sp.together(sp.diff(function, y)))
    expected = -(moment + total) * y**2 + 2 * k**2 * y + k**2 * moment
    assert sp.simplify(sp.rem(sp.expand(numerator), sp.expand(expected), y)) == 0
    body = rs.Spheroid(equatorial=1.0, polar=aspect)
    assert negative_threshold(body, FREE_LAW) == pytest.approx(
        5 * (aspect - 1) ** 2 / (aspect**2 + 1), rel=2e-14
    )
    inertia, square = (1 + aspect**2) / 5, aspect**2
    top = (square + np.sqrt(square**2 + 6 * square * inertia**2)) / (6 * inertia)
    peak = (top - 1) * (square - top) / (top * (inertia + top))
    assert negative_threshold(body, PAPER) == pytest.approx(peak, rel=1e-12)


@pytest.mark.parametrize(
    "law",
    [
        PAPER,
        FREE_LAW,
        rs.Coulomb(normal=0, friction=0.2),
        rs.ChatterjeeRuina(normal=0, tangential=0.8, friction=0.2),
    ],
    ids=lambda law: type(law).__name__,
)
def test_the_least_restitution_changes_sign_at_the_threshold(law: Law) -> None:
    """The support of the distribution begins below 0 just below the threshold, and at 0 there."""
    bodies: list[Body] = [
        rs.Spheroid(equatorial=1.0, polar=1.6),
        rs.Spheroid(equatorial=1.0, polar=0.6),
        rs.Spherocylinder(radius=1.0, separation=1.7),
        rs.Dumbbell(radius=(1.0, 0.7), separation=0.8),
        rs.LoadedSphere(radius=1.0, load=3e3, offset=0.9),
    ]
    for body in bodies:
        threshold = negative_threshold(body, law)
        assert 0 < threshold < 1
        for shift in (-1e-3, 0.0, 1e-3):
            there = law.model_copy(update={"normal": threshold + shift})
            distribution = first_impact(body, there)
            low, _ = distribution.support()
            assert abs(low) < 4e-16 if shift == 0 else low * shift > 0
            assert (distribution.probability_negative > 0) == (low < 0)


class Curve:
    """ε(θ) of a spheroid in fifty digits and its inverse: a² = (y - A²)(C² - y)/y is quadratic in y = h²."""

    def __init__(self, equatorial: float, polar: float, normal: float, law: str) -> None:
        self.across, self.along = mp.mpf(equatorial) ** 2, mp.mpf(polar) ** 2
        self.inertia, self.normal, self.law = (self.across + self.along) / 5, mp.mpf(normal), law

    def restitution(self, cosine: Any) -> Any:
        y = self.across + (self.along - self.across) * cosine**2
        square = (y - self.across) * (self.along - y) / y
        support = y if self.law == "paper" else 0
        return -1 + (1 + self.normal) * (self.inertia + support) / (self.inertia + support + square)

    def cosines(self, restitution: Any) -> list[Any]:
        """Both cos θ in [0, 1] that give ε: (y - A²)(C² - y) = λ y (J + y), or = λ y J."""
        share = (self.normal - restitution) / (1 + restitution)
        lead = 1 + share if self.law == "paper" else mp.mpf(1)
        linear = share * self.inertia - self.across - self.along
        root = mp.sqrt(linear**2 - 4 * lead * self.across * self.along)
        heights = [(-linear - root) / (2 * lead), (-linear + root) / (2 * lead)]
        return [mp.sqrt((y - self.across) / (self.along - self.across)) for y in heights]

    def below(self, restitution: Any, orientation: str) -> Any:
        """P(ε <= x): that of the cosines between both."""
        one, two = self.cosines(restitution)
        if orientation == "isotropic":
            return abs(one - two)
        return abs(mp.asin(one) - mp.asin(two)) * 2 / mp.pi


@pytest.mark.parametrize("orientation", ["uniform-angle", "isotropic"])
@pytest.mark.parametrize("law", ["paper", "free"])
@pytest.mark.parametrize(("equatorial", "polar"), [(1.0, 3.0), (1.0, 1.05), (1.0, 0.2), (1.0, 100.0)])
def test_spheroids_in_closed_form(equatorial: float, polar: float, law: str, orientation: Any) -> None:
    """Both branches by a quadratic equation: probability, density and quantiles against fifty digits."""
    exact = Curve(equatorial, polar, 0.6, law)
    kind = rs.TangentialRestitution if law == "paper" else rs.Frictionless
    body = rs.Spheroid(equatorial=equatorial, polar=polar)
    distribution = first_impact(body, kind(normal=0.6), orientation)
    low, high = distribution.support()
    x = low + (high - low) * np.array([1e-3, 0.03, 0.2, 0.5, 0.8, 0.97, 0.999])
    probability = [float(exact.below(mp.mpf(v), orientation)) for v in x]
    density = [float(mp.diff(lambda s: exact.below(s, orientation), mp.mpf(v))) for v in x]
    # ε is rounded to an ulp of 1, which the density turns into probability, and its slope into density.
    width = 1e-15 / (high - low)
    np.testing.assert_allclose(distribution.cdf(x), probability, rtol=0, atol=1e3 * width + 1e-14)
    above = 1 - np.array(probability)
    np.testing.assert_allclose(distribution.sf(x), above, rtol=0, atol=1e3 * width + 1e-14)
    np.testing.assert_allclose(distribution.pdf(x), density, rtol=2e4 * width + 1e-12)
    np.testing.assert_allclose(distribution.ppf(probability), x, rtol=0, atol=1e-14)


def by_quadrature(distribution: Any, order: int, orientation: str, cuts: list[float]) -> float:
    """Mean of a power of ε(θ) by tanh-sinh, interval by interval; ε itself is double precision."""
    limit = cuts[-1]

    def integrand(theta: Any) -> float:
        weight = 1 / limit if orientation == "uniform-angle" else np.sin(float(theta)) / (1 - np.cos(limit))
        return float(distribution.restitution(np.cos(float(theta)))) ** order * weight

    with mpmath.workdps(17):
        return float(mpmath.quad(integrand, cuts, maxdegree=7))


GLASS = rs.Viscoelastic(young_modulus=1e7, poisson_ratio=0.3, dissipation=1e-3, density=1000.0, radius=0.01)
FALL = {"release_height": 4.0, "gravity": 9.81}


@pytest.mark.parametrize("orientation", ["uniform-angle", "isotropic"])
@pytest.mark.parametrize(
    ("body", "law", "fall"),
    [
        (rs.Spheroid(equatorial=1.0, polar=3.0), rs.Frictionless(normal=0.9), {}),
        (rs.Spheroid(equatorial=1.0, polar=0.1), rs.TangentialRestitution(normal=0.4), {}),
        (rs.LoadedSphere(radius=1.0, load=8e3, offset=0.9), rs.Coulomb(normal=0.4, friction=0.1), {}),
        (
            rs.Spherocylinder(radius=1.0, separation=3.0),
            rs.ChatterjeeRuina(normal=0.5, tangential=1, friction=0.4),
            {},
        ),
        (rs.Spheroid(equatorial=1.0, polar=3.0), rs.Coulomb(normal=GLASS, friction=0.3), FALL),
        (
            rs.Dumbbell(radius=(1.0, 0.5), separation=2.0),
            rs.Frictionless(normal=rs.Plastic(yield_speed=7.0)),
            FALL,
        ),
    ],
    ids=["prolate", "oblate", "loaded", "capsule", "glass", "plastic"],
)
def test_moments_are_exact_to_rounding(body: Body, law: Law, fall: dict[str, Any], orientation: Any) -> None:
    """Against tanh-sinh quadrature between the angles at which the formula changes."""
    distribution: Any = first_impact(body, law, orientation, **fall)
    cuts = [0.0, *(piece.high for piece in distribution._curve.pieces)]
    for order in (0, 1, 2, 3, 12):
        expected = by_quadrature(distribution, order, orientation, cuts)
        assert distribution.moment(order) == pytest.approx(expected, rel=0, abs=3e-15)
    mean, square = distribution.moment(1), distribution.moment(2)
    assert distribution.mean() == mean
    assert distribution.var() == pytest.approx(square - mean**2, abs=1e-14)
    skewness, kurtosis = distribution.stats("sk")
    third, fourth = distribution.moment(3), distribution.moment(4)
    central = third - 3 * mean * square + 2 * mean**3
    assert skewness * distribution.std() ** 3 == pytest.approx(central, abs=1e-14)
    central = fourth - 4 * mean * third + 6 * mean**2 * square - 3 * mean**4
    assert kurtosis * distribution.var() ** 2 == pytest.approx(central, abs=1e-14)


@pytest.mark.parametrize("orientation", ["uniform-angle", "isotropic"])
@pytest.mark.parametrize("kind", [rs.Dumbbell, rs.Spherocylinder])
@pytest.mark.parametrize("elongation", [0.3, 2.0, 30.0, 1e4])
@pytest.mark.parametrize("law", [rs.TangentialRestitution(normal=0.6), rs.Frictionless(normal=0.6)])
def test_two_ways_to_the_same_distribution(law: Law, elongation: float, kind: Any, orientation: Any) -> None:
    """Two equal balls have an elementary inverse; the general way, by branches, gives the same."""
    body = kind(radius=1.0, separation=elongation)
    fall = Fall(release_height=3.0 + elongation, gravity=1.0)
    direct, general = first_impact(body, law, orientation), BranchedFirstImpact(body, law, orientation, fall)
    assert general.support() == pytest.approx(direct.support(), abs=1e-15)
    x = direct.ppf(np.linspace(0.01, 0.99, 50))
    np.testing.assert_allclose(general.cdf(x), direct.cdf(x), rtol=0, atol=1e-13)
    # Near an end, p goes as the root of the distance to it, and that is known to an ulp of x and of the end.
    known = 1e-13 + 2.0**-52 / np.min(np.abs(np.subtract.outer(x, direct.support())), axis=1)
    assert np.all(np.abs(general.pdf(x) / direct.pdf(x) - 1.0) <= known)
    np.testing.assert_allclose(general.ppf(direct.cdf(x)), x, rtol=0, atol=1e-14)
    np.testing.assert_allclose(general.cos_theta(x), direct.cos_theta(x), rtol=0, atol=1e-13)
    for order in (1, 2, 7, 20):
        assert general.moment(order) == pytest.approx(direct.moment(order), rel=0, abs=1e-15)
    assert general.std() == pytest.approx(direct.std(), rel=1e-14)
    assert general.stats("sk") == pytest.approx(direct.stats("sk"), rel=0, abs=1e-12)
    assert general.entropy() == pytest.approx(direct.entropy(), abs=1e-7)


def test_a_nearly_spherical_body_without_friction() -> None:
    """As L → 0 the loss goes to w sin²θ, w = (1 + ε_n)L²/(4J) with J = 2R²/5; σ keeps its digits."""
    for kind in (rs.Dumbbell, rs.Spherocylinder):
        body, w = kind(radius=1.0, separation=1e-9), 1.6 * 1e-18 / 1.6
        for orientation, share in (("uniform-angle", np.sqrt(1 / 8)), ("isotropic", np.sqrt(4 / 45))):
            distribution = first_impact(body, rs.Frictionless(normal=0.6), orientation)  # type: ignore[arg-type]
            assert distribution.std() == pytest.approx(w * share, rel=3e-9)


def test_sympy_integrates_the_loaded_sphere() -> None:
    """Isotropic axis, no friction, ε_n = 0: the mean of 1 + ε = J/(J + s²(1 - c²)) over c.

    It is J artanh(s/q)/(sq) with q = √(J + s²).
    """
    c, s = sp.symbols("c s", positive=True)
    body = rs.LoadedSphere(radius=1.0, load=8e3, offset=0.9)
    inertia, place = body.transverse_inertia / body.mass, body.centre_of_mass
    root = sp.sqrt(j + s**2)
    formula = j / (s * root) * sp.atanh(s / root)
    assert sp.simplify(sp.diff(j / (s * root) * sp.atanh(s * c / root), c) - j / (j + s**2 * (1 - c**2))) == 0
    distribution = first_impact(body, rs.Frictionless(normal=0.0), "isotropic")
    expected = float(formula.subs({j: inertia, s: place})) - 1
    assert distribution.mean() == pytest.approx(expected, rel=4e-15)
