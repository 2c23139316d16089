"""The scatter of ε of a nearly round ball in closed form, to lowest order in its out-of-roundness.

The normal of a contact passes the centre of mass at the distance d, the lever arm: the derivative of the
support function h(θ) by the angle. From (10) and (11), to second order in d and in the spin ω,

    ε - ε_n = -c (q d² + ω d/v),    Δω = c q v d,    c = 1 + ε_n,

with q = m/J under the frictionless law, and q = m/(J + m R²) where the tangential velocity of the contact
point is kept (ε_t = 1): the kick is that of the ball about its contact. The angle then turns by 2 v' ω/g
until the next impact. This is the map of a kicked rotor, with the kick parameter K = 2 c q ε_n v² |h''|/g.

Where K is far above 1 the angles are independent, and ω grows as a random walk, up to corrections
that oscillate as 2 J_2(K) (Rechester and White, Phys. Rev. Lett. 44, 1586 (1980)). Where K is far below 1 the
ball swings slowly about an angle where h is least. A clock then hardly sees the shape: the gap below the ball
falls with g + h'' ω², and it is the contact point that comes back with ε_n: times give ε_n up to h'' ω²/g.
"""

from dataclasses import dataclass

import numpy as np

from restitution._internal.arrays import FloatArray as Array
from restitution.bodies import Body, Dumbbell, LoadedSphere, Spheroid
from restitution.experiment.budget.experiment import Experiment, coupling


@dataclass(frozen=True)
class NearRound:
    """Bias and standard deviation of ε of n impacts where the angles are independent.

    Attributes
    ----------
    kick : ndarray, shape (n,)
        K of each impact, dimensionless.
    bias : ndarray, shape (n,)
        -c q ⟨d²⟩.
    deviation : ndarray, shape (n,)
        c ((⟨ω²⟩ ⟨d²⟩ + s)/v² + q² var(d²))^½ with ⟨ω²⟩ = q² ⟨d²⟩ Σ c² v² over the impacts before. A spin ω_0
        at release, of any direction, changes h with ⟨(dh/dt)²⟩ = s, (8/45) t² ω_0² where h = t cos² θ and
        (2/9) t² ω_0² where it is t cos θ: averages over the directions of axis and spin.
    """

    kick: Array
    bias: Array
    deviation: Array


def near_round(experiment: Experiment, body: Body) -> NearRound | None:
    """Return the limit, or None for laws and bodies for which they are not worked out here."""
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
    return NearRound(
        kick=2.0 * c * q * e * v**2 * curvature * t / experiment.setting.gravity,
        bias=-c * q * square,
        deviation=c * np.sqrt((spin + q**2 * square**2 * before) / v**2 + q**2 * variance),
    )
