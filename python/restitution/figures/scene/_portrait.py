"""A body as a picture: shaded, standing on the plane, with its centre of mass and point of contact."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from restitution._internal.arrays import real
from restitution._internal.parameters import ParameterError, wrong
from restitution.bodies import BODIES, Body
from restitution.figures.scene import _solid as solid
from restitution.figures.scene import _vectors as draw
from restitution.figures.style import COLUMN, Style, ink, panels, points, styled


@styled
def body(body: Body, angle: float = math.radians(50.0), *, style: Style | None = None) -> Figure:
    """Draw a body as it touches the plane, with centre of mass, axis, point of contact and a scale bar.

    The brighter end is end 2 of the axis.

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
    if not isinstance(body, Body):
        raise ParameterError(wrong("body", body, BODIES))
    angle = real("angle", angle, "an angle in rad, in [-2 pi, 2 pi]", lambda x: abs(x) <= 2.0 * math.pi)
    figure, [[axes]] = panels(0.5 * COLUMN, 0.5 * COLUMN)
    portrait(axes, body, angle)
    return figure


def portrait(axes: Axes, body: Body, angle: float) -> None:
    """Draw the body into a panel."""
    axis = np.array([math.sin(angle), math.cos(angle), 0.0])
    contact = 1e3 * solid.contact_point(body, axis)
    centre = np.array([0.0, -contact[1] / 1e3, 0.0])
    size = 1e3 * solid.reach(body)
    draw.bare(axes)
    draw.plane(axes, 0.0, 1.3 * size, 0.2 * size)
    draw.scale_bar(axes, -1.2 * size, -0.42 * size, 1.5 * size)
    solid.place(axes, body, axis, centre)
    ends = np.array([-1.2, 1.2])[:, None] * size * axis[:2] + 1e3 * centre[:2]
    axes.plot(*ends.T, color=ink(0.6), linewidth=points(0.7), linestyle=(0, (6, 2, 1, 2)), zorder=3.0)
    draw.marks(axes, 1e3 * centre, contact * [1.0, 0.0, 0.0])
    axes.set_xlim(-1.3 * size, 1.3 * size)
    axes.set_ylim(-0.6 * size, 2.2 * size)
