"""Distance of a learned distribution from impacts that it was not learned from."""

import warnings
from collections.abc import Iterable

import numpy as np
import xarray as xr

from restitution import _core
from restitution._internal.process import uninterrupted
from restitution._internal.resources import checked_threads
from restitution.distribution._ensemble import BATCHES, Impacts
from restitution.distribution._nodes import POINT
from restitution.distribution._table import Floats, Ints, Table

_FAR, _TIMES = 0.05, 3.5
"""A distance beyond both, of fresh impacts and in terms of their scatter, triggers a warning."""
_COARSE = 0.1
"""A distance that triggers one also where scatter explains it: so few impacts tell little."""
_RESAMPLES, _SEED = 64, 1


class Check:
    """Kolmogorov–Smirnov distances between a table and impacts, one for each interval between two nodes.

    If ε has the learned distribution at its own v, the probability of a smaller one, u = F(ε | v), is uniform
    on [0, 1] at any speeds of the impacts. So the distance of u from uniform is that of the learned
    distribution from the true one, averaged over the interval.
    """

    def __init__(self, table: Table) -> None:
        self.table = table
        self._levels = _core.Levels(table.speeds.size, BATCHES)

    @classmethod
    def of(cls, table: Table, blocks: Iterable[Impacts], threads: int | None = None) -> "Check":
        """Compare a table with an ensemble."""
        check = cls(table)
        for block in blocks:
            check.add(block, threads)
            del block  # before the next one is simulated
        return check

    def add(self, block: Impacts, threads: int | None = None) -> None:
        """Count impacts by interval and u.

        Where ε is a point mass, u is spread evenly between the levels on either side of it.
        """
        velocity, restitution = map(np.ascontiguousarray, (block.velocity, block.restitution))
        number = checked_threads(threads)
        found = self._levels.add(self.table.mixture, POINT, velocity, restitution, block.first, number)
        uninterrupted(None, found)

    def count(self, interval: int) -> Ints:
        """Count the impacts of an interval in each of 4096 equal parts of [0, 1] that u falls into."""
        return self._levels.fine(interval)

    @property
    def _intervals(self) -> range:
        return range(self.table.speeds.size - 1)

    def impacts(self) -> Ints:
        """Count the impacts in each interval."""
        return np.array([self.count(interval).sum() for interval in self._intervals])

    def distances(self) -> Floats:
        """Bound the distance: its value at 4096 equidistant u, and 1/4096; NaN without impacts."""
        found = []
        for interval in self._intervals:
            count = self.count(interval)
            exact = np.arange(1, count.size + 1) / count.size
            found.append(np.max(np.abs(_shares(count) - exact)) + 1.0 / count.size)
        return np.array(found)

    def scatter(self) -> Floats:
        """Estimate the part of the distances that is scatter of the impacts: the mean of a bootstrap.

        Batches of particles are resampled, each a Poisson number of times of mean 1, and compared with
        all of them at 256 u. Independent impacts scatter by 0.87/√impacts. NaN for a single batch.
        """
        seen = [self._levels.coarse(interval).any(axis=1) for interval in self._intervals]
        some = np.any(seen, axis=0)
        scatter = np.full(len(self._intervals), np.nan)
        if np.count_nonzero(some) < 2:
            return scatter
        times = np.random.default_rng(_SEED).poisson(size=(_RESAMPLES, np.count_nonzero(some))).astype(float)
        for interval in self._intervals:
            batches = self._levels.coarse(interval)[some]
            distances = np.abs(_shares(times @ batches) - _shares(batches.sum(axis=0))).max(axis=1)
            known = distances[np.isfinite(distances)]
            if known.size:
                scatter[interval] = known.mean()
        return scatter


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
    """Warn if an interval is too far; `stacklevel` is that of `warnings.warn`."""
    distance, scatter, impacts = (
        data[name].to_numpy() for name in ("ks_distance", "ks_scatter", "fresh_impacts")
    )
    # A single batch has no scatter; independent impacts have this one.
    scatter = np.where(np.isfinite(scatter), scatter, 0.87 / np.sqrt(np.maximum(impacts, 1)))
    far = (distance > _FAR) & (distance > _TIMES * scatter)
    if far.any():
        why = (
            f"{int(far.sum())} of {far.size} intervals between nodes are farther than scatter explains. More "
            "particles reduce only the scatter; where lines or bands of p(ε | v) move with v by more than "
            "their width, spread the heights of release, or learn another range of velocities"
        )
    elif (distance > _COARSE).any():
        why = "So few impacts do not tell whether it is right: learn from more particles"
    else:
        return
    text = f"the learned distribution is up to {largest_distance(data)}. {why}"
    warnings.warn(text, DistanceWarning, stacklevel=stacklevel + 1)


def largest_distance(data: xr.Dataset) -> str:
    """Report the largest distance of fresh impacts, its speeds, and the distance due to their scatter."""
    worst = int(np.nanargmax(data["ks_distance"].to_numpy()))
    low, high = data["velocity"].to_numpy()[worst : worst + 2]
    distance, scatter = (float(data[name][worst]) for name in ("ks_distance", "ks_scatter"))
    text = f"{distance:.4f} from fresh impacts (Kolmogorov-Smirnov), at {low:.4g} to {high:.4g} m/s"
    return f"{text}, of which their own scatter explains {scatter:.4f}"


def _shares(count: Ints | Floats) -> Floats:
    """Cumulate along the last axis, as shares; NaN where there are no impacts."""
    with np.errstate(invalid="ignore"):
        below = np.cumsum(count, axis=-1)
        return np.asarray(below / below[..., -1:])
