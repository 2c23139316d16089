"""Ellipsoids and superellipsoids, and points of smooth surfaces."""

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from restitution._internal.arrays import FloatArray
from restitution._internal.parameters import Allowed
from restitution.bodies._rigid import Density, Matter, RigidBody, several

_AXES = "three finite numbers > 0 in m, the largest at most 1000 times the smallest"


class Ellipsoid(Matter):
    """A homogeneous ellipsoid.

    Parameters
    ----------
    semi_axes : array_like, shape (3,)
        Semi-axes along x, y and z of the body, in m; > 0, the largest at most 1000 times the smallest.

    Examples
    --------
    >>> import restitution as rs
    >>> pebble = rs.Ellipsoid(semi_axes=(3e-3, 2e-3, 1e-3))
    >>> round(pebble.mass * 1e6, 3)  # mg
    62.832
    """

    semi_axes: Annotated[Any, Allowed(_AXES), several(_AXES, 3, "m"), Field(description="m")]
    density: Density = 2500.0


_EXPONENTS = "two numbers (n1, n2), each from 1.1 to 100"


class Superellipsoid(Matter):
    """A homogeneous superellipsoid, the superquadric of discrete-element codes.

    Its surface is (|x/a|^n2 + |y/b|^n2)^(n1/n2) + |z/c|^n1 = 1.

    Parameters
    ----------
    semi_axes : array_like, shape (3,)
        Semi-axes a, b and c along x, y and z of the body, in m; > 0, the largest at most 1000 times the
        smallest.
    exponents : array_like, shape (2,)
        n1, along z, and n2, across, each from 1.1 to 100: with 2 and 2 it is an ellipsoid, with larger ones
        it becomes a box with round edges, with smaller ones an octahedron.

    Examples
    --------
    >>> import restitution as rs
    >>> tablet = rs.Superellipsoid(semi_axes=(3e-3, 3e-3, 1e-3), exponents=(4, 2))
    >>> ellipsoid = rs.Ellipsoid(semi_axes=(3e-3, 3e-3, 1e-3))
    >>> round(tablet.mass / ellipsoid.mass, 3)
    1.311
    """

    semi_axes: Annotated[Any, Allowed(_AXES), several(_AXES, 3, "m"), Field(description="m")]
    exponents: Annotated[Any, Allowed(_EXPONENTS), several(_EXPONENTS, 2, "1")]
    density: Density = 2500.0


_STEP = 1e-5
_LEAST = 1e-280
"""Added to what is 0 at a pole, so that it has a power."""


def farthest(body: RigidBody, normals: FloatArray) -> FloatArray:
    """Return the points farthest along unit vectors, from the centre of mass, in m; shape (n, 3).

    Of ellipsoids and superellipsoids in closed form. Others have the gradient of the support function h, by
    differences: to 1e-9 where the surface is smooth.
    """
    if isinstance(body, Ellipsoid | Superellipsoid):
        found = np.transpose(outermost(body, list(np.abs(normals).T)))
        return np.asarray(np.sign(normals) * found - body.centre_of_mass)

    def h(vectors: FloatArray) -> FloatArray:
        size = np.linalg.norm(vectors, axis=1)
        return np.asarray(size * body.compiled.supports(vectors / size[:, None]))

    changes = [h(normals + _STEP * axis) - h(normals - _STEP * axis) for axis in np.eye(3)]
    return np.stack(changes, axis=1) / (2.0 * _STEP)


def outermost(body: Ellipsoid | Superellipsoid, normal: Sequence[Any]) -> list[Any]:
    """Return the point of the surface with this normal, of any length, in the octant of positive components.

    The support is ((|ax|^q + |by|^q)^(p/q) + |cz|^p)^(1/p), p and q being n/(n - 1) of the exponents n, and
    the point its gradient. Components may be of any kind that adds, multiplies and has powers.
    """
    axes = np.asarray(body.semi_axes)
    p, q = (n / (n - 1.0) for n in getattr(body, "exponents", (2.0, 2.0)))
    size = axes / axes.max()
    x, y, z = (a * u for a, u in zip(size, normal, strict=True))
    across = x**q + y**q + _LEAST
    whole = (across ** (p / q) + z**p) ** (1.0 / p - 1.0)
    side = across ** (p / q - 1.0) * whole
    return [
        axes[0] * (x ** (q - 1.0) * side),
        axes[1] * (y ** (q - 1.0) * side),
        axes[2] * (z ** (p - 1.0) * whole),
    ]
