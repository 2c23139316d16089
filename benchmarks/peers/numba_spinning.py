"""Numba loops for bodies that spin: a spheroid with the paper's law, a dumbbell with Coulomb friction.

One thread. Where the slip turns, friction is integrated in the normal impulse by the classical Runge-Kutta
method, in steps of a quarter of what the slip would need to stop: good to about 1e-8 of the impulse.
"""

from collections.abc import Callable
from math import hypot, sqrt
from typing import Any

import numpy as np

from benchmarks.peers.numba_grid import place
from benchmarks.peers.numba_planar import compiled, inlined
from benchmarks.peers.numba_spatial import (
    Three,
    along,
    contact,
    dot,
    dumbbell_contact,
    spheroid_contact,
    struck,
    turned,
)
from benchmarks.spinning import Released, Spinning
from benchmarks.work import Array, Grid

Friction = tuple[float, float, float]


@inlined
def pull(k: tuple[float, float, float, float], mu: float, su: float, sw: float) -> Friction:
    """d(v_n, s_u, s_w)/dp while the contact slips."""
    inverse = mu / hypot(su, sw)
    du, dw = su * inverse, sw * inverse
    return k[0] - k[3] * du, k[3] - k[1] * du, -k[2] * dw


@compiled
def stronge(
    k: tuple[float, float, float, float], slip: Three, normal: float, mu: float
) -> tuple[float, float, float]:
    """Impulse along n, u and w by Coulomb's law under Stronge's hypothesis."""
    knn, kuu, kww, knu = k
    vn, su, sw = min(slip[0], 0.0), slip[1], slip[2]
    p, work, goal = 0.0, 0.0, 0.0
    small = 1e-12 * (hypot(su, sw) - vn)
    restoring = False
    while True:
        size = hypot(su, sw)
        if size > small:
            dn, du, dw = pull(k, mu, su, sw)
            longest = 0.25 * size / hypot(du, dw)
        else:  # sticks, or starts to slip along u
            su, sw = 0.0, 0.0
            friction = min(max(-knu / kuu, -mu), mu)
            dn, du, dw = knn + knu * friction, knu + kuu * friction, 0.0
            longest = 1e300
        if restoring:
            left = goal - work
            end = 2.0 * left / (vn + sqrt(max(vn * vn + 2.0 * dn * left, 0.0)))
        else:
            end = -vn / dn if dn > 0.0 else 1e300
        h = min(longest, end)
        if size > small:
            n2, u2, w2 = pull(k, mu, su + 0.5 * h * du, sw + 0.5 * h * dw)
            n3, u3, w3 = pull(k, mu, su + 0.5 * h * u2, sw + 0.5 * h * w2)
            n4, u4, w4 = pull(k, mu, su + h * u3, sw + h * w3)
            work += h * (vn + h / 6.0 * (dn + n2 + n3))
            vn += h / 6.0 * (dn + 2.0 * (n2 + n3) + n4)
            su += h / 6.0 * (du + 2.0 * (u2 + u3) + u4)
            sw += h / 6.0 * (dw + 2.0 * (w2 + w3) + w4)
        else:
            work += h * (vn + 0.5 * h * dn)
            vn, su = vn + h * dn, su + h * du
        p += h
        if not restoring and abs(vn) <= 1e-10 * (slip[1] * slip[1] + slip[0] * slip[0]) ** 0.5:
            goal, work, vn, restoring = -normal * normal * work, 0.0, 0.0, True
        elif restoring and abs(goal - work) <= 1e-10 * goal:
            return p, (su - slip[1] - knu * p) / kuu, (sw - slip[2]) / kww


@compiled
def keep_slip(
    k: tuple[float, float, float, float], slip: Three, normal: float, tangential: float
) -> tuple[float, float, float]:
    """Impulse along n, u and w by the paper's law (9)."""
    knn, kuu, kww, knu = k
    jn, ju, jw = -(1.0 + normal) * slip[0], (tangential - 1.0) * slip[1], (tangential - 1.0) * slip[2]
    inverse = 1.0 / (knn * kuu - knu * knu)
    return (kuu * jn - knu * ju) * inverse, (knn * ju - knu * jn) * inverse, jw / kww


Law = Callable[[tuple[float, float, float, float], Three, float, float], tuple[float, float, float]]


def loop(of_balls: bool, law: Law) -> Any:
    """The loop with one body and one law: counts on the lattice, and v and ε of the first impacts."""

    @compiled
    def count(
        first: float,  # radius, or equatorial semi-axis
        second: float,  # L/2, or polar semi-axis
        across: float,  # J_xx over the mass
        axial: float,
        normal: float,
        other: float,  # ε_t, or μ
        g: float,
        height: float,
        axes: Array,
        turns: Array,
        impacts: int,
        per_velocity: float,
        low: float,
        per_restitution: float,
        counts: Any,
        kept: Array,
    ) -> None:
        rows, columns = counts.shape[0] - 2, counts.shape[1] - 2
        for i in range(axes.shape[0]):
            e = (axes[i, 0], axes[i, 1], axes[i, 2])
            turn = (turns[i, 0], turns[i, 1], turns[i, 2])
            z, v, hit = height, (0.0, 0.0, 0.0), 0
            for number in range(impacts):
                if of_balls:
                    time, hit = dumbbell_contact(first, second, g, z, v[2], e, turn, hit)
                else:
                    time, hit = spheroid_contact(first, second, g, z, v[2], e, turn, hit), 1
                e = turned(e, turn, sqrt(dot(turn, turn)), time)
                e = along((0.0, 0.0, 0.0), 1.5 - 0.5 * dot(e, e), e)
                v = (v[0], v[1], v[2] - g * time)
                if of_balls:
                    reach, round_ = hit * second, first
                    z = round_ - reach * e[2]
                else:
                    z = sqrt(first * first + (second * second - first * first) * e[2] * e[2])
                    reach, round_ = (first * first - second * second) * e[2] / z, first * first / z
                u, r, slip, k = contact(e, v, turn, reach, round_, across, axial)
                pn, pu, pw = law(k, slip, normal, other)
                fall = -v[2]
                v, turn = struck(v, turn, u, r, across, pn, pu, pw)
                if number < kept.shape[1]:
                    kept[i, number, 0], kept[i, number, 1] = fall, v[2] / fall
                row = place(fall, 0.0, per_velocity, rows)
                counts[row, place(v[2] / fall, low, per_restitution, columns)] += 1  # (1)

    return count


def run(job: Spinning, released: Released, count: Any, keep: int = 0) -> tuple[Grid, Array]:
    """The grid, and v and ε of the first `keep` impacts, shape (particle, impact, 2)."""
    lattice = job.work.lattice
    counts = np.zeros((lattice.velocity_bins + 2, lattice.restitution_bins + 2), np.int64)
    kept = np.empty((len(released.spins), keep, 2))
    count(
        *job.outline,
        *job.inertia,
        job.work.normal,
        job.other,
        job.work.gravity,
        job.work.release_height,
        released.axes,
        released.turns(job.inertia),
        job.work.impacts,
        1.0 / lattice.velocity_mesh,
        lattice.restitution_low,
        1.0 / lattice.restitution_mesh,
        counts,
        kept,
    )
    return Grid(counts[1:-1, 1:-1], int(counts.sum())), kept


LOOPS = {"spheroid": loop(False, keep_slip), "dumbbell": loop(True, stronge)}
