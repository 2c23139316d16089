"""Data that fits refuse, by name, and survive: few, equal, enormous, heavy-tailed, empty, infinite."""

import time
import tracemalloc
from collections.abc import Callable
from functools import partial
from typing import Any, cast

import numpy as np
import pytest
import xarray as xr
from scipy import stats

import restitution as rs
from reference.flanks import CUSP, flanks, scaled_flanks
from restitution import fit
from restitution.fit import Counts

HARD: dict[str, Any] = {
    "two": np.array([0.9, 1.1]),
    "two values": np.repeat([0.9, 1.0], 50),
    "all but one equal": np.append(np.full(999, CUSP), 0.99),
    "Cauchy": np.random.default_rng(0).standard_cauchy(5000),
    "infinite mean": CUSP + np.random.default_rng(0).pareto(0.5, 5000),
    "enormous": 1e99 * np.random.default_rng(0).normal(size=100),
    "narrow": CUSP + 1e-14 * np.random.default_rng(0).normal(size=100),
    "one-sided": CUSP + np.random.default_rng(0).exponential(size=200),
    "integers": np.arange(10),
}
FAMILIES: dict[str, Callable[..., fit.Fit]] = {
    "asymmetric_laplace": fit.asymmetric_laplace,
    "asymmetric_power": fit.asymmetric_power,
    "fixed asymmetric_power": partial(fit.asymmetric_power, location=CUSP),
    "gaussian": fit.gaussian,
    "laplace": fit.laplace,
    "logistic": fit.logistic,
    "student_t": fit.student_t,
    "cusp_mixture": partial(fit.cusp_mixture, location=CUSP),
}

REFUSED = {("cusp_mixture", "two"), ("student_t", "all but one equal")}
"""Five parameters of two samples, and a density that has no largest likelihood; tests of their own say so."""


@pytest.mark.parametrize("name", HARD)
def test_hard_samples_give_a_finite_likelihood(name: str) -> None:
    """No family warns, and none ends at a likelihood that is not a number, or takes seconds."""
    for which, family in FAMILIES.items():
        if (which, name) in REFUSED:
            continue
        started = time.process_time()
        found = family(HARD[name])
        assert np.isfinite(found.loglikelihood), which
        assert np.all(np.isfinite(list(found.parameters.values()))), which
        assert time.process_time() - started < 5, which


def test_the_logarithm_of_the_laplace_density_does_not_underflow() -> None:
    """At 2000 decay lengths the density is 0 in floating point, its logarithm is not."""
    x = np.append(np.tile([-1.0, 1.0], 1000), 4e3)
    found = fit.laplace(x)
    scale = found.parameters["scale"]
    assert scale == pytest.approx((2000 + 4e3) / 2001, rel=1e-3)
    far = -np.log(2 * scale) - np.abs(x - found.parameters["location"]) / scale
    assert found.loglikelihood == pytest.approx(far.sum())
    assert found.pdf(1e4 * scale) == 0.0
    assert found.logpdf(1e4 * scale) == pytest.approx(-np.log(2 * scale) - 1e4, rel=1e-3)


def test_a_million_samples_take_a_second_and_little_memory() -> None:
    """The exact fit sorts once: fifteen arrays of the size of the samples at most, 1 µs a sample."""
    x = flanks(np.random.default_rng(1).random(1_000_000))
    started = time.process_time()
    tracemalloc.start()
    fit.asymmetric_laplace(x)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert time.process_time() - started < 3
    assert peak < 15 * x.nbytes


def test_huge_counts_are_no_harder_than_few() -> None:
    """10¹⁵ samples in bins: the parameters are those of 10⁹ with the same shares."""
    edges = np.linspace(0.5, 1.3, 201)
    shares = np.diff(fit.asymmetric_laplace(flanks(np.random.default_rng(1).random(2000))).cdf(edges))
    few, many = (fit.asymmetric_laplace(Counts(edges, np.rint(n * shares))).parameters for n in (1e9, 1e15))
    assert list(few.values()) == pytest.approx(list(many.values()), rel=1e-5)


def test_impacts_without_a_coefficient_are_left_out() -> None:
    """ε = ±inf or NaN, as at v = 0, or too large for statistics: counted nowhere, as in `reduce`."""
    data = scaled_flanks(40, 1)
    v = data.impact_velocity.to_numpy()
    e = data.restitution.to_numpy().copy()
    for row, value in enumerate((np.inf, -np.inf, np.nan, 1e10)):
        e[row] = value
    spoiled = data.assign(restitution=(("particle", "impact"), e))
    window = (0.2, 0.4)
    found = fit.laplace(spoiled, velocity=window)
    assert found == fit.laplace(data.isel(particle=slice(4, None)), velocity=window)
    counted = rs.reduce(spoiled, [0.2, 0.4], np.linspace(0.0, 2.0, 201))
    assert fit.laplace(counted, velocity=0.3).samples == found.samples
    slopes = fit.slopes(spoiled, [0.1, 0.2, 0.4], resamples=2).table
    assert int(slopes.samples[1]) == np.sum((v[4:] >= 0.2) & (v[4:] < 0.4))


def test_bins_that_say_nothing_stay_empty() -> None:
    """Too few samples or particles, equal ones, or counts in fewer bins than parameters: NaN, no error."""
    data = scaled_flanks(200, 1)
    edges = [0.1, 0.2, 0.4, 5.0, 6.0]
    found = fit.slopes(data, edges, resamples=3).table
    assert np.isfinite(found.above[:2]).all()
    assert np.isnan(found.above[3])
    assert np.isnan(fit.slopes(data.isel(particle=slice(9)), edges, resamples=3).table.above).all()
    level = data.assign(restitution=xr.full_like(data.restitution, 0.9))
    assert np.isnan(fit.slopes(level, edges, resamples=3).table.above).all()
    coarse = rs.reduce(data, [0.1, 0.3, 0.5], [0.0, CUSP, 2 * CUSP])
    assert np.isnan(fit.slopes(coarse).table.above).all()
    assert np.isnan(fit.slopes(data, [5.0, 6.0], resamples=3).fails_below())


def test_bad_input_is_named() -> None:
    x = [1.0, 2.0, 4.0]
    edges = np.array([0.0, 1.0, 2.0])
    data = scaled_flanks(10, 1)
    one = fit.slopes(data, [0.1, 0.3, 0.5], resamples=2)
    wide = fit.slopes(data, np.linspace(0.1, 0.5, 5), resamples=2)
    cases: list[tuple[Callable[[], Any], str]] = [
        (
            lambda: fit.bootstrap(fit.gaussian, x, resamples=1),
            r"resamples = 1: must be a whole number in \[2, 1000000\]",
        ),
        (lambda: fit.bootstrap(fit.gaussian, x, [1]), "clusters: 1 values"),
        (lambda: fit.bootstrap(fit.gaussian, x, [1, 1, 1]), "clusters: all samples are in one"),
        (lambda: fit.bootstrap(fit.gaussian, x, resamples=2).interval("mean", 1.0), "confidence = 1.0: must"),
        (lambda: fit.bootstrap(fit.gaussian, x, resamples=2).interval("mean", 0.0), "confidence = 0.0: must"),
        (lambda: fit.bootstrap(fit.gaussian, x, resamples=2, seed=-1), "seed = -1: must be a whole number"),
        (
            lambda: fit.bootstrap(fit.gaussian, x, resamples=2).draws("width"),
            "name = 'width': must be 'mean' or 'deviation'$",
        ),
        (
            lambda: fit.bootstrap(cast(Any, x), x),
            r"family = \[1.0, 2.0, 4.0\]: must be a function from samples to a Fit$",
        ),
        (
            lambda: fit.bootstrap(cast(Any, len), x),
            "family = <built-in function len>: must be a function from samples to a Fit; it gave 3$",
        ),
        (
            lambda: fit.bootstrap(cast(Any, {}.__getitem__), x),
            "family = .* gave TypeError: .*unhashable .*: must be a function to a Fit$",
        ),
        (lambda: fit.bootstrap(fit.gaussian, data, [1]), "clusters: a Dataset knows its particles"),
        (lambda: fit.bootstrap(fit.gaussian, Counts(edges, np.ones(2))), "samples: one set of counts"),
        (lambda: fit.bootstrap(fit.gaussian, [Counts(edges, np.ones(2))]), "counts: all samples are in one"),
        (
            lambda: fit.bootstrap(fit.gaussian, [Counts(edges, np.ones(2)), Counts(edges + 1, np.ones(2))]),
            "counts: must all have the same edges",
        ),
        (
            lambda: fit.goodness(fit.gaussian, [Counts(edges, np.ones(2))] * 2, clusters=[1, 2]),
            "clusters: must be left out, because counts are drawn again run by run",
        ),
        (lambda: Counts(edges, np.ones(3)), r"count = .*: must be a 1-D array of 2 counts"),
        (lambda: Counts(edges[::-1], np.ones(2)), "edges goes from 2.0 to 1.0: edges must increase"),
        (lambda: Counts(edges, np.array([1.0, -1.0])), r"count\[1\] = -1.0: must be a whole number in"),
        (lambda: Counts(edges, np.array([1.0, 0.0])), r"count: 1 bin\(s\) filled"),
        (lambda: fit.slopes(data), "velocity_bins: missing"),
        (
            lambda: fit.slopes(rs.reduce(data, [0.1, 0.5], [0.0, 1.0]), [0.1, 0.5]),
            "velocity_bins: counts have",
        ),
        (lambda: one.power_law("left"), "side = 'left': must be 'above' or 'below'"),
        (lambda: wide.power_law("above", release_speed=0.3), "release_speed = 0.3: must be above 0.45 m/s"),
        (lambda: one.power_law("above"), "low = 0.0, high = inf: fewer than three bins"),
        (
            lambda: fit.dependence(data, [0.0, 1.0], lags=0),
            r"lags = 0: must be a whole number in \[1, 10000\]",
        ),
    ]
    statistics = rs.reduce(data, np.linspace(0.1, 0.5, 5), np.linspace(0.0, 2.0, 201))
    by_impact = statistics.drop_vars("velocity_edges")
    four = Counts(np.arange(4.0), np.array([5.0, 3.0, 2.0]))
    cases += [
        (lambda: fit.laplace(data), "velocity = None: recorded impacts need a window"),
        (lambda: fit.laplace(data, velocity=0.3), "velocity = 0.3: recorded impacts need a window"),
        (lambda: fit.laplace(data, velocity=(0.4, 0.3)), r"velocity = \(0.4, 0.3\): must be a window"),
        (lambda: fit.laplace(data, velocity=(np.nan, 0.3)), r"velocity = \(nan, 0.3\): must be a window"),
        (lambda: fit.laplace(data, velocity=(5.0, 6.0)), r"velocity = \(5.0, 6.0\): must be a window that"),
        (lambda: fit.laplace(x, velocity=(0.1, 0.2)), "velocity = .*: is for a Dataset"),
        (lambda: fit.goodness(fit.laplace, x, velocity=0.2), "velocity = 0.2: is for a Dataset"),
        (lambda: fit.bootstrap(fit.laplace, x, velocity=0.2), "velocity = 0.2: is for a Dataset"),
        (lambda: fit.laplace(statistics), "velocity: missing; statistics need a number or a window"),
        (lambda: fit.laplace(statistics, velocity=2.0), r"velocity = 2.0: must be in \[0.1, 0.5\) m/s"),
        (
            lambda: fit.laplace(statistics, velocity=(0.2, 0.37)),
            "must be edges of velocity bins",
        ),
        (lambda: fit.laplace(by_impact, velocity=0.2), "samples: statistics without velocity bins"),
        (lambda: fit.slopes(by_impact), "data: statistics without velocity bins"),
        (lambda: fit.laplace(xr.Dataset(), velocity=(0.1, 0.2)), "samples lacks impact_velocity"),
        (lambda: fit.slopes(data.drop_vars("restitution"), [0.1, 0.2]), "data lacks restitution"),
        (lambda: fit.dependence(data, [0.1, 0.2]), "data lacks contact"),
        (
            lambda: fit.slopes(data, [0.1, 0.2], resamples=1),
            r"resamples = 1: must be a whole number in \[2, 1000000\]",
        ),
        (lambda: fit.bootstrap(fit.laplace, statistics, velocity=0.2), "samples: one set of counts"),
        (lambda: fit.bootstrap(fit.laplace, data, [1], velocity=(0.1, 0.2)), "clusters: a Dataset knows its"),
        (
            lambda: fit.gaussian(Counts(edges, np.ones(2))),
            "2 bins are filled; 2 parameters need at least 3",
        ),
        (lambda: fit.asymmetric_laplace(four), "count: 3 bins are filled; 3 parameters need at least 4"),
        (lambda: fit.asymmetric_laplace(four, np.nan), "location = nan: must be a finite"),
        (lambda: fit.cusp_mixture(x, 1.0), "samples: 3 value"),
        (lambda: fit.bootstrap(fit.laplace, [1.0, 1.0, 2.0, 2.0], [0, 0, 1, 1]), "clusters: 2 are too few"),
        (lambda: fit.gaussian([1.0, 1e101]), r"samples: magnitudes up to 1e\+101"),
    ]
    for call, message in cases:
        with pytest.raises(ValueError, match=message):
            call()


def test_student_t_is_not_fitted_to_a_single_value() -> None:
    """At k of n equal samples L ~ s^(ν(n−k) − k) grows without bound as s falls, for ν < k/(n−k)."""
    x = np.random.default_rng(3).standard_t(3.0, 2000)
    few, many = x.copy(), x.copy()
    few[:200] = many[:1000] = 0.3
    assert fit.student_t(few).parameters["scale"] > 0.5
    with pytest.raises(ValueError, match=r"samples: 1000 of 2000 are 0.3; must be fewer: Student's t has no"):
        fit.student_t(many)
    # The search is right to go there: half a degree, and ever more likely the nearer.
    likelihoods = [stats.t(0.5, 0.3, scale).logpdf(many).sum() for scale in (1e-3, 1e-6, 1e-9, 1e-12)]
    assert np.all(np.diff(likelihoods) > 100)


def test_a_table_of_records_is_not_one_sample() -> None:
    """Times, speeds and angles among the values would be fitted as well."""
    table = rs.simulate(
        rs.Dumbbell(radius=3e-3, separation=3e-4),
        rs.TangentialRestitution(normal=0.98),
        particles=2,
        impacts=50,
    ).to_dataframe()
    text = r"^samples: a table of .*restitution.*; must be one column, such as that of restitution$"
    for take in (fit.laplace, partial(fit.goodness, fit.gaussian), partial(fit.bootstrap, fit.gaussian)):
        with pytest.raises(ValueError, match=text):
            take(table)
    assert fit.laplace(table["restitution"].dropna()).samples == 100
