"""The cost of every body, law and release, beside the equal dumbbell dropped from rest with the paper's law.

The dumbbell has L/R = 0.1, and every row bounces as often as it does. Ratios are taken within a round; a row
is given as many particles as take it about `SECONDS`.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache
from time import perf_counter
from typing import Any

import numpy as np

import restitution as rs
from benchmarks.work import Array, Grid, Work
from restitution.bodies import RigidBody

SECONDS = 0.4
LEAST = 100  # particles
LEAST_LEARNED = 2000  # so that every speed has enough impacts to be learned from
ROUNDS_LEARNED = 3  # they take long
MOST = 200_000
Bodies = rs.Dumbbell | rs.LoadedSphere | rs.Spherocylinder | rs.Spheroid | RigidBody
Laws = rs.TangentialRestitution | rs.Coulomb | rs.Frictionless

WORK = Work()
R = WORK.radius
PAPER = rs.TangentialRestitution(normal=WORK.normal, tangential=WORK.tangential)
DUMBBELL = rs.Dumbbell(radius=R, separation=WORK.separation)
UNEQUAL = rs.Dumbbell(radius=(R, 0.95 * R), separation=WORK.separation)
LONG = rs.Dumbbell(radius=(R, 0.8 * R), separation=R)  # as an equal one it would have L/R = 1
LONG_EQUAL = rs.Dumbbell(radius=R, separation=R)
LOADED = rs.LoadedSphere(radius=R, density=2500.0, load=2e-3, offset=0.5 * R)
CAPSULE = rs.Spherocylinder(radius=R, separation=WORK.separation)
THROWN: dict[str, Any] = {
    "orientation": "isotropic",
    "spin": rs.RandomSpin(rate=(10.0, 90.0)),
    "release_velocity": (0.2, 0.1, 0.0),
    "incline": 0.1,
}
REST: dict[str, Any] = {}


FOUR = rs.Clump(
    spheres=0.5 * R * np.array([(1, 1, 1, 1), (1, -1, -1, 1), (-1, 1, -1, 1.2), (-1, -1, 1, 0.8)])
)
ELLIPSOID = rs.Ellipsoid(semi_axes=(R, 0.8 * R, 0.6 * R))
DIE = rs.Box(R, R, R)
BOX = rs.Box(0.8 * R, R, 1.2 * R)
ROUGH: dict[str, Any] = {"radius": R, "asperity_radius": 1e-3 * R}


def spheroid(aspect: float) -> rs.Spheroid:
    """Of the same equatorial radius as the dumbbell."""
    return rs.Spheroid(equatorial=R, polar=aspect * R)


@dataclass(frozen=True)
class Row:
    """A body under a law, let go somehow; `target` is how many times longer than the dumbbell it may take.

    Where making the body takes long, `body` is the function that does it.
    """

    name: str
    target: float
    body: Bodies | Callable[[], Bodies]
    law: Laws
    release: dict[str, Any]
    learned: bool = False
    bins: dict[str, Array] = field(default_factory=dict)

    def run(self, particles: int, threads: int, seed: int) -> int:
        """Bounce as many particles on this number of threads (0: all); the number of impacts."""
        common: dict[str, Any] = {
            "particles": particles,
            "impacts": WORK.impacts,
            "release_height": 2.0 * R + WORK.release_height,  # high enough for the longest body
            "gravity": WORK.gravity,
            "threads": threads or None,
            "seed": seed,
            **self.release,
        }
        body = self.body() if callable(self.body) else self.body
        if self.learned:
            dist = rs.FluctuatingRestitution.learn(body, self.law, velocities=LEARNED, **common)
            return 2 * particles * WORK.impacts if dist is not None else 0
        lattice = {"velocity_bins": WORK.lattice.velocity, "restitution_bins": WORK.lattice.restitution}
        bins: dict[str, Any] = lattice | self.bins
        return Grid.of(rs.statistics(body, self.law, **bins, **common)).impacts


LEARNED = (0.1, 0.4)  # m/s
# As many bins as the lattice has: of equal ratios from 1 mm/s on; a seventieth as wide at ε_n as at the ends.
LOGARITHMIC = np.geomspace(1e-3, WORK.lattice.velocity[-1], WORK.lattice.velocity.size)
DENSE = WORK.normal + np.sinh(np.linspace(-5.0, 5.0, WORK.lattice.restitution.size)) / np.sinh(5.0)


def coulomb(hypothesis: Any) -> rs.Coulomb:
    return rs.Coulomb(normal=WORK.normal, friction=0.3, hypothesis=hypothesis)


def clump(spheres: int) -> rs.Clump:
    """Spheres of 0.4 R within R, at random places; overlaps count several times."""
    random = np.random.default_rng(1)
    places = random.normal(size=(spheres, 3))
    places *= 0.6 * R * random.uniform(0.5, 1.0, (spheres, 1)) / np.linalg.norm(places, axis=1)[:, None]
    return rs.Clump(spheres=np.column_stack([places, np.full(spheres, 0.4 * R)]), inertia="sum")


@cache
def million() -> rs.RoughSphere:
    """Make one of 51 MB, which takes a second."""
    return rs.RoughSphere(asperities=1_000_000, **ROUGH)


HYPOTHESES = ("stronge", "poisson", "newton")
SMOOTH = rs.Frictionless(normal=WORK.normal)
SPINNING: dict[str, Any] = {"orientation": "isotropic", "spin": rs.RandomSpin(rate=(10.0, 90.0))}
SPUN = Row("equal dumbbell spinning, frictionless", 1.0, DUMBBELL, SMOOTH, SPINNING)
RIGID = tuple(
    Row(f"{name} spinning, frictionless", target, body, SMOOTH, SPINNING)
    for name, target, body in (
        ("clump of 4", 30.0, FOUR),
        ("clump of 16", 45.0, clump(16)),
        ("clump of 1000", 135.0, clump(1000)),
        ("triaxial ellipsoid", 30.0, ELLIPSOID),
        ("superellipsoid", 150.0, rs.Superellipsoid(semi_axes=(R, 0.8 * R, 0.6 * R), exponents=(4, 3))),
        ("die", 30.0, DIE),
        ("rough sphere, 10² asperities", 30.0, rs.RoughSphere(asperities=100, **ROUGH)),
        ("rough sphere, 10⁴ asperities", 100.0, rs.RoughSphere(asperities=10_000, **ROUGH)),
        ("rough sphere, 10⁶ asperities", 300.0, million),
    )
)
YARDSTICK = Row("equal dumbbell at rest", 1.0, DUMBBELL, PAPER, REST)
ROWS = (
    Row("logarithmic bins of velocity", 1.5, DUMBBELL, PAPER, REST, bins={"velocity_bins": LOGARITHMIC}),
    Row(
        "uneven bins of velocity and ε",
        1.5,
        DUMBBELL,
        PAPER,
        REST,
        bins={"velocity_bins": LOGARITHMIC, "restitution_bins": DENSE},
    ),
    Row("unequal pair at rest", 1.3, UNEQUAL, PAPER, REST),
    Row("equal dumbbell, L/R = 1, at rest", 1.3, LONG_EQUAL, PAPER, REST),
    Row("unequal pair, L/R = 1, at rest", 1.3, LONG, PAPER, REST),
    Row("loaded sphere at rest", 1.3, LOADED, PAPER, REST),
    Row("spherocylinder at rest", 1.3, CAPSULE, PAPER, REST),
    *(Row(f"spheroid {aspect:g} at rest", 3.0, spheroid(aspect), PAPER, REST) for aspect in (1.05, 2.0, 0.5)),
    Row("equal dumbbell thrown", 2.5, DUMBBELL, PAPER, THROWN),
    Row("unequal pair thrown", 2.5, UNEQUAL, PAPER, THROWN),
    Row("unequal pair, L/R = 1, thrown", 2.5, LONG, PAPER, THROWN),
    Row("loaded sphere thrown", 2.5, LOADED, PAPER, THROWN),
    Row("spherocylinder thrown", 2.5, CAPSULE, PAPER, THROWN),
    *(
        Row(f"spheroid {aspect:g} thrown", 4.0, spheroid(aspect), PAPER, THROWN)
        for aspect in (1.05, 2.0, 0.5)
    ),
    *(Row(f"Coulomb in the plane, {name}", 1.3, DUMBBELL, coulomb(name), REST) for name in HYPOTHESES),
    *(
        Row(f"Coulomb with turning slip, {name}", 10.0, DUMBBELL, coulomb(name), THROWN)
        for name in HYPOTHESES
    ),
)
LEARN_YARDSTICK = Row("learn, equal dumbbell at rest", 1.0, DUMBBELL, PAPER, REST, learned=True)
LEARN = Row(
    "learn, spinning spheroid, Coulomb",
    6.0,
    spheroid(2.0),
    coulomb("stronge"),
    {"spin": THROWN["spin"]},
    learned=True,
)
# What friction costs: each body over itself without.
FRICTION = tuple(
    (
        Row(f"{name} spinning, without friction", 1.0, body, SMOOTH, SPINNING),
        tuple(
            Row(f"{name} spinning, Coulomb, {law}", target, body, coulomb(law), SPINNING)
            for law in HYPOTHESES
        ),
    )
    for name, target, body in (
        ("triaxial ellipsoid", 2.5, ELLIPSOID),
        ("clump of 4", 3.5, FOUR),
        ("box", 4.0, BOX),
        ("die", 4.0, DIE),
        ("spheroid 0.8", 6.0, spheroid(0.8)),
    )
)

BLOCKS = ((YARDSTICK, ROWS), (SPUN, RIGID), *FRICTION, (LEARN_YARDSTICK, (LEARN,)))
EVERY = tuple(row for first, rows in BLOCKS for row in (first, *rows))


@dataclass(frozen=True)
class Timed:
    """Something to be timed, after a first run that may compile: particles, seed -> impacts."""

    name: str
    run: Callable[[int, int], int]


def particles_for(job: Timed, seconds: float, least: int) -> int:
    """The number of particles that take about that long; the cost of a call besides them must not count."""
    job.run(least, 0)
    particles = least
    while particles < MOST:
        start = perf_counter()
        job.run(particles, 1)
        took = perf_counter() - start
        if took > 0.5 * seconds:
            return min(max(least, math.ceil(particles * seconds / took)), MOST)
        particles *= 4
    return MOST


def measured(jobs: Sequence[Timed], rounds: int, seconds: float = SECONDS, least: int = LEAST) -> Array:
    """Nanoseconds an impact, (round, job); every other round goes through the jobs backwards."""
    sizes = [particles_for(job, seconds, least) for job in jobs]
    times = np.empty((rounds, len(jobs)))
    for turn in range(rounds):
        order = range(len(jobs)) if turn % 2 == 0 else reversed(range(len(jobs)))
        for column in order:
            start = perf_counter()
            number = jobs[column].run(sizes[column], turn)
            times[turn, column] = 1e9 * (perf_counter() - start) / number
    return times


def line(name: str, nanoseconds: Array, ratios: Array, target: float, at_least: bool) -> str:
    """One row: its time, its ratio with the range over the rounds, the target, and whether it is reached."""
    ratio = float(np.median(ratios))
    reached = ratio >= target if at_least else ratio <= target
    return (
        f"{name:<52}{np.median(nanoseconds):>9.4g}{ratio:>9.3g}   ({ratios.min():.3g} to {ratios.max():.3g})"
        f"   {'>=' if at_least else '<='} {target:g}{'' if reached else '   MISSED'}"
    )


HEAD = f"{'':<52}{'ns':>9}{'ratio':>9}"


def timed(row: Row, threads: int = 1) -> Timed:
    return Timed(row.name, lambda particles, seed: row.run(particles, threads, seed))


def table(rounds: int, only: str = "") -> Iterator[str]:
    """Every row over the yardstick, one thread; `only` those whose name contains this."""
    for yardstick, rows in BLOCKS:
        chosen = [row for row in rows if only in row.name]
        if not chosen:
            continue
        jobs = [timed(row) for row in (yardstick, *chosen)]
        if yardstick.learned:
            times = measured(jobs, min(rounds, ROUNDS_LEARNED), least=LEAST_LEARNED)
        else:
            times = measured(jobs, rounds)
        yield f"{yardstick.name:<52}{np.median(times[:, 0]):>9.4g}{1:>9}"
        for column, row in enumerate(chosen, 1):
            ratios = times[:, column] / times[:, 0]
            yield line(row.name, times[:, column], ratios, row.target, at_least=False)


def threads(rounds: int, only: str = "") -> Iterator[str]:
    """Every row with one thread over the same with two."""
    for row in EVERY:
        if only in row.name:
            jobs = [timed(row), timed(row, threads=2)]
            if row.learned:
                times = measured(jobs, min(rounds, ROUNDS_LEARNED), least=LEAST_LEARNED)
            else:
                times = measured(jobs, rounds)
            yield line(row.name, times[:, 1], times[:, 0] / times[:, 1], 1.9, at_least=True)


def loops(rounds: int) -> Iterator[str]:
    """The Numba loops for bodies that spin over `statistics` of the same; each checked first."""
    from benchmarks import agreement
    from benchmarks.peers.numba_spinning import LOOPS, run
    from benchmarks.spinning import JOBS, Released, Spinning

    def pair(job: Spinning) -> list[Timed]:
        def own(particles: int, seed: int) -> int:
            return job.statistics(Released.random(particles, seed)).impacts

        def peer(particles: int, seed: int) -> int:
            return run(job, Released.random(particles, seed), LOOPS[job.name])[0].impacts

        return [Timed(job.name, own), Timed(job.name, peer)]

    for job in JOBS:
        worst = agreement.same_spinning(job, LOOPS[job.name])
        times = measured(pair(job), rounds)
        name = f"Numba loop, spinning {job.name}, {type(job.law).__name__}"
        yield line(name, times[:, 1], times[:, 1] / times[:, 0], 10.0, at_least=True)
        yield f"    the same first impacts to {worst:.2g} of what is allowed"
