"""Every number that the figures and claims depend on."""

from dataclasses import dataclass

import numpy as np

from restitution.bodies import Dumbbell, Spherocylinder
from restitution.papers import settings
from restitution.papers.settings import chosen, stated


@dataclass(frozen=True)
class Settings(settings.Settings):
    """Gases of dumbbells, spheres and rods, all of which begin with T_rot = T_tr; SI units."""

    radius: float = chosen(3e-3, "m", "radius R of the balls, and of rods")
    temperature: float = chosen(1e-9, "J", "T_tr at the beginning; hard contacts have no scale of it")
    number_density: float = chosen(1e6, "1/m³", "particles per volume")
    share: float = chosen(1.0, "1", "of the collisions below that every gas has")

    elongations: tuple[float, ...] = chosen((0.1, 0.3, 1.0, 2.0), "1", "L/R of the dumbbells")
    slightly: float = stated(0.1, "1", "L/R of the dumbbells of the paper")
    normals: tuple[float, ...] = chosen((0.9, 0.7), "1", "ε_n of these gases, and of those with friction")
    collisions: tuple[float, ...] = chosen((300.0, 150.0, 100.0, 100.0), "1", "of a particle, by L/R")
    coefficients: tuple[float, ...] = chosen(
        (0.5, 0.6, 0.8, 0.95), "1", "ε_n of gases that begin at the steady ratio of the closure"
    )
    steady_collisions: float = chosen(40.0, "1", "of a particle of these")

    frictions: tuple[float, ...] = chosen((0.1, 0.2, 0.3, 0.5, 1.0), "1", "μ of Coulomb's law")
    friction_collisions: float = chosen(100.0, "1", "of a particle with friction")

    rough_normal: float = chosen(0.8, "1", "ε of rough spheres")
    roughness: tuple[float, ...] = chosen((-0.9, -0.5, 0.0, 0.5), "1", "β of rough spheres")
    lossy: float = chosen(0.85, "1", "another ε_n of spheres, with μ = 0.5")
    rods: tuple[float, ...] = chosen((1.5, 2.0, 4.0), "1", "lengths of rods over their diameter")
    rod_normals: tuple[float, ...] = chosen((0.98, 0.8), "1", "ε_n of smooth rods")
    long_normal: float = chosen(0.7, "1", "ε_n of the longest rods with friction")
    long_friction: float = chosen(0.3, "1", "μ of these")
    other_collisions: float = chosen(60.0, "1", "of a particle of rough spheres; of a rod two thirds of it")

    speed: float = chosen(0.5**0.5, "m/s", "√(T_tr/m) of spheres at the beginning, for which p(ε|v) is given")
    drop: float = chosen(1.0, "m", "height from which a dumbbell is dropped on a plane to learn p(ε|v)")

    def dumbbell(self, elongation: float) -> Dumbbell:
        """Make a dumbbell of equal balls."""
        return Dumbbell(radius=self.radius, separation=elongation * self.radius)

    def rod(self, aspect: float) -> Spherocylinder:
        """Make a rod so many diameters long."""
        return Spherocylinder(radius=self.radius, separation=2.0 * self.radius * (aspect - 1.0))

    def limit(self, normal: float, elongation: float) -> float:
        """Return T_rot/T_tr of nearly round dumbbells, (12/5)(R/L)²(1 - ε)/(1 + ε)."""
        return 2.4 / elongation**2 * (1.0 - normal) / (1.0 + normal)

    def spheres(self, normal: float) -> float:
        """Return -d ln T/d(collisions) of smooth spheres."""
        return (1.0 - normal**2) / 3.0

    @property
    def theta(self) -> float:
        """T_tr/m of spheres at the beginning, in m²/s²."""
        return float(np.square(self.speed))
