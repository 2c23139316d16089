"""The surface on which the bodies of a pair touch, averaged over their attitudes.

The rates of a gas are integrals over it of functions of b, the rotational part of the inverse effective mass
K = 2/m + b along the normal **n**, b = Σ (**r** × **n**)·J⁻¹(**r** × **n**) over both bodies.

Two convex bodies touch at the normal **n** with the element of area det(W₁ + W₂) d**n**, W being the matrix
of the radii of curvature there. Averaged over the turn of one body about **n** this is (g₁k₂ + k₁g₂ + 2h₁h₂)
d**n** with g = 1, h = tr W/2 and k = det W, so that each body enters with three measures over its normals:
of direction, of mean radius and of area. A pair of equal dumbbells is not convex. The balls of two ends touch
in 16πR² of directions, which are open to them if no other ball is in the way: with the axis **e**, towards
the end that touches, x = **n**·**e** of each body and ℓ = L/4R these are x₁ > -ℓ, x₂ > -ℓ and
x₁ + x₂ + 2ℓ(1 + **e**₁·**e**₂) > 0.
"""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from restitution._internal.arrays import FloatArray
from restitution._internal.parameters import ParameterError, wrong
from restitution.bodies import AnyBody, Dumbbell, Ellipsoid, Spherocylinder, Spheroid

ALLOWED = (
    "an Ellipsoid, a Spheroid, a Spherocylinder, or a Dumbbell of equal balls at most two radii apart, "
    "with the inertia of its matter or one of the same axes"
)


class Surface(NamedTuple):
    """Nodes of a quadrature over the contact surface of a pair of equal bodies."""

    area: FloatArray
    """Its element, in m²; shape (n,)."""
    turning: FloatArray
    """The rotational part b of K, in 1/kg; shape (n,)."""
    axes: int
    """Axes of a body about which contacts turn it."""


class _Measures(NamedTuple):
    """The normals of a convex body: directions g, mean radii h and areas k, over 4π, and b."""

    g: FloatArray
    h: FloatArray
    k: FloatArray
    b: FloatArray


def surface(body: AnyBody, nodes: int) -> Surface:
    """Return the contact surface of two such bodies by Gauss's rules of so many nodes each."""
    match body:
        case Dumbbell() if body.separation == 0.0:
            semi_axes, moments = np.full(3, body.radii[0]), np.full(3, body.transverse_inertia)
            measures, axes = _ellipsoid(semi_axes, moments, 1, 1), 0
        case Dumbbell() if body.is_equal and body.separation <= 2.0 * body.radii[0]:
            return _dumbbells(body, nodes)
        case Spherocylinder():
            measures, axes = _spherocylinder(body, nodes), 2 if body.separation else 0
        case Spheroid():
            semi_axes = np.array([body.equatorial, body.equatorial, body.polar])
            moments = np.array([body.transverse_inertia, body.transverse_inertia, body.axial_inertia])
            measures, axes = _ellipsoid(semi_axes, moments, nodes, 1), 2 if body.elongation != 1.0 else 0
        case Ellipsoid() if _diagonal(body):
            a, b, c = (semi_axes := np.asarray(body.semi_axes, float))
            measures = _ellipsoid(semi_axes, np.diag(body.inertia_tensor), nodes, nodes)
            axes = sum((b != c, c != a, a != b))
        case _:
            raise ParameterError(wrong("body", body, ALLOWED))
    g, h, k, b = measures
    area = np.multiply.outer(g, k) + np.multiply.outer(k, g) + 2.0 * np.multiply.outer(h, h)
    return Surface(4.0 * np.pi * area.ravel(), np.add.outer(b, b).ravel(), axes)


def _diagonal(body: Ellipsoid) -> bool:
    tensor, centre = body.inertia_tensor, body.centre_of_mass
    off = tensor - np.diag(np.diag(tensor))
    return not (np.abs(off) > 1e-14 * np.abs(tensor).max()).any() and not centre.any()


def _gauss(low: float, high: float, nodes: int) -> tuple[FloatArray, FloatArray]:
    x, weight = np.polynomial.legendre.leggauss(nodes)
    return 0.5 * (high - low) * x + 0.5 * (low + high), 0.5 * (high - low) * weight


def _ellipsoid(semi_axes: FloatArray, moments: FloatArray, nodes: int, azimuths: int) -> _Measures:
    """With A = diag(a², b², c²), h = √(n·An) the support: r = An/h, W = A/h - An nA/h³, det W = (abc)²/h⁴.

    The octant of positive components stands for all, and one azimuth for those of a body of revolution.
    """
    z, along = _gauss(0.0, 1.0, nodes)
    azimuth, around = _gauss(0.0, 0.5 * np.pi, azimuths)
    across = np.sqrt(1.0 - z * z)
    x, y = np.multiply.outer(across, np.cos(azimuth)), np.multiply.outer(across, np.sin(azimuth))
    normal = np.stack([x, y, np.broadcast_to(z[:, None], x.shape)], axis=-1).reshape(-1, 3)
    g = np.multiply.outer(along, around / (0.5 * np.pi)).ravel()
    square = semi_axes**2
    support = np.sqrt(normal**2 @ square)
    mean = 0.5 * (square.sum() / support - (normal * square) ** 2 @ np.ones(3) / support**3)
    arm = np.cross(normal * square / support[:, None], normal)
    return _Measures(g, g * mean, g * square.prod() / support**4, arm**2 @ (1.0 / moments))


def _spherocylinder(body: Spherocylinder, nodes: int) -> _Measures:
    """Both caps, of which one stands for the other, and the cylinder, whose normals have one direction."""
    half = 0.5 * body.separation
    cosine, cap = _gauss(0.0, 1.0, nodes)
    place, along = _gauss(0.0, 1.0, nodes)
    radius = body.radius
    g = np.concatenate([cap, np.zeros(nodes)])
    h = np.concatenate([cap * radius, 0.5 * half * along])
    k = np.concatenate([cap * radius**2, radius * half * along])
    arm = np.concatenate([1.0 - cosine**2, place**2])
    return _Measures(g, h, k, half**2 * arm / body.transverse_inertia)


def _dumbbells(body: Dumbbell, nodes: int) -> Surface:
    """Find the directions that are open, in the angles of both axes with **n** and the azimuth between them.

    The first angle goes up to arccos(-ℓ). For each, and an azimuth φ, the second goes up to this as well, or
    to where A + B cos + C sin = 0 of the third condition, of which it meets one at most. Which of both it is
    changes at one φ, and where that leaves [0, π] a panel of the first angle ends, with a square root that
    the substitution by sin² removes.
    """
    reach = body.separation / (4.0 * body.radii[0])
    end, sine = math.acos(-reach), math.sqrt(1.0 - reach * reach)
    first, second, weight = [], [], []
    cuts = {0.0, end}
    for across in (sine, -sine):
        cuts |= {one for one in _zeros(reach, -reach, across) if 0.0 < one < end}
    ends = sorted(cuts)
    for low, high in pairwise(ends):
        turn, share = _gauss(0.0, 0.5 * np.pi, nodes)
        angles = low + (high - low) * np.sin(turn) ** 2
        for angle, part in zip(angles, share * (high - low) * np.sin(2.0 * turn), strict=True):
            x, y = math.cos(angle), math.sin(angle)
            change = -(x - reach + 2.0 * reach * (1.0 - x * reach)) / (2.0 * reach * y * sine)
            switch = math.acos(min(1.0, max(-1.0, change)))
            for start, stop in ((0.0, switch), (switch, np.pi)):
                azimuth, around = _gauss(start, stop, nodes)
                limit = np.full(nodes, end) if start == 0.0 else _last(reach, x, y * np.cos(azimuth))
                share_of, inner = _gauss(0.0, 1.0, nodes)
                other = np.multiply.outer(limit, share_of)
                area = part * y * np.multiply.outer(around * limit, inner) * np.sin(other)
                weight.append(area.ravel())
                second.append(np.sin(other.ravel()) ** 2)
                first.append(np.full(area.size, y * y))
    arms = np.concatenate(first) + np.concatenate(second)
    half = 0.5 * body.separation
    # 16πR² of the four pairs of ends each; the average over x₁, x₂ in [-1, 1] and φ in [0, π].
    area = 16.0 * np.pi * body.radii[0] ** 2 * 4.0 / (4.0 * np.pi) * np.concatenate(weight)
    return Surface(area, half**2 * arms / body.transverse_inertia, 2)


def _zeros(reach: float, x: float, across: float) -> tuple[float, ...]:
    """Angles in (-π, π] where x + cos + 2ℓ(1 + x cos + across sin) = 0."""
    constant, cosine, sine = x + 2.0 * reach, 1.0 + 2.0 * reach * x, 2.0 * reach * across
    middle, size = math.atan2(sine, cosine), math.hypot(sine, cosine)
    if abs(constant) > size:
        return ()
    wide = math.acos(-constant / size)
    return tuple(math.remainder(middle + side * wide, 2.0 * math.pi) for side in (1.0, -1.0))


def _last(reach: float, x: float, across: FloatArray) -> FloatArray:
    """Find the angle up to which the third condition holds, with **e**₁ at x and `across` of the azimuth."""
    constant, cosine, sine = x + 2.0 * reach, 1.0 + 2.0 * reach * x, 2.0 * reach * across
    wide = np.arccos(np.clip(-constant / np.hypot(sine, cosine), -1.0, 1.0))
    return np.asarray(np.arctan2(sine, cosine) + wide)
