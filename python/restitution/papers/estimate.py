"""Estimates from impacts that are correlated within a particle, with the covariance they have."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from restitution.papers.settings import AtSpeeds

Array = NDArray[np.float64]
Index = NDArray[np.intp]


@dataclass(frozen=True)
class Estimate:
    """Quantities estimated together from one run, each particle being one independent draw."""

    value: Array  # (k,)
    covariance: Array  # (k, k), by linearisation
    number: Index  # (k,), impacts that each value rests on

    @property
    def error(self) -> Array:
        """Standard errors, shape (k,)."""
        return np.sqrt(np.diag(self.covariance))

    def take(self, chosen: Sequence[int] | slice) -> "Estimate":
        """Select some of the quantities."""
        return Estimate(self.value[chosen], self.covariance[chosen][:, chosen], self.number[chosen])

    def steps(self) -> Array:
        """Return value[i+1] − value[i] in standard errors of that difference, shape (k−1,)."""
        variance = np.diag(self.covariance)
        return _in_errors(np.diff(self.value), variance[1:] + variance[:-1] - 2 * np.diag(self.covariance, 1))

    def beyond(self, reference: float) -> Array:
        """Return value − `reference` in standard errors, shape (k,)."""
        return _in_errors(self.value - reference, np.diag(self.covariance))

    def apart(self, other: "Estimate") -> Array:
        """Return the difference self − other of two independent runs, in its standard errors; shape (k,)."""
        return _in_errors(self.value - other.value, np.diag(self.covariance) + np.diag(other.covariance))


def _in_errors(difference: Array, variance: Array) -> Array:
    """difference/√variance; 0 where there is no difference, infinite where it has no error at all."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(difference == 0, 0.0, difference / np.sqrt(np.maximum(variance, 0)))


def clustered(value: Array, influence: Array, number: Index) -> Estimate:
    """Estimate whose particle p has influence Ψ_p, shape (particles, k): covariance P/(P−1) Σ_p Ψ_p Ψ_pᵀ."""
    particles = influence.shape[0]
    return Estimate(value, influence.T @ influence * (particles / max(particles - 1, 1)), number)


@dataclass(frozen=True)
class Impacts:
    """Some impacts of a run, each in a cell (a bin of speed, say)."""

    where: tuple[Index, Index]  # particle and impact number of each
    cell: Index  # of each, 0 … cells−1
    cells: int
    particles: int

    def of(self, values: xr.DataArray | NDArray[np.generic]) -> Array:
        """Return values of a (particle, impact) variable at these impacts."""
        return np.asarray(np.asarray(values)[self.where], dtype=np.float64)

    def number(self) -> Index:
        """Count the impacts in each cell."""
        return np.bincount(self.cell, minlength=self.cells)

    def means(self, values: Array) -> Estimate:
        """Return the mean of `values`, one per impact, in each cell; NaN in an empty one."""
        mean = self._mean(values)
        return self._estimate(mean, values - mean[self.cell])

    def deviations(self, values: Array) -> Estimate:
        """Estimate the deviation σ of `values` in each cell; the influence of x is [(x−mean)² − σ²]/2σ."""
        square = (values - self._mean(values)[self.cell]) ** 2
        sigma = np.sqrt(self._mean(square))
        width = np.where(sigma > 0, sigma, 1.0)[self.cell]
        return self._estimate(sigma, (square / width - sigma[self.cell]) / 2)

    def correlations(self, first: Array, second: Array) -> Estimate:
        """Correlate two values per impact in each cell; the influence on ρ is z₁z₂ − ρ(z₁² + z₂²)/2."""
        z1, z2 = (self._standardised(values) for values in (first, second))
        rho = self._mean(z1 * z2)
        return self._estimate(rho, z1 * z2 - rho[self.cell] * (z1**2 + z2**2) / 2)

    def shares(self, label: Index, labels: int) -> Estimate:
        """Return the share of impacts with each label 0 … labels−1, all cells together; shape (labels,)."""
        count = np.bincount(self.where[0] * labels + label, minlength=self.particles * labels)
        by_particle = count.reshape(self.particles, labels).astype(np.float64)
        share = by_particle.sum(axis=0) / label.size
        return clustered(
            share,
            (by_particle - by_particle.sum(axis=1, keepdims=True) * share) / label.size,
            count.reshape(-1, labels).sum(axis=0),
        )

    def regrouped(self, cell: Index, cells: int) -> "Impacts":
        """Put the same impacts in other cells."""
        return Impacts(self.where, cell, cells, self.particles)

    def only(self, chosen: NDArray[np.bool_]) -> "Impacts":
        """Select the impacts for which `chosen`, one value per impact, is true."""
        where = (self.where[0][chosen], self.where[1][chosen])
        return Impacts(where, self.cell[chosen], self.cells, self.particles)

    def followed(self, data: xr.Dataset) -> "Impacts":
        """Select the impacts of a run that have a next one of the same particle with a finite ε."""
        finite = np.isfinite(data["restitution"].to_numpy())
        follows = np.zeros_like(finite)
        follows[:, :-1] = finite[:, 1:]
        return self.only((follows & finite)[self.where])

    def following(self, values: NDArray[np.generic]) -> Array:
        """Return values of a (particle, impact) variable at the impacts that follow these."""
        return self.of(values[:, 1:])

    def one_per_particle(self, seed: int) -> "Impacts":
        """Keep at most one impact of a particle in each cell: those of a cell are then independent draws.

        A particle with n of the cell's impacts is kept with probability n/max n and then gives one of them at
        random: every impact of the cell is equally likely to be drawn, as in a histogram of all of them.
        """
        random = np.random.default_rng(seed)
        order = np.lexsort((random.random(self.cell.size), self.cell, self.where[0]))
        key = (self.where[0] * self.cells + self.cell)[order]
        _, start, count = np.unique(key, return_index=True, return_counts=True)
        drawn = order[start]
        largest = np.zeros(self.cells)
        np.maximum.at(largest, self.cell[drawn], count)
        kept = random.random(drawn.size) * largest[self.cell[drawn]] < count
        chosen = np.zeros(self.cell.size, dtype=np.bool_)
        chosen[drawn[kept]] = True
        return self.only(chosen)

    def _mean(self, values: Array) -> Array:
        with np.errstate(invalid="ignore"):
            return np.bincount(self.cell, weights=values, minlength=self.cells) / self.number()

    def _standardised(self, values: Array) -> Array:
        centred = values - self._mean(values)[self.cell]
        sigma = np.sqrt(self._mean(centred**2))
        return centred / np.where(sigma > 0, sigma, 1.0)[self.cell]

    def _estimate(self, value: Array, influence: Array) -> Estimate:
        size = (self.particles, self.cells)
        cell = self.where[0] * self.cells + self.cell
        summed = np.bincount(cell, weights=influence, minlength=size[0] * size[1]).reshape(size)
        with np.errstate(invalid="ignore"):
            return clustered(value, summed / self.number(), self.number())


def in_cells(cell: NDArray[np.integer], cells: int) -> Impacts:
    """Group impacts by cell, shape (particle, impact), without those of a cell < 0 or ≥ `cells`."""
    particle, impact = np.nonzero((cell >= 0) & (cell < cells))
    return Impacts((particle, impact), cell[particle, impact].astype(np.intp), cells, cell.shape[0])


def in_bins(values: xr.DataArray | Array, edges: Array) -> Impacts:
    """Group impacts by the bin edges[k] ≤ value < edges[k+1] of a (particle, impact) variable without NaN."""
    return in_cells(np.searchsorted(edges, np.asarray(values), side="right") - 1, edges.size - 1)


def in_windows(values: xr.DataArray | Array, windows: Sequence[tuple[float, float]]) -> Impacts:
    """Group impacts by the window lo ≤ value < hi; the windows increase and do not overlap."""
    gaps = in_bins(values, np.array(windows, dtype=np.float64).ravel())
    inside = gaps.only(gaps.cell % 2 == 0)
    return inside.regrouped(inside.cell // 2, len(windows))


def in_blocks(happened: NDArray[np.bool_], edges: Sequence[int]) -> Impacts:
    """Group impacts by the block edges[k] ≤ number < edges[k+1] of their number on the particle, from 0."""
    block = np.searchsorted(np.asarray(edges), np.arange(happened.shape[1]), side="right") - 1
    return in_cells(np.where(happened, block, -1), len(edges) - 1)


def blocks(data: xr.Dataset, edges: Sequence[int], share: float = 0.95) -> list[int]:
    """Return the `edges` of impact numbers that this share of the particles reached, and the last one.

    Later impacts are those of unusual particles, since most trajectories end by themselves.
    """
    reached = int(np.quantile(data["impacts"].to_numpy(), 1 - share))
    return [*(edge for edge in edges if edge < reached), reached]


def settled_speed(data: xr.Dataset, share: float = 0.95) -> float:
    """Return the speed in m/s that so large a share of the particles came below before their record ended.

    At higher speeds the statistics are complete; at lower ones they are those of the particles that got there
    early.
    """
    v = data["impact_velocity"].to_numpy()
    slowest = np.min(np.where(v > 0, v, np.inf), axis=1)
    return float(np.quantile(slowest, share))


def deviations(data: xr.Dataset, settings: AtSpeeds) -> Estimate:
    """Return σ(ε) in the windows of the speeds at which densities are shown."""
    impacts = in_windows(data["impact_velocity"], settings.speed_windows)
    return impacts.deviations(impacts.of(data["restitution"]))


def jackknife(
    statistic: Callable[[Array], float], values: Array, particle: Index, groups: int = 20
) -> tuple[float, float]:
    """Value and standard error of any statistic of `values`, leaving out one group of particles at a time."""
    group = particle % groups
    left = np.array([statistic(values[group != k]) for k in range(groups)])
    return statistic(values), float(np.sqrt((groups - 1) / groups * np.sum((left - left.mean()) ** 2)))
