"""How far a learned distribution is from impacts that it has not seen."""

import numpy as np

from restitution.distribution._count import intervals
from restitution.distribution._table import Floats, Ints, Table

_LEVELS = 4096


class Check:
    """Kolmogorov–Smirnov distances between a table and impacts, one for each interval between two nodes.

    If ε has the learned distribution at its own v, the probability of a smaller one, u = F(ε | v), is uniform
    on [0, 1] at whatever speeds the impacts are. So the distance of u from uniform is that of the learned
    distribution from the true one, averaged over the interval.
    """

    def __init__(self, table: Table) -> None:
        self.table = table
        self.count: Ints = np.zeros((table.speeds.size - 1, _LEVELS), dtype=np.int64)

    def add(self, velocity: Floats, restitution: Floats, z: Floats) -> None:
        """Count impacts by interval and u."""
        for i, (weight, epsilon, condition) in intervals(self.table.speeds, velocity, restitution, z):
            low, high = self.table.speeds[i : i + 2]
            u = self.table.value("cdf", epsilon, low + weight * (high - low), condition)
            place = np.minimum((u * _LEVELS).astype(np.int64), _LEVELS - 1)
            self.count[i] += np.bincount(place, minlength=_LEVELS)

    def impacts(self) -> Ints:
        """Impacts in each interval."""
        return np.asarray(self.count.sum(axis=1))

    def distances(self) -> Floats:
        """Upper bounds: the distance at 4096 equidistant u, and 1/4096; NaN where there are no impacts."""
        with np.errstate(invalid="ignore"):
            found = np.cumsum(self.count, axis=1) / self.impacts()[:, None]
        exact = np.arange(1, _LEVELS + 1) / _LEVELS
        return np.asarray(np.max(np.abs(found - exact), axis=1) + 1.0 / _LEVELS)
