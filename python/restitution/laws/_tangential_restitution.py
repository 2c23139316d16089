"""The paper's law."""

from typing import Annotated

from pydantic import Field

from restitution._internal.parameters import Number
from restitution.laws._law import Law


class TangentialRestitution(Law):
    """The paper's law: both components of the contact velocity change by a fixed factor (Eq. 9).

    ``v_n' = -normal * v_n`` and ``v_t' = tangential * v_t`` for the velocity of the contact point.

    ``tangential = 1`` is not frictionless for a body that is not a sphere: keeping the tangential contact
    velocity takes a tangential impulse, which can do positive work and lie outside every friction cone.
    Kinetic energy can grow; it cannot for a sphere, nor where ``tangential = -normal``. Watch
    ``energy_ratio`` in the results.

    Parameters
    ----------
    normal : float, material or callable
        Normal coefficient of restitution ε_n at the contact point, in [0, 1], or a material.
    tangential : float, default 1
        Tangential coefficient of restitution ε_t at the contact point, in [-1, 1]. Kinetic theory writes
        β = -ε_t.

    Examples
    --------
    >>> import restitution as rs
    >>> law = rs.TangentialRestitution(normal=0.98, tangential=1.0)
    """

    tangential: Annotated[Number, Field(ge=-1, le=1)] = 1.0
