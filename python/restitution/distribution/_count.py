"""Impacts counted at the nodes: each is shared among its neighbours as the mixture will weight them."""

from collections.abc import Iterator, Sequence
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from restitution.distribution._ensemble import BATCHES
from restitution.distribution._table import Floats, Histogram, Ints

Chosen: TypeAlias = "slice | npt.NDArray[np.bool_]"


def placed(nodes: Floats, velocity: Floats, *columns: Floats) -> tuple[Ints, npt.NDArray[np.bool_]]:
    """Find between which two neighbouring nodes each impact lies, and whether it counts.

    Those outside the nodes, and those with NaN in any column, do not.
    """
    number = np.searchsorted(nodes, velocity, side="right") - 1
    inside = (number >= 0) & (number < nodes.size - 1)
    for column in columns:
        inside &= np.isfinite(column)
    return number, inside


def intervals(nodes: Floats, velocity: Floats, *columns: Floats) -> Iterator[tuple[int, tuple[Floats, ...]]]:
    """Yield the impacts between each two neighbouring nodes that have any: the interval, weights, columns.

    The weight is that of the upper node.
    """
    number, inside = placed(nodes, velocity, *columns)
    number = number[inside].astype(np.int32)
    order = np.argsort(number, kind="stable")
    sorted_columns = [column[inside][order] for column in (velocity, *columns)]
    ends = np.cumsum(np.bincount(number, minlength=nodes.size - 1))
    for i, end in enumerate(ends):
        start = 0 if i == 0 else int(ends[i - 1])
        if end > start:
            speed, *rest = (column[start:end] for column in sorted_columns)
            yield i, ((speed - nodes[i]) / (nodes[i + 1] - nodes[i]), *rest)


def shares(z: Floats, conditions: Floats) -> Iterator[tuple[int, Chosen, Floats]]:
    """Yield for each condition the impacts that count there, and their weights."""
    if conditions.size == 1:
        yield 0, slice(None), np.ones(1)
        return
    below = np.clip(np.searchsorted(conditions, z, side="right") - 1, 0, conditions.size - 2)
    part = np.clip((z - conditions[below]) / (conditions[below + 1] - conditions[below]), 0.0, 1.0)
    for k in range(conditions.size):
        lower, upper = below == k, below + 1 == k
        chosen = lower | upper
        yield k, chosen, np.where(lower, 1.0 - part, part)[chosen]


class Counter:
    """Counts of the impacts at nodes and conditions, and how they scatter from batch to batch.

    Parameters
    ----------
    nodes : ndarray, shape (nodes,)
        Speeds in m/s.
    conditions : sequence of ndarray, one for each node
        One component each.
    edges : sequence of ndarray, one for each component
        Inner edges of the bins of ε.
    """

    def __init__(self, nodes: Floats, conditions: Sequence[Floats], edges: Sequence[Floats]) -> None:
        self.nodes, self.conditions, self.edges = nodes, conditions, edges
        self.first = np.concatenate([[0], np.cumsum([group.size for group in conditions])])
        self.start = np.concatenate([[0], np.cumsum([inner.size + 1 for inner in edges])])
        size = int(self.start[-1])
        self.count = np.zeros((BATCHES, size))
        self.lowest, self.highest = np.full(len(edges), np.inf), np.full(len(edges), -np.inf)
        self.seen = np.array([np.full(nodes.size, np.inf), np.full(nodes.size, -np.inf)])
        # Σw, Σwx and Σwx², x being ε above one of the edges in the middle.
        self._powers = np.zeros((3, BATCHES, len(edges)))

    def add(self, batch: int, velocity: Floats, restitution: Floats, z: Floats) -> None:
        """Count impacts of a batch, which shares no particle with any other."""
        for i, (weight, epsilon, condition) in intervals(self.nodes, velocity, restitution, z):
            for node, share in ((i, 1.0 - weight), (i + 1, weight)):
                self.seen[0, node] = min(self.seen[0, node], condition.min())
                self.seen[1, node] = max(self.seen[1, node], condition.max())
                for k, chosen, part in shares(condition, self.conditions[node]):
                    component = int(self.first[node]) + k
                    self._add_to(batch, component, epsilon[chosen], share[chosen] * part)

    def _add_to(self, batch: int, component: int, epsilon: Floats, weight: Floats) -> None:
        counted = weight > 0.0
        if not counted.any():
            return
        epsilon, weight = epsilon[counted], weight[counted]
        inner = self.edges[component]
        place = np.searchsorted(inner, epsilon, side="right")
        bins = slice(self.start[component], self.start[component + 1])
        self.count[batch, bins] += np.bincount(place, weights=weight, minlength=inner.size + 1)
        above = epsilon - inner[inner.size // 2]
        self._powers[:, batch, component] += [np.sum(weight * above**power) for power in range(3)]
        self.lowest[component] = min(self.lowest[component], epsilon.min())
        self.highest[component] = max(self.highest[component], epsilon.max())

    def impacts(self) -> Floats:
        """Weights added up at each component."""
        return np.add.reduceat(self.count.sum(axis=0), self.start[:-1])

    def moment_errors(self) -> tuple[Floats, Floats]:
        """Give standard errors of mean and standard deviation at each component, as in `histograms`."""
        n, first, second = self._powers
        total, correction = n.sum(axis=0), self._correction()
        mean = first.sum(axis=0) / total
        variance = np.maximum(second.sum(axis=0) / total - mean**2, 0.0)
        # To first order a batch moves the mean by Σw(x - <x>), the variance by Σw((x - <x>)² - σ²).
        moved = (first - mean * n, second - 2.0 * mean * first + (mean**2 - variance) * n)
        errors = [np.sqrt(correction * np.sum(part**2, axis=0)) / total for part in moved]
        spread = variance > 0.0
        return errors[0], np.where(spread, errors[1] / (2.0 * np.sqrt(np.where(spread, variance, 1.0))), 0.0)

    def _correction(self) -> float:
        batches = np.count_nonzero(self.count.any(axis=1))
        return batches / (batches - 1.0) if batches > 1 else np.nan

    def histograms(self) -> Iterator[tuple[Histogram, Floats, Floats]]:
        """Yield each histogram with the standard errors of the bins' shares and of `cumulative`.

        The outermost bins end at the least and the greatest ε that were seen. A batch of particles is one
        draw; for a share p = Σc/Σn the standard error is √(B/(B - 1) Σ(c - pn)²)/Σn over B batches.
        """
        correction = self._correction()
        for component, inner in enumerate(self.edges):
            bins = slice(self.start[component], self.start[component + 1])
            batches = self.count[:, bins]
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
            edges = np.concatenate([[self.lowest[component]], lower])
            top = max(self.highest[component], np.nextafter(edges[-1], np.inf))
            edges = np.append(edges, top)
            cumulative = np.concatenate([[0.0], np.minimum(np.cumsum(count)[low:high] / total, 1.0)])
            cumulative[-1] = 1.0
            below = np.concatenate([[0.0], errors[1][low:high]])
            below[-1] = 0.0
            yield Histogram(edges, cumulative), errors[0][low:high], below
