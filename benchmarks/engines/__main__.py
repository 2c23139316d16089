"""`python -m benchmarks.engines [ENGINE...]`, in the environment of requirements.txt: docs/performance.md."""

import importlib
import sys

import numpy as np

from benchmarks.engines import problem
from benchmarks.engines.settings import SETTINGS

FIRST, LONG = 0.16, 1.2
"""Seconds that are simulated: up to after the first impact, and for σ(v)."""
BODIES = 96


def main() -> None:
    first = problem.read("first_impacts")
    leaning = problem.leaning(first["angle"])
    spread = problem.leaning((np.random.default_rng(1).permutation(BODIES) + 0.5) * np.pi / BODIES)
    print(
        "| engine | step | stiffness | error of the first ε: median | above 0.02 "
        "| σ over the exact one | ⟨ε⟩ less it |"
    )
    print("|---|---|---|---|---|---|---|")
    wanted = sys.argv[1:] or list(SETTINGS)
    for module, settings in ((name, SETTINGS[name]) for name in wanted):
        try:
            engine = importlib.import_module(f"benchmarks.engines.{module}")
        except (ImportError, OSError) as error:
            print(f"{module}: left out: {error}", flush=True)
            continue
        for step, stiffness in settings:
            median, share = problem.of_first_impacts(
                engine.run(problem.DUMBBELL, leaning, FIRST, step, stiffness), first["restitution"]
            )
            ratio, scatter, shift, number = problem.of_spread(
                engine.run(problem.DUMBBELL, spread, LONG, step, stiffness)
            )
            hard = f"{stiffness:.0e}" if stiffness else "rigid"
            print(
                f"| {engine.NAME} | {step:.2g} s | {hard} | {median:.4f} | {100 * share:.0f} % "
                f"| {ratio:.2f} ± {scatter:.2f} ({number} impacts) | {shift:+.2f} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
