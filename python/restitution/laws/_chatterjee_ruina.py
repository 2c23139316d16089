"""The law of Chatterjee and Ruina."""

from typing import Annotated

from pydantic import Field

from restitution._internal.parameters import Number
from restitution.laws._law import Friction, Law


class ChatterjeeRuina(Law):
    """The algebraic law of Chatterjee and Ruina, J. Appl. Mech. 65, 939 (1998).

    P = (1 + e)P_I + κ(P_II - P_I), with P_I the impulse of a frictionless and P_II that of a sticking plastic
    impact, and κ = 1 + e_t or, where that lies outside the friction cone |P_t| <= μ P_n, the κ at which P is
    on it. ``v_n' = -normal * v_n`` always, and kinetic energy cannot grow.

    Parameters
    ----------
    normal : float, material or callable
        Normal coefficient e, in [0, 1], or a material.
    tangential : float
        Tangential coefficient e_t, in [-1, 1]: -1 is frictionless, 0 sticks, 1 reverses the slip. For a
        sphere it is -ε_t.
    friction : float
        Coefficient of friction μ, in [0, 1e100].

    Examples
    --------
    >>> import restitution as rs
    >>> law = rs.ChatterjeeRuina(normal=0.9, tangential=0.0, friction=0.3)
    """

    tangential: Annotated[Number, Field(ge=-1, le=1)]
    friction: Friction
