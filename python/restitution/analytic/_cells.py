"""Directions of the plane, in triangles on each of which one ball or vertex touches: the unit sphere cut up.

In a direction d, from the centre of mass down to the plane, the element with the greatest support c·d + r
touches, c the centre of a ball and r its radius, 0 for a vertex. On a flat triangle with its corners on the
sphere the support, extended to all vectors, is c·p + r|p|. Taken as linear there, it divides the triangle
into convex cells, one for each element: for equal radii, and so for polyhedra, exactly. The error is at most
(1 - |p|) |r_i - r_j| for two elements; elements that could touch within it are kept, so that no cell is
missed, and `Units.cells` bounds the share of directions of each cell that it can assign to the wrong one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from restitution.analytic._full_impulse import cross, dot
from restitution.analytic._orientation import Floats
from restitution.bodies import Ellipsoid, Superellipsoid, outermost

Ints: TypeAlias = NDArray[np.intp]


@dataclass(frozen=True)
class Balls:
    """A convex hull of balls about the centre of mass, vertices among them."""

    centres: Floats
    radii: Floats

    def contact(self, down: Sequence[Floats], element: Ints) -> tuple[list[Floats], list[Floats]]:
        """Return the points that are farthest down, and their vector products with that direction."""
        centres, radii = list(self.centres[element].T), self.radii[element]
        arm = cross(centres, down)
        if not radii.any():
            return centres, arm
        radii = radii * dot(down, down) ** -0.5
        return [centre + radii * x for centre, x in zip(centres, down, strict=True)], arm

    def halfway(self, one: Floats, two: Floats) -> Floats:
        """Return directions between two."""
        return unit(one + two)

    def touching(self, corners: Floats) -> NDArray[np.bool_]:
        """Say which corners of triangles, (units, 3, 3), are on which planes where contacts are singular."""
        return np.zeros(corners.shape, dtype=bool)

    def lowest(self, down: Floats) -> Ints:
        """Return which element touches."""
        return np.asarray(np.argmax(down @ self.centres.T + self.radii, axis=-1))


@dataclass(frozen=True)
class Smooth(Balls):
    """A smooth convex body: one element, about which the support need not be known here."""

    body: Ellipsoid | Superellipsoid
    axes: Floats  # principal ones, as columns

    def contact(self, down: Sequence[Floats], element: Ints) -> tuple[list[Floats], list[Floats]]:
        """Return the point that is farthest down, and its vector product with that direction."""
        own = [dot(axis, down) for axis in self.axes]
        sizes = np.abs(own)
        # High powers of components, of which the point depends on the ratios alone.
        sizes = sizes / (sizes * np.reshape(self.body.semi_axes, (3, 1))).max(axis=0)
        found = outermost(self.body, list(sizes))
        point = [np.sign(x) * y - z for x, y, z in zip(own, found, self.body.centre_of_mass, strict=True)]
        lever = [dot(axis, point) / self.body.compiled.farthest() for axis in self.axes.T]
        return lever, cross(lever, down)

    def halfway(self, one: Floats, two: Floats) -> Floats:
        """Return directions between two, half-way on |A d| = 1, where normals of a needle are as contacts."""
        own = [np.linalg.norm(d @ self.axes.T * self.body.semi_axes, axis=-1)[:, None] for d in (one, two)]
        return unit(one / own[0] + two / own[1])

    def touching(self, corners: Floats) -> NDArray[np.bool_]:
        """Say which corners are on which planes of symmetry, where components have powers of less than 2."""
        sharp = max(getattr(self.body, "exponents", (0.0, 0.0))) > 1.5
        return np.asarray(sharp & (np.abs(corners @ self.axes.T) < 1e-12))


@dataclass(frozen=True)
class Units:
    """Flat triangles with corners on the sphere, and pairs of each with the elements that may touch there."""

    body: Balls
    corners: Floats  # (units, 3, 3)
    owner: Ints  # the unit of each pair, ascending
    element: Ints

    @classmethod
    def all(cls, body: Balls, axes: Floats) -> Units:
        """Make the faces of an octahedron with its corners on the axes of the body, which are rows."""
        signs = np.array(list(product((-1.0, 1.0), repeat=3)))
        number = len(body.radii)
        pairs = np.repeat(np.arange(8), number), np.tile(np.arange(number), 8)
        return cls(body, signs[:, :, None] * axes, *pairs)._pruned()

    def split(self) -> Units:
        """Divide each into four; one that touches a single plane into three, by a cut along that plane."""
        touching = self.body.touching(self.corners)
        mine, number = touching.any(axis=2), touching.sum(axis=(1, 2))
        cut = (touching.any(axis=1).sum(axis=1) == 1) & (number < 3)
        alone = np.argmax(mine == (number == 1)[:, None], axis=1)  # the corner by itself
        order = (np.where(cut, alone, 0)[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(self.corners, order[:, :, None], 1), 1, 0)
        ab, bc, ca = (self.body.halfway(*side) for side in ((a, b), (b, c), (c, a)))
        bc = np.where(cut[:, None], c, bc)
        fine = [(a, ab, ca), (ab, b, bc), (ab, bc, ca), (ca[~cut], bc[~cut], c[~cut])]
        corners = np.concatenate([np.stack(one, axis=1) for one in fine])
        four = ~cut[self.owner]
        last = 3 * len(a) + (np.cumsum(~cut) - 1)[self.owner[four]]
        owner = np.concatenate([*(self.owner + k * len(a) for k in range(3)), last])
        element = np.concatenate([np.tile(self.element, 3), self.element[four]])
        return Units(self.body, corners, owner, element)._pruned()

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

    def cells(self) -> tuple[Floats, Ints, Floats]:
        """Return the cells as flat triangles, (cells, 3, 3), the pair of each, and its share in doubt.

        That is the share of directions in a cell for which the support of another element may be greater.
        """
        weights = np.broadcast_to(np.eye(3), (len(self.owner), 3, 3))
        pair = np.arange(len(self.owner))
        most = int(np.diff(self.first).max())
        for k in range(most):
            there, gap, _ = self._lead(weights, pair, k)
            cut, origin = clipped(weights[there], gap)
            weights = np.concatenate([weights[~there], cut])
            pair = np.concatenate([pair[~there], pair[there][origin]])
        doubt = np.zeros(len(pair))
        for k in range(most if np.ptp(self.body.radii) > 0.0 else 0):
            there, gap, error = self._lead(weights, pair, k)
            doubt[there] += _share_below(gap, error)
        doubt /= self._distance[self.owner[pair]] ** 3  # a flat area has at most so many more directions
        return weights @ self.corners[self.owner[pair]], pair, np.minimum(doubt, 1.0)

    def _lead(self, weights: Floats, pair: Ints, k: int) -> tuple[NDArray[np.bool_], Floats, Floats]:
        """Return which cells have a k-th other element, its lag at corners, and how much less it may be."""
        other = self.first[self.owner[pair]] + k
        there = (other < self.first[self.owner[pair] + 1]) & (other != pair)
        mine, other = pair[there], other[there]
        gap = self.supports[mine] - self.supports[other]
        radii = self.body.radii[self.element]
        error = (radii[mine] - radii[other]) * (1.0 - self._distance[self.owner[mine]])
        return there, np.einsum("tak,tk->ta", weights[there], gap), error

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

    @cached_property
    def _distance(self) -> Floats:
        """Distance of each flat triangle from the centre of the sphere."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return np.asarray(np.abs(np.einsum("uk,uk->u", unit(np.cross(b - a, c - a)), a)))

    def _slack(self, best: Ints) -> Floats:
        """Bound the error of the difference of two supports."""
        radii = self.body.radii[self.element]
        return np.asarray(np.abs(radii[best] - radii) * (1.0 - self._distance)[self.owner])

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


def _share_below(corners: Floats, most: Floats) -> Floats:
    """Return the share of a flat triangle in which a linear function, not negative, is below a bound."""
    low, middle, high = np.sort(corners, axis=1).T
    width, below, above = (np.maximum(x, 1e-300) for x in (high - low, middle - low, high - middle))
    at = np.clip(most, low, high)
    rising = (at - low) / width * ((np.minimum(at, middle) - low) / below)
    falling = 1.0 - (high - at) / width * ((high - np.maximum(at, middle)) / above)
    return np.where(most <= np.maximum(low, 0.0), 0.0, np.where(at < middle, rising, falling))


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
