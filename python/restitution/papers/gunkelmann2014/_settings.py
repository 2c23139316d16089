"""Every number that the figures depend on."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from restitution.analytic import RoughContact, rough_contact, rough_impact, rough_spin
from restitution.bodies import Dumbbell, RoughSphere
from restitution.laws import TangentialRestitution
from restitution.papers import settings
from restitution.papers.settings import AtSpeeds, chosen, stated


@dataclass(frozen=True)
class Settings(AtSpeeds, settings.Settings):
    """Parameters of PRE 90, 052204 for its refs. 10 and 11, our choices where it has none; SI units."""

    # The body and the law.
    radius: float = chosen(3e-3, "m", "radius R of the sphere")
    asperities: int = stated(10**6, "1", "number N of asperities, the least that is called typical")
    asperity_radius: float = chosen(1e-5, "m", "radius ρ of every asperity")
    mean_height: float = chosen(
        3e-7, "m", "mean of the heights of the asperities above the sphere, exponentially distributed"
    )
    numbers: tuple[int, ...] = chosen((10**4, 10**5, 10**6), "1", "numbers N of asperities of equal height")
    height: float = chosen(1e-5, "m", "height of the asperities where it is the same for all")
    mean_heights: tuple[float, ...] = chosen((1e-7, 3e-7, 1e-6), "m", "other mean heights")
    normal: float = chosen(0.98, "1", "normal restitution of the contact point, as for the dumbbells")
    tangential: float = chosen(1.0, "1", "tangential restitution of the contact point, as for the dumbbells")
    elongation: float = stated(0.1, "1", "L/R of the dumbbell that rough spheres are compared with")

    # The experiment.
    release_height: float = chosen(0.06, "m", "release height of the centre of mass, at rest")
    gravity: float = chosen(9.81, "m/s²", "gravitational acceleration")
    impacts_per_particle: int = chosen(180, "1", "impacts followed on each particle: down to 3 cm/s")
    recorded_impacts: int = chosen(1_000_000, "1", "impacts to record at most, main run")
    secondary_particles: int = chosen(400, "1", "particles recorded in each secondary run")
    seed_of_surface: int = chosen(1, "1", "seed of the places and heights of the asperities")

    # What is drawn.
    speeds: tuple[float, ...] = chosen((0.1, 0.2, 0.4, 0.8), "m/s", "speeds at which densities are shown")
    speed_tolerance: float = chosen(0.05, "1", "half-width of the speed windows, as a share of the speed")
    velocity_mesh: float = chosen(0.005, "m/s", "lattice of impact velocity and restitution, impact velocity")
    restitution_mesh: float = chosen(0.005, "1", "lattice of impact velocity and restitution, restitution")
    velocity_range: tuple[float, float] = chosen((0.05, 1.1), "m/s", "impact velocities in the figures")
    restitution_range: tuple[float, float] = chosen((0.7, 1.3), "1", "restitution in the figures")
    histogram_bins: int = chosen(60, "1", "bins of each density, over six standard deviations either way")
    curve_bins: int = chosen(14, "1", "logarithmic bins of impact velocity where curves are drawn")

    @property
    def release_speed(self) -> float:
        """Velocity of the first impact, in m/s."""
        return float(np.sqrt(2.0 * self.gravity * (self.release_height - self.radius)))

    @property
    def law(self) -> TangentialRestitution:
        """The law of all runs."""
        return TangentialRestitution(normal=self.normal, tangential=self.tangential)

    def contact(self, asperities: int | None = None, mean_height: float | None = None) -> RoughContact:
        """Return where a sphere touches: of equal heights if the number is given, else of random ones."""
        heights = {"height": self.height} if asperities else {"mean_height": mean_height or self.mean_height}
        number = asperities or self.asperities
        return rough_contact(
            radius=self.radius, asperities=number, asperity_radius=self.asperity_radius, **heights
        )

    def spin(self, speed: float, contact: RoughContact) -> float:
        """Return σ_ω of a horizontal component at this speed since the release (docs/rough.md, 12)."""
        release = self.release_speed
        return rough_spin(
            self.law, contact, speed=min(speed, release), release_speed=release, radius=self.radius
        )

    def density(self, speed: float, contact: RoughContact | None = None) -> Any:
        """Return p(ε | v) in closed form, frozen (docs/rough.md, 11); of the main run unless told."""
        contact = contact or self.contact()
        spin = self.spin(speed, contact)
        return rough_impact(self.law, contact, speed=speed, spin=spin, radius=self.radius)

    def mean_share(self, speed: float, contact: RoughContact | None = None) -> float:
        """Return <E_rot/E_tot> of a Gaussian spin; the contact keeps its tangential velocity, 0: v_h = ωR.

        With x = Jω_h²/mv², exponential with the mean ξ, the share is x/(x(1 + mR²/J) + 1).
        """
        nodes, weights = np.polynomial.laguerre.laggauss(64)
        spin = self.spin(speed, contact or self.contact())
        x = nodes * 2.0 * 0.4 * (spin * self.radius / speed) ** 2
        return float(weights @ (x / (x * (1.0 + 1.0 / 0.4) + 1.0)))

    def body(self, asperities: int | None = None, mean_height: float | None = None) -> RoughSphere:
        """Make a sphere: with equal heights if the number of asperities is given, else with random ones."""
        return RoughSphere(
            radius=self.radius,
            asperities=asperities or self.asperities,
            asperity_radius=self.asperity_radius,
            heights=self.height if asperities else ("exponential", mean_height or self.mean_height),
            seed=self.seed_of_surface,
        )

    @property
    def dumbbell(self) -> Dumbbell:
        """The other kind of imperfect sphere."""
        return Dumbbell(radius=self.radius, separation=self.elongation * self.radius)
