"""Directions of the plane, in triangles on each of which one ball or vertex touches: the unit sphere cut up.

In a direction d, from the centre of mass down to the plane, the element with the greatest support c·d + r
touches, c the centre of a ball and r its radius, 0 for a vertex. On a flat triangle with its corners on the
sphere the support, extended to all vectors, is c·p + r|p|. Taken as linear there, it divides the triangle
into convex cells, one for each element: for equal radii, and so for polyhedra, exactly. The error is at most
(1 - |p|) |r_i - r_j| for two elements; elements that could touch within it are kept, so that no cell is
missed, and the share of directions that it can assign to the wrong one is `Units.doubt`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from restitution.analytic._orientation import Floats
from restitution.bodies import RigidBody, farthest

Ints: TypeAlias = NDArray[np.intp]


@dataclass(frozen=True)
class Balls:
    """A convex hull of balls about the centre of mass, vertices among them."""

    centres: Floats
    radii: Floats

    def contact(self, down: Floats, element: Ints) -> Floats:
        """Return the point of each element that is farthest down."""
        return np.asarray(self.centres[element] + self.radii[element, None] * down)

    def lowest(self, down: Floats) -> Ints:
        """Return which element touches."""
        return np.asarray(np.argmax(down @ self.centres.T + self.radii, axis=-1))


@dataclass(frozen=True)
class Smooth(Balls):
    """A smooth convex body: one element, about which the support need not be known here."""

    body: RigidBody
    axes: Floats  # principal ones, as columns

    def contact(self, down: Floats, element: Ints) -> Floats:
        """Return the point that is farthest down."""
        found = farthest(self.body, np.reshape(down @ self.axes.T, (-1, 3)))
        return np.reshape(found @ self.axes / self.body.compiled.farthest(), down.shape)


@dataclass(frozen=True)
class Units:
    """Flat triangles with corners on the sphere, and pairs of each with the elements that may touch there."""

    body: Balls
    corners: Floats  # (units, 3, 3)
    owner: Ints  # the unit of each pair, ascending
    element: Ints

    @classmethod
    def all(cls, body: Balls) -> Units:
        """Make the faces of an icosahedron."""
        from scipy.spatial import ConvexHull

        golden = 0.5 * (1.0 + 5.0**0.5)
        points = np.array([(0.0, a, b * golden) for a in (-1.0, 1.0) for b in (-1.0, 1.0)])
        points = np.concatenate([np.roll(points, shift, axis=1) for shift in range(3)])
        corners = points[ConvexHull(points).simplices] / np.hypot(1.0, golden)
        number = len(body.radii)
        pairs = np.repeat(np.arange(20), number), np.tile(np.arange(number), 20)
        return cls(body, corners, *pairs)._pruned()

    def split(self) -> Units:
        """Divide each into four."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        ab, bc, ca = map(unit, (a + b, b + c, c + a))
        corners = np.concatenate(
            [np.stack(one, axis=1) for one in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
        owner = np.concatenate([self.owner + k * len(a) for k in range(4)])
        return Units(self.body, corners, owner, np.tile(self.element, 4))._pruned()

    def only(self, which: NDArray[np.bool_]) -> Units:
        """Take some of them."""
        pairs = which[self.owner]
        number = np.cumsum(which) - 1
        return Units(self.body, self.corners[which], number[self.owner[pairs]], self.element[pairs])

    def joined(self, other: Units) -> Units:
        """Append others."""
        return Units(
            self.body,
            np.concatenate([self.corners, other.corners]),
            np.concatenate([self.owner, other.owner + len(self.corners)]),
            np.concatenate([self.element, other.element]),
        )

    @cached_property
    def first(self) -> Ints:
        """The first pair of each unit, and the number of all."""
        return np.searchsorted(self.owner, np.arange(len(self.corners) + 1))

    @cached_property
    def supports(self) -> Floats:
        """Support of each pair at the three corners."""
        body = self.body
        along = np.einsum("pak,pk->pa", self.corners[self.owner], body.centres[self.element])
        return np.asarray(along + body.radii[self.element, None])

    @cached_property
    def share(self) -> Floats:
        """Share of all directions."""
        return solid_angle(self.corners) / (4.0 * np.pi)

    @cached_property
    def doubt(self) -> Floats:
        """Share of all directions that may be given to the wrong element."""
        doubt = np.zeros(len(self.owner))
        for best in self._best:
            gap = self.supports[best] - self.supports
            width = np.maximum(np.ptp(gap, axis=1), np.finfo(float).tiny)
            doubt = np.maximum(doubt, np.minimum(1.0, 2.0 * self._slack(best) / width))
        return self.share * np.minimum(1.0, np.bincount(self.owner, doubt, len(self.corners)))

    def cells(self) -> tuple[Floats, Ints]:
        """Return the cells as flat triangles, (cells, 3, 3), and the pair of each."""
        weights = np.broadcast_to(np.eye(3), (len(self.owner), 3, 3))
        pair = np.arange(len(self.owner))
        for k in range(int(np.diff(self.first).max())):
            other = self.first[self.owner[pair]] + k
            there = (other < self.first[self.owner[pair] + 1]) & (other != pair)
            gap = self.supports[pair[there]] - self.supports[other[there]]
            cut, origin = clipped(weights[there], np.einsum("tak,tk->ta", weights[there], gap))
            weights = np.concatenate([weights[~there], cut])
            pair = np.concatenate([pair[~there], pair[there][origin]])
        return weights @ self.corners[self.owner[pair]], pair

    @cached_property
    def _best(self) -> list[Ints]:
        """For each pair, the pair of the same unit that touches at each corner."""
        found = []
        for corner in self.supports.T:
            most = np.maximum.reduceat(corner, self.first[:-1])
            winners = np.flatnonzero(corner == most[self.owner])
            best = np.empty(len(self.corners), dtype=np.intp)
            best[self.owner[winners]] = winners
            found.append(best[self.owner])
        return found

    def _slack(self, best: Ints) -> Floats:
        """Bound the error of the difference of two supports."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        distance = np.einsum("uk,uk->u", unit(np.cross(b - a, c - a)), a)
        radii = self.body.radii[self.element]
        return np.asarray(np.abs(radii[best] - radii) * (1.0 - np.abs(distance))[self.owner])

    def _pruned(self) -> Units:
        """Leave out elements that cannot touch, because another one is farther down everywhere."""
        keep = np.ones(len(self.owner), dtype=bool)
        for best in self._best:
            keep &= ~((self.supports[best] - self.supports).min(axis=1) > self._slack(best))
        return Units(self.body, self.corners, self.owner[keep], self.element[keep])


def unit(vectors: Floats) -> Floats:
    """Return vectors of length 1."""
    return np.asarray(vectors / np.linalg.norm(vectors, axis=-1, keepdims=True))


def solid_angle(corners: Floats) -> Floats:
    """Return the solid angles of triangles.

    A. van Oosterom, J. Strackee, IEEE Trans. Biomed. Eng. 30, 125 (1983).
    """
    a, b, c = np.moveaxis(unit(corners), 1, 0)
    volume = np.einsum("tk,tk->t", a, np.cross(b - a, c - a))  # without cancellation
    dots = (np.einsum("tk,tk->t", x, y) for x, y in ((a, b), (b, c), (c, a)))
    return np.asarray(2.0 * np.arctan2(np.abs(volume), 1.0 + sum(dots)))


def clipped(triangles: Floats, values: Floats) -> tuple[Floats, Ints]:
    """Return the parts of triangles on which a linear function is not negative, and the triangle of each."""
    inside = values >= 0.0
    number = inside.sum(axis=1)
    whole = np.flatnonzero(number == 3)
    found, origin = [triangles[whole]], [whole]
    for count in (1, 2):
        rows = np.flatnonzero(number == count)
        alone = np.argmax(inside[rows] == (count == 1), axis=1)  # the corner by itself on its side
        order = (alone[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(triangles[rows], order[:, :, None], 1), 1, 0)
        at = np.take_along_axis(values[rows], order, 1)
        ab, ac = (a + (at[:, :1] / (at[:, :1] - at[:, k : k + 1])) * (end - a) for k, end in ((1, b), (2, c)))
        for part in ((a, ab, ac),) if count == 1 else ((ab, b, c), (ab, c, ac)):
            found.append(np.stack(part, axis=1))
            origin.append(rows)
    return np.concatenate(found), np.concatenate(origin)
