"""The first-impact distribution used like one of scipy's: inverses, ends, shapes, nan, draws, errors."""

import math
import pickle
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

import restitution as rs
from restitution.analytic import FirstImpact, first_impact

LAWS = ("uniform-angle", "isotropic")
ULP = float(np.finfo(float).eps)


def make(elongation: float, normal: float, orientation: Any = "uniform-angle") -> FirstImpact:
    body = rs.Dumbbell(radius=1.0, separation=elongation)
    return first_impact(body, rs.TangentialRestitution(normal=normal), orientation)


FIG_9 = {law: make(2.0, 0.4, law) for law in LAWS}

wide = st.builds(
    make,
    elongation=st.floats(-100, 100).map(lambda x: 10**x),
    normal=st.floats(0, 1),
    orientation=st.sampled_from(LAWS),
)


@given(distribution=wide, q=st.floats(0, 1))
def test_quantiles_invert_the_distribution_function(distribution: FirstImpact, q: float) -> None:
    """For every L > 0: q is within what the neighbouring floats of the quantile have as probability."""
    low, high = distribution.support()
    step = 3 * float(np.spacing(max(high, high - low)))
    for inverse, forward, sign in (
        (distribution.ppf, distribution.cdf, 1),
        (distribution.isf, distribution.sf, -1),
    ):
        quantile = float(inverse(q))
        assert low <= quantile <= high
        assert forward(quantile - sign * step) - 4 * ULP <= q <= forward(quantile + sign * step) + 4 * ULP


@given(distribution=wide, share=st.lists(st.floats(-0.5, 1.5), min_size=2, max_size=20))
def test_probability_is_monotone_and_within_its_bounds(distribution: FirstImpact, share: list[float]) -> None:
    """Also at and beyond the ends, where it is exactly 0 and 1; cdf + sf = 1."""
    low, high = distribution.support()
    x = np.sort(np.clip(low + np.array(share) * (high - low), -2, 2))
    cdf, sf = np.asarray(distribution.cdf(x)), np.asarray(distribution.sf(x))
    assert np.all(np.diff(cdf) >= -2 * ULP)
    assert np.all((cdf >= 0) & (cdf <= 1))
    np.testing.assert_allclose(cdf + sf, 1, rtol=0, atol=4 * ULP)
    assert np.all(cdf[x >= high] == 1)
    assert np.all(sf[x >= high] == 0)
    assert np.all(cdf[x < low] == 0)
    assert distribution.cdf(low) == float(low == high)
    assert np.all((np.asarray(distribution.pdf(x)) > 0) == ((x >= low) & (x <= high)))
    assert distribution.ppf(0.0) == low
    assert distribution.ppf(1.0) == high


@given(distribution=wide, cosine=st.floats(-1, 1))
def test_the_angle_and_the_restitution_are_inverse(distribution: FirstImpact, cosine: float) -> None:
    """Either sphere may be the lower one; cos θ comes back within the rounding of ε."""
    restitution = distribution.restitution(cosine)
    assert restitution == distribution.restitution(-cosine)
    low, high = distribution.support()
    step = 3 * float(np.spacing(max(high, high - low)))
    below = distribution.cos_theta(restitution - step) if restitution - step > low else 0.0
    above = distribution.cos_theta(restitution + step) if restitution + step < high else 1.0
    assert below - 2 * ULP <= abs(cosine) <= above + 2 * ULP


def test_the_ends_of_the_density() -> None:
    """Eq. 20 by hand: ε(c) has slopes b w and 2w/(1 + b) at c = 0 and 1, where p_c is 2/π and ∞, or 1."""
    w, b = 1.4 * 4 / 13.6, 8 / 13.6
    uniform, isotropic = FIG_9["uniform-angle"], FIG_9["isotropic"]
    ends = uniform.support()
    np.testing.assert_allclose(uniform.pdf(ends), [2 / np.pi / (b * w), np.inf], rtol=8 * ULP)
    np.testing.assert_allclose(isotropic.pdf(ends), [1 / (b * w), (1 + b) / (2 * w)], rtol=8 * ULP)
    outside = [np.nextafter(ends[0], -1), np.nextafter(ends[1], 1), -np.inf, np.inf]
    for distribution in (uniform, isotropic):
        assert np.array_equal(distribution.pdf(outside), np.zeros(4))
        assert np.array_equal(distribution.logpdf(outside), np.full(4, -np.inf))
        assert np.array_equal(distribution.cdf(outside), [0, 1, 0, 1])
        assert np.array_equal(distribution.sf(outside), [1, 0, 1, 0])
        assert np.array_equal(distribution.cdf(ends), [0, 1])
        assert np.array_equal(distribution.sf(ends), [1, 0])
        assert np.array_equal(distribution.logcdf(ends), [-np.inf, 0])
        assert np.array_equal(distribution.logsf(ends), [0, -np.inf])
        assert np.array_equal(distribution.cos_theta(ends), [0, 1])
        assert np.all(np.isnan(distribution.cos_theta(outside)))


def test_probabilities_outside_the_unit_interval_have_no_quantile() -> None:
    for distribution in FIG_9.values():
        assert np.all(np.isnan(distribution.ppf([-0.1, 1.1, np.nan])))
        assert np.all(np.isnan(distribution.isf([-0.1, 1.1, np.nan])))
        assert np.all(np.isnan(distribution.restitution([-1.1, 1.1])))
        assert np.all(np.isnan(distribution.interval(1.1)))


def test_scipy_takes_it_for_a_distribution() -> None:
    """A probability plot of the quantiles themselves is the diagonal."""
    distribution = FIG_9["uniform-angle"]
    _, (slope, intercept, r) = stats.probplot(
        distribution.ppf((np.arange(2000) + 0.5) / 2000), dist=distribution
    )
    assert (slope, intercept, r) == pytest.approx((1.0, 0.0, 1.0), abs=1e-3)  # probplot's ends differ by 1/n


def test_only_the_shape_and_the_normal_coefficient_matter() -> None:
    """Neither size, nor density, nor ε_t."""
    expected = FIG_9["uniform-angle"]
    for radius, density, tangential in ((2.0**-8, 7850.0, -1.0), (2.0**-200, 1.0, 0.5)):
        body = rs.Dumbbell(radius=radius, separation=2 * radius, density=density)
        distribution = first_impact(body, rs.TangentialRestitution(normal=0.4, tangential=tangential))
        assert distribution.support() == expected.support()
        assert distribution.std() == expected.std()
    assert pickle.loads(pickle.dumps(expected)) == expected


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"body": 3}, r"body = 3: must be a Dumbbell"),
        ({"law": 0.4}, r"law = 0\.4: must be a TangentialRestitution"),
        ({"orientation": "random"}, r"orientation = 'random': must be 'uniform-angle' or 'isotropic'"),
        (
            {"body": rs.Dumbbell(radius=1.0, separation=0.0)},
            r"body = Dumbbell\(.*separation=0\.0.*\): .*; a sphere .* law\.normal = 0\.4",
        ),
        (
            {"body": rs.Dumbbell(radius=1.0, separation=1e-101)},
            r"body\.separation = 1e-101: .* 1e-100 to 1e\+100",
        ),
    ],
)
def test_wrong_arguments_are_named(arguments: dict[str, Any], message: str) -> None:
    right = {"body": rs.Dumbbell(radius=1.0, separation=1.0), "law": rs.TangentialRestitution(normal=0.4)}
    with pytest.raises(ValueError, match=message):
        first_impact(**{**right, **arguments})


def test_wrong_orders_are_named() -> None:
    distribution = FIG_9["isotropic"]
    for order in (-1, 1.5, True):
        with pytest.raises(ValueError, match=rf"order = {order!r}: must be a whole number in \[0, 1000\]"):
            distribution.moment(order)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="moments = 'mx': must be letters of 'mvsk'"):
        distribution.stats("mx")


def test_a_mean_over_what_never_happens_is_nan() -> None:
    for distribution in FIG_9.values():
        _, high = distribution.support()
        assert math.isnan(distribution.expect(lb=high + 1, ub=high + 2, conditional=True))
        assert distribution.expect(lb=high + 1, ub=high + 2) == 0


def test_all_moments_at_once_come_in_the_order_of_their_letters() -> None:
    for distribution in FIG_9.values():
        mean, variance, skewness, kurtosis = distribution.stats("mvsk")
        assert (mean, variance) == (distribution.mean(), distribution.var())
        assert distribution.stats("ksvm") == (kurtosis, skewness, variance, mean)


def test_the_unit_of_an_angle_on_its_cosine_does_no_harm() -> None:
    """np.cos of a DataArray keeps the attributes of the angle."""
    for distribution in FIG_9.values():
        cosine = np.cos(xr.DataArray(0.3, attrs={"units": "rad"}))
        assert distribution.restitution(cosine) == distribution.restitution(math.cos(0.3))
