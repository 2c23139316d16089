"""The dependence of an impact on the one before, worked out again pair by pair."""

from math import isnan, sqrt
from statistics import fmean

import numpy as np
import pytest

from reference.scattered import EDGES, impacts
from restitution import fit


def share_with_error(values: dict[int, list[float]]) -> tuple[float, float, int]:
    """Mean over all values of all particles, and the error of a ratio of sums over particles."""
    every = [x for one in values.values() for x in one]
    if not every:
        return np.nan, np.nan, 0
    mean = fmean(every)
    groups = len(values)
    squares = sum((sum(one) - mean * len(one)) ** 2 for one in values.values())
    error = sqrt(squares * groups / (groups - 1)) / len(every) if groups > 1 else np.nan
    return mean, error, len(every)


def test_dependence_is_that_of_pairs_counted_one_by_one() -> None:
    """The ranks, the pairs and the errors over particles, in every bin and at its edges."""
    data = impacts()
    v, e, c = (data[name].to_numpy().tolist() for name in ("impact_velocity", "restitution", "contact"))
    # In the fastest bin one particle is alone, and its mean has no error; in the next there are two.
    for one in v:
        one[:] = [0.3 * x if x >= EDGES[2] else x for x in one]
    v[0][:3], e[0][:3] = [1.0, 1.1, 1.0], [0.9, 0.91, 0.92]
    for p in (2, 7):
        v[p][4:9], e[p][4:9] = [0.6, 0.7, 0.8, 0.5, 0.85], [0.8 + 0.01 * (n * p % 5) for n in range(5)]
    v[1][0], c[1][0], c[1][1] = 0.1, 1, 2  # slower than all bins, though with both contacts
    data["impact_velocity"][:], data["restitution"][:], data["contact"][:] = v, e, c
    found = fit.dependence(data, EDGES)
    assert found.attrs == data.attrs
    np.testing.assert_array_equal(found["lag"], [1, 2, 3, 4, 5])
    np.testing.assert_allclose(found["velocity"], [0.25, 0.4, 0.7, 1.05], rtol=1e-15)

    def bin_of(p: int, n: int) -> int | None:
        if isnan(e[p][n]):
            return None
        return next((i for i in range(4) if EDGES[i] <= v[p][n] < EDGES[i + 1]), None)

    members: dict[int, list[float]] = {
        i: sorted(e[p][n] for p in range(40) for n in range(30) if bin_of(p, n) == i) for i in range(4)
    }

    def u(p: int, n: int) -> float | None:
        i = bin_of(p, n)
        if i is None:
            return None
        equal = members[i].count(e[p][n])  # which share the mean of their ranks
        return (members[i].index(e[p][n]) + 0.5 * equal) / len(members[i])

    for i in range(4):
        for lag in range(1, 6):
            products: dict[int, list[float]] = {}
            for p in range(40):
                for n in range(30 - lag):
                    first, second = u(p, n), u(p, n + lag)
                    if bin_of(p, n) == i and first is not None and second is not None:
                        products.setdefault(p, []).append(12 * (first - 0.5) * (second - 0.5))
            mean, error, _ = share_with_error(products)
            one = found.isel(velocity=i).sel(lag=lag)
            assert float(one.autocorrelation) == pytest.approx(mean, rel=1e-11, abs=1e-14, nan_ok=True)
            assert float(one.autocorrelation_error) == pytest.approx(error, rel=1e-11, nan_ok=True)
        sides: dict[int, list[float]] = {}
        others: dict[int, list[float]] = {}
        for p in range(40):
            for n in range(29):
                first, second = u(p, n), u(p, n + 1)
                if bin_of(p, n) != i:
                    continue
                if first is not None and second is not None:
                    sides.setdefault(p, []).append(float((first < 0.5) != (second < 0.5)))
                if c[p][n] > 0 and c[p][n + 1] > 0:
                    others.setdefault(p, []).append(float(c[p][n] != c[p][n + 1]))
        crossing, error, pairs = share_with_error(sides)
        one = found.isel(velocity=i)
        assert int(one.pairs) == pairs
        assert float(one.crossing) == pytest.approx(crossing, rel=1e-12)
        assert float(one.crossing_error) == pytest.approx(error, rel=1e-12, nan_ok=True)
        swap, swap_error, _ = share_with_error(others)
        assert float(one.alternation) == pytest.approx(swap, rel=1e-12, nan_ok=True)
        assert float(one.alternation_error) == pytest.approx(swap_error, rel=1e-12, nan_ok=True)
        if crossing > 0:
            assert float(one.run) == pytest.approx(1 / crossing, rel=1e-12)
            assert float(one.run_error) == pytest.approx(error / crossing**2, rel=1e-12, nan_ok=True)


def test_equal_coefficients_do_not_depend_on_each_other() -> None:
    """As those of a sphere: whatever their order, ranks do not say that one follows from another."""
    data = impacts()
    data["restitution"][:] = 0.9
    found = fit.dependence(data, EDGES)
    np.testing.assert_array_equal(found["autocorrelation"][:3], 0.0)
    np.testing.assert_array_equal(found["crossing"][:3], 0.0)
