"""Standard errors of moments against loops over clusters, the jackknife, and repetition."""

from collections.abc import Callable
from itertools import pairwise
from typing import Any, cast

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import restitution as rs
from reference.given import impacts
from restitution.drop.batches import batches_of, origin
from restitution.drop.reduce import reduce, standard_errors


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
    found = reduce(impacts(velocity, values, fraction), edges, [-1.0, 0.0, 1.0, 2.0], batches=batches)
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


def scatter_over_error(estimates: npt.NDArray[np.float64], errors: npt.NDArray[np.float64]) -> float:
    """Scatter of repeated estimates over the root mean square of their standard errors; should be 1."""
    return float(estimates.std(ddof=1) / np.sqrt(np.mean(errors**2)))


def test_standard_errors_match_repetition_of_correlated_samples() -> None:
    """Particles that differ from each other: 400 repetitions scatter as the errors say, mean and variance.

    The ratio of 400 repetitions has a standard deviation of 0.035 (by bootstrap); ± 0.2 is five of
    these (1 in 10⁶) and 0.02 for the bias of 60 clusters. Errors for independent impacts would be four
    times too small.
    """
    random = np.random.default_rng(3)
    shape = (60, 16)
    found = []
    for _ in range(400):
        values = random.normal(size=(60, 1)) + 0.25 * random.normal(size=shape)
        data = impacts(np.full(shape, 0.1), values)
        errors = standard_errors(data, [0.0, 1.0])
        names = ("mean_standard_error", "variance_standard_error")
        found.append([values.mean(), values.var(), *(float(errors[name][0]) for name in names)])
    mean, variance, mean_error, variance_error = np.array(found).T
    assert scatter_over_error(mean, mean_error) == pytest.approx(1, abs=0.2)
    assert scatter_over_error(variance, variance_error) == pytest.approx(1, abs=0.2)
    independent = np.sqrt(variance / values.size)
    assert scatter_over_error(mean, independent) > 3


def test_standard_errors_match_repeated_simulations() -> None:
    """The same for 150 independent runs of 60 particles between 0.3 and 0.5 m/s.

    The ratio's standard deviation is 0.061 (by bootstrap); ± 0.33 is five of these and 0.02 for the bias.
    """
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    bins = [0.3, 0.5]
    found = []
    for seed in range(150):
        data = rs.simulate(body, law, particles=60, impacts=100, seed=seed)
        moments = reduce(data, bins, [0.0, 1.0])
        errors = standard_errors(data, bins)
        deviation = float(moments["variance"][0]) ** 0.5
        names = ("mean_standard_error", "deviation_standard_error")
        found.append(
            [float(moments["mean_restitution"][0]), deviation, *(float(errors[name][0]) for name in names)]
        )
    mean, deviations, mean_error, deviation_error = np.array(found).T
    assert scatter_over_error(mean, mean_error) == pytest.approx(1, abs=0.33)
    assert scatter_over_error(deviations, deviation_error) == pytest.approx(1, abs=0.33)


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
