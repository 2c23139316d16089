"""What a distribution is learned from: whose impacts are simulated, gathered and counted."""

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import restitution as rs
from reference.ensembles import BODY, EMPTY, LAW, ensemble_of
from restitution import _core
from restitution._internal.parameters import ParameterError
from restitution.distribution import _ensemble, _learn
from restitution.distribution._check import Check
from restitution.distribution._count import Counter
from restitution.distribution._ensemble import BATCHES, FRESH, LEARNING, Ensemble, Impacts, _gathered
from restitution.distribution._table import Histogram, Table
from restitution.drop.run import Run

Floats = NDArray[np.float64]


def test_rounds_share_particles_among_the_heights(monkeypatch: pytest.MonkeyPatch) -> None:
    """23 particles at 3 heights are 8, 8 and 7; 230 impacts at 60 a round are 4 rounds, so 2 runs of each."""
    monkeypatch.setattr(_ensemble, "_IMPACTS_PER_ROUND", 60)
    found = ensemble_of((0.05, 0.055, 0.06), particles=23, impacts=10).rounds()
    assert found == [[(0, 4), (1, 4)], [(1, 4), (2, 3)], [(2, 4)], [(0, 4)]]
    assert ensemble_of(particles=5, impacts=10).rounds() == [[(0, 5)]]
    assert ensemble_of(particles=6, impacts=10).rounds() == [[(0, 3)], [(0, 3)]]
    # Runs that would have no particles are left out.
    found = ensemble_of((0.05, 0.06), particles=4, impacts=90).rounds()
    assert found == [[(0, 1)], [(1, 1)], [(0, 1)], [(1, 1)], [], [], []]


def test_particles_are_gathered_in_their_order() -> None:
    """From the share of each whole run on, as many at a time as there is room for, none left out."""
    runs: list[Any] = [
        (SimpleNamespace(particles=n, name=n), whole) for n, whole in ((4, 10), (7, 9), (1, 1))
    ]
    told = [
        [(run.name, part) for run, part in parts]  # type: ignore[attr-defined]
        for parts in _gathered(runs, 0.25, 3)
    ]
    # Of ten 3 to 4 are left, of nine 3 to 7, and of a single one none.
    assert told == [[(4, (3, 4)), (7, (3, 5))], [(7, (5, 7))]]
    assert list(_gathered(runs[:0], 0.0, 3)) == []
    assert [len(parts) for parts in _gathered(runs, 0.0, 6)] == [2, 2]


@pytest.mark.parametrize("stream", [LEARNING, FRESH])
@pytest.mark.parametrize("fraction", [False, True])
def test_blocks_are_runs_whose_seeds_are_hashed(
    stream: int, fraction: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each run is that of `simulate` with a seed hashed from seed, stream, round and number, bit by bit."""
    monkeypatch.setattr(_ensemble, "_IMPACTS_PER_ROUND", 60)
    monkeypatch.setattr(_ensemble, "_IMPACTS_AT_A_TIME", 35)
    asked: list[tuple[int, float]] = []
    monkeypatch.setattr(_ensemble, "check_size", lambda *about: asked.append(about[2:4]))
    heights = (0.05, 0.055, 0.06)
    ensemble = ensemble_of(heights, particles=23, impacts=10, seed=5, fraction=fraction)
    names = ["impact_velocity", "restitution", *(["rotational_fraction"] if fraction else [])]
    told: list[int] = []
    blocks = list(ensemble.blocks(stream, told.append))
    assert asked == [(30, _core.bytes_per_impact(names))]
    assert told == [block.velocity.shape[0] for block in blocks]
    assert max(told) == 3  # of ten impacts each
    firsts = [block.first for block in blocks]
    expected: list[Any] = []
    for number, runs in enumerate(ensemble.rounds()):
        first = 0
        for k, (height, particles) in enumerate(runs):
            hashed = np.random.SeedSequence(5, spawn_key=(stream, number, k)).generate_state(1, np.uint64)
            how: dict[str, Any] = {"particles": particles, "impacts": 10, "release_height": heights[height]}
            expected.append(rs.simulate(BODY, LAW, **how, seed=int(hashed[0])))
            first += particles
        assert firsts[: -(-first // 3)] == list(range(0, first, 3))
        del firsts[: -(-first // 3)]
    assert firsts == []
    for name, column in zip(names, ("velocity", "restitution", "fraction"), strict=False):
        found = np.concatenate([getattr(block, column) for block in blocks])
        np.testing.assert_array_equal(found, np.concatenate([run[name].to_numpy() for run in expected]))
    assert fraction or all(block.fraction.size == 0 for block in blocks)


def test_parts_of_an_ensemble_are_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    """Some shares one after the other have every particle once, in each height's own order."""
    monkeypatch.setattr(_ensemble, "_IMPACTS_AT_A_TIME", 35)
    ensemble = ensemble_of((0.05, 0.06), particles=23, impacts=10)
    whole = np.concatenate([block.velocity for block in ensemble.blocks(LEARNING)])
    parts = [
        np.concatenate([block.velocity for block in ensemble.blocks(LEARNING, share=share)])
        for share in ((0.0, 0.3), (0.3, 0.7), (0.7, 1.0))
    ]
    # 12 and 11 particles: up to ⌈3.6⌉ and ⌈3.3⌉, ⌈8.4⌉ and ⌈7.7⌉.
    first, second = whole[:12], whole[12:]
    for part, (a, b), (c, d) in zip(parts, ((0, 4), (4, 9), (9, 12)), ((0, 4), (4, 8), (8, 11)), strict=True):
        np.testing.assert_array_equal(part, np.concatenate([first[a:b], second[c:d]]))


def test_given_orientations_are_dealt_out_anew_in_each_stream() -> None:
    """All of them in each stream, in another order; part of an ensemble has the first of every run."""
    angles = np.linspace(0.1, 1.5, 20)
    spins = np.column_stack([np.zeros(20), angles, np.zeros(20)])
    ensemble = ensemble_of((0.05, 0.06), particles=20, impacts=5, orientation=angles, spin=spins)
    dealt = []
    for stream in (LEARNING, FRESH):
        (runs,) = ensemble._runs(stream, 1.0)
        assert [(run.particles, whole, run.release_height) for run, whole in runs] == [
            (10, 10, 0.05),
            (10, 10, 0.06),
        ]
        for run, _ in runs:
            np.testing.assert_array_equal(
                np.asarray(run.spins)[:, 1], np.asarray(run.angles)
            )  # what belongs together stays so
        dealt.append(np.concatenate([run.angles for run, _ in runs]))
        np.testing.assert_array_equal(np.sort(dealt[-1]), angles)
        assert not np.all(np.diff(dealt[-1]) > 0)
        (some,) = ensemble._runs(stream, 0.25)
        for (part, whole), (run, _) in zip(some, runs, strict=True):
            assert (part.particles, whole) == (3, 10)
            np.testing.assert_array_equal(np.asarray(part.angles), np.asarray(run.angles)[:3])
            assert part.seed == run.seed
    assert np.any(dealt[0] != dealt[1])


def test_spins_alone_are_dealt_out_too() -> None:
    spins = np.column_stack([np.zeros(8), np.arange(8.0), np.zeros(8)])
    ((run, _),) = next(ensemble_of((0.06,), particles=8, impacts=5, spin=spins)._runs(LEARNING, 1.0))
    assert run.spins is not None
    rates = np.asarray(run.spins)[:, 1].tolist()
    assert sorted(rates) == list(range(8))
    assert rates != list(range(8))


def test_what_would_be_learned_and_checked_alike_is_refused() -> None:
    """Orientation, spin and height all given: both streams would have the same trajectories."""
    angles = np.linspace(0.1, 1.5, 4)
    told = (
        "^orientation, spin, release_height: orientations, spins and the height are all given; one of them "
        "must be random, or the fresh impacts that test a distribution are the same as those that it was "
        "learned from$"
    )
    with pytest.raises(ParameterError, match=told):
        ensemble_of(particles=4, orientation=angles)
    spin = rs.RandomSpin(rate=10.0)
    random = rs.RandomHeight(0.05, 0.06)
    ensemble_of(particles=4, orientation=angles, spin=spin)
    ensemble_of((random,), particles=4, orientation=angles)
    ensemble_of((0.05, 0.06), particles=4, orientation=angles)
    ensemble_of(particles=2)
    with pytest.raises(
        ParameterError, match=r"^particles = 3: must be at least 4, two for each release height$"
    ):
        ensemble_of((0.05, 0.06), particles=3)


def test_an_interrupted_simulation_ends_the_learning(monkeypatch: pytest.MonkeyPatch) -> None:
    stopped = KeyboardInterrupt("here")
    monkeypatch.setattr(_core, "simulate_series", lambda *_: ({}, stopped))
    with pytest.raises(KeyboardInterrupt) as raised:
        next(ensemble_of(particles=4, impacts=5).blocks(LEARNING))
    assert raised.value.__cause__ is stopped


# Counts


def at_the_nodes() -> tuple[list[Impacts], Floats, Floats, NDArray[np.int64]]:
    """Impacts at exactly 1 m/s in three batches: each counts wholly at the first node, and at no other."""
    rng = np.random.default_rng(3)
    values = rng.normal(0.8, 0.1, (40, 7))
    values[rng.random(values.shape) < 0.3] = np.nan  # particles have different numbers of impacts
    rows = np.arange(values.shape[0])
    batch = np.array([0, 5, 31])[rows % 3]
    blocks = [
        Impacts(np.ones((1, 7)), row[None], EMPTY, int(number) + BATCHES * int(i))
        for i, (row, number) in enumerate(zip(values, batch, strict=True))
    ]
    return blocks, values, np.array([0.65, 0.75, 0.8, 0.9]), batch


def test_counts_and_their_errors_are_those_of_the_batches() -> None:
    """By loops over the impacts: shares of the bins, and how much each of three batches moves them."""
    blocks, values, inner, batch = at_the_nodes()
    counter = Counter(np.array([1.0, 2.0]), [np.zeros(1)] * 2, [inner, inner])
    # Halfway between the nodes, in every batch: the second node has a histogram too.
    counter.add_all(iter(blocks), lambda _: None)
    assert counter.impacts()[0] == np.isfinite(values).sum()
    between = {0: [0.7, 0.9], 5: [0.6, 0.85], 31: [0.7, 0.7]}
    for number, both in between.items():
        counter.add(Impacts(np.full((1, 2), 1.5), np.array([both]), EMPTY, number))
    found = counter.counted()
    # A half of each of the last six: in ln v or v, both halves are one impact.
    assert found.impacts.sum() == pytest.approx(np.isfinite(values).sum() + 6)
    assert found.nodes is counter.nodes
    assert found.conditions is counter.conditions
    weights = [1.0, float(found.impacts[0] - np.isfinite(values).sum()) / 6]
    x = np.concatenate([values[np.isfinite(values)], np.ravel(list(between.values()))])
    w = np.concatenate([np.full(x.size - 6, weights[0]), np.full(6, weights[1])])
    of = np.concatenate([np.repeat(batch, np.isfinite(values).sum(axis=1)), np.repeat([0, 5, 31], 2)])
    total, mean = w.sum(), np.sum(w * x) / w.sum()
    variance = np.sum(w * (x - mean) ** 2) / total

    def error(moved: Floats) -> float:
        """√(B/(B - 1) Σ_b (Σ_{i in b} w_i moved_i)²)/Σw over B batches."""
        squares = sum(float(np.sum((w * moved)[of == number])) ** 2 for number in (0, 5, 31))
        return math.sqrt(1.5 * squares) / float(total)

    assert found.mean_errors[0] == pytest.approx(error(x - mean), rel=1e-6)
    few, each = x[-6:], np.array(list(between.values()))
    alone = math.sqrt(1.5 * np.sum(np.sum(each - few.mean(), axis=1) ** 2)) / 6
    assert found.mean_errors[1] == pytest.approx(alone, rel=1e-6)
    squares = np.sum((each - few.mean()) ** 2 - few.var(), axis=1)
    alone = math.sqrt(1.5 * np.sum(squares**2)) / 6 / (2 * few.std())
    assert found.std_errors[1] == pytest.approx(alone, rel=1e-6)
    expected = error((x - mean) ** 2 - variance) / (2 * math.sqrt(variance))
    assert found.std_errors[0] == pytest.approx(expected, rel=1e-6)
    histogram, shares, below = found.histograms[0], found.share_errors[0], found.below_errors[0]
    edges = np.array([x.min(), *inner, x.max()])
    np.testing.assert_array_equal(histogram.edges, edges)
    bins = np.searchsorted(inner, x, side="right")
    for k in range(inner.size + 1):
        inside, under = bins == k, bins <= k
        share, part = w[inside].sum() / total, w[under].sum() / total
        assert histogram.cumulative[k + 1] == pytest.approx(part, rel=1e-9)
        assert shares[k] == pytest.approx(error(inside - share), rel=1e-6)
        if k < inner.size:
            assert below[k + 1] == pytest.approx(error(under - part), rel=1e-6)
    assert (histogram.cumulative[0], histogram.cumulative[-1], below[0], below[-1]) == (0.0, 1.0, 0.0, 0.0)


def test_empty_bins_at_the_ends_are_left_out() -> None:
    """The outermost bins end at the least and the greatest ε that were seen, even at an edge itself."""
    inner = np.array([0.1, 0.2, 0.5, 0.8, 0.9])
    counter = Counter(np.array([1.0, 2.0]), [np.zeros(1)] * 2, [inner] * 2)
    counter.add(Impacts(np.ones((1, 3)), np.array([[0.3, 0.6, 0.8]]), EMPTY))
    counter.add(Impacts(np.full((1, 1), 1.5), np.array([[0.3]]), EMPTY))
    histogram, shares, below, _ = next(iter(counter.histograms()))
    assert histogram.edges.tolist() == [0.3, 0.5, 0.8, np.nextafter(0.8, 1)]
    assert (shares.size, below.size) == (3, 4)
    # A single batch does not scatter: that is not known, but for the ends.
    assert np.isnan(shares).all()
    assert np.isnan(below[1:-1]).all()
    assert np.isnan(counter.moment_errors()).all() or np.isnan(counter.moment_errors()[0]).all()


def test_equal_restitutions_have_no_error_of_their_deviation() -> None:
    """All at ε = 0.5: the mean is exact and does not scatter, neither does the deviation, which is 0."""
    counter = Counter(np.array([1.0, 2.0]), [np.zeros(1)] * 2, [np.array([0.4, 0.6])] * 2)
    for number in (0, 1):
        counter.add(Impacts(np.full((1, 4), 1.0), np.full((1, 4), 0.5), EMPTY, number))
        counter.add(Impacts(np.full((1, 1), 1.5), np.full((1, 1), 0.5), EMPTY, number))
    assert [error.tolist() for error in counter.moment_errors()] == [[0.0, 0.0], [0.0, 0.0]]


def test_what_was_counted_is_told_anew_after_more(monkeypatch: pytest.MonkeyPatch) -> None:
    counter = Counter(np.array([1.0, 2.0]), [np.zeros(1)] * 2, [np.array([0.4, 0.6])] * 2)
    block = Impacts(np.full((1, 4), 1.0), np.full((1, 4), 0.5), EMPTY)
    counter.add(block)
    assert counter.impacts().tolist() == [4.0, 0.0]
    counter.add(block)
    assert counter.impacts().tolist() == [8.0, 0.0]
    stopped = KeyboardInterrupt("here")
    monkeypatch.setattr(counter, "_counter", SimpleNamespace(add=lambda *_: stopped))
    with pytest.raises(KeyboardInterrupt) as raised:
        counter.add(block)
    assert raised.value.__cause__ is stopped


def test_threads_are_those_that_were_asked_for() -> None:
    """A number of threads that cannot be reaches the check from everything that takes one."""
    even = Histogram(np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    table = Table.of(np.array([1.0, 2.0]), [even, even])
    counter = Counter(np.array([1.0, 2.0]), [np.zeros(1)] * 2, [np.array([0.4, 0.6])] * 2)
    block = Impacts(np.full((1, 4), 1.0), np.full((1, 4), 0.5), np.full((1, 4), 0.5))
    run = Run(body=BODY, law=LAW, particles=4, impacts=5)
    actions: list[Any] = [
        lambda: counter.add_all([block], lambda _: None, 0),
        lambda: counter.add(block, None, 0),
        lambda: Check.of(table, [block], 0),
        lambda: Check(table).add(block, 0),
        lambda: table.value("cdf", 0.5, 1.5, threads=0),
        lambda: table.draw(np.array(1.5), np.array(0.0), (3,), 1, 0),
        lambda: _learn.condition("previous", block, table, 0),
        lambda: next(Ensemble(run, (0.06,), 0).blocks(LEARNING)),
        lambda: _learn.learn(Ensemble(run, (0.06,), 0), np.array([0.2, 0.5]), None, progress=False),
    ]
    for action in actions:
        with pytest.raises(ParameterError, match=r"^threads = 0: must be a whole number in \[1, "):
            action()
