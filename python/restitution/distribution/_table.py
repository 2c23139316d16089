"""The table behind a learned distribution: histograms at nodes, and their mixtures."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from restitution import _core
from restitution._resources import checked_threads

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

_ANY: Floats = np.zeros(1)


@dataclass(frozen=True)
class Histogram:
    """One component: bins of any width and the probability below each edge.

    Parameters
    ----------
    edges, cumulative : ndarray, shape (bins + 1,)
        Strictly increasing; increasing from 0 to 1.
    """

    edges: Floats
    cumulative: Floats


@dataclass(frozen=True)
class Table:
    """Histograms at increasing speeds, at each speed one, or one for each of its conditions.

    Parameters
    ----------
    speeds : ndarray, shape (nodes,)
        In m/s.
    first : ndarray of int, shape (nodes + 1,)
        Where the components of each node start.
    conditions : ndarray, shape (components,)
        Increasing within a node.
    start : ndarray of int, shape (components + 1,)
        Where the edges of each component start.
    edges, cumulative : ndarray, shape (edges,)
        Of all components, one after the other.
    """

    speeds: Floats
    first: Ints
    conditions: Floats
    start: Ints
    edges: Floats
    cumulative: Floats

    @classmethod
    def of(
        cls, speeds: Floats, histograms: Sequence[Histogram], conditions: Sequence[Floats] | None = None
    ) -> "Table":
        """Put histograms, node by node and condition by condition, behind each other."""
        groups = [_ANY for _ in speeds] if conditions is None else conditions
        return cls(
            speeds=speeds,
            first=_starts(len(group) for group in groups),
            conditions=np.concatenate(list(groups)),
            start=_starts(part.edges.size for part in histograms),
            edges=np.concatenate([part.edges for part in histograms]),
            cumulative=np.concatenate([part.cumulative for part in histograms]),
        )

    def __iter__(self) -> Iterator[Histogram]:
        for low, high in zip(self.start[:-1], self.start[1:], strict=True):
            yield Histogram(self.edges[low:high], self.cumulative[low:high])

    @cached_property
    def _core(self) -> dict[str, Any]:
        names = ("speeds", "first", "conditions", "start", "edges", "cumulative")
        return {name: np.ascontiguousarray(getattr(self, name)) for name in names}

    def value(
        self, what: Literal["cdf", "pdf", "ppf"], x: npt.ArrayLike, v: npt.ArrayLike, z: npt.ArrayLike = 0.0
    ) -> Floats:
        """Evaluate at x, v and z, broadcast against each other."""
        values = [np.asarray(value, dtype=np.float64) for value in (x, v, z)]
        shape = np.broadcast_shapes(*(value.shape for value in values))
        points = np.broadcast_to(values[0], shape).ravel()
        found, interrupted = _core.mixture_value(
            self._core, what, points, _flat(values[1], shape), _flat(values[2], shape), 0
        )
        if interrupted:
            raise KeyboardInterrupt
        return found.reshape(shape)

    def draw(
        self, v: Floats, z: Floats, shape: tuple[int, ...], seed: int, threads: int | None = None
    ) -> Floats:
        """Draw as many as `shape` says, at v and z broadcast to it."""
        size = int(np.prod(shape, dtype=np.int64))
        found, interrupted = _core.mixture_draw(
            self._core, _flat(v, shape), _flat(z, shape), size, seed, checked_threads(threads)
        )
        if interrupted:
            raise KeyboardInterrupt
        return found.reshape(shape)

    def weights(self, v: Floats) -> tuple[Ints, Floats]:
        """Give the node below each v and the weight of the one above; beyond the nodes the nearest alone."""
        left = np.clip(np.searchsorted(self.speeds, v, side="right") - 1, 0, self.speeds.size - 2)
        low, high = self.speeds[left], self.speeds[left + 1]
        return left, (np.clip(v, low, high) - low) / (high - low)

    def moments(self, v: Floats, z: Floats) -> tuple[Floats, Floats]:
        """Mean and variance at v and z."""
        centres, spreads = self._moments
        parts: list[tuple[Floats, Floats, Floats]] = []
        left, right_share = self.weights(v)
        for node, share in ((left, 1.0 - right_share), (left + 1, right_share)):
            for component, part in self._chosen(node, z):
                parts.append((share * part, centres[component], spreads[component]))
        mean = np.sum([weight * centre for weight, centre, _ in parts], axis=0)
        variance = np.sum([w * (spread + (centre - mean) ** 2) for w, centre, spread in parts], axis=0)
        return mean, variance

    @cached_property
    def _moments(self) -> tuple[Floats, Floats]:
        """Mean and variance of each component: within a bin the density is constant."""
        mean, variance = np.empty(len(self.conditions)), np.empty(len(self.conditions))
        for i, part in enumerate(self):
            share, centre = np.diff(part.cumulative), 0.5 * (part.edges[:-1] + part.edges[1:])
            mean[i] = share @ centre
            variance[i] = share @ ((centre - mean[i]) ** 2 + np.diff(part.edges) ** 2 / 12.0)
        return mean, variance

    def _chosen(self, node: Ints, z: Floats) -> Iterator[tuple[Ints, Floats]]:
        """Yield the component below z and the one above, each with its weight, at given nodes."""
        first, last = self.first[node], self.first[node + 1] - 1
        node, z = np.broadcast_arrays(node, z)
        below = first + np.zeros_like(node)
        for _ in range(int(np.diff(self.first).max())):
            onward = (below < last - 1) & (self.conditions[np.minimum(below + 1, last)] <= z)
            below = below + onward
        above = np.minimum(below + 1, last)
        gap = self.conditions[above] - self.conditions[below]
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.where(gap > 0, np.clip((z - self.conditions[below]) / gap, 0.0, 1.0), 0.0)
        yield below, 1.0 - share
        yield above, share


def _starts(sizes: Any) -> Ints:
    return np.concatenate([[0], np.cumsum(list(sizes))]).astype(np.int64)


def _flat(values: Floats, shape: tuple[int, ...]) -> Floats:
    """One value for all, or one for each element of `shape`."""
    if values.size == 1:
        return values.ravel()
    return np.broadcast_to(values, shape).ravel()
