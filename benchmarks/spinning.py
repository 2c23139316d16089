"""Two jobs with spin in every direction, for the engine and for the Numba loops alike."""

from dataclasses import dataclass, field

import numpy as np

import restitution as rs
from benchmarks.work import Array, Grid, Work

RATES = (10.0, 90.0)  # rad/s: the rim of a body of 1 cm moves at up to 0.9 m/s, the body at 1 m/s
NUDGE = 1e-9


@dataclass(frozen=True)
class Released:
    """Polar angle and azimuth (rad) and angular velocity (rad/s) of each particle."""

    angles: Array
    spins: Array

    @classmethod
    def random(cls, particles: int, seed: int) -> "Released":
        """Axes uniform in the angle, spins in all directions."""
        rng = np.random.default_rng(seed)
        angles = rng.uniform(0.0, [np.pi, 2.0 * np.pi], (particles, 2))
        spins = rng.normal(size=(particles, 3))
        spins *= (rng.uniform(*RATES, particles) / np.linalg.norm(spins, axis=1))[:, None]
        return cls(angles, spins)

    def nudged(self) -> "Released":
        """Every number off by about `NUDGE`."""
        return Released(self.angles + NUDGE, self.spins * (1.0 + NUDGE))

    @property
    def axes(self) -> Array:
        """Unit vectors of the symmetry axes."""
        (theta, phi), level = self.angles.T, np.sin(self.angles[:, 0])
        return np.stack([level * np.cos(phi), level * np.sin(phi), np.cos(theta)], axis=1)

    def turns(self, inertia: tuple[float, float]) -> Array:
        """Λ/J_xx."""
        axes = self.axes
        own = np.sum(axes * self.spins, axis=1, keepdims=True)
        turns: Array = self.spins + (inertia[1] / inertia[0] - 1.0) * own * axes
        return turns


@dataclass(frozen=True)
class Spinning:
    """A body that spins, a law and its second parameter (ε_t or μ)."""

    name: str
    other: float
    work: Work = field(default_factory=Work)

    @property
    def body(self) -> rs.Dumbbell | rs.Spheroid:
        if self.name == "spheroid":
            return rs.Spheroid(equatorial=self.work.radius, polar=2.0 * self.work.radius)
        return rs.Dumbbell(radius=self.work.radius, separation=self.work.separation)

    @property
    def law(self) -> rs.TangentialRestitution | rs.Coulomb:
        if self.name == "spheroid":
            return rs.TangentialRestitution(normal=self.work.normal, tangential=self.other)
        return rs.Coulomb(normal=self.work.normal, friction=self.other, hypothesis="stronge")

    @property
    def outline(self) -> tuple[float, float]:
        """Semi-axes across and along, or radius and L/2; in m."""
        if self.name == "spheroid":
            return self.work.radius, 2.0 * self.work.radius
        return self.work.radius, 0.5 * self.work.separation

    @property
    def inertia(self) -> tuple[float, float]:
        """J_xx and J_zz over the mass, in m²."""
        a, c = self.outline
        if self.name == "spheroid":
            return (a * a + c * c) / 5.0, 0.4 * a * a
        q = 2.0 * c / a
        mass = 4 / 3 + q - q**3 / 12  # (A3) over πρR³
        axial = 8 / 15 + q / 2 - q**3 / 12 + q**5 / 160  # (A5), its last term corrected
        return self.work.inertia, axial / mass * a * a

    def statistics(self, released: Released, threads: int = 1) -> Grid:
        """The engine's grid, everything that `restitution.statistics` keeps included."""
        lattice = self.work.lattice
        found = rs.statistics(
            self.body,
            self.law,
            particles=len(released.spins),
            impacts=self.work.impacts,
            release_height=self.work.release_height,
            gravity=self.work.gravity,
            orientation=released.angles,
            spin=released.spins,
            threads=threads,
            velocity_bins=lattice.velocity,
            restitution_bins=lattice.restitution,
        )
        return Grid.of(found)

    def first(self, released: Released, keep: int) -> Array:
        """v and ε of the engine's first impacts, (particle, impact, 2)."""
        data = rs.simulate(
            self.body,
            self.law,
            particles=len(released.spins),
            impacts=keep,
            release_height=self.work.release_height,
            gravity=self.work.gravity,
            orientation=released.angles,
            spin=released.spins,
        )
        return np.stack([data.impact_velocity.values, data.restitution.values], axis=2)


JOBS = (Spinning("spheroid", 1.0), Spinning("dumbbell", 0.3))
