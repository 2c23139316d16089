"""Impacts at one instant, beside single contacts of a box without friction, solved one by one."""

import warnings
from itertools import product
from typing import Any

import numpy as np
import pytest

import restitution as rs

A, B, C = 2e-2, 1e-2, 1e-2
FLAT: dict[str, Any] = {
    "particles": 2,
    "impacts": 9,
    "orientation": [(1.0, 0.0, 0.0, 0.0), (0.9, 0.1, 0.2, 0.3)],
}


def every_net(normal: float) -> set[float]:
    """Net ε of all orders, to ten digits: any corner that approaches the plane may be next."""
    x, y = np.array(list(product((-A / 2, A / 2), (-B / 2, B / 2)))).T
    about_x, about_y = 12.0 / (B**2 + C**2), 12.0 / (A**2 + C**2)
    found, open_ends = set(), [(-1.0, 0.0, 0.0)]
    while open_ends:
        v, p, q = open_ends.pop()  # of the centre of mass, about x and y
        approach = v + p * y - q * x
        corners = np.flatnonzero(approach < -1e-12)
        if corners.size == 0:
            found.add(round(v, 10))
        for k in corners:
            push = -(1.0 + normal) * approach[k] / (1.0 + about_x * y[k] ** 2 + about_y * x[k] ** 2)
            open_ends.append((v + push, p + push * about_x * y[k], q - push * about_y * x[k]))
    return found


@pytest.mark.parametrize("normal", [0.3, 0.5, 0.8])
def test_a_box_that_lands_flat(normal: float) -> None:
    """The net ε is that of one of the orders, and the warning tells of one of two particles."""
    with pytest.warns(rs.ClusterWarning, match=r"particles \(1 of 2\), first at impact 0 of particle 0"):
        data = rs.simulate(rs.Box(a=A, b=B, c=C), rs.Frictionless(normal=normal), **FLAT)
    found = rs.clusters(data)
    number = int(found.impacts[0, 0])
    assert number >= 4
    assert found.cluster[0, : number + 1].values.tolist() == [0] * number + [number]
    orders = every_net(normal)
    assert len(orders) > 1
    assert min(abs(float(found.restitution[0, 0]) - one) for one in orders) < 1e-9
    alone = data.restitution[1].where(np.isfinite(data.time[1]))
    np.testing.assert_allclose(found.restitution[1], alone, rtol=1e-12)


def test_no_warning_without_a_cluster() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", rs.ClusterWarning)
        data = rs.simulate(
            rs.Box(a=A, b=B, c=C),
            rs.Frictionless(normal=0.5),
            **FLAT | {"orientation": [(1.0, 0.1, 0.2, 0.3)] * 2},
        )
    assert int(rs.clusters(data).impacts.max()) == 1
