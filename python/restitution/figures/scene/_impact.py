"""One impact as a drawing: the body, its point of contact and lever arm, and what the impulse changes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from restitution._internal.arrays import FARTHEST, FloatArray, check_each, whole
from restitution._internal.parameters import ParameterError, Problem
from restitution.drop.recorded import RECORDS, check_frame, variables
from restitution.drop.trajectory import times_of
from restitution.figures.scene import _solid as solid
from restitution.figures.scene import _vectors as draw
from restitution.figures.style import COLUMN, Style, colors, panels, points, styled

if TYPE_CHECKING:
    import xarray as xr

    from restitution.bodies import Body

_VECTORS = (
    "position",
    "axis",
    "velocity_before",
    "velocity_after",
    "angular_velocity_before",
    "angular_velocity_after",
)
_NEEDED = dict.fromkeys(("time", "impact_velocity", "restitution", "contact"), RECORDS) | dict.fromkeys(
    _VECTORS, (*RECORDS, "component")
)
LARGEST_TURN = np.radians(200.0)
"""Of the arc that stands for the largest angular velocity."""


@dataclass(frozen=True)
class Impact:
    """An impact, its vectors in the frame of a picture: right, up, towards the reader."""

    time: float
    speed: float  # impact velocity v_G^n
    restitution: float
    centre: FloatArray
    axis: FloatArray
    contact: FloatArray
    velocity: tuple[FloatArray, FloatArray]  # before, after
    rotation: tuple[FloatArray, FloatArray]

    @property
    def impulse(self) -> FloatArray:
        """P/m."""
        return self.velocity[1] - self.velocity[0]


@dataclass(frozen=True)
class Sideview:
    """The impacts of a particle, seen along the plane and across the axis of the body at the first."""

    body: Body
    frame: FloatArray  # rows: right, up, towards the reader
    impacts: tuple[Impact, ...]

    @classmethod
    def of(cls, data: xr.Dataset, particle: int, first: int, last: int, *, name: str) -> Sideview:
        """Read the impacts from `first` to `last`, as the argument `name` says, of a run with states."""
        if "attitude" in getattr(data, "variables", ()):
            text = f" is of {data.attrs.get('body')}: must be of a body with an axis, seen from aside"
            raise ParameterError(Problem("data", text))
        found = variables("data", data, 'restitution.simulate(..., record="state")', _NEEDED)
        check_frame("data", data)
        body = solid.body_of(data)
        particle = whole("particle", particle, 0, data.sizes["particle"] - 1)
        one = {key: values[particle] for key, values in zip(_NEEDED, found, strict=True)}
        happened = times_of(one["time"]).size
        if happened == 0:
            raise ParameterError(Problem("particle", f" = {particle}: must be one that has an impact"))
        first = whole(name, first, 0, happened - 1)
        last = whole(name, last, first, happened - 1)
        _check({key: values[first : last + 1] for key, values in one.items()})
        frame = _frame(one["axis"][first])
        impacts = []
        for i in range(first, last + 1):
            vectors = {key: frame @ one[key][i] for key in _VECTORS}
            contact = solid.contact_point(body, vectors["axis"], int(one["contact"][i]))
            impacts.append(
                Impact(
                    float(one["time"][i]),
                    float(one["impact_velocity"][i]),
                    float(one["restitution"][i]),
                    vectors["position"],
                    vectors["axis"],
                    vectors["position"] + contact,
                    (vectors["velocity_before"], vectors["velocity_after"]),
                    (vectors["angular_velocity_before"], vectors["angular_velocity_after"]),
                )
            )
        return cls(body, frame, tuple(impacts))

    @property
    def reach(self) -> float:
        """Largest distance of the surface from the centre of mass, in mm."""
        return 1e3 * self.body.compiled.farthest()

    @property
    def scales(self) -> tuple[float, float]:
        """Length in m of 1 m/s, and angle in rad of 1 rad/s, at which the arrows have room."""
        speeds = [v for one in self.impacts for v in (*one.velocity, one.impulse)]
        turns = [abs(float(w[2])) for one in self.impacts for w in one.rotation]
        fastest = max(float(np.hypot(v[0], v[1])) for v in speeds)
        return 1.15 * self.body.compiled.farthest() / (fastest or 1.0), LARGEST_TURN / (max(turns) or 1.0)


def _check(one: dict[str, FloatArray]) -> None:
    """Refuse what cannot be drawn."""
    for key, values in one.items():
        allowed = f"a finite number, at most {FARTHEST:g} either way"
        check_each(f"data.{key}", values, np.abs(values) <= FARTHEST, allowed)
    check_each(
        "data.contact", one["contact"], np.isin(one["contact"], (1, 2)), "1 or 2, the end that touches"
    )
    length = np.linalg.norm(one["axis"], axis=1)
    check_each("data.axis", length, np.abs(length - 1.0) < 1e-6, "of length 1")


def _frame(axis: FloatArray) -> FloatArray:
    """Return the directions to the right, in which the axis leans, up and towards the reader."""
    length = float(np.hypot(axis[0], axis[1]))
    right = np.array([axis[0], axis[1], 0.0]) / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])
    up = np.array([0.0, 0.0, 1.0])
    return np.stack([right, up, np.cross(right, up)])


@styled
def impact(data: xr.Dataset, particle: int = 0, impact: int = 0, *, style: Style | None = None) -> Figure:
    """Draw an impact before and after: body, point of contact, lever arm, v, ω and P.

    The body is seen along the plane, across its axis. P is drawn per mass and on the scale of the velocities,
    so that v and P/m add up to v'; of ω the part across the picture is drawn, counter-clockwise or clockwise.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts from `restitution.simulate` with ``record="state"``.
    particle, impact : int
        Which one of its impacts.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Returns
    -------
    matplotlib.figure.Figure

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.simulate(
    ...     rs.Dumbbell(radius=3e-3, separation=6e-3), rs.Coulomb(normal=0.9, friction=0.3), particles=1,
    ...     impacts=3, record="state")
    >>> figure = rs.figures.impact(data, impact=2)
    """
    view = Sideview.of(data, particle, impact, impact, name="impact")
    figure, [[before, after]] = panels(1.45 * COLUMN, 2.2, columns=2)
    for axes, when in ((before, 0), (after, 1)):
        _draw(axes, view, when)
    return figure


def _draw(axes: Axes, view: Sideview, when: int) -> None:
    one, body, far = view.impacts[0], view.body, view.reach
    centre, contact = 1e3 * one.centre[:2], 1e3 * one.contact[:2]
    x, top = centre[0], centre[1] + (draw.ARC + 0.3) * far
    draw.stage(axes, x, 1.9 * far, 0.25 * far, (-0.6 * far, top))
    draw.scale_bar(axes, x - 1.9 * far, -0.5 * far, 2.0 * far)
    solid.put(axes, body, solid.picture(body, one.axis), one.centre)
    beyond = one.velocity[when][:2]
    if when == 0:  # the lever arm
        axes.plot(*zip(centre, contact, strict=True), color="black", linewidth=points(1.0), zorder=3.0)
        arm, v = contact - centre, one.velocity[0]
        aside = 1.0 if arm[0] * v[1] >= arm[1] * v[0] else -1.0  # the side on which v is
        middle = 0.4 * centre + 0.6 * contact
        name = axes.text(
            middle[0],
            middle[1],
            r"  $\mathbf{r}_c$  ",
            ha="right" if aside > 0.0 else "left",
            va="center",
            zorder=5.0,
        )
        name.set_path_effects(draw.halo())
        beyond = np.array([aside, 0.0])  # at the tip of v are the plane and the point of contact
    draw.marks(axes, centre, contact)
    length, angle = view.scales
    v, w = one.velocity[when], float(one.rotation[when][2])
    prime = "\N{PRIME}" if when else ""  # a letter: as a superscript of a bold one it floats off
    draw.arrow(axes, centre, 1e3 * length * v[:2], draw.VELOCITY)
    tip = centre + 1e3 * length * v[:2]
    _label(axes, tip, beyond, rf"$\mathbf{{v}}${prime}", draw.VELOCITY)
    if abs(angle * w) > 0.02:
        draw.turn(axes, centre, draw.ARC * far, angle * w, draw.ROTATION)
        phi = 0.5 * (np.pi + angle * w)  # where the arc ends
        way = np.array([np.cos(phi), np.sin(phi)])
        _label(axes, centre + draw.ARC * far * way, way, rf"$\boldsymbol{{\omega}}${prime}", draw.ROTATION)
    if when:
        push = 1e3 * length * one.impulse[:2]
        draw.arrow(axes, contact, push, draw.IMPULSE)
        # Beside its middle: at the tip is the centre of mass, with the velocity.
        middle = contact + 0.5 * push
        away = np.array([1.0 if middle[0] > centre[0] else -1.0, 0.0])
        _label(axes, middle, away, r"$\mathbf{P}/m$", draw.IMPULSE, 14.0)
    told = (
        rf"after: $\varepsilon = {one.restitution:.2f}$"
        if when
        else rf"before: $v_G^n = {one.speed:.3g}$ m/s"
    )
    axes.set_title(told.replace("-", "\N{MINUS SIGN}"))


def _label(axes: Axes, at: FloatArray, along: FloatArray, text: str, number: int, far: float = 7.0) -> None:
    """Write the name of an arrow so many points beyond its tip."""
    size = float(np.hypot(*along)) or 1.0
    offset = points(far) * np.asarray(along) / size
    name = axes.annotate(
        text,
        tuple(at),
        tuple(offset),
        textcoords="offset points",
        color=colors()[number],
        ha="center",
        va="center",
        zorder=6.0,
    )
    name.set_path_effects(draw.halo())
