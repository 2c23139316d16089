"""`python -m benchmarks.accuracy`: how far learned distributions are from fresh simulations, as a table.

For each body and law p(ε | v) is learned from some 10⁷ impacts, with the defaults of `learn`, and compared
with twice as many impacts of other particles in every interval between two nodes, about one per cent of v.
What a perfect distribution would show is the scatter of the fresh particles, by bootstrap over batches of
them.
"""

import argparse
import warnings
from dataclasses import dataclass

import numpy as np

import restitution as rs
from restitution.bodies import Body
from restitution.distribution._check import Check
from restitution.distribution._ensemble import FRESH, Ensemble
from restitution.drop.run import Run
from restitution.laws import Law

R = 3e-3
FRESH_SEED = 1_000_003


@dataclass(frozen=True)
class Case:
    """A body, a law, and the number of particles that have some 10⁷ impacts at the default speeds."""

    body: Body
    law: Law
    particles: int
    spread: bool = True


CASES = {
    "dumbbell 0.5, ε_n = 0.98": Case(
        rs.Dumbbell(radius=R, separation=0.5 * R), rs.TangentialRestitution(normal=0.98), 50_000
    ),
    "dumbbell 2, ε_n = 0.98": Case(
        rs.Dumbbell(radius=R, separation=2.0 * R), rs.TangentialRestitution(normal=0.98), 50_000
    ),
    "dumbbell 0.5, frictionless, ε_n = 0.9": Case(
        rs.Dumbbell(radius=R, separation=0.5 * R), rs.Frictionless(normal=0.9), 200_000
    ),
    "dumbbell 1, Coulomb 0.3, ε_n = 0.8": Case(
        rs.Dumbbell(radius=R, separation=R), rs.Coulomb(normal=0.8, friction=0.3), 500_000
    ),
    "dumbbell 2, ε_n = 0.4": Case(
        rs.Dumbbell(radius=R, separation=2.0 * R), rs.TangentialRestitution(normal=0.4), 2_500_000
    ),
    "oblate spheroid 1:0.8, Coulomb 0.3, ε_n = 0.9": Case(
        rs.Spheroid(equatorial=R, polar=0.8 * R), rs.Coulomb(normal=0.9, friction=0.3), 200_000
    ),
    "dumbbell 0.1, ε_n = 0.4": Case(
        rs.Dumbbell(radius=R, separation=0.1 * R), rs.TangentialRestitution(normal=0.4), 2_500_000
    ),
    "dumbbell 0.1, ε_n = 0.98": Case(
        rs.Dumbbell(radius=R, separation=0.1 * R), rs.TangentialRestitution(normal=0.98), 50_000
    ),
    "the same, one height": Case(
        rs.Dumbbell(radius=R, separation=0.1 * R), rs.TangentialRestitution(normal=0.98), 50_000, False
    ),
}


def measured(case: Case, scale: float) -> str:
    """Learn as `learn` does by default, compare with fresh particles, and give the cells of a row."""
    particles = round(scale * case.particles)
    height = None if case.spread else 0.06
    dist = rs.FluctuatingRestitution.learn(case.body, case.law, particles=particles, release_height=height)
    chosen = dist.data.attrs
    run = Run(
        body=case.body,
        law=case.law,
        particles=2 * particles,
        impacts=chosen["impacts"],
        minimum_speed=chosen["minimum_speed"],
        seed=FRESH_SEED,
    )
    heights = tuple(np.atleast_1d(chosen["release_height"]).tolist())
    check = Check.of(dist._table, Ensemble(run, heights).blocks(FRESH))
    found, scatter = check.distances(), check.scatter()
    worst = int(np.argmax(found))
    low, high = dist.velocities
    return " | ".join(
        [
            f"{float(dist.data.impacts.sum()) / 1e6:.1f}·10⁶",
            f"{low:.3f} to {high:.3f}",
            f"{dist.data.sizes['node']}",
            f"{np.median(found):.4f} ({np.median(scatter):.4f})",
            f"{found[worst]:.4f} ({scatter[worst]:.4f}) at {float(dist.data.velocity[worst]):.3f}",
            f"{100 * np.mean(found > 0.01):.0f} %",
            f"{float(dist.data.ks_distance.max()):.4f}",
        ]
    )


def table(scale: float = 1.0, rows: int | None = None, only: str = "") -> str:
    """Write the table of docs/theory.md, or its first rows, or those whose name contains `only`."""
    head = "| body, law | impacts | v (m/s) | nodes | median distance | largest, at v | above 0.01 | stated |"
    lines = [head, "|---" * 8 + "|"]
    with warnings.catch_warnings():  # the table shows what the warnings say
        warnings.simplefilter("ignore", rs.DistanceWarning)
        warnings.simplefilter("ignore", rs.EnergyWarning)
        for name, case in list(CASES.items())[:rows]:
            if only in name:
                lines.append(f"| {name} | {measured(case, scale)} |")
    return "\n".join(lines)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scale", type=float, default=1.0, help="times the particles")
    parser.add_argument("--only", default="", help="rows whose name contains this")
    options = parser.parse_args()
    print(table(options.scale, only=options.only))


if __name__ == "__main__":
    main()
