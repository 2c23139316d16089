"""Where nodes and bins of a learned distribution are placed, and what learning asks of speeds and passes."""

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

from reference.ensembles import BODY, EMPTY, LAW, ensemble_of
from restitution._internal.parameters import ParameterError
from restitution.distribution import _learn, _pilot
from restitution.distribution._ensemble import FRESH, LEARNING, Impacts
from restitution.distribution._pilot import Pilot, Sample
from restitution.distribution._table import Histogram, Table
from restitution.drop.run import Run

Floats = NDArray[np.float64]


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
        r"between any two nodes: more particles, more impacts of each, another range, or heights of release "
        r"that are spread$"
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
