"""Dry friction."""

from typing import Annotated, Literal

from restitution._internal.parameters import Allowed
from restitution.laws._law import Friction, Law

Hypothesis = Literal["stronge", "poisson", "newton"]


class Coulomb(Law):
    """Coulomb friction during the impact, with slip that may stop, turn or reverse.

    The impact is followed in the normal impulse (Routh 1860; Wang and Mason, J. Appl. Mech. 59, 635 (1992)):
    in closed form where the slip stays in the vertical plane of the axis, else by an integration to double
    precision. |P_t| <= μ P_n always; the hypotheses differ only where the slip stops or turns during the
    impact.

    Parameters
    ----------
    normal : float, material or callable
        Coefficient of restitution ε_n, in [0, 1], or a material; its meaning depends on the hypothesis.
    friction : float
        Coefficient of friction μ, in [0, 1e100]. 0 is `Frictionless`.
    hypothesis : {"stronge", "poisson", "newton"}, default "stronge"
        When the impact is over. "stronge": the normal force has given back ε_n² of the work that it took
        (Proc. R. Soc. Lond. A 431, 169 (1990)). "poisson": the normal impulse of restitution is ε_n times
        that of compression. "newton": ``v_n' = -normal * v_n``. Kinetic energy cannot grow with the first
        two; with Newton's it can, where the slip stops or reverses.

    Examples
    --------
    >>> import restitution as rs
    >>> law = rs.Coulomb(normal=0.9, friction=0.3)
    """

    friction: Friction
    hypothesis: Annotated[Hypothesis, Allowed("'stronge', 'poisson' or 'newton'")] = "stronge"
