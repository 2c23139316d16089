"""Part of an ensemble, by which nodes and bins are placed before all of it is counted."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from restitution.distribution._ensemble import LEARNING, Ensemble, Impacts, Look
from restitution.distribution._nodes import Density
from restitution.distribution._table import Floats, Ints

IMPACTS = 2_000_000
"""About as many are looked at, or all of a smaller ensemble."""
_HELD = 2_500_000
"""Most impacts that are kept instead of being simulated again: two numbers each, or three."""
_LARGE = 6_000_000
"""Ensembles of so many keep none: it would save them little, and their tables take the memory."""


@dataclass(frozen=True)
class Pilot:
    """Part of an ensemble with particles from every height of release.

    Where the energy that is lost at an impact hardly varies, each height contributes impacts of its own
    at each node, and bins that were placed without them would hold several times their share.
    """

    ensemble: Ensemble
    share: float  # part of the particles of each run
    scale: float  # how many times larger the whole is
    density: Density  # of the impacts over the range of speeds
    held: list[Impacts]  # those that are kept
    kept: float  # their share

    @classmethod
    def of(cls, ensemble: Ensemble, low: float, high: float) -> "Pilot":
        """Choose the share that has `IMPACTS` between two speeds, if the ensemble has as many."""
        run = ensemble.run
        density, particles = Density(low, high), 0
        held: list[Impacts] = []
        most = _HELD if run.particles * run.impacts <= _LARGE else 0
        before, kept, share = 0.0, 0.0, min(1.0, IMPACTS / (run.particles * run.impacts))
        while True:
            more = []
            for block in ensemble.blocks(LEARNING, share=(before, share)):
                particles += block.velocity.shape[0]
                density.add(block.velocity)
                if particles * run.impacts <= most:
                    more.append(block)
            if particles * run.impacts <= most:
                held, kept = held + more, share
            if share == 1.0 or density.impacts >= IMPACTS / 2:
                return cls(ensemble, share, run.particles / particles, density, held, kept)
            before, share = share, min(1.0, share * IMPACTS / max(density.impacts, 1))

    def blocks(self) -> Iterator[Impacts]:
        """Yield the blocks that are kept, and simulate the rest again."""
        yield from self.held
        if self.kept < self.share:
            yield from self.ensemble.blocks(LEARNING, share=(self.kept, self.share))

    def whole(self, tell: Callable[[int], None], *, last: bool) -> Iterator[Impacts]:
        """Yield all impacts of the ensemble; the `last` time nothing is kept any longer."""
        held = self.held if last else self.held.copy()
        held.reverse()
        while held:
            block = held.pop()
            particles = block.velocity.shape[0]
            yield block
            del block
            tell(particles)
        if self.kept < 1.0:
            yield from self.ensemble.blocks(LEARNING, tell, share=(self.kept, 1.0))


class Sample:
    """Impacts that count between nodes."""

    def __init__(self, blocks: Iterable[Impacts], nodes: Floats, look: Look) -> None:
        self._last = nodes.size - 1
        # One array of all would be copied while it is sorted, and be the most memory that learning takes.
        self._parts = [_by_interval(block, nodes, look(block)) for block in blocks]

    def impacts(self) -> Ints:
        """Count those in each interval between two nodes."""
        return np.asarray(sum(np.diff(ends) for _, _, ends in self._parts))

    def near(self) -> Iterator[tuple[Floats, Floats]]:
        """Yield ε and condition of the impacts in the intervals next to each node."""
        for node in range(self._last + 1):
            first, last = max(node - 1, 0), min(node + 1, self._last)
            near = [(e[ends[first] : ends[last]], z[ends[first] : ends[last]]) for e, z, ends in self._parts]
            restitution, z = (np.concatenate(values) for values in zip(*near, strict=True))
            yield restitution, z


def _by_interval(block: Impacts, nodes: Floats, z: Floats | None) -> tuple[Floats, Floats, Ints]:
    """Return ε and condition of the impacts that count, sorted by interval, and where each interval ends."""
    counted = (block.velocity >= nodes[0]) & (block.velocity < nodes[-1]) & np.isfinite(block.restitution)
    if z is not None:
        counted &= np.isfinite(z)
    number = np.searchsorted(nodes, block.velocity[counted], side="right") - 1
    ends = np.concatenate([[0], np.cumsum(np.bincount(number, minlength=nodes.size - 1))])
    # Numbers of 16 bits are sorted in a fraction of the time.
    order = np.argsort(number.astype(np.uint16) if nodes.size < 1 << 16 else number, kind="stable")
    return block.restitution[counted][order], np.zeros(0) if z is None else z[counted][order], ends
