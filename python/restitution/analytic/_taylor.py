"""Taylor models: a function on flat triangles as a cubic polynomial and a proved bound of what is left.

A triangle has the points m + s (b - a) + t (c - a), m being its centroid. A model has the derivatives of the
function at m, up to the third, and a bound of how far it is from that polynomial anywhere on the triangle. A
formula of +, -, *, / and powers, evaluated on models, gives a model: the bound shrinks as the fourth power of
the size. Where a power is too near to its singularity, only the range of its values is kept; where nothing is
known, the bound is infinite or nan. Rounding, some 1e-15 of each value, is not followed.

K. Makino, M. Berz, Int. J. Pure Appl. Math. 4, 379 (2003).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations_with_replacement, permutations

import numpy as np
from numpy.typing import NDArray

from restitution.analytic._disc import Number
from restitution.analytic._orientation import Floats

_CORNERS = np.array([[-1.0, -1.0], [2.0, -1.0], [-1.0, 2.0]]) / 3.0
"""The corners as s and t."""


def _polar(degree: int) -> Floats:
    """Return what the monomials of a form are, in polar form, at all choices of corners.

    The form is a mean of these, with positive weights, anywhere on the triangle, and so within their range.
    """
    rows = []
    for choice in combinations_with_replacement(_CORNERS, degree):
        s, t = np.moveaxis(np.array(list(permutations(choice))), 2, 0)
        powers = range(degree + 1)  # of t
        rows.append([np.mean(s[:, k:].prod(axis=1) * t[:, :k].prod(axis=1)) for k in powers])
    return np.array(rows)


_POLAR = [_polar(degree) for degree in (1, 2, 3)]
_FORMS = [slice(1, 3), slice(3, 6), slice(6, 10)]
"""Rows of the coefficients of the linear, quadratic and cubic form."""


@dataclass(eq=False)
class Taylor:
    """A function on many triangles side by side."""

    terms: Floats  # of 1, s, t, s², st, t², s³, s²t, st² and t³, (10, triangles)
    rest: Floats

    __array_ufunc__ = None  # NumPy leaves the operators below alone

    @classmethod
    def linear(cls, corners: Floats) -> Taylor:
        """Make it of the values of linear functions at the corners, (3, triangles)."""
        a, b, c = corners
        terms = np.zeros((10, len(a)))
        terms[:3] = (a + b + c) / 3.0, b - a, c - a
        return cls(terms, np.zeros(len(a)))

    @classmethod
    def constant(cls, values: Floats) -> Taylor:
        """Make it of numbers, one for each triangle."""
        return cls.linear(np.stack([values, values, values]))

    def at(self, weights: Floats) -> Floats:
        """Return the polynomial at points, each given by three weights; (triangles, points)."""
        return np.asarray((monomials(weights) @ self.terms).T)

    def __getitem__(self, rows: NDArray[np.bool_]) -> Taylor:
        return Taylor(self.terms[:, rows], self.rest[rows])

    def __setitem__(self, rows: NDArray[np.bool_], other: Taylor) -> None:
        self.terms[:, rows], self.rest[rows] = other.terms, other.rest

    @property
    def forms(self) -> list[Floats]:
        """The coefficients of the linear, quadratic and cubic form."""
        return [self.terms[rows] for rows in _FORMS]

    @cached_property
    def sizes(self) -> list[Floats]:
        """Bounds of the forms."""
        return [np.abs(polar @ form).max(axis=0) for polar, form in zip(_POLAR, self.forms, strict=True)]

    def __neg__(self) -> Taylor:
        return Taylor(-self.terms, self.rest)

    def __add__(self, other: Number) -> Taylor:
        if isinstance(other, Taylor):
            return Taylor(self.terms + other.terms, self.rest + other.rest)
        terms = self.terms.copy()
        terms[0] += other
        return Taylor(terms, self.rest)

    __radd__ = __add__

    def __sub__(self, other: Number) -> Taylor:
        return self.__add__(-other)

    def __rsub__(self, other: Number) -> Taylor:
        return (-self).__add__(other)

    def __mul__(self, other: Number) -> Taylor:
        if not isinstance(other, Taylor):
            return Taylor(self.terms * other, self.rest * np.abs(other))
        terms = self.terms[0] * other.terms
        terms[1:] += other.terms[0] * self.terms[1:]
        (f, g, _), (u, v, _) = self.forms, other.forms
        terms[3:6] += _product(f, u)
        terms[6:] += _product(f, v) + _product(g, u)
        (a, b, c), (d, e, f) = self.sizes, other.sizes
        rest = (a + b + c) * f + (b + c) * e + c * d + (np.abs(self.terms[0]) + a + b + c) * other.rest
        return Taylor(terms, rest + (np.abs(other.terms[0]) + d + e + f + other.rest) * self.rest)

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> Taylor:
        """Return the quotient by what is positive: f/g is q + (f - q g)/g, and f - q g has no terms left."""
        if not isinstance(other, Taylor):
            return self.__mul__(1.0 / other)
        terms, first, (u, v, w) = self.terms.copy(), other.terms[0], other.forms
        quotient = Taylor(terms, np.zeros(len(first)))
        f, g, h = quotient.forms  # views
        terms[0] /= first
        f -= terms[0] * u
        f /= first
        g -= terms[0] * v + _product(f, u)
        g /= first
        h -= terms[0] * w + _product(f, v) + _product(g, u)
        h /= first
        low, _ = bounds(other)
        rest = (self.rest + (quotient * other).rest) / np.where(low > 0.0, low, 0.0)
        return Taylor(terms, rest)

    def __rtruediv__(self, other: Number) -> Taylor:
        return Taylor.constant(other + np.zeros(len(self.rest))) / self

    def __abs__(self) -> Taylor:
        """Return the absolute value; nothing is known where the sign changes."""
        turned = self * np.where(self.terms[0] < 0.0, -1.0, 1.0)
        low, high = bounds(turned)
        return Taylor(turned.terms, np.where(low >= -1e-12 * high, turned.rest, np.inf))

    def __pow__(self, exponent: float) -> Number:
        """Return a power of what is not negative."""
        if exponent in (0.0, 1.0):
            return self if exponent else 1.0
        if exponent == 2.0:
            return self * self
        low, high = bounds(self)
        low = np.maximum(low, 0.0)
        x, (f, g, _), (a, b, c) = self.terms[0], self.forms, self.sizes
        first = exponent * x ** (exponent - 1.0)
        second, third = (
            exponent * (exponent - 1.0) / 2.0,
            exponent * (exponent - 1.0) * (exponent - 2.0) / 6.0,
        )
        fourth = (
            np.abs(third * (exponent - 3.0)) / 4.0 * (low if exponent < 4.0 else high) ** (exponent - 4.0)
        )
        second, third = second * x ** (exponent - 2.0), third * x ** (exponent - 3.0)
        square = _product(f, f)
        terms = first * self.terms
        terms[0] = x**exponent
        terms[3:6] += second * square
        terms[6:] += 2.0 * second * _product(f, g) + third * _product(f, square)
        more = c + self.rest
        rest = np.abs(first) * self.rest + np.abs(second) * (b * b + (2.0 * a + 2.0 * b + more) * more)
        whole = a + b + more
        rest += np.abs(third) * (whole**3 - a**3) + fourth * whole**4
        low, high = low**exponent, high**exponent
        flat = ~(rest < 0.5 * np.abs(high - low))  # than which no more is known of the values
        terms[:, flat] = 0.0
        terms[0, flat] = 0.5 * (low + high)[flat]
        return Taylor(terms, np.where(flat, 0.5 * np.abs(high - low), rest))


def over_greatest(values: Sequence[Number], weights: Sequence[float]) -> Sequence[Number]:
    """Divide models by the one that is greatest at the centroid once they are weighted: powers vary less."""
    if not isinstance(values[0], Taylor):
        return values
    found = np.argmax([w * x.terms[0] for w, x in zip(weights, values, strict=True)], axis=0)
    greatest = Taylor.constant(np.zeros(len(found)))
    for k, x in enumerate(values):
        greatest[found == k] = x[found == k]
    inverse = 1.0 / greatest
    return [x * inverse for x in values]


def monomials(weights: Floats) -> Floats:
    """Return what belongs to the ten coefficients at points given by three weights; (points, 10)."""
    s, t = (weights @ _CORNERS).T
    return np.stack([s**0, s, t, s * s, s * t, t * t, s**3, s * s * t, s * t * t, t**3], axis=1)


def bounds(values: Number) -> tuple[Floats, Floats]:
    """Return what a function is at least and at most on each triangle."""
    if not isinstance(values, Taylor):
        return values, values
    slant, more = _POLAR[0] @ values.terms[1:3], values.sizes[1] + values.sizes[2] + values.rest
    return values.terms[0] + slant.min(axis=0) - more, values.terms[0] + slant.max(axis=0) + more


def value(values: Number) -> Number:
    """Return numbers as they are, and of models those at the centroids."""
    return values.terms[0] if isinstance(values, Taylor) else values


def _product(one: Floats, two: Floats) -> Floats:
    """Return the product of two forms."""
    found = np.zeros((len(one) + len(two) - 1, one.shape[1]))
    for k, factor in enumerate(one):
        found[k : k + len(two)] += factor * two
    return found
