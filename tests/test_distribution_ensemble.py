"""What a distribution is learned from: whose impacts are simulated, placed, counted and told."""

import math
import re
from collections.abc import Iterator
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray

import restitution as rs
from reference.ensembles import BODY, LAW
from restitution import _core
from restitution._parameters import ParameterError
from restitution._run import Run
from restitution.distribution import _ensemble, _learn, _pilot
from restitution.distribution._check import Check
from restitution.distribution._count import Counter
from restitution.distribution._ensemble import BATCHES, FRESH, LEARNING, Ensemble, Impacts, _gathered
from restitution.distribution._pilot import Pilot, Sample
from restitution.distribution._table import Histogram, Table

Floats = NDArray[np.float64]
EMPTY = np.empty((0, 0))


def ensemble_of(heights: tuple[Any, ...] = (0.06,), *, fraction: bool = False, **run: Any) -> Ensemble:
    return Ensemble(Run(body=BODY, law=LAW, **run), heights, fraction=fraction)


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
    monkeypatch.setattr(_ensemble, "check_memory", lambda rows, of_row: asked.append((rows, of_row)))
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
        "^orientation, spin, release_height: orientations, spins and the height are all given; must be "
        "random in one of them, or the fresh impacts that a distribution is held against are those that it "
        "was learned from$"
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
    histogram, shares, below = next(iter(counter.histograms()))
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


# The part that places nodes and bins


class Fake:
    """An ensemble of 1000 particles with 4 impacts each; those of one in `every` are at 1.5 m/s."""

    def __init__(self, every: int = 1) -> None:
        self.run = SimpleNamespace(particles=1000, impacts=4)
        self.every, self.asked = every, list[tuple[float, float]]()

    def blocks(
        self, stream: int, tell: Any = None, *, share: tuple[float, float] = (0.0, 1.0)
    ) -> Iterator[Impacts]:
        assert stream == LEARNING
        self.asked.append(share)
        begin, end = (math.ceil(part * 1000) for part in share)
        for first in range(begin, end, 50):
            rows = np.arange(first, min(first + 50, end))
            velocity = np.where(rows % self.every == 0, 1.5, 9.0)[:, None] * np.ones(4)
            yield Impacts(velocity, np.repeat(rows[:, None] / 1000.0, 4, axis=1), EMPTY, first)
            if tell is not None:
                tell(rows.size)


def particles_of(blocks: Iterator[Impacts]) -> list[int]:
    return [round(row[0] * 1000) for block in blocks for row in block.restitution]


@pytest.mark.parametrize(
    ("impacts", "every", "asked"),
    [
        (10_000, 1, [(0.0, 1.0)]),  # all of a small ensemble
        (400, 1, [(0.0, 0.1)]),
        (400, 2, [(0.0, 0.1)]),  # half as many in the range are enough
        # A tenth of them in the range: 40 were found of 400, ten times as many are looked at.
        (400, 10, [(0.0, 0.1), (0.1, 1.0)]),
        (400, 4, [(0.0, 0.1), (0.1, 0.4)]),
        (360, 3, [(0.0, 0.09), (0.09, 0.27)]),
        (400, 100, [(0.0, 0.1), (0.1, 1.0)]),  # there are no more than all
    ],
)
@pytest.mark.parametrize("held", [0, 300, 400, 10_000])
def test_the_pilot_has_enough_impacts(
    impacts: int, every: int, asked: list[tuple[float, float]], held: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Particles are looked at, kept or simulated again, and counted, each exactly once."""
    monkeypatch.setattr(_pilot, "IMPACTS", impacts)
    monkeypatch.setattr(_pilot, "_HELD", held)
    fake = Fake(every)
    ensemble: Any = fake
    pilot = Pilot.of(ensemble, 1.0, 2.0)
    np.testing.assert_allclose(fake.asked, asked)
    share = asked[-1][1]
    looked = round(1000 * share)
    assert pilot.share == pytest.approx(share)
    assert pilot.scale == pytest.approx(1 / share)
    assert pilot.density.impacts == 4 * len(range(0, looked, every))
    # Kept is what ends within the room: whole shares only.
    fits = [end for _, end in asked if 4000 * end <= held]
    assert pilot.kept == pytest.approx(max(fits, default=0.0))
    assert sum(block.velocity.size for block in pilot.held) == round(4000 * pilot.kept)
    assert particles_of(pilot.blocks()) == list(range(looked))
    for last in (False, True):
        told: list[int] = []
        counted = particles_of(pilot.whole(told.append, last=last))
        assert sorted(counted) == list(range(1000))
        assert sum(told) == 1000
    # The last time it gave away what it had.
    assert pilot.held == []


def test_large_ensembles_keep_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    ensemble: Any = Fake()
    for large, kept in ((3999, 0.0), (4000, 1.0)):
        monkeypatch.setattr(_pilot, "_LARGE", large)
        assert Pilot.of(ensemble, 1.0, 2.0).kept == kept


@pytest.mark.parametrize("given", [False, True])
def test_a_sample_has_the_impacts_next_to_each_node(given: bool) -> None:
    """Compared with masks over all impacts of several blocks."""
    rng = np.random.default_rng(4)
    nodes = np.array([1.0, 1.5, 1.7, 3.0])
    v, e, z = rng.uniform(0.8, 3.3, (3, 20, 10)), rng.random((3, 20, 10)), rng.random((3, 20, 10))
    v[0, 0, :4] = nodes
    e[1, 3, :5] = np.nan
    z[2, 4, :5] = np.nan
    v[1] = v[1] % 0.5 + 1.0  # a block without any in the last intervals
    blocks = [Impacts(v[i], e[i], z[i]) for i in range(3)]
    sample = Sample(blocks, nodes, (lambda block: block.fraction) if given else (lambda _: None))
    counts = np.isfinite(e) & (np.isfinite(z) | (not given))
    between = [(v >= low) & (v < high) & counts for low, high in pairwise(nodes)]
    assert sample.impacts().tolist() == [mask.sum() for mask in between]
    near = list(sample.near())
    assert len(near) == nodes.size
    for i, (restitution, condition) in enumerate(near):
        mask = np.any(between[max(i - 1, 0) : i + 1], axis=0)
        np.testing.assert_array_equal(np.sort(restitution), np.sort(e[mask]))
        order = np.argsort(e[mask])
        if given:
            np.testing.assert_array_equal(condition[np.argsort(restitution)], z[mask][order])
        else:
            assert condition.size == 0


def test_a_sample_at_more_nodes_than_16_bits_can_number() -> None:
    """Impacts in every thousandth of 70 000 intervals, given from the last to the first."""
    nodes = np.linspace(1.0, 8.0, 70_001)
    rows = np.arange(69_500, 0, -1000)
    v, e = 0.5 * (nodes[rows] + nodes[rows + 1])[None], rows[None] / 70_000.0
    sample = Sample([Impacts(v, e, EMPTY)], nodes, lambda _: None)
    assert np.flatnonzero(sample.impacts()).tolist() == rows[::-1].tolist()
    found = {node: values.tolist() for node, (values, _) in enumerate(sample.near()) if values.size}
    assert found == {int(row) + side: [row / 70_000.0] for row in rows for side in (0, 1)}


# What is learned


def test_the_condition_of_an_impact() -> None:
    """That of the one before is its level at its own speed; none for the first.

    F = ε at 1 m/s and ε/2 at 2 m/s: at 1.5 m/s 3ε/4. Slower or faster than all nodes, that at the nearest.
    """
    even, wide = (Histogram(np.array([0.0, end]), np.array([0.0, 1.0])) for end in (1.0, 2.0))
    table = Table.of(np.array([1.0, 2.0]), [even, wide])
    block = Impacts(
        np.array([[1.5, 0.5, 2.5, 1.2]]), np.array([[0.4, 0.6, 0.9, 0.1]]), np.array([[0.1, 0.2, 0.3, 0.4]])
    )
    assert _learn.condition("rotational_fraction", block, table) is block.fraction
    found = _learn.condition("previous", block, table)
    np.testing.assert_allclose(found, [[np.nan, 0.3, 0.6, 0.45]], rtol=1e-15)


def test_impacts_count_at_the_conditions_next_to_their_own() -> None:
    """Of three conditions each has what is between its neighbours; beyond the ends, all."""
    z = np.array([0.05, 0.2, 0.35, 0.5, 0.65, 0.8, 0.95])
    e = np.arange(7.0)
    sample: Any = SimpleNamespace(near=lambda: iter([(e, z), (e, z)]))
    groups = [np.array([0.2, 0.5, 0.8]), np.array([0.5])]
    found = list(_learn._at_nodes(sample, np.array([1.25, 2.0]), groups))
    assert [(values.tolist(), where) for values, where in found] == [
        ([0.0, 1.0, 2.0], "1.25 m/s and condition 0.2"),
        ([2.0, 3.0, 4.0], "1.25 m/s and condition 0.5"),
        ([4.0, 5.0, 6.0], "1.25 m/s and condition 0.8"),
        ([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0], "2 m/s"),
    ]
    few: Any = SimpleNamespace(near=lambda: iter([(e, z), (e[:1], z[:1])]))
    with pytest.raises(ParameterError, match=r"must be 2 or more at 2 m/s"):
        _learn._edges(few, 1.0, np.array([1.25, 2.0]), [np.zeros(1)] * 2)


def test_speeds_that_are_hardly_met_are_named() -> None:
    """500 impacts are needed in each interval: 250 in half of the ensemble."""
    nodes = np.array([0.1, 0.2, 0.3, 0.123456789])
    enough: Any = SimpleNamespace(impacts=lambda: np.array([250, 300, 250]))
    _learn._enough(enough, nodes, 2.0)
    few: Any = SimpleNamespace(impacts=lambda: np.array([250, 249, 240]))
    told = (
        r"^velocities: 480 impacts between 0\.3 and 0\.123457 m/s; must be speeds with at least 500 impacts "
        r"between any two nodes: more particles, more impacts of each, or another range$"
    )
    with pytest.raises(ParameterError, match=told):
        _learn._enough(few, nodes, 2.0)


def test_speeds_to_learn() -> None:
    run = Run(body=BODY, law=LAW)
    given = np.array([0.1, 0.2])
    found = _learn.checked_speeds(given, run)
    assert found.tolist() == [0.1, 0.2]
    found[0] = 7.0
    assert given[0] == 0.1
    allowed = r"the least and the greatest speed, or all nodes, finite, in m/s"
    for bad in ([0.1], [], [0.1, np.nan], [0.1, np.inf]):
        with pytest.raises(ParameterError, match=rf"^velocities = .*: must be {allowed}$"):
            _learn.checked_speeds(bad, run)
    for strange in ("all", [[0.1, 0.2]], 0.1, [0.1, 1j]):
        with pytest.raises(ParameterError, match=rf"^velocities\b.*: must be {allowed}"):
            _learn.checked_speeds(strange, run)
    for unit in ("km/h", "m", "1"):
        with pytest.raises(ParameterError, match=rf"^velocities .*{unit}.*m s-1"):
            _learn.checked_speeds(xr.DataArray([0.1, 0.2], attrs={"units": unit}), run)
    for bad in ([0.0, 0.1], [-0.1, 0.1], [0.1, 0.1], [0.2, 0.1]):
        shown = re.escape(repr(bad))
        with pytest.raises(ParameterError, match=f"^velocities = {shown}: must be > 0 and strictly increas"):
            _learn.checked_speeds(bad, run)


@pytest.mark.parametrize("given", [None, "previous"])
@pytest.mark.filterwarnings("ignore::restitution.DistanceWarning")
def test_progress_counts_every_particle_of_every_pass(given: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Once for the table, once for the fresh impacts, and once more for conditions."""
    told: list[int] = []
    asked: list[Any] = []

    class Bar:
        def __enter__(self) -> Any:
            return told.append

        def __exit__(self, *_: object) -> None:
            asked.append("closed")

    def bar(what: str, total: int, unit: str, *, show: bool) -> Bar:
        asked.extend([what, total, unit, show])
        return Bar()

    monkeypatch.setattr(_learn, "progress_bar", bar)
    heights = (0.05, 0.06)
    data = _learn.learn(
        ensemble_of(heights, particles=200, impacts=100), np.array([0.2, 0.5]), given, progress=True
    )
    total = 400 if given is None else 600
    assert asked == ["learn", total, "particles", True, "closed"]
    assert told[-1] == total
    assert all(np.diff(told) > 0)
    assert list(data.attrs["release_height"]) == list(heights)
    assert data.attrs["title"] == "Distribution of the coefficient of restitution at given impact velocity"
    assert data.attrs.get("given") == given
    assert ("given_edges" in data) == (given is not None)
    # All impacts that lie between the nodes, simulated once more by themselves.
    count = sum(
        int(np.sum((block.velocity >= 0.2) & (block.velocity < 0.5) & np.isfinite(block.restitution)))
        for block in ensemble_of(heights, particles=200, impacts=100).blocks(LEARNING)
    )
    assert float(data.impacts.sum()) == pytest.approx(count)
    fresh = sum(
        int(np.sum((block.velocity >= 0.2) & (block.velocity < 0.5) & np.isfinite(block.restitution)))
        for block in ensemble_of(heights, particles=200, impacts=100).blocks(FRESH)
    )
    assert int(data.fresh_impacts.sum()) == fresh
    one = _learn.learn(
        ensemble_of(particles=200, impacts=100), np.array([0.2, 0.3, 0.5]), None, progress=False
    )
    assert one.attrs["release_height"] == 0.06
    assert one.velocity.to_numpy().tolist() == [0.2, 0.3, 0.5]
    assert asked[-2] is False


def test_too_few_impacts_end_the_learning() -> None:
    """20 impacts cannot be 500 between two nodes."""
    with pytest.raises(ParameterError, match=r"^velocities: \d+ impacts between 0\.\d+ and 0\.\d+ m/s; must"):
        _learn.learn(ensemble_of(particles=4, impacts=5), np.array([0.2, 0.3, 0.5]), None, progress=False)


@pytest.mark.parametrize("given", ["next", 1, ["previous"]])
def test_conditions_that_are_none(given: Any) -> None:
    with pytest.raises(
        ParameterError, match=r"^given = .*: must be 'rotational_fraction' or 'previous' or None$"
    ):
        _learn.learn(ensemble_of(particles=4), np.array([0.2, 0.5]), given, progress=False)
