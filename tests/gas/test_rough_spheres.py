"""Rough spheres beside a Monte Carlo simulation of their own: what is not Maxwellian shifts T_rot/T_tr.

At ε = 0.8 and β = -0.5 the theory of Huthmann and Zippelius (1997) gives 1.447; spins exchange little
there, and those of a few particles stay hot.
"""

from typing import Any

import numpy as np
import pytest

import restitution as rs
from reference.unit import dumbbell

NORMAL, BETA, Q = 0.8, -0.5, 0.4  # Q = 4J/md² of a solid sphere


def ratio(seed: int, particles: int = 20_000) -> float:
    """Mean T_rot/T_tr from 40 to 60 collisions of a particle; m = R = 1."""
    rng = np.random.default_rng(seed)
    u, omega = rng.normal(size=(particles, 3)), rng.normal(size=(particles, 3)) / np.sqrt(Q)
    u -= u.mean(axis=0)
    met, seen = 0.0, []
    while met < 60.0:
        one, two = rng.choice(particles, (2, particles // 6), replace=False)
        k = rng.normal(size=(one.size, 3))
        k /= np.linalg.norm(k, axis=1, keepdims=True)
        v = -np.sum((u[one] - u[two]) * k, axis=1)
        hit = 10.0 * np.sqrt(np.mean(u**2)) * rng.random(v.size) < v
        one, two, k, v = one[hit], two[hit], k[hit], v[hit]
        slip = u[one] - u[two] - np.cross(omega[one] + omega[two], k)
        slip -= np.sum(slip * k, axis=1, keepdims=True) * k
        eta = Q * (1.0 + BETA) / (2.0 * (1.0 + Q))
        impulse = 0.5 * (1.0 + NORMAL) * v[:, np.newaxis] * k - eta * slip
        u[one] += impulse
        u[two] -= impulse
        for side in (one, two):  # both levers are -k and k, and both impulses opposite
            omega[side] -= np.cross(k, impulse) / Q
        met += 2.0 * one.size / particles
        if met > 40.0:
            seen.append(Q * np.mean(omega**2) / np.mean(u**2))
    return float(np.mean(seen))


@pytest.mark.slow
def test_the_ratio_of_temperatures_is_that_of_another_simulation() -> None:
    law: Any = rs.TangentialRestitution(normal=NORMAL, tangential=-BETA)
    others = [ratio(seed) for seed in range(4)]
    expected, error = np.mean(others), np.std(others, ddof=1) / 2.0
    data = rs.gas.cool(
        dumbbell(0.0), law, particles=40_000, collisions=60, translational_temperature=1.0, samples=30
    )
    late = data.isel(time=slice(20, None))
    found = float((late["rotational_temperature"] / late["translational_temperature"]).mean())
    own = float((late["rotational_temperature_error"] / late["translational_temperature"]).mean())
    assert abs(found - expected) < 4 * np.hypot(error, own)
    assert found < 1.35 < rs.gas.theory.steady_ratio(dumbbell(0.0), law)
