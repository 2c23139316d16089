"""How far a learned distribution is from impacts that it was not learned from."""

import warnings
from collections.abc import Iterable

import numpy as np
import xarray as xr

from restitution.distribution._count import placed
from restitution.distribution._ensemble import BATCHES, Impacts
from restitution.distribution._nodes import POINT
from restitution.distribution._table import Floats, Ints, Table

_LEVELS = 4096
_FAR, _TIMES = 0.05, 3.5
"""A distance beyond both, of fresh impacts and in terms of their scatter, triggers a warning."""
_COARSE, _RESAMPLES, _SEED = 256, 64, 1


class Check:
    """Kolmogorov–Smirnov distances between a table and impacts, one for each interval between two nodes.

    If ε has the learned distribution at its own v, the probability of a smaller one, u = F(ε | v), is uniform
    on [0, 1] at whatever speeds the impacts are. So the distance of u from uniform is that of the learned
    distribution from the true one, averaged over the interval.
    """

    def __init__(self, table: Table) -> None:
        self.table = table
        self._random = np.random.default_rng(_SEED)
        self._has_points = any(np.diff(part.edges).min() < POINT for part in table)
        self.count: Ints = np.zeros((table.speeds.size - 1, _LEVELS), dtype=np.int64)
        self._batches: Ints = np.zeros((BATCHES, table.speeds.size - 1, _COARSE), dtype=np.int64)

    @classmethod
    def of(cls, table: Table, blocks: Iterable[Impacts]) -> "Check":
        """Compare a table with an ensemble."""
        check = cls(table)
        for block in blocks:
            check.add(block.batch, block.velocity, block.restitution)
        return check

    def add(self, batch: int, velocity: Floats, restitution: Floats) -> None:
        """Count impacts of a batch, which shares no particle with any other, by interval and u."""
        number, inside = placed(self.table.speeds, velocity, restitution)
        u = self._levels(restitution[inside], velocity[inside])
        place = number[inside] * _LEVELS + np.minimum((u * _LEVELS).astype(np.int64), _LEVELS - 1)
        count = np.bincount(place, minlength=self.count.size).reshape(self.count.shape)
        self.count += count
        self._batches[batch] += count.reshape(*count.shape[:1], _COARSE, -1).sum(axis=2)

    def _levels(self, restitution: Floats, velocity: Floats) -> Floats:
        """F(ε | v); evenly between the levels on either side of ε where it is a point mass."""
        u = self.table.value("cdf", restitution, velocity)
        if self._has_points:
            below, above = (self.table.value("cdf", restitution + side, velocity) for side in (-POINT, POINT))
            even = self._random.random(u.size)
            u = np.where(above - below > 0.5 / _LEVELS, below + even * (above - below), u)
        return u

    def impacts(self) -> Ints:
        """Impacts in each interval."""
        return np.asarray(self.count.sum(axis=1))

    def distances(self) -> Floats:
        """Upper bounds: the distance at 4096 equidistant u, and 1/4096; NaN where there are no impacts."""
        exact = np.arange(1, _LEVELS + 1) / _LEVELS
        return np.asarray(np.max(np.abs(_shares(self.count) - exact), axis=1) + 1.0 / _LEVELS)

    def scatter(self) -> Floats:
        """Estimate the part of the distances that is scatter of the impacts: the mean of a bootstrap.

        Batches of particles are resampled, each a Poisson number of times of mean 1, and compared with
        all of them at 256 u. Independent impacts scatter by 0.87/√impacts. NaN for a single batch.
        """
        filled = self._batches[self._batches.any(axis=(1, 2))]
        if filled.shape[0] < 2:
            return np.full(self.count.shape[0], np.nan)
        found = _shares(filled.sum(axis=0))
        times = np.random.default_rng(_SEED).poisson(size=(_RESAMPLES, filled.shape[0]))
        distances = [np.abs(_shares(np.tensordot(row, filled, 1)) - found).max(axis=1) for row in times]
        known = np.isfinite(distances)
        with np.errstate(invalid="ignore"):
            return np.asarray(np.where(known, distances, 0.0).sum(axis=0) / known.sum(axis=0))


class DistanceWarning(UserWarning):
    """A learned distribution is farther from fresh impacts than their scatter explains.

    Examples
    --------
    >>> import warnings
    >>> import restitution as rs
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", rs.DistanceWarning)  # stop there instead
    ...     dist = rs.FluctuatingRestitution.learn(
    ...         rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98),
    ...         particles=400, velocities=(0.2, 0.6))
    """


def warn_of_distance(data: xr.Dataset, *, stacklevel: int) -> None:
    """Warn if the worst interval is too far; `stacklevel` is that of `warnings.warn`."""
    distance, scatter, impacts = (
        data[name].to_numpy() for name in ("ks_distance", "ks_scatter", "fresh_impacts")
    )
    # A single batch has no scatter; independent impacts have this one.
    scatter = np.where(np.isfinite(scatter), scatter, 0.87 / np.sqrt(np.maximum(impacts, 1)))
    far = (distance > _FAR) & (distance > _TIMES * scatter)
    if far.any():
        worst = int(np.nanargmax(np.where(far, distance, np.nan)))
        low, high = data["velocity"].to_numpy()[worst : worst + 2]
        warnings.warn(
            f"the learned distribution is {distance[worst]:.3f} from fresh impacts at {low:.4g} to "
            f"{high:.4g} m/s (Kolmogorov-Smirnov), of which {scatter[worst]:.3f} are due to their "
            f"scatter; so are {int(far.sum())} of {far.size} intervals. More particles, heights of release "
            "spread over the loss of an impact, or another range of velocities reduce the distance",
            DistanceWarning,
            stacklevel=stacklevel + 1,
        )


def _shares(count: Ints) -> Floats:
    """Cumulate along the last axis, as shares; NaN where there are no impacts."""
    with np.errstate(invalid="ignore"):
        below = np.cumsum(count, axis=-1)
        return np.asarray(below / below[..., -1:])
