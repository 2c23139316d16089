"""The task of every peer, and the result it hands back."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np
import xarray as xr
from numpy.typing import NDArray

Array = NDArray[np.float64]
Counts = NDArray[np.int64]
Result = TypeVar("Result")
Records = Mapping[str, NDArray[Any]]
"""Arrays (particle, impact) under the names of the variables of `restitution.simulate`; NaN for no impact."""


@dataclass(frozen=True)
class Lattice:
    """Uniform bins of impact velocity (m/s) and ε: the mesh of Fig. 2, and the part of it that is counted."""

    velocity_mesh: float = 0.002
    velocity_bins: int = 550
    restitution_mesh: float = 0.01
    restitution_bins: int = 120
    restitution_low: float = 0.4

    @property
    def velocity(self) -> Array:
        """Edges."""
        return self.velocity_mesh * np.arange(self.velocity_bins + 1, dtype=np.float64)

    @property
    def restitution(self) -> Array:
        """Edges."""
        steps = np.arange(self.restitution_bins + 1, dtype=np.float64)
        return self.restitution_low + self.restitution_mesh * steps


@dataclass(frozen=True)
class Grid:
    """Impacts counted on a `Lattice`, (velocity, restitution), and their number with those beside it."""

    count: Counts
    impacts: int

    @classmethod
    def of(cls, found: xr.Dataset) -> "Grid":
        """From what `restitution.statistics` returns."""
        numbers = ("number", "undefined", "velocity_underflow", "velocity_overflow")
        return cls(
            found["restitution_count"].to_numpy(), sum(int(found[name].to_numpy().sum()) for name in numbers)
        )


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
    lattice: Lattice = Lattice()

    @property
    def release_height(self) -> float:
        return self.radius + 1.0 / (2.0 * self.gravity)

    @property
    def inertia(self) -> float:
        """J_xx over the mass, in m²."""
        q = self.separation / self.radius
        mass = 4 / 3 + q - q**3 / 12  # (A3) over πρR³
        return (8 / 15 + 3 / 4 * q + q**2 / 3 + q**3 / 24 + q**5 / 960) / mass * self.radius**2  # (A8)

    def angles(self, particles: int, seed: int = 1) -> Array:
        """Release angles, uniform in [0, π)."""
        return np.random.default_rng(seed).uniform(0.0, np.pi, particles)


@dataclass(frozen=True)
class Peer(Generic[Result]):
    """One row of the table: a name, a way to do the work, and the share of the particles it is given.

    A slow peer gets a small share; all figures are per impact.
    """

    name: str
    run: Callable[[Work, Array], Result]
    share: float = 1.0

    def particles(self, particles: int) -> int:
        return max(1, round(particles * self.share))
