"""ε of an impact from rest of any rigid body, under every law: the response of the full matrix K.

Per unit mass K = 1 + N with N = [r]ᵀ J⁻¹ [r], r from the centre of mass to the contact, J the principal
moments over m. The contact comes down along the normal n, so that the impulse P per mass and speed gives
ε = P_n - 1. docs/first-impact.md derives what P is:

* "free": P_n = (1 + ε_n)/K_nn;
* "stuck": P_n = (1 + ε_n)/(K_nn - K_nt K_tt⁻¹ K_tn);
* "sliding", beyond the cone of friction of a stuck contact, in a direction s that stays as it begins,
  (μ K_tt + λ) s = K_tn with λ > 0 and |s| = 1: P_n = (1 + ε_n)/(K_nn - μ K_nt s);
* "part", of Chatterjee and Ruina: P = (1 + e) P_I + κ (P_II - P_I) with κ = 1 + e_t, or less, on the cone.

All follow from K_nn, trace and determinant of K_tt, K_nt adj(K_tt) K_tn, |K_tn|² and |adj(K_tt) K_tn|². By
adj K = 1 + tr N - N + c r rᵀ, c = rᵀJr/det J, they are sums of products of the components of r, n and r × n,
The last three are small where r and n are nearly along each other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from restitution.analytic._impulse import Impulse
from restitution.analytic._orientation import Floats

_NEWTON = 60


@dataclass(frozen=True)
class Response:
    """Impulse of a law under the full K, at many contacts side by side."""

    impulse: Impulse
    normal: Floats | float  # ε_n
    moments: Floats
    lever: Sequence[Floats]  # r and, of any length, n, in principal axes
    down: Sequence[Floats]
    arm: Sequence[Floats]  # r × n, which where a ball touches does not depend on its radius

    @cached_property
    def nn(self) -> Floats:
        return 1.0 + dot(self.arm, self._turn) * self._scale

    @cached_property
    def margin(self) -> Floats:
        """Positive where a contact that sticks, or the part of it, would be outside of the friction cone."""
        friction, kept, turned = self.impulse.friction, self.impulse.kept, self._turned**0.5
        if self.impulse.modes()[0] == "stuck":
            return turned / self._minor - friction  # |P_t|/P_n - μ
        return kept * (turned / self._whole - friction * self._more) - friction * self._free

    def restitution(self) -> Floats:
        """Return ε."""
        within, beyond = self.impulse.modes()
        if within == "free":
            return self._free - 1.0
        if within == "stuck":
            found = (1.0 + self.normal) * self._stuck
        else:
            found = self._free + self.impulse.kept * self._more
        if beyond == "sliding":
            slips = self.margin > 0.0
            if slips.any():
                found[slips] = self._beyond(slips)
        return found - 1.0

    def raised(self) -> Floats:
        """Return by how much ε is more than ε_n."""
        return self.restitution() - self.normal

    def _beyond(self, slips: NDArray[np.bool_]) -> Floats:
        """Return P_n where contacts slide."""
        friction = self.impulse.friction
        if self.impulse.modes()[0] == "part":
            free, more, turned, whole = self._rows(slips, self._free, self._more, self._turned, self._whole)
            return free + friction * (free * more) / (turned**0.5 / whole - friction * more)
        trace = 3.0 + self._sums[0] - self.nn  # of K_tt
        across = dot(self._aside[0], self._aside[0]) * self._scale**2.0  # |K_tn|²
        sums = trace, self._minor, across, self._turned, self._mixed
        gain, nn, trace, minor, across, turned, mixed = self._rows(slips, 1.0 + self.normal, self.nn, *sums)
        push = _push_aside(friction, trace, minor, across, turned, mixed)
        drag = friction * mixed + across * push
        below = nn - friction * drag / (friction * (friction * minor + trace * push) + push * push)
        return gain / below

    @staticmethod
    def _rows(rows: NDArray[np.bool_], *values: Floats | float) -> list[Floats]:
        return [np.broadcast_to(x, rows.shape)[rows] for x in values]

    @cached_property
    def _scale(self) -> Floats:
        return 1.0 / dot(self.down, self.down)

    @cached_property
    def _turn(self) -> Sequence[Floats]:
        """J⁻¹ (r × n)."""
        return [a / moment for a, moment in zip(self.arm, self.moments, strict=True)]

    @cached_property
    def _sums(self) -> tuple[Floats, Floats]:
        """Return tr N and c."""
        squares, inverse = [r * r for r in self.lever], 1.0 / self.moments
        trace = dot(squares, inverse.sum() - inverse)
        return trace, dot(squares, inverse.prod() / inverse)

    @cached_property
    def _whole(self) -> Floats:
        """The determinant of K."""
        return self.nn * self._minor - self._mixed

    @cached_property
    def _reach(self) -> tuple[Floats, Floats]:
        """Return r·n and c (r·n)."""
        reach = dot(self.lever, self.down)
        return reach, self._sums[1] * reach

    @cached_property
    def _minor(self) -> Floats:
        """The determinant of K_tt, n·adj(K) n."""
        return 2.0 + self._sums[0] - self.nn + self._reach[0] * self._reach[1] * self._scale

    @cached_property
    def _aside(self) -> tuple[Sequence[Floats], Sequence[Floats]]:
        """Return K_tn and adj(K_tt) K_tn, turned by a right angle and as long as the square of n."""
        aside = cross(self.down, cross(self._turn, self.lever))
        return aside, [x + self._reach[1] * a for x, a in zip(aside, self.arm, strict=True)]

    @cached_property
    def _turned(self) -> Floats:
        """|adj(K_tt) K_tn|²."""
        return dot(self._aside[1], self._aside[1]) * self._scale**2.0

    @cached_property
    def _mixed(self) -> Floats:
        """K_nt adj(K_tt) K_tn."""
        return dot(self._aside[0], self._aside[1]) * self._scale**2.0

    @cached_property
    def _free(self) -> Floats:
        return (1.0 + self.normal) / self.nn

    @cached_property
    def _stuck(self) -> Floats:
        return 1.0 / (self.nn - self._mixed / self._minor)

    @cached_property
    def _more(self) -> Floats:
        return self._stuck * self._mixed / (self._minor * self.nn)


def _push_aside(
    friction: float, trace: Floats, minor: Floats, across: Floats, turned: Floats, mixed: Floats
) -> Floats:
    """Return λ of contacts that slide from rest.

    The length of w = (μ K_tt + λ)⁻¹ K_tn is √N/D, N and D quadratic in λ. D/√N rises with λ > -μ, for the
    eigenvalues of K_tt are 1 at least, and is concave: Newton's steps come to 1 from below. The derivative of
    K_nt w is -w².
    """
    largest = 0.5 * (trace + np.sqrt(np.maximum(trace * trace - 4.0 * minor, 0.0)))
    push = np.maximum(np.sqrt(across) - friction * largest, 0.0)  # a lower bound
    for _ in range(_NEWTON):
        square = friction * (friction * turned + 2.0 * mixed * push) + across * (push * push)
        whole = friction * (friction * minor + trace * push) + push * push
        rise, steep = friction * mixed + across * push, friction * trace + 2.0 * push
        with np.errstate(divide="ignore", invalid="ignore"):
            step = square * (np.sqrt(square) - whole) / (steep * square - rise * whole)
        push, last = push + step, push
        if np.all(np.abs(push - last) <= 1e-15 * (friction * trace + push)):
            break
    return push


def dot(one: Sequence[Floats], two: Sequence[Floats]) -> Floats:
    """Return the scalar product of vectors, by their components."""
    return one[0] * two[0] + one[1] * two[1] + one[2] * two[2]


def cross(one: Sequence[Floats], two: Sequence[Floats]) -> list[Floats]:
    """Return the vector product."""
    return [one[i] * two[j] - one[j] * two[i] for i, j in ((1, 2), (2, 0), (0, 1))]
