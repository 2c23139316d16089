"""One contract: a learned distribution and a closed form have the methods of SciPy's frozen distributions."""

from typing import Any

import numpy as np
import pytest
from scipy import stats

import restitution as rs
from restitution.distribution import FluctuatingRestitution

V, Z = 0.3, 0.1


@pytest.fixture(scope="module")
def learned() -> FluctuatingRestitution:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    how: dict[str, Any] = {"particles": 4000, "impacts": 60, "velocities": (0.1, 0.5), "seed": 1}
    return FluctuatingRestitution.learn(body, law, **how, given="rotational_fraction")


def frozen_methods() -> set[str]:
    frozen = type(stats.norm())
    return {name for name in dir(frozen) if not name.startswith("_") and callable(getattr(frozen, name))}


def test_both_have_every_method_of_a_frozen_distribution(learned: FluctuatingRestitution) -> None:
    first = rs.analytic.first_impact(
        rs.Dumbbell(radius=1.0, separation=1.0), rs.TangentialRestitution(normal=0.9)
    )
    for dist in (first, learned):
        assert {name for name in frozen_methods() if not hasattr(dist, name)} == set()


def as_scipy(dist: FluctuatingRestitution, given: float | None) -> Any:
    """The mixture at V as SciPy's distribution of a histogram, put together from the Dataset alone."""
    prefix = "" if given is None else "given_"
    data, nodes = dist.data, dist.data.velocity.to_numpy()
    start = np.concatenate([[0], np.cumsum(data[f"{prefix}edges"])])
    first = np.concatenate([[0], np.cumsum(data.given_components)]) if prefix else np.arange(nodes.size + 1)
    i = int(np.searchsorted(nodes, V, side="right")) - 1
    w = (V - nodes[i]) / (nodes[i + 1] - nodes[i])
    parts = []
    for node, share in ((i, 1 - w), (i + 1, w)):
        components = range(first[node], first[node + 1])
        if given is None:
            parts.append((components[0], share))
            continue
        z = data.given.to_numpy()[first[node] : first[node + 1]]
        weights = [np.interp(given, z, row) for row in np.eye(z.size)]
        parts += [(c, share * weight) for c, weight in zip(components, weights, strict=True) if weight > 0]
    tables = []
    for component, share in parts:
        here = slice(start[component], start[component + 1])
        tables.append(
            (
                data[f"{prefix}restitution_edge"].to_numpy()[here],
                data[f"{prefix}probability_below"].to_numpy()[here],
                share,
            )
        )
    edges = np.unique(np.concatenate([edge for edge, _, _ in tables]))
    below = sum(share * np.interp(edges, edge, level) for edge, level, share in tables)
    return stats.rv_histogram((np.diff(below), edges), density=False)()


@pytest.mark.parametrize("given", [None, Z])
def test_every_method_agrees_with_scipy(learned: FluctuatingRestitution, given: float | None) -> None:
    """`scipy.stats.rv_histogram` of the same mixture, to the rounding of its quadrature."""
    exact = as_scipy(learned, given)
    low, high = exact.support()
    x = np.linspace(low + 1e-3, high - 1e-3, 50)
    q = np.linspace(0.01, 0.99, 33)
    at: dict[str, Any] = {"v": V, "given": given}
    for name in ("pdf", "logpdf", "cdf", "logcdf", "sf", "logsf"):
        with np.errstate(divide="ignore"):
            expected = getattr(exact, name)(x)
        np.testing.assert_allclose(getattr(learned, name)(x, **at), expected, rtol=1e-9, atol=1e-12)
    for name in ("ppf", "isf"):
        np.testing.assert_allclose(
            getattr(learned, name)(q, **at), getattr(exact, name)(q), rtol=0, atol=1e-12
        )
    np.testing.assert_allclose(learned.interval(0.9, **at), exact.interval(0.9), rtol=0, atol=1e-12)
    np.testing.assert_allclose(learned.support(**at), (low, high))
    for name in ("mean", "var", "std", "median", "entropy"):
        assert getattr(learned, name)(**at) == pytest.approx(getattr(exact, name)(), rel=1e-9), name
    # Pearson's kurtosis, as everywhere in the package; SciPy has the excess.
    expected = np.add(exact.stats(moments="mvsk"), [0.0, 0.0, 0.0, 3.0])
    np.testing.assert_allclose(learned.stats(**at, moments="mvsk"), expected, rtol=1e-7)
    for order in range(6):
        assert learned.moment(order, **at) == pytest.approx(exact.moment(order), rel=1e-10)
    # By the trapezoidal rule over quantiles, which shares nothing with either.
    level = (np.arange(400_000) + 0.5) / 400_000
    values = learned.ppf(level, **at)
    inside = (values >= 0.2) & (values <= 1.1)
    assert learned.expect(np.exp, **at) == pytest.approx(np.exp(values).mean(), rel=1e-5)
    found = learned.expect(lambda e: e * e, **at, lb=0.2, ub=1.1, conditional=True)
    assert found == pytest.approx((values[inside] ** 2).mean(), rel=1e-5)
    assert learned.expect(None, **at) == pytest.approx(learned.mean(**at), rel=1e-12)


@pytest.mark.parametrize("given", [None, Z])
def test_every_estimate_has_its_error(given: float | None) -> None:
    """Eight ensembles scatter by the stated errors or less: those are upper bounds, by √2 or so at most.

    The scatter of eight is known to a quarter; the bounds are some three of these away.
    """
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    how: dict[str, Any] = {"particles": 1000, "impacts": 60, "velocities": np.linspace(0.2, 0.4, 5)}
    found = [
        FluctuatingRestitution.learn(body, law, **how, given="rotational_fraction", seed=seed)
        for seed in range(8)
    ]
    at: dict[str, Any] = {"v": V, "given": given}
    for name, argument in (("cdf", 0.8), ("ppf", 0.5), ("mean", None), ("std", None), ("var", None)):
        arguments = () if argument is None else (argument,)
        values = [getattr(dist, name)(*arguments, **at) for dist in found]
        errors = [getattr(dist, f"{name}_error")(*arguments, **at) for dist in found]
        ratio = np.std(values, ddof=1) / np.sqrt(np.mean(np.square(errors)))
        assert 0.35 < ratio < 1.6, (name, ratio)


def test_errors_that_are_not_known_say_why(learned: FluctuatingRestitution) -> None:
    counts = rs.statistics(
        rs.Dumbbell(radius=3e-3, separation=3e-3),
        rs.TangentialRestitution(normal=0.9),
        velocity_bins=np.linspace(0.1, 0.5, 9),
        restitution_bins=np.linspace(-1.0, 3.0, 401),
    )
    dist = FluctuatingRestitution.from_statistics(counts)
    for error in (dist.mean_error, dist.var_error, dist.std_error):
        with pytest.raises(ValueError, match="not known; the distribution was made from counts"):
            error(0.3)
    assert dist.data.attrs["standard_errors"].startswith("none: counts do not say which particle")


def test_a_condition_that_was_not_seen_is_refused_or_clamped(learned: FluctuatingRestitution) -> None:
    """By the rule that speeds follow: the least and the greatest that a neighbouring node has seen."""
    highest = float(learned.data.given_highest.max())
    assert highest < 0.99
    for method in (learned.mean, learned.std_error, learned.rvs):
        with pytest.raises(
            ValueError, match=r"given = 0.99: must be in .*, what was seen of rotational_fraction"
        ):
            method(V, given=0.99)
    clamped = learned.clamped()
    assert clamped.mean(V, given=0.99) == clamped.mean(V, given=highest)
    with pytest.raises(ValueError, match=r"given = 1.01: must be in \[0, 1\]"):
        clamped.mean(V, given=1.01)


def test_a_sphere_is_a_point_mass() -> None:
    """Its restitution is its law's, at every quantile, within rounding; fresh spheres agree."""
    sphere, law = rs.Dumbbell(radius=3e-3, separation=0.0), rs.TangentialRestitution(normal=0.9)
    heights = 3e-3 + 0.06 * 0.9 ** (2 * np.linspace(0, 1, 100))
    dist = FluctuatingRestitution.learn(sphere, law, particles=2000, impacts=60, release_height=heights)
    low, high = dist.velocities
    v = np.linspace(low, high, 7)
    np.testing.assert_allclose(dist.ppf([[0.0], [0.5], [1.0]], v), 0.9, rtol=0, atol=1e-14)
    np.testing.assert_allclose(dist.mean(v), 0.9, rtol=0, atol=1e-14)
    assert np.all(dist.std(v) < 1e-14)
    assert np.all(dist.rvs(v, random_state=1) == pytest.approx(0.9, abs=1e-14))
    np.testing.assert_array_equal(dist.cdf([[0.8999], [0.9001]], v), [[0.0] * 7, [1.0] * 7])
    # Uniform levels of independent impacts have 0.87 / sqrt(impacts); the largest of 44 is below three times.
    assert float((dist.data.ks_distance * np.sqrt(dist.data.fresh_impacts)).max()) < 3.0


def test_the_summary_is_text(learned: FluctuatingRestitution) -> None:
    summary = learned.summary()
    assert repr(summary) == str(summary)  # what a notebook shows
    lines = summary.splitlines()
    assert lines[-2] == "It is also given E_rot/E_tot before the impact (Eq. 12)."
    assert lines[-1].startswith("It is at most 0.")
