"""The Dataset of a learned distribution from counts written down here, and the standard errors it states."""

import math
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray

from restitution.distribution import FluctuatingRestitution, _store
from restitution.distribution._count import Counted
from restitution.distribution._table import Histogram

Floats = NDArray[np.float64]
NODES = np.array([0.5, 1.0, 3.0])
WHOLE = [
    Histogram(np.array([0.0, 1.0]), np.array([0.0, 1.0])),
    Histogram(np.array([0.0, 0.5, 2.0]), np.array([0.0, 0.25, 1.0])),
    Histogram(np.array([-1.0, 0.0, 0.25, 1.0]), np.array([0.0, 0.5, 0.75, 1.0])),
]
SHARE_ERRORS = [np.array([0.0]), np.array([0.03, 0.03]), np.array([0.02, 0.01, 0.04])]
BELOW_ERRORS = [np.array([0.0, 0.0]), np.array([0.0, 0.03, 0.0]), np.array([0.0, 0.02, 0.05, 0.0])]
MEAN_ERRORS, STD_ERRORS = np.array([0.01, 0.02, 0.04]), np.array([0.005, 0.015, 0.025])
SHAPE_ERRORS = np.array([[0.0, 0.0], [0.1, 0.3], [0.2, 0.5]])
CONDITIONS = [np.array([0.2, 0.6]), np.array([0.5]), np.array([0.1])]
NO_GAPS: Floats = np.empty((0, 2))


def counted(scale: float, conditions: list[Floats], order: list[int]) -> Counted:
    """What was counted, with the components in this order and errors so many times as large."""
    return Counted(
        nodes=NODES,
        conditions=conditions,
        histograms=[WHOLE[i] for i in order],
        share_errors=[scale * SHARE_ERRORS[i] for i in order],
        below_errors=[scale * BELOW_ERRORS[i] for i in order],
        impacts=np.array([100.0, 200.0, 300.0, 400.0])[: len(order)],
        mean_errors=scale * MEAN_ERRORS[order],
        std_errors=scale * STD_ERRORS[order],
        shape_errors=scale * SHAPE_ERRORS[order],
        seen=np.array([[0.1, 0.2, 0.05], [0.9, 0.8, 0.7]]),
    )


def dataset(given: str | None, gaps: Floats = NO_GAPS) -> xr.Dataset:
    """Components by condition: those of nodes 1 and 2 at the first node, then 0, then 2."""
    check: Any = SimpleNamespace(
        distances=lambda: np.array([0.01, 0.02]),
        scatter=lambda: np.array([0.003, np.nan]),
        impacts=lambda: np.array([50, 60]),
    )
    plain = counted(1.0, [np.zeros(1)] * 3, [0, 1, 2])
    conditional = None if given is None else counted(2.0, CONDITIONS, [1, 2, 0, 2])
    return _store.assemble(plain, conditional, given, check, {"source": "here"}, gaps)


@pytest.mark.parametrize("given", [None, "rotational_fraction", "previous"])
def test_everything_that_was_counted_has_its_place(given: str | None) -> None:
    data = dataset(given, np.array([[0.7, 0.75], [1.5, 2.0]]))
    expected: dict[str, tuple[tuple[str, ...], list[float], str | None]] = {
        "velocity": (("node",), [0.5, 1.0, 3.0], "m s-1"),
        "impacts": (("node",), [100.0, 200.0, 300.0], "1"),
        "edges": (("node",), [2, 3, 4], None),
        "restitution_edge": (("edge",), [0.0, 1.0, 0.0, 0.5, 2.0, -1.0, 0.0, 0.25, 1.0], "1"),
        "probability_below": (("edge",), [0.0, 1.0, 0.0, 0.25, 1.0, 0.0, 0.5, 0.75, 1.0], "1"),
        "probability_error": (
            ("edge",),
            [0.0, np.nan, 0.03, 0.03, np.nan, 0.02, 0.01, 0.04, np.nan],
            "1",
        ),
        "probability_below_error": (("edge",), [0.0, 0.0, 0.0, 0.03, 0.0, 0.0, 0.02, 0.05, 0.0], "1"),
        "mean_error": (("node",), MEAN_ERRORS.tolist(), "1"),
        "std_error": (("node",), STD_ERRORS.tolist(), "1"),
        "skewness_error": (("node",), SHAPE_ERRORS[:, 0].tolist(), "1"),
        "kurtosis_error": (("node",), SHAPE_ERRORS[:, 1].tolist(), "1"),
        "gap_lowest": (("gap",), [0.7, 1.5], "m s-1"),
        "gap_highest": (("gap",), [0.75, 2.0], "m s-1"),
        "ks_distance": (("interval",), [0.01, 0.02], None),
        "ks_scatter": (("interval",), [0.003, np.nan], None),
        "fresh_impacts": (("interval",), [50, 60], None),
    }
    if given is not None:
        # A level of probability has all values, whatever was seen; a share of the energy those that were.
        seen = ([0.1, 0.2, 0.05], [0.9, 0.8, 0.7]) if given != "previous" else ([0.0] * 3, [1.0] * 3)
        order = [1, 2, 0, 2]
        component, edge = ("given_component",), ("given_edge",)
        expected |= {
            "given": (component, [0.2, 0.6, 0.5, 0.1], "1"),
            "given_components": (("node",), [2, 1, 1], None),
            "given_impacts": (component, [100.0, 200.0, 300.0, 400.0], "1"),
            "given_lowest": (("node",), seen[0], "1"),
            "given_highest": (("node",), seen[1], "1"),
            "given_edges": (component, [3, 4, 2, 4], None),
            "given_restitution_edge": (edge, [x for i in order for x in WHOLE[i].edges], "1"),
            "given_probability_below": (edge, [x for i in order for x in WHOLE[i].cumulative], "1"),
            "given_probability_error": (
                edge,
                [x for i in order for x in (*(2 * SHARE_ERRORS[i]), np.nan)],
                "1",
            ),
            "given_probability_below_error": (edge, [2 * x for i in order for x in BELOW_ERRORS[i]], "1"),
            "given_mean_error": (component, (2 * MEAN_ERRORS[order]).tolist(), "1"),
            "given_std_error": (component, (2 * STD_ERRORS[order]).tolist(), "1"),
            "given_skewness_error": (component, (2 * SHAPE_ERRORS[order, 0]).tolist(), "1"),
            "given_kurtosis_error": (component, (2 * SHAPE_ERRORS[order, 1]).tolist(), "1"),
        }
    assert set(data.variables) == set(expected)
    for name, (dimensions, values, units) in expected.items():
        assert data[name].dims == dimensions
        np.testing.assert_array_equal(data[name].values, values)
        assert data[name].attrs.get("units") == units
    told = {name: data[name].attrs.get("long_name", "") for name in data.variables}
    assert all(told.values())
    prefixes = ["", "given_"] if given else [""]
    for prefix in prefixes:
        about = "; a batch of particles is a draw"
        errors = {
            "probability_error": "the probability of the bin above the edge",
            "probability_below_error": "probability_below",
            "mean_error": "the mean",
            "std_error": "the standard deviation",
        }
        for name, of in errors.items():
            assert told[f"{prefix}{name}"] == f"standard error of {of}{about}"
    if given:
        assert told["given"] == _store.GIVEN[given]
        assert told["given_lowest"] == "lowest condition that was seen at the node"
        assert told["given_highest"] == "highest condition that was seen at the node"
    about_given = {} if given is None else {"given": given}
    assert data.attrs == {"source": "here", "beyond": "raise", **about_given}
    _store.check(data)


@pytest.fixture(scope="module")
def dist() -> FluctuatingRestitution:
    return FluctuatingRestitution(dataset("rotational_fraction"))


PLACES: list[tuple[float, float | None]] = [(0.5, None), (0.75, None), (1.0, None), (2.5, None), (3.0, None)]
GIVEN: list[tuple[float, float | None]] = [
    (0.5, 0.2),
    (0.5, 0.5),
    (0.75, 0.6),
    (0.7, 0.3),
    (1.0, 0.4),
    (2.0, 0.2),
]


def components(v: float, z: float | None) -> list[tuple[float, int]]:
    """Share and number, in `WHOLE`, of the histograms that are mixed: linear between nodes and conditions."""
    found = []
    for node in range(3):
        share = float(np.interp(v, NODES, np.eye(3)[node]))
        if z is None or node > 0:
            found.append((share, node if z is None else (0, 0, 2)[node]))
            continue
        above = float(np.clip((z - 0.2) / 0.4, 0.0, 1.0))
        found += [(share * (1 - above), 1), (share * above, 2)]
    return [(share, i) for share, i in found if share > 0]


@pytest.mark.parametrize(("v", "z"), PLACES + GIVEN)
def test_errors_add_up_over_the_neighbours(dist: FluctuatingRestitution, v: float, z: float | None) -> None:
    """As if they were one: each with the share that its histogram has in the mixture."""
    mixed, scale = components(v, z), 1.0 if z is None else 2.0
    given = () if z is None else (z,)
    assert dist.mean_error(v, *given) == pytest.approx(scale * sum(w * MEAN_ERRORS[i] for w, i in mixed))
    std_error = scale * sum(w * STD_ERRORS[i] for w, i in mixed)
    assert dist.std_error(v, *given) == pytest.approx(std_error)
    # d(σ²) = 2 σ dσ
    assert dist.var_error(v, *given) == pytest.approx(2 * math.sqrt(dist.var(v, *given)) * std_error)
    xs = np.array([-2.0, -0.5, 0.1, 0.3, 0.7, 1.5, 3.0])
    for x in xs:
        below = density = 0.0
        for w, i in mixed:
            edges = WHOLE[i].edges
            below += w * float(np.interp(x, edges, BELOW_ERRORS[i]))
            for k, (low, high) in enumerate(pairwise(edges)):
                if low <= x < high:
                    density += w * SHARE_ERRORS[i][k] / (high - low)
        assert dist.cdf_error(x, v, *given) == pytest.approx(scale * below, abs=1e-15)
        assert dist.pdf_error(x, v, *given) == pytest.approx(scale * density, abs=1e-15)
        # dF = p dx, so that an error of F moves the quantile by that error over p.
        probability = dist.cdf(x, v, *given)
        if 0.0 < probability < 1.0 and density > 0.0 and below > 0.0:
            moved = dist.ppf_error(probability, v, *given)
            at = dist.ppf(probability, v, *given)
            assert moved == pytest.approx(dist.cdf_error(at, v, *given) / dist.pdf(at, v, *given))
    for name in ("cdf_error", "pdf_error"):
        found = getattr(dist, name)(xs, v, *given)
        one_by_one = [getattr(dist, name)(x, v, *given) for x in xs]
        np.testing.assert_array_equal(found, one_by_one)
    assert dist.ppf_error([0.0, 1.0], v, *given).tolist() == [0.0, 0.0]


def test_errors_broadcast_and_are_unknown_where_the_arguments_are(dist: FluctuatingRestitution) -> None:
    found = dist.cdf_error(np.array([[0.1], [0.3]]), np.array([0.5, 1.0, 3.0]))
    np.testing.assert_allclose(found, [[0.0, 0.006, 0.032], [0.0, 0.018, 0.05 * (1 - 0.05 / 0.75)]])
    for name in ("cdf_error", "pdf_error"):
        assert np.isnan(getattr(dist, name)(np.nan, 1.0))
        assert np.isnan(getattr(dist, name)([0.1, 0.2], [1.0, np.nan])).tolist() == [False, True]
        assert np.isnan(getattr(dist, name)(0.1, 0.6, [0.3, np.nan])).tolist() == [False, True]
        assert np.ndim(getattr(dist, name)(0.1, 1.0)) == 0
    assert isinstance(dist.ppf_error(0.5, 1.0), float)
    assert isinstance(dist.mean_error(1.0), float)


def test_errors_that_are_not_known_say_why() -> None:
    whole = dataset("rotational_fraction")
    single = FluctuatingRestitution(
        whole.assign(
            {name: whole[name] * np.nan for name in map(str, whole.data_vars) if name.endswith("error")}
        )
    )
    counts = FluctuatingRestitution(
        whole.drop_vars([name for name in whole.variables if str(name).endswith("error")])
    )
    assert single.has_errors
    assert not counts.has_errors
    for name, variable in (
        ("cdf_error", "probability_below_error"),
        ("pdf_error", "probability_error"),
        ("mean_error", "mean_error"),
        ("std_error", "std_error"),
    ):
        arguments = (0.1, 1.0) if name in ("cdf_error", "pdf_error") else (1.0,)
        told = (
            rf"^{variable}: not known; the distribution was made from counts, which do not say what particle "
            r"an impact belongs to; learn gives errors$"
        )
        with pytest.raises(ValueError, match=told):
            getattr(counts, name)(*arguments)
        told = rf"^{variable}: not known; all impacts are those of a single particle, learn from more$"
        with pytest.raises(ValueError, match=told):
            getattr(single, name)(*arguments)
