"""A body as a picture: shaded, standing on the plane, with its centre of mass and point of contact."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

from restitution._internal.arrays import FloatArray, real
from restitution._internal.parameters import ParameterError, wrong
from restitution.bodies import ANY_BODIES, AnyBody, Body, RigidBody
from restitution.figures.scene import _grain as grain
from restitution.figures.scene import _solid as solid
from restitution.figures.scene import _vectors as draw
from restitution.figures.style import COLUMN, Style, ink, panels, points, styled

_ASIDE, _TOWARDS = 0.6, 0.45
"""Angles in rad at which one sees three sides of a box."""


@styled
def body(body: AnyBody, angle: float = math.radians(50.0), *, style: Style | None = None) -> Figure:
    """Draw a body as it touches the plane, with centre of mass, axis, point of contact and a scale bar.

    End 1 of the axis is blue, end 2 orange. The axis of a body without one, as of a box, is its own z; it
    leans towards the reader, too, so that one sees its shape.

    Parameters
    ----------
    body : Dumbbell or another body
        What is drawn.
    angle : float
        Angle θ between the axis and the plane normal, in rad; the axis leans to the right.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> import restitution as rs
    >>> figure = rs.figures.body(rs.Spheroid(equatorial=2e-3, polar=3e-3), angle=1.0)
    """
    if not isinstance(body, AnyBody):
        raise ParameterError(wrong("body", body, ANY_BODIES))
    angle = real("angle", angle, "an angle in rad, in [-2 pi, 2 pi]", lambda x: abs(x) <= 2.0 * math.pi)
    figure, [[axes]] = panels(0.5 * COLUMN, 0.5 * COLUMN)
    axis = np.array([math.sin(angle), math.cos(angle), 0.0])
    size = 1e3 * body.compiled.farthest()
    if isinstance(body, RigidBody):
        attitude = _attitude(angle)
        contact, pixels = 1e3 * grain.lowest(body, attitude), grain.picture(body, attitude)
    else:
        assert isinstance(body, Body)
        contact, pixels = 1e3 * solid.contact_point(body, axis), solid.picture(body, axis)
    centre = np.array([0.0, -contact[1] / 1e3, 0.0])
    draw.stage(axes, 0.0, 1.3 * size, 0.2 * size, (-0.6 * size, 2.2 * size))
    draw.scale_bar(axes, -1.2 * size, -0.42 * size, 1.5 * size)
    solid.put(axes, body, pixels, centre)
    if isinstance(body, Body):
        ends = np.array([-1.2, 1.2])[:, None] * size * axis[:2] + 1e3 * centre[:2]
        axes.plot(*ends.T, color=ink(0.6), linewidth=points(0.7), linestyle=(0, (6, 2, 1, 2)), zorder=3.0)
    draw.marks(axes, 1e3 * centre, contact * [1.0, 0.0, 0.0])
    return figure


def _attitude(angle: float) -> FloatArray:
    """Turn the axes of a body into the picture's: about its own z, towards the reader, to the right."""
    upright = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    about = Rotation.from_euler("yxz", [_ASIDE, _TOWARDS, -angle]).as_matrix()
    attitude: FloatArray = about @ upright
    return attitude
