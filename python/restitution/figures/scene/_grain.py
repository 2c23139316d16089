"""The picture of a rigid body: spheres, an ellipsoid or a convex hull."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull

from restitution._internal.arrays import FloatArray
from restitution.bodies import (
    Box,
    Clump,
    ConvexPolyhedron,
    Die,
    Dumbbell,
    Egg,
    Ellipsoid,
    LoadedSphere,
    Mesh,
    RigidBody,
    Ring,
    Rough,
    RoughSphere,
    Turned,
    directions,
    farthest,
)
from restitution.figures.scene._solid import PIXELS, TONES, shade

_FINE = 3
"""Rays across a pixel, so that edges are soft."""
_SIDES = 48
"""Corners of the polygon that stands for a circular rim."""
_POINTS = 600
"""Of a surface that is known by its support."""


@dataclass(frozen=True)
class _Round:
    """The points q about `centre` with q·Aq = 1, in the frame of the picture: right, up, to the reader."""

    centre: FloatArray
    matrix: FloatArray

    @property
    def window(self) -> list[tuple[float, float]]:
        """Between which heights, and how far to the left and the right, it is seen."""
        half = np.sqrt(np.diag(np.linalg.inv(self.matrix)))
        return [(self.centre[k] - half[k], self.centre[k] + half[k]) for k in (1, 0)]

    @property
    def lowest(self) -> FloatArray:
        """Of the ellipsoid q·Q⁻¹q = 1 it is -Qn/√(n·Qn)."""
        down = np.linalg.inv(self.matrix)[:, 1]
        point: FloatArray = self.centre - down / np.sqrt(down[1])
        return point

    def seen(self, right: FloatArray, up: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how near the reader each ray meets it, -inf where it does not, and its normal there."""
        x, y, a = right - self.centre[0], up - self.centre[1], self.matrix
        b = a[0, 2] * x + a[1, 2] * y
        c = a[0, 0] * x * x + 2.0 * a[0, 1] * x * y + a[1, 1] * y * y - 1.0
        root = b * b - a[2, 2] * c
        z = (np.sqrt(np.maximum(root, 0.0)) - b) / a[2, 2]
        normal = np.stack([x, y, z], axis=-1) @ a
        return np.where(root > 0.0, z + self.centre[2], -np.inf), normal


@dataclass(frozen=True)
class _Faces:
    """The points q with n·q <= d for every face, and the corners of that."""

    normals: FloatArray
    distances: FloatArray
    corners: FloatArray

    @property
    def window(self) -> list[tuple[float, float]]:
        """As of what is round."""
        return [(self.corners[:, k].min(), self.corners[:, k].max()) for k in (1, 0)]

    @property
    def lowest(self) -> FloatArray:
        lowest: FloatArray = self.corners[self.corners[:, 1].argmin()]
        return lowest

    hole: "_Faces | None" = None

    def seen(self, right: FloatArray, up: FloatArray) -> tuple[FloatArray, FloatArray]:
        """As of what is round; a ray that comes into the hole meets its far side, or nothing."""
        near, far, normal, _ = self._through(right, up)
        z = np.where(far <= near, near, -np.inf)
        if self.hole is None:
            return z, normal
        front, back, _, wall = self.hole._through(right, up)
        inside = (back <= near) & (near <= front)
        z = np.where(inside, np.where(back > far, back, -np.inf), z)
        return z, np.where(inside[..., None], -wall, normal)

    def _through(self, right: FloatArray, up: FloatArray) -> tuple[FloatArray, ...]:
        """Return between which places a ray is inside, and the normals where it comes in and goes out."""
        near, far = np.full(right.shape, np.inf), np.full(right.shape, -np.inf)
        normal, other = np.zeros((*right.shape, 3)), np.zeros((*right.shape, 3))
        for (x, y, z), distance in zip(self.normals, self.distances, strict=True):
            room = distance - x * right - y * up
            if z > 1e-12:
                nearer = room / z < near
                near, normal[nearer] = np.where(nearer, room / z, near), (x, y, z)
            elif z < -1e-12:
                farther = room / z > far
                far, other[farther] = np.where(farther, room / z, far), (x, y, z)
            else:
                far = np.where(room < 0.0, np.inf, far)
        return near, far, normal, other


def surfaces(body: RigidBody, attitude: FloatArray) -> list[_Round | _Faces]:
    """Return what there is to see about the centre of mass; `attitude` is from the body to the picture."""
    middle = body.centre_of_mass
    match body:
        case Clump() | RoughSphere() | Rough(body=Dumbbell() | LoadedSphere() | Clump()):
            balls = body.compiled.balls()
            return [_Round(attitude @ (ball[:3] - middle), np.eye(3) / ball[3] ** 2) for ball in balls]
        case Ellipsoid(semi_axes=axes):
            return [_Round(attitude @ -middle, attitude @ np.diag(np.array(axes) ** -2.0) @ attitude.T)]
        case Box(vertices=points) | ConvexPolyhedron(points=points) | Die(vertices=points):
            return [_hull((np.array(points) - middle) @ attitude.T)]
        case Mesh(vertices=points, hull=hull):
            return [_hull((np.array(points)[hull] - middle) @ attitude.T)]
        case Ring():
            rims = np.array(body.compiled.rims)
            inner = np.array([[z, body.inner] for z in 3.0 * rims[[0, -1], 0]])
            outside, hole = (_hull((_rims(each) - middle) @ attitude.T) for each in (rims, inner))
            return [replace(outside, hole=hole)]
        case Turned() if not isinstance(body, Egg):
            return [_hull((_rims(np.array(body.compiled.rims)) - middle) @ attitude.T)]
    return [_hull(farthest(body, directions(_POINTS)) @ attitude.T)]


def _hull(corners: FloatArray) -> _Faces:
    size = np.abs(corners).max()
    faces = np.unique(ConvexHull(corners / size).equations.round(9), axis=0)
    return _Faces(faces[:, :3], -size * faces[:, 3], corners)


def _rims(rims: FloatArray) -> FloatArray:
    """Make polygons of circles (z, r), fine enough for the eye."""
    angles = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
    (z, r), circle = rims.T[:, :, None], np.stack([np.cos(angles), np.sin(angles)])
    points = np.broadcast_arrays(r * circle[0], r * circle[1], z)
    return np.stack(points, axis=-1).reshape(-1, 3)


def lowest(body: RigidBody, attitude: FloatArray) -> FloatArray:
    """Return the lowest point of a body from its centre of mass, in the frame of the picture."""
    return min((one.lowest for one in surfaces(body, attitude)), key=lambda point: float(point[1]))


def picture(body: RigidBody, attitude: FloatArray) -> FloatArray:
    """Return the picture of a body about its centre of mass, from -1.05 to 1.05 of its reach, as RGBA."""
    rays, size = _FINE * PIXELS, 1.05 * body.compiled.farthest()
    places = size * ((np.arange(rays) + 0.5) * 2.0 / rays - 1.0)
    right, up = np.meshgrid(places, places)
    depth, color = np.full(right.shape, -np.inf), np.zeros((*right.shape, 3))
    for one in surfaces(body, attitude):
        part = tuple(slice(*np.searchsorted(places, ends)) for ends in one.window)
        z, normal = one.seen(right[part], up[part])
        nearer = z > depth[part]
        depth[part][nearer], color[part][nearer] = z[nearer], shade(normal[nearer], TONES[1])
    parts = (PIXELS, _FINE, PIXELS, _FINE)
    cover = np.isfinite(depth).reshape(parts).mean(axis=(1, 3))
    color = color.reshape(*parts, 3).mean(axis=(1, 3)) / np.maximum(cover, 1e-300)[..., None]
    return np.dstack([color, cover])
