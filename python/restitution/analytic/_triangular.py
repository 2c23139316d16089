"""Distribution of a function that is sampled on triangles: a sum of triangular distributions.

A function that is linear over a triangle has, with points uniform on it, a triangular distribution between
its values at the corners. Each triangle is taken in four, by the middles of its sides; where the function is
nearly level in 64, of the quadratic function through its six values.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from restitution.analytic._cells import Ints
from restitution.analytic._orientation import Floats
from restitution.analytic._panels import gauss, solve

_NODES = 257
_HALVINGS = 10
_TOLERANCE = 2e-6
_NARROWEST = 1e-200
_BLOCK = 1 << 14  # parts, so that their values stay in a cache
_LEVEL = 0.02
_SAFETY = 3.0  # over what is seen inside of a triangle, for between the points there may be more
POINTS = np.concatenate([np.eye(3), 0.5 * (np.eye(3) + np.roll(np.eye(3), 1, 1)), 0.5 * np.eye(3) + 1 / 6])
"""Where a function is sampled: the corners, the middles of the sides, and inside, each as three weights."""


class Triangles(NamedTuple):
    """Triangles of which the sphere consists."""

    unit: Ints  # to which each belongs
    share: Floats
    values: Floats  # at `POINTS`, (triangles, 9)
    middle: Floats  # the share that counts for each middle of a side, (triangles, 3)
    alone: Floats  # 1 where the function is one number, else 0
    doubt: Floats  # the share that may have another function

    def only(self, rows: NDArray[np.bool_]) -> Triangles:
        """Take some of them."""
        return Triangles._make(part[rows] for part in self)

    def joined(self, other: Triangles) -> Triangles:
        """Append others."""
        return Triangles._make(np.concatenate(pair) for pair in zip(self, other, strict=True))

    @property
    def bend(self) -> Floats:
        """Estimate how far the function is from what `parts` make of it."""
        return np.asarray(np.where(self.level, 1.0 / 64.0, 0.25) * self._second + _SAFETY * self._off)

    @property
    def level(self) -> NDArray[np.bool_]:
        """Where the function is nearly at an extreme, and linear parts would have to be many."""
        off = 0.25 * self._second
        return np.asarray((off > _LEVEL * np.ptp(self.values, axis=1)) & (off > self._off))

    @property
    def _second(self) -> Floats:
        """Bound how far the quadratic function through six values is from the linear one.

        With second differences δ at the middles it is off by 4 Σ δ_ij x_i x_j at weights x. Let a be the
        greatest |δ| and c the least; with a in place of the third this is no more than 4a²/(4a - c), and that
        no more than a + c/3. Parts with sides of 1/n have δ/n².
        """
        a, b, c, ab, bc, ca = self.values[:, :6].T
        off = np.abs([ab - 0.5 * (a + b), bc - 0.5 * (b + c), ca - 0.5 * (c + a)])
        return np.asarray(off.max(axis=0) + off.min(axis=0) / 3.0)

    @property
    def _off(self) -> Floats:
        """Return how far the function is from that quadratic one at the points inside."""
        return np.asarray(np.abs(self.values @ _OFF.T).max(axis=1))

    def parts(self) -> tuple[Floats, Floats, Floats]:
        """Return parts of the triangles: values at the corners, ascending, share and bend."""
        found = []
        for rows, (basis, corners) in ((~self.level, _quadratic(2)), (self.level, _quadratic(8))):
            values = (self.values[rows, :6] @ basis.T)[:, corners].reshape(-1, 3)
            number = len(corners)
            share, bend = np.repeat(self.share[rows] / number, number), np.repeat(self.bend[rows], number)
            found.append((np.sort(values, axis=1), share, bend))
        parts, share, bend = (np.concatenate(pair) for pair in zip(*found, strict=True))
        return parts, share, bend

    def mean(self, function: Callable[[Floats], Floats]) -> float:
        """Return the mean of a function of the values, by the rule of the middles."""
        return float(np.sum(self.middle * function(self.values[:, 3:6])))


@dataclass(frozen=True)
class Table:
    """The distribution function at nodes, its density there, and a cubic between them."""

    nodes: Floats
    below: Floats
    density: Floats
    error: float  # of the distribution function
    step: tuple[float, float]  # value of the function with a probability of its own, and that probability

    @classmethod
    def of(cls, found: Triangles, support: tuple[float, float]) -> Table:
        """Sum up the triangular distributions."""
        atom = found.alone > 0.0
        size = float(found.share[atom].sum())
        place = float(found.values[atom].max()) if size else np.nan  # a mean could be beyond all
        rest = found.only(~atom)
        parts, weight, wide = rest.parts()
        middles = np.sort(rest.values[:, 3:6], axis=None)
        even = middles[np.linspace(0, len(middles) - 1, _NODES).astype(int)] if len(middles) else middles
        nodes = np.unique(np.clip(np.concatenate([np.linspace(*support, _NODES), even]), *support))
        below, density = _summed(nodes, parts, weight)
        new, between = 0.5 * (nodes[1:] + nodes[:-1]), 0.0
        for left in reversed(range(_HALVINGS)):
            new_below, new_density = _summed(new, parts, weight)
            off = np.abs(cls(nodes, below, density, 0.0, (place, size)).curve(new) - new_below)
            order = np.argsort(np.concatenate([nodes, new]), kind="stable")
            nodes = np.concatenate([nodes, new])[order]
            below, density = np.append(below, new_below)[order], np.append(density, new_density)[order]
            rough = np.searchsorted(nodes, new[off > _TOLERANCE]) if left else np.empty(0, dtype=int)
            between = max(between, float(np.max(off[(off <= _TOLERANCE) | (left == 0)], initial=0.0)))
            new = np.setdiff1d(0.5 * (nodes[rough, None] + nodes[rough[:, None] + [-1, 1]]), nodes)
            if not new.size:
                break
        _, blurred = _summed(nodes, parts + wide[:, None] * [-1.0, 0.0, 1.0], weight * wide)
        return cls(nodes, below, density, float(blurred.max()) + between, (place, size))

    @cached_property
    def curve(self) -> CubicHermiteSpline:
        """The cubic, its slopes small enough for it to rise.

        F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17, 238 (1980).
        """
        rise = np.maximum(np.diff(self.below), 0.0) / np.diff(self.nodes)
        most = 3.0 * np.minimum(np.append(rise, rise[-1]), np.append(rise[0], rise))
        return CubicHermiteSpline(self.nodes, self.below, np.minimum(self.density, most))

    def probability(self, x: Floats, *, above: bool = False) -> Floats:
        """Return the probability of values up to x, or above it."""
        low, high = self.nodes[[0, -1]]
        place, size = self.step
        inner = np.where(np.isnan(x), x, self.curve(np.clip(x, low, high)))
        below = np.clip(inner, 0.0, 1.0 - size) + size * (x >= place)
        below = np.where(x >= high, 1.0, np.where(x < low, 0.0, below))
        return 1.0 - below if above else below

    def slope(self, x: Floats) -> Floats:
        """Return the density, of what is continuous."""
        low, high = self.nodes[[0, -1]]
        inside = (x >= low) & (x <= high)
        found = np.maximum(self.curve.derivative()(np.clip(x, low, high)), 0.0)
        return np.where(np.isnan(x), np.nan, np.where(inside, found, 0.0))

    def quantile(self, q: Floats) -> Floats:
        """Return x up to which the probability is q."""
        place, size = self.step
        before = float(self.curve(place)) if size else np.inf  # of the step
        rest = np.where(q > before, np.maximum(q - size, before), q)
        after = np.clip(np.searchsorted(self.below, rest), 1, len(self.nodes) - 1)
        found = solve(lambda x: self.curve(x) - rest, self.nodes[after - 1], self.nodes[after])
        found = np.where(q < 1.0, found, self.nodes[-1])  # where the curve may be 1 already before
        found = np.where((q >= before) & (q <= before + size), place, found)
        return np.where(np.isnan(q), np.nan, found)

    def weights(self) -> tuple[Floats, Floats]:
        """Return points between all nodes, and the shares for which they count."""
        points, weights = gauss(3)
        width = np.diff(self.nodes)[:, None]
        x = self.nodes[:-1, None] + width * points
        return x, width * weights * self.slope(x)


def _six(weights: Floats) -> Floats:
    """Return what six values count for in the quadratic function through them, at points of a triangle."""
    x, y, z = weights
    corner, middle = [t * (2.0 * t - 1.0) for t in weights], [4.0 * x * y, 4.0 * y * z, 4.0 * z * x]
    return np.stack(corner + middle, axis=1)


_OFF = np.concatenate([-_six(POINTS[6:].T), np.eye(3)], axis=1)
"""Of the nine values, by how much those inside are more than the quadratic function."""


@lru_cache(maxsize=2)
def _quadratic(number: int) -> tuple[Floats, Ints]:
    """Return the quadratic through six values at points of a triangle, and the parts between them."""
    place: dict[tuple[int, int], int] = {}
    for i in range(number + 1):
        for j in range(number + 1 - i):
            place[i, j] = len(place)
    y, z = np.array(list(place)).T / number
    basis = _six(np.array([1.0 - y - z, y, z]))
    parts = [[(i, j), (i + 1, j), (i, j + 1)] for i, j in place if i + j < number]
    parts += [[(i + 1, j), (i + 1, j + 1), (i, j + 1)] for i, j in place if i + j < number - 1]
    return basis, np.array([[place[at] for at in part] for part in parts])


def _summed(nodes: Floats, parts: Floats, weight: Floats) -> tuple[Floats, Floats]:
    """Return weighted sums of triangular distributions at nodes, and their densities."""
    if len(weight) > _BLOCK:
        blocks = (slice(i, i + _BLOCK) for i in range(0, len(weight), _BLOCK))
        both = np.sum([_summed(nodes, parts[i], weight[i]) for i in blocks], axis=0)
        return both[0], both[1]
    ends = len(nodes)
    place = np.searchsorted(nodes, parts)  # nodes that are less than each corner
    below: Floats = np.cumsum(np.bincount(place[:, 2], weight, ends + 1)[:-1])
    density = np.zeros(ends)
    (a, b, c), corners = parts.T, place.T
    left, right = (np.maximum(side, _NARROWEST) for side in (b - a, c - b))
    peak = 2.0 * weight / np.maximum(c - a, _NARROWEST)
    rise = 0.5 * peak * (b - a)
    for k, (foot, width, sign) in enumerate(((a, left, 1.0), (c, right, -1.0))):
        first, last = corners[k], corners[k + 1] - 1  # nodes on a side
        rows = first < last
        curve, base = sign * peak[rows] / width[rows], k * weight[rows]
        value, slope, _ = _over_nodes(nodes, first[rows], last[rows], foot[rows], curve, base)
        below, density = below + value, density + slope
        rows = first <= last  # the last node of each side, by itself: nothing cancels
        far = np.clip(sign * (nodes[last[rows]] - foot[rows]) / width[rows], 0.0, 1.0)
        part = (rise if k == 0 else weight - rise)[rows] * far * far
        below += np.bincount(last[rows], weight[rows] - part if k else part, ends)
        density += np.bincount(last[rows], peak[rows] * far, ends)
    return below, density


def _over_nodes(nodes: Floats, first: Ints, last: Ints, foot: Floats, curve: Floats, base: Floats) -> Floats:
    """Sum up base + curve (x - foot)²/2, each from one node to before another, and two derivatives.

    In blocks of 1, 2, 4, ... nodes, of which few make up any range: so no number of parts in which all nodes
    are takes long, and nothing cancels.
    """
    levels = [nodes[:: 1 << k] for k in range(len(nodes).bit_length() + 1)]
    sums = []
    for x in levels:
        total = np.zeros((3, len(x)))
        for rows, block in ((first % 2 > 0, first), (last % 2 > 0, last - 1)):
            at = block[rows]
            far = x[at] - foot[rows]
            slope = curve[rows] * far
            terms = base[rows] + 0.5 * slope * far, slope, curve[rows]
            total += np.stack([np.bincount(at, term, len(x)) for term in terms])
        sums.append(total)
        first, last = (first + 1) // 2, last // 2
        rows = first < last
        first, last = first[rows], last[rows]
        foot, curve, base = foot[rows], curve[rows], base[rows]
    found = np.zeros((3, 1))
    for x, total in zip(reversed(levels), reversed(sums), strict=True):
        far = x - np.repeat(x[::2], 2)[: len(x)]
        value, slope, bend = np.repeat(found, 2, axis=1)[:, : len(x)]
        found = total + np.stack([value + (slope + 0.5 * bend * far) * far, slope + bend * far, bend])
    return found
