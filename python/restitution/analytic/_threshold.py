"""The ε_n below which a body that falls from rest can go on downwards after its first impact."""

from __future__ import annotations

import numpy as np

from restitution._internal.parameters import ParameterError, wrong
from restitution.analytic._disc import Number, turned
from restitution.analytic._frozen import check
from restitution.analytic._hull import Outline, Side
from restitution.analytic._impulse import Impulse, Mode
from restitution.analytic._panels import roots
from restitution.bodies import Body, RoughSphere, Turned
from restitution.laws import Law


def negative_threshold(body: Body | RoughSphere | Turned, law: Law) -> float:
    """Return ε_n below which ε < 0 occurs at the first impact from rest; from it on ε >= 0 at every angle.

    In each mode of the contact ε rises with ε_n and is 0 at a closed form in height h and lever arm a; where
    a law has two modes, the one that holds has the greater of the two. Their maximum over all angles is at
    the end of a side of the body, or at a zero of the derivative. docs/first-impact.md has it in closed form.

    Parameters
    ----------
    body : Dumbbell or another body
        The body that is dropped: one of revolution, or a RoughSphere.
    law : TangentialRestitution or another law
        The collision law; its own ``normal`` does not matter.

    Returns
    -------
    float
        Threshold, >= 0 and exact to rounding. If it is more than 1, ε < 0 occurs for every ε_n.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import restitution as rs
    >>> from restitution.analytic import negative_threshold
    >>> body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    >>> round(12 * negative_threshold(body, rs.TangentialRestitution(normal=0.5)), 12)
    5.0
    >>> round(7 * negative_threshold(body, rs.Frictionless(normal=0.5)), 12)
    5.0
    """
    check(body, law)
    if not isinstance(body, Body | RoughSphere | Turned):
        raise ParameterError(wrong("body", body, "a body of revolution, or a RoughSphere"))
    outline = Outline.of(body)
    impulse = Impulse(law, outline.inertia)
    modes = sorted(set(impulse.modes()))
    return max(_greatest(impulse, mode, side) for side in outline.sides for mode in modes)


def _greatest(impulse: Impulse, mode: Mode, side: Side) -> float:
    def threshold(theta: Number) -> Number:
        height, arm = side.hull.contact(*turned(theta))
        return impulse.threshold(mode, height, arm)

    level = roots(threshold, side.low, side.high, derivative=True)
    angles = np.array([side.low, *level, side.high])
    return max(0.0, float(np.max(threshold(angles))))
