"""`restitution template`: a commented TOML file with all parameters of a run."""

from restitution._internal.process import say

TEMPLATE = """\
# What restitution simulate, statistics, compare and distribution read. SI units throughout: m, kg, s, rad.
# What is commented out is another choice, or a default that may be left out.

[body]                            # for compare: a table [[body]] for each, perhaps with name = "..."
shape = "dumbbell"
radius = 3e-3                     # R of both spheres, > 0; or of each: [3e-3, 2e-3]
separation = 3e-4                 # L, distance of the centres, >= 0; 0 is a sphere
# density = 2500.0                # kg/m^3, > 0; or of each sphere
# [body]
# shape = "spherocylinder"        # a cylinder with hemispherical caps: radius, separation, density
# [body]
# shape = "loaded-sphere"         # radius, density, load (kg), offset (of the load from the centre)
# [body]
# shape = "spheroid"              # equatorial, polar (semi-axes), density

[law]                             # for compare: a table [[law]] for each, perhaps with name = "..."
type = "tangential-restitution"   # Eq. 9 of Phys. Rev. E 90, 052204
normal = 0.98                     # in [0, 1]; or a table [law.normal], see below
# tangential = 1.0                # in [-1, 1]
# [law]
# type = "frictionless"           # normal
# [law]
# type = "coulomb"                # normal, friction, hypothesis = "stronge", "poisson" or "newton"
# [law]
# type = "chatterjee-ruina"       # normal, tangential, friction

# [law.normal]                    # instead of the number: a coefficient that depends on the speed
# type = "viscoelastic"           # young_modulus (Pa), poisson_ratio, dissipation (s), density, radius
# [law.normal]
# type = "plastic"                # yield_speed (m/s)
# [law.normal]
# type = "tabulated"              # v = [0.1, 1.0] (m/s), e = [0.97, 0.92]
# [law.normal]
# type = "scattered"              # drawn at every impact: normal = 0.98 (or a table), deviation = 0.01

[run]
# particles = 1000
# impacts = 400                   # the most of each particle
# release_height = 0.06           # of the centre of mass
# gravity = 9.81
# orientation = "uniform-angle"   # or "isotropic"; or angles, one per particle: [0.1, 0.7]
# spin = [0.0, 0.0, 0.0]          # rad/s; or one per particle: [[0.0, 5.0, 0.0], ...]
# release_velocity = [0.0, 0.0, 0.0]  # m/s; z is the plane normal, x down the slope
# incline = 0.0                   # of the plane
# minimum_speed = 0.0             # a particle ends when it is slower after an impact; 0 never ends one
# seed = 1                        # in [0, 2**64)

# [run.release_height]            # instead of the number: drawn for each particle
# lowest = 0.05
# highest = 0.07
# [run.spin]                      # instead of the list: drawn for each particle
# rate = [0.0, 50.0]              # rad/s, from and to; or one number
# axis = "isotropic"              # or "horizontal", "across" the symmetry axis; or "thermal", of rms rate

[statistics]                      # for statistics and compare
velocity_bins = 120               # a number with a range, or a list of edges
velocity_range = [0.0, 1.2]       # m/s
restitution_bins = 400
restitution_range = [-1.0, 3.0]
# fraction_bins = 50              # of E_rot/E_tot
# fraction_range = [0.0, 1.0]
# counts_only = false             # true: no moments, and quicker

[distribution]                    # for distribution
# velocities = [0.04, 0.4]        # m/s, from and to
# given = "rotational_fraction"   # or "previous"
# heights_about = 0.06            # spread about this one where no release_height is given
# release_height = [0.05, 0.06]   # in equal parts from each, instead of the height of [run]
"""


def template() -> None:
    """Print a commented RUN.toml with all bodies, laws and options, to be edited."""
    say(TEMPLATE.removesuffix("\n"))
