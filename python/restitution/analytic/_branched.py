"""The distribution of ε at the first impact from rest, as a sum over the branches of ε(θ).

The curve ε(θ), of any body of revolution and any law, is cut where its formula changes: where the other
sphere becomes the lower one, where friction reaches its limit, where a material has a kink. On each piece it
is analytic; at its extremes the pieces are cut again into branches, on which it rises or falls.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import quad

from restitution.analytic._disc import Number, turned
from restitution.analytic._frozen import FirstImpact, Values, cosine_of, floats, scalar
from restitution.analytic._hull import Hull, Outline
from restitution.analytic._impulse import Impulse, Mode
from restitution.analytic._normal import Fall, coefficient, kinks
from restitution.analytic._orientation import Floats, Tilt
from restitution.analytic._panels import distinct, nodes, panels, roots, solve
from restitution.bodies import Body, RoughSphere, Turned
from restitution.laws import Law

_NEARLY_VERTICAL = 1e-8  # rad, whose square is rounding
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
    piece: Piece


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


@dataclass(frozen=True)
class BranchedFirstImpact(FirstImpact):
    """Distribution of ε(θ) where ε need not rise with the cosine; make it with `first_impact`.

    ε(θ), its slope and where its formula changes are closed forms. P(ε <= x) is the probability of the angles
    between the roots of ε(θ) = x, one on each branch, found to rounding; the density is the sum of
    p(θ)/|dε/dθ| over them, and infinite at an extreme of ε(θ). Moments are Gauss sums over panels on which a
    bound in the complex plane proves them exact to rounding.
    """

    body: Body | RoughSphere | Turned
    fall: Fall  # without effect on a law with a number for ``normal``

    @cached_property
    def _curve(self) -> Curve:
        return Curve(self.body, self.law, self.fall)

    @cached_property
    def _tilt(self) -> Tilt:
        return Tilt(self.orientation, self._curve.limit)

    def support(self) -> tuple[float, float]:
        return self._curve.ends[0], self._curve.ends[-1]

    def restitution(self, cos_theta: ArrayLike) -> Values:
        cosine = cosine_of(cos_theta)
        theta = np.arccos(np.abs(cosine) if self._curve.limit < np.pi else cosine)
        return scalar(self._curve.restitution(theta))

    def cos_theta(self, restitution: ArrayLike) -> Values:
        value = floats(restitution, "restitution")
        greatest = np.full(value.shape, np.nan)
        for branch in self._curve.branches:
            there = _inside(branch, value)
            cosine = np.abs(np.cos(self._curve.angle(branch, value[there])))
            greatest[there] = np.fmax(greatest[there], cosine)
        return scalar(greatest)

    def _drawn(self, uniform: Floats) -> Values:
        return scalar(self._curve.restitution(self._tilt.quantile(uniform)))

    def _expected(
        self, func: Callable[[float], float], low: float, high: float, options: dict[str, Any]
    ) -> tuple[float, float]:
        ends = np.array([low, high])
        total = part = 0.0
        for branch in self._curve.branches:

            def integrand(theta: float, branch: Branch = branch) -> float:
                value = float(branch.piece.restitution(np.float64(theta)))
                return float(self._tilt.density(theta)) * func(value)

            if ends[0] > max(branch.first, branch.last) or ends[1] < min(branch.first, branch.last):
                continue
            start, stop = np.sort(self._curve.angle(branch, ends))
            total += quad(integrand, start, stop, **options)[0]
            part += self._tilt.between(start, stop)
        return float(total), float(part)

    def entropy(self) -> float:
        """Return the differential entropy, -∫ p ln p dε, to 1e-7."""
        levels = np.unique([*self._curve.ends, *self._curve.restitution(self._tilt.edges)])
        nodes, weights = np.polynomial.legendre.leggauss(128)
        u = 0.5 * (1.0 + nodes)
        # Flat at both ends, where ln p may diverge.
        step = u**4 * (35.0 - 84.0 * u + 70.0 * u**2 - 20.0 * u**3)
        rate = 0.5 * weights * 140.0 * (u * (1.0 - u)) ** 3
        total = 0.0
        for branch in self._curve.branches:
            # Where other branches begin or end at the same ε the density jumps.
            for start, stop in pairwise(np.unique(self._curve.angle(branch, levels))):
                theta = start + (stop - start) * step
                share = (stop - start) * rate * self._tilt.density(theta)
                own = self._branch_density(branch, theta)
                others = self._density(branch.piece.restitution(theta), without=branch)
                # At an extreme, to rounding, both sides have the same density. Where it is 0, so is p ln p.
                density = own + np.where(np.isfinite(others), others, own)
                total -= float(share @ np.log(np.maximum(density, np.finfo(float).tiny)))
        return total

    @property
    def probability_above_normal(self) -> float:
        total = 0.0
        for piece in self._curve.pieces:
            raised = piece.raised
            if np.ndim(raised(np.zeros(1))) == 0:  # the same for every angle
                continue
            cuts = [piece.low, *roots(raised, piece.low, piece.high), piece.high]
            for start, stop in pairwise(cuts):
                if raised(0.5 * (start + stop)) > 0.0:
                    total += self._tilt.between(start, stop)
        return total

    def _density(self, x: Floats, without: Branch | None = None) -> Floats:
        """Return the density at ε = x, of all branches but one."""
        total = np.where(np.isnan(x), np.nan, 0.0)
        for branch in self._curve.branches:
            if branch is without:
                continue
            there = _inside(branch, x, top=self._is_top(branch))
            total[there] += self._branch_density(branch, self._curve.angle(branch, x[there]))
        return total

    def _branch_density(self, branch: Branch, theta: Floats) -> Floats:
        """Return p(θ)/|dε/dθ|."""
        if self.orientation == "isotropic":  # 0/0 where the axis is vertical; the limit is as good as reached
            theta = np.clip(theta, _NEARLY_VERTICAL, np.pi - _NEARLY_VERTICAL)
        with np.errstate(divide="ignore", over="ignore"):
            return self._tilt.density(theta) / np.abs(branch.piece.slope(theta))

    def _probability(self, x: Floats, *, above: bool) -> Floats:
        total = np.zeros(x.shape)
        for branch in self._curve.branches:
            share = self._tilt.below(self._curve.angle(branch, x))
            rising = branch.last > branch.first
            if rising == above:
                total += self._tilt.below(branch.high) - share
            else:
                total += share - self._tilt.below(branch.low)
        low, high = self.support()
        total = np.where(x >= high, 0.0 if above else 1.0, np.clip(total, 0.0, 1.0))
        return np.where(x <= low, 1.0 if above else 0.0, total)

    def _quantile(self, q: Floats, *, above: bool) -> Floats:
        low, high = self.support()
        found = solve(
            lambda x: self._probability(x, above=above) - q, np.full(q.shape, low), np.full(q.shape, high)
        )
        found = np.where(q == 0.0, high if above else low, np.where(q == 1.0, low if above else high, found))
        return np.where(np.isnan(q), np.nan, found)

    def _is_top(self, branch: Branch) -> bool:
        """Test whether no other branch goes on from the upper end."""
        most = max(branch.first, branch.last)
        starts = [min(other.first, other.last) for other in self._curve.branches]
        return not np.any(np.abs(np.array(starts) - most) <= 4.0 * np.finfo(float).eps)

    def _mean_of(self, polynomial: Callable[[Floats], Floats], order: int) -> float:
        total = 0.0
        for piece, edges in zip(self._curve.pieces, self._curve.edges, strict=True):
            inner = self._tilt.edges
            inner = inner[(inner > edges[0]) & (inner < edges[-1])]
            theta, weights = nodes(np.union1d(edges, inner), order)
            total += float((weights * self._tilt.density(theta)) @ polynomial(piece.restitution(theta)))
        return total


def _inside(branch: Branch, x: Floats, *, top: bool = True) -> NDArray[np.bool_]:
    least, most = min(branch.first, branch.last), max(branch.first, branch.last)
    return (x >= least) & ((x <= most) if top else (x < most))


def _between(low: float, high: float, cuts: list[float]) -> list[tuple[float, float]]:
    """Return the intervals into which the cuts divide one."""
    inner = [cut for cut in distinct(cuts, _NARROW) if low + _NARROW < cut < high - _NARROW]
    return list(pairwise([low, *inner, high]))
