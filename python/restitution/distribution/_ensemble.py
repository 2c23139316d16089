"""What a distribution is learned from: an ensemble of particles, simulated block by block."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from restitution._parameters import ParameterError, wrong
from restitution._run import Run
from restitution._simulate import simulate_run
from restitution.distribution._table import Floats

LEARNING, FRESH = 0, 1
"""Streams of random numbers: what is learned from, and what the learned distribution is held against."""

_IMPACTS_PER_BLOCK = 2_000_000
_LEAST_BLOCKS = 20
"""Blocks of particles, if there are as many particles, so that standard errors can be taken from them."""


class Impacts(NamedTuple):
    """What is looked at of the impacts of a block; shape (particles, impacts), NaN where there was none.

    Parameters
    ----------
    velocity : ndarray
        Impact velocity in m/s.
    restitution, fraction : ndarray
        ε and E_rot/E_tot before the impact.
    """

    velocity: Floats
    restitution: Floats
    fraction: Floats


@dataclass(frozen=True)
class Ensemble:
    """Particles that are released alike, or in equal parts from several heights.

    Parameters
    ----------
    run : Run
        With the particles and the seed of the whole.
    heights : tuple of float
        Heights of release, in m.
    threads : int, optional
        For the simulation.
    """

    run: Run
    heights: tuple[float, ...]
    threads: int | None = None

    def __post_init__(self) -> None:
        if self.run.angles is not None:
            allowed = "'uniform-angle' or 'isotropic': a distribution is learned from random orientations"
            raise ParameterError(wrong("orientation", self.run.orientation, allowed))
        if self.run.spins is not None:
            allowed = (
                "None, one for all particles, or a RandomSpin: a distribution is learned from random draws"
            )
            raise ParameterError(wrong("spin", self.run.spin, allowed))
        if self.run.particles < 2 * len(self.heights):
            allowed = f"at least {2 * len(self.heights)}, two for each release height"
            raise ParameterError(wrong("particles", self.run.particles, allowed))

    def parts(self) -> list[list[tuple[float, int]]]:
        """Height and number of particles of each run of each block; every block spans the heights."""
        share, rest = divmod(self.run.particles, len(self.heights))
        least = -(-_LEAST_BLOCKS // len(self.heights))
        rounds: list[list[tuple[float, int]]] = []
        for number, height in enumerate(self.heights):
            left = share + (number < rest)
            largest = max(1, min(-(-left // least), _IMPACTS_PER_BLOCK // self.run.impacts))
            pieces = -(-left // largest)
            rounds.append([(height, left // pieces + (i < left % pieces)) for i in range(pieces)])
        runs = [pieces[i] for i in range(max(map(len, rounds))) for pieces in rounds if i < len(pieces)]
        most = -(-self.run.particles * self.run.impacts // _IMPACTS_PER_BLOCK)
        blocks = min(len(runs), max(_LEAST_BLOCKS, most))
        return [runs[i::blocks] for i in range(blocks)]

    def blocks(self, stream: int, tell: Callable[[int], None] | None = None) -> Iterator[Impacts]:
        """Simulate block after block; run k of a block has a seed hashed from seed, stream, block and k."""
        names = ("impact_velocity", "restitution", "rotational_fraction")
        for block, runs in enumerate(self.parts()):
            found = []
            for k, (height, particles) in enumerate(runs):
                hashed = np.random.SeedSequence(self.run.seed, spawn_key=(stream, block, k))
                seed = int(hashed.generate_state(1, np.uint64)[0])
                changed = {"particles": particles, "release_height": height, "seed": seed}
                data = simulate_run(self.run.model_copy(update=changed), threads=self.threads)
                found.append([data[name].to_numpy() for name in names])
            yield Impacts(*(np.concatenate(column) for column in zip(*found, strict=True)))
            if tell is not None:
                tell(sum(particles for _, particles in runs))
