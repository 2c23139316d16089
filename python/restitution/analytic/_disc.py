"""Discs in the complex plane: what a formula can at most be near the real axis, proved by evaluating it.

The error of a Gauss sum or of a Chebyshev interpolant follows from a bound on the integrand in a complex
neighbourhood. A formula of +, -, *, / and powers, evaluated on discs, gives such a bound; where a pole may be
in reach, the bound is infinite. Rounding, some 1e-15 of each radius, is not followed.
"""

from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from restitution.analytic._orientation import Floats

Number: TypeAlias = Any
"""An array of real or complex numbers, or of discs: formulas are written once for all three."""


@dataclass(frozen=True, eq=False)
class Disc:
    """Discs with centres on the real axis."""

    centre: Floats
    radius: Floats  # infinite where nothing is known

    __array_ufunc__ = None  # NumPy leaves the operators below alone

    @property
    def bound(self) -> Floats:
        """The greatest absolute value."""
        total = np.abs(self.centre) + self.radius
        return np.where(np.isfinite(total), total, np.inf)

    def __neg__(self) -> "Disc":
        return Disc(-self.centre, self.radius)

    def __add__(self, other: Number) -> "Disc":
        if isinstance(other, Disc):
            return Disc(self.centre + other.centre, self.radius + other.radius)
        return Disc(self.centre + other, self.radius)

    __radd__ = __add__

    def __sub__(self, other: Number) -> "Disc":
        return self.__add__(-other)

    def __rsub__(self, other: Number) -> "Disc":
        return (-self).__add__(other)

    def __mul__(self, other: Number) -> "Disc":
        if isinstance(other, Disc):
            radius = np.abs(self.centre) * other.radius + np.abs(other.centre) * self.radius
            return Disc(self.centre * other.centre, radius + self.radius * other.radius)
        return Disc(self.centre * other, self.radius * abs(other))

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> "Disc":
        return self.__mul__(1.0 / other)

    def __rtruediv__(self, other: Number) -> "Disc":
        return self.reciprocal().__mul__(other)

    def reciprocal(self) -> "Disc":
        """Return 1/z."""
        size = np.abs(self.centre)
        away = self.radius < size
        gap = np.where(away, size - self.radius, 1.0)
        centre = np.where(away, self.centre, 1.0)
        return Disc(1.0 / centre, np.where(away, self.radius / (np.abs(centre) * gap), np.inf))

    def __pow__(self, exponent: float) -> "Disc":
        """Return z^p for -1 < p < 1: the Taylor coefficients of (1 + x)^p but the first alternate in sign."""
        away = self.radius < self.centre
        centre = np.where(away, self.centre, 1.0)
        share = np.where(away, self.radius, 0.0) / centre
        radius = np.abs((1.0 - share) ** exponent - 1.0) * centre**exponent
        return Disc(centre**exponent, np.where(away, radius, np.inf))


def turned(theta: Number) -> tuple[Number, Number]:
    """Return the sine and cosine of an angle."""
    if not isinstance(theta, Disc):
        return np.sin(theta), np.cos(theta)
    sine, cosine = np.sin(theta.centre), np.cos(theta.centre)
    odd, even = np.sinh(theta.radius), np.cosh(theta.radius) - 1.0
    return (
        Disc(sine, np.abs(cosine) * odd + np.abs(sine) * even),
        Disc(cosine, np.abs(sine) * odd + np.abs(cosine) * even),
    )
