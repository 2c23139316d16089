"""Bins so wide or so narrow that a double has no number for their width or for one over it."""

from collections.abc import Callable
from typing import Any

import pytest

import restitution as rs
from reference.refused import message

LOW = {"restitution_bins": [-1.0, 3.0]}
BODY, LAW = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)


def counted(**bins: Any) -> object:
    return rs.statistics(BODY, LAW, particles=2, impacts=2, **bins)


def reduced(**bins: Any) -> object:
    return rs.reduce(rs.simulate(BODY, LAW, particles=2, impacts=2), **bins)


BOTH = pytest.mark.parametrize("call", [counted, reduced])


@BOTH
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("span", [(-1.7e308, 1.7e308), (0.0, 1e101), (-2e100, 0.0)])
def test_a_range_beyond_all_edges(call: Callable[..., object], span: tuple[float, float]) -> None:
    """It is the range that is wrong: nobody gave the edges between its ends."""
    text = message(lambda: call(velocity_bins=3, velocity_range=span, **LOW))
    assert text == f"velocity_range = {span}: must be at most 1e+100 either way"


@BOTH
@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("span", [(0.0, 5e-324), (0.0, 1e-308), (1.0, 1.0000000000000002)])
def test_a_range_too_narrow_for_its_bins(call: Callable[..., object], span: tuple[float, float]) -> None:
    """Between two neighbouring doubles there is no room for edges, and 1/width of a subnormal is infinite."""
    text = message(lambda: call(velocity_bins=3, velocity_range=span, **LOW))
    assert text == f"velocity_range = {span}: must be so wide that 1/width of each of 3 bins is finite"


@BOTH
@pytest.mark.parametrize("edges", [[1e-310, 2e-310, 3e-310], [0.0, 5e-324, 1.0], [-1.0, -1e-309, 0.0]])
def test_edges_too_close(call: Callable[..., object], edges: list[float]) -> None:
    """The edges increase; what fails is the density of bins, by which a number finds its own."""
    at = next(i for i in range(2) if edges[i + 1] - edges[i] < 1e-308)
    text = message(lambda: call(velocity_bins=edges, **LOW))
    told = (
        f"velocity_bins goes from {edges[at]} to {edges[at + 1]}: bins must be so wide that 1/width is finite"
    )
    assert text == told


@BOTH
def test_the_narrowest_bins_that_are_taken(call: Callable[..., object]) -> None:
    call(velocity_bins=[0.0, 6e-309, 1.0], **LOW)
    call(velocity_bins=1, velocity_range=(0.0, 6e-309), **LOW)
