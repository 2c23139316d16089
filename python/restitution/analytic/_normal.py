"""The normal coefficient at the speed at which a body released from rest arrives: v² = 2g(H - h)."""

from typing import Annotated

import numpy as np
from pydantic import Field

from restitution._core import PADE
from restitution._internal.parameters import Number, Parameters
from restitution.analytic import _disc
from restitution.laws import Material, Plastic, Tabulated, Viscoelastic

_ABOVE, _BELOW = map(np.polynomial.Polynomial, PADE)
"""Numerator and denominator of a viscoelastic sphere's ε_n, in powers of v*."""


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
    match normal:
        case Plastic():
            return (normal.yield_speed,)
        case Tabulated():
            return normal.v
    return ()


def coefficient(normal: float | Material, squared: _disc.Number, among: float) -> _disc.Number:
    """Return ε_n at v², complex or a disc, by the formula that holds about the speed ``among``.

    For real speeds this is what the core computes; between its kinks it is continued into the complex plane.
    A `Scattered` coefficient was refused before.
    """
    match normal:
        case Viscoelastic():
            x = normal.beta**0.5 * squared**0.05
            return _ABOVE(x) / _BELOW(x)
        case Plastic():
            if among <= normal.yield_speed:
                return 1.0
            x = normal.yield_speed / squared**0.5
            ratio = x / (x + 2.0 * (1.2 - 0.2 * (x * x)) ** 0.5)
            return (1.2 * 3.0**0.5) ** 0.5 * (1.0 - x * x / 6.0) ** 0.5 * ratio**0.25
        case Tabulated():
            i = int(np.searchsorted(normal.v, among))
            if i in (0, len(normal.v)):
                return normal.e[max(i - 1, 0)]
            slope = (normal.e[i] - normal.e[i - 1]) / (normal.v[i] - normal.v[i - 1])
            return normal.e[i - 1] + slope * (squared**0.5 - normal.v[i - 1])
    assert not isinstance(normal, Material)
    return normal
