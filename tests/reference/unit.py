"""Bodies in units of their own."""

import restitution as rs


def dumbbell(separation: float, mass: float = 1.0) -> rs.Dumbbell:
    """Return a dumbbell of balls of radius 1."""
    of_density = rs.Dumbbell(radius=1.0, separation=separation, density=1.0).mass
    return rs.Dumbbell(radius=1.0, separation=separation, density=mass / of_density)
