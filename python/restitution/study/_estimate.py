"""What a study will cost, from a timed pilot."""

import time
from dataclasses import dataclass, replace

import numpy as np

from restitution._internal.arrays import whole
from restitution._internal.parameters import ParameterError, wrong
from restitution.study._point import count, evaluate, point_of, with_template
from restitution.study._study import Study

_POINTS = 8
_ENOUGH = 0.1
"""Seconds of a pilot at one point."""


@dataclass(frozen=True)
class Estimate:
    """The cost of a study.

    Attributes
    ----------
    points, tasks : int
        Points, and the least number of tasks.
    particles : float
        Particles of all points; with `until`, as many as the scatter in the pilot asks for.
    seconds : float
        Time on one thread like those of this machine.
    task_seconds : float
        Time of a task.
    threads : int
        Threads that will share it.
    store : int
        Bytes that the store will take, at most: zeros are compressed.
    most : float
        How many times longer it may take, where particles are added until a standard error is reached.

    Examples
    --------
    >>> import restitution as rs
    >>> study = {
    ...     "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
    ...     "law": rs.TangentialRestitution(normal=0.98),
    ...     "run": {"particles": 32, "impacts": 50},
    ...     "statistics": {"velocity_bins": {"from": 0.0, "to": 1.1, "bins": 11},
    ...                    "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 40}},
    ...     "sweep": {"law.normal": [0.9, 0.98]},
    ... }
    >>> cost = rs.study.estimate(rs.study.study_of(study), threads=2)
    >>> cost.points, cost.particles, cost.seconds > 0
    (2, 64.0, True)
    """

    points: int
    tasks: int
    particles: float
    seconds: float
    task_seconds: float
    threads: int
    store: int
    most: float

    def __str__(self) -> str:
        lines = [
            f"{self.points} points, {self.tasks} tasks of about {duration(self.task_seconds)}, "
            f"{self.particles:.3g} particles",
            f"estimated time: {duration(self.seconds)} on one thread, "
            f"{duration(self.seconds / self.threads)} on {self.threads}; "
            f"store below {self.store / 1e6:.3g} MB",
        ]
        if self.most > 1:
            lines.append(
                f"particles are added until the standard error is reached: {self.most:.3g} times that at most"
            )
        return "\n".join(lines)


def estimate(study: Study, threads: int, points: int | None = None) -> Estimate:
    """Time a few particles at a few points, spread over the design.

    Parameters
    ----------
    study : Study
        The study.
    threads : int
        Threads that will share the work.
    points : int, optional
        Points that will be computed, if not all.

    Examples
    --------
    >>> import restitution as rs
    >>> study = {
    ...     "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
    ...     "law": rs.TangentialRestitution(normal=0.98),
    ...     "run": {"particles": 32, "impacts": 50},
    ...     "statistics": {"velocity_bins": {"from": 0.0, "to": 1.1, "bins": 11},
    ...                    "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 40}},
    ...     "sweep": {"law.normal": [0.9, 0.98]},
    ... }
    >>> rs.study.estimate(rs.study.study_of(study), threads=2).points
    2
    """
    if not isinstance(study, Study):
        raise ParameterError(wrong("study", study, "a Study, as from study_of"))
    threads = whole("threads", threads, 1)
    points = study.design.points if points is None else whole("points", points, 0, study.design.points)
    chosen = np.unique(np.linspace(0, study.design.points - 1, min(_POINTS, study.design.points)).astype(int))
    costs, amounts, words = [], [], 0
    _pilot(study, 0)  # the first one loads what all need
    for number in chosen:
        cost, amount, words = _pilot(study, int(number))
        costs.append(cost)
        amounts.append(amount)
    effort = study.effort
    particles = points * float(np.mean(amounts))
    blocks = float(np.mean(amounts)) / effort.particles
    return Estimate(
        points=points,
        tasks=points * effort.block_tasks,
        particles=particles,
        seconds=points * float(np.mean(np.array(costs) * np.array(amounts))),
        task_seconds=float(np.mean(costs)) * effort.particles / effort.block_tasks,
        threads=threads,
        store=int(points * blocks * effort.batches * words * 8),
        most=effort.blocks / max(1.0, blocks),
    )


def _pilot(study: Study, number: int) -> tuple[float, float, int]:
    """Give seconds a particle, particles that the point will need, and words of a batch."""
    point = with_template(point_of(study, number))
    effort = study.effort
    share = max(1, min(8, effort.particles // effort.batches))
    while True:
        start = time.perf_counter()
        rows = [count(point, (i * share, (i + 1) * share)) for i in range(effort.batches)]
        took = time.perf_counter() - start
        particles = share * effort.batches
        if took >= _ENOUGH or 2 * particles > effort.particles:
            break
        share *= 2
    cost = took / particles
    if not effort.until:
        return cost, effort.particles, rows[0].size
    pilot = replace(point, effort=replace(effort, particles=particles))
    blocks = effort.needed(evaluate(pilot, np.stack(rows)), particles)
    return cost, blocks * effort.particles, rows[0].size


def duration(seconds: float) -> str:
    """Write a time as a person would."""
    for unit, size in (("d", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if seconds >= 2 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds:.2g} s" if seconds < 100 else f"{seconds:.0f} s"
