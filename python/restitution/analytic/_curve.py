"""ε as a function of the angle θ at the first impact, for any body of revolution and any law.

The curve is cut where its formula changes: where the other sphere becomes the lower one, where friction
reaches its limit, where a material has a kink. On each piece it is analytic; at its extremes the pieces are
cut again into branches, on which it rises or falls.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from restitution.analytic._disc import Number, turned
from restitution.analytic._hull import Hull, Outline
from restitution.analytic._impulse import Impulse, Mode
from restitution.analytic._normal import Fall, coefficient, kinks
from restitution.analytic._orientation import Floats
from restitution.analytic._panels import distinct, panels, roots, solve
from restitution.bodies import Body, RoughSphere, Turned
from restitution.laws import Law

_STEP = 1e-150
"""Of the derivative by a complex step, which has no cancellation."""

_NARROW = 1e-9
"""Pieces of fewer rad are left to their neighbours."""


class Branch(NamedTuple):
    """Angles between which ε rises or falls, in rad, and ε at both."""

    low: float
    high: float
    first: float
    last: float
    piece: "Piece"


@dataclass(frozen=True)
class Piece:
    """Part of the curve with one formula, from ``low`` to ``high`` in rad; lengths in units of ``unit``."""

    low: float
    high: float
    hull: Hull
    impulse: Impulse
    unit: float  # in m
    fall: Fall
    among: float  # a speed of the piece in m/s, which determines the formula of a material that holds
    mode: Mode = "stuck"

    def state(self, theta: Number) -> tuple[Number, Number, Number]:
        """Return normal coefficient, height and lever arm."""
        height, arm = self.hull.contact(*turned(theta))
        squared = self.fall.squared_speed(self.unit * height)
        return coefficient(self.impulse.law.normal, squared, self.among), height, arm

    def restitution(self, theta: Number) -> Number:
        """Return ε at θ."""
        state = self.state(theta)
        return state[0] - self.impulse.loss(self.mode, *state)

    def margin(self, theta: Number) -> Number:
        """Positive where friction is at its limit."""
        return self.impulse.margin(*self.state(theta))

    def raised(self, theta: Number) -> Number:
        """Positive where ε > ε_n."""
        return self.impulse.raised(self.mode, *self.state(theta))

    def slope(self, theta: Floats) -> Floats:
        """Return dε/dθ."""
        return np.asarray(np.imag(self.restitution(theta + 1j * _STEP)) / _STEP)


@dataclass(frozen=True)
class Curve:
    """ε as a function of θ from 0 to ``limit``."""

    body: Body | RoughSphere | Turned
    law: Law
    fall: Fall  # without effect on a law with a number for ``normal``

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """Parts with one formula each, ascending."""
        outline = Outline.of(self.body)
        impulse = Impulse(self.law, outline.inertia)
        heights = [self.fall.height(speed) / outline.unit for speed in kinks(self.law.normal)]
        found: list[Piece] = []
        for side in outline.sides:
            cosines = [cosine for height in heights for cosine in side.hull.cosines(height)]
            bends = [float(np.arccos(c)) for c in cosines if -1.0 < c < 1.0]
            for low, high in _between(side.low, side.high, bends):
                height, _ = side.hull.contact(*turned(0.5 * (low + high)))
                among = float(self.fall.squared_speed(outline.unit * height) ** 0.5)
                plain = Piece(low, high, side.hull, impulse, outline.unit, self.fall, among)
                one_mode = len(set(impulse.modes())) == 1
                limits = [] if one_mode else roots(plain.margin, low, high)
                for start, stop in _between(low, high, limits):
                    beyond = bool(plain.margin(0.5 * (start + stop)) > 0.0)
                    found.append(replace(plain, low=start, high=stop, mode=impulse.modes()[beyond]))
        return tuple(found)

    @cached_property
    def limit(self) -> float:
        """The greatest θ: π/2 for bodies that look the same upside down, else π."""
        return self.pieces[-1].high

    @cached_property
    def branches(self) -> tuple[Branch, ...]:
        """List the intervals in which ε rises or falls, ascending in θ."""
        found = []
        for piece in self.pieces:
            turns = roots(piece.restitution, piece.low, piece.high, derivative=True)
            for low, high in _between(piece.low, piece.high, turns):
                ends = piece.restitution(np.array([low, high]))
                found.append(Branch(low, high, float(ends[0]), float(ends[1]), piece))
        return tuple(found)

    @cached_property
    def ends(self) -> list[float]:
        """ε at both ends of all branches, ascending."""
        return sorted(value for branch in self.branches for value in (branch.first, branch.last))

    @cached_property
    def edges(self) -> tuple[Floats, ...]:
        """Edges of the panels of each piece, on which Gauss sums are exact to rounding."""
        return tuple(panels(piece.restitution, piece.low, piece.high) for piece in self.pieces)

    def restitution(self, theta: Floats) -> Floats:
        """Return ε at angles from 0 to ``limit``; nan for nan."""
        inner = [piece.low for piece in self.pieces[1:]]
        number = np.searchsorted(inner, theta, side="right")
        value = np.full(np.shape(theta), np.nan)
        for i, piece in enumerate(self.pieces):
            here = (number == i) & ~np.isnan(theta)
            value[here] = piece.restitution(theta[here])
        return value

    def angle(self, branch: Branch, restitution: Floats) -> Floats:
        """Return θ on a branch that gives ε, or the end of the branch nearest to it; nan for nan."""
        least, most = min(branch.first, branch.last), max(branch.first, branch.last)
        target = np.clip(restitution, least, most)
        inside = (target > least) & (target < most)
        at_first = (target == branch.first) | (branch.first == branch.last)
        theta = np.where(np.isnan(target), np.nan, np.where(at_first, branch.low, branch.high))
        wanted = target[inside]
        if wanted.size:
            theta[inside] = solve(
                lambda t: branch.piece.restitution(t) - wanted,
                np.full_like(wanted, branch.low),
                np.full_like(wanted, branch.high),
            )
        return theta


def _between(low: float, high: float, cuts: list[float]) -> list[tuple[float, float]]:
    """Return the intervals into which the cuts divide one."""
    inner = [cut for cut in distinct(cuts, _NARROW) if low + _NARROW < cut < high - _NARROW]
    return list(pairwise([low, *inner, high]))
