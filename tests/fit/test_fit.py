"""Fits of the density of ε: against brute force, against known parameters; p-values that are true."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy import integrate, optimize, special, stats

from restitution import fit
from restitution.fit._asymmetric import frozen

CUSP, ABOVE, BELOW = 0.98, 0.02, 0.05


def draw(n: int, seed: int) -> np.ndarray:
    """Draw asymmetric Laplace: an exponential of mean a above, of mean b below, with odds a : b."""
    random = np.random.default_rng(seed)
    up = random.random(n) < ABOVE / (ABOVE + BELOW)
    return CUSP + np.where(up, random.exponential(ABOVE, n), -random.exponential(BELOW, n))


def naive_loglikelihood(x: np.ndarray, m: float, a: float, b: float) -> float:
    above, below = np.maximum(x - m, 0).sum(), np.maximum(m - x, 0).sum()
    return float(-x.size * np.log(a + b) - above / max(a, 1e-300) - below / max(b, 1e-300))


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("decimals", [16, 2], ids=["distinct", "ties"])
def test_exact_fit_is_as_good_as_brute_force(seed: int, decimals: int) -> None:
    """Nelder–Mead over (m, ln a, ln b), started at every other sample, finds nothing above the maximum."""
    x = np.round(draw(25, seed), decimals)
    found = fit.asymmetric_laplace(x)

    def cost(p: np.ndarray) -> float:
        return -naive_loglikelihood(x, p[0], np.exp(p[1]), np.exp(p[2]))

    widths = [np.log(np.std(x))] * 2
    best = min(
        optimize.minimize(cost, [m, *widths], method="Nelder-Mead", tol=1e-9).fun
        for m in np.unique(x)[1:-1:2]
    )
    assert found.loglikelihood >= -best - 1e-7
    assert found.loglikelihood == pytest.approx(naive_loglikelihood(x, *found.parameters.values()), abs=1e-9)


def test_cusp_is_the_best_of_a_dense_scan() -> None:
    """The profile likelihood, evaluated at 20 000 cusps, is nowhere above the maximum of the fit."""
    x = draw(40, 7)
    scan = np.concatenate([np.linspace(x.min() - 0.1, x.max() + 0.1, 20000), x])
    above = np.maximum(x - scan[:, None], 0).sum(axis=1)
    below = np.maximum(scan[:, None] - x, 0).sum(axis=1)
    profile = -x.size * (np.log((np.sqrt(above) + np.sqrt(below)) ** 2 / x.size) + 1)
    assert fit.asymmetric_laplace(x).loglikelihood == pytest.approx(profile.max(), abs=1e-9)


def test_fixed_location_is_the_maximum_over_both_widths() -> None:
    x = draw(200, 3)
    found = fit.asymmetric_laplace(x, location=CUSP)

    def cost(p: np.ndarray) -> float:
        return -naive_loglikelihood(x, CUSP, *np.exp(p))

    best = optimize.minimize(cost, [-3.0, -3.0], tol=1e-9)
    a, b = np.exp(best.x)
    assert found.parameters == pytest.approx({"location": CUSP, "above": a, "below": b}, rel=1e-5)
    assert found.loglikelihood == pytest.approx(-best.fun, abs=1e-8)
    assert found.free_parameters == 2
    assert found.aic == pytest.approx(4 - 2 * found.loglikelihood)
    assert found.bic == pytest.approx(2 * np.log(200) - 2 * found.loglikelihood)


def test_known_parameters_come_back() -> None:
    """Fifty fits of 2000 draws: their mean is the truth within 4 standard errors (false alarm 2e−4)."""
    found = np.array([list(fit.asymmetric_laplace(draw(2000, s)).parameters.values()) for s in range(50)])
    error = found.std(axis=0, ddof=1) / np.sqrt(50)
    assert np.all(np.abs(found.mean(axis=0) - [CUSP, ABOVE, BELOW]) < 4 * error)


def test_samples_on_one_side_give_the_exponential() -> None:
    """For x ≥ m alone the density is exp(−(x−m)/a)/a with a the mean, and no probability lies below m."""
    x = np.array([1.0, 1.5, 4.0])
    found = fit.asymmetric_laplace(x, location=1.0)
    mean = 7 / 6
    assert found.parameters == pytest.approx({"location": 1.0, "above": mean, "below": 0.0})
    assert found.loglikelihood == pytest.approx(-3 * np.log(mean) - 3)
    assert found.cdf([0.999, 1.0, 2.0]) == pytest.approx([0, 0, 1 - np.exp(-1 / mean)])
    assert np.all(found.rvs(100) >= 1.0)
    mirrored = fit.asymmetric_laplace(-x, location=-1.0)
    assert mirrored.parameters == pytest.approx({"location": -1.0, "above": 0.0, "below": mean})
    assert mirrored.loglikelihood == pytest.approx(found.loglikelihood)


def test_the_cusp_of_samples_on_one_side_is_at_their_end() -> None:
    """Drawn evenly from an exponential: the densest end is the cusp, and nothing lies beyond it."""
    x = 1.0 - np.log1p(-(np.arange(200) + 0.5) / 200)
    found, mirrored = fit.asymmetric_laplace(x), fit.asymmetric_laplace(-x)
    mean = float(np.mean(x - x[0]))
    assert found.parameters == pytest.approx({"location": x[0], "above": mean, "below": 0.0})
    assert mirrored.parameters == pytest.approx({"location": -x[0], "above": 0.0, "below": mean})


def test_one_sample_beside_a_fixed_location() -> None:
    assert fit.asymmetric_laplace([3.0], location=1.0).parameters["above"] == pytest.approx(2.0)


@pytest.mark.parametrize(
    "family",
    [fit.asymmetric_laplace, fit.asymmetric_power, fit.gaussian, fit.laplace, fit.logistic, fit.student_t],
)
@pytest.mark.parametrize(
    ("samples", "message"),
    [
        ([], "samples: empty"),
        ([1.0, np.nan, 2.0], "samples: 1 of 3 values are NaN"),
        ([1.0, np.inf], "samples: 1 of 2"),
        ([2.0], "all 1 equal 2"),
        ([2.0, 2.0], "all 2 equal 2"),
    ],
)
def test_unusable_samples_are_refused_by_name(family: object, samples: list[float], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        family(samples)  # type: ignore[operator]


def test_five_parameters_need_six_samples() -> None:
    six = [0.9, 0.95, 0.97, 0.98, 0.99, 1.1]
    assert np.isfinite(fit.cusp_mixture(six, location=0.98).loglikelihood)
    with pytest.raises(ValueError, match=r"^samples: 5 value\(s\); five parameters need at least six$"):
        fit.cusp_mixture(six[1:], location=0.98)


def test_unusable_arguments_are_refused_by_name() -> None:
    with pytest.raises(ValueError, match="location = nan"):
        fit.asymmetric_laplace([1.0, 2.0], location=np.nan)
    with pytest.raises(ValueError, match="all 2 equal 1"):
        fit.asymmetric_laplace([1.0, 1.0], location=1.0)
    with pytest.raises(ValueError, match="resamples = 0"):
        fit.goodness(fit.gaussian, [1.0, 2.0], resamples=0)
    one = fit.gaussian([1.0, 2.0])
    with pytest.raises(ValueError, match="clusters: 1 values"):
        fit.compare(one, one, [1.0, 2.0], clusters=[1])
    with pytest.raises(ValueError, match="clusters: all samples are in one"):
        fit.compare(one, one, [1.0, 2.0], clusters=[1, 1])


@pytest.mark.parametrize(
    "family",
    [fit.asymmetric_laplace, fit.asymmetric_power, fit.gaussian, fit.laplace, fit.logistic, fit.student_t],
)
def test_every_density_is_one(family: object) -> None:
    """The density integrates to 1, its integral is the distribution function, and draws follow that."""
    found = family(draw(500, 1))  # type: ignore[operator]
    cusp = found.parameters.get("location", found.parameters.get("mean"))
    low, high = found.distribution.ppf([1e-12, 1 - 1e-12])
    parts = [integrate.quad(found.pdf, *ends, limit=200)[0] for ends in ((low, cusp), (cusp, high))]
    assert sum(parts) == pytest.approx(1, abs=1e-5)
    assert parts[0] == pytest.approx(float(found.cdf(cusp)), abs=1e-5)
    assert (
        stats.kstest(found.cdf(found.rvs(2000)), "uniform").pvalue > 1e-3
    )  # false alarm: 1 in 1000, seed fixed


def test_power_density_recovers_its_members() -> None:
    """Its exponent is 1 for Laplace draws, 2 for Gaussian ones; its maximum is never below theirs.

    The exponent's error is that of its Fisher information with the scale projected out,
    n[(1+1/k)ψ′(1+1/k) − 1]/k³; four of them are allowed (false alarm 6e−5 each).
    """
    sharp, smooth = draw(20000, 1), np.random.default_rng(1).normal(size=20000)
    for x, k in ((sharp, 1.0), (smooth, 2.0)):
        error = np.sqrt(k**3 / (x.size * ((1 + 1 / k) * special.polygamma(1, 1 + 1 / k) - 1)))
        found = fit.asymmetric_power(x)
        assert found.parameters["exponent"] == pytest.approx(k, abs=4 * float(error))
        most = found.loglikelihood
        assert (
            most
            >= max(family(x).loglikelihood for family in (fit.asymmetric_laplace, fit.gaussian, fit.laplace))
            - 1e-6
        )


@pytest.mark.parametrize("exponent", [0.7, 1.0, 2.0, 6.0])
def test_quantiles_of_the_power_density_invert_its_distribution_function(exponent: float) -> None:
    """That is worked out by quadrature here; a Gaussian's quantiles are SciPy's."""
    m, a, b = CUSP, 0.03, 0.01
    found = frozen(exponent, m, a, b)

    def density(x: float) -> float:
        width = a if x >= m else b
        scale = (a + b) * special.gamma(1 / exponent) / exponent
        return float(np.exp(-((abs(x - m) / width) ** exponent)) / scale)

    for q in (0.01, 0.2, 0.25, 0.5, 0.9, 0.99):  # b/(a + b) = 1/4 of it lies below m
        side = integrate.quad(density, m, float(found.ppf(q)))[0]
        assert 0.25 + side == pytest.approx(q, abs=1e-9)
        assert float(found.cdf(found.ppf(q))) == pytest.approx(q, rel=1e-12)
        assert float(found.sf(found.ppf(q))) == pytest.approx(1 - q, rel=1e-12)
    sigma = 0.02
    gaussian = frozen(2.0, m, np.sqrt(2) * sigma, np.sqrt(2) * sigma)
    shares = np.array([1e-6, 0.3, 0.5, 0.999])
    np.testing.assert_allclose(gaussian.ppf(shares), stats.norm(m, sigma).ppf(shares), rtol=1e-12)


def test_student_t_is_at_least_as_likely_as_the_truth() -> None:
    """Heavy tails far from the origin, where SciPy's own start fails to arrive."""
    truth = stats.t(3.0, loc=50.0, scale=0.01)
    x = truth.rvs(size=3000, random_state=np.random.default_rng(2))
    assert fit.student_t(x).loglikelihood >= truth.logpdf(x).sum() - 1e-6


def test_p_values_are_uniform_under_the_null() -> None:
    """Twenty sets of Laplace draws have uniform p-values (Kolmogorov–Smirnov, false alarm 1 in 1000 each)."""
    found = [fit.goodness(fit.asymmetric_laplace, draw(40, s), resamples=39, seed=s) for s in range(20)]
    for p in ([g.kolmogorov_smirnov_p for g in found], [g.anderson_darling_p for g in found]):
        # p is one of 1/40 … 40/40; a uniform jitter of one step makes it continuous.
        jitter = np.random.default_rng(0).random(20) / 40
        assert stats.kstest(np.array(p) - jitter, "uniform").pvalue > 1e-3


def test_a_wrong_family_is_rejected() -> None:
    """1000 Gaussian draws are no Laplace draws: both p-values at their floor, and Vuong's z says the same."""
    x = np.random.default_rng(4).normal(size=1000)
    found = fit.goodness(fit.asymmetric_laplace, x, resamples=99)
    assert found.kolmogorov_smirnov_p == found.anderson_darling_p == 0.01
    assert fit.compare(found.fit, fit.gaussian(x), x).z < -4
    assert fit.compare(fit.gaussian(x), found.fit, x).p < 1e-4


def test_repeated_samples_carry_no_information_when_clustered() -> None:
    """Each sample three times over, as one cluster, leaves difference and error as they are."""
    x = draw(400, 9)
    first, second = fit.asymmetric_laplace(x), fit.gaussian(x)
    once = fit.compare(first, second, x)
    thrice = fit.compare(first, second, np.repeat(x, 3), clusters=np.repeat(np.arange(400), 3))
    assert thrice.difference == pytest.approx(once.difference)
    assert thrice.standard_error == pytest.approx(once.standard_error)
    naive = fit.compare(first, second, np.repeat(x, 3))
    assert naive.standard_error == pytest.approx(once.standard_error / np.sqrt(3), rel=2e-3)
    assert fit.compare(first, first, x).z == 0


@pytest.mark.parametrize(
    ("family", "kind"),
    [
        (fit.gaussian, stats.norm),
        (fit.laplace, stats.laplace),
        (fit.logistic, stats.logistic),
        (fit.student_t, stats.t),
    ],
)
def test_no_other_fit_of_the_family_is_likelier(family: Callable[[Any], fit.Fit], kind: Any) -> None:
    """Not that of SciPy, which climbs by itself."""
    x = np.random.default_rng(1).gamma(2.0, size=400)
    other = float(kind(*kind.fit(x)).logpdf(x).sum())
    assert family(x).loglikelihood == pytest.approx(other, abs=1e-4)
    assert float(family(x).distribution.logpdf(x).sum()) == pytest.approx(other, abs=1e-4)
