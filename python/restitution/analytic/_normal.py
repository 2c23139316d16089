"""The normal coefficient at the speed at which a body released from rest arrives: v² = 2g(H - h)."""

from typing import Annotated

import numpy as np
from pydantic import Field

from restitution._internal.parameters import Number, Parameters
from restitution.analytic import _disc
from restitution.analytic._taylor import Taylor, bounds, value
from restitution.laws import Material


class Fall(Parameters):
    """From where a body falls: the height H of its centre of mass, and g; in SI units."""

    release_height: Annotated[Number, Field(gt=0, description="height of the centre of mass, m")]
    gravity: Annotated[Number, Field(gt=0, description="m/s²")]

    def squared_speed(self, height: _disc.Number) -> _disc.Number:
        """Return v² when the centre of mass has come down to a height."""
        return 2.0 * self.gravity * (self.release_height - height)

    def height(self, speed: float) -> float:
        """Return the height of the centre of mass at a speed."""
        return self.release_height - 0.5 * speed * speed / self.gravity


def kinks(normal: float | Material) -> tuple[float, ...]:
    """Return speeds in m/s at which the formula of ε_n changes."""
    return normal.kinks if isinstance(normal, Material) else ()


def coefficient(normal: float | Material, squared: _disc.Number, among: float) -> _disc.Number:
    """Return ε_n at v², complex or a disc, by the formula that holds about the speed ``among``."""
    return normal.formula(squared, among) if isinstance(normal, Material) else normal


def at_speed(normal: Material, squared: _disc.Number) -> _disc.Number:
    """Return ε_n at v², numbers or Taylor models; the formula of a triangle is that about its centroid.

    Between two kinks, two formulas of a material differ by what only rises or only falls: the one is farthest
    from ε_n at a kink or at an end of the speeds.
    """
    if not isinstance(squared, Taylor):
        return normal(np.sqrt(squared))
    found, kinks = Taylor.constant(np.zeros_like(squared.rest)), np.array([0.0, *normal.kinks, np.inf])
    middle, low, high = np.sqrt(np.maximum([value(squared), *bounds(squared)], 0.0))
    piece, first, last = np.searchsorted(kinks[1:-1], [middle, low, high])
    for one in np.unique(piece):
        rows = piece == one
        among = float(middle[rows][0])
        found[rows] = found[rows] + normal.formula(squared[rows], among)
        near = first[rows] + np.arange(np.max((last - first)[rows]) + 2)[:, None]
        speeds = np.clip(kinks[np.minimum(near, len(kinks) - 1)], low[rows], high[rows])
        off = np.abs(normal(speeds) - normal.formula(speeds**2, among)).max(axis=0)
        found.rest[rows] += off
    return found
