"""The law without friction."""

from restitution.laws._law import Law


class Frictionless(Law):
    """An impulse along the plane normal alone, P = (1 + ε_n)|v_n|/K_nn, so that ``v_n' = -normal * v_n``.

    The horizontal velocity of the centre of mass and the angular momentum about the plane normal are
    conserved. Kinetic energy falls by (1 - ε_n²)v_n²/(2K_nn) and cannot grow.

    Parameters
    ----------
    normal : float, material or callable
        Normal coefficient of restitution ε_n at the contact point, in [0, 1], or a material.

    Examples
    --------
    >>> import restitution as rs
    >>> law = rs.Frictionless(normal=0.98)
    """
