"""Pairs of fits, goodness, counts and mixtures, worked out again in loops over single values."""

import pickle
from itertools import pairwise
from math import erfc, exp, inf, log, sqrt
from statistics import fmean, stdev
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy import optimize, stats

from reference.scattered import distance, impacts
from restitution import fit
from restitution.fit._asymmetric import frozen
from restitution.fit._mixture import Mixture

Counts: Any = fit.Counts  # lists are taken, though its fields are arrays


def two_fits(samples: Any) -> tuple[fit.Fit, fit.Fit]:
    return fit.gaussian(samples), fit.laplace(samples)


def test_vuong_test_over_clusters_and_runs() -> None:
    """Squares of the sums of each of G particles or runs, times G/(G - 1); the p-value of the normal."""
    rng = np.random.default_rng(8)
    x = rng.normal(0.9, 0.05, 60)
    labels = rng.integers(0, 7, 60)
    first, second = two_fits(x)
    gain = np.array([float(first.logpdf(one) - second.logpdf(one)) for one in x])
    mean = fmean(gain)
    sums = [sum(gain[labels == k] - mean) for k in range(7)]
    found = fit.compare(first, second, x, labels)
    assert found.difference == pytest.approx(mean, rel=1e-12)
    error = sqrt(sum(s**2 for s in sums) * 7 / 6) / 60
    assert found.standard_error == pytest.approx(error, rel=1e-12)
    assert found.z == pytest.approx(mean / error, rel=1e-12)
    assert found.p == pytest.approx(2 * stats.norm.sf(abs(mean / error)), rel=1e-12)
    free = fit.compare(first, second, x)
    assert free.standard_error == pytest.approx(stdev(gain) / sqrt(60), rel=1e-12)

    edges = np.linspace(0.7, 1.1, 9)
    runs = []
    for _ in range(4):
        y = rng.normal(0.9, 0.08, 50)
        count, _ = np.histogram(y, edges)
        runs.append(Counts(edges, count, int(np.sum(y < 0.7)), int(np.sum(y > 1.1))))
    every = Counts(edges, sum(r.count for r in runs), sum(r.below for r in runs), sum(r.above for r in runs))
    first, second = two_fits(every)

    def logs(one: fit.Fit) -> list[float]:
        d = one.distribution
        shares = [d.cdf(edges[0]), *(d.cdf(b) - d.cdf(a) for a, b in pairwise(edges))]
        return [log(share) for share in [*shares, d.sf(edges[-1])]]

    per_bin = [a - b for a, b in zip(logs(first), logs(second), strict=True)]
    mean = sum(n * g for n, g in zip(every.all, per_bin, strict=True)) / every.total
    sums = [sum(n * (g - mean) for n, g in zip(r.all, per_bin, strict=True)) for r in runs]
    tallied = fit.compare(first, second, runs)
    assert tallied.difference == pytest.approx(mean, rel=1e-9)
    assert tallied.standard_error == pytest.approx(
        sqrt(sum(s**2 for s in sums) * 4 / 3) / every.total, rel=1e-9
    )


def test_a_difference_without_error() -> None:
    assert fit.Comparison(0.0, 0.0).z == 0.0
    assert fit.Comparison(0.5, 0.0).z == inf
    assert fit.Comparison(-0.5, 0.0).z == -inf
    assert fit.Comparison(1.0, 0.5).p == pytest.approx(erfc(sqrt(2)), rel=1e-14)
    assert pickle.loads(pickle.dumps(fit.Comparison(0.5, 0.25))).z == 2.0


def test_the_statistics_of_goodness_are_those_of_scipy() -> None:
    """D by `kstest`; A² by its sum; both p-values are shares of refitted draws, the samples counted in."""
    x = np.random.default_rng(9).normal(0.9, 0.05, 25)
    for samples in (x, np.full(25, 0.9) + np.where(np.arange(25) < 24, 1e-3 * np.arange(25), 9.0)):
        found = fit.goodness(fit.gaussian, samples, resamples=20, seed=3)
        one = fit.gaussian(samples)
        assert found.kolmogorov_smirnov == pytest.approx(distance(samples, one), rel=1e-12)
        assert found.resamples == 20
        assert (found.kolmogorov_smirnov_p * 21) % 1 == pytest.approx(0, abs=1e-9)
    one, y = fit.gaussian(x), np.sort(x)
    terms = [
        (2 * i + 1) * (float(one.distribution.logcdf(y[i])) + float(one.distribution.logsf(y[-1 - i])))
        for i in range(25)
    ]
    found = fit.goodness(fit.gaussian, x, resamples=20, seed=3)
    assert found.anderson_darling == pytest.approx(-25 - sum(terms) / 25, rel=1e-9)
    again = np.random.default_rng(3)
    reached = 1
    for _ in range(20):
        draw = one.distribution.rvs(size=25, random_state=again)
        reached += int(distance(draw, fit.gaussian(draw)) >= found.kolmogorov_smirnov)
    assert found.kolmogorov_smirnov_p == pytest.approx(reached / 21, rel=1e-12)


def test_goodness_with_clusters_asks_the_same_of_all_its_doors() -> None:
    """A Dataset's particles, given clusters and single values as lists; the sides of a distance below."""
    data = impacts(particles=9, each=20, seed=3)
    v, e = data["impact_velocity"].to_numpy(), data["restitution"].to_numpy()
    inside = (v >= 0.3) & (v < 0.6) & np.isfinite(e)
    labels = np.nonzero(inside)[0]
    by_data = fit.goodness(fit.gaussian, data, velocity=(0.3, 0.6), resamples=5, seed=2)
    by_label = fit.goodness(fit.gaussian, e[inside], clusters=labels, resamples=5, seed=2)
    assert by_data.kolmogorov_smirnov_p == by_label.kolmogorov_smirnov_p
    assert by_data.anderson_darling == pytest.approx(by_label.anderson_darling, rel=1e-12)
    assert by_data.resamples == by_label.resamples == 5
    first, second = two_fits(e[inside])
    assert fit.compare(first, second, data, velocity=(0.3, 0.6)) == fit.compare(
        first, second, e[inside], labels
    )
    as_list = fit.goodness(fit.gaussian, e[inside].tolist(), resamples=5, seed=2)
    as_array = fit.goodness(fit.gaussian, e[inside], resamples=5, seed=2)
    assert as_list == as_array
    few = e[inside][:20]
    assert fit.goodness(fit.gaussian, few) == fit.goodness(fit.gaussian, few, resamples=199, seed=1)
    edges = np.linspace(0.5, 1.3, 17)
    runs = [Counts(edges, np.histogram(part, edges)[0]) for part in (e[:4], e[4:])]
    tallied = fit.goodness(fit.gaussian, runs, resamples=5, seed=2)
    counted = fit.gaussian(Counts(edges, runs[0].count + runs[1].count))
    share = np.concatenate([[0], np.cumsum(runs[0].count + runs[1].count)]) / counted.samples
    assert tallied.kolmogorov_smirnov == pytest.approx(np.max(np.abs(share - counted.cdf(edges))), rel=1e-9)
    for call in (
        lambda: fit.goodness(fit.gaussian, e[inside], velocity=(0.3, 0.6)),
        lambda: fit.compare(first, second, e[inside], velocity=(0.3, 0.6)),
    ):
        with pytest.raises(ValueError, match="velocity"):
            call()
    with pytest.raises(ValueError, match="seed = -1"):
        fit.goodness(fit.gaussian, e[inside], seed=-1)
    with pytest.raises(ValueError, match="resamples = 1000001: must be"):
        fit.goodness(fit.gaussian, e[inside], resamples=1_000_001)
    wrong: Any = "no fit"
    with pytest.raises(ValueError, match="first = 'no fit': must be a Fit"):
        fit.compare(wrong, second, e[inside])
    with pytest.raises(ValueError, match="second = 'no fit': must be a Fit"):
        fit.compare(first, wrong, e[inside])


def test_draws_of_a_fit() -> None:
    one = fit.gaussian(np.random.default_rng(1).normal(0.9, 0.1, 100))
    mean, deviation = one.parameters["mean"], one.parameters["deviation"]
    expected = stats.norm(mean, deviation).rvs(size=4, random_state=np.random.default_rng(7))
    np.testing.assert_array_equal(one.rvs(4, 7), expected)
    np.testing.assert_array_equal(one.rvs(4), one.rvs(4, seed=1))
    assert one.rvs(0).shape == (0,)
    assert one.family == "Gaussian"
    assert one.free_parameters == 2
    with pytest.raises(ValueError, match="size = -1"):
        one.rvs(-1)
    with pytest.raises(ValueError, match="size = 1000000000000: must be"):
        one.rvs(10**12)
    with pytest.raises(ValueError, match="seed = -1"):
        one.rvs(1, -1)
    assert one.cdf(inf) == 1.0
    assert one.cdf(-inf) == 0.0
    with pytest.raises(ValueError, match="x = 'a': must be numbers"):
        one.pdf("a")


def test_maxima_of_counts_of_all_families() -> None:
    """The likelihood of a multinomial, maximised by another search from the fitted point and from afar."""
    rng = np.random.default_rng(11)
    x = 0.9 + 0.04 * rng.standard_t(4, 4000)
    edges = np.linspace(0.75, 1.05, 31)
    count, _ = np.histogram(x, edges)
    counts = Counts(edges, count, int(np.sum(x < 0.75)), int(np.sum(x > 1.05)))
    families: tuple[tuple[Any, Any, int], ...] = (
        (fit.gaussian, stats.norm, 0),
        (fit.laplace, stats.laplace, 0),
        (fit.logistic, stats.logistic, 0),
        (fit.student_t, stats.t, 1),
    )
    for family, kind, shapes in families:

        def likelihood(point: np.ndarray, kind: Any = kind, shapes: int = shapes) -> float:
            given = [*np.exp(point[2:]), point[0], exp(point[1])]
            assert len(given) == 2 + shapes
            below = kind(*given).cdf(edges)
            share = np.diff(np.concatenate([[0.0], below, [1.0]]))
            return -float(counts.all @ np.log(np.maximum(share, 1e-300)))

        found = family(counts)
        start = [0.9, log(0.05), log(5.0)][: 2 + shapes]
        best = optimize.minimize(likelihood, start, method="Powell", options={"xtol": 1e-9, "ftol": 1e-14})
        assert found.loglikelihood == pytest.approx(-best.fun, rel=1e-9)
        named = dict(found.parameters)
        width = named.get("scale", named.get("deviation"))
        assert width == pytest.approx(exp(best.x[1]), rel=1e-4)


def test_counts_are_told_apart_and_named() -> None:
    edges = np.linspace(0.8, 1.0, 5)
    one = Counts(edges, [1, 2, 3, 4], 5, 6)
    assert (one.below, one.above, one.total) == (5, 6, 21)
    with pytest.raises(ValueError, match=r"count.*must be a 1-D array of 4 counts"):
        Counts(edges, [[1, 2, 3, 4]])
    for array in (one.edges, one.count):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    # A whole 2**53 is the most that doubles count.
    assert Counts(edges, [2**53, 1, 0, 0]).count[0] == 2.0**53
    table = xr.Dataset(
        {
            "restitution_count": (("velocity", "restitution"), [[1, 2, 3, 4], [4, 3, 2, 1]]),
            "restitution_underflow": ("velocity", [7, 8]),
            "restitution_overflow": ("velocity", [9, 10]),
            "number": ("velocity", [26, 28]),
            "velocity_edges": ("velocity_edge", [0.2, 0.4, 0.8]),
            "restitution_edges": ("restitution_edge", edges),
        },
        coords={"velocity": [0.3, 0.6], "restitution": (edges[1:] + edges[:-1]) / 2},
    )
    second = Counts.at(table, 0.4)
    assert second.count.tolist() == [4, 3, 2, 1]
    assert (second.below, second.above) == (8, 10)
    wrong: Any
    for wrong, text in (
        (np.nan, "velocity = nan: must be a speed in m/s, in one of the velocity bins"),
        (xr.DataArray(0.3, attrs={"units": "mm/s"}), "velocity.*m s-1"),
        (0.8, r"velocity = 0\.8: must be in \[0\.2, 0\.8\) m/s"),
    ):
        with pytest.raises(ValueError, match=text):
            Counts.at(table, wrong)
    with pytest.raises(ValueError, match="statistics"):
        Counts.at(3, 0.3)
    np.testing.assert_allclose(one.quantile([0.0, 1.0]), [0.8, 1.0])
    assert one.quantile([inf])[0] == 1.0
    halves = [Counts(edges, [1, 0, 3, 1], 2, 3), Counts(edges, [0, 2, 0, 3], 3, 3)]
    compared = fit.compare(*two_fits(one), halves)
    assert compared.difference == pytest.approx(
        (one.loglikelihood(fit.gaussian(one).distribution) - one.loglikelihood(fit.laplace(one).distribution))
        / 21,
        rel=1e-12,
    )


def test_standard_errors_are_of_a_sample() -> None:
    """Deviations with n - 1; intervals between the quantiles that leave out half of the rest on each side."""
    fits = tuple(
        fit.Fit("any", MappingProxyType({"a": a}), 1, 10, 0.0, stats.norm()) for a in (1.0, 2.0, 4.0, 8.0)
    )
    given = fit.Bootstrap(fits[0], fits, 5, 1.0)
    assert given.standard_errors["a"] == pytest.approx(stdev([1, 2, 4, 8]), rel=1e-14)
    assert given.interval("a", 0.5) == pytest.approx((1.75, 5.0), rel=1e-14)
    for bad in (0.0, 1.0):
        with pytest.raises(ValueError, match=r"confidence = .*: must be a number in \(0, 1\)"):
            given.interval("a", bad)
    x = np.random.default_rng(2).normal(size=40)
    assert fit.bootstrap(fit.gaussian, x, resamples=3).draws("mean").size == 3
    assert fit.bootstrap(fit.gaussian, x) == fit.bootstrap(fit.gaussian, x, resamples=199, seed=1)


def test_a_mixture_is_the_sum_of_its_parts() -> None:
    """Densities weighted by their shares, also where they underflow; draws of a generator."""
    first, second, share = frozen(1.0, 0.95, 0.01, 0.01), stats.norm(0.8, 0.1), 0.3
    made = Mixture(share, first, second)
    x = np.array([[0.2, 0.7, 0.94], [0.95, 0.96, 1.4]])
    density = share * first.pdf(x) + (1 - share) * second.pdf(x)
    np.testing.assert_allclose(made.pdf(x), density, rtol=1e-14)
    np.testing.assert_allclose(made.logpdf(x), np.log(density), rtol=1e-13)
    assert made.logpdf(0.9) == pytest.approx(log(float(made.pdf(0.9))), rel=1e-13)
    assert made.logpdf(100.0) == pytest.approx(log(share / 0.02) - 99.05 / 0.01, rel=1e-12)
    assert Mixture(0.0, first, second).logpdf(0.9) == pytest.approx(second.logpdf(0.9), rel=1e-14)
    levels = np.array([[0.01, 0.2], [0.7, 0.999]])
    np.testing.assert_allclose(made.cdf(made.ppf(levels)), levels, rtol=1e-12)
    drawn = [made.rvs(20_000, np.random.default_rng(seed)) for seed in (1, 1, 2)]
    np.testing.assert_array_equal(drawn[0], drawn[1])
    for one in drawn[1:]:
        assert distance(one, made) < 0.016  # exceeded once in 10 000 times


def test_a_cusp_fit_is_a_maximum_of_its_likelihood() -> None:
    """No step of one parameter gains; it says how likely the samples are under its density."""
    rng = np.random.default_rng(12)
    x = np.concatenate([rng.laplace(0.95, 0.01, 300), rng.normal(0.85, 0.08, 500)])
    found = fit.cusp_mixture(x, 0.95)
    assert found.loglikelihood == pytest.approx(float(np.sum(np.log(found.pdf(x)))), rel=1e-12)
    given = dict(found.parameters)

    def likelihood(p: dict[str, float]) -> float:
        wide = np.where(x >= p["location"], p["above"], p["below"])
        cusp = np.exp(-np.abs(x - p["location"]) / wide) / (p["above"] + p["below"])
        gauss = stats.norm.pdf(x, p["mean"], p["deviation"])
        return float(np.sum(np.log(p["share"] * cusp + (1 - p["share"]) * gauss)))

    assert found.loglikelihood == pytest.approx(likelihood(given), rel=1e-12)
    for name in given.keys() - {"location"}:
        for step in (0.99, 1.01):
            assert likelihood(given | {name: step * given[name]}) < found.loglikelihood + 1e-4
    assert given["location"] == 0.95
    for bad in (np.nan, inf):
        with pytest.raises(ValueError, match=r"location = .*: must be a finite number"):
            fit.cusp_mixture(x, bad)
    for family in (fit.asymmetric_laplace, fit.cusp_mixture):
        with pytest.raises(ValueError, match=r"location = 1e\+200: must be a finite number, at most 1e100"):
            family(x, location=1e200)
    equal = fit.cusp_mixture(np.full(8, 0.9), 1.0)  # their own spread is 0: that from the cusp is taken
    assert np.isfinite(equal.loglikelihood)
    assert equal.parameters["deviation"] >= 1e-3 * 0.1 * (1 - 1e-9)
    assert equal.parameters["deviation"] < 0.01


def test_goodness_with_clusters_redraws_particles_of_samples_that_follow_the_fit() -> None:
    """Each sample becomes the quantile at its rank; particles of these are drawn again, and fitted again."""
    rng = np.random.default_rng(13)
    x, labels = rng.normal(0.9, 0.1, 40), np.repeat(np.arange(8), 5)
    found = fit.goodness(fit.gaussian, x, clusters=labels, resamples=30, seed=6)

    def both(samples: np.ndarray) -> tuple[float, float]:
        one, values = stats.norm(np.mean(samples), np.std(samples)), sorted(samples)
        far = max(
            max(np.mean(samples <= at) - one.cdf(at), one.cdf(at) - np.mean(samples < at)) for at in values
        )
        terms = [
            (2 * i + 1) * (one.logcdf(low) + one.logsf(high))
            for i, (low, high) in enumerate(zip(values, values[::-1], strict=True))
        ]
        return float(far), -len(values) - sum(terms) / len(values)

    ks, ad = both(x)
    assert found.kolmogorov_smirnov == pytest.approx(ks, rel=1e-10)
    assert found.anderson_darling == pytest.approx(ad, rel=1e-10)
    rank = [int(np.sum(x < value)) for value in x]
    null = stats.norm(np.mean(x), np.std(x)).ppf([(one + 0.5) / 40 for one in rank])
    draws, reached = np.random.default_rng(6), [1, 1]
    draws.random(40)  # the order among equal samples
    for _ in range(30):
        again = np.concatenate([null[5 * k : 5 * k + 5] for k in draws.integers(8, size=8)])
        reached = [n + (value >= top) for n, value, top in zip(reached, both(again), (ks, ad), strict=True)]
    assert found.kolmogorov_smirnov_p == pytest.approx(reached[0] / 31, rel=1e-12)
    assert found.anderson_darling_p == pytest.approx(reached[1] / 31, rel=1e-12)
