"""Spheres with asperities that fall and spin: contacts on a grid of times, impulses from linear systems.

Shares nothing with the package. Each impact has a sphere of its own, of radius 1 and mass 1. Only the
asperities of a cap about the lowest point are drawn, binomially many: outside it none can touch, with a
probability that is stated.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

STEPS = 80
REACH = 5.0
"""Radius of the cap in units of 2/√N: none of N asperities lies inside one of REACH with exp(-REACH²)."""


@dataclass(frozen=True)
class Rough:
    """Spheres of radius 1, with N asperities of radius ρ, their heights h or exponential with that mean."""

    asperities: int
    asperity_radius: float
    height: float
    exponential: bool = False
    inertia: float = 0.4


@dataclass(frozen=True)
class Hits:
    """Contacts of many spheres, moving down at speed 1: each a row."""

    arm: Floats  # (n, 3), from the centre to the contact
    spin: Floats  # (n, 3)
    itself: NDArray[np.bool_]  # whether the sphere itself touches


def hits(body: Rough, spin: Floats, seed: int, gravity: float = 0.0) -> Hits:
    """Let one sphere fall for each row of spin (ω_x, ω_y, 0), from where nothing touches, to its contact."""
    rng = np.random.default_rng(seed)
    return Hits(
        *map(np.concatenate, zip(*(_some(body, part, rng, gravity) for part in _parts(spin)), strict=True))
    )


def _parts(spin: Floats) -> list[Floats]:
    return [spin[start : start + 500] for start in range(0, len(spin), 500)]


def _some(body: Rough, spin: Floats, rng: np.random.Generator, gravity: float) -> tuple[Floats, ...]:
    n, top = len(spin), body.height
    if body.exponential:  # sin² a of the contact has the mean 2 h: exp(-12) is left out, as of the heights
        tallest, cap = top * (np.log(body.asperities) + 12.0), np.sqrt(24.0 * top)
        depth = tallest
    else:  # lower than the sphere itself none can touch
        end = np.arccos(np.clip(1.0 - top / (1.0 + top - body.asperity_radius), -1.0, 1.0))
        tallest, cap = top, min(REACH * 2.0 / np.sqrt(body.asperities), 1.05 * end)
        depth = min(top, 0.55 * cap**2)
    duration = 1.001 * depth + 1e-12  # from where the tallest could touch to where something must
    rate = np.hypot(spin[:, 0], spin[:, 1])
    inside = np.minimum(cap + rate * duration, np.pi)
    count = rng.binomial(body.asperities, np.sin(0.5 * inside) ** 2)
    width = max(int(count.max()), 1)
    here = np.arange(width) < count[:, None]
    cosine = 1.0 - 2.0 * np.sin(0.5 * inside[:, None]) ** 2 * rng.random((n, width))
    around = 2.0 * np.pi * rng.random((n, width))
    sine = np.sqrt(1.0 - cosine**2)
    place = np.stack([sine * np.cos(around), sine * np.sin(around), -cosine], axis=-1)
    tops = rng.exponential(top, (n, width)) if body.exponential else np.full((n, width), top)
    radius = 1.0 + tops - body.asperity_radius  # of the centres

    axis = np.where(rate[:, None] > 0.0, spin / np.maximum(rate, 1e-300)[:, None], [1.0, 0.0, 0.0])
    along = np.einsum("ijk,ik->ij", place, axis)
    up, side = place[..., 2], np.cross(axis[:, None], place)[..., 2]  # e_z of p⊥ and of axis × p

    def lowest(time: Floats) -> Floats:
        """Height of each asperity's lowest point when the sphere has fallen so long; (n, width)."""
        turn = rate * time
        centre = 1.0 + tallest - time - 0.5 * gravity * time**2
        rotated = up * np.cos(turn)[:, None] + side * np.sin(turn)[:, None]  # axis is horizontal
        found = centre[:, None] + radius * rotated - body.asperity_radius
        return np.where(here, found, np.inf)

    low, high = np.zeros(n), np.full(n, duration)
    met = np.zeros(n, dtype=bool)
    for step in range(1, STEPS + 1):
        now = np.full(n, duration * step / STEPS)
        below = np.minimum(lowest(now).min(axis=1), tallest - now - 0.5 * gravity * now**2) < 0.0
        first = below & ~met
        low[first], high[first] = duration * (step - 1) / STEPS, now[first]
        met |= below
    for _ in range(40):
        middle = 0.5 * (low + high)
        below = np.minimum(lowest(middle).min(axis=1), tallest - middle - 0.5 * gravity * middle**2) < 0.0
        low, high = np.where(below, low, middle), np.where(below, middle, high)
    heights = lowest(high)
    touching = np.argmin(heights, axis=1)
    rows = np.arange(n)
    itself = (tallest - high - 0.5 * gravity * high**2 < heights[rows, touching]) & met
    assert met.all(), "some sphere met nothing: the cap is too small"
    point, u = place[rows, touching], rate * high
    c, s = np.cos(u)[:, None], np.sin(u)[:, None]
    share = along[rows, touching][:, None] * axis
    turned = share + (point - share) * c + np.cross(axis, point) * s  # Rodrigues
    arm = radius[rows, touching][:, None] * turned - [0.0, 0.0, body.asperity_radius]
    return np.where(itself[:, None], [0.0, 0.0, -1.0], arm), spin, itself


def rebound(body: Rough, met: Hits, normal: float, tangential: float | None) -> tuple[Floats, Floats]:
    """Return ε and the spin after the impact; without friction, or ε_t = ``tangential``; v = (0, 0, -1)."""
    n = len(met.arm)
    velocity = np.array([0.0, 0.0, -1.0]) + np.cross(met.spin, met.arm)
    units = np.eye(3)
    kicked = [unit + np.cross(np.cross(met.arm, unit) / body.inertia, met.arm) for unit in units]
    # (10): change of the contact velocity by a unit impulse along each axis.
    matrix = np.stack(kicked, axis=-1)
    if tangential is None:
        impulse: Floats = np.zeros((n, 3))
        impulse[:, 2] = -(1.0 + normal) * velocity[:, 2] / matrix[:, 2, 2]
    else:
        wanted = np.column_stack([(tangential - 1.0) * velocity[:, :2], -(1.0 + normal) * velocity[:, 2]])
        impulse = np.asarray(np.linalg.solve(matrix, wanted[..., None])[..., 0], dtype=np.float64)
    return impulse[:, 2] - 1.0, met.spin + np.cross(met.arm, impulse) / body.inertia
