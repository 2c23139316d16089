"""Errors, bands, criteria and p-values of correlated samples: against repetition and against theory."""

import re
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from scipy import stats

from reference.flanks import ABOVE, BELOW, CUSP, Array, binned, correlated, flanks, mixed
from restitution import fit


def test_errors_are_those_of_repetition_and_count_particles() -> None:
    """Thirty sets of correlated samples: the stated error of a width is its scatter, within 4/√58 of it.

    Single samples drawn again would say a third of that.
    """
    sets = [correlated(60, 20, seed) for seed in range(30)]
    found = [fit.bootstrap(fit.asymmetric_laplace, *one, resamples=40) for one in sets]
    scatter = np.std([one.fit.parameters["below"] for one in found], ddof=1)
    stated = np.sqrt(np.mean([one.standard_errors["below"] ** 2 for one in found]))
    assert abs(stated / scatter - 1) < 4 / np.sqrt(58)
    naive = fit.bootstrap(fit.asymmetric_laplace, sets[0][0], resamples=60).standard_errors["below"]
    assert naive < 0.5 * stated


@pytest.mark.slow
def test_intervals_cover_the_truth_as_often_as_they_say() -> None:
    """90 sets of 200 correlated particles: intervals and bands of 90 % hold the truth in 90 %.

    Within four binomial errors of 0.032; 79 resamples cost a percentile interval 0.02. Single samples drawn
    again hold it in half of the sets.
    """
    points = np.array([0.85, CUSP, 1.02])
    density = np.exp([-0.13 / BELOW, 0.0, -0.04 / ABOVE]) / (ABOVE + BELOW)
    family = partial(fit.asymmetric_laplace, location=CUSP)
    inside, naive, shown = [], [], []
    for seed in range(90):
        x, particle = correlated(200, 5, seed)
        found = fit.bootstrap(family, x, particle, resamples=79, seed=seed)
        inside.append([low < truth < high for low, truth, high in _intervals(found)])
        low, high = found.band(points, 0.9)
        shown.append((low < density) & (density < high))
        if seed < 30:
            alone = fit.bootstrap(family, x, resamples=79, seed=seed)
            naive.append([low < truth < high for low, truth, high in _intervals(alone)])
    allowed = 4 * np.sqrt(0.9 * 0.1 / 90)
    for covered in (np.mean(inside, axis=0), np.mean(shown, axis=0)):
        assert np.all(np.abs(covered - 0.88) < allowed), covered
    assert np.all(np.mean(naive, axis=0) < 0.88 - allowed)


def test_intervals_and_bands_are_of_95_percent_unless_said() -> None:
    found = fit.bootstrap(fit.gaussian, np.random.default_rng(3).normal(size=50), resamples=20)
    assert found.interval("mean") == found.interval("mean", 0.95) != found.interval("mean", 0.9)
    for usual, said in zip(found.band([0.0, 1.0]), found.band([0.0, 1.0], 0.95), strict=True):
        np.testing.assert_array_equal(usual, said)
        assert usual.shape == (2,)


def test_numbers_of_particles_are_told_apart_however_large() -> None:
    """As floating-point numbers these four would be one."""
    numbers = 2**62 + np.arange(4)
    found = fit.bootstrap(fit.gaussian, [1.0, 2.0, 4.0, 8.0], clusters=numbers, resamples=20)
    assert found.clusters == 4
    with pytest.raises(ValueError, match=r"^clusters\[0\] = .*must be whole numbers, one for each sample$"):
        fit.bootstrap(fit.gaussian, [1.0, 2.0], clusters=[2.0**63, 0.0])


def _intervals(found: fit.Bootstrap) -> list[tuple[float, float, float]]:
    ends = {name: found.interval(name, 0.9) for name in ("above", "below")}
    return [(ends[name][0], truth, ends[name][1]) for name, truth in (("above", ABOVE), ("below", BELOW))]


def test_the_penalty_grows_with_the_correlation() -> None:
    """tr(J H⁻¹) is the number of parameters for independent samples, 20 times that for twenty copies."""
    x = np.random.default_rng(2).normal(size=2000)
    alone = fit.bootstrap(fit.gaussian, x, resamples=200)
    assert alone.effective_parameters == pytest.approx(2.0, abs=0.6)  # mean of 200 χ² with 2 degrees: 0.14
    assert alone.aic == pytest.approx(alone.fit.aic, abs=1.2)
    copies = fit.bootstrap(fit.gaussian, np.repeat(x[:100], 20), np.repeat(np.arange(100), 20), resamples=200)
    assert copies.effective_parameters == pytest.approx(40.0, rel=0.35)
    assert alone.effective_samples == pytest.approx(2000, rel=0.3)
    assert copies.effective_samples == pytest.approx(100, rel=0.35)
    assert copies.bic - copies.aic == pytest.approx(copies.effective_parameters * (np.log(100) - 2))


@pytest.mark.slow
def test_p_values_are_uniform_under_correlation() -> None:
    """Eighty sets of correlated samples of the family have uniform p-values.

    Kolmogorov–Smirnov against uniform, false alarm 1 in 1000.
    """
    sets = [correlated(200, 5, seed) for seed in range(80)]
    how: dict[str, Any] = {"resamples": 39}
    found = [
        fit.goodness(fit.asymmetric_laplace, x, clusters=particle, seed=i, **how)
        for i, (x, particle) in enumerate(sets)
    ]
    jitter = np.random.default_rng(0).random(80) / 40
    for p in ([g.kolmogorov_smirnov_p for g in found], [g.anderson_darling_p for g in found]):
        assert stats.kstest(np.array(p) - jitter, "uniform").pvalue > 1e-3
    alike = [correlated(60, 20, seed)[0] for seed in range(40)]
    naive = [
        fit.goodness(fit.asymmetric_laplace, x, seed=i, **how).anderson_darling_p for i, x in enumerate(alike)
    ]
    # Taken as independent, more than half of the sets are rejected at the level of one tenth.
    assert np.mean(np.array(naive) <= 0.1) > 0.5


WRONG: dict[str, Callable[[Array], Array]] = {
    "uniform": lambda u: 0.9 + 0.16 * u,
    "two separate peaks": lambda u: np.where(u < 0.5, 0.85, 1.05) + 0.02 * stats.norm.ppf(2 * u % 1.0),
    "normal": lambda u: 0.98 + 0.03 * stats.norm.ppf(u),
}


@pytest.mark.parametrize("truth", WRONG)
@pytest.mark.parametrize(("particles", "each", "correlation"), [(120, 10, 0.5), (60, 20, 0.8), (240, 5, 0.0)])
def test_wrong_densities_are_rejected_though_the_cusp_is_free(
    truth: str, particles: int, each: int, correlation: float
) -> None:
    """1200 values of what has no cusp do not pass as asymmetric Laplace at 0.05 in any of 10 sets."""
    level, found = stats.norm(scale=1.0), []
    for seed in range(10):
        rng = np.random.default_rng([seed, each])
        score = np.sqrt(correlation) * rng.normal(size=(particles, 1))
        score = score + np.sqrt(1.0 - correlation) * rng.normal(size=(particles, each))
        x, particle = WRONG[truth](level.cdf(score)), np.repeat(np.arange(particles), each)
        judged = fit.goodness(fit.asymmetric_laplace, x, clusters=particle, resamples=19, seed=seed)
        found.append(min(judged.kolmogorov_smirnov_p, judged.anderson_darling_p))
    assert max(found) <= 0.05


def test_families_get_their_keywords() -> None:
    """The location of the cusp reaches the family, of samples, of their bootstrap and of a mixture."""
    x, particle = correlated(100, 5, 3)
    how: dict[str, Any] = {"clusters": particle, "resamples": 9}
    given = fit.goodness(fit.asymmetric_laplace, x, location=CUSP, **how)
    assert given == fit.goodness(partial(fit.asymmetric_laplace, location=CUSP), x, **how)
    assert given.fit.parameters["location"] == CUSP
    assert fit.goodness(fit.cusp_mixture, x, location=CUSP, **how).fit.parameters["location"] == CUSP
    found = fit.bootstrap(fit.asymmetric_laplace, x, location=CUSP, **how)
    assert found.standard_errors["location"] == 0.0
    with pytest.raises(ValueError, match="unexpected keyword argument 'locations'"):
        fit.goodness(fit.asymmetric_laplace, x, locations=CUSP, **how)


def test_a_parameter_that_ran_to_its_end_says_so() -> None:
    rng = np.random.default_rng(5)
    normal, one_sided = rng.normal(0.98, 0.03, 1000), 1.0 - rng.exponential(0.05, 1000)
    edges = np.linspace(0.4, 1.2, 81)
    for take in (lambda x: x, lambda x: binned(x, edges)):
        assert "degrees of freedom are so many that" in str(fit.student_t(take(normal)))
        assert "cusp is at the end of the samples" in str(fit.asymmetric_laplace(take(one_sided)))
    assert "exponent is at the end" in fit.asymmetric_power(rng.random(1000)).limit
    assert "one part is empty" in fit.cusp_mixture(normal, 0.98).limit
    x = correlated(200, 5, 1)[0]
    heavy = fit.student_t(rng.standard_t(4.0, 1000))
    for found in (
        fit.asymmetric_laplace(x),
        fit.asymmetric_power(x),
        fit.cusp_mixture(mixed(2000, 1), CUSP),
        heavy,
    ):
        assert found.limit == ""


def test_a_fit_writes_a_table_for_latex() -> None:
    """Both columns of every row, and only characters that LaTeX has."""
    x, particle = correlated(100, 5, 3)
    found = fit.bootstrap(fit.asymmetric_laplace, x, particle, resamples=20, location=CUSP)
    rows = dict(re.findall(r"^(.*) & \$(.*)\$ \\\\$", found.to_latex(), re.MULTILINE))
    assert rows["location"] == "0.98"
    value, error = (float(part) for part in rows["below"].split(r" \pm "))
    assert value == pytest.approx(found.fit.parameters["below"], abs=error)
    assert error == pytest.approx(found.standard_errors["below"], rel=0.05)
    assert rows["samples"] == "500"
    assert found.to_latex().isascii()
    assert r"\pm" not in found.fit.to_latex()


def test_runs_of_counts_take_the_place_of_particles() -> None:
    """Counts of twenty runs: errors and p-values as from the samples behind them, drawn run by run."""
    rng = np.random.default_rng(4)
    edges = np.linspace(0.5, 1.3, 401)
    runs = [flanks(rng.random(500)) for _ in range(20)]
    counts = [binned(run, edges) for run in runs]
    found = fit.bootstrap(fit.asymmetric_laplace, counts, resamples=9)
    samples = fit.bootstrap(
        fit.asymmetric_laplace, np.concatenate(runs), np.repeat(np.arange(20), 500), resamples=9
    )
    assert found.clusters == 20
    assert found.fit.parameters["below"] == pytest.approx(samples.fit.parameters["below"], rel=5e-3)
    ratio = found.standard_errors["below"] / samples.standard_errors["below"]
    assert 0.4 < ratio < 2.5  # both know their error to a quarter
    assert fit.goodness(fit.asymmetric_laplace, counts, resamples=9).kolmogorov_smirnov_p > 0.1
    assert fit.goodness(fit.gaussian, counts, resamples=19).kolmogorov_smirnov_p == 0.05
