"""Fits of binned counts, of correlated samples, and over all speeds: against what they must come to."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray
from scipy import integrate, optimize, stats

import restitution as rs
from restitution import fit
from restitution.fit import Counts, Fit
from restitution.fit._mixture import _cost

Array = NDArray[np.float64]
Family = Callable[[Any], Fit]

CUSP, ABOVE, BELOW = 0.98, 0.02, 0.05


def flanks(u: Array) -> Array:
    """Quantiles of the asymmetric Laplace density with the parameters above."""
    split = BELOW / (ABOVE + BELOW)
    with np.errstate(divide="ignore"):
        low = CUSP + BELOW * np.log(u / split)
        high = CUSP - ABOVE * np.log((1 - u) / (1 - split))
    return np.where(u < split, low, high)


def correlated(particles: int, each: int, seed: int, correlation: float = 0.8) -> tuple[Array, Array]:
    """Asymmetric Laplace samples with Gaussian scores correlated inside a particle; and the particles."""
    rng = np.random.default_rng(seed)
    common = rng.normal(size=(particles, 1))
    score = np.sqrt(correlation) * common + np.sqrt(1 - correlation) * rng.normal(size=(particles, each))
    x = flanks(stats.norm.cdf(score))
    return x.ravel(), np.repeat(np.arange(particles), each)


def mixed(n: int, seed: int) -> Array:
    """Three tenths of the flanks, seven tenths of a Gaussian."""
    rng = np.random.default_rng(seed)
    return np.where(
        rng.random(n) < 0.3, CUSP + 0.2 * (flanks(rng.random(n)) - CUSP), rng.normal(0.95, 0.06, n)
    )


def binned(x: Array, edges: Array) -> Counts:
    return Counts(
        edges,
        np.histogram(x[x < edges[-1]], edges)[0],
        int(np.sum(x < edges[0])),
        int(np.sum(x >= edges[-1])),
    )


def at_cusp(samples: Any) -> Fit:
    return fit.cusp_mixture(samples, CUSP)


FAMILIES: list[Family] = [
    fit.asymmetric_laplace,
    fit.asymmetric_power,
    fit.gaussian,
    fit.laplace,
    fit.logistic,
    fit.student_t,
    at_cusp,
]


@pytest.mark.parametrize("family", FAMILIES)
def test_fine_bins_give_the_fit_of_the_samples(family: Family) -> None:
    """A thousand bins over 20 000 samples: parameters differ by less than a third of their errors."""
    x = mixed(20_000, 1)
    samples = fit.bootstrap(family, x, resamples=8)
    counts = family(binned(x, np.linspace(0.6, 1.3, 1001)))
    assert counts.samples == x.size
    assert counts.free_parameters == samples.fit.free_parameters
    for name, error in samples.standard_errors.items():
        # Eight resamples know an error to a quarter.
        assert abs(counts.parameters[name] - samples.fit.parameters[name]) <= 0.3 * error + 1e-9, name


def test_coarse_and_open_bins_are_censored_not_rounded() -> None:
    """Eight bins and two open ends, half the samples in the ends: the Gaussian comes back unbiased.

    Fifty sets; mean parameters within four standard errors (false alarm 1e-4).
    """
    edges = np.linspace(0.4, 1.6, 9)
    found = []
    for seed in range(50):
        x = np.random.default_rng(seed).normal(1.0, 0.9, 2000)
        found.append(list(fit.gaussian(binned(x, edges)).parameters.values()))
    mean, error = np.mean(found, axis=0), np.std(found, axis=0, ddof=1) / np.sqrt(50)
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


def test_counts_come_from_statistics() -> None:
    """The bin that holds the velocity, with what is beyond its edges; a fit is that of the impacts."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.1, 0.5, 5),
        "restitution_bins": np.linspace(0.7, 1.3, 601),
    }
    counts = Counts.at(rs.statistics(body, law, particles=500, impacts=150, **bins), 0.45)
    data = rs.simulate(body, law, particles=500, impacts=150)
    v = data.impact_velocity.to_numpy()
    x = data.restitution.to_numpy()[(v >= 0.4) & (v < 0.5)]
    assert counts.total == x.size
    one, other = fit.asymmetric_laplace(counts, CUSP), fit.asymmetric_laplace(x, CUSP)
    assert one.parameters["above"] == pytest.approx(other.parameters["above"], rel=5e-3)
    with pytest.raises(ValueError, match=r"velocity = 0.5: must be in \[0.1, 0.5\) m/s"):
        Counts.at(rs.statistics(body, law, particles=5, **bins), 0.5)


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


def test_errors_are_those_of_repetition_and_count_particles() -> None:
    """Forty sets of correlated samples: the stated error of a width is its scatter, within 4/√78 of it.

    Single samples drawn again would say a third of that.
    """
    sets = [correlated(60, 20, seed) for seed in range(40)]
    found = [fit.bootstrap(fit.asymmetric_laplace, *one, resamples=60) for one in sets]
    scatter = np.std([one.fit.parameters["below"] for one in found], ddof=1)
    stated = np.sqrt(np.mean([one.standard_errors["below"] ** 2 for one in found]))
    assert abs(stated / scatter - 1) < 4 / np.sqrt(78)
    naive = fit.bootstrap(fit.asymmetric_laplace, sets[0][0], resamples=60).standard_errors["below"]
    assert naive < 0.5 * stated
    inside = [low < BELOW < high for low, high in (one.interval("below") for one in found)]
    assert np.mean(inside) > 0.8  # 0.95 nominal; 40 sets leave an error of 0.035, few particles make it low
    low, high = found[0].band([CUSP, 0.9], confidence=0.9)
    assert np.all(low < found[0].fit.pdf([CUSP, 0.9]))
    assert np.all(high > found[0].fit.pdf([CUSP, 0.9]))


def test_the_penalty_grows_with_the_correlation() -> None:
    """tr(J H⁻¹) is the number of parameters for independent samples, 20 times that for twenty copies."""
    x = np.random.default_rng(2).normal(size=2000)
    alone = fit.bootstrap(fit.gaussian, x, resamples=200)
    assert alone.effective_parameters == pytest.approx(2.0, abs=0.6)  # mean of 200 χ² with 2 degrees: 0.14
    assert alone.aic == pytest.approx(alone.fit.aic, abs=1.2)
    copies = fit.bootstrap(fit.gaussian, np.repeat(x[:100], 20), np.repeat(np.arange(100), 20), resamples=200)
    assert copies.effective_parameters == pytest.approx(40.0, rel=0.35)
    assert copies.bic - copies.aic == pytest.approx(copies.effective_parameters * (np.log(100) - 2))


def test_p_values_are_uniform_under_correlation() -> None:
    """Eighty sets of correlated samples of the family have uniform p-values.

    Kolmogorov–Smirnov against uniform, false alarm 1 in 1000. Taken as independent, nearly equal samples of a
    particle make the right family look wrong.
    """
    sets = [correlated(80, 10, seed) for seed in range(80)]
    how: dict[str, Any] = {"resamples": 39}
    found = [
        fit.goodness(fit.asymmetric_laplace, x, clusters=particle, seed=i, **how)
        for i, (x, particle) in enumerate(sets)
    ]
    jitter = np.random.default_rng(0).random(80) / 40
    for p in ([g.kolmogorov_smirnov_p for g in found], [g.anderson_darling_p for g in found]):
        assert stats.kstest(np.array(p) - jitter, "uniform").pvalue > 1e-3
    tight = [correlated(20, 100, seed, correlation=0.98)[0] for seed in range(10)]
    wrong = [fit.goodness(fit.asymmetric_laplace, x, **how).kolmogorov_smirnov_p for x in tight]
    assert np.median(wrong) == 1 / 40


def test_a_wrong_family_is_rejected_in_spite_of_the_correlation() -> None:
    x, particle = correlated(400, 10, 1)
    found = fit.goodness(fit.gaussian, x, clusters=particle, resamples=39)
    assert found.kolmogorov_smirnov_p == found.anderson_darling_p == 1 / 40


def test_runs_of_counts_take_the_place_of_particles() -> None:
    """Counts of twenty runs: errors and p-values as from the samples behind them, drawn run by run."""
    rng = np.random.default_rng(4)
    edges = np.linspace(0.5, 1.3, 401)
    runs = [flanks(rng.random(500)) for _ in range(20)]
    counts = [binned(run, edges) for run in runs]
    found = fit.bootstrap(fit.asymmetric_laplace, counts, resamples=12)
    samples = fit.bootstrap(
        fit.asymmetric_laplace, np.concatenate(runs), np.repeat(np.arange(20), 500), resamples=12
    )
    assert found.clusters == 20
    assert found.fit.parameters["below"] == pytest.approx(samples.fit.parameters["below"], rel=5e-3)
    ratio = found.standard_errors["below"] / samples.standard_errors["below"]
    assert 0.4 < ratio < 2.5  # both know their error to 1/√22
    assert fit.goodness(fit.asymmetric_laplace, counts, resamples=9).kolmogorov_smirnov_p > 0.1
    assert fit.goodness(fit.gaussian, counts, resamples=19).kolmogorov_smirnov_p == 0.05


def scaled_flanks(particles: int, seed: int) -> xr.Dataset:
    """Impacts at random speeds with flanks that grow as 0.01/v (above) and 0.02 v^-1.5 (below)."""
    rng = np.random.default_rng(seed)
    v = rng.uniform(0.1, 0.5, (particles, 60))
    above, below = 0.01 / v, 0.02 * v**-1.5
    up = rng.random(v.shape) < above / (above + below)
    e = CUSP + np.where(up, rng.exponential(above), -rng.exponential(below))
    return xr.Dataset(
        {
            "impact_velocity": (("particle", "impact"), v),
            "restitution": (("particle", "impact"), e),
            "rotational_fraction": (("particle", "impact"), np.full_like(v, 0.5)),
        }
    )


def test_growth_laws_come_back() -> None:
    """Exponents -1 and -1.5 within four stated errors, which are small; a bin's finite width adds 0.005."""
    data = scaled_flanks(1000, 1)
    edges = np.linspace(0.1, 0.5, 41)
    found = fit.slopes(data, edges, location=CUSP, resamples=40)
    for side, exponent, amplitude in (("above", -1.0, 0.01), ("below", -1.5, 0.02)):
        law = found.power_law(side)
        assert law.exponent_error < 0.02
        assert abs(law.exponent - exponent) < 4 * law.exponent_error + 0.005
        assert abs(law.amplitude - amplitude) < 4 * law.amplitude_error + 0.01 * amplitude
        assert law.misfit < 1.6
    assert found.fails_below(0.05) == 0.1
    assert np.isnan(found.fails_below(1e-4))
    free = fit.slopes(data, edges, resamples=2)
    assert np.abs(free.table.location - CUSP).max() < 0.02


def test_slopes_of_counts_are_those_of_the_impacts() -> None:
    data = scaled_flanks(500, 2)
    edges = np.linspace(0.1, 0.5, 9)
    counts = rs.reduce(data, edges, np.linspace(-1.0, 2.0, 3001))
    one, other = fit.slopes(counts, location=CUSP), fit.slopes(data, edges, location=CUSP, resamples=20)
    for side in ("above", "below"):
        gap = np.abs(one.table[side] - other.table[side])
        assert np.all(gap < 0.2 * other.table[f"{side}_error"])
        assert np.isnan(one.table[f"{side}_error"]).all()
        assert one.power_law(side).exponent == pytest.approx(other.power_law(side).exponent, abs=0.03)
        assert np.isnan(one.power_law(side).exponent_error)


def test_the_exponential_form_fails_where_the_samples_are_gaussian() -> None:
    """Below 0.3 m/s the flanks are replaced by a Gaussian, 0.05 from any asymmetric Laplace distribution."""
    data = scaled_flanks(500, 3)
    v = data.impact_velocity
    gauss = np.random.default_rng(1).normal(CUSP, 0.1, v.shape)
    data["restitution"] = data.restitution.where(v >= 0.3, gauss)
    found = fit.slopes(data, np.linspace(0.1, 0.5, 9), resamples=2)
    assert found.fails_below(0.03) == pytest.approx(0.3)


def sequences(kind: str, seed: int = 1) -> xr.Dataset:
    """Particles of constant speed: ε an autoregression and spheres that alternate, or all random."""
    rng = np.random.default_rng(seed)
    shape = (400, 100)
    score = rng.normal(size=shape)
    if kind == "chain":
        for n in range(1, shape[1]):
            score[:, n] = 0.6 * score[:, n - 1] + 0.8 * score[:, n]
    contact = {
        "chain": 1 + np.cumsum(np.ones(shape, dtype=int), axis=1) % 2,
        "free": rng.integers(1, 3, size=shape),
    }[kind]
    return xr.Dataset(
        {
            "impact_velocity": (("particle", "impact"), np.full(shape, 0.35)),
            "restitution": (("particle", "impact"), score),
            "contact": (("particle", "impact"), contact.astype(np.int8)),
        }
    )


def test_dependence_of_known_sequences() -> None:
    """AR(1) of 0.6: ranks correlate by (6/π) arcsin(0.6^k/2), signs change with probability arccos(0.6)/π.

    Within five standard errors; independent impacts have 0, ½ and runs of 2.
    """
    chain = fit.dependence(sequences("chain"), [0.2, 0.3, 0.4], lags=3).isel(velocity=1)
    exact = 6 / np.pi * np.arcsin(0.6 ** np.arange(1, 4) / 2)
    assert np.all(np.abs(chain.autocorrelation - exact) < 5 * chain.autocorrelation_error)
    crossing = np.arccos(0.6) / np.pi
    assert abs(chain.crossing - crossing) < 5 * chain.crossing_error
    assert abs(chain.run - 1 / crossing) < 5 * chain.run_error
    assert float(chain.alternation) == 1.0
    assert int(chain.pairs) == 400 * 99
    free = fit.dependence(sequences("free"), [0.2, 0.3, 0.4], lags=3)
    assert np.isnan(free.alternation[0])  # no impacts there
    free = free.isel(velocity=1)
    assert np.all(np.abs(free.autocorrelation) < 5 * free.autocorrelation_error)
    assert 0.003 < float(free.autocorrelation_error[0]) < 0.007  # 1/√39 600 = 0.005
    assert abs(free.alternation - 0.5) < 5 * free.alternation_error
    assert abs(free.run - 2.0) < 5 * free.run_error


def test_bad_input_is_named() -> None:
    x = [1.0, 2.0, 4.0]
    edges = np.array([0.0, 1.0, 2.0])
    data = scaled_flanks(10, 1)
    one = fit.slopes(data, [0.1, 0.3, 0.5], resamples=2)
    cases: list[tuple[Callable[[], Any], str]] = [
        (lambda: fit.bootstrap(fit.gaussian, x, resamples=1), "resamples = 1: at least two"),
        (lambda: fit.bootstrap(fit.gaussian, x, [1]), "clusters: 1 values"),
        (lambda: fit.bootstrap(fit.gaussian, x, [1, 1, 1]), "clusters: all samples are in one"),
        (lambda: fit.bootstrap(fit.gaussian, x, resamples=2).interval("mean", 1.0), "confidence = 1.0: must"),
        (lambda: fit.bootstrap(fit.gaussian, Counts(edges, np.ones(2))), "samples: one set of counts"),
        (lambda: fit.bootstrap(fit.gaussian, [Counts(edges, np.ones(2))]), "counts: all samples are in one"),
        (
            lambda: fit.bootstrap(fit.gaussian, [Counts(edges, np.ones(2)), Counts(edges + 1, np.ones(2))]),
            "counts: must all have the same edges",
        ),
        (
            lambda: fit.goodness(fit.gaussian, [Counts(edges, np.ones(2))] * 2, clusters=[1, 2]),
            "clusters: counts are drawn again run by run",
        ),
        (lambda: Counts(edges, np.ones(3)), r"count: shape \(3,\)"),
        (lambda: Counts(edges[::-1], np.ones(2)), "edges: must be finite and strictly increasing"),
        (lambda: Counts(edges, np.array([1.0, -1.0])), r"count: holds \[-1.\]"),
        (lambda: Counts(edges, np.array([1.0, 0.0])), r"count: 1 bin\(s\) filled"),
        (lambda: fit.slopes(data), "velocity_bins: missing"),
        (
            lambda: fit.slopes(rs.reduce(data, [0.1, 0.5], [0.0, 1.0]), [0.1, 0.5]),
            "velocity_bins: counts have",
        ),
        (lambda: one.power_law("left"), "side = 'left': must be 'above' or 'below'"),
        (lambda: one.power_law("above"), "low = 0.0, high = inf: fewer than three bins"),
        (lambda: fit.dependence(sequences("free"), [0.0, 1.0], lags=0), "lags = 0: must be at least 1"),
    ]
    for call, message in cases:
        with pytest.raises(ValueError, match=message):
            call()
