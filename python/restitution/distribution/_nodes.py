"""Nodes of a distribution: speeds, conditions at each of them, and edges of bins that follow the data."""

import math
from collections.abc import Iterable, Iterator

import numpy as np

from restitution._internal.parameters import ParameterError, wrong
from restitution.distribution._ensemble import Impacts
from restitution.distribution._table import Floats

POINT = 1e-9
"""Restitutions that differ by less are the same: those of a sphere, apart from rounding."""
LEAST_IMPACTS = 500
"""Fewer impacts than these in an interval between two nodes are refused."""
_LEAST_INTERVALS, _CELLS = 8, 256
_BALANCE = 0.23
_CONDITIONS = 8
_CELL, _GAP = 0.0025, 0.01
"""In ln v: of the cells in which speeds are seen, and the least range without any that is a gap."""


class Density:
    """Density of impacts over a range of speeds, and how many of them are independent.

    Parameters
    ----------
    low, high : float
        Ends of the range, in m/s.
    """

    def __init__(self, low: float, high: float) -> None:
        self.low, self.high = low, high
        self._width = math.log(high / low) / _CELLS
        # Σc and Σc² over particles, c being the impacts of one particle in a cell of ln v.
        self._sums = np.zeros((2, _CELLS))

    def add(self, velocity: Floats) -> None:
        """Count impacts with these velocities in m/s; shape (particles, impacts)."""
        particle, column = np.nonzero((velocity >= self.low) & (velocity < self.high))
        place = np.log(velocity[particle, column] / self.low) / self._width
        cell = np.minimum(place.astype(np.int64), _CELLS - 1)
        which, number = np.unique(particle * _CELLS + cell, return_counts=True)
        for power in (1, 2):
            weights = number**power
            self._sums[power - 1] += np.bincount(which % _CELLS, weights=weights, minlength=_CELLS)

    @property
    def impacts(self) -> int:
        """Number of impacts within the range."""
        return int(self._sums[0].sum())

    def speeds(self, scale: float) -> Floats:
        """Place nodes as close as the number of impacts is worth.

        With h the distance of nodes in ln v and ρ the effective number of impacts per unit of ln v, the
        statistical error of a node's distribution function is at most 0.5/√(1.5 ρ h), and the mixture is off
        by about 0.2 h² F″. Their sum is least at h = 0.23 ρ^(-1/5) for F″ = 20, the largest second derivative
        with respect to ln v that was seen. The whole ensemble is `scale` times larger than what was counted.
        """
        impacts, squares = self._sums
        # Kish's effective number: impacts of one particle in one cell are taken for one and the same.
        kish = impacts**2 / np.maximum(squares, 1.0)  # 0 in empty cells
        widest = math.log(self.high / self.low) / _LEAST_INTERVALS
        with np.errstate(divide="ignore"):
            best = _BALANCE * (scale * kish / self._width) ** -0.2
            needed = 2.0 * LEAST_IMPACTS / (scale * impacts / self._width)
        spacing = np.minimum(np.maximum(best, needed), widest)
        intervals = np.concatenate([[0.0], np.cumsum(self._width / spacing)])
        points = np.linspace(0.0, intervals[-1], max(_LEAST_INTERVALS, math.floor(intervals[-1])) + 1)
        nodes = self.low * np.exp(np.interp(points, intervals, self._width * np.arange(_CELLS + 1)))
        nodes[0], nodes[-1] = self.low, self.high
        return np.asarray(nodes)


class Met:
    """Speeds of a range at which impacts were seen, to a quarter of a per cent.

    Parameters
    ----------
    low, high : float
        Ends of the range, in m/s.
    """

    def __init__(self, low: float, high: float) -> None:
        self._low, self._high = low, high
        self._number = np.zeros(math.ceil(math.log(high / low) / _CELL), dtype=np.int64)

    def watch(self, blocks: Iterable[Impacts]) -> Iterator[Impacts]:
        """Pass impacts on, and take note of their speeds."""
        for block in blocks:
            v = block.velocity
            v = v[(v >= self._low) & (v < self._high)]
            cell = (np.log(v / self._low) / math.log(self._high / self._low) * self._number.size).astype(
                np.int64
            )
            cell = np.minimum(cell, self._number.size - 1)
            self._number += np.bincount(cell, minlength=self._number.size)
            yield block
            del block  # before the next one is simulated

    def gaps(self) -> Floats:
        """Return the ends of ranges of at least 1 % without an impact; shape (gaps, 2), in m/s."""
        empty = np.concatenate([[0], self._number == 0, [0]])
        ends = np.flatnonzero(np.diff(empty)).reshape(-1, 2)
        wide = ends[np.diff(ends, axis=1)[:, 0] * _CELL >= _GAP]
        return np.asarray(self._low * (self._high / self._low) ** (wide / self._number.size))


def conditions(values: Floats) -> Floats:
    """Place nodes in the middle of equally probable parts of the condition's values."""
    levels = (np.arange(_CONDITIONS) + 0.5) / _CONDITIONS
    return np.unique(np.quantile(values, levels))


def bins(restitution: Floats, scale: float, where: str) -> Floats:
    """Place the edges of bins that are equally probable in the middle and halve in probability to the tails.

    Beyond what is in `restitution` the edges go on, twice as far with every step, because the whole ensemble
    reaches farther. Where all restitutions are the same, as those of a sphere, one bin holds them.
    They are the inner edges; the outermost bins are open. The node, named `where` in the error, will have
    `scale` times as many impacts.
    """
    if restitution.size < 2:
        allowed = f"2 or more at {where}: more particles, more impacts of each, or another range"
        raise ParameterError(wrong("impacts of the first particles", restitution.size, allowed))
    reach = 2.0 ** np.arange(1, 20) - 1.0
    least, most = float(restitution.min()), float(restitution.max())
    if most - least < POINT:
        ends = np.array([least, np.nextafter(most, np.inf)])
        return np.unique(np.concatenate([ends, least - POINT * reach, most + POINT * reach]))
    number = int(np.clip(2.0 * (scale * restitution.size) ** (1 / 3), 8, 256))  # Rice's rule
    levels = np.arange(1, number) / number
    tails = 0.5 ** np.arange(1, max(2, int(np.log2(restitution.size / number)))) / number
    inner = np.unique(np.quantile(restitution, np.concatenate([levels, tails, 1.0 - tails])))
    below, above = inner[1] - inner[0], inner[-1] - inner[-2]
    return np.unique(np.concatenate([inner, inner[0] - below * reach, inner[-1] + above * reach]))
