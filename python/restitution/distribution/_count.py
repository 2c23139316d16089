"""Impacts counted at the nodes: each is shared among its neighbours as the mixture will weight them."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from restitution import _core
from restitution._internal.process import uninterrupted
from restitution._internal.resources import checked_threads
from restitution.distribution._ensemble import BATCHES, Impacts, Look
from restitution.distribution._table import Floats, Histogram, starts


@dataclass(frozen=True)
class Counted:
    """Counts of all batches together, with nodes and conditions as in `Counter`."""

    nodes: Floats
    conditions: Sequence[Floats]
    histograms: list[Histogram]  # one for each component
    share_errors: list[Floats]  # of the shares of the bins
    below_errors: list[Floats]  # of `Histogram.cumulative`
    impacts: Floats  # weights added up, shape (components,)
    mean_errors: Floats
    std_errors: Floats
    shape_errors: Floats  # of skewness and kurtosis, shape (components, 2)
    seen: Floats  # least and greatest condition next to each node, shape (2, nodes)


class Counter:
    """Counts of the impacts at nodes and conditions, and how they scatter from batch to batch.

    Nodes are speeds in m/s, each with one component for each of its conditions; each component has the inner
    edges of its bins of ε.
    """

    def __init__(self, nodes: Floats, conditions: Sequence[Floats], edges: Sequence[Floats]) -> None:
        self.nodes, self.conditions, self.edges = nodes, conditions, edges
        self.start = starts(inner.size + 1 for inner in edges)
        self._counter = _core.Counter(
            np.ascontiguousarray(nodes),
            starts(group.size for group in conditions),
            np.concatenate(conditions),
            starts(inner.size for inner in edges),
            np.concatenate(edges),
            BATCHES,
        )

    def add_all(self, blocks: Iterable[Impacts], look: Look, threads: int | None = None) -> None:
        """Count the impacts of blocks with the conditions that `look` sees."""
        for block in blocks:
            self.add(block, look(block), threads)
            del block  # before the next one is simulated

    def add(self, block: Impacts, condition: Floats | None = None, threads: int | None = None) -> None:
        """Count the impacts from the first node up to the last that have a restitution, and a condition."""
        number = checked_threads(threads)
        found = self._counter.add(block.velocity, block.restitution, condition, block.first, number)
        uninterrupted(None, found)
        self.__dict__.pop("_table", None)

    @cached_property
    def _table(self) -> dict[str, Floats]:
        """Sums over batches: Σw of each bin; Σw, Σwx and Σwx² of all, with x above an edge in the middle."""
        return self._counter.table()

    def counted(self) -> Counted:
        """Return the results that follow from the counts, which take more memory than all else."""
        histograms, shares, below, shape = zip(*self.histograms(), strict=True)
        mean, deviation = self.moment_errors()
        return Counted(
            self.nodes,
            self.conditions,
            list(histograms),
            list(shares),
            list(below),
            self.impacts(),
            mean,
            deviation,
            np.array(shape),
            self._table["seen"],
        )

    def impacts(self) -> Floats:
        """Return the sum of weights at each component."""
        return np.add.reduceat(self._table["count"].sum(axis=0), self.start[:-1])

    def moment_errors(self) -> tuple[Floats, Floats]:
        """Return standard errors of mean and standard deviation at each component, as in `histograms`."""
        n, first, second = self._table["powers"]
        total, correction = n.sum(axis=0), self._correction()
        mean = first.sum(axis=0) / total
        variance = np.maximum(second.sum(axis=0) / total - mean**2, 0.0)
        # To first order a batch moves the mean by Σw(x - <x>), the variance by Σw((x - <x>)² - σ²).
        moved = (first - mean * n, second - 2.0 * mean * first + (mean**2 - variance) * n)
        errors = [np.sqrt(correction * np.sum(part**2, axis=0)) / total for part in moved]
        spread = variance > 0.0
        return errors[0], np.where(spread, errors[1] / (2.0 * np.sqrt(np.where(spread, variance, 1.0))), 0.0)

    def _correction(self) -> float:
        batches = np.count_nonzero(self._table["count"].any(axis=1))
        return batches / (batches - 1.0) if batches > 1 else np.nan

    def histograms(self) -> Iterator[tuple[Histogram, Floats, Floats, Floats]]:
        """Yield each histogram with the standard errors of bins' shares, of `cumulative`, and of its shape.

        The outermost bins end at the least and the greatest ε that were seen. A batch of particles is one
        draw; for a share p = Σc/Σn the standard error is √(B/(B - 1) Σ(c - pn)²)/Σn over B batches.
        """
        correction = self._correction()
        for component, inner in enumerate(self.edges):
            bins = slice(self.start[component], self.start[component + 1])
            batches = self._table["count"][:, bins]
            count, numbers = batches.sum(axis=0), batches.sum(axis=1, keepdims=True)
            total = count.sum()
            errors = []
            for c in (batches, np.cumsum(batches, axis=1)):
                moved = c - c.sum(axis=0) / total * numbers
                errors.append(np.sqrt(correction * np.sum(moved**2, axis=0)) / total)
            filled = np.flatnonzero(count)
            low, high = int(filled[0]), int(filled[-1]) + 1
            # The greatest may be the very edge that its bin starts at.
            lower = inner[low : high - 1]
            edges = np.concatenate([[self._table["lowest"][component]], lower])
            top = max(self._table["highest"][component], np.nextafter(edges[-1], np.inf))
            edges = np.append(edges, top)
            cumulative = np.concatenate([[0.0], np.minimum(np.cumsum(count)[low:high] / total, 1.0)])
            cumulative[-1] = 1.0
            below = np.concatenate([[0.0], errors[1][low:high]])
            below[-1] = 0.0
            found = Histogram(edges, cumulative)
            moved = batches[:, low:high] @ found.shape_influence().T
            shape = np.sqrt(correction * np.sum(moved**2, axis=0)) / total
            yield found, errors[0][low:high], below, shape
