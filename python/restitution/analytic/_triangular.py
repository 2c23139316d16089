"""Distribution of a function that is sampled on triangles: a sum of triangular distributions.

A function that is linear over a triangle has, with points uniform on it, a triangular distribution between
its values at the corners. Each triangle is taken in four, by the middles of its sides; where the function is
nearly level in 64, of the quadratic function through its six values.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicHermiteSpline

from restitution.analytic._cells import Ints
from restitution.analytic._orientation import Floats
from restitution.analytic._panels import gauss, solve
from restitution.analytic._taylor import Taylor, monomials

_NODES = 1025
_ROUNDS = 3
_MOST = 8
_TOLERANCE = 4e-6
_NARROWEST = 1e-200
_BLOCK = 1 << 14  # parts, so that their values stay in a cache
_LEVEL = 0.02
POINTS = np.concatenate([np.eye(3), 0.5 * (np.eye(3) + np.roll(np.eye(3), 1, 1))])
"""Where a function is sampled: the corners and the middles of the sides, each as three weights."""


class Triangles(NamedTuple):
    """Triangles of which the sphere consists."""

    unit: Ints  # to which each belongs
    share: Floats
    values: Floats  # at `POINTS`, (triangles, 6)
    middle: Floats  # the share that counts for each middle of a side, (triangles, 3)
    alone: Floats  # 1 where the function is one number, else 0
    off: Floats  # how far the function may be from the quadratic one through the values
    uneven: Floats  # how much of a share there may be more on a part of a triangle than on a flat one
    doubt: Floats  # the share that may have another function

    def only(self, rows: NDArray[np.bool_]) -> Triangles:
        """Take some of them."""
        return Triangles._make(part[rows] for part in self)

    def joined(self, other: Triangles) -> Triangles:
        """Append others."""
        return Triangles._make(np.concatenate(pair) for pair in zip(self, other, strict=True))

    @property
    def bend(self) -> Floats:
        """Bound how far the function is from what `parts` make of it."""
        return np.asarray(np.where(self.level, 1.0 / 64.0, 0.25) * self._second + self.off)

    @property
    def level(self) -> NDArray[np.bool_]:
        """Where the function is nearly at an extreme, and linear parts would have to be many."""
        off = 0.25 * self._second
        return np.asarray((off > _LEVEL * np.ptp(self.values, axis=1)) & (off > self.off))

    @property
    def _second(self) -> Floats:
        """Bound how far the quadratic function through the values is from the linear one.

        With second differences δ at the middles it is off by 4 Σ δ_ij x_i x_j at weights x. Let a be the
        greatest |δ| and c the least; with a in place of the third this is no more than 4a²/(4a - c), and that
        no more than a + c/3. Parts with sides of 1/n have δ/n².
        """
        a, b, c, ab, bc, ca = self.values.T
        off = np.abs([ab - 0.5 * (a + b), bc - 0.5 * (b + c), ca - 0.5 * (c + a)])
        return np.asarray(off.max(axis=0) + off.min(axis=0) / 3.0)

    def uneven_at(self, nodes: Floats) -> Floats:
        """Return how much the distribution function may be off for what is uneven, between each two nodes."""
        wide, ends = self._second + self.off, len(nodes)
        first = np.searchsorted(nodes, self.values[:, :3].min(axis=1) - wide, "right")
        last = np.searchsorted(nodes, self.values[:, :3].max(axis=1) + wide)
        begin, end = (np.bincount(at, self.uneven, ends + 2) for at in (first, np.maximum(first, last) + 1))
        return np.maximum(np.cumsum(begin - end)[1:ends], 0.0)

    def parts(self) -> tuple[Floats, Floats, Floats]:
        """Return parts of the triangles: values at the corners, ascending, share and bend."""
        found = []
        for rows, fine in ((~self.level, _quadratic(2)), (self.level, _quadratic(8))):
            basis, corners = fine
            values = (self.values[rows] @ basis.T)[:, corners].reshape(-1, 3)
            number = len(corners)
            found.append(
                (
                    np.sort(values, axis=1),
                    np.repeat(self.share[rows] / number, number),
                    np.repeat(self.bend[rows], number),
                )
            )
        parts, share, bend = (np.concatenate(pair) for pair in zip(*found, strict=True))
        return parts, share, bend

    def mean(self, function: Callable[[Floats], Floats]) -> float:
        """Return the mean of a function of the values, by the rule of the middles."""
        return float(np.sum(self.middle * function(self.values[:, 3:])))


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
        middles = np.sort(rest.values[:, 3:], axis=None)
        even = middles[np.linspace(0, len(middles) - 1, _NODES).astype(int)] if len(middles) else middles
        nodes = np.unique(np.clip(np.concatenate([np.linspace(*support, _NODES), even]), *support))
        for left in reversed(range(_ROUNDS)):
            below, density, rough = _summed(nodes, parts, weight)
            number = np.clip(np.ceil(np.sqrt(rough / _TOLERANCE)), 1, _MOST).astype(int)
            if not left or number.max() == 1:
                break
            step = np.arange(number.sum()) - np.repeat(np.cumsum(number) - number, number)
            step = step * np.repeat(np.diff(nodes) / number, number)
            nodes = np.append(np.repeat(nodes[:-1], number) + step, nodes[-1])
        table = cls(nodes, below, density, 0.0, (place, size))
        shifted = (_summed(nodes, parts + sign * wide[:, None], weight) for sign in (-1.0, 1.0))
        (most, _, above), (least, _, under) = shifted
        more, less = (np.maximum(gap[1:], gap[:-1]) for gap in (most - below, below - least))
        uneven = rest.uneven_at(nodes)
        off = np.maximum(more + above, less + under) + table._bend + uneven
        ends = most[0] + uneven[0], 1.0 - size - least[-1] + uneven[-1]  # where the curve has nothing left
        return replace(table, error=float(max(off.max(), *ends)))

    @cached_property
    def _slopes(self) -> Floats:
        """Slopes at the nodes, small enough for the curve to rise.

        F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17, 238 (1980).
        """
        rise = np.maximum(np.diff(self.below), 0.0) / np.diff(self.nodes)
        most = 3.0 * np.minimum(np.append(rise, rise[-1]), np.append(rise[0], rise))
        return np.asarray(np.minimum(self.density, most))

    @property
    def _bend(self) -> Floats:
        """How far the curve is from linear between each two nodes: u(1 - u)² is 4/27 at most."""
        step = np.diff(self.nodes)
        off = np.abs([slope * step - np.diff(self.below) for slope in (self._slopes[1:], self._slopes[:-1])])
        return np.asarray(off.sum(axis=0) * 4.0 / 27.0)

    @cached_property
    def curve(self) -> CubicHermiteSpline:
        """The cubic."""
        return CubicHermiteSpline(self.nodes, self.below, self._slopes)

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


def apart(model: Taylor, values: Floats) -> Floats:
    """Bound how far a function is from the quadratic one through its values at `POINTS`.

    It is within a bound of its model, and the quadratic function through what the model is off at the points
    within 5/3 of that, the constant of Lebesgue. The quadratic function through a cubic form is off by
    Σ α_ij x_i x_j (x_i - x_j) + β x_1 x_2 x_3; the products beside α add up to less than 0.118.
    """
    cubic = np.abs(_CUBIC @ model.terms[6:])
    off = np.abs(model.at(POINTS) - values).max(axis=1)
    return np.asarray(model.rest + 0.118 * cubic[:3].max(axis=0) + cubic[3] / 27.0 + 5.0 / 3.0 * off)


_CUBIC = np.concatenate(
    [
        0.5 * monomials(np.roll(np.eye(3), 1, axis=1) - np.eye(3)),
        [3.0, 3.0, 3.0, -12.0, -12.0, -12.0] @ monomials(POINTS)[None],
    ]
)[:, 6:]
"""Of the coefficients of a cubic form, α from its values along the sides, and β from those at the points."""


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


def _summed(nodes: Floats, parts: Floats, weight: Floats) -> tuple[Floats, Floats, Floats]:
    """Return weighted sums of triangular distributions at nodes, and their densities.

    The third result bounds how far the sum is from linear between each two nodes: for each distribution that
    is no more than what it rises there, or a quarter of the interval times the range of its density, or an
    eighth of the square of the interval times the greatest derivative of the density.
    """
    if len(weight) > _BLOCK:
        blocks = (slice(i, i + _BLOCK) for i in range(0, len(weight), _BLOCK))
        sums = zip(*(_summed(nodes, parts[i], weight[i]) for i in blocks), strict=True)
        below, density, rough = (np.sum(one, axis=0) for one in sums)
        return below, density, rough
    step, ends = np.diff(nodes), len(nodes)
    place = np.searchsorted(nodes, parts)  # nodes that are less than each corner
    below = np.cumsum(np.bincount(place[:, 2], weight, ends + 1))[:-1]
    density, rough = np.zeros(ends), np.zeros(ends - 1)
    (a, b, c), corners = parts.T, place.T
    left, right = (np.maximum(side, _NARROWEST) for side in (b - a, c - b))
    peak = 2.0 * weight / np.maximum(c - a, _NARROWEST)
    each = np.stack([a, c, left, right, weight, 0.5 * peak * (b - a), peak])

    def at(node: Ints, rows: NDArray[np.bool_]) -> tuple[Floats, Floats, Floats]:
        """Return distributions at a node of each, and by how much their densities have risen and fallen."""
        a, c, left, right, w, rise, peak = each[:, rows]
        x = nodes[node[rows]]
        up, level = np.clip((x - a) / left, 0.0, 1.0), np.clip((c - x) / right, 0.0, 1.0)
        return rise * up * up + (w - rise) * (1.0 - level * level), peak * up, peak * (1.0 - level)

    for k, (foot, width, sign) in enumerate(((a, left, 1.0), (c, right, -1.0))):
        first, last = corners[k], corners[k + 1] - 1  # nodes on a side; all intervals but those of corners
        rows = first < last
        curve, base = sign * peak[rows] / width[rows], k * weight[rows]
        value, slope, bend = _over_nodes(nodes, first[rows], last[rows], foot[rows], curve, base)
        below, density, rough = below + value, density + slope, rough + 0.125 * step**2 * np.abs(bend[:-1])
        rows = first <= last
        value, up, down = at(last, rows)
        below += np.bincount(last[rows], value, ends)
        density += np.bincount(last[rows], up - down, ends)
    for k, node in enumerate(corners):
        rows = (node > 0) & (node < ends) & np.all(node != corners[:k], axis=0)
        (low, *less), (high, *more) = at(node - 1, rows), at(node, rows)
        here = node[rows] - 1
        range_ = np.maximum(*(y - x for x, y in zip(less, more, strict=True)))
        rough += np.bincount(here, np.minimum(high - low, 0.25 * step[here] * range_), ends - 1)
    return below, density, rough


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
