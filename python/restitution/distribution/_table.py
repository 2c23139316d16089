"""The table behind a learned distribution: histograms at nodes, and their mixtures."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from restitution import _core
from restitution._internal.process import uninterrupted
from restitution._internal.resources import checked_threads

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

    def moments(self) -> tuple[float, Floats, Floats]:
        """Return the mean, the central moments 1 to 4, and what each bin has of these, shape (4, bins).

        Within a bin the density is constant.
        """
        share, centre = np.diff(self.cumulative), 0.5 * (self.edges[:-1] + self.edges[1:])
        mean = float(share @ centre)
        u, h2 = centre - mean, np.diff(self.edges) ** 2
        powers = (u, u**2 + h2 / 12.0, u**3 + u * h2 / 4.0, u**4 + u**2 * h2 / 2.0 + h2**2 / 80.0)
        return mean, np.array(powers) @ share, np.array(powers)

    def shape_influence(self) -> Floats:
        """Return the change of skewness and kurtosis by one more impact in a bin, times all; shape (2, bins).

        To first order; 0 where there is no spread.
        """
        _, (_, m2, m3, m4), (d, d2, d3, d4) = self.moments()
        if not m2 > 0.0:
            return np.zeros((2, d.size))
        skewness = (d3 - m3 - 3.0 * m2 * d - 1.5 * m3 * (d2 / m2 - 1.0)) / m2**1.5
        kurtosis = (d4 - m4 - 4.0 * m3 * d - 2.0 * m4 * (d2 / m2 - 1.0)) / m2**2
        return np.array([skewness, kurtosis])


@dataclass(frozen=True)
class Table:
    """Histograms at increasing speeds, at each speed one, or one for each of its conditions."""

    speeds: Floats  # in m/s
    first: Ints  # where the components of each node start, shape (nodes + 1,)
    conditions: Floats  # increasing within a node, shape (components,)
    start: Ints  # where the edges of each component start, shape (components + 1,)
    edges: Floats  # of all components, one after the other
    cumulative: Floats

    @classmethod
    def of(
        cls, speeds: Floats, histograms: Sequence[Histogram], conditions: Sequence[Floats] | None = None
    ) -> "Table":
        """Put histograms, node by node and condition by condition, behind each other."""
        groups = [_ANY for _ in speeds] if conditions is None else conditions
        return cls(
            speeds=speeds,
            first=starts(len(group) for group in groups),
            conditions=np.concatenate(list(groups)),
            start=starts(part.edges.size for part in histograms),
            edges=np.concatenate([part.edges for part in histograms]),
            cumulative=np.concatenate([part.cumulative for part in histograms]),
        )

    def __getitem__(self, component: int) -> Histogram:
        here = slice(self.start[component], self.start[component + 1])
        return Histogram(self.edges[here], self.cumulative[here])

    def __iter__(self) -> Iterator[Histogram]:
        return (self[i] for i in range(len(self.conditions)))

    def __getstate__(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def mixture(self) -> _core.Mixture:
        """The table as the core knows it, checked once."""
        return _core.Mixture(*(np.ascontiguousarray(values) for values in self.__getstate__().values()))

    def value(
        self,
        what: Literal["cdf", "pdf", "ppf"],
        x: npt.ArrayLike,
        v: npt.ArrayLike,
        z: npt.ArrayLike = 0.0,
        threads: int | None = None,
    ) -> Floats:
        """Evaluate at x, v and z, broadcast against each other."""
        values = [np.asarray(value, dtype=np.float64) for value in (x, v, z)]
        shape = np.broadcast_shapes(*(value.shape for value in values))
        points = np.broadcast_to(values[0], shape).ravel()
        at = _flat(values[1], shape), _flat(values[2], shape)
        return uninterrupted(*self.mixture.value(what, points, *at, checked_threads(threads))).reshape(shape)

    def draw(
        self, v: Floats, z: Floats, shape: tuple[int, ...], seed: int, threads: int | None = None
    ) -> Floats:
        """Draw as many as `shape` says, at v and z broadcast to it."""
        size = int(np.prod(shape, dtype=np.int64))
        at = _flat(v, shape), _flat(z, shape)
        return uninterrupted(*self.mixture.draw(*at, size, seed, checked_threads(threads))).reshape(shape)

    def weights(self, v: Floats) -> tuple[Ints, Floats]:
        """Return the node below each v and the weight of the one above; beyond the nodes only the nearest."""
        left = np.clip(np.searchsorted(self.speeds, v, side="right") - 1, 0, self.speeds.size - 2)
        low, high = self.speeds[left], self.speeds[left + 1]
        return left, (np.clip(v, low, high) - low) / (high - low)

    def parts(self, v: Floats, z: Floats) -> list[tuple[Floats, Ints]]:
        """Return the components that make up the mixture at v and z, each with its weight."""
        left, right_share = self.weights(v)
        found = []
        for node, share in ((left, 1.0 - right_share), (left + 1, right_share)):
            found += [(share * part, component) for component, part in self._chosen(node, z)]
        return found

    def mean(self, v: Floats, z: Floats) -> Floats:
        """Return the mean at v and z."""
        return np.asarray(sum(weight * self._moments[0][i] for weight, i in self.parts(v, z)))

    def central(self, v: Floats, z: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the second, third and fourth central moment at v and z."""
        mean = self.mean(v, z)
        sums = [np.zeros(mean.shape) for _ in range(3)]
        for weight, i in self.parts(v, z):
            centre, m2, m3, m4 = (moment[i] for moment in self._moments)
            d = centre - mean
            sums[0] += weight * (m2 + d**2)
            sums[1] += weight * (m3 + 3.0 * d * m2 + d**3)
            sums[2] += weight * (m4 + 4.0 * d * m3 + 6.0 * d**2 * m2 + d**4)
        return sums[0], sums[1], sums[2]

    def expectation(
        self, function: Callable[[Floats], Floats], v: Floats, z: Floats, low: float, high: float, order: int
    ) -> Floats:
        """Return the mean of a function that is 0 outside [low, high], exactly for polynomials of this order.

        Gauss's rule on the part of every bin that lies in [low, high].
        """
        points, weights = np.polynomial.legendre.leggauss(order // 2 + 1)
        total: Floats = np.zeros(np.broadcast_shapes(v.shape, z.shape))
        for share, component in self.parts(v, z):
            for i in np.unique(component):
                part = self[int(i)]
                edges = np.clip(part.edges, min(low, part.edges[-1]), max(high, part.edges[0]))
                width = np.diff(edges)
                density = np.diff(part.cumulative) / np.diff(part.edges)
                # Where nothing is left of a bin the function need not have a value.
                values = np.zeros((width.size, points.size))
                left, half = edges[:-1][width > 0.0], 0.5 * width[width > 0.0]
                values[width > 0.0] = function(left[:, None] + half[:, None] * (1.0 + points))
                value = float(np.sum(0.5 * weights * (density * width)[:, None] * values))
                total = total + np.where(component == i, share * value, 0.0)
        return np.where(np.isnan(v + z), np.nan, total)

    def entropy(self, v: float, z: float) -> float:
        """Return the differential entropy of the mixture, of constant density between edges; NaN for NaN."""
        if np.isnan(v + z):
            return np.nan
        components = {int(i) for weight, i in self.parts(np.float64(v), np.float64(z)) if weight > 0.0}  # type: ignore[arg-type]
        edges = np.unique(np.concatenate([self[i].edges for i in components]))
        width = np.diff(edges)
        density = self.value("pdf", edges[:-1] + 0.5 * width, v, z)
        filled = density > 0.0
        return float(-np.sum((density * width * np.log(np.where(filled, density, 1.0)))[filled]))

    @cached_property
    def _moments(self) -> tuple[Floats, Floats, Floats, Floats]:
        """Mean and central moments 2 to 4 of each component."""
        found = [(mean, *central[1:]) for mean, central, _ in (part.moments() for part in self)]
        mean, m2, m3, m4 = np.array(found).T
        return mean, m2, m3, m4

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


def starts(sizes: Iterable[int]) -> Ints:
    """Return the starts of adjoining ranges of these sizes, and the end of the last one."""
    return np.concatenate([[0], np.cumsum(list(sizes))]).astype(np.int64)


def _flat(values: Floats, shape: tuple[int, ...]) -> Floats:
    """Return one value for all, or one for each element of `shape`."""
    if values.size == 1:
        return values.ravel()
    return np.broadcast_to(values, shape).ravel()
