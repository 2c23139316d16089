"""Counts and moments against slow exact arithmetic, standard errors against repetition."""

from collections.abc import Callable
from fractions import Fraction
from itertools import pairwise
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import restitution as rs
from restitution._batches import batches_of, origin
from restitution._reduce import reduce, standard_errors
from restitution._statistics import statistics

V_EDGES = [-1.0, -0.5, 0.0, 0.5, 1.0]
E_EDGES = [-1.0, 0.0, 1.0, 2.0]
F_EDGES = [0.0, 0.25, 0.5, 0.75, 1.0]


def impacts(velocity: Any, restitution: Any, fraction: Any = None) -> xr.Dataset:
    """Data with one row a particle, as `simulate` gives them."""
    columns = {"impact_velocity": velocity, "restitution": restitution}
    columns["rotational_fraction"] = np.full(np.shape(velocity), 0.1) if fraction is None else fraction
    columns["energy_ratio"] = np.square(restitution)
    return xr.Dataset(
        {name: (("particle", "impact"), np.atleast_2d(values)) for name, values in columns.items()},
        attrs={"seed": 7},
    )


# Values on the edges, beside them, and off every scale; eighths have exact moments in floating point.
EIGHTHS = st.integers(-24, 24).map(lambda n: n / 8)
ODD = st.sampled_from([np.nan, np.inf, -np.inf, -0.0, 5e-324, np.nextafter(1.0, 0), np.nextafter(0.5, 1)])
ONE = st.tuples(EIGHTHS | ODD, EIGHTHS | ODD, EIGHTHS | ODD)


def member(x: float, edges: list[float]) -> int | None:
    """Index of the half-open bin of x by plain comparison, or None outside."""
    return next((k for k, (low, high) in enumerate(pairwise(edges)) if low <= x < high), None)


@settings(max_examples=150, deadline=None)
@given(st.lists(ONE, min_size=1, max_size=30))
def test_reduce_counts_like_plain_comparison(rows: list[tuple[float, float, float]]) -> None:
    """Every impact is put where comparing it with each edge in turn puts it, and none is lost."""
    found = reduce(impacts(*np.array(rows).T[:, None, :]), V_EDGES, E_EDGES, F_EDGES)
    count, fraction_count = np.zeros((4, 3), int), np.zeros((4, 4), int)
    undefined = np.zeros(4, int)
    outside = 0
    for v, e, f in rows:
        k = member(v, V_EDGES)
        if k is None:
            outside += not np.isnan(v)
        elif not (np.isfinite(e) and np.isfinite(f)):
            undefined[k] += 1
        else:
            if (j := member(e, E_EDGES)) is not None:
                count[k, j] += 1
            if (j := member(f, F_EDGES)) is not None:
                fraction_count[k, j] += 1
    np.testing.assert_array_equal(found["restitution_count"], count)
    np.testing.assert_array_equal(found["fraction_count"], fraction_count)
    np.testing.assert_array_equal(found["undefined"], undefined)
    assert int(found["velocity_underflow"] + found["velocity_overflow"]) == outside
    number = found["number"]
    happened = sum(not np.isnan(v) for v, _, _ in rows)
    assert int(outside + (number + undefined).sum()) == happened
    for grid, name in (("restitution_count", "restitution"), ("fraction_count", "fraction")):
        total = found[grid].sum(name) + found[f"{name}_underflow"] + found[f"{name}_overflow"]
        np.testing.assert_array_equal(total, number)


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(EIGHTHS, EIGHTHS), min_size=1, max_size=40))
def test_moments_equal_exact_rational_arithmetic(rows: list[tuple[float, float]]) -> None:
    """Mean to kurtosis in every bin agree with fractions to the rounding of a few dozen additions."""
    found = reduce(impacts(*np.array(rows).T[:, None, :]), V_EDGES, [0.0, 1.0])
    for k, (low, high) in enumerate(pairwise(V_EDGES)):
        values = [Fraction(e) for v, e in rows if low <= v < high]
        here = found.isel(velocity=k)
        assert int(here["number"]) == len(values)
        if not values:
            assert all(
                np.isnan(float(here[name]))
                for name in ("mean_restitution", "variance", "kurtosis", "minimum")
            )
            continue
        n = len(values)
        mean = sum(values, Fraction()) / n
        deviations = [x - mean for x in values]
        m2, m3, m4 = (sum((d**p for d in deviations), Fraction()) / n for p in (2, 3, 4))
        assert float(here["mean_restitution"]) == pytest.approx(float(mean), rel=1e-14, abs=1e-15)
        assert float(here["variance"]) == pytest.approx(float(m2), rel=1e-13)
        assert (float(here["minimum"]), float(here["maximum"])) == (float(min(values)), float(max(values)))
        if m2 == 0:
            assert np.isnan(float(here["skewness"]))
        else:
            # The third moment cancels; its error is measured by what is added up.
            scale = float(sum(abs(d**3) for d in deviations) / n) / float(m2) ** 1.5
            assert float(here["skewness"]) == pytest.approx(float(m3) / float(m2) ** 1.5, abs=1e-13 * scale)
            assert float(here["kurtosis"]) == pytest.approx(float(m4 / m2**2), rel=1e-13)


def test_kurtosis_is_pearsons() -> None:
    """Two equally likely values have kurtosis 1 in Pearson's convention (-2 in Fisher's)."""
    found = reduce(impacts([0.1] * 4, [0.5, 1.5, 0.5, 1.5]), [0.0, 1.0], E_EDGES)
    assert (float(found["kurtosis"][0]), float(found["skewness"][0])) == (1.0, 0.0)


def test_moments_look_beyond_the_restitution_bins() -> None:
    """Values outside the lattice are counted as such, and belong to the moments of their velocity bin."""
    found = reduce(impacts([0.1, 0.1], [0.5, 9.5]), [0.0, 1.0], [0.0, 1.0])
    assert int(found["restitution_count"].sum()) == 1
    assert int(found["restitution_overflow"][0]) == 1
    assert float(found["mean_restitution"][0]) == 5.0


def test_equal_values_have_no_variance_at_all() -> None:
    """A sphere's restitution is one number; rounding in a mean of 0.98s must not invent a spread."""
    found = reduce(impacts([0.1] * 7, [0.98] * 7), [0.0, 1.0], E_EDGES)
    assert float(found["mean_restitution"][0]) == 0.98
    assert float(found["variance"][0]) == 0.0
    assert np.isnan(float(found["kurtosis"][0]))


def test_negative_zero_is_zero() -> None:
    """-0.0 equals the edge 0.0, so it belongs to the bin above."""
    found = reduce(impacts([-0.0], [-0.0]), [-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0])
    np.testing.assert_array_equal(found["restitution_count"], [[0, 0], [0, 1]])


def test_nothing_happened() -> None:
    """Without a single impact all counts are 0, all moments NaN, and nothing warns."""
    found = reduce(impacts([np.nan], [np.nan]), V_EDGES, E_EDGES)
    assert int(found["number"].sum() + found["undefined"].sum() + found["velocity_underflow"]) == 0
    assert bool(np.isnan(found["mean_restitution"]).all())
    assert found.attrs["seed"] == 7


def test_huge_restitution_near_zero_velocity_is_kept() -> None:
    """Eq. 1 grows without bound as v → 0: up to 2³³ it enters the moments, from there on it is undefined."""
    found = reduce(impacts([1e-300] * 3, [8e9, -8e9, 2.0**33]), [0.0, 1.0], E_EDGES)
    assert int(found["undefined"][0]) == 1
    assert float(found["maximum"][0]) == 8e9
    assert float(found["variance"][0]) == 6.4e19


def test_created_energy_is_counted_where_it_happened() -> None:
    """A ratio above 1 + 1e-12 counts in its velocity bin; rounding does not, nor what is beyond the bins."""
    ratios = np.sqrt([0.9, 1.0 + 5e-13, 1.5, 1.2, 9.0])
    found = reduce(impacts([0.1, 0.2, 0.3, 0.9, 2.0], ratios), [0.0, 0.5, 1.0, 1.5], E_EDGES)
    np.testing.assert_array_equal(found["energy_created"], [1, 1, 0])
    np.testing.assert_allclose(found["largest_energy_ratio"], [1.5, 1.2, np.nan], rtol=1e-15)


@pytest.mark.parametrize(
    ("edges", "reason"),
    [
        ([0.0], "at least two"),
        ([[0.0, 1.0]], "one dimension"),
        ([0.0, np.nan], "finite"),
        ([0.0, 1.0, 1.0], "increase"),
    ],
)
@pytest.mark.parametrize("name", ["velocity_bins", "restitution_bins", "fraction_bins"])
def test_bad_bins_are_named(name: str, edges: Any, reason: str) -> None:
    """The message says which bins are wrong and how; a run is not started with wrong bins."""
    bins: dict[str, Any] = {"velocity_bins": V_EDGES, "restitution_bins": E_EDGES, "fraction_bins": F_EDGES}
    with pytest.raises(ValueError, match=f"{name}.*{reason}"):
        reduce(impacts([0.1], [0.5]), **(bins | {name: edges}))
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    with pytest.raises(ValueError, match=name):
        statistics(body, law, particles=2**39, **(bins | {name: edges}))


def test_missing_variable_is_named() -> None:
    """Data that do not come from `simulate` are refused by what they lack."""
    with pytest.raises(ValueError, match="rotational_fraction"):
        reduce(impacts([0.1], [0.5]).drop_vars("rotational_fraction"), V_EDGES, E_EDGES)


def _logarithmic(low: float, high: float, number: int) -> npt.NDArray[np.float64]:
    return np.concatenate([[0.0], np.geomspace(low, high, number)])


@pytest.mark.parametrize(
    "bins",
    [
        {"velocity_bins": np.geomspace(1e-3, 1.2, 60)},
        {
            "velocity_bins": _logarithmic(1e-4, 1.2, 80),
            "restitution_bins": [-1.0, 0.0, 0.5, 0.9, 0.95, 0.99, 2.0],
        },
        {"fraction_bins": np.linspace(0.0, 1.0, 21) ** 3},
        {
            "velocity_bins": [0.0, 0.3, 0.30001, 1.2],
            "restitution_bins": 0.9 + 0.5 * np.linspace(-1.0, 1.0, 41) ** 3,
            "fraction_bins": [0.0, 1e-12, 0.5, 1.0],
        },
    ],
)
@pytest.mark.parametrize("counts_only", [False, True])
def test_bins_of_any_widths(bins: dict[str, Any], counts_only: bool) -> None:
    """Counted as they happen, reduced from the records, and by numpy.histogram2d: the same counts."""
    body, law = rs.Dumbbell(radius=3e-3, separation=1e-3), rs.TangentialRestitution(normal=0.95)
    how: dict[str, Any] = {"particles": 300, "impacts": 200}
    all_bins: dict[str, Any] = {
        "velocity_bins": V_EDGES,
        "restitution_bins": E_EDGES,
        "fraction_bins": F_EDGES,
    }
    all_bins |= bins
    counted = statistics(body, law, **how, **all_bins, counts_only=counts_only)
    data = rs.simulate(body, law, **how)
    reduced = reduce(data, **all_bins)
    names = [str(name) for name in reduced.data_vars if reduced[name].dtype == np.int64 and name in counted]
    assert "restitution_count" in names
    for name in names:
        np.testing.assert_array_equal(counted[name], reduced[name], name)
    edges = [np.asarray(all_bins[f"{name}_bins"]) for name in ("velocity", "restitution")]
    columns = [data[name].to_numpy().ravel() for name in ("impact_velocity", "restitution")]
    inside = np.all([(x >= own[0]) & (x < own[-1]) for x, own in zip(columns, edges, strict=True)], axis=0)
    expected = np.histogram2d(columns[0][inside], columns[1][inside], bins=(edges[0], edges[1]))[0]
    np.testing.assert_array_equal(counted["restitution_count"], expected)


def test_uniform_allows_for_rounded_edges() -> None:
    """The usual ways to write 0, 0.002, ... differ by rounding, and each is taken."""
    for edges in (0.002 * np.arange(551), np.linspace(0, 1.1, 551), np.arange(0, 1.1, 0.002)):
        assert reduce(impacts([0.1], [0.5]), edges, E_EDGES).sizes["velocity"] == edges.size - 1


def test_first_impact_has_the_moments_of_equation_17() -> None:
    """L = 2R, ε_n = 0.4: mean and variance agree with the closed form (5 standard errors: 1 in 10⁶ each)."""
    body, law = rs.Dumbbell(radius=3e-3, separation=6e-3), rs.TangentialRestitution(normal=0.4)
    data = rs.simulate(body, law, particles=20_000, impacts=1, seed=11)
    found = reduce(data, [0.0, 2.0], E_EDGES)
    errors = standard_errors(data, [0.0, 2.0])
    exact = rs.analytic.first_impact(body, law)
    assert abs(float(found["mean_restitution"][0]) - exact.mean()) < 5 * float(
        errors["mean_standard_error"][0]
    )
    assert abs(float(found["variance"][0]) - exact.var()) < 5 * float(errors["variance_standard_error"][0])


def test_one_impact_a_particle_gives_the_textbook_error() -> None:
    """With clusters of one, the standard error of the mean is s/√n."""
    values = np.random.default_rng(1).normal(size=(50, 1))
    found = standard_errors(impacts(np.full((50, 1), 0.1), values), [0.0, 1.0])
    expected = values.std(ddof=1) / np.sqrt(50)
    assert float(found["mean_standard_error"][0]) == pytest.approx(expected, rel=1e-13)


def test_copies_of_an_impact_add_no_information() -> None:
    """A particle that repeats its impact three times counts once; blocks change nothing but the rounding."""
    values = np.random.default_rng(2).normal(size=(40, 1))
    once = standard_errors(impacts(np.full((40, 1), 0.1), values), [0.0, 1.0])
    thrice = standard_errors(impacts(np.full((40, 3), 0.1), np.tile(values, 3)), [0.0, 1.0], block=7)
    for name in ("mean_standard_error", "variance_standard_error", "deviation_standard_error"):
        assert float(thrice[name][0]) == pytest.approx(float(once[name][0]), rel=1e-12)


def test_single_particle_has_no_standard_error() -> None:
    """One cluster says nothing of the spread of clusters."""
    found = standard_errors(impacts([[0.1, 0.1]], [[0.5, 0.7]]), [0.0, 1.0, 2.0])
    assert np.isnan(found["mean_standard_error"]).all()
    np.testing.assert_array_equal(found["particles"], [1, 0])


def test_standard_errors_of_clusters_in_several_bins() -> None:
    """√(m/(m-1) Σ_i Ψ_i²)/number by loops, whatever the blocks, without what has no number or bin."""
    random = np.random.default_rng(6)
    shape = (11, 9)
    velocity, values = random.uniform(-0.2, 2.2, shape), random.normal(size=shape)
    velocity[3, 2:] = np.nan
    values[4, :3] = np.inf, 2.0**33, -np.inf
    fraction = np.full(shape, 0.1)
    fraction[5, 0] = np.nan
    edges = [0.0, 0.5, 2.0]
    data = impacts(velocity, values, fraction)
    blocks = [standard_errors(data, edges, block=block) for block in (1, 4, 11, 100)]
    for k, (low, high) in enumerate(pairwise(edges)):
        good = (velocity >= low) & (velocity < high) & (np.abs(values) < 2.0**33) & np.isfinite(fraction)
        pooled = values[good]
        mean, variance = pooled.mean(), pooled.var()
        clusters = [row[kept] for row, kept in zip(values, good, strict=True) if kept.any()]
        m = len(clusters)
        sums = np.array([[(row - mean).sum(), ((row - mean) ** 2 - variance).sum()] for row in clusters])
        for_mean, for_variance = np.sqrt(m / (m - 1) * np.sum(sums**2, axis=0)) / pooled.size
        for found in blocks:
            assert int(found["particles"][k]) == m
            assert float(found["mean_standard_error"][k]) == pytest.approx(for_mean, rel=1e-12)
            assert float(found["variance_standard_error"][k]) == pytest.approx(for_variance, rel=1e-12)
            deviation = for_variance / (2 * np.sqrt(variance))
            assert float(found["deviation_standard_error"][k]) == pytest.approx(deviation, rel=1e-12)
    for found in blocks:
        assert found["velocity"].values.tolist() == [0.25, 1.25]
        assert found["velocity"].dims == ("velocity",)
        assert found["velocity"].attrs["units"] == "m s-1"
        assert found.attrs == data.attrs
        for name in ("mean", "variance", "deviation"):
            assert f"{name} of restitution" in found[f"{name}_standard_error"].attrs["long_name"]
        assert found["particles"].attrs["long_name"]


def test_equal_values_have_no_error_of_their_deviation() -> None:
    found = standard_errors(impacts(np.full((5, 2), 0.1), np.full((5, 2), 0.5)), [0.0, 1.0])
    assert float(found["mean_standard_error"][0]) == float(found["variance_standard_error"][0]) == 0.0
    assert np.isnan(found["deviation_standard_error"][0])


def moments_of(values: npt.NDArray[np.float64], fraction: npt.NDArray[np.float64]) -> list[float]:
    d = values - values.mean()
    m2, m3, m4 = ((d**power).mean() for power in (2, 3, 4))
    return [values.mean(), m2, m3 / m2**1.5, m4 / m2**2, fraction.mean()]


def test_errors_of_moments_are_the_jackknife_over_batches() -> None:
    """√((n-1)/n Σ_b (θ_(b) - θ̄)²) of moments that are worked out anew without each batch.

    The second bin has impacts of two batches alone, the third of one, which leaves nothing to compare.
    """
    random = np.random.default_rng(8)
    batches, each, number = 5, 8, 30
    shape = (batches * each, number)
    velocity = random.uniform(0.0, 1.0, shape)
    velocity[: 2 * each, :4] = 1.5
    velocity[-each:, :4] = 2.5
    velocity[:, 4] = np.nan
    velocity[:, 5] = 9.0
    values, fraction = random.gamma(2.0, size=shape), random.uniform(0.1, 0.4, shape)
    values[1::3, 6] = np.inf
    edges = [0.0, 1.0, 2.0, 3.0]
    found = reduce(impacts(velocity, values, fraction), edges, E_EDGES, batches=batches)
    names = ("mean_restitution", "variance", "skewness", "kurtosis", "mean_fraction")
    for k, (low, high) in enumerate(pairwise(edges)):
        good = (velocity >= low) & (velocity < high) & np.isfinite(values)
        batch = np.repeat(np.arange(batches), each)[:, None] + np.zeros(number, int)
        left = [
            moments_of(*(column[good & (batch != out)] for column in (values, fraction)))
            for out in range(batches)
            if (good & (batch != out)).any()
        ]
        for name, own in zip(names, np.array(left).T, strict=True):
            error = found[f"{name}_error"]
            assert f"error of {name} over 5 batches" in error.attrs["long_name"]
            if k == 2:
                assert np.isnan(error[k])
            else:
                expected = np.sqrt((batches - 1) / batches * np.sum((own - own.mean()) ** 2))
                assert float(error[k]) == pytest.approx(expected, rel=1e-9), name


@pytest.mark.parametrize(
    ("found", "particles", "batches", "told"),
    [
        (16, 1000, 16, "jackknife over 16 batches of particles"),
        (2, 4, 2, "jackknife over 2 batches of particles"),
        (1, 1000, 1, "none: a single batch was asked for"),
        (1, 1, 1, "none: a single batch was asked for"),
        (1, 31, 16, "none: 31 particles are fewer than two for each of 16 batches"),
        (1, 32, 16, "none: interrupted before the second batch"),
        (0, 1000, 2, "none: interrupted before the second batch"),
    ],
)
def test_where_standard_errors_come_from(found: int, particles: int, batches: int, told: str) -> None:
    assert origin(found, particles, batches) == told


@pytest.mark.parametrize("particles", [0, 1, 9, 10, 31, 32, 33, 100])
@pytest.mark.parametrize("batches", [1, 5, 16])
def test_batches_take_every_particle_once(particles: int, batches: int) -> None:
    """In order, none of fewer than two, sizes that differ by one at most; a single one of few particles."""
    found = batches_of(particles, batches)
    assert len(found) == (batches if particles >= 2 * batches else 1)
    assert [particle for first, end in found for particle in range(first, end)] == list(range(particles))
    sizes = [end - first for first, end in found]
    assert max(sizes) - min(sizes) <= 1
    with pytest.raises(ValueError, match=r"^batches = 0: "):
        batches_of(particles, 0)


def scatter_over_error(estimates: npt.NDArray[np.float64], errors: npt.NDArray[np.float64]) -> float:
    """Scatter of repeated estimates over the root mean square of their standard errors; should be 1."""
    return float(estimates.std(ddof=1) / np.sqrt(np.mean(errors**2)))


def test_standard_errors_match_repetition_of_correlated_samples() -> None:
    """Particles that differ from each other: 1000 repetitions scatter as the errors say, mean and variance.

    The ratio of 1000 repetitions has a standard deviation of 0.022 (by bootstrap); ± 0.13 is five of
    these (1 in 10⁶) and 0.02 for the bias of 60 clusters. Errors for independent impacts would be four
    times too small.
    """
    random = np.random.default_rng(3)
    shape = (60, 16)
    found = []
    for _ in range(1000):
        values = random.normal(size=(60, 1)) + 0.25 * random.normal(size=shape)
        data = impacts(np.full(shape, 0.1), values)
        errors = standard_errors(data, [0.0, 1.0])
        names = ("mean_standard_error", "variance_standard_error")
        found.append([values.mean(), values.var(), *(float(errors[name][0]) for name in names)])
    mean, variance, mean_error, variance_error = np.array(found).T
    assert scatter_over_error(mean, mean_error) == pytest.approx(1, abs=0.13)
    assert scatter_over_error(variance, variance_error) == pytest.approx(1, abs=0.13)
    independent = np.sqrt(variance / values.size)
    assert scatter_over_error(mean, independent) > 3


def test_standard_errors_match_repeated_simulations() -> None:
    """The same for 300 independent runs of 60 particles between 0.3 and 0.5 m/s.

    The ratio's standard deviation is 0.043 (by bootstrap); ± 0.23 is five of these and 0.02 for the bias.
    """
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    bins = [0.3, 0.5]
    found = []
    for seed in range(300):
        data = rs.simulate(body, law, particles=60, impacts=100, seed=seed)
        moments = reduce(data, bins, [0.0, 1.0])
        errors = standard_errors(data, bins)
        deviation = float(moments["variance"][0]) ** 0.5
        names = ("mean_standard_error", "deviation_standard_error")
        found.append(
            [float(moments["mean_restitution"][0]), deviation, *(float(errors[name][0]) for name in names)]
        )
    mean, deviations, mean_error, deviation_error = np.array(found).T
    assert scatter_over_error(mean, mean_error) == pytest.approx(1, abs=0.23)
    assert scatter_over_error(deviations, deviation_error) == pytest.approx(1, abs=0.23)


def test_errors_that_are_not_there_say_why() -> None:
    """Statistics and `reduce` tell in an attribute how standard errors were found, or why there are none."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    bins: dict[str, Any] = {"velocity_bins": [0.0, 1.2], "restitution_bins": [-1.0, 3.0]}
    how: dict[str, Any] = {"particles": 40, "impacts": 4}
    for more, reason in (
        ({}, "jackknife over 16 batches of particles"),
        ({"particles": 31}, "none: 31 particles are fewer than two for each of 16 batches"),
        ({"batches": 1}, "none: a single batch was asked for"),
        ({"counts_only": True}, "none: counts_only leaves the moments out"),
    ):
        found = rs.statistics(body, law, **(how | bins | more))
        assert found.attrs["standard_errors"] == reason
        assert ("mean_restitution_error" in found) == (reason[:4] != "none")
    data = rs.simulate(body, law, **(how | {"particles": 31}))
    assert rs.reduce(data, **bins).attrs["standard_errors"].startswith("none: 31 particles")
    assert rs.reduce(data, **bins, batches=8).attrs["standard_errors"].startswith("jackknife over 8")


@pytest.mark.parametrize("batches", [1, 4])
def test_both_ways_to_statistics_have_one_layout(batches: int) -> None:
    """Counted during the run or from its records: variables, dimensions, types, texts, units, and values.

    The former round ε to 2⁻²⁰ at most, 1e-6 of a variance of 0.4; its powers go with a few times of that.
    """
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.98)
    run: dict[str, Any] = {"particles": 40, "impacts": 50, "seed": 3}
    bins: dict[str, Any] = {
        **{"velocity_bins": 5, "velocity_range": (0.0, 1.2)},
        **{"restitution_bins": 6, "restitution_range": (-1.0, 3.0), "batches": batches},
    }
    counted = rs.statistics(body, law, **run, **bins)
    reduced = rs.reduce(rs.simulate(body, law, **run), **bins)
    assert set(reduced.variables) == set(counted.variables) - {"particles_ended", "stop_reason"}
    assert ("variance_error" in reduced) == (batches > 1)
    for name, variable in reduced.variables.items():
        expected = counted.variables[name]
        assert (variable.dims, variable.dtype) == (expected.dims, expected.dtype), name
        assert variable.attrs == expected.attrs, name
        np.testing.assert_allclose(variable.to_numpy(), expected.to_numpy(), rtol=4e-6, atol=1e-9)
    assert reduced.attrs["content"].startswith("statistics of restitution")
    assert reduced.attrs["standard_errors"] == counted.attrs["standard_errors"]


def test_standard_errors_of_clusters_lie_along_the_velocity() -> None:
    found = standard_errors(impacts([[0.1, 0.1]], [[0.5, 0.7]]), [0.0, 1.0, 2.0])
    assert found.sizes == {"velocity": 2}
    assert all(variable.dims == ("velocity",) for variable in found.variables.values())
    assert found["particles"].dtype == np.int64
    assert found["deviation_standard_error"].attrs["long_name"] == (
        "cluster-robust standard error of the standard deviation of restitution; a particle is a cluster"
    )
    calls: dict[str, Callable[[], object]] = {
        "restitution_bins": lambda: reduce(impacts(0.1, 0.5), [0.0, 1.0], [1.0, 0.0]),
        "fraction_bins": lambda: reduce(impacts(0.1, 0.5), [0.0, 1.0], [0.0, 1.0], [1.0, 0.0]),
        "velocity_bins": lambda: standard_errors(impacts(0.1, 0.5), [1.0, 0.0]),
        "data": lambda: standard_errors(impacts(0.1, 0.5).drop_vars("restitution"), [0.0, 1.0]),
        "block = 0": lambda: standard_errors(impacts(0.1, 0.5), [0.0, 1.0], block=0),
        "data lacks": lambda: reduce(impacts(0.1, 0.5).drop_vars("restitution"), [0.0, 1.0], [0.0, 1.0]),
        "velocity_bins goes": lambda: reduce(impacts(0.1, 0.5), [1.0, 0.0], [0.0, 1.0]),
        "data = 5": lambda: reduce(cast(Any, 5), [0.0, 1.0], [0.0, 1.0]),
        "data lacks impact_velocity": lambda: reduce(xr.Dataset(), [0.0, 1.0], [0.0, 1.0]),
    }
    for name, call in calls.items():
        with pytest.raises(ValueError, match=rf"^{name}"):
            call()


def test_two_batches_are_enough_for_standard_errors() -> None:
    data = impacts(np.full((4, 1), 0.1), [[0.5], [0.6], [0.8], [0.9]])
    found = reduce(data, [0.0, 1.0], [0.0, 1.0], batches=2)
    # Without either batch the mean is that of the other: √(1/2 · 2 · 0.15²).
    assert float(found["mean_restitution_error"][0]) == pytest.approx(0.15, rel=1e-12)


def test_values_that_differ_by_their_rounding_do_not_scatter() -> None:
    """ε = 0.98 of a sphere, as recorded: the variance is 0, and there is no skewness."""
    values = [[0.98, np.nextafter(0.98, 1.0), 0.98, np.nextafter(0.98, 0.0)]]
    found = reduce(impacts(np.full((1, 4), 0.1), values), [0.0, 1.0], [0.0, 1.0])
    assert float(found["variance"][0]) == 0.0
    assert np.isnan(found["skewness"][0])
    assert np.isnan(found["kurtosis"][0])
