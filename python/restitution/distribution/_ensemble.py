"""What a distribution is learned from: an ensemble of particles, simulated block by block."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from restitution._parameters import ParameterError, Problem, wrong
from restitution._release import RandomHeight, RandomSpin
from restitution._run import Run
from restitution._simulate import simulate_run
from restitution.distribution._table import Floats

LEARNING, FRESH = 0, 1
"""Streams of random numbers: what is learned from, and what the learned distribution is held against."""

BATCHES = 32
"""Parts of the ensemble, each with equal shares of all heights, whose scatter gives the standard errors."""
_IMPACTS_PER_ROUND = 4_000_000


class Impacts(NamedTuple):
    """The variables of some impacts of a batch; shape (particles, impacts), NaN where there was none.

    Parameters
    ----------
    velocity : ndarray
        Impact velocity in m/s.
    restitution, fraction : ndarray
        ε and E_rot/E_tot before the impact.
    batch : int
        Which one.
    """

    velocity: Floats
    restitution: Floats
    fraction: Floats
    batch: int = 0


@dataclass(frozen=True)
class Ensemble:
    """Particles that are released from one height, or in equal parts from several.

    Given orientations and spins are dealt out to the heights at random, in another way in each stream, so
    that the fresh ensemble has them all, too, but none of the trajectories that were learned from.

    Parameters
    ----------
    run : Run
        With the particles and the seed of the whole.
    heights : tuple of float, or of one RandomHeight
        Heights of release, in m.
    threads : int, optional
        For the simulation.
    """

    run: Run
    heights: tuple[float | RandomHeight, ...]
    threads: int | None = None

    def __post_init__(self) -> None:
        spread = len(self.heights) > 1 or isinstance(self.heights[0], RandomHeight)
        if self.run.angles is not None and not isinstance(self.run.spin, RandomSpin) and not spread:
            text = (
                ": orientations, spins and the height are all given; must be random in one of them, or the "
                "fresh impacts that a distribution is held against are those that it was learned from"
            )
            raise ParameterError(Problem("orientation, spin, release_height", text))
        if self.run.particles < 2 * len(self.heights):
            allowed = f"at least {2 * len(self.heights)}, two for each release height"
            raise ParameterError(wrong("particles", self.run.particles, allowed))

    def rounds(self) -> list[list[tuple[int, int]]]:
        """Give number of the height and particles of each run, round by round; a round spans the heights."""
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
        self, stream: int, tell: Callable[[int], None] | None = None, *, share: float = 1.0
    ) -> Iterator[Impacts]:
        """Simulate and yield what each batch has of a round.

        The seed of run k of a round is hashed from seed, stream, round and k. Particles are dealt out to the
        batches one by one, from run to run going on where the last one stopped. Of a smaller `share` are the
        first particles of every run, so that all heights are among them.
        """
        names = ("impact_velocity", "restitution", "rotational_fraction")
        shuffled = np.random.default_rng(np.random.SeedSequence(self.run.seed, spawn_key=(stream,)))
        rows = shuffled.permutation(self.run.particles)
        begun = 0
        for number, runs in enumerate(self.rounds()):
            dealt: list[list[list[Floats]]] = [[] for _ in range(BATCHES)]
            first = 0
            for k, (height, particles) in enumerate(runs):
                hashed = np.random.SeedSequence(self.run.seed, spawn_key=(stream, number, k))
                seed = int(hashed.generate_state(1, np.uint64)[0])
                some = math.ceil(share * particles)
                part = self.run.of(rows[begun : begun + some])
                begun += particles
                changed = {"release_height": self.heights[height], "seed": seed}
                data = simulate_run(part.model_copy(update=changed), threads=self.threads)
                columns = [data[name].to_numpy() for name in names]
                for row in range(min(BATCHES, some)):
                    batch = dealt[(first + row) % BATCHES]
                    batch.append([column[row::BATCHES] for column in columns])
                first += some
            for i, batch in enumerate(dealt):
                if batch:
                    velocity, restitution, fraction = map(np.concatenate, zip(*batch, strict=True))
                    yield Impacts(velocity, restitution, fraction, i)
            if tell is not None:
                tell(sum(particles for _, particles in runs))
