"""Fifty digits, and the few vector operations that the reference needs."""

from typing import Any

import mpmath

mp = mpmath.MPContext()  # its own context: the global precision of mpmath stays as it is
mp.dps = 50

Real = Any  # an mpf; mpmath has no types
Vector = tuple[Real, Real, Real]


def dot(a: Vector, b: Vector) -> Real:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def add(a: Vector, b: Vector, factor: Real = 1) -> Vector:
    return (a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2])


def scaled(factor: Real, a: Vector) -> Vector:
    return (factor * a[0], factor * a[1], factor * a[2])


def vector(values: Any) -> Vector:
    x, y, z = (mp.mpf(value) for value in values)
    return (x, y, z)


def rotated(a: Vector, turn: Vector, time: Real) -> Vector:
    """`a` turned with the angular velocity `turn` for `time` (Eqs. 3, 4)."""
    rate = mp.sqrt(dot(turn, turn))
    if rate == 0:
        return a
    unit = scaled(1 / rate, turn)
    cosine, sine = mp.cos_sin(rate * time)
    along = scaled((1 - cosine) * dot(unit, a), unit)
    return add(add(along, a, cosine), cross(unit, a), sine)
