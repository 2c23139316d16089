"""The law of the angle θ itself, for bodies that need not look the same upside down."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from restitution.analytic._orientation import Floats, OrientationName


@dataclass(frozen=True)
class Tilt:
    """θ between symmetry axis and plane normal, from 0 to ``limit``."""

    orientation: OrientationName
    limit: float  # π/2 where θ and π - θ are taken as one, else π

    @property
    def edges(self) -> Floats:
        """Angles between which the density is smooth."""
        return np.empty(0)

    def below(self, theta: ArrayLike) -> Floats:
        """Return the probability of angles up to θ."""
        angle = np.asarray(theta, dtype=np.float64)
        if self.orientation == "uniform-angle":
            return np.asarray(angle / self.limit)
        return np.asarray((np.sin(0.5 * angle) / np.sin(0.5 * self.limit)) ** 2)

    def between(self, low: float, high: float) -> float:
        """Return the probability of angles from low to high."""
        return float(self.below(high) - self.below(low))

    def density(self, theta: ArrayLike) -> Floats:
        """Return the probability density of θ, per rad."""
        angle = np.asarray(theta, dtype=np.float64)
        if self.orientation == "uniform-angle":
            return np.full_like(angle, 1.0 / self.limit)
        return np.asarray(np.sin(angle) / (2.0 * np.sin(0.5 * self.limit) ** 2))

    def quantile(self, share: Floats) -> Floats:
        """Return the angle up to which the probability is ``share``."""
        if self.orientation == "uniform-angle":
            return share * self.limit
        return np.asarray(2.0 * np.arcsin(np.sqrt(share) * np.sin(0.5 * self.limit)))
