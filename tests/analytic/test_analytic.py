"""The distribution of ε at the first impact: held to Eq. 10, fifty digits and chance.

The reference values come from sources that share nothing with `restitution.analytic` but the paper: Eq. 10
solved as a linear system in three dimensions, Eq. 17 evaluated with fifty digits on an inertia that is
integrated over the slices of the body, and Eqs. 21 and 22 with their misprints corrected.
"""

from typing import Any

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy import stats

import restitution as rs
from reference.arithmetic import Real, mp
from reference.top import Body
from restitution.analytic import FirstImpact, first_impact

Floats = NDArray[np.float64]

LAWS = ("uniform-angle", "isotropic")
ELONGATIONS = (1e-3, 0.1, 1.0, 2.0, 3.5, 50.0)  # L/R on both sides of 2, where the spheres come apart
ULP = float(np.finfo(float).eps)


def make(elongation: float, normal: float, orientation: Any = "uniform-angle") -> FirstImpact:
    body = rs.Dumbbell(radius=1.0, separation=elongation)
    return first_impact(body, rs.TangentialRestitution(normal=normal), orientation)


FIG_9 = {law: make(2.0, 0.4, law) for law in LAWS}


class Exact:
    """Eqs. 17 and 18 with fifty digits."""

    def __init__(self, elongation: float, normal: float, orientation: str) -> None:
        self.inertia = Body.dumbbell(1.0, elongation).transverse
        self.length, self.normal, self.orientation = mp.mpf(elongation), mp.mpf(normal), orientation

    def restitution(self, c: Real) -> Real:  # (17), R = 1
        top = 4 * self.inertia + self.length**2 * c**2 + 4 * self.length * c + 4
        return -1 + (1 + self.normal) * top / (4 * self.inertia + 4 * self.length * c + 4 + self.length**2)

    def cosine(self, q: Real) -> Real:
        return mp.sin(mp.pi * q / 2) if self.orientation == "uniform-angle" else q

    def mean(self, function: Any) -> Real:
        return mp.quadgl(lambda q: function(self.restitution(self.cosine(q))), [0, 0.5, 1])

    def slope(self, s: Real) -> tuple[Real, Real]:
        """The cosine h⁻¹(s), and its derivative: Eq. 21 with 2R² in its bracket."""
        k, e = 1 + self.normal, self.normal
        f = mp.sqrt(4 * (s - e) * ((s + 1) + k * self.inertia) + k * (s + 1) * self.length**2)  # (22)
        c = (2 * (s - e) + f) / (k * self.length)
        bracket = k * (4 * self.inertia + self.length**2) / 2 + 2 * (2 * s - e + 1)
        return c, (2 * f + bracket) / (f * k * self.length)

    def density(self, s: Real) -> Real:
        """Eq. 21 with the factor 2 for the uniform angle; p_c = 1 instead of 2/(π sin θ) if isotropic."""
        c, slope = self.slope(s)
        return slope * (2 / (mp.pi * mp.sqrt(1 - c**2)) if self.orientation == "uniform-angle" else 1)


def solve_eq_10(
    body: rs.Dumbbell, axis: Floats, velocity: Floats, spin: Floats, normal: float, tangential: Floats
) -> Floats:
    """P/m of n contacts of the lower sphere, shape (n, 3): Eqs. 6–10 as linear systems in space."""
    up = np.array([0.0, 0.0, 1.0])
    axis = np.where(axis[:, 2:] > 0, -axis, axis)  # towards the lower sphere
    contact = 0.5 * body.separation * axis - body.radius * up  # (6)
    unit, along = np.eye(3), axis[:, :, None] * axis[:, None, :]
    inverse = (unit - along) * body.mass / body.transverse_inertia + along * body.mass / body.axial_inertia
    at_contact = velocity + np.cross(spin, contact)  # (7)
    normal_part = at_contact[:, 2:] * up  # (8)
    change = -(1 + normal) * normal_part + (tangential[:, None] - 1) * (at_contact - normal_part)
    cross = np.cross(contact[:, None, :], unit, axisb=1)  # row k: r_c × e_k
    twist = np.einsum("nij,nkj->nki", inverse, cross)
    matrix = unit + np.swapaxes(np.cross(twist, contact[:, None, :]), 1, 2)  # right side of (10)
    return np.asarray(np.linalg.solve(matrix, change[..., None])[..., 0], dtype=np.float64)


def first_restitution(
    body: rs.Dumbbell, axis: Floats, normal: float, tangential: Floats, speed: float = 0.7
) -> Floats:
    velocity = np.tile([0.0, 0.0, -speed], (len(axis), 1))
    impulse = solve_eq_10(body, axis, velocity, np.zeros_like(velocity), normal, tangential)
    return np.asarray(-(velocity + impulse)[:, 2] / velocity[:, 2])  # (1), (11)


def random_axes(orientation: str, count: int, rng: np.random.Generator) -> Floats:
    if orientation == "isotropic":
        vector = rng.normal(size=(count, 3))
        return np.asarray(vector / np.linalg.norm(vector, axis=1, keepdims=True))
    theta, azimuth = rng.uniform(0, np.pi, count), rng.uniform(0, 2 * np.pi, count)
    sine = np.sin(theta)
    return np.stack([sine * np.cos(azimuth), sine * np.sin(azimuth), np.cos(theta)], axis=1)


@pytest.mark.parametrize("elongation", ELONGATIONS)
def test_the_angle_gives_what_eq_10_gives_whatever_the_tangential_coefficient(elongation: float) -> None:
    """From rest the contact point moves along n, so that ε_t, drawn at random here, has nothing to act on."""
    rng = np.random.default_rng(1)
    body = rs.Dumbbell(radius=0.7, separation=0.7 * elongation, density=3.0)
    axes, tangential = random_axes("isotropic", 500, rng), rng.uniform(-1, 1, 500)
    for normal in (0.0, 0.4, 1.0):
        distribution = first_impact(body, rs.TangentialRestitution(normal=normal, tangential=-0.3))
        expected = first_restitution(body, axes, normal, tangential)
        # The condition number of Eq. 10 is at most about 1 + mr_c²/J_zz, and J_zz is 0.4 mR² or less.
        rounding = 4 * ULP * (1 + (1 + elongation / 2) ** 2 / 0.4)
        np.testing.assert_allclose(distribution.restitution(axes[:, 2]), expected, rtol=0, atol=rounding)


@pytest.mark.parametrize("orientation", LAWS)
@pytest.mark.parametrize(("elongation", "normal"), [(0.1, 0.98), (2.0, 0.4), (5.0, 0.7)])
def test_random_bodies_follow_the_distribution(orientation: str, elongation: float, normal: float) -> None:
    """Kolmogorov–Smirnov, 20 000 orientations through Eq. 10; false alarm of the six tests: once in 1e6."""
    body = rs.Dumbbell(radius=1.0, separation=elongation)
    axes = random_axes(orientation, 20_000, np.random.default_rng(2))
    drawn = first_restitution(body, axes, normal, np.ones(len(axes)))
    assert stats.kstest(drawn, make(elongation, normal, orientation).cdf).pvalue > 1e-6 / 6


@pytest.mark.parametrize("orientation", LAWS)
@pytest.mark.parametrize("elongation", [0.3, 2.0, 3.0])
def test_the_simulated_first_impacts_are_these(elongation: float, orientation: Any) -> None:
    """Each at its recorded angle to rounding, and all of them as a sample; false alarm of the six: 1e-6."""
    distribution = make(elongation, 0.4, orientation)
    how: dict[str, Any] = {"release_height": 20.0, "orientation": orientation, "seed": 3}
    data = rs.simulate(distribution.body, distribution.law, particles=20_000, impacts=1, **how)
    drawn, angle = data["restitution"].to_numpy()[:, 0], data["angle"].to_numpy()[:, 0]
    np.testing.assert_allclose(drawn, distribution.restitution(np.cos(angle)), rtol=0, atol=8 * ULP)
    assert stats.kstest(drawn, distribution.cdf).pvalue > 1e-6 / 6


def test_the_wrong_distribution_would_be_noticed() -> None:
    """The test above has power: with a tenth of its sample it tells one law of the angle from the other."""
    axes = random_axes("isotropic", 2_000, np.random.default_rng(3))
    drawn = first_restitution(rs.Dumbbell(radius=1.0, separation=2.0), axes, 0.4, np.ones(len(axes)))
    assert stats.kstest(drawn, FIG_9["isotropic"].cdf).pvalue > 1e-6
    assert stats.kstest(drawn, FIG_9["uniform-angle"].cdf).pvalue < 1e-20


def test_restitution_rises_strictly_with_the_cosine() -> None:
    """Symbolically, for every parameter: dh/dc is a positive factor times bc² + 2c + b, b > 0."""
    c, inertia, length, radius, k = sp.symbols("c j L R k", positive=True)
    denominator = 4 * inertia + 4 * length * radius * c + 4 * radius**2 + length**2
    h = -1 + k * (denominator - length**2 * (1 - c**2)) / denominator  # Eq. 17
    fixed = denominator.subs(c, 0)
    b = 4 * length * radius / fixed
    slope = k * length**2 / fixed * (b * c**2 + 2 * c + b) / (1 + b * c) ** 2
    assert sp.simplify(sp.diff(h, c) - slope) == 0
    assert sp.expand(fixed - 4 * length * radius - 4 * inertia - (2 * radius - length) ** 2) == 0  # b < 1


def test_the_numbers_of_fig_9() -> None:
    """L = 2R, ε_n = 0.4. J_xx = 7mR²/5 makes the least ε -1 + 1.4·9.6/13.6 = -1/85."""
    uniform, isotropic = FIG_9["uniform-angle"], FIG_9["isotropic"]
    assert uniform.support() == isotropic.support()
    assert uniform.support() == pytest.approx((-1 / 85, 0.4), abs=2 * ULP)
    assert round(uniform.mean(), 4) == 0.2327
    assert round(uniform.std(), 4) == 0.1333
    assert round(float(uniform.cdf(0.0)), 4) == 0.0295
    assert round(float(isotropic.cdf(0.0)), 4) == 0.0463


@pytest.mark.parametrize("orientation", LAWS)
@pytest.mark.parametrize("elongation", ELONGATIONS)
def test_the_density_is_the_corrected_eq_21(elongation: float, orientation: str) -> None:
    """At quantiles across the support; the rounding of ε itself is part of the argument on both sides."""
    distribution, exact = make(elongation, 0.6, orientation), Exact(elongation, 0.6, orientation)
    inner = np.asarray(distribution.ppf(np.linspace(0, 1, 23)[1:-1]))
    expected = [float(exact.density(mp.mpf(s))) for s in inner]
    tolerance = 1e-13  # w is rounded; near the lower end, where c >= 1/22, p multiplies that by up to 1/c²
    np.testing.assert_allclose(distribution.pdf(inner), expected, rtol=tolerance)
    np.testing.assert_allclose(distribution.logpdf(inner), np.log(expected), rtol=0, atol=tolerance)


@pytest.mark.parametrize("orientation", LAWS)
@pytest.mark.parametrize("elongation", ELONGATIONS)
def test_the_density_integrates_to_one(elongation: float, orientation: str) -> None:
    """To 1e-12 with the singular end included: with ε_n = 0 a float comes as near to it as tanh-sinh asks.

    The peak of width b w at the lower end gets its own intervals.
    """
    distribution = make(elongation, 0.0, orientation)
    low, high = distribution.support()
    with mp.workdps(28):  # nodes come within 1e-28 of the end, where 1e-14 of the probability is left
        total = mp.quadts(
            lambda s: distribution.pdf(min(max(float(s), low), -1e-300)),
            [low, 0.9999 * low, 0.99 * low, 0.5 * low, high],
        )
    assert abs(total - 1) < 1e-12


@given(
    elongation=st.floats(-2, 3).map(lambda x: 10**x),
    normal=st.floats(0, 1),
    ends=st.tuples(st.floats(0.02, 0.98), st.floats(0.02, 0.98)),
    orientation=st.sampled_from(LAWS),
)
def test_the_distribution_function_is_the_integral_of_the_density(
    elongation: float, normal: float, ends: tuple[float, float], orientation: str
) -> None:
    """Between any two points inside, by Gauss–Legendre over 50 pieces, short where the density is great."""
    distribution = make(elongation, normal, orientation)
    edges = distribution.ppf(np.linspace(min(ends), max(ends), 51))
    nodes, weights = np.polynomial.legendre.leggauss(20)
    half = np.diff(edges)[:, None] / 2
    total = float(np.sum(half * weights * distribution.pdf(edges[:-1, None] + half * (1 + nodes))))
    # ε is rounded to an ulp of 1, which the density (up to 1/(b w)) turns into probability.
    rounding = 4 * ULP * float(np.max(distribution.pdf(edges)))
    expected = distribution.cdf(edges[-1]) - distribution.cdf(edges[0])
    assert total == pytest.approx(float(expected), abs=1e-12 + rounding)


@pytest.mark.parametrize("orientation", LAWS)
@pytest.mark.parametrize("elongation", [1e-6, *ELONGATIONS])
def test_moments_have_all_digits(elongation: float, orientation: str) -> None:
    """Against fifty digits; σ keeps all of them at L/R = 1e-6, where the support is 3e-13 wide."""
    distribution, exact = make(elongation, 0.8, orientation), Exact(elongation, 0.8, orientation)
    mean = exact.mean(lambda s: s)
    width = exact.restitution(mp.mpf(1)) - exact.restitution(mp.mpf(0))
    central = {n: exact.mean(lambda s, n=n: ((s - mean) / width) ** n) for n in (2, 3, 4)}
    # J_xx and b are rounded, and skewness comes near 0: a few ulp.
    assert distribution.mean() == pytest.approx(float(mean), rel=1e-15)
    assert distribution.std() == pytest.approx(float(width * mp.sqrt(central[2])), rel=2e-15)
    assert distribution.var() == pytest.approx(float(width**2 * central[2]), rel=4e-15)
    skewness, kurtosis = central[3] / central[2] ** 1.5, central[4] / central[2] ** 2
    assert distribution.stats("sk") == pytest.approx((float(skewness), float(kurtosis)), abs=2e-14)
    assert distribution.stats() == (distribution.mean(), distribution.var())
    for order in (0, 1, 2, 5, 12, 40):
        moment = exact.mean(lambda s, order=order: s**order)
        assert distribution.moment(order) == pytest.approx(float(moment), rel=1e-15 * (2 + order))


@pytest.mark.parametrize("elongation", ELONGATIONS)
def test_the_mean_has_a_closed_form(elongation: float) -> None:
    """With b = 2β/(1 + β²), E(ε_n - ε)/w = (1 + β²)[1/2 - (atan β + (β - atan β)/β²)/π].

    It is the sum of the Fourier series of Eq. 17 in θ. For c uniform, the partial fractions of
    (1 - c²)/(1 + bc) give 1/b² - 1/(2b) + (1 - 1/b²) ln(1 + b)/b.
    """
    inertia, length = Body.dumbbell(1.0, elongation).transverse, mp.mpf(elongation)
    denominator = 4 * inertia + 4 + length**2
    w, b = length**2 / denominator, 4 * length / denominator  # ε_n = 0
    beta = b / (1 + mp.sqrt(1 - b**2))
    uniform = (1 + beta**2) * (mp.mpf(1) / 2 - (mp.atan(beta) + (beta - mp.atan(beta)) / beta**2) / mp.pi)
    isotropic = 1 / b**2 - 1 / (2 * b) + (1 - 1 / b**2) * mp.log(1 + b) / b
    for orientation, expected in (("uniform-angle", uniform), ("isotropic", isotropic)):
        assert make(elongation, 0.0, orientation).mean() == pytest.approx(float(-w * expected), rel=2e-15)


@pytest.mark.parametrize("normal", [0.0, 0.98])
def test_a_nearly_spherical_body(normal: float) -> None:
    """As L → 0, (ε_n - ε)/w → sin²θ with w → (1 + ε_n)L²/(5.6 R²): the arcsine law if θ is uniform."""
    elongation = 1e-9  # the corrections are of the order of b, L/R
    w = (1 + normal) * elongation**2 / 5.6
    uniform, isotropic = (make(elongation, normal, law) for law in LAWS)
    assert uniform.std() == pytest.approx(w / np.sqrt(8), rel=3e-9)
    assert isotropic.std() == pytest.approx(w * np.sqrt(4 / 45), rel=3e-9)
    assert uniform.stats("sk") == pytest.approx((0.0, 1.5), abs=1e-8)
    assert uniform.mean() == pytest.approx(normal - w / 2, rel=3e-9)
    if normal == 0.0:  # here the support is resolved by floats
        share = np.linspace(0.05, 0.95, 19)
        np.testing.assert_allclose(uniform.sf(-w * share), stats.arcsine.cdf(share), rtol=1e-8)
        np.testing.assert_allclose(isotropic.cdf(-w * share), np.sqrt(1 - share), rtol=2e-8)


def test_the_upper_tail_keeps_all_digits() -> None:
    """ε a hair below ε_n, where cos θ is 1 to rounding: sf, isf and cos θ against fifty digits."""
    for orientation in LAWS:
        distribution, exact = make(1.0, 0.0, orientation), Exact(1.0, 0.0, orientation)
        for loss in (1e-3, 1e-12, 1e-60, 1e-250):
            with mp.workdps(600):
                # Eq. 17 with c = 1 - u: loss (d - 4u) = u(2 - u)
                d = 4 * exact.inertia + 8 + 1
                middle, constant = 1 + 2 * mp.mpf(loss), mp.mpf(loss) * d
                u = constant / (middle + mp.sqrt(middle**2 - constant))
                tail = mp.acos(1 - u) * 2 / mp.pi if orientation == "uniform-angle" else u
                assert float(distribution.sf(-loss)) == pytest.approx(float(tail), rel=4e-15, abs=0)
                assert float(distribution.isf(float(tail))) == pytest.approx(-loss, rel=1e-14, abs=0)
                assert float(distribution.cos_theta(-loss)) == pytest.approx(float(1 - u), rel=ULP)


def test_means_of_functions() -> None:
    """`expect` over all, over a range and conditional on it: against moments, probabilities, fifty digits."""
    for orientation, distribution in FIG_9.items():
        exact = Exact(2.0, 0.4, orientation)
        assert distribution.expect() == pytest.approx(distribution.mean(), abs=1e-14)
        assert distribution.expect(lambda e: e**3) == pytest.approx(distribution.moment(3), abs=1e-14)
        assert distribution.expect(np.exp) == pytest.approx(float(exact.mean(mp.exp)), abs=1e-14)
        negative = float(distribution.cdf(0.0))
        assert distribution.expect(lambda _: 1.0, ub=0.0) == pytest.approx(negative, abs=1e-15)
        assert distribution.expect(lambda _: 1.0, lb=0.0, epsabs=1e-12) == pytest.approx(
            1 - negative, abs=1e-15
        )
        assert distribution.expect(lambda _: 3.0, lb=-0.01, ub=0.1, conditional=True) == pytest.approx(3.0)
        low, high = distribution.interval(0.9)
        assert (distribution.cdf(low), distribution.sf(high)) == pytest.approx((0.05, 0.05), abs=1e-14)
        assert distribution.cdf(distribution.median()) == pytest.approx(0.5, abs=1e-15)


@pytest.mark.parametrize("orientation", LAWS)
@pytest.mark.parametrize("elongation", [1e-4, 0.1, 2.0, 30.0])
def test_entropy(elongation: float, orientation: str) -> None:
    """-∫ ln p over the quantile function with thirty digits; p is the corrected Eq. 21, its factors apart."""
    exact = Exact(elongation, 0.4, orientation)
    scale = mp.mpf(elongation) / 2  # of c, where the slope of Eq. 17 changes
    breaks = [0, *(x for x in (scale / 10, scale, 10 * scale) if x < 0.3), 0.7, 1]
    with mp.workdps(30):
        slope = mp.quadgl(lambda q: mp.log(exact.slope(exact.restitution(exact.cosine(q)))[1]), breaks)
        angle = mp.quadts(lambda p: mp.log(mp.pi / 2 * mp.sin(mp.pi * p / 2)), [0, 1])
    expected = -slope + (angle if orientation == "uniform-angle" else 0)
    assert make(elongation, 0.4, orientation).entropy() == pytest.approx(float(expected), abs=2e-12)
