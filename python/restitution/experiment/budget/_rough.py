"""The scatter of ε of a rough ball in closed form, of what its surface is known by: Ra.

Ra is the mean distance of a profile from its mean line. Heights that are exponentially distributed with mean
h_0 have Ra = 2 h_0/e. A sphere with many such asperities touches with one at the distance d from the vertical
through its centre, ⟨d²⟩ = 2 h_0 R, whatever their number, and docs/rough.md gives

    ε - ε_n = c (ω d/v - q d²),    Δω = c q v d,    c = 1 + ε_n,

with q as for a nearly round ball; contacts are met in proportion to their speed of approach, so that ω d/v
has the mean ⟨ω²d²⟩/v². Contacts of different impacts are independent. Asperities are rigid: those of a real
ball are pressed flat by an impact, and what is found here is the most that roughness can do.
"""

import numpy as np

from restitution._internal.parameters import ParameterError, wrong
from restitution.bodies import Body
from restitution.experiment.budget._sources import Source, nothing
from restitution.experiment.budget.experiment import HEIGHT, ROUGHEST, Experiment, coupling, mean_radius


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
