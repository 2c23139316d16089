"""The number of drops that tell whether the surface or the material makes ε scatter.

``python -m benchmarks.shape_or_material`` prints the table of docs/inference.md, in some two minutes on one
core. Balls of 6 mm with ε_n = 0.93 are dropped from 0.1 m, and 15 impacts of each drop are timed to 20 µs.
"""

from collections import Counter
from typing import Any

import numpy as np
import xarray as xr

import restitution as rs

DIAMETER, ERROR, IMPACTS = 6e-3, 2e-5, 15
LAW = rs.Frictionless(normal=0.93)
BALLS = (
    ("round, scatter 0.003", 0.0, 0.003),
    ("dumbbell, L/R = 0.05", 0.05, 0.0),
    ("round, Ra = 0.74 µm", 0.0, 0.0),
)
DROPS = (1, 5)
REPEATED = 4
CAUSES = ("shape", "roughness", "surface", "material", "both", "neither", "undecided")


def drops(elongation: float, scatter: float, number: int, seed: int) -> list[xr.Dataset]:
    """Drop the same ball several times."""
    ball: rs.RoughSphere | rs.bodies.Body = rs.from_roundness(
        DIAMETER, 0.25 * elongation * DIAMETER, form="dumbbell"
    )
    if elongation == scatter == 0.0:  # Ra is 2/e of the mean height
        ball = rs.RoughSphere(
            radius=DIAMETER / 2.0,
            asperities=100_000,
            asperity_radius=3e-6,
            heights=("exponential", 1e-6),
            seed=seed,
        )
    run = rs.simulate(
        ball,
        rs.Frictionless(normal=rs.Scattered(normal=0.93, deviation=scatter)),
        particles=number,
        impacts=IMPACTS,
        release_height=0.1 + DIAMETER / 2.0 + 2e-5,
        seed=seed,
    )
    times = run.time.values + np.random.default_rng(seed).normal(0.0, ERROR, run.time.shape)
    exact: dict[str, Any] = {"gravity_uncertainty": 0.0, "clock_uncertainty": 0.0}
    return [rs.flight.restitution(one, ERROR, drop_height=0.1, **exact) for one in times]


def row(name: str, elongation: float, scatter: float, number: int) -> str:
    """Count the verdicts on some balls, each dropped so many times."""
    found: Counter[str] = Counter()
    for seed in range(1, REPEATED + 1):
        data = drops(elongation, scatter, number, 1000 * number + seed)
        tree = rs.posterior(data, LAW, diameter=DIAMETER, particles=200, draws=200)
        found[tree.attrs["explained_by"]] += 1
    return f"| {name} | {number} | {' | '.join(str(found[cause]) for cause in CAUSES)} |"


def main() -> None:
    """Print the table."""
    print(f"| ball | drops | {' | '.join(CAUSES)} |")
    print("|---" * (2 + len(CAUSES)) + "|")
    for ball in BALLS:
        for number in DROPS:
            print(row(*ball, number), flush=True)


if __name__ == "__main__":
    main()
