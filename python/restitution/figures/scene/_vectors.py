"""Plane, scale bar, and arrows for velocity, rotation and impulse, drawn around a body."""

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import FancyArrowPatch, Rectangle
from matplotlib.path import Path
from matplotlib.patheffects import withStroke

from restitution._internal.arrays import FloatArray
from restitution.figures.style import colors, ink, points

VELOCITY, ROTATION, IMPULSE, CONTACT = 2, 3, 5, 1
"""Numbers of the colours of v, ω, P and the point of contact, those of the explorer."""

ARC = 1.12
"""Radius of the arc that stands for ω, in reaches of the body."""


def stage(axes: Axes, middle: float, half: float, depth: float, ends: tuple[float, float]) -> None:
    """Draw the plane at height 0 on both sides of `middle`, with strokes that are fixed to it; all in mm.

    Of the panel nothing is left but its contents, with equal scales, between these heights.
    """
    axes.set_axis_off()
    axes.set_aspect("equal")
    left, right = middle - half, middle + half
    axes.set_xlim(left, right)
    axes.set_ylim(*ends)
    axes.add_patch(Rectangle((left, -depth), 2.0 * half, depth, facecolor=ink(0.12), linewidth=0))
    first, last = int(np.floor(left / depth)) - 1, int(np.ceil(right / depth)) + 1
    strokes = [[(depth * k, -depth), (depth * (k + 0.8), 0.0)] for k in range(first, last)]
    lines = LineCollection(strokes, colors=ink(0.35), linewidths=points(0.8))
    lines.set_clip_path(Rectangle((left, -depth), 2.0 * half, depth, transform=axes.transData))
    axes.add_collection(lines, autolim=False)
    axes.plot([left, right], [0.0, 0.0], color=ink(), linewidth=points(1.0), zorder=1.0)


def scale_bar(axes: Axes, left: float, below: float, size: float) -> None:
    """Draw a bar of a round length, a third of `size` or less, with its length; all in mm."""
    wanted = size / 3.0
    power = 10.0 ** np.floor(np.log10(wanted))
    length = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= wanted)
    axes.plot(
        [left, left + length], [below, below], color=ink(), linewidth=points(2.0), solid_capstyle="butt"
    )
    label = f"{length:g} mm" if length >= 0.1 else f"{1e3 * length:g} µm"
    axes.text(left + 1.05 * length, below, f" {label}", va="center", ha="left", fontsize="small")


def arrow(axes: Axes, start: FloatArray, along: FloatArray, number: int) -> None:
    """Draw an arrow in mm from `start`; one that would be a head alone is left out."""
    tip = np.asarray(start) + along
    if np.hypot(*along) > 0.0:
        _put(axes, Path([tuple(start), tuple(tip)]), number)


def turn(axes: Axes, centre: FloatArray, radius: float, angle: float, number: int) -> None:
    """Draw an arc with an arrow about `centre`, from the top on by `angle` counter-clockwise."""
    phi = 0.5 * np.pi + np.linspace(-0.5, 0.5, 41) * angle
    line = np.asarray(centre) + radius * np.column_stack([np.cos(phi), np.sin(phi)])
    if abs(angle) > 0.02:
        _put(axes, Path(line), number)


def halo() -> list[Any]:
    """Return what sets arrows and letters off from a body behind them."""
    return [withStroke(linewidth=points(2.6), foreground=mpl.rcParams["axes.facecolor"], alpha=0.75)]


def _put(axes: Axes, path: Path, number: int) -> None:
    patch = FancyArrowPatch(
        path=path,
        arrowstyle="-|>,head_length=0.45,head_width=0.22",
        mutation_scale=points(11.0),
        color=colors()[number],
        linewidth=points(1.6),
        shrinkA=0,
        shrinkB=0,
        zorder=4.0,
        joinstyle="miter",
        path_effects=halo(),
    )
    axes.add_patch(patch)


def marks(axes: Axes, centre: FloatArray, contact: FloatArray | None) -> None:
    """Mark the centre of mass and, where there is one, the point of contact; in mm."""
    axes.plot(*centre[:2], marker="+", color="black", markersize=points(6.0), zorder=3.5, path_effects=halo())
    if contact is not None:
        edge: dict[str, Any] = {"markeredgecolor": "black", "markeredgewidth": points(0.7)}
        axes.plot(*contact[:2], "o", color=colors()[CONTACT], zorder=5.0, clip_on=False, **edge)
