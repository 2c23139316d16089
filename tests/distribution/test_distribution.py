"""p(ε | v): one distribution in all its functions; conditions, files, counts, and bad input."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray
from scipy import stats

import restitution as rs
from reference.ensembles import BODY, LAW, heights
from restitution.distribution import FluctuatingRestitution
from restitution.distribution._ensemble import FRESH, Ensemble
from restitution.drop.run import Run

Floats = NDArray[np.float64]


@pytest.fixture(scope="module")
def learned() -> FluctuatingRestitution:
    return FluctuatingRestitution.learn(
        BODY, LAW, particles=4000, impacts=200, release_height=heights(20), velocities=(0.05, 0.8), seed=2
    )


@pytest.fixture(scope="module")
def conditional() -> FluctuatingRestitution:
    how: dict[str, Any] = {"velocities": (0.2, 0.8), "given": "rotational_fraction", "seed": 3}
    return FluctuatingRestitution.learn(
        BODY, LAW, particles=8000, impacts=100, release_height=heights(20), **how
    )


def by_hand(dist: FluctuatingRestitution, x: Floats, v: float) -> Floats:
    """The distribution function from the Dataset, with NumPy alone."""
    nodes, sizes = dist.data.velocity.to_numpy(), dist.data.edges.to_numpy()
    start = np.concatenate([[0], np.cumsum(sizes)])
    i = int(np.searchsorted(nodes, v, side="right")) - 1
    w = (v - nodes[i]) / (nodes[i + 1] - nodes[i])
    parts = []
    for node in (i, i + 1):
        here = slice(start[node], start[node + 1])
        edges, below = (
            dist.data.restitution_edge.to_numpy()[here],
            dist.data.probability_below.to_numpy()[here],
        )
        parts.append(np.interp(x, edges, below))
    return np.asarray((1 - w) * parts[0] + w * parts[1])


def test_the_mixture_is_the_one_in_the_dataset(learned: FluctuatingRestitution) -> None:
    """Between two nodes their distribution functions are weighted linearly: interpolated here with NumPy."""
    x = np.linspace(-0.5, 2.5, 2001)
    for v in (0.0501, 0.1234, 0.5, 0.7999):
        np.testing.assert_allclose(learned.cdf(x, v), by_hand(learned, x, v), rtol=0, atol=1e-15)


@pytest.mark.parametrize("given", [None, 0.01, 0.1])
def test_all_methods_are_those_of_one_distribution(
    conditional: FluctuatingRestitution, given: float | None
) -> None:
    """cdf inverts ppf; pdf, mean and variance are integrals over the quantiles, to what those resolve."""
    v = 0.4567
    q = np.concatenate([np.linspace(0, 1, 20_001), [1e-6, 1 - 1e-6]])
    x = conditional.ppf(q, v, given)
    np.testing.assert_allclose(conditional.cdf(x, v, given), q, rtol=0, atol=1e-13)
    np.testing.assert_allclose(conditional.sf(x, v, given), 1 - q, rtol=0, atol=1e-13)
    low, high = conditional.support(v, given)
    assert (conditional.cdf(low, v, given), conditional.cdf(high, v, given)) == (0.0, 1.0)
    # The density is constant between edges: its integral over every piece is exact.
    edges = np.unique(np.concatenate([x, conditional._conditional.edges, conditional._table.edges]))
    edges = edges[(edges >= low) & (edges <= high)]
    centre, width = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    density = conditional.pdf(centre, v, given)
    assert density @ width == pytest.approx(1.0, abs=1e-12)
    mean = float(density @ (width * centre))
    variance = float(density @ (width * ((centre - mean) ** 2 + width**2 / 12)))
    assert conditional.mean(v, given) == pytest.approx(mean, abs=1e-12)
    assert conditional.var(v, given) == pytest.approx(variance, rel=1e-9)
    assert conditional.std(v, given) == pytest.approx(np.sqrt(variance), rel=1e-9)
    draws = conditional.rvs(v, 20_000, random_state=1, given=given)
    assert (
        stats.kstest(draws, lambda x: conditional.cdf(x, v, given)).pvalue > 1e-4
    )  # false alarm 1e-4, seed fixed


def test_arguments_broadcast_as_in_scipy(learned: FluctuatingRestitution) -> None:
    """Scalars give scalars, arrays what NumPy's rules say; nan and impossible probabilities give nan."""
    v = np.array([0.1, 0.4])
    assert learned.cdf(1.0, v).shape == (2,)
    assert learned.pdf(np.ones((3, 1)), v).shape == (3, 2)
    assert learned.rvs(v, size=(5, 2), random_state=1).shape == (5, 2)
    assert learned.rvs(v, random_state=1).shape == (2,)
    assert np.isscalar(learned.rvs(0.1, random_state=1))
    assert np.isscalar(learned.mean(0.1))
    assert isinstance(learned.median(0.1), float)
    assert np.isnan(learned.cdf([np.nan, 1.0], [0.1, np.nan])).all()
    assert np.isnan(learned.ppf([-0.1, 1.1], 0.1)).all()
    assert np.isnan(learned.rvs([np.nan], random_state=1)).all()
    assert learned.cdf(1.0, []).shape == (0,)
    with pytest.raises(ValueError, match=r"size = 3: must be a shape that \(2,\) broadcasts to"):
        learned.rvs(v, size=3)


def test_draws_depend_on_the_seed_alone(learned: FluctuatingRestitution) -> None:
    """Neither on the threads nor on how many there are; generators of NumPy are taken, and go on."""
    v = np.linspace(0.05, 0.8, 50_000)
    one = learned.rvs(v, random_state=5, threads=1)
    np.testing.assert_array_equal(one, learned.rvs(v, random_state=5, threads=3))
    np.testing.assert_array_equal(one[:7], learned.rvs(v[:7], random_state=5))
    assert not np.array_equal(one, learned.rvs(v, random_state=6))
    for make in (np.random.default_rng, np.random.RandomState):
        first, again = make(1), make(1)
        x = learned.rvs(0.1, 3, random_state=first)
        np.testing.assert_array_equal(x, learned.rvs(0.1, 3, random_state=again))
        assert not np.array_equal(x, learned.rvs(0.1, 3, random_state=first))
    assert learned.rvs(0.1, 3).shape == (3,)


def test_a_hundred_thousandth_of_the_draws_is_where_it_should_be(learned: FluctuatingRestitution) -> None:
    """Ten million draws: shares beyond far quantiles, within five standard errors (false alarm 4e-6)."""
    draws = learned.rvs(0.0712, 10_000_000, random_state=8)
    for q in (1e-5, 1e-4, 1e-2):
        for share in (
            np.mean(draws < learned.ppf(q, 0.0712)),
            np.mean(draws > learned.ppf(1 - q, 0.0712)),
        ):
            assert abs(share - q) < 5 * np.sqrt(q / draws.size)


def test_the_stated_distance_is_that_of_a_fresh_simulation(learned: FluctuatingRestitution) -> None:
    """Another simulation, compared by SciPy at each impact's own speed, is as far away as `distance` says."""
    data = rs.simulate(BODY, LAW, particles=500, impacts=200, release_height=float(heights(3)[1]), seed=77)
    found = learned.distance(data)
    v, e = data.impact_velocity.to_numpy().ravel(), data.restitution.to_numpy().ravel()
    nodes = learned.data.velocity.to_numpy()
    for i in (0, 20, nodes.size - 2):
        here = (v >= nodes[i]) & (v < nodes[i + 1])
        exact = stats.kstest(learned.cdf(e[here], v[here]), "uniform").statistic
        assert int(found.impacts[i]) == here.sum()
        assert exact <= float(found.ks_distance[i]) < exact + 2 / 4096


def test_the_condition_explains_the_dependence(conditional: FluctuatingRestitution) -> None:
    """Wide follows wide: |u - 1/2| is correlated by a half, but by less than a tenth at given E_rot/E_tot."""
    how: dict[str, Any] = {"particles": 2000, "impacts": 100, "seed": 11}
    memory = conditional.memory(rs.simulate(BODY, LAW, **how), lags=3)
    free, bound = memory.spread.to_numpy()
    assert np.all(free > 0.45)
    assert np.all(np.abs(bound) < 0.1)
    assert np.all(memory.spread_error < 0.01)
    assert np.all(np.abs(memory.level) < 0.1)


def test_a_markov_chain_remembers_one_impact() -> None:
    """Nearly round: u is correlated with the one before, and so are the draws that are given it.

    Draws given a level have the correlation with it that simulated impacts have, within 0.03: 20 000 draws
    leave a standard error of 0.007, and eight conditions smooth the rest.
    """
    nearly_round = rs.Dumbbell(radius=3e-3, separation=3e-5)
    how: dict[str, Any] = {"impacts": 100, "release_height": heights(100), "velocities": (0.3, 0.5)}
    dist = FluctuatingRestitution.learn(nearly_round, LAW, **how, particles=8000, given="previous", seed=5)
    run = Run(body=nearly_round, law=LAW, particles=8000, impacts=100, seed=12)
    levels = []
    for block in Ensemble(run, tuple(heights(100))).blocks(FRESH):
        inside = (block.velocity >= 0.3) & (block.velocity < 0.5)
        u = dist.clamped().cdf(block.restitution, block.velocity)
        here = inside[:, 1:]
        levels.append(np.array([u[:, :-1][here], u[:, 1:][here], block.velocity[:, 1:][here]]))
    before, after, v = np.concatenate(levels, axis=1)
    drawn = dist.rvs(v, given=before, random_state=1)
    simulated = np.corrcoef(before, after)[0, 1]
    assert simulated > 0.2
    assert np.corrcoef(before, dist.cdf(drawn, v))[0, 1] == pytest.approx(simulated, abs=0.03)


def test_a_condition_averages_to_the_whole(conditional: FluctuatingRestitution) -> None:
    """p(ε | v, z) averaged over the simulated z of that speed is p(ε | v)."""
    data = rs.simulate(BODY, LAW, particles=4000, impacts=100, release_height=float(heights(3)[1]), seed=4)
    here = (abs(data.impact_velocity - 0.4) < 0.004).to_numpy()
    z = data.rotational_fraction.to_numpy()[here]
    x = conditional.ppf(np.linspace(0.05, 0.95, 10), 0.4)
    mixed = conditional.clamped().cdf(x[:, None], 0.4, given=z).mean(axis=1)
    np.testing.assert_allclose(mixed, conditional.cdf(x, 0.4), rtol=0, atol=0.02)


def test_files_keep_everything(learned: FluctuatingRestitution, tmp_path: Path) -> None:
    """Tables, errors, parameters and draws, to the bit; an existing file only on demand."""
    path = tmp_path / "dist.nc"
    learned.save(path)
    again = FluctuatingRestitution.load(path)
    xr.testing.assert_identical(again.data, learned.data)
    np.testing.assert_array_equal(again.rvs(0.1, 9, random_state=1), learned.rvs(0.1, 9, random_state=1))
    expected = {"normal": 0.98, "separation": 3e-4, "particles": 4000, "seed": 2, "beyond": "raise"}
    assert {name: again.data.attrs[name] for name in expected} == expected
    np.testing.assert_array_equal(again.data.attrs["release_height"], heights(20))
    with pytest.raises(FileExistsError):
        learned.save(path)
    learned.clamped().save(path, replace=True)
    assert FluctuatingRestitution.load(path).mean(5.0) == learned.mean(0.8)
    assert sorted(tmp_path.iterdir()) == [path]


def test_counts_give_the_same_distribution() -> None:
    """From `statistics` and `reduce`: F at the edges of the bins is the share of the counts, exactly."""
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.1, 0.4, 31),
        "restitution_bins": np.linspace(0.4, 1.6, 1201),
    }
    counts = rs.statistics(BODY, LAW, particles=2000, impacts=150, **bins)
    dist = FluctuatingRestitution.from_statistics(counts)
    np.testing.assert_allclose(dist.data.velocity, counts.velocity)
    for row in (0, 12, 29):
        v = float(counts.velocity[row])
        edge = dist._table.edges[dist._table.start[row] : dist._table.start[row + 1]]
        assert edge[0] == float(counts.minimum[row])
        assert edge[-1] == float(counts.maximum[row])
        below = np.concatenate([[0], np.cumsum(counts["restitution_count"][row])]) + int(
            counts.restitution_underflow[row]
        )
        place = np.searchsorted(counts.restitution_edges, edge[1:-1])
        np.testing.assert_allclose(
            dist.cdf(edge[1:-1], v), below[place] / int(counts.number[row]), rtol=1e-12
        )
        # A bin of one thousandth can hide half of itself from the mean, no more.
        assert dist.mean(v) == pytest.approx(float(counts["mean_restitution"][row]), abs=5e-4)
    with pytest.raises(ValueError, match="not known; the distribution was made from counts"):
        dist.cdf_error(1.0, 0.2)
    data = rs.simulate(BODY, LAW, particles=2000, impacts=150)
    again = FluctuatingRestitution.from_statistics(rs.reduce(data, **bins))
    np.testing.assert_array_equal(again.data.probability_below, dist.data.probability_below)
    assert "ks_distance" not in repr(dist)


def test_counts_without_a_distribution_are_refused() -> None:
    with pytest.raises(ValueError, match="statistics lacks restitution_count"):
        FluctuatingRestitution.from_statistics(xr.Dataset())
    bins: dict[str, Any] = {"velocity_bins": [0.2, 0.3, 0.4], "restitution_bins": [0.0, 1.0, 2.0]}
    poor = rs.statistics(BODY, LAW, particles=10, impacts=10, **bins)
    with pytest.raises(ValueError, match="0 velocity bins have 500 impacts"):
        FluctuatingRestitution.from_statistics(poor)
    gap = rs.statistics(
        BODY, LAW, particles=2000, impacts=20, **{**bins, "velocity_bins": 0.9 + 0.01 * np.arange(17)}
    )
    with pytest.raises(ValueError, match="impacts in the velocity bin at"):
        FluctuatingRestitution.from_statistics(gap)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"velocities": (0.0, 1.0)}, r"velocities = \(0.0, 1.0\): must be > 0 and strictly increasing"),
        ({"velocities": 0.3}, "velocities = 0.3: must be the least and the greatest speed"),
        ({"velocities": "ab"}, "velocities = 'ab': must be the least and the greatest speed"),
        ({"velocities": (2.0, 3.0)}, r"velocities: 0 impacts between 2 and .* m/s; must be .* 500"),
        ({"given": "spin"}, "given = 'spin': must be 'rotational_fraction' or 'previous' or None"),
        ({"orientation": [0.1, 0.2]}, r"orientation, spin, release_height: .*; one of them must be random"),
        ({"particles": 1}, "particles = 1: must be at least 2"),
        ({"release_height": [0.06, -1.0]}, r"release_height\[1\] = -1.0: must be a finite number > 0"),
        ({"release_height": []}, r"release_height = .*: must be a height or several"),
    ],
)
def test_bad_input_is_named(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        FluctuatingRestitution.learn(BODY, LAW, **{"particles": 2, "impacts": 10, **arguments})


def test_speeds_beyond_are_an_error_unless_clamped(learned: FluctuatingRestitution) -> None:
    with pytest.raises(
        ValueError, match=r"v\[1\] = 0.9: must be in \[0.05, 0.8\] m/s, the speeds that were learned"
    ):
        learned.cdf(1.0, [0.1, 0.9])
    with pytest.raises(ValueError, match=r"v = 0.01: must be in"):
        learned.rvs(0.01)
    assert learned.clamped().ppf(0.3, 0.9) == learned.ppf(0.3, 0.8)
    assert learned.clamped().rvs(0.0, random_state=1) == learned.rvs(0.05, random_state=1)
    with pytest.raises(ValueError, match=r"given = 0.1: must be None"):
        learned.pdf(1.0, 0.1, given=0.1)
    with pytest.raises(ValueError, match=r"random_state = -1: must be a seed in \[0, 2\*\*64\)"):
        learned.rvs(0.1, random_state=-1)
    with pytest.raises(ValueError, match=r"random_state = 'a': must be"):
        learned.rvs(0.1, random_state="a")  # type: ignore[call-overload]
    with pytest.raises(ValueError, match="data lacks velocity"):
        FluctuatingRestitution(xr.Dataset())


def test_conditions_outside_are_named(conditional: FluctuatingRestitution) -> None:
    with pytest.raises(ValueError, match=r"given\[1\] = 1.5: must be in \[0, 1\], rotational_fraction"):
        conditional.pdf(1.0, 0.4, given=[0.1, 1.5])
    with pytest.raises(ValueError, match=r"given\[1\] = 0.9: must be in \[.*\], what was seen"):
        conditional.pdf(1.0, 0.4, given=[0.1, 0.9])
    assert "nodes, tails to 3e-4, ks_distance up to 0.0" in repr(conditional)


def test_odd_arguments_are_named(learned: FluctuatingRestitution) -> None:
    """Of every kind that a caller may send; those that no machine can hold, too."""
    clamped = learned.clamped()
    odd: Any
    for odd in ("0.3", None, 1j, [0.1, "a"], [[0.2, 0.3], [0.3]]):
        for method in (learned.mean, learned.rvs, clamped.std_error):
            with pytest.raises(ValueError, match=r"v = .*: must be a number or an array of numbers"):
                method(odd)
        with pytest.raises(ValueError, match=r"x = .*: must be a number"):
            learned.cdf(odd, 0.3)
    # v12·n has a sign; the speed has none.
    with pytest.raises(ValueError, match=r"v\[1\] = -0.3: must be a speed, >= 0 m/s"):
        clamped.rvs([0.3, -0.3])
    for odd in (-1, (2, -3), 2.5, "a", (2.5,), True):
        with pytest.raises(ValueError, match=r"size = .*: must be a whole number >= 0 or a tuple of them"):
            learned.rvs(0.3, size=odd)
    for odd in (0, -1, 1.5, True):
        with pytest.raises(ValueError, match=rf"lags = {odd}: must be a whole number in \[1, 10000\]"):
            learned.memory(rs.simulate(BODY, LAW, particles=2, impacts=3), lags=odd)
    for take in (learned.distance, learned.memory, FluctuatingRestitution.from_statistics):
        with pytest.raises(ValueError, match=r"= None: must be a (result|Dataset) "):
            take(None)  # type: ignore[arg-type]
        with pytest.raises(ValueError, match="lacks"):
            take(learned.data)


def test_extreme_arguments_are_answered(learned: FluctuatingRestitution) -> None:
    """What has an answer gets it, without a warning: infinite, huge, empty and missing values."""
    clamped = learned.clamped()
    for v in (1e308, np.inf):
        assert clamped.mean(v) == learned.mean(0.8)
        assert clamped.rvs(v, random_state=1) == learned.rvs(0.8, random_state=1)
    assert clamped.var(0.0) == learned.var(0.05)
    assert (learned.cdf(-np.inf, 0.3), learned.cdf(np.inf, 0.3), learned.pdf(1e308, 0.3)) == (0.0, 1.0, 0.0)
    for error in (learned.pdf_error, learned.cdf_error):
        assert np.isnan(error([np.nan, 1.0], [0.3, np.nan])).all()
    whole = np.ma.masked_array([0.2, 0.3], [False, False])
    np.testing.assert_array_equal(learned.mean(whole), learned.mean([0.2, 0.3]))
    with pytest.raises(ValueError, match=r"v = .* must be a number or an array of numbers; it holds masked"):
        learned.mean(np.ma.masked_array([0.2, 0.3], [False, True]))
    for empty in (learned.mean([]), learned.rvs([]), learned.std_error([]), learned.rvs(0.3, size=(0, 3))):
        assert empty.size == 0
    first = rs.simulate(BODY, LAW, particles=5, impacts=1)  # all too fast for it
    assert np.isnan(learned.distance(first).ks_distance).all()
    assert np.isnan(learned.distance(first).ks_scatter).all()
