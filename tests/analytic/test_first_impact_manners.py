"""Distributions with several branches used like scipy's: inverses, ends, shapes, nan, draws, errors."""

import itertools
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

import restitution as rs
from restitution.analytic import FirstImpact, first_impact, negative_threshold

CUTS: dict[str, tuple[Any, Any, dict[str, Any]]] = {
    "spheroid": (rs.Spheroid(equatorial=2.0, polar=3.0), rs.Frictionless(normal=0.7), {}),
    "disc": (rs.Spheroid(equatorial=2.0, polar=0.2), rs.TangentialRestitution(normal=0.7), {}),
    "club": (rs.Dumbbell(radius=(1.0, 0.7), separation=1.5), rs.Coulomb(normal=0.5, friction=0.1), {}),
    "loaded": (
        rs.LoadedSphere(radius=1.0, load=8e3, offset=0.9),
        rs.ChatterjeeRuina(normal=0.2, tangential=0.9, friction=0.3),
        {},
    ),
    "steel": (
        rs.Dumbbell(radius=1e-3, separation=2e-3),
        rs.TangentialRestitution(normal=rs.Plastic(yield_speed=1.0)),
        {"release_height": 0.0515, "gravity": 9.81},
    ),
}
ALL: list[FirstImpact] = [
    first_impact(body, law, orientation, **fall)
    for body, law, fall in CUTS.values()
    for orientation in ("uniform-angle", "isotropic")
]
BODY_OF_FIG_9 = rs.Dumbbell(radius=1.0, separation=2.0), rs.TangentialRestitution(normal=0.4)
CLOSED = [first_impact(*BODY_OF_FIG_9, orientation) for orientation in ("uniform-angle", "isotropic")]
"""Of two equal spheres, which have closed forms of their own."""


def named(distribution: FirstImpact) -> str:
    body, law = type(distribution.body).__name__, type(distribution.law).__name__
    return f"{body}-{law}-{distribution.orientation}"


each = pytest.mark.parametrize("distribution", ALL, ids=named)
every = pytest.mark.parametrize("distribution", ALL + CLOSED, ids=named)


@settings(max_examples=25)
@given(distribution=st.sampled_from(ALL), q=st.floats(0, 1))
def test_quantiles_invert_the_distribution_function(distribution: FirstImpact, q: float) -> None:
    """To what the neighbouring ε of the quantile have as probability."""
    low, high = distribution.support()
    for inverse, forward, sign in (
        (distribution.ppf, distribution.cdf, 1),
        (distribution.isf, distribution.sf, -1),
    ):
        quantile = float(inverse(q))
        assert low <= quantile <= high
        step = 4e-15
        assert forward(quantile - sign * step) - 1e-14 <= q <= forward(quantile + sign * step) + 1e-14


@each
def test_the_density_at_the_ends_is_its_limit(distribution: FirstImpact) -> None:
    """Finite or not: it grows like 1/√|ε − end| at an extreme of ε(θ), unless sin θ vanishes there."""
    ends = np.array(distribution.support())
    inside = ends + np.array([1e-9, -1e-9]) * np.ptp(ends)
    assert np.all(distribution.pdf(ends) >= (1.0 - 1e-6) * np.asarray(distribution.pdf(inside)))


def test_the_density_where_two_branches_meet_is_that_of_one() -> None:
    """Where friction begins to slide ε(θ) has a kink: the density jumps there, and is not counted twice."""
    distribution = first_impact(
        rs.Spheroid(equatorial=2e-2, polar=3e-2), rs.Coulomb(normal=0.9, friction=0.2)
    )
    branches = distribution._curve.branches  # type: ignore[attr-defined]
    joints = {branch.last for branch in branches[:-1]} - set(distribution.support())
    assert len(joints) == 2
    for joint in joints:
        below, at, above = distribution.pdf([joint - 1e-9, joint, joint + 1e-9])
        assert abs(below - above) > 0.1 * below
        assert min(abs(at - below), abs(at - above)) < 1e-6 * at


PAIR = first_impact(rs.Dumbbell(radius=1.0, separation=0.8), rs.TangentialRestitution(normal=0.7))


@pytest.mark.parametrize("distribution", [PAIR, ALL[0]])
def test_upright_a_body_does_not_turn(distribution: FirstImpact) -> None:
    """ε = ε_n where the axis is vertical, either way up."""
    assert np.asarray(distribution.restitution([1.0, -1.0])) == pytest.approx(0.7, rel=1e-15)
    assert np.isnan(distribution.restitution([1.0 + 1e-15, -1.1])).all()


@pytest.mark.parametrize("distribution", [PAIR, ALL[0]])
def test_options_of_an_expectation_are_quad_s(distribution: FirstImpact) -> None:
    with pytest.raises(TypeError, match="nonsense"):
        distribution.expect(lambda x: x, nonsense=1)  # type: ignore[call-arg]


@each
def test_the_ends(distribution: FirstImpact) -> None:
    low, high = distribution.support()
    assert distribution.ppf(0.0) == distribution.isf(1.0) == low
    assert distribution.ppf(1.0) == distribution.isf(0.0) == high
    outside = [-np.inf, np.nextafter(low, -2), np.nextafter(high, 2), np.inf]
    assert np.array_equal(distribution.cdf(outside), [0, 0, 1, 1])
    assert np.array_equal(distribution.sf(outside), [1, 1, 0, 0])
    assert np.array_equal(distribution.pdf(outside), np.zeros(4))
    assert np.array_equal(distribution.logpdf(outside), np.full(4, -np.inf))
    assert np.all(np.isnan(distribution.cos_theta(outside)))
    assert np.all(np.asarray(distribution.cos_theta([low, high])) <= 1.0)
    assert np.array_equal(distribution.cdf([low, high]), [0, 1])
    assert np.array_equal(distribution.logcdf([low, high]), [-np.inf, 0])
    assert np.array_equal(distribution.logsf([low, high]), [0, -np.inf])


@each
def test_probability_is_monotone_and_the_integral_of_the_density(distribution: FirstImpact) -> None:
    """Between the levels at which a branch begins or ends, where the density may be infinite.

    Gauss–Legendre in u with ε quadratic in u at both ends; the nearest node is 1e-9 of the range from an end,
    where the rounding of ε is some 1e-7 of that.
    """
    curve = distribution._curve  # type: ignore[attr-defined]
    levels = np.unique([value for b in curve.branches for value in (b.first, b.last)])
    nodes, weights = np.polynomial.legendre.leggauss(200)
    u = (1 + nodes) / 2
    smooth = u * u * (3 - 2 * u)
    total = 0.0
    for low, high in itertools.pairwise(levels):
        if high - low < 1e-12:
            continue
        x = low + (high - low) * smooth
        part = float(np.sum(weights * 3 * u * (1 - u) * (high - low) * distribution.pdf(x)))
        assert part == pytest.approx(float(distribution.cdf(high) - distribution.cdf(low)), abs=2e-7)
        total += part
    assert total == pytest.approx(1, abs=4e-7)
    x = np.linspace(*distribution.support(), 1001)
    assert np.all(np.diff(distribution.cdf(x)) >= -1e-15)
    np.testing.assert_allclose(distribution.cdf(x) + distribution.sf(x), 1, rtol=0, atol=1e-14)


@every
@pytest.mark.parametrize(
    "name", ["pdf", "logpdf", "cdf", "sf", "logcdf", "logsf", "ppf", "isf", "restitution", "cos_theta"]
)
def test_elementwise_methods_broadcast_like_scipy(name: str, distribution: FirstImpact) -> None:
    """A float for a float, an array for an array, nan for nan, the same value in either."""
    method: Callable[[Any], Any] = getattr(distribution, name)
    low, high = distribution.support()
    at = np.array([[0.3, np.nan, 0.5], [0.6, 0.45, 0.9]])
    values = at if name in ("ppf", "isf", "restitution") else low + (high - low) * at
    result = method(values)
    assert result.shape == (2, 3)
    assert np.array_equal(np.isnan(result), np.isnan(values))
    assert type(method(values[0, 0])) is np.float64
    assert np.isnan(method(np.nan))
    assert method(values[0, 0]) == pytest.approx(result[0, 0], rel=1e-13)
    assert method([]).shape == (0,)


@every
def test_angles_and_draws(distribution: FirstImpact) -> None:
    """ε at the angle that `cos_theta` gives is ε; draws follow the distribution, false alarm of all: 1e-6."""
    x = distribution.ppf(np.linspace(0.01, 0.99, 40))
    cosine = distribution.cos_theta(x)
    either = [distribution.restitution(cosine), distribution.restitution(-cosine)]
    assert np.max(np.min(np.abs(either - x), axis=0)) < 1e-13
    drawn = distribution.rvs((50, 200), 5)
    assert np.array_equal(drawn, distribution.rvs((50, 200), np.random.default_rng(5)))
    assert not np.array_equal(drawn, distribution.rvs((50, 200), 6))
    assert np.shape(distribution.rvs(3, np.random.RandomState(1))) == (3,)
    assert np.shape(drawn) == (50, 200)
    assert type(distribution.rvs()) is np.float64
    assert stats.kstest(np.ravel(drawn), distribution.cdf).pvalue > 1e-7
    assert pickle.loads(pickle.dumps(distribution)) == distribution


@every
def test_means_of_functions(distribution: FirstImpact) -> None:
    """`expect` over all, over a range and conditional on it."""
    assert distribution.expect() == pytest.approx(distribution.mean(), abs=1e-12)
    assert distribution.expect(lambda e: e**3) == pytest.approx(distribution.moment(3), abs=1e-12)
    low, high = distribution.interval(0.8)
    assert distribution.expect(lambda _: 1.0, lb=low, ub=high) == pytest.approx(0.8, abs=1e-12)
    assert distribution.expect(lambda _: 2.0, lb=low, conditional=True) == pytest.approx(2.0, abs=1e-12)
    assert distribution.cdf(distribution.median()) == pytest.approx(0.5, abs=1e-14)
    assert distribution.var() == pytest.approx(distribution.std() ** 2)


@every
def test_entropy(distribution: FirstImpact) -> None:
    """The mean of -ln p over 10⁵ draws, within 5.3 standard errors: false alarm of all once in 10⁶."""
    logarithm = np.asarray(distribution.logpdf(distribution.rvs(100_000, 8)))
    error = np.std(logarithm) / np.sqrt(logarithm.size)
    assert distribution.entropy() == pytest.approx(-float(np.mean(logarithm)), abs=5.3 * error)


def test_scale_does_not_matter() -> None:
    """Neither size nor density; with a material size does, for the speed depends on it."""
    law = rs.Coulomb(normal=0.5, friction=0.1)
    one = first_impact(rs.Spheroid(equatorial=2.0, polar=3.0), law)
    two = first_impact(rs.Spheroid(equatorial=2e-50, polar=3e-50, density=7.0), law)
    assert two.support() == pytest.approx(one.support(), rel=1e-14)
    assert two.std() == pytest.approx(one.std(), rel=1e-13)


STEEL = rs.Plastic(yield_speed=0.1)
EGG = rs.Spheroid(equatorial=2e-2, polar=3e-2)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            {"body": rs.Spheroid(equatorial=1.0, polar=1.0)},
            r"body = Spheroid\(.*: must be no sphere about its centre of mass",
        ),
        (
            {"body": rs.LoadedSphere(radius=1.0, load=0, offset=0.5)},
            r"body = LoadedSphere\(.*: must be no sphere about its",
        ),
        (
            {"body": rs.Spheroid(equatorial=1.0, polar=1.00001)},
            r"body = Spheroid.*restitution varies by 1e-09 at least; here by [0-9.e-]+",
        ),
        (
            {"release_height": 0.1},
            r"release_height = 0\.1: must be left out: law\.normal = 0\.5 at any speed",
        ),
        ({"gravity": 9.81}, r"gravity = 9\.81: must be left out"),
        (
            {"law": rs.Frictionless(normal=STEEL)},
            r"release_height: missing; law\.normal = Plastic depends on",
        ),
        (
            {"law": rs.Frictionless(normal=STEEL), "release_height": 0.1},
            r"gravity: missing; law\.normal = Plastic",
        ),
        (
            {"law": rs.Frictionless(normal=STEEL), "release_height": 0.1, "gravity": -1.0},
            r"gravity = -1\.0: must be a finite number > 0 \(m/s²\)",
        ),
        (
            {"law": rs.Frictionless(normal=STEEL), "release_height": 0.03, "gravity": 9.81},
            r"release_height = 0\.03: must be more than 0\.03 m",
        ),
    ],
    ids=str,
)
def test_wrong_arguments_are_named(arguments: dict[str, Any], message: str) -> None:
    right: dict[str, Any] = {"body": EGG, "law": rs.Frictionless(normal=0.5)}
    with pytest.raises(ValueError, match=message):
        first_impact(**{**right, **arguments})


def test_wrong_arguments_of_the_threshold_are_named() -> None:
    with pytest.raises(ValueError, match=r"body = 3: must be a Dumbbell, LoadedSphere"):
        negative_threshold(3, rs.Frictionless(normal=0.5))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"law = 0\.5: must be a TangentialRestitution"):
        negative_threshold(EGG, 0.5)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("told", "use"),
    [
        ("x = 'half': must be a number or an array of numbers", lambda d: d.cdf("half")),
        ("q = 'half': must be a number or an array of numbers", lambda d: d.isf("half")),
        ("restitution = 'x': must be a number or an array of numbers", lambda d: d.cos_theta("x")),
        ("cos_theta = 'x': must be a number or an array of numbers", lambda d: d.restitution("x")),
        ("confidence = 'x': must be a number or an array of numbers", lambda d: d.interval("x")),
        ("func = 5: must be a function of one number", lambda d: d.expect(5)),
        ("lb = nan: must be a number or None", lambda d: d.expect(lb=np.nan)),
        ("ub = nan: must be a number or None", lambda d: d.expect(ub=np.nan)),
        ("size = -1: must be a whole number >= 0 or a tuple of them", lambda d: d.rvs(-1)),
        ("lb = 'x': must be a number or None", lambda d: d.expect(lb="x")),
        ("ub = 'x': must be a number or None", lambda d: d.expect(ub="x")),
        (
            "x has units 's': must be in 1; drop_attrs() removes units that xarray copied",
            lambda d: d.pdf(xr.DataArray(0.5, attrs={"units": "s"})),
        ),
    ],
)
def test_errors_name_the_argument(told: str, use: Callable[[FirstImpact], object]) -> None:
    for distribution in (ALL[0], CLOSED[0]):
        with pytest.raises(ValueError) as raised:  # noqa: PT011 (the message is compared below)
            use(distribution)
        assert str(raised.value).startswith(told)


def test_draws_are_what_fits_into_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Three numbers a draw: the uniform one, the quantile, and what it is found with."""
    monkeypatch.setattr("restitution._internal.resources.available_memory", lambda: 71_999)
    assert np.shape(ALL[0].rvs(size=(1, 2999), random_state=1)) == (1, 2999)
    with pytest.raises(
        MemoryError, match=r"^size = 3000: must be at most 2999 draws, which this process can hold$"
    ):
        ALL[0].rvs(size=3000)


def test_the_shortest_and_the_longest_pair() -> None:
    law = rs.TangentialRestitution(normal=0.5)
    for separation, beyond in ((1e-100, 0.9), (1e100, 1.1)):
        first_impact(rs.Dumbbell(radius=1.0, separation=separation), law)
        with pytest.raises(ValueError, match=r"body\.separation = .* 1e-100 to 1e\+100 times body\.radius"):
            first_impact(rs.Dumbbell(radius=1.0, separation=separation * beyond), law)


def test_a_pair_turned_upside_down_is_the_same_body() -> None:
    law = rs.TangentialRestitution(normal=0.5)
    radii, densities = (1.0, 0.3), (1.0, 4.0)
    one = first_impact(rs.Dumbbell(radius=radii, separation=1.5, density=densities), law)
    two = first_impact(rs.Dumbbell(radius=radii[::-1], separation=1.5, density=densities[::-1]), law)
    assert two.support() == pytest.approx(one.support(), rel=1e-14)
    at = np.linspace(*one.support(), 50)
    np.testing.assert_allclose(two.cdf(at), one.cdf(at), rtol=0, atol=1e-7)  # like √ at the ends


@pytest.mark.parametrize("radii", [(1.0, 0.3), (0.3, 1.0)])
def test_a_pair_one_of_which_holds_the_other_is_a_sphere(radii: tuple[float, float]) -> None:
    with pytest.raises(ValueError, match="must be no sphere about its centre of mass"):
        first_impact(rs.Dumbbell(radius=radii, separation=0.5), rs.TangentialRestitution(normal=0.5))
