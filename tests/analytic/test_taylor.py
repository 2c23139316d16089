"""Taylor models beside the functions they stand for, and what is bounded with them."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import restitution as rs
from restitution.analytic import _full_impulse
from restitution.analytic._cells import Units
from restitution.analytic._normal import Fall
from restitution.analytic._rigid_first import RigidFirstImpact
from restitution.analytic._taylor import Taylor, bounds
from restitution.analytic._triangular import POINTS, _six, _summed, apart

INSIDE = np.random.default_rng(1).dirichlet([0.7] * 3, size=200)
"""Points of triangles, as weights of the corners; many are near sides and corners."""

FORMULAS: dict[str, Callable[[Any, Any, Any], Any]] = {
    "products": lambda x, y, z: x * y * z * z - 2.0 * x * x + (1.0 - y) * 0.5,
    "quotients": lambda x, y, z: (x - y) / (2.0 + z) - 1.0 / (x * x + y + 0.1),
    "powers": lambda x, y, z: (x + y) ** 0.5 * (1.0 + z * z) ** -1.3 + (x * y) ** 2.0,
    "high powers": lambda x, y, z: (x**7.5 + y**1.5 + z**3.0) ** (1.0 / 7.5),
    "near a singularity": lambda x, y, z: x**0.1 + y ** (1.0 / 3.0) * z**1.0,
    "nested": lambda x, y, z: 0.3 / (1.2 - 0.2 * (0.1 / (x + 0.2) ** 0.5) ** 2.0) ** 0.5 + abs(-1.0 - y * z),
}


@pytest.mark.parametrize("size", [1.0, 0.1, 1e-3])
@pytest.mark.parametrize("name", FORMULAS)
def test_a_function_is_within_the_bound_of_its_model(name: str, size: float) -> None:
    rng = np.random.default_rng(2)
    corners = rng.uniform(0.0, 1.0, (300, 1, 3)) + size * rng.uniform(0.0, 1.0, (300, 3, 3))
    corners[::3, 0, 0] = corners[::3, 1, 0] = 0.0  # where a power is singular
    with np.errstate(all="ignore"):
        model = FORMULAS[name](*(Taylor.linear(part) for part in corners.T))
    values = FORMULAS[name](*np.moveaxis(INSIDE @ corners, 2, 0))
    rest = np.where(model.rest < np.inf, model.rest, np.inf)[:, None]
    off = np.abs(model.at(INSIDE) - values)
    assert np.all(off <= rest + 1e-13)
    assert np.mean(rest < np.inf) > (0.5 if size == 1.0 else 0.9)
    low, high = bounds(model)
    known = rest[:, 0] < np.inf
    assert np.all((low - 1e-13 <= values.min(axis=1))[known] & (values.max(axis=1) <= high + 1e-13)[known])
    samples = FORMULAS[name](*np.moveaxis(POINTS @ corners, 2, 0))
    off = np.abs(samples @ _six(INSIDE.T).T - values)
    assert np.all((off <= apart(model, samples)[:, None] + 1e-13)[known])


@pytest.mark.parametrize("name", ["products", "quotients", "powers", "nested"])
def test_the_bound_falls_with_the_fourth_power_of_the_size(name: str) -> None:
    corners = np.random.default_rng(3).uniform(0.0, 1.0, (50, 3, 3))
    middle = corners.mean(axis=1, keepdims=True)
    coarse, fine = (
        FORMULAS[name](*(Taylor.linear(part) for part in (middle + size * (corners - middle)).T)).rest
        for size in (0.02, 0.01)
    )
    assert np.median(coarse / fine) == pytest.approx(16.0, rel=0.1)


def test_a_function_may_be_as_far_from_its_samples_as_from_its_model() -> None:
    """Of 0 at all samples no more is known."""
    assert apart(Taylor(np.zeros((10, 1)), np.full(1, 0.25)), np.zeros((1, 6))) == 0.25


LAWS: dict[str, Any] = {
    "frictionless": rs.Frictionless(normal=0.7),
    "paper": rs.TangentialRestitution(normal=0.7),
    "Coulomb": rs.Coulomb(normal=0.7, friction=0.15),
    "slippery": rs.Coulomb(normal=0.7, friction=0.0),
    "part": rs.ChatterjeeRuina(normal=0.3, tangential=0.9, friction=0.3),
    "plastic": rs.Coulomb(normal=rs.Plastic(yield_speed=1.5), friction=0.2),
    "measured": rs.ChatterjeeRuina(
        normal=rs.Tabulated(v=[0.0, 1.0, 1.4, 1.6, 2.0, 3.0], e=[1.0, 0.8, 0.7, 0.75, 0.4, 0.3]),
        tangential=0.5,
        friction=0.1,
    ),
}
BODIES: dict[str, Any] = {
    "box": rs.Box(a=1.0, b=2.0, c=3.0),
    "clump": rs.Clump(spheres=[(0, 0, 1, 2), (1, 0, -1, 1.5), (0, 2, 0, 1), (-1, -1, 0, 1.2)]),
    "needle": rs.Ellipsoid(semi_axes=(0.03, 0.025, 1.0)),
    "cushion": rs.Superellipsoid(semi_axes=(1.0, 0.8, 0.6), exponents=(4.0, 4.0)),
    "brick": rs.Superellipsoid(semi_axes=(1.0, 0.8, 0.6), exponents=(20.0, 3.0)),
    "spiky": rs.Superellipsoid(semi_axes=(1.0, 0.8, 0.6), exponents=(1.1, 1.5)),
}


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("body", BODIES)
def test_the_response_inside_of_triangles_is_as_near_as_is_bounded(
    body: str, law: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To the quadratic function through the samples, which is as near to the linear parts as is bounded."""
    one, high = BODIES[body], BODIES[body].compiled.farthest()
    fall = Fall(release_height=1.5 * high, gravity=3.0 / high)  # speeds of 1.2 to 3, in m/s
    distribution = RigidFirstImpact(one, LAWS[law], "isotropic", fall)
    units = Units.all(distribution._hull, distribution._axes[1])
    for _ in range(5):
        units = units.split()
    seen: list[tuple[Any, Any]] = []
    left = RigidFirstImpact._left

    def noted(self: Any, corners: Any, element: Any, values: Any, **options: Any) -> Any:
        seen.append((corners, element))
        return left(self, corners, element, values, **options)

    monkeypatch.setattr(RigidFirstImpact, "_left", noted)
    found = distribution._sampled(units)
    corners, element = (np.concatenate(part) for part in zip(*seen, strict=True))
    points = (INSIDE[:50] @ corners).reshape(-1, 3)
    values = distribution._restitution(list(points.T), np.repeat(element, 50)).reshape(-1, 50)
    with np.errstate(all="ignore"):
        response = distribution._response([Taylor.linear(part) for part in corners.T], element)
        model = response.restitution()
        rest = model.rest + response.kink()
        off = np.abs(values - model.at(INSIDE[:50])).max(axis=1)
    assert np.all((off <= rest + 1e-12) | ~(rest < np.inf))
    quadratic = found.values @ _six(INSIDE[:50].T).T
    assert np.all(np.abs(values - quadratic) <= found.off[:, None] + 1e-12)
    linear = found.values[:, :3] @ INSIDE[:50].T
    assert np.all(np.abs(quadratic - linear) <= found._second[:, None] + 1e-12)
    assert np.median(found.off) < 0.1


@pytest.mark.parametrize("body", ["box", "clump"])
def test_a_slip_in_a_poor_direction_is_bounded(body: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """λ of the centroid for the whole triangle: what it is off counts."""
    monkeypatch.setattr(_full_impulse, "_ORDERS", 0)
    test_the_response_inside_of_triangles_is_as_near_as_is_bounded(body, "Coulomb", monkeypatch)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_sum_of_triangular_distributions_is_as_linear_between_nodes_as_is_bounded(seed: int) -> None:
    """Wide, narrow, one-sided ones and such as are a single number, beside each one's own formula."""
    rng = np.random.default_rng(seed)
    width, places = 10.0 ** rng.uniform(-6.0, 0.0, 400), [0.0, 1e-9, 0.3, 0.5, 1.0]
    if seed == 3:  # wide ones alone
        width, places = rng.uniform(0.5, 1.0, 400), [0.3, 0.5]
    at = np.stack([np.zeros(400), rng.choice(places, 400), np.ones(400)], axis=1)
    parts = rng.uniform(-0.2, 1.0, (400, 1)) + width[:, None] * at
    parts[::40] = parts[::40, :1] if seed < 3 else parts[::40]
    weight = rng.uniform(0.0, 1.0, 400) / 200.0
    nodes = np.unique(np.append(rng.uniform(0.0, 1.0, 60), [0.0, 1.0]))
    x = np.sort(np.append(rng.uniform(0.0, 1.0, 4000), nodes))
    a, b, c = parts.T[:, :, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        rising, falling = (x - a) ** 2 / ((c - a) * (b - a)), 1.0 - (c - x) ** 2 / ((c - a) * (c - b))
    each = np.where(x >= c, 1.0, np.where(x <= a, 0.0, np.where(x < b, rising, falling)))
    exact = weight @ each
    below, _, rough = _summed(nodes, parts, weight)
    np.testing.assert_allclose(below, exact[np.searchsorted(x, nodes)], rtol=0.0, atol=1e-9)
    interval = np.clip(np.searchsorted(nodes, x, "right") - 1, 0, len(rough) - 1)
    assert np.all(np.abs(exact - np.interp(x, nodes, below)) <= rough[interval] + 1e-9)
