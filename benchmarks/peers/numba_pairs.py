"""Encounters of smooth dumbbells in a plain Numba loop, one thread.

Two equal dumbbells without spin about their axes, at T_rot = T_tr = m = 1, come through the sphere that both
reach. Of each two balls the distance is at least n·(y + y't) - Mt²/2, with M = ℓ(ω₁² + ω₂²), ℓ half the
separation, and n their direction now; the next look is at the first time at which this is 2R.
"""

from math import cos, pi, sin, sqrt

import numpy as np

from benchmarks.peers.numba_planar import compiled
from benchmarks.work import Array

NEAR = 1e-12
"""Gap over the radius that counts as a contact."""


@compiled
def _direction(rng: np.random.Generator) -> Array:
    z, around = 2.0 * rng.random() - 1.0, 2.0 * pi * rng.random()
    across = sqrt(1.0 - z * z)
    return np.array([across * cos(around), across * sin(around), z])


@compiled
def _spin(rng: np.random.Generator, axis: Array, size: float) -> Array:
    """Draw ω across the axis, each component normal with this deviation."""
    w = np.array([rng.normal(), rng.normal(), rng.normal()]) * size
    across: Array = w - axis * np.dot(w, axis)
    return across


@compiled
def _turned(axis: Array, spin: Array, time: float) -> Array:
    rate = sqrt(np.dot(spin, spin))
    if rate == 0.0:
        return axis
    return axis * cos(rate * time) + np.cross(spin, axis) * (sin(rate * time) / rate)


@compiled
def _next(x: Array, u: Array, axes: Array, spins: Array, arm: float) -> tuple[float, int, int]:
    """Return the shortest time in which no balls can meet, and those that touch now, if they approach."""
    most = arm * (np.dot(spins[0], spins[0]) + np.dot(spins[1], spins[1]))
    soonest, first, second = np.inf, 0, 0
    for one in (-1, 1):
        for two in (-1, 1):
            y = x + arm * (one * axes[0] - two * axes[1])
            moves = u + arm * (one * np.cross(spins[0], axes[0]) - two * np.cross(spins[1], axes[1]))
            far = sqrt(np.dot(y, y))
            gap, rate = far - 2.0, np.dot(y, moves) / far
            if gap < NEAR:
                if rate < 0.0:
                    return 0.0, one, two
                gap = 0.0
            root = sqrt(rate * rate + 2.0 * most * gap)
            time = (rate + root) / most if rate > 0.0 else 2.0 * gap / (root - rate)
            soonest = min(soonest, time)
    return soonest, first, second


@compiled
def run(encounters: int, arm: float, inertia: float, normal: float, rng: np.random.Generator) -> int:
    """Follow encounters of dumbbells of balls of radius 1; return their contacts."""
    reach = 2.0 * (1.0 + arm)
    contacts = 0
    for _ in range(encounters):
        ahead = _direction(rng)
        other = np.cross(ahead, _direction(rng))
        other /= sqrt(np.dot(other, other))
        # u²/4T has the density x e⁻ˣ.
        speed = sqrt(-4.0 * np.log((1.0 - rng.random()) * (1.0 - rng.random())))
        aside = reach * sqrt(rng.random())
        x = aside * other - sqrt(reach * reach - aside * aside) * ahead
        u = speed * ahead
        axes = np.stack((_direction(rng), _direction(rng)))
        spins = np.stack((_spin(rng, axes[0], inertia**-0.5), _spin(rng, axes[1], inertia**-0.5)))
        while True:
            time, one, two = _next(x, u, axes, spins, arm)
            if one != 0:
                contacts += 1
                y = x + arm * (one * axes[0] - two * axes[1])
                n = y / sqrt(np.dot(y, y))
                moves = u + arm * (one * np.cross(spins[0], axes[0]) - two * np.cross(spins[1], axes[1]))
                first, second = np.cross(arm * one * axes[0], n), np.cross(arm * two * axes[1], n)
                k = 2.0 + (np.dot(first, first) + np.dot(second, second)) / inertia
                impulse = -(1.0 + normal) * np.dot(moves, n) / k
                u = u + 2.0 * impulse * n
                spins[0] += impulse / inertia * first
                spins[1] -= impulse / inertia * second
                continue
            if np.dot(x, x) > reach * reach * (1.0 - 1e-12) and np.dot(x, u) > 0.0:
                break
            time = max(time, 1e-13 * reach / speed)
            x = x + u * time
            for i in range(2):
                axes[i] = _turned(axes[i], spins[i], time)
    return int(contacts)
