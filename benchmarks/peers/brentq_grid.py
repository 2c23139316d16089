"""An event loop as one would write it with NumPy and SciPy in an afternoon, carefully.

Both gaps are evaluated on a time grid, the first change of sign is polished with `scipy.optimize.brentq`. A
dip below the plane between two points of the grid goes unnoticed: the price of not knowing a bound.
"""

from math import atan2, cos, pi, sin, sqrt

import numpy as np
from scipy.optimize import brentq

from benchmarks.work import Array, Peer, Records, Work

GRID = 1e-3  # s
NAMES = (
    "time",
    "impact_velocity",
    "rebound_velocity",
    "restitution",
    "rotational_fraction",
    "energy_ratio",
    "angle",
    "contact",
)


class Dumbbell:
    """One particle: z, v_x, v_z, the angle of its axis from the vertical, and its spin."""

    def __init__(self, work: Work, angle: float) -> None:
        self.work, self.arm = work, work.separation / 2
        self.inertia = work.inertia
        self.z, self.vx, self.vz, self.angle, self.spin = work.release_height, 0.0, 0.0, angle, 0.0
        self.clock, self.hit = 0.0, 0

    def gap(self, time: float, sign: int) -> float:
        lift = sign * self.arm * cos(self.angle + self.spin * time)
        return self.z - self.work.radius + lift + (self.vz - 0.5 * self.work.gravity * time) * time

    def next_contact(self) -> tuple[float, int]:
        """Duration of the flight and the sphere, +1 or -1, that touches."""
        g = self.work.gravity
        start = 0.0
        if self.hit:
            # The sphere just hit rises from gap 0 and cannot have come back before `start`.
            rise = self.vz - self.hit * self.arm * self.spin * sin(self.angle)
            start = rise / (g + self.arm * self.spin**2)
            if self.gap(start, -self.hit) <= 0.0:
                return self.root(-self.hit, 0.0, start), -self.hit
        above = max(self.z - self.work.radius, 0.0)
        latest = (self.vz + sqrt(self.vz**2 + 2.0 * g * above)) / g  # z = R: one sphere must have touched
        times = np.arange(start, max(latest, start) + 2.0 * GRID, GRID)
        height = self.z - self.work.radius + (self.vz - 0.5 * g * times) * times
        lift = self.arm * np.cos(self.angle + self.spin * times)
        below = int(np.argmax(height <= np.abs(lift)))
        a, b = times[below - 1], times[below]
        roots = [
            (self.root(sign, a, b), sign) for sign in (1, -1) if height[below] + sign * lift[below] <= 0.0
        ]
        return min(roots)

    def root(self, sign: int, a: float, b: float) -> float:
        return float(brentq(self.gap, a, b, args=(sign,), xtol=1e-15, rtol=1e-15))

    def bounce(self) -> tuple[float, ...]:
        """Move to the next impact and through it; returns the row of `NAMES`."""
        work = self.work
        time, self.hit = self.next_contact()
        self.clock += time
        self.vz -= work.gravity * time
        self.angle = (self.angle + self.spin * time) % (2.0 * pi)
        x, y = sin(self.angle), cos(self.angle)
        rx, rz = self.hit * self.arm * x, self.hit * self.arm * y - work.radius  # (6)
        jx = (work.tangential - 1) * (self.vx + self.spin * rz)  # left side of (10)
        jz = -(1 + work.normal) * (self.vz - self.spin * rx)
        d = self.inertia + rx**2 + rz**2
        px = ((self.inertia + rx**2) * jx + rx * rz * jz) / d  # (14), for any ε_t
        pz = ((self.inertia + rz**2) * jz + rx * rz * jx) / d
        rotation = self.inertia * self.spin**2
        energy = rotation + self.vx**2 + self.vz**2
        fall = -self.vz
        self.vx, self.vz = self.vx + px, self.vz + pz  # (11)
        self.spin += (rz * px - rx * pz) / self.inertia
        self.z = work.radius - self.hit * self.arm * y
        left = self.inertia * self.spin**2 + self.vx**2 + self.vz**2
        return (
            self.clock,
            fall,
            self.vz,
            self.vz / fall,
            rotation / energy,
            left / energy,
            atan2(abs(x), y),
            1.0 if self.hit > 0 else 2.0,
        )


def run(work: Work, angles: Array) -> Records:
    particles = [Dumbbell(work, angle) for angle in angles.tolist()]
    rows = np.array([[particle.bounce() for _ in range(work.impacts)] for particle in particles])
    return dict(zip(NAMES, np.moveaxis(rows, 2, 0), strict=True))


def rows() -> list[Peer[Records]]:
    return [Peer("NumPy 1 ms grid + brentq", run, share=0.005)]
