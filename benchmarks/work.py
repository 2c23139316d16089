"""What every peer is asked to do, and what it hands back."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Records = Mapping[str, NDArray[Any]]
"""Arrays (particle, impact) under the names of the variables of `restitution.simulate`; NaN for no impact."""


@dataclass(frozen=True)
class Work:
    """Dumbbells dropped from rest with the paper's law; SI units.

    The release height is that from which a sphere of the same radius would arrive at 1 m/s.
    """

    impacts: int = 200
    radius: float = 0.01
    separation: float = 0.001
    normal: float = 0.98
    tangential: float = 1.0
    gravity: float = 9.81

    @property
    def release_height(self) -> float:
        return self.radius + 1.0 / (2.0 * self.gravity)

    def angles(self, particles: int, seed: int = 1) -> Array:
        """Release angles, uniform in [0, π)."""
        return np.random.default_rng(seed).uniform(0.0, np.pi, particles)


@dataclass(frozen=True)
class Peer:
    """One row of the table: a name, a way to do the work, and the share of the particles it is given.

    A slow peer gets a small share; all figures are per impact.
    """

    name: str
    run: Callable[[Work, Array], Records]
    share: float = 1.0
