"""The scatter of ε in closed form, of a nearly round ball and of a rough one.

Of a nearly round ball it is to lowest order in its out-of-roundness. The normal of a contact passes the
centre of mass at the distance d, the lever arm: the derivative of the support function h(θ) by the angle.
From (10) and (11), to second order in d and in the spin ω,

    ε - ε_n = -c (q d² + ω d/v),    Δω = c q v d,    c = 1 + ε_n,

with q = m/J under the frictionless law, and q = m/(J + m R²) where the tangential velocity of the contact
point is kept (ε_t = 1): the kick is that of the ball about its contact. The angle then turns by 2 v' ω/g
until the next impact. This is the map of a kicked rotor, with the kick parameter K = 2 c q ε_n v² |h''|/g.

Where K is far above 1 the angles are independent, and ω grows as a random walk, up to corrections
that oscillate as 2 J_2(K) (Rechester and White, Phys. Rev. Lett. 44, 1586 (1980)). Where K is far below 1 the
ball swings slowly about an angle where h is least. A clock then hardly sees the shape: the gap below the ball
falls with g + h'' ω², and it is the contact point that comes back with ε_n: times give ε_n up to h'' ω²/g.

Of a rough ball it follows from what its surface is known by: Ra, the mean distance of a profile from its mean
line. Heights that are exponentially distributed with mean h_0 have Ra = 2 h_0/e. A sphere with many such
asperities touches with one at the distance d from the vertical through its centre, ⟨d²⟩ = 2 h_0 R, whatever
their number, and docs/rough.md gives

    ε - ε_n = c (ω d/v - q d²),    Δω = c q v d,    c = 1 + ε_n,

with q as for a nearly round ball; contacts are met in proportion to their speed of approach, so that ω d/v
has the mean ⟨ω²d²⟩/v². Contacts of different impacts are independent. Asperities are rigid: those of a real
ball are pressed flat by an impact, and what is found here is the most that roughness can do.
"""

import numpy as np

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.parameters import ParameterError, wrong
from restitution.bodies import Body, Dumbbell, LoadedSphere, Spheroid
from restitution.experiment.budget._sources import Source, nothing
from restitution.experiment.budget.experiment import HEIGHT, ROUGHEST, Experiment, coupling, mean_radius


def near_round(experiment: Experiment, body: Body) -> tuple[Array, Array, Array] | None:
    """Return what ε does where the angles are independent; None for laws and bodies not worked out here.

    Returns
    -------
    kick : ndarray, shape (n,)
        K of each impact, dimensionless.
    bias : ndarray, shape (n,)
        Of ε, -c q ⟨d²⟩.
    deviation : ndarray, shape (n,)
        Standard deviation of ε, c ((⟨ω²⟩ ⟨d²⟩ + s)/v² + q² var(d²))^½ with ⟨ω²⟩ = q² ⟨d²⟩ Σ c² v² over the
        impacts before. A spin ω_0 at release, of any direction, changes h with ⟨(dh/dt)²⟩ = s,
        (8/45) t² ω_0² where h = t cos² θ and (2/9) t² ω_0² where it is t cos θ: averages over the directions
        of axis and spin.
    """
    q = coupling(experiment.law, body)
    if q is None or len(experiment.laws) > 1:
        return None
    match body:
        case Spheroid():
            t, curvature, turned = abs(body.polar - body.equatorial), 2.0, 8.0 / 45.0
        case Dumbbell(is_equal=True):
            t, curvature, turned = 0.5 * body.separation, 1.0, 2.0 / 9.0
        case LoadedSphere():
            t, curvature, turned = body.centre_of_mass, 1.0, 2.0 / 9.0
        case _:
            return None
    square = 0.5 * t**2  # ⟨d²⟩, d = t sin of an angle that is uniform
    variance = 0.5 * square**2  # of d²
    v, e = experiment.speed, experiment.coefficient
    c = 1.0 + e
    before = np.concatenate([[0.0], np.cumsum((c * v) ** 2)[:-1]])
    spin = turned * (t * experiment.setting.spin) ** 2
    kick = 2.0 * c * q * e * v**2 * curvature * t / experiment.setting.gravity
    deviation = c * np.sqrt((spin + q**2 * square**2 * before) / v**2 + q**2 * variance)
    return kick, -c * q * square, deviation


def roughness(experiment: Experiment, body: Body) -> Source:
    """Take the roughness alone, of a round ball with its mass and inertia, with the spin at its release.

    A smooth ball has no error, whatever the law.

    Raises
    ------
    ValueError
        If the closed form is not known for the law, or the ball too rough for it.
    """
    rough = experiment.setting.roughness
    if rough == 0.0:
        return nothing(experiment.setting.impacts)
    radius = mean_radius(body)
    if not rough <= ROUGHEST * radius:
        allowed = f"at most {ROUGHEST:g} of the radius, {ROUGHEST * radius:.6g} m"
        raise ParameterError(wrong("roughness", rough, allowed))
    sources = []
    for known in experiment.laws:
        q = coupling(known, body)
        if q is None:
            allowed = "0 but for Frictionless, tangential = 1, or Coulomb with friction >= 0.1"
            raise ParameterError(wrong("roughness", rough, allowed))
        sources.append(_of_one(experiment, q, 2.0 * HEIGHT * rough * radius))
    bias = np.mean([one.bias for one in sources], axis=0)
    second = np.mean([one.covariance + np.outer(one.bias, one.bias) for one in sources], axis=0)
    return Source(bias, second - np.outer(bias, bias))


def _of_one(experiment: Experiment, q: float, square: float) -> Source:
    """Return the errors with one q, of lever arms with ⟨d²⟩ in m², of either component half."""
    v, e = experiment.speed, experiment.coefficient
    c = 1.0 + e
    kicks = 0.5 * square * np.concatenate([[0.0], np.cumsum((c * q * v) ** 2)[:-1]])
    spin = kicks + experiment.setting.spin**2 / 3.0  # ⟨ω²⟩ of a horizontal component
    bias = c * square * (spin / v**2 - q)
    # That of an asymmetric Laplace density: σ² + μ².
    return Source(bias, np.diag(c**2 * square * spin / v**2 + bias**2))
