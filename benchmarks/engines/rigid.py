"""The cost of a first impact in engines whose error of ε is below 0.01, beside this; docs/performance.md.

`python -m benchmarks.engines.rigid [ENGINE...]`, where this package and requirements.txt are installed.
"""

import importlib
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from time import process_time
from typing import Any, Protocol

import numpy as np

import restitution as rs
from benchmarks import bodies
from benchmarks.engines import problem, settings
from benchmarks.engines.problem import Floats, Motion, Solid

ATTITUDES = 45
SECONDS = 0.16
"""Simulated, up to after the first impact."""
ALLOWED = 0.01
"""Median error of ε."""
PARTICLES, ROUNDS = 200_000, 5
"""Of `statistics`, and how often costs are measured, in turns."""
LAW = rs.Frictionless(normal=problem.NORMAL)
RELEASE: dict[str, Any] = {"impacts": 1, "release_height": problem.HEIGHT, "gravity": problem.GRAVITY}
EDGES: dict[str, Any] = {
    "velocity_bins": np.linspace(0.0, 1.2, 121),
    "restitution_bins": np.linspace(-1.0, 1.0, 201),
}
Body = rs.Clump | rs.Ellipsoid | rs.Box


class Engine(Protocol):
    """A module of this folder."""

    NAME: str

    def sprung(self, solid: Solid) -> float:
        """Give the mass in the unit of the stiffness, 0 where contacts are rigid."""

    def run(self, solid: Solid, attitudes: Floats, seconds: float, step: float, stiffness: float) -> Motion:
        """Drop bodies."""


def principal(clump: rs.Clump) -> rs.Clump:
    """Give the same body in its principal axes, about its centre of mass."""
    _, axes = np.linalg.eigh(clump.inertia_tensor)
    axes[:, 2] *= np.linalg.det(axes)
    spheres = np.array(clump.spheres)
    spheres[:, :3] = (spheres[:, :3] - clump.centre_of_mass) @ axes
    return rs.Clump(spheres=spheres)


BODIES: dict[str, Body] = {
    "clump of 4": principal(bodies.FOUR),
    "triaxial ellipsoid": bodies.ELLIPSOID,
    "die": bodies.DIE,
}


def solid(body: Body) -> Solid:
    """Give a body in its principal axes as an engine takes it."""
    x, y, z = np.diag(body.inertia_tensor).tolist()
    if isinstance(body, rs.Clump):
        places, sizes = zip(*(((a, b, c), (radius,)) for a, b, c, radius in body.spheres), strict=True)
        return Solid(body.mass, (x, y, z), "sphere", sizes, places)
    if isinstance(body, rs.Ellipsoid):
        return Solid(body.mass, (x, y, z), "ellipsoid", (tuple(body.semi_axes),))
    return Solid(body.mass, (x, y, z), "box", ((body.a / 2, body.b / 2, body.c / 2),))


def attitudes() -> Floats:
    """Give quaternions (w, x, y, z), uniform on the rotations."""
    found = np.random.default_rng(1).normal(size=(ATTITUDES, 4))
    return np.asarray(found / np.linalg.norm(found, axis=1)[:, None])


@dataclass(frozen=True)
class Fall:
    """A body that falls to its first impact: ε for each of the attitudes, and the mean time in s."""

    body: Body
    restitution: Floats
    time: float

    @classmethod
    def exact(cls, body: Body) -> "Fall":
        """Solve it."""
        data = rs.simulate(body, LAW, particles=ATTITUDES, orientation=attitudes(), **RELEASE)
        return cls(body, data["restitution"].values[:, 0], float(data["time"].mean()))

    def own_cost(self, seed: int) -> float:
        """Give the processor time of `statistics` for an impact, in s."""
        start = process_time()
        rs.statistics(self.body, LAW, particles=PARTICLES, threads=1, seed=seed, **EDGES, **RELEASE)
        return (process_time() - start) / PARTICLES

    def run(self, engine: Engine, step: float, stiffness: float) -> tuple[float, float]:
        """Give the median error of ε of an engine, and its processor time for the fall of a body, in s."""
        motion = engine.run(solid(self.body), attitudes(), SECONDS, step, stiffness)
        error, _ = problem.of_first_impacts(motion, self.restitution)
        return error, motion.cost / ATTITUDES * self.time / SECONDS


def tried(engine: Engine, fall: Fall, step: float) -> tuple[float, float, float]:
    """Give the least error with a step, which is returned with it and the stiffness."""
    mass = engine.sprung(solid(fall.body))
    choices = {mass * (np.pi / (number * step)) ** 2 for number in settings.LASTING}
    return min((fall.run(engine, step, stiffness)[0], step, stiffness) for stiffness in choices)


def largest(engine: Engine, fall: Fall, steps: tuple[float, ...]) -> tuple[float, float, float]:
    """Give error, step and stiffness of the largest step with an error that is allowed, else of the least."""
    found = []
    for step in steps:
        found.append(tried(engine, fall, step))
        if found[-1][0] < ALLOWED:
            return found[-1]
    return min(found)


def row(name: str, engine: Engine, fall: Fall, steps: tuple[float, ...]) -> str:
    """Measure a line of the table."""
    error, step, stiffness = largest(engine, fall, steps)
    costs = np.array([(fall.run(engine, step, stiffness)[1], fall.own_cost(turn)) for turn in range(ROUNDS)])
    theirs, own = np.median(costs, axis=0)
    hard = f"{stiffness:.1e}" if stiffness else "rigid"
    return (
        f"| {name} | {engine.NAME} | {step:.2g} s | {hard} | {error:.4f} | {1e6 * theirs:.0f} µs "
        f"| {1e6 * own:.2f} µs | {float(f'{np.median(costs[:, 0] / costs[:, 1]):.2g}'):.0f} |"
    )


def table(names: list[str]) -> Iterator[str]:
    """Measure every body in these engines."""
    for name, body in BODIES.items():
        fall = Fall.exact(body)
        for module in names:
            if solid(body).kind not in settings.SHAPES[module]:
                continue
            try:
                engine: Any = importlib.import_module(f"benchmarks.engines.{module}")
            except (ImportError, OSError) as error:
                yield f"{module}: left out: {error}"
                continue
            longest = settings.LONGEST.get(module, np.inf)
            yield row(name, engine, fall, tuple(step for step in settings.STEPS if step <= longest))


def main() -> None:
    print(
        "| body | engine | step | stiffness | error of the first ε: median | processor time an impact "
        "| `statistics` | ratio |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for line in table(sys.argv[1:] or list(settings.SETTINGS)):
        print(line, flush=True)


if __name__ == "__main__":
    main()
