"""The table of a learned distribution against its own mixtures, worked out bin by bin."""

import pickle
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from restitution.distribution._table import Histogram, Table

Floats = npt.NDArray[np.float64]

PARTS = [
    Histogram(np.array([0.0, 1.0]), np.array([0.0, 1.0])),
    Histogram(np.array([-1.0, 0.0, 3.0]), np.array([0.0, 0.25, 1.0])),
    Histogram(np.array([0.5, 0.75, 1.0, 2.0]), np.array([0.0, 0.5, 0.625, 1.0])),
    Histogram(np.array([0.0, 2.0]), np.array([0.0, 1.0])),
    Histogram(np.array([1.0, 1.5, 4.0]), np.array([0.0, 0.75, 1.0])),
    Histogram(np.array([-2.0, 1.0]), np.array([0.0, 1.0])),
]
SPEEDS = np.array([0.5, 1.0, 4.0])
CONDITIONS = [np.array([0.1, 0.2, 0.4]), np.array([0.3]), np.array([0.2, 0.6])]
PLACES = [
    (0.5, 0.1),
    (0.6, 0.15),
    (0.6, 0.3),
    (0.75, 0.9),
    (1.0, 0.0),
    (3.0, 0.5),
    (4.0, 0.6),
    (0.1, 0.2),
    (9.0, 0.25),
]


@pytest.fixture(scope="module")
def conditional() -> Table:
    return Table.of(SPEEDS, PARTS, CONDITIONS)


@pytest.fixture(scope="module")
def plain() -> Table:
    return Table.of(SPEEDS, PARTS[:3])


def shares(nodes: Floats, x: float) -> list[tuple[float, int]]:
    """Hat functions: 1 at a node, 0 at all others, constant beyond the ends."""
    found = [(float(np.interp(x, nodes, np.eye(nodes.size)[i])), i) for i in range(nodes.size)]
    return [(share, i) for share, i in found if share > 0]


def weights(v: float, z: float | None) -> list[tuple[float, Histogram]]:
    if z is None:
        return [(share, PARTS[i]) for share, i in shares(SPEEDS, v)]
    first = np.cumsum([0, *map(len, CONDITIONS)])
    return [
        (at_speed * at_condition, PARTS[first[node] + i])
        for at_speed, node in shares(SPEEDS, v)
        for at_condition, i in shares(CONDITIONS[node], z)
    ]


def integral(v: float, z: Any, power: int, about: float = 0.0) -> Any:
    """Mean of (x - about)^power: the antiderivative at both ends of every bin."""
    return sum(
        float(weight)
        * probability
        / (high - low)
        * ((high - about) ** (power + 1) - (low - about) ** (power + 1))
        / (power + 1)
        for weight, part in weights(v, z)
        for low, high, probability in zip(
            part.edges[:-1], part.edges[1:], np.diff(part.cumulative), strict=True
        )
    )


def test_components(conditional: Table) -> None:
    assert len(list(conditional)) == len(PARTS)
    for one, part in zip(conditional, PARTS, strict=True):
        assert np.array_equal(one.edges, part.edges)
        assert np.array_equal(one.cumulative, part.cumulative)
    assert conditional.first.tolist() == [0, 3, 4, 6]
    assert conditional.start.tolist() == [0, 2, 5, 9, 11, 14, 16]
    assert conditional.first.dtype == conditional.start.dtype == np.int64


@pytest.mark.parametrize(("v", "z"), PLACES)
@pytest.mark.parametrize("given", [True, False])
def test_moments_are_integrals(v: float, z: float, given: bool, conditional: Table, plain: Table) -> None:
    table, condition = (conditional, z) if given else (plain, None)
    at: tuple[Any, Any] = np.float64(v), np.float64(z)
    mean = integral(v, condition, 1)
    assert float(table.mean(*at)) == pytest.approx(mean, rel=1e-14, abs=1e-15)
    expected = [integral(v, condition, power, mean) for power in (2, 3, 4)]
    assert [float(value) for value in table.central(*at)] == pytest.approx(expected, rel=1e-12, abs=1e-13)
    assert sum(float(weight) for weight, _ in table.parts(*at)) == pytest.approx(1.0, rel=1e-15)


def test_many_places_at_once(conditional: Table, plain: Table) -> None:
    """Shapes are broadcast, and what is not a number gives none."""
    v, z = np.array([[0.6], [1.0], [3.0]]), np.array([0.1, 0.3, 0.5, 0.7])
    assert conditional.mean(v, z).shape == (3, 4)
    cubes = conditional.expectation(lambda x: x**3, v, z, -9.0, 9.0, 3)
    for i, j in np.ndindex(3, 4):
        assert conditional.mean(v, z)[i, j] == pytest.approx(integral(v[i, 0], z[j], 1), rel=1e-14)
        assert cubes[i, j] == pytest.approx(integral(v[i, 0], z[j], 3), rel=1e-13)
        for k, moment in enumerate(conditional.central(v, z), start=2):
            expected = integral(v[i, 0], z[j], k, integral(v[i, 0], z[j], 1))
            assert moment[i, j] == pytest.approx(expected, rel=1e-12)
    for bad in ((np.nan, 0.1), (0.6, np.nan)):
        nowhere = conditional.expectation(np.square, np.array(bad[0]), np.array(bad[1]), 0.0, 1.0, 2)
        assert np.isnan(nowhere)
    assert np.isnan(plain.expectation(np.square, np.array(0.6), np.array(np.nan), 0.0, 1.0, 2))


@pytest.mark.parametrize("order", range(8))
def test_expectations_of_polynomials_are_exact(order: int, conditional: Table) -> None:
    """In a part of the range as well, which cuts bins: the integral of x^n times the density."""
    v, z, low, high = 0.7, 0.25, 0.3, 1.75
    found = conditional.expectation(lambda x: x**order, np.array(v), np.array(z), low, high, order)
    expected = 0.0
    for weight, part in weights(v, z):
        for start, end, probability in zip(
            part.edges[:-1], part.edges[1:], np.diff(part.cumulative), strict=True
        ):
            a, b = np.clip((start, end), low, high)
            expected += (
                weight * probability / (end - start) * (b ** (order + 1) - a ** (order + 1)) / (order + 1)
            )
    assert float(found) == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize(("v", "z"), PLACES)
def test_entropy_is_that_of_the_density(v: float, z: float, conditional: Table) -> None:
    """-∫ p ln p with p constant between neighbouring edges of all components."""
    parts = weights(v, z)
    edges = np.unique(np.concatenate([part.edges for _, part in parts]))
    expected = 0.0
    for low, high in pairwise(edges):
        share = sum(w * np.diff(np.interp([low, high], part.edges, part.cumulative))[0] for w, part in parts)
        if share > 0:
            expected -= share * np.log(share / (high - low))
    assert conditional.entropy(v, z) == pytest.approx(expected, rel=1e-13, abs=1e-15)


def test_entropy_of_parts_that_lie_apart() -> None:
    """Half on [0, 1] and half on [3, 5]: -∫ p ln p = ½ ln 2 + ½ ln 4, and nothing between them."""
    apart = [Histogram(np.array(edges), np.array([0.0, 1.0])) for edges in ([0.0, 1.0], [3.0, 5.0])]
    table = Table.of(np.array([1.0, 2.0]), apart)
    assert table.entropy(1.5, 0.0) == pytest.approx(1.5 * np.log(2.0), rel=1e-14)


def test_values(conditional: Table, plain: Table) -> None:
    """cdf and pdf by interpolation in each part, ppf is the inverse; arguments are broadcast."""
    x = np.linspace(-2.5, 4.5, 57)
    for v, z in PLACES:
        for table, condition in ((conditional, z), (plain, None)):
            parts = weights(v, condition)
            below = sum(w * np.interp(x, part.edges, part.cumulative) for w, part in parts)
            given = () if condition is None else (condition,)
            np.testing.assert_allclose(table.value("cdf", x, v, *given), below, rtol=0, atol=1e-15)
            again = table.value("cdf", table.value("ppf", [0.1, 0.5, 0.9], v, *given), v, *given)
            np.testing.assert_allclose(again, [0.1, 0.5, 0.9], rtol=0, atol=1e-14)
            h = 1e-7
            inside = x + 0.01  # off every edge
            slope = sum(
                w
                * (
                    np.interp(inside + h, p.edges, p.cumulative)
                    - np.interp(inside - h, p.edges, p.cumulative)
                )
                for w, p in parts
            ) / (2 * h)
            np.testing.assert_allclose(table.value("pdf", inside, v, *given), slope, atol=1e-7)
    grid = conditional.value("cdf", x[:, None, None], SPEEDS[:, None], [0.1, 0.3])
    assert grid.shape == (57, 3, 2)
    assert grid[30, 1, 1] == conditional.value("cdf", x[30], SPEEDS[1], 0.3)
    assert conditional.value("cdf", 0.5, 0.5, 0.1).shape == ()


def test_whole_numbers_are_places_as_well(plain: Table) -> None:
    np.testing.assert_array_equal(plain.value("cdf", [0, 1, 2], 1), plain.value("cdf", [0.0, 1.0, 2.0], 1.0))
    assert plain.value("cdf", 1, 1) == plain.value("cdf", np.float32(1), np.float32(1))


def test_draws_have_the_mean_of_their_place(conditional: Table) -> None:
    """Whatever the threads; another seed draws others. Five standard errors: 1 in 10⁶ each."""
    v, z = np.array([[0.6], [3.0]]), np.array(0.3)
    shape = (2, 4000)
    found = conditional.draw(v, z, shape, 7)
    assert found.shape == shape
    assert np.array_equal(conditional.draw(v, z, shape, 7, 2), found)
    assert not np.array_equal(conditional.draw(v, z, shape, 8), found)
    mean, (variance, *_) = conditional.mean(v, z), conditional.central(v, z)
    assert np.all(abs(found.mean(axis=1) - mean[:, 0]) < 5 * np.sqrt(variance[:, 0] / 4000))
    with pytest.raises(ValueError, match="threads = 0"):
        conditional.draw(v, z, shape, 7, 0)


def test_an_interruption_is_passed_on(plain: Table) -> None:
    """Ctrl-C in the core comes out with what raised it."""

    class Interrupted:
        def __getattr__(self, _: str) -> Any:
            def function(*_: Any) -> Any:
                return np.zeros(1), KeyboardInterrupt("core")

            return function

    table = Table.of(SPEEDS, PARTS[:3])
    table.__dict__["mixture"] = Interrupted()
    at: Any = np.array([1.0])
    actions: list[Callable[[], Any]] = [
        lambda: table.value("cdf", at, at),
        lambda: table.draw(at, at, (1,), 0),
    ]
    for action in actions:
        with pytest.raises(KeyboardInterrupt) as raised:
            action()
        assert raised.value.__cause__ is not None
        assert raised.value.__cause__.args == ("core",)


def test_a_table_pickles_without_what_follows_from_it(conditional: Table) -> None:
    conditional.value("cdf", 0.5, 0.6, 0.2)
    again = pickle.loads(pickle.dumps(conditional))
    assert set(vars(again)) == {"speeds", "first", "conditions", "start", "edges", "cumulative"}
    assert again.value("cdf", 0.5, 0.6, 0.2) == conditional.value("cdf", 0.5, 0.6, 0.2)
