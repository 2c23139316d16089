"""Every number that the figures depend on."""

from dataclasses import dataclass

import numpy as np

from restitution._internal.arrays import FloatArray
from restitution.bodies import Dumbbell
from restitution.laws import TangentialRestitution
from restitution.papers import settings
from restitution.papers.settings import AtSpeeds, chosen, stated


@dataclass(frozen=True)
class Settings(AtSpeeds, settings.Settings):
    """Settings that PRE 90, 052204 states, and our choices where it states none, in SI units.

    The motion depends on L/R, the law, and release height and speed in units of R and √(gR): a body with
    another radius is one released from another height, with speeds rescaled.
    """

    # The body and the law.
    radius: float = chosen(3e-3, "m", "radius R of either sphere")
    elongation: float = stated(0.1, "1", "L/R of Figs. 2-5 and 7")
    bead_elongations: tuple[float, ...] = stated((0.01, 0.02), "1", "L/R of Fig. 6, average glass beads")
    first_elongation: float = stated(2.0, "1", "L/R of Fig. 9")
    energy_elongations: tuple[float, ...] = chosen((0.1, 0.5, 2.0), "1", "L/R of the energy ledger")
    normal: float = stated(0.98, "1", "normal restitution of the contact point, Figs. 2-7")
    first_normal: float = stated(0.4, "1", "normal restitution of the contact point, Fig. 9")
    tangential: float = stated(1.0, "1", "tangential restitution of the contact point")

    # The experiment.
    release_height: float = chosen(0.06, "m", "release height of the centre of mass")
    gravity: float = chosen(9.81, "m/s²", "gravitational acceleration")
    orientation: str = stated("uniform-angle", "", "release angle θ uniform in [0, π)")
    least_impacts: int = stated(400_000, "1", "impacts in Fig. 2, the fewest to count")
    recorded_impacts: int = chosen(
        4_000_000, "1", "impacts to record at most, main run: for the claims, fits and standard errors"
    )
    # Cut short, low speeds are seen only in unusual trajectories. With these numbers over 99 % of all
    # impacts at each speed of Figs. 2-6 are seen (with 400, 79 % at 0.05 m/s and 85 % at 0.1 m/s for L/R
    # = 0.1), and most trajectories end by themselves, from the 660th impact on.
    impacts_per_particle: int = chosen(
        1200, "1", "impacts followed on each particle, main and secondary runs"
    )
    mean_impacts: int = chosen(980, "1", "impacts per particle of the main run, at least, on average")
    bead_impacts_per_particle: int = chosen(400, "1", "impacts followed on each particle, L/R of Fig. 6")
    sensitivity_impacts_per_particle: int = chosen(1600, "1", "impacts on each particle, other R and heights")
    secondary_particles: int = chosen(1000, "1", "particles recorded in each secondary run")
    first_particles: int = chosen(1_000_000, "1", "particles in Fig. 9, one impact each")
    radii: tuple[float, ...] = chosen((1e-3, 3e-3, 10e-3), "m", "radii of the sensitivity figures")
    heights: tuple[float, ...] = chosen((0.03, 0.06, 0.2), "m", "release heights of the sensitivity figures")

    # What is drawn.
    velocity_mesh: float = stated(0.002, "m/s", "lattice of Figs. 2, 3, 7, impact velocity, origin 0")
    restitution_mesh: float = stated(0.01, "1", "lattice of Figs. 2 and 7, restitution, origin 0")
    fraction_mesh: float = chosen(
        0.005, "1", "lattice of Fig. 3 and bins of Fig. 5, rotational fraction, origin 0"
    )
    velocity_range: tuple[float, float] = chosen((0.05, 1.1), "m/s", "impact velocities in Figs. 2 and 3")
    restitution_range: tuple[float, float] = chosen((0.4, 1.6), "1", "restitution in Fig. 2")
    fraction_range: tuple[float, float] = chosen((0.0, 0.35), "1", "rotational fraction in Figs. 3 and 5")
    low_velocity_range: tuple[float, float] = chosen((-0.024, 0.1), "m/s", "impact velocities in Fig. 7")
    low_restitution_range: tuple[float, float] = chosen((-3.0, 4.0), "1", "restitution in Fig. 7")
    lowest_speed: float = stated(0.1, "m/s", "the one speed of Fig. 4 that the text names")
    other_speeds: tuple[float, ...] = chosen((0.2, 0.4, 0.8), "m/s", "the other speeds of Figs. 4 and 5")
    speed_tolerance: float = chosen(0.05, "1", "half-width of the speed windows, as a share of the speed")
    histogram_widths: tuple[float, ...] = chosen(
        (0.024, 0.012, 0.006, 0.002), "1", "restitution bins of Fig. 4"
    )
    histogram_bins: int = chosen(60, "1", "bins in each histogram of Fig. 4, half on either side of ε_n")
    deviation_mesh: float = chosen(0.02, "m/s", "velocity bins of Fig. 6")
    deviation_range: tuple[float, float] = chosen((0.02, 1.1), "m/s", "impact velocities in Fig. 6")
    sensitivity_mesh: float = chosen(0.05, "m/s", "velocity bins, other R and heights")
    sensitivity_range: tuple[float, float] = chosen(
        (0.1, 2.0), "m/s", "impact velocities, other R and heights"
    )
    first_mesh: float = chosen(0.005, "1", "restitution bins of Fig. 9")

    @property
    def speeds(self) -> tuple[float, ...]:
        """The four speeds of Figs. 4 and 5, in m/s, in increasing order."""
        return (self.lowest_speed, *self.other_speeds)

    @property
    def law(self) -> TangentialRestitution:
        """The law of Figs. 2-7 (Eq. 9)."""
        return TangentialRestitution(normal=self.normal, tangential=self.tangential)

    @property
    def first_law(self) -> TangentialRestitution:
        """The law of Fig. 9 (Eq. 9)."""
        return TangentialRestitution(normal=self.first_normal, tangential=self.tangential)

    @property
    def finest(self) -> float:
        """Largest step of which all `histogram_widths` are multiples, if all are whole millionths."""
        return float(np.gcd.reduce(np.rint(1e6 * np.array(self.histogram_widths)).astype(np.int64))) / 1e6

    def histogram_edges(self, width: float, times: int = 1) -> FloatArray:
        """Return edges of bins of this width, so many times those of Fig. 4, half on either side of ε_n."""
        half = self.histogram_bins // 2 * times
        return self.normal + width * np.arange(-half, half + 1, dtype=np.float64)

    @property
    def rolling(self) -> float:
        """E_rot/E_tot of the body of Fig. 2 that rolls end over end, its centre of mass at height R."""
        body = self.body(self.elongation)
        return body.transverse_inertia / (body.transverse_inertia + body.mass * self.radius**2)

    def body(self, elongation: float, radius: float | None = None) -> Dumbbell:
        """Make the dumbbell with this L/R; `radius` is `Settings.radius` unless given."""
        r = self.radius if radius is None else radius
        return Dumbbell(radius=r, separation=elongation * r)
