"""Names of what a study measures with a standard error beside it."""

from collections.abc import Iterable

from restitution.drop.statistics import MOMENTS, Edges
from restitution.study._forms import Form

_EXTREMES = ("minimum", "maximum")
"""They have no standard error: leaving out a group moves them by a jump, or not at all."""
MOVED = tuple(name for name in MOMENTS if name not in _EXTREMES)
"""Moments that have one."""
DERIVED = {
    "std_restitution": "standard deviation of restitution",
    "second_moment": "mean of restitution squared",
    "density": "probability density of restitution",
}


def with_errors(edges: Edges | None, forms: Iterable[Form]) -> list[str]:
    """Name the variables of statistics, and of what is taken from them by name."""
    if edges is None:
        return []
    derived = MOVED + tuple(DERIVED) if edges["fraction"] is not None else ("density",)
    return [*derived, *(name for form in forms for name in form.variables)]
