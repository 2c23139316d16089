"""The cost of an encounter of two bodies, and of a collision in a gas of them; one thread."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

import restitution as rs
from benchmarks.bodies import Timed, clump, line, measured, spheroid

WARM = 1e-9
"""Temperature in J."""
LEAST = 200
"""Encounters, or particles."""
COLLISIONS = 10.0
"""Of a particle."""


@dataclass(frozen=True)
class Row:
    """What is timed, and the nanoseconds that it may take on one core."""

    name: str
    run: Callable[[int, int], int]
    target: float


def pairs(body: Any, law: Any, encounters: int, seed: int) -> int:
    """Follow encounters, misses among them."""
    rs.pair.encounters(
        body,
        body,
        law,
        encounters=encounters,
        translational_temperature=WARM,
        rotational_temperature=WARM,
        seed=seed,
        threads=1,
    )
    return encounters


def gas(body: Any, law: Any, particles: int, seed: int) -> int:
    """Cool a gas; return its collisions."""
    data = rs.gas.cool(
        body,
        law,
        particles=particles,
        collisions=COLLISIONS,
        translational_temperature=WARM,
        batches=2,
        samples=1,
        seed=seed,
        threads=1,
    )
    return round(float(data["collisions"][-1]) * particles / 2)


def numba_pairs(body: Any, law: Any, encounters: int, seed: int) -> int:
    """Follow the encounters of dumbbells in units of their radius and mass, by a plain loop in Numba."""
    from benchmarks.peers.numba_pairs import run

    radius = body.radii[0]
    inertia = body.transverse_inertia / (body.mass * radius**2)
    run(encounters, 0.5 * body.separation / radius, inertia, law.normal, np.random.default_rng(seed))
    return encounters


def rows() -> list[Row]:
    """Make all rows."""
    ball = rs.Dumbbell(radius=3e-3, separation=0.0)
    dumbbell = rs.Dumbbell(radius=3e-3, separation=3e-3)
    smooth, sticky = rs.Frictionless(normal=0.9), rs.Coulomb(normal=0.9, friction=0.3)
    box = rs.Box(a=4e-3, b=5e-3, c=6e-3)
    return [
        Row("encounters: dumbbells L/R = 1", partial(pairs, dumbbell, smooth), 1000.0),
        Row("encounters: dumbbells L/R = 1, Numba", partial(numba_pairs, dumbbell, smooth), np.inf),
        Row("encounters: dumbbells, Coulomb", partial(pairs, dumbbell, sticky), 2000.0),
        Row("encounters: spheroids 2:1", partial(pairs, spheroid(2.0), smooth), 4000.0),
        Row("encounters: clumps of 4", partial(pairs, clump(4), smooth), 5000.0),
        Row("encounters: boxes", partial(pairs, box, smooth), 50_000.0),
        Row("gas: spheres", partial(gas, ball, smooth), 150.0),
        Row("gas: dumbbells L/R = 1", partial(gas, dumbbell, smooth), 1430.0),
        Row("gas: spheroids 2:1", partial(gas, spheroid(2.0), smooth), 5000.0),
    ]


def table(rounds: int, only: str = "") -> Iterator[str]:
    """Each row over what it may take."""
    for row in rows():
        if only in row.name:
            times = measured([Timed(row.name, row.run)], rounds, least=LEAST)[:, 0]
            yield line(row.name, times, np.asarray(times / row.target), 1.0, at_least=False)
