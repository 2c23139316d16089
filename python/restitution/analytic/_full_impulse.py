"""ε of an impact from rest of any rigid body, under every law: the response of the full matrix K.

Per unit mass K = 1 + W Wᵀ, the rows of W being (r × e)/√J for the axes e of the plane and its normal n, r
from the centre of mass to the contact, J the principal moments over m. The contact comes down along the
normal, so that the impulse P per mass and speed gives ε = P_n - 1. docs/first-impact.md derives what P is:

* "free": P_n = (1 + ε_n)/K_nn;
* "stuck": P_n = (1 + ε_n)/(K_nn - K_nt K_tt⁻¹ K_tn);
* "sliding", beyond the cone of friction of a stuck contact, in a direction s that stays as it begins,
  (μ K_tt + λ) s = K_tn with λ > 0 and |s| = 1: P_n = (1 + ε_n)/(K_nn - μ K_nt s);
* "part", of Chatterjee and Ruina: P = (1 + e) P_I + κ (P_II - P_I) with κ = 1 + e_t, or less, on the cone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from restitution.analytic._impulse import Impulse
from restitution.analytic._orientation import Floats

_NEWTON = 60


@dataclass(frozen=True)
class Response:
    """What a law makes of K, at many contacts side by side."""

    impulse: Impulse
    normal: Floats | float  # ε_n
    nn: Floats
    tangential: tuple[Floats, Floats, Floats, Floats, Floats]  # K_xx, K_yy, K_xy, K_nx and K_ny

    @classmethod
    def of(
        cls, impulse: Impulse, normal: Floats | float, moments: Floats, lever: Floats, up: Floats
    ) -> Response:
        """Make K from levers r and normals n in principal axes, shape (contacts, 3)."""
        n, x, y = (np.cross(lever, axis) / np.sqrt(moments) for axis in (up, *_across(up)))
        tangential = 1.0 + _dot(x, x), 1.0 + _dot(y, y), _dot(x, y), _dot(n, x), _dot(n, y)
        return cls(impulse, normal, 1.0 + _dot(n, n), tangential)

    def margin(self) -> Floats:
        """Positive where a contact that sticks, or the part of it, would be outside of the friction cone."""
        stuck, along = self._sticking()
        if self.impulse.modes()[0] == "stuck":
            return along - self.impulse.friction
        kept, more = self.impulse.kept, 1.0 / stuck - 1.0 / self.nn
        return kept * along / stuck - self.impulse.friction * ((1.0 + self.normal) / self.nn + kept * more)

    def restitution(self) -> Floats:
        """Return ε."""
        within, beyond = self.impulse.modes()
        gain, nn = 1.0 + self.normal, self.nn
        if within == "free":
            return gain / nn - 1.0
        stuck, along = self._sticking()
        if beyond == "sliding":
            friction, slips = self.impulse.friction, self.margin() > 0.0
        else:
            friction, slips = 0.0, np.zeros(nn.shape, dtype=bool)
        if within == "part":
            more = 1.0 / stuck - 1.0 / nn
            kept = np.full(nn.shape, self.impulse.kept)
            limit = friction * gain / nn / np.where(slips, along / stuck - friction * more, 1.0)
            return gain / nn + np.where(slips, limit, kept) * more - 1.0
        if slips.any():
            stuck[slips] = nn[slips] - friction * _dragged(friction, *(k[slips] for k in self.tangential))
        return gain / stuck - 1.0

    def _sticking(self) -> tuple[Floats, Floats]:
        """Return K_nn - K_nt K_tt⁻¹ K_tn, and |P_t|/P_n = |K_tt⁻¹ K_tn|."""
        xx, yy, xy, nx, ny = self.tangential
        whole = xx * yy - xy * xy
        x, y = (yy * nx - xy * ny) / whole, (xx * ny - xy * nx) / whole
        return self.nn - nx * x - ny * y, np.hypot(x, y)


def _dragged(friction: float, xx: Floats, yy: Floats, xy: Floats, nx: Floats, ny: Floats) -> Floats:
    """Return K_nt s of a contact that slides from rest.

    |(μ K_tt + λ)⁻¹ K_tn| falls with λ from more than 1 at 0. One over it is concave, so that Newton's steps
    come to 1 from below.
    """
    middle, half = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    turn = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    cosine, sine = np.cos(turn), np.sin(turn)
    first, second = (cosine * nx + sine * ny) ** 2, (cosine * ny - sine * nx) ** 2
    one, two = friction * (middle + half), friction * (middle - half)
    push = np.maximum(np.sqrt(first + second) - one, 0.0)  # a lower bound
    for _ in range(_NEWTON):
        a, b = one + push, two + push
        with np.errstate(divide="ignore", invalid="ignore"):
            square = first / a**2 + second / b**2
            step = square * (np.sqrt(square) - 1.0) / (first / a**3 + second / b**3)
        push, last = push + step, push
        if np.all(np.abs(push - last) <= 1e-15 * (one + push)):
            break
    return first / (one + push) + second / (two + push)


def _across(up: Floats) -> tuple[Floats, Floats]:
    """Return two directions in the plane."""
    least = np.eye(3)[np.argmin(np.abs(up), axis=-1)]
    one = np.cross(up, least)
    one /= np.linalg.norm(one, axis=-1, keepdims=True)
    return one, np.cross(up, one)


def _dot(one: Floats, two: Floats) -> Floats:
    return np.asarray(np.einsum("...i,...i", one, two))
