"""Where a learned distribution puts its nodes and bins, in closed form; and how far it is from impacts."""

import math
import warnings
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
import xarray as xr

import restitution as rs
from restitution.distribution._check import Check, warn_of_distance
from restitution.distribution._ensemble import Impacts
from restitution.distribution._nodes import Density, bins, conditions
from restitution.distribution._table import Histogram, Table

Floats = npt.NDArray[np.float64]
LOW, HIGH = 0.2, 1.1
LENGTH = math.log(HIGH / LOW)
CELLS = 256
"""Cells of equal width in ln v in which impacts are counted."""


def impacts_in(each: list[int], copies: int = 1) -> Floats:
    """So many particles, each with impacts in one cell only, in the middle of it."""
    cell = np.repeat(np.arange(len(each)), each)
    return np.repeat(LOW * np.exp((cell + 0.5) * LENGTH / len(each))[:, None], copies, axis=1)


def speeds(blocks: list[Floats], low: float, high: float, scale: float) -> Floats:
    density = Density(low, high)
    for block in blocks:
        density.add(block)
    return density.speeds(scale)


def distance(particles: float, copies: int, scale: float) -> float:
    """Of nodes in ln v: 0.23 ρ^(-1/5), but two intervals have 1000 impacts, and there are eight at least."""
    per_length = CELLS / LENGTH * scale * particles
    return min(max(0.23 * math.pow(per_length, -0.2), 1000 / (per_length * copies)), LENGTH / 8)


@pytest.mark.parametrize(
    ("particles", "copies", "scale"),
    [
        (3, 1, 1.0),
        (3, 1, 100.0),
        (3, 4, 100.0),
        (2, 1, 3000.0),
        (1, 1, 4.0),
        (1, 1, 40.0),
        (4, 1, 1e8),
        (3, 20, 1.0),
    ],
)
def test_nodes_are_as_close_as_impacts_are_worth(particles: int, copies: int, scale: float) -> None:
    """At equal distances in ln v where impacts are; several of a particle in one cell count as one."""
    found = speeds([impacts_in([particles] * CELLS, copies)], LOW, HIGH, scale)
    number = max(8, math.floor(LENGTH / distance(particles, copies, scale) + 1e-9))
    assert found.size == number + 1
    assert (found[0], found[-1]) == (LOW, HIGH)
    np.testing.assert_allclose(np.diff(np.log(found)), LENGTH / number, rtol=1e-9)


def test_nodes_are_closer_where_impacts_are_more() -> None:
    """Two densities: equal numbers of intervals pass over each as long as it is in its own distances."""
    half = CELLS // 2
    each = [2] * half + [40] * half
    blocks = [impacts_in(each), np.array([[LOW * 0.9, HIGH, HIGH * 2.0, np.nan]])]  # outside: of no account
    found = speeds(blocks, LOW, HIGH, 1000.0)
    wide, close = distance(2, 1, 1000.0), distance(40, 1, 1000.0)
    of_wide, of_close = LENGTH / 2 / wide, LENGTH / 2 / close
    number = math.floor(of_wide + of_close)
    place = np.arange(number + 1) * (of_wide + of_close) / number
    expected = np.where(place < of_wide, place * wide, LENGTH / 2 + (place - of_wide) * close)
    np.testing.assert_allclose(np.log(found / LOW), expected, atol=1e-12)


def test_impacts_of_one_particle_in_several_cells_or_blocks() -> None:
    """Blocks have particles of their own; a particle counts in every cell that it reaches."""
    one = impacts_in([1] * CELLS)
    np.testing.assert_array_equal(
        speeds([one, one], LOW, HIGH, 30.0), speeds([impacts_in([2] * CELLS)], LOW, HIGH, 30.0)
    )
    np.testing.assert_array_equal(speeds([one.T], LOW, HIGH, 30.0), speeds([one], LOW, HIGH, 30.0))


def test_impacts_at_the_ends_of_the_range() -> None:
    """At the least speed they are within it, at the greatest they are not."""
    density = Density(LOW, HIGH)
    density.add(np.array([[LOW, HIGH, np.nextafter(HIGH, 0.0), np.nextafter(LOW, 0.0)]]))
    assert density.impacts == 2
    # Just below 1.4 the logarithm of the ratio to 0.1 is rounded to that of the end.
    for low, high in ((LOW, HIGH), (0.1, 1.4)):
        top, middle = np.nextafter(high, 0.0), high * (low / high) ** (0.5 / CELLS)
        found = [speeds([np.full((50, 1), float(v))], low, high, 100.0) for v in (top, middle)]
        np.testing.assert_array_equal(found[0], found[1])


def test_particles_with_unequal_numbers_of_impacts() -> None:
    """One with 1 and one with 9 impacts in a cell are worth 10²/(1 + 9²) = 1.22 of equal ones (Kish)."""
    centres = LOW * np.exp((np.arange(CELLS) + 0.5) * LENGTH / CELLS)
    once, often = centres[:, None] * np.ones((1, 9)), centres[:, None] * np.ones((1, 9))
    once[:, 1:] = np.nan
    scale = 500.0
    found = speeds([np.concatenate([once, often])], LOW, HIGH, scale)
    number = math.floor(LENGTH / distance(100 / 82, 1, scale) + 1e-9)
    # Ten impacts in each cell are enough for all intervals, so that these alone set the distance.
    assert 1000 / (CELLS / LENGTH * scale * 10) < LENGTH / number
    assert found.size == number + 1
    np.testing.assert_allclose(np.diff(np.log(found)), LENGTH / number, rtol=1e-9)


def test_nodes_where_there_are_no_impacts() -> None:
    """Eight intervals of equal ratio, whether none or only a few cells have any."""
    for block in (np.zeros((0, 3)), impacts_in([1] * 4)):
        found = speeds([block], LOW, HIGH, 1.0)
        np.testing.assert_allclose(found, np.geomspace(LOW, HIGH, 9), rtol=1e-12)


def test_conditions_are_in_the_middle_of_eight_equal_parts() -> None:
    np.testing.assert_allclose(conditions(np.linspace(3.0, 5.0, 1601)), 3.0 + (np.arange(8) + 0.5) / 4)
    assert conditions(np.array([0.5, 0.5, 0.5])).tolist() == [0.5]


@pytest.mark.parametrize(("size", "scale"), [(1001, 1.0), (1001, 50.0), (20_001, 1.0), (3, 1.0), (5001, 1e4)])
def test_bins_are_equally_probable_and_halve_in_the_tails(size: int, scale: float) -> None:
    """Of numbers that are evenly spread from 2 to 3 the quantile q is 2 + q."""
    found = bins(np.linspace(2.0, 3.0, size), scale, "v")
    number = int(min(max(2.0 * (scale * size) ** (1 / 3), 8), 256))
    inner = {k / number for k in range(1, number)}
    halves = {0.5**k / number for k in range(1, max(2, int(math.log2(size / number))))}
    levels = np.sort([*inner, *halves, *(1 - half for half in halves)])
    reach = 2.0 ** np.arange(1, 20) - 1
    first, last = levels[1] - levels[0], levels[-1] - levels[-2]
    expected = np.concatenate([levels[0] - first * reach[::-1], levels, levels[-1] + last * reach])
    np.testing.assert_allclose(found - 2.0, expected, rtol=1e-9, atol=1e-11)
    assert np.all(np.diff(found) > 0)


@pytest.mark.parametrize("spread", [0.0, 0.9e-9])
def test_bins_of_a_sphere(spread: float) -> None:
    """One bin holds all that differs by less than 1e-9; the others go on from there."""
    found = bins(np.array([0.7 + spread, 0.7, 0.7]), 1.0, "v")
    reach = 1e-9 * (2.0 ** np.arange(1, 20) - 1)
    top = 0.7 + spread
    expected = [*(0.7 - reach[::-1]), 0.7, np.nextafter(top, 1), *(top + reach)]
    np.testing.assert_array_equal(found, expected)
    assert bins(np.array([0.7, 0.7 + 1e-9 * 1.5]), 1.0, "v").size > found.size


@pytest.mark.parametrize("number", [0, 1])
def test_a_node_needs_two_impacts(number: int) -> None:
    told = rf"^impacts of the first particles = {number}: must be 2 or more at 0\.5 m/s: more particles, "
    with pytest.raises(ValueError, match=told):
        bins(np.full(number, 0.5), 1.0, "0.5 m/s")
    assert bins(np.array([0.5, 0.6]), 1.0, "v").size > 2


UNIFORM = Histogram(np.array([0.0, 1.0]), np.array([0.0, 1.0]))


@pytest.fixture
def uniform() -> Table:
    return Table.of(np.array([1.0, 2.0, 3.0]), [UNIFORM] * 3)


def block(batch: int, restitution: Any, velocity: float = 1.5) -> Impacts:
    values = np.atleast_2d(np.asarray(restitution, dtype=float))
    return Impacts(np.full(values.shape, velocity), values, np.zeros(values.shape), batch)


def test_distances_of_equal_values(uniform: Table) -> None:
    """All at u: the distance is max(u, 1 - u); nothing where there are no impacts, or none between nodes."""
    for u in (0.25, 0.75, 0.0, 1.0):
        check = Check.of(
            uniform, [block(0, [u, u]), block(1, [u], 3.0), block(2, [u], 0.5), block(0, [np.nan])]
        )
        assert check.impacts().tolist() == [2, 0]
        first, second = check.distances()
        assert first == pytest.approx(max(u, 1 - u), abs=1 / 4096)
        assert first >= max(u, 1 - u) - 1e-15
        assert np.isnan(second)
        assert check.scatter().shape == (2,)
        assert np.isnan(check.scatter()).all()


def test_the_distance_is_kolmogorovs(uniform: Table) -> None:
    """Of what is even on [0, 1/2] alone 1/2, of all of [0, 1] nothing but what is resolved."""
    even = (np.arange(40_960) + 0.5) / 40_960
    found = Check.of(uniform, [block(0, even), block(0, even / 2, 2.5)])
    assert found.impacts().tolist() == [even.size, even.size]
    np.testing.assert_allclose(found.distances(), [1 / 4096, 0.5 + 1 / 4096], atol=1e-12)


def test_the_scatter_of_two_batches() -> None:
    """One at 1/4, one at 3/4: taken a and b times, Poisson of mean 1, they are |a/(a+b) - 1/2| from all.

    The mean of 64 resamples is within five of its standard errors (1 in 10⁶) of the sum over all a and b.
    """
    number = 10
    table = Table.of(np.arange(1.0, 5.0), [UNIFORM] * 4)
    found = Check.of(table, [block(3, [0.25] * number), block(5, [0.75] * number)]).scatter()
    a, b = np.meshgrid(np.arange(30), np.arange(30))
    factorial = np.array([math.factorial(k) for k in range(30)], dtype=float)
    weight = 1.0 / (factorial[a] * factorial[b])
    weight[0, 0] = 0.0
    weight /= weight.sum()
    away = np.abs(a / np.maximum(a + b, 1) - 0.5)
    mean = float(np.sum(weight * away))
    error = math.sqrt(float(np.sum(weight * (away - mean) ** 2)) / (64 * (1 - math.exp(-2))))
    assert abs(found[0] - mean) < 5 * error
    again = Check.of(table, [block(3, [0.25] * number), block(5, [0.75] * number)]).scatter()
    np.testing.assert_array_equal(again, found)  # the resamples are always the same
    assert np.isnan(found[1:]).all()


def test_a_point_is_spread_evenly(uniform: Table) -> None:
    """A restitution that all impacts share has every u, within five standard errors."""
    edges = np.array([0.0, 0.5, np.nextafter(0.5, 1.0), 1.0])
    point = Histogram(edges, np.array([0.0, 0.25, 0.75, 1.0]))
    table = Table.of(np.array([1.0, 2.0]), [point, point])
    check = Check.of(table, [block(0, np.full(10_000, 0.5))])
    share = np.cumsum(check.count(0)) / 10_000
    assert check.impacts().tolist() == [10_000]
    assert share[1023] == 0.0
    assert share[3072] == 1.0
    assert abs(share[2047] - 0.5) < 5 * 0.5 / 100
    assert abs(share[1535] - 0.25) < 5 * 0.44 / 100
    apart = Check.of(table, [block(0, np.full(100, 0.25))])
    assert apart.count(0)[512] == 100


def distances(distance: list[float], scatter: list[float], impacts: list[int]) -> xr.Dataset:
    return xr.Dataset(
        {
            "ks_distance": ("interval", distance),
            "ks_scatter": ("interval", scatter),
            "fresh_impacts": ("interval", impacts),
            "velocity": ("node", 0.1 * np.arange(1.0, len(distance) + 2)),
        }
    )


def test_a_distance_that_scatter_does_not_explain() -> None:
    """The largest distance is named, as in the summary, with its scatter; and how many are beyond theirs."""
    data = distances([0.06, 0.3, 0.2, np.nan], [0.01, 0.2, 0.02, np.nan], [900, 900, 900, 0])
    with pytest.warns(rs.DistanceWarning) as caught:
        warn_of_distance(data, stacklevel=1)
    told = str(caught[0].message)
    assert "is up to 0.3000 from fresh impacts (Kolmogorov-Smirnov), at 0.2 to 0.3 m/s" in told
    assert "of which their own scatter explains 0.2000. 2 of 4 intervals between nodes are farther" in told
    assert caught[0].filename == __file__


@pytest.mark.parametrize(
    ("distance", "scatter", "impacts", "warned"),
    [
        (0.0499, 0.001, 10_000, False),
        (0.0501, 0.001, 10_000, True),
        (0.098, 0.0281, 10_000, False),
        (0.098, 0.0279, 10_000, True),
        (0.102, 0.0860, 10_000, True),
        (0.06, np.nan, 2500, False),  # 3.5 * 0.87 / 50 = 0.0609
        (0.062, np.nan, 2500, True),
        (np.nan, np.nan, 0, False),
        (0.098, np.nan, 0, False),
    ],
)
def test_when_a_distance_warns(distance: float, scatter: float, impacts: int, warned: bool) -> None:
    """Beyond 0.05 and 3.5 of the scatter, that of a batch as if impacts were independent; and beyond 0.1."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        warn_of_distance(distances([distance], [scatter], [impacts]), stacklevel=1)
    assert [one.category for one in caught] == [rs.DistanceWarning] * warned
