"""Ensemble of particles that a distribution is learned from, simulated block by block."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from restitution import _core
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution._internal.process import uninterrupted
from restitution._internal.resources import check_size, checked_threads
from restitution.distribution._table import Floats
from restitution.drop.release import RandomHeight, RandomSpin
from restitution.drop.run import Run

LEARNING, FRESH = 0, 1
"""Streams of random numbers: what is learned from, and what the learned distribution is held against."""

BATCHES = 32
"""Parts of the ensemble, each with equal shares of all heights, whose scatter gives the standard errors."""
_IMPACTS_PER_ROUND = 4_000_000
_IMPACTS_AT_A_TIME = 100_000
"""As many are in memory, or those of one particle if it has more."""


class Impacts(NamedTuple):
    """The variables of some impacts; shape (particles, impacts), NaN where there was none.

    Particle i belongs to batch i modulo `BATCHES`, and shares impacts with no other.
    """

    velocity: Floats  # impact velocity in m/s
    restitution: Floats
    fraction: Floats  # E_rot/E_tot before the impact; no elements where it is not asked for
    first: int = 0  # number of the particle in the first row


_Part: TypeAlias = tuple[Run, tuple[int, int]]
"""The particles of a run from one number up to, not including, another."""

Look: TypeAlias = Callable[[Impacts], Floats | None]
"""Gives the condition of each impact, in the shape of the block, NaN where it has none; None without one."""


@dataclass(frozen=True)
class Ensemble:
    """Particles that are released from one height, or in equal parts from several.

    Given orientations and spins are dealt out to the heights at random, in another way in each stream, so
    that the fresh ensemble has them all, too, but none of the trajectories that were learned from.
    """

    run: Run  # with the particles and the seed of the whole
    heights: tuple[float | RandomHeight, ...]  # of release, in m
    threads: int | None = None
    fraction: bool = False  # whether E_rot/E_tot is asked for

    def __post_init__(self) -> None:
        spread = len(self.heights) > 1 or isinstance(self.heights[0], RandomHeight)
        if self.run.orientations is not None and not isinstance(self.run.spin, RandomSpin) and not spread:
            text = (
                ": orientations, spins and the height are all given; one of them must be random, or the "
                "fresh impacts that test a distribution are the same as those that it was learned from"
            )
            raise ParameterError(Problem("orientation, spin, release_height", text))
        if self.run.particles < 2 * len(self.heights):
            allowed = f"at least {2 * len(self.heights)}, two for each release height"
            raise ParameterError(wrong("particles", self.run.particles, allowed))

    def rounds(self) -> list[list[tuple[int, int]]]:
        """Return the number of the height and the particles of each run; a round spans the heights."""
        number, heights = self.run.particles * self.run.impacts // _IMPACTS_PER_ROUND + 1, len(self.heights)
        pieces = -(-number // heights)
        share, rest = divmod(self.run.particles, heights)
        runs = []
        for piece in range(pieces):
            for k in range(heights):
                whole, left = divmod(share + (k < rest), pieces)
                runs.append((k, whole + (piece < left)))
        return [[run for run in runs[i::number] if run[1] > 0] for i in range(number)]

    def blocks(
        self,
        stream: int,
        tell: Callable[[int], None] | None = None,
        *,
        share: tuple[float, float] = (0.0, 1.0),
    ) -> Iterator[Impacts]:
        """Simulate and yield some impacts after the other.

        The seed of run k of a round is hashed from seed, stream, round and k. Particles are numbered from
        run to run of a round. A `share` of the particles, from one part to another of every run, has all
        heights among them.
        """
        names = ["impact_velocity", "restitution", *(["rotational_fraction"] if self.fraction else [])]
        most = max(1, _IMPACTS_AT_A_TIME // self.run.impacts)
        rows = min(most, self.run.particles) * self.run.impacts
        check_size("particles * impacts", rows, rows, _core.bytes_per_impact(names), "impacts")
        for runs in self._runs(stream, share[1]):
            first = 0
            for parts in _gathered(runs, share[0], most):
                block = self._simulated(parts, names, first)
                particles = block.velocity.shape[0]
                yield block
                del block  # before the next one is simulated
                if tell is not None:
                    tell(particles)
                first += particles

    def _runs(self, stream: int, share: float) -> Iterator[list[tuple[Run, int]]]:
        """Yield the runs of each round, up to that share, and the particles that the whole runs have."""
        given = self.run.orientations is not None or self.run.spins is not None
        shuffled = np.random.default_rng(np.random.SeedSequence(self.run.seed, spawn_key=(stream,)))
        rows = shuffled.permutation(self.run.particles) if given else None
        begun = 0
        for number, runs in enumerate(self.rounds()):
            found = []
            for k, (height, particles) in enumerate(runs):
                hashed = np.random.SeedSequence(self.run.seed, spawn_key=(stream, number, k))
                seed = int(hashed.generate_state(1, np.uint64)[0])
                some = math.ceil(share * particles)
                changed: dict[str, Any] = {"release_height": self.heights[height], "seed": seed}
                part = self.run if rows is None else self.run.of(rows[begun : begun + some])
                found.append((part.model_copy(update={**changed, "particles": some}), particles))
                begun += particles
            yield found

    def _simulated(self, parts: list[_Part], names: list[str], first: int) -> Impacts:
        """Simulate parts of several runs side by side, whose particles are numbered from `first` on."""
        runs = [(run.parameters(), part) for run, part in parts]
        table = uninterrupted(*_core.simulate_series(runs, checked_threads(self.threads), names))
        columns = [table[name][1] for name in names]
        return Impacts(columns[0], columns[1], columns[2] if self.fraction else np.empty((0, 0)), first)


def _gathered(runs: list[tuple[Run, int]], begin: float, most: int) -> Iterator[list[_Part]]:
    """Gather particles, in each run from that share of the whole run on, as many as `most` at a time."""
    held: list[_Part] = []
    room = most
    for run, particles in runs:
        start = math.ceil(begin * particles)
        while start < run.particles:
            end = min(start + room, run.particles)
            held.append((run, (start, end)))
            room -= end - start
            start = end
            if room == 0:
                yield held
                held, room = [], most
    if held:
        yield held
