"""The distribution of ε at the first impact from rest of a rigid body of any shape."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.analytic._cells import Balls, Ints, Smooth, Units, clipped, solid_angle, unit
from restitution.analytic._frozen import FirstImpact, Values
from restitution.analytic._full_impulse import Response, dot
from restitution.analytic._impulse import Impulse
from restitution.analytic._normal import Fall
from restitution.analytic._orientation import Floats
from restitution.analytic._triangular import POINTS, Table, Triangles
from restitution.bodies import Ellipsoid, RigidBody, Superellipsoid
from restitution.laws import Material

_AIM = 2e-5
"""Of the error of the distribution function."""
_MOST_TRIANGLES = 64_000
_MOST_PAIRS = 10_000_000
_LEVELS = 4
_HARD = 1e-3  # an error of the distribution function that is worth twice as many
_BINS = 4096
_NARROW = 1e-200
_SMALLEST_STEP = 1e-9  # of a search for an extreme, in rad
_MOST_STEPS = 300
_BLOCK = 1 << 20


@dataclass(frozen=True)
class RigidFirstImpact(FirstImpact):
    """Distribution of ε over the attitudes of a rigid body, all equally likely; make it with `first_impact`.

    ε is a closed form in the direction of the plane as seen from the body. The sphere of these directions is
    divided into triangles, smaller where ε bends, on each of which one ball or vertex touches; there ε is
    taken as linear, so that the distribution is a sum of triangular ones. `cdf_error` estimates, generously,
    how far the distribution function is off, from ε at other points of the triangles; moments come closer.
    `expect` is a sum over the table of the distribution function, whatever accuracy is asked for.

    Examples
    --------
    >>> import restitution as rs
    >>> first = rs.analytic.first_impact(rs.Box(a=1e-2, b=1e-2, c=1e-2), rs.Frictionless(normal=0.5))
    >>> round(first.mean(), 4), first.cdf_error < 3e-4
    (-0.2008, True)
    """

    body: RigidBody
    fall: Fall  # without effect on a law with a number for ``normal``

    @property
    def cdf_error(self) -> float:
        return self._table.error + float(self._cover[1].doubt.sum())

    def _at(self, normal: Floats) -> Floats:
        return self._touching(-normal @ self._axes[1])

    def restitution(self, cos_theta: ArrayLike) -> Values:
        """Raise a ValueError, for the body has no axis: `at` takes the normal."""
        raise ParameterError(wrong("body", self.body, "one with an axis; `at` gives ε for plane normals"))

    def cos_theta(self, restitution: ArrayLike) -> Values:
        """Raise a ValueError, for the body has no axis."""
        raise ParameterError(wrong("body", self.body, "one with an axis"))

    def support(self) -> tuple[float, float]:
        return self._support

    def _density(self, x: Floats) -> Floats:
        return self._table.slope(x)

    def _probability(self, x: Floats, *, above: bool) -> Floats:
        return self._table.probability(x, above=above)

    def _quantile(self, q: Floats, *, above: bool) -> Floats:
        return self._table.quantile(1.0 - q if above else q)

    def entropy(self) -> float:
        """Return the differential entropy, -∫ p ln p dε, to some 1e-3; -inf if one ε has a probability."""
        if self._table.step[1] > 0.0:
            return -np.inf
        x, weights = self._table.weights()
        return -float(np.sum(weights * np.log(np.maximum(self._table.slope(x), np.finfo(float).tiny))))

    @property
    def probability_above_normal(self) -> float:
        if "part" not in self._impulse.modes():
            return 0.0
        above = self._sampled(self._cover[0], raised=True)
        ends = float(above.values.min()), float(above.values.max())
        least = 1e-13  # of rounding
        if ends[1] <= least:
            return 0.0
        return (
            1.0 if ends[0] > least else float(Table.of(above, ends).probability(np.array(least), above=True))
        )

    def _expected(
        self, func: Callable[[float], float], low: float, high: float, options: dict[str, Any]
    ) -> tuple[float, float]:
        x, weights = self._table.weights()
        there = (x >= low) & (x <= high) & (weights > 0.0)
        values = [func(value) for value in x[there].tolist()]
        total, part = float(weights[there] @ np.asarray(values, dtype=float)), float(weights[there].sum())
        place, size = self._table.step
        if size > 0.0 and low <= place <= high:
            total, part = total + size * func(place), part + size
        return total, part

    def _mean_of(self, polynomial: Callable[[Floats], Floats], order: int) -> float:
        return self._cover[1].mean(polynomial)

    @cached_property
    def _size(self) -> float:
        return self.body.compiled.farthest()

    @cached_property
    def _axes(self) -> tuple[Floats, Floats]:
        """Principal moments over mass and square of the size, and the principal axes as columns."""
        moments, axes = np.linalg.eigh(self.body.inertia_tensor / self._size / self.body.mass / self._size)
        return moments, axes

    @cached_property
    def _hull(self) -> Balls:
        """The parts that can touch, in principal axes and units of the size."""
        _, axes = self._axes
        if isinstance(self.body, Ellipsoid | Superellipsoid):
            return Smooth(np.zeros((1, 3)), np.ones(1), self.body, axes)
        balls = np.unique(self.body.compiled.balls(), axis=0)
        centres = (balls[:, :3] - self.body.centre_of_mass) @ axes
        return Balls(centres / self._size, balls[:, 3] / self._size)

    @cached_property
    def _support(self) -> tuple[float, float]:
        _, found = self._cover
        low, high = float(found.values.min()), float(found.values.max())
        return min(low, self._extreme(-1.0)), max(high, self._extreme(1.0))

    @cached_property
    def _table(self) -> Table:
        return Table.of(self._cover[1], self._support)

    @cached_property
    def _cover(self) -> tuple[Units, Triangles]:
        """Divide all directions, and sample ε."""
        if 20 * len(self._hull.radii) > _MOST_PAIRS:
            text = f" has {len(self._hull.radii)} balls: must have at most {_MOST_PAIRS // 20}"
            raise ParameterError(Problem("body", text))
        units = Units.all(self._hull, self._axes[1])
        for _ in range(_LEVELS):
            units = units.split()
        found = self._sampled(units)
        while True:
            worst, error = _coarse(units, found)
            room = _MOST_TRIANGLES * (2 if error > _HARD else 1) - len(found.share)
            order = np.argsort(-worst, kind="stable")
            more = np.cumsum(3 * np.bincount(found.unit, minlength=len(worst))[order])
            marked = np.zeros(len(worst), dtype=bool)
            marked[order[(worst[order] > 0.0) & (more <= room)]] = True
            if not marked.any():
                return units, found
            fine, rest = units.only(marked).split(), units.only(~marked)
            kept, number = ~marked[found.unit], np.cumsum(~marked) - 1
            new = self._sampled(fine)
            old = found.only(kept)._replace(unit=number[found.unit[kept]])
            new = new._replace(unit=new.unit + len(rest.corners))
            units, found = rest.joined(fine), old.joined(new)

    def _sampled(self, units: Units, *, raised: bool = False) -> Triangles:
        """Sample ε, or by how much it is more than ε_n, on all cells."""
        corners, pair, doubt = units.cells()
        if self._impulse.modes()[1] == "sliding":  # ε has a kink where friction reaches its limit
            margin = self._response(list(corners.reshape(-1, 3).T), np.repeat(units.element[pair], 3)).margin
            parts = [clipped(corners, sign * margin.reshape(-1, 3)) for sign in (-1.0, 1.0)]
            corners, rows = (np.concatenate(part) for part in zip(*parts, strict=True))
            pair, doubt = pair[rows], doubt[rows]
        share = solid_angle(corners) / (4.0 * np.pi)
        full = share > 0.0
        corners, pair, share, doubt = corners[full], pair[full], share[full], share[full] * doubt[full]
        points = POINTS @ corners
        element = units.element[pair]
        down, each = list(points.reshape(-1, 3).T), np.repeat(element, len(POINTS))
        values = self._restitution(down, each, raised=raised).reshape(-1, len(POINTS))
        middle = points[:, 3:6]
        middle = np.einsum("tpk,tpk->tp", middle, middle) ** -1.5  # solid angle over area, but for a factor
        middle *= (share / middle.sum(axis=1))[:, None]
        central = np.linalg.norm(self._hull.centres, axis=1) < 1e-12
        alone = central[element] & (not isinstance(self._hull, Smooth))
        return Triangles(units.owner[pair], share, values, middle, alone.astype(float), doubt)

    def _touching(self, down: Floats) -> Floats:
        """Return ε of what touches in directions."""
        step = max(1, _BLOCK // len(self._hull.radii))
        parts = [down[i : i + step] for i in range(0, len(down), step)]
        found = [self._restitution(list(part.T), self._hull.lowest(part)) for part in parts]
        return np.concatenate(found) if found else np.empty(0)

    def _restitution(self, down: Sequence[Floats], element: Ints, *, raised: bool = False) -> Floats:
        """Return ε where an element touches, or by how much it is more than ε_n."""
        response = self._response(down, element)
        return response.raised() if raised else response.restitution()

    def _response(self, down: Sequence[Floats], element: Ints) -> Response:
        """Make the response to directions, as components of any length."""
        lever, arm = self._hull.contact(down, element)
        normal: Floats | float | Material = self.law.normal
        if isinstance(normal, Material):
            height = dot(lever, down) * dot(down, down) ** -0.5 * self._size
            normal = normal(np.sqrt(self.fall.squared_speed(height)))
        return Response(self._impulse, normal, self._axes[0], lever, down, arm)

    @property
    def _impulse(self) -> Impulse:
        return Impulse(self.law, 1.0)  # of which only the modes and the parameters of the law are used

    def _extreme(self, sign: float) -> float:
        """Follow ε from the sample that is greatest or least to the extreme near it."""
        units, found = self._cover
        row = int(np.argmax((sign * found.values).max(axis=1)))
        corners = unit(units.corners[found.unit[row]])
        best, value, step = unit(corners.sum(axis=0)), -np.inf, float(np.ptp(corners, axis=0).max())
        angles, least = 0.25 * np.pi * np.arange(8), 1e-3 * float(np.ptp(found.values))
        for _ in range(_MOST_STEPS):  # along a sharp ridge there would be many
            if step <= _SMALLEST_STEP:
                break
            one = unit(np.cross(best, np.eye(3)[np.argmin(np.abs(best))]))
            ring = np.outer(np.cos(angles), one) + np.outer(np.sin(angles), np.cross(best, one))
            tried = unit(np.concatenate([best[None], best + step * ring]))
            values = sign * self._touching(tried)
            first = int(np.argmax(values))
            if first == 0 or values[first] <= value + least * step * step:  # or it would follow a ridge
                step *= 0.5
            best, value = tried[first], max(value, float(values[first]))
        return sign * value


def _coarse(units: Units, found: Triangles) -> tuple[Floats, float]:
    """Return what is gained by dividing each unit, 0 for most, and how far the distribution may be off."""
    bend, lowest, highest = found.bend, found.values.min(axis=1), found.values.max(axis=1)
    start, width = lowest.min(), max(float(np.ptp(found.values)), _NARROW)
    blur = found.share * bend / np.maximum(highest - lowest + 2.0 * bend, _NARROW)
    ends = lowest - bend, highest + bend
    first, last = (np.clip((end - start) / width * _BINS, 0, _BINS).astype(int) for end in ends)
    last += 1

    def over_bins(weights: Floats) -> Floats:
        ends = _BINS + 2
        return np.cumsum(np.bincount(first, weights, ends) - np.bincount(last, weights, ends))

    error, number = over_bins(blur), over_bins(np.ones_like(blur))
    doubt = np.bincount(found.unit, found.doubt, len(units.corners))
    at = (first + last) // 2
    largest = float(error.max())
    if doubt.sum() > max(0.5 * _AIM, largest):
        gain = np.where(doubt >= doubt.sum() / np.count_nonzero(doubt), doubt, 0.0)
    else:
        rough = (error[at] > max(_AIM, 0.25 * largest)) & (blur * number[at] >= error[at])
        gain = np.bincount(found.unit, blur * rough, len(units.corners))
    crowded = (np.diff(units.first) > 12) & (units.share > 1e-6)
    return np.where(crowded, np.inf, gain), largest
