"""Counts and moments against slow exact arithmetic."""

from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import restitution as rs
from reference.given import impacts
from restitution.drop.reduce import reduce, standard_errors
from restitution.drop.statistics import statistics

V_EDGES = [-1.0, -0.5, 0.0, 0.5, 1.0]
E_EDGES = [-1.0, 0.0, 1.0, 2.0]
F_EDGES = [0.0, 0.25, 0.5, 0.75, 1.0]


# Values on the edges, beside them, and off every scale; eighths have exact moments in floating point.
EIGHTHS = st.integers(-24, 24).map(lambda n: n / 8)
ODD = st.sampled_from([np.nan, np.inf, -np.inf, -0.0, 5e-324, np.nextafter(1.0, 0), np.nextafter(0.5, 1)])
ONE = st.tuples(EIGHTHS | ODD, EIGHTHS | ODD, EIGHTHS | ODD)


def member(x: float, edges: list[float]) -> int | None:
    """Index of the half-open bin of x by plain comparison, or None outside."""
    return next((k for k, (low, high) in enumerate(pairwise(edges)) if low <= x < high), None)


@settings(max_examples=60, deadline=None)
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
