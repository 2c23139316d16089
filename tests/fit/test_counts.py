"""Data that may be fitted: counts against the samples behind them, a Dataset against the array in it."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy import integrate, optimize, stats

import restitution as rs
from reference.flanks import ABOVE, BELOW, CUSP, Array, at_cusp, binned, flanks, mixed
from restitution import fit
from restitution.fit import Counts, Fit
from restitution.fit._mixture import _cost

Family = Callable[..., Fit]

FAMILIES: list[Family] = [
    fit.asymmetric_laplace,
    fit.asymmetric_power,
    fit.gaussian,
    fit.laplace,
    fit.logistic,
    fit.student_t,
    at_cusp,
]


@pytest.fixture(scope="module")
def bounced() -> xr.Dataset:
    """Impacts of 60 of the paper's particles."""
    law = rs.TangentialRestitution(normal=0.98)
    return rs.simulate(rs.Dumbbell(radius=3e-3, separation=3e-4), law, particles=60, impacts=150)


@pytest.mark.parametrize("family", FAMILIES)
def test_fine_bins_give_the_fit_of_the_samples(family: Family) -> None:
    """A thousand bins over 10 000 samples: parameters differ by less than a third of their errors."""
    x = mixed(10_000, 1)
    samples = fit.bootstrap(family, x, resamples=8)
    counts = family(binned(x, np.linspace(0.6, 1.3, 1001)))
    assert counts.samples == x.size
    assert counts.family == samples.fit.family
    assert counts.free_parameters == samples.fit.free_parameters
    for name, error in samples.standard_errors.items():
        # Eight resamples know an error to a quarter.
        assert abs(counts.parameters[name] - samples.fit.parameters[name]) <= 0.3 * error + 1e-9, name


def test_coarse_and_open_bins_are_censored_not_rounded() -> None:
    """Eight bins and two open ends, half the samples in the ends: the Gaussian comes back unbiased.

    Sixteen sets; mean parameters within four standard errors (false alarm 1e-4).
    """
    edges = np.linspace(0.4, 1.6, 9)
    found = []
    for seed in range(16):
        x = np.random.default_rng(seed).normal(1.0, 0.9, 2000)
        found.append(list(fit.gaussian(binned(x, edges)).parameters.values()))
    mean, error = np.mean(found, axis=0), np.std(found, axis=0, ddof=1) / np.sqrt(16)
    assert np.all(np.abs(mean - [1.0, 0.9]) < 4 * error)
    # To take the open ends for bins would make the deviation smaller by a third.
    assert mean[1] - 4 * error[1] > 0.8


def test_the_likelihood_of_counts_is_that_of_a_multinomial() -> None:
    counts = Counts(np.array([0.0, 1.0, 3.0]), np.array([2.0, 0.0]), below=1, above=4)
    model = stats.norm(0.5, 1.0)
    p = np.diff([0, *model.cdf([0.0, 1.0, 3.0]), 1])
    full = stats.multinomial.logpmf([1, 2, 0, 4], 7, p)
    other = stats.norm(0.2, 2.0)
    q = np.diff([0, *other.cdf([0.0, 1.0, 3.0]), 1])
    expected = full - stats.multinomial.logpmf([1, 2, 0, 4], 7, q)
    assert counts.loglikelihood(model) - counts.loglikelihood(other) == pytest.approx(expected)
    assert counts.cumulative() == pytest.approx([1 / 7, 3 / 7, 3 / 7])


def test_the_binned_likelihood_tends_to_that_of_the_density() -> None:
    """ln L of counts less n ln(width of a bin) is ln L of the samples but for the curvature inside the bins.

    For a Gaussian of deviation s its mean is n w²/(24 s²) (Sheppard): halving w divides the gap by four.
    """
    x = np.random.default_rng(3).normal(1.0, 0.05, 20_000)
    exact = fit.gaussian(x).loglikelihood
    for width in (0.05, 0.025):
        counts = binned(x, np.arange(0.0, 2.0 + width / 2, width))
        gap = fit.gaussian(counts).loglikelihood - x.size * np.log(width) - exact
        sheppard = -x.size * (width / 0.05) ** 2 / 24.0
        # The sum of 20 000 curvatures scatters about its mean, as 1/√n and with a factor of order 1.
        assert gap == pytest.approx(sheppard, rel=0.1)


@pytest.mark.parametrize("family", FAMILIES)
def test_a_dataset_is_fitted_as_what_is_in_it(family: Family, bounced: xr.Dataset) -> None:
    """A window of recorded impacts is their array; a window of statistics is the counts of its bins."""
    v = bounced.impact_velocity.to_numpy()
    x = bounced.restitution.to_numpy()[(v >= 0.38) & (v < 0.42)]
    assert family(bounced, velocity=(0.38, 0.42)) == family(x)
    counted = rs.reduce(bounced, np.linspace(0.3, 0.5, 11), np.linspace(0.7, 1.3, 301))
    found = family(counted, velocity=(0.38, 0.42))
    assert found == family(binned(x, np.linspace(0.7, 1.3, 301)))
    assert found.samples == x.size


def test_a_speed_or_a_window_of_bins(bounced: xr.Dataset) -> None:
    counted = rs.reduce(bounced, np.linspace(0.3, 0.5, 11), np.linspace(0.7, 1.3, 301))
    one = fit.laplace(counted, velocity=0.41)
    assert one == fit.laplace(Counts.at(counted, 0.41)) == fit.laplace(counted, velocity=(0.40, 0.42))


def test_particles_of_a_dataset_are_the_clusters(bounced: xr.Dataset) -> None:
    """Errors, p-values and comparisons of a Dataset are those of its values labelled by particle."""
    v = bounced.impact_velocity.to_numpy()
    particle, impact = np.nonzero((v >= 0.3) & (v < 0.4))
    x, window = bounced.restitution.to_numpy()[particle, impact], (0.3, 0.4)
    one = fit.bootstrap(fit.laplace, bounced, velocity=window, resamples=9)
    other = fit.bootstrap(fit.laplace, x, particle, resamples=9)
    assert one.resampled == other.resampled
    assert one.clusters == np.unique(particle).size
    assert fit.goodness(fit.laplace, bounced, velocity=window, resamples=5) == fit.goodness(
        fit.laplace, x, clusters=particle, resamples=5
    )
    pair = fit.laplace(x), fit.gaussian(x)
    assert fit.compare(*pair, bounced, velocity=window) == fit.compare(*pair, x, particle)


def test_statistics_count_what_was_simulated(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """From the core's own counts, over- and underflow included, come the flanks of the same impacts."""
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.1, 0.5, 5),
        "restitution_bins": np.linspace(0.9, 1.1, 201),
    }
    counted = rs.statistics(body, law, particles=500, impacts=150, **bins)
    counts = Counts.at(counted, 0.45)
    data = rs.simulate(body, law, particles=500, impacts=150)
    v = data.impact_velocity.to_numpy()
    x = data.restitution.to_numpy()[(v >= 0.4) & (v < 0.5)]
    assert counts.total == x.size
    assert counts.below > 0
    assert (counts.below, counts.above) == (np.sum(x < 0.9), np.sum(x >= 1.1))
    one, other = fit.asymmetric_laplace(counts, CUSP), fit.asymmetric_laplace(x, CUSP)
    assert one.parameters["above"] == pytest.approx(other.parameters["above"], rel=0.01)


def test_runs_of_statistics_are_drawn_again(body: rs.Dumbbell, law: rs.TangentialRestitution) -> None:
    """Statistics of several seeds give errors and a comparison, whose mean is that of the pooled counts."""
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.3, 0.5, 3),
        "restitution_bins": np.linspace(0.8, 1.2, 201),
    }
    runs = [rs.statistics(body, law, particles=60, impacts=100, seed=s, **bins) for s in range(8)]
    parts = [Counts.at(one, 0.45) for one in runs]
    found = fit.bootstrap(fit.laplace, runs, velocity=0.45, resamples=5)
    assert found.resampled == fit.bootstrap(fit.laplace, parts, resamples=5).resampled
    gauss = fit.bootstrap(fit.gaussian, parts, resamples=2).fit
    compared = fit.compare(found.fit, gauss, runs, velocity=0.45)
    gain = (found.fit.loglikelihood - gauss.loglikelihood) / found.fit.samples
    assert compared.difference == pytest.approx(gain)
    assert 0 < compared.standard_error < 1


def test_the_higher_of_two_maxima_is_found() -> None:
    """Bins wider than the cusp: a search from equal parts ends 150 below, in a mixture of other shares."""
    x = mixed(20_000, 1)
    found = at_cusp(binned(x, np.linspace(0.6, 1.3, 60)))
    known = at_cusp(x).parameters
    assert found.parameters["share"] == pytest.approx(known["share"], abs=0.02)
    assert found.parameters["deviation"] == pytest.approx(known["deviation"], rel=0.02)


def test_mixture_is_a_density_and_its_maximum_is_found() -> None:
    """Density, quantiles and draws agree; the gradient is right; the true point is not better."""
    x = mixed(20_000, 3)
    found = at_cusp(x)
    share, deviation = found.parameters["share"], found.parameters["deviation"]
    assert share == pytest.approx(0.3, abs=0.04)
    assert deviation == pytest.approx(0.06, rel=0.05)
    assert found.free_parameters == 5
    for low, high in ((0.0, CUSP), (CUSP, 2.0)):
        area = integrate.quad(lambda y: float(found.pdf(y)), low, high, limit=200)[0]
        assert area == pytest.approx(float(found.cdf(high) - found.cdf(low)), abs=1e-8)
    q = np.linspace(0.01, 0.99, 50)
    assert found.cdf(found.distribution.ppf(q)) == pytest.approx(q, abs=1e-12)
    assert found.cdf(1.0) + found.distribution.sf(1.0) == pytest.approx(1.0)
    draws = found.cdf(found.rvs(5000))
    assert stats.kstest(draws, "uniform").pvalue > 1e-3  # false alarm 1 in 1000, seed fixed
    assert found.logpdf([-50.0])[0] < -1000  # where the density itself underflows
    y, point = (x[:500] - CUSP) / 0.06, np.array([-0.5, -1.0, -0.7, -0.3, 0.1])

    def cost(p: Array) -> float:
        return _cost(p, y)[0]

    gradient = optimize.approx_fprime(point, cost, 1e-7)
    assert _cost(point, y)[1] == pytest.approx(gradient, abs=1e-5)
    truth = 0.3 * stats.laplace_asymmetric.pdf(
        (x - CUSP) / (0.2 * np.sqrt(ABOVE * BELOW)), np.sqrt(BELOW / ABOVE)
    ) / (0.2 * np.sqrt(ABOVE * BELOW)) + 0.7 * stats.norm.pdf(x, 0.95, 0.06)
    assert found.loglikelihood > np.log(truth).sum()


def test_the_exponent_may_have_its_cusp_fixed() -> None:
    x = flanks(np.random.default_rng(1).random(4000))
    found = fit.asymmetric_power(x, location=CUSP)
    assert found.parameters["location"] == CUSP
    assert found.free_parameters == 3
    assert found.loglikelihood <= fit.asymmetric_power(x).loglikelihood + 1e-6
    assert found.parameters["exponent"] == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("family", [fit.asymmetric_laplace, fit.asymmetric_power])
def test_what_is_given_is_no_free_parameter(family: Family) -> None:
    """Of samples as of counts: AIC and BIC count what was fitted."""
    x = flanks(np.random.default_rng(1).random(4000))
    for samples in (x, binned(x, np.linspace(0.6, 1.3, 1001))):
        free, fixed = family(samples), family(samples, location=CUSP)
        assert free.free_parameters == len(free.parameters)
        assert fixed.free_parameters == len(fixed.parameters) - 1
        assert fixed.parameters["location"] == CUSP


@pytest.mark.parametrize(("sharpness", "exponent"), [(0.25, 0.5), (50.0, 20.0)])
def test_the_exponent_stays_within_its_bounds(sharpness: float, exponent: float) -> None:
    """Where the density asks for a sharper cusp, or a flatter top, than k = 1/2 and 20."""
    x = stats.gennorm(sharpness, loc=CUSP, scale=0.02).rvs(4000, random_state=1)
    found = fit.asymmetric_power(x, location=CUSP)
    low, high = np.quantile(x, [0.002, 0.998])
    counts = fit.asymmetric_power(binned(x, np.linspace(low, high, 400)), location=CUSP)
    assert found.parameters["exponent"] == pytest.approx(exponent, rel=1e-3)
    assert counts.parameters["exponent"] == pytest.approx(exponent, rel=1e-12)


def test_shares_of_bins_far_out_on_either_side() -> None:
    """Of a symmetric density the same on both: the upper ones are not 1 less what lies below."""
    edges = np.arange(-12.0, 12.5, 0.5)
    share = Counts(edges, np.ones(edges.size - 1)).logshare(stats.norm)
    np.testing.assert_allclose(share, share[::-1], rtol=1e-12)
    assert share[1] == pytest.approx(np.log(stats.norm.cdf(-11.5) - stats.norm.cdf(-12.0)), rel=1e-12)
    assert np.exp(share).sum() == pytest.approx(1.0, abs=1e-14)
    with pytest.raises(ValueError, match=r"^q = 'x': must be probabilities"):
        Counts(edges, np.ones(edges.size - 1)).quantile("x")  # type: ignore[arg-type]


def test_counts_are_arrays_that_stay_as_they_are() -> None:
    counts = Counts([0.0, 1.0, 2.0], [1, 2], above=3)  # type: ignore[arg-type]
    for array in (counts.edges, counts.count):
        assert isinstance(array, np.ndarray)
        assert not array.flags.writeable
    assert counts.total == 6
    with pytest.raises(ValueError, match=r"^above = 9007199254740993: must be a whole number in \[0, 9007"):
        Counts(np.arange(3.0), np.ones(2), above=2**53 + 1)
    with pytest.raises(
        ValueError, match=r"^distribution = 3: must be a distribution, with methods cdf and sf$"
    ):
        counts.logshare(3)


def test_what_else_is_in_statistics_does_not_matter(bounced: xr.Dataset) -> None:
    """As times of day, which have no sum, beside each velocity."""
    found = rs.reduce(bounced, np.linspace(0.1, 1.1, 11), np.linspace(-1.0, 3.0, 201))
    noted = found.assign(
        noted=("velocity", np.full(found.sizes["velocity"], "2014-11-20", "datetime64[ns]")),
        by=("velocity", ["somebody"] * found.sizes["velocity"]),
    )
    expected = fit.laplace(found, velocity=(0.3, 0.9))
    assert fit.laplace(noted, velocity=(0.3, 0.9)).parameters == expected.parameters
