"""First impacts from rest of random bodies, by matrices and all directions of two lattices."""

from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

import restitution as rs
from restitution.analytic import first_impact

Floats = npt.NDArray[np.float64]


def full_matrix(lever: Floats, inertia: Floats, law: Any, up: Floats) -> Floats:
    """ε of levers and plane normals in the axes of the body: K as a matrix, inertia over the mass."""
    arms = np.cross(lever[:, None], np.eye(3))  # r × e, of the three axes
    k = np.eye(3) + arms @ np.linalg.inv(inertia) @ arms.transpose(0, 2, 1)
    push = (k @ up[..., None])[..., 0]
    whole, gain = np.sum(up * push, axis=1), 1.0 + law.normal
    if isinstance(law, rs.Frictionless):
        return np.asarray(gain / whole - 1.0)
    stuck = np.linalg.solve(k, up[..., None])[..., 0]
    along = np.sum(up * stuck, axis=1)
    across = np.linalg.norm(stuck - along[:, None] * up, axis=1)
    if isinstance(law, rs.ChatterjeeRuina):
        more = along - 1.0 / whole
        room = np.maximum(across - law.friction * more, 1e-300)
        kept = np.minimum(1.0 + law.tangential, law.friction * gain / whole / room)
        return np.asarray(gain / whole + kept * more - 1.0)
    if isinstance(law, rs.Coulomb):
        slips = across > law.friction * along
        flat = np.eye(3) - up[slips, :, None] * up[slips, None]
        weights, axes = np.linalg.eigh(law.friction * flat @ k[slips] @ flat)
        square = ((push[slips, None] @ flat @ axes)[:, 0]) ** 2  # of K_tn along the axes
        low, high = np.zeros(len(square)), np.sqrt(square.sum(axis=1))
        for _ in range(32):
            middle = 0.5 * (low + high)
            long = np.sum(square / (weights + middle[:, None]) ** 2, axis=1) > 1.0
            low, high = np.where(long, middle, low), np.where(long, high, middle)
        drag = np.sum(square / (weights + high[:, None]), axis=1)
        along[slips] = 1.0 / (whole[slips] - law.friction * drag)
    return np.asarray(gain * along - 1.0)


def lowest(body: Any, up: Floats) -> Floats:
    """What touches the plane, from the centre of mass: of balls, of vertices, and of a superellipsoid."""
    if isinstance(body, rs.Ellipsoid | rs.Superellipsoid):
        one, two = (n / (n - 1.0) for n in getattr(body, "exponents", (2.0, 2.0)))  # of the support
        size = np.abs(body.semi_axes * up)
        side = (size[:, 0] ** two + size[:, 1] ** two) ** (1.0 / two)
        height = (side**one + size[:, 2] ** one) ** (1.0 / one)
        found = (size / np.stack([side, side, height], axis=1)) ** [two - 1.0, two - 1.0, one - 1.0]
        found[:, :2] *= (side / height)[:, None] ** (one - 1.0)
        return np.asarray(-np.sign(up) * body.semi_axes * found - body.centre_of_mass)
    if isinstance(body, rs.Box):
        points = np.array(list(product((-0.5, 0.5), repeat=3))) * [body.a, body.b, body.c]
    else:
        points = np.array(body.spheres if isinstance(body, rs.Clump) else body.points)
    radii = points[:, 3] if points.shape[1] == 4 else np.zeros(len(points))
    first = np.argmin(up @ points[:, :3].T - radii, axis=1)
    return np.asarray(points[first, :3] - radii[first, None] * up - body.centre_of_mass)


RANDOM: dict[str, Any] = {
    "clump": lambda rng: rs.Clump(spheres=np.c_[rng.normal(size=(6, 3)), rng.uniform(1.0, 2.0, 6)]),
    "equal balls": lambda rng: rs.Clump(spheres=np.c_[rng.normal(size=(9, 3)), np.full(9, 1.5)]),
    "polyhedron": lambda rng: rs.ConvexPolyhedron(rng.normal(size=(12, 3))),
    "plate": lambda rng: rs.Box(a=rng.uniform(0.5, 1.0), b=rng.uniform(0.5, 1.0), c=0.02),
    "needle": lambda rng: rs.Ellipsoid(semi_axes=[*rng.uniform(0.02, 0.04, 2), 1.0]),
    "superellipsoid": lambda rng: rs.Superellipsoid(
        semi_axes=rng.uniform(0.5, 1.0, 3), exponents=rng.uniform(4.0, 6.0, 2)
    ),
}


def beside_lattices(body: Any, law: Any, number: int, seed: int) -> tuple[float, float, float]:
    """Return how far the distribution function is off, how far the lattices are, and what is stated.

    The two lattices have so many directions, each turned at random: their error is half of what they differ.
    """
    found = []
    height = 1.0 - (2.0 * np.arange(number) + 1.0) / number
    angle = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(number)
    side = np.sqrt(1.0 - height * height)
    even = np.stack([side * np.cos(angle), side * np.sin(angle), height], axis=1)
    for turn in Rotation.random(2, random_state=seed):
        up = turn.apply(even)
        found.append(np.sort(full_matrix(lowest(body, up), body.inertia_tensor / body.mass, law, up)))
    x = np.sort(np.concatenate(found))
    below = [np.searchsorted(values, x, "right") / number for values in found]
    own = 0.5 * np.abs(below[0] - below[1]).max()
    distribution = first_impact(body, law)
    off = np.abs(distribution.cdf(x) - 0.5 * (below[0] + below[1])).max()
    return float(off), float(own), distribution.cdf_error
