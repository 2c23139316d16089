"""Analytic functions on an interval, in panels short enough for polynomials: roots, extremes, Gauss sums.

A panel of half width r is accepted if `Disc` arithmetic bounds the function by `GROWTH` times its greatest
value on the interval, on the disc of radius 2r about the middle. That disc holds the Bernstein ellipse ρ = 2
+ √3 of the panel, so that (L. N. Trefethen, SIAM Rev. 50, 67 (2008), Theorems 4.5 and 4.3), in units of that
greatest value,

* n Gauss nodes integrate the power k with an error below (64/15) GROWTH^k ρ^(-2n)/(1 - ρ^-2) times r: with
  n = 20 + 2k less than 1e-21;
* the Chebyshev interpolant of degree 32 is off by less than 4 GROWTH ρ^-32/(ρ - 1) = 1.2e-17.
"""

from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev

from restitution.analytic._disc import Disc, Number
from restitution.analytic._orientation import Floats

GROWTH = 16.0
_DEGREE = 32
_MOST_HALVINGS = 60

Function = Callable[[Number], Number]


def panels(function: Function, low: float, high: float) -> Floats:
    """Return edges of panels on which the error bounds above hold, from low to high, ascending.

    Raises
    ------
    ArithmeticError
        If there is a singularity on the interval.
    """
    greatest = float(np.max(np.abs(function(np.linspace(low, high, 129)))))
    lows, highs = np.array([low]), np.array([high])
    edges = [low, high]
    for _ in range(_MOST_HALVINGS):
        middle = 0.5 * (lows + highs)
        with np.errstate(all="ignore"):
            image = function(Disc(middle, highs - lows))
        greatest = max(greatest, float(np.max(np.abs(function(middle)))))
        # A formula that is constant on the interval gives a plain number.
        bound = image.bound if isinstance(image, Disc) else np.full_like(middle, abs(image))
        rough = bound > GROWTH * greatest
        if not rough.any():
            return np.sort(np.array(edges))
        edges.extend(middle[rough])
        lows, highs = (
            np.concatenate([lows[rough], middle[rough]]),
            np.concatenate([middle[rough], highs[rough]]),
        )
    raise ArithmeticError(f"no bound on the function near {lows[0]!r}")


def roots(function: Function, low: float, high: float, *, derivative: bool = False) -> list[float]:
    """Return angles strictly between low and high at which a function, or its derivative, is 0, ascending."""
    found: list[float] = []
    if not np.any(function(np.linspace(low, high, 129))):
        return found  # 0 throughout
    edges = panels(function, low, high)
    for start, stop in pairwise(edges):
        polynomial = Chebyshev.interpolate(function, _DEGREE, domain=[start, stop])
        zeros = (polynomial.deriv() if derivative else polynomial).roots()
        # Rounding may move a zero by √ulp off the axis where it is nearly double, or across the edge.
        slack = 1e-7 * (stop - start)
        real = zeros[np.abs(zeros.imag) <= slack].real
        found.extend(np.clip(real[(real >= start - slack) & (real <= stop + slack)], start, stop))
    margin = 1e-8 * (high - low)
    return distinct([t for t in found if low + margin < t < high - margin], margin)


def distinct(values: list[float], apart: float) -> list[float]:
    """Sort angles, without those that are nearer to the one before than ``apart``."""
    kept: list[float] = []
    for value in sorted(map(float, values)):
        if not kept or value - kept[-1] > apart:
            kept.append(value)
    return kept


def nodes(edges: Floats, order: int) -> tuple[Floats, Floats]:
    """Return the Gauss nodes and weights on all panels, for the power ``order`` of the function."""
    points, weights = gauss(20 + 2 * order)
    width = np.diff(edges)[:, None]
    return (edges[:-1, None] + width * points).ravel(), (width * weights).ravel()


@lru_cache(maxsize=16)
def gauss(number: int) -> tuple[Floats, Floats]:
    """Return the Gauss nodes and weights on [0, 1]."""
    points, weights = np.polynomial.legendre.leggauss(number)
    return 0.5 * (1.0 + points), 0.5 * weights


def solve(function: Callable[[Floats], Floats], low: Floats, high: Floats) -> Floats:
    """Return roots of many functions, each with a change of sign between its low and high, side by side.

    T. R. Chandrupatla, Adv. Eng. Softw. 28, 145 (1997): inverse quadratic interpolation where it is safe,
    else bisection. Where there is no change of sign, some point of the interval.
    """
    x1, x2 = np.array(low, dtype=float), np.array(high, dtype=float)
    f1, f2 = function(x1), function(x2)
    x3, f3 = x2.copy(), f2.copy()
    tolerance = 4.0 * np.finfo(float).eps * np.maximum(np.abs(x1), np.abs(x2))
    share = np.full_like(x1, 0.5)
    for _ in range(120):
        x = x1 + share * (x2 - x1)
        f = function(x)
        same = np.sign(f) == np.sign(f1)
        x3, f3 = np.where(same, x1, x2), np.where(same, f1, f2)
        x2, f2 = np.where(same, x2, x1), np.where(same, f2, f1)
        x1, f1 = x, f
        with np.errstate(all="ignore"):
            least = tolerance / np.abs(x2 - x1)
            if np.all((least > 0.5) | (f1 == 0.0) | (f2 == 0.0) | np.isnan(f1)):
                break
            xi, phi = (x1 - x2) / (x3 - x2), (f1 - f2) / (f3 - f2)
            inverse = f1 / (f1 - f2) * f3 / (f3 - f2)
            inverse += (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
            safe = (phi**2 < xi) & ((1.0 - phi) ** 2 < 1.0 - xi) & np.isfinite(inverse)
            share = np.clip(np.where(safe, inverse, 0.5), np.fmin(least, 0.5), np.fmax(1.0 - least, 0.5))
    return np.where(np.abs(f1) <= np.abs(f2), x1, x2)
