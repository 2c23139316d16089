"""The figure: a column for each L/R and a row for each quantity; below, the energy that two laws create."""

from typing import Any, Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from restitution import figures as fg
from restitution.figures.style import DEVIATION, FRACTION, RESTITUTION, VELOCITY, Style, colors, ink

_LINES: tuple[Literal["-", "--", ":"], ...] = ("-", "-", "-", "--", ":", "-")
_VELOCITY_TICKS = (0.03, 0.1, 0.3, 1.0)
_RANGE = (0.018, 1.1)


@fg.styled
def draw(data: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw what `measure` found."""
    columns = data.sizes["elongation"]
    figure, panels = fg.panels(fg.PAGE, 7.6, 4, columns)
    for k in range(columns):
        body = data.isel(elongation=k)
        panels[0][k].set_title(rf"$L/R = {float(body['elongation']):g}$")
        _density(panels[0][k], body)
        _by_velocity(panels[1][k], body, "deviation")
        _by_velocity(panels[2][k], body, "mean_fraction")
        panels[1][k].set_yscale("log")
        panels[2][k].set_ylim(bottom=0.0)
        panels[2][k].yaxis.set_major_locator(MaxNLocator(5))
        panels[2][k].sharex(panels[1][k])
        panels[1][k].tick_params(labelbottom=False)
    for axes in panels[3]:
        axes.remove()
    places = panels[3][0].get_gridspec()
    assert places is not None
    half = columns // 2
    panels[3] = [figure.add_subplot(places[3, :half]), figure.add_subplot(places[3, half:])]
    _created(panels[3][0], data["created_share"], 0.01)
    panels[3][0].set_ylim(0.0, 0.7)
    bodies = [
        Line2D([], [], color=ink(0.6), linestyle="none", marker=marker, label=f"$L/R = {x:g}$")
        for marker, x in zip(fg.MARKERS, data["elongation"].to_numpy(), strict=False)
    ]
    panels[3][0].legend(handles=bodies[1:], loc="upper left", ncols=3, handlelength=0.8)
    _bounds(panels[3][1], data)
    _created(panels[3][1], data["largest_energy_ratio"] - 1.0, 1e-5)
    for row in panels[1:]:
        for axes in row:
            axes.set_xlim(*_RANGE)
            fg.plain_log(axes, _VELOCITY_TICKS)
    for axes in (*panels[2], *panels[3]):
        axes.set_xlabel(VELOCITY)
    labels = (
        rf"$p(\varepsilon\,|\,{float(data.attrs['speed']):g}$ m/s$)$",
        DEVIATION,
        f"mean {FRACTION}",
        "share creating energy",
    )
    letters = iter("abcdefghijklmn")
    for row, label in zip(panels, labels, strict=True):
        row[0].set_ylabel(label)
        for axes in row:
            fg.letter(axes, f"({next(letters)})", left=row is panels[0])
    panels[3][1].set_ylabel("largest relative gain")
    _legend(figure, data)
    figure.align_ylabels([row[0] for row in panels])
    return figure


def _legend(figure: Figure, data: xr.Dataset) -> None:
    names = [str(name).replace("ε_t", r"$\varepsilon_t$") for name in data["law"].values]
    lines = [
        Line2D([], [], color=color, linestyle=style, label=name)
        for name, color, style in zip(names, map(_color, range(len(names))), _LINES, strict=True)
    ]
    lines.append(
        Line2D([], [], color="0.55", linewidth=0.8, linestyle="-.", label=r"bound, $\varepsilon_t$ = 1")
    )
    figure.legend(handles=lines, loc="outside upper center", ncols=4)


def _color(law: int) -> str:
    return colors()[(1, 5, 0, 4, 2, 3)[law]]


def _density(axes: Axes, body: xr.Dataset) -> None:
    for law in range(body.sizes["law"]):
        density = body["density"].isel(law=law)
        axes.plot(
            body["restitution"],
            density.where(density > 0),
            color=_color(law),
            linestyle=_LINES[law],
            drawstyle="steps-mid",
            linewidth=0.8,
        )
    axes.set_yscale("log")
    top, low = float(body["density"].max()), float(body["density"].where(body["density"] > 0).min())
    axes.set_ylim(max(low / 2, 1e-5 * top), 6 * top)
    half = float(body["restitution"][1] - body["restitution"][0]) / 2
    axes.set_xlim(float(body["restitution"][0]) - half, float(body["restitution"][-1]) + half)
    axes.set_xlabel(RESTITUTION)


def _by_velocity(axes: Axes, body: xr.Dataset, name: str) -> None:
    for law in range(body.sizes["law"]):
        values, error = (body[each].isel(law=law).to_numpy() for each in (name, f"{name}_error"))
        fg.line(
            axes,
            body["velocity"].to_numpy(),
            values,
            error,
            color=_color(law),
            linestyle=_LINES[law],
        )


def _created(axes: Axes, values: xr.DataArray, least: float) -> None:
    """Draw a line for each law that creates energy, and each body in which it does, by its marker."""
    velocity = values["velocity"].to_numpy()
    inside = (velocity >= _RANGE[0]) & (velocity <= _RANGE[1])
    for law in range(values.sizes["law"]):
        for k, marker in enumerate(fg.MARKERS[: values.sizes["elongation"]]):
            one = values.isel(law=law, elongation=k).to_numpy()
            if (one[inside] > least).any():
                shown = np.where(one > 0.0, one, np.nan)
                look: dict[str, Any] = {
                    "marker": marker,
                    "markevery": [0, 2, 4, 7, 12, 20, 32],
                    "linewidth": 0.8,
                }
                axes.plot(velocity, shown, color=_color(law), linestyle=_LINES[law], **look)


def _bounds(axes: Axes, data: xr.Dataset) -> None:
    """Draw what no gain of the paper's law exceeds, with the L/R beside it."""
    axes.set_yscale("log")
    axes.set_ylim(1e-5, 20.0)
    for elongation, most in zip(data["elongation"].to_numpy(), data["bound"].to_numpy() - 1.0, strict=True):
        axes.axhline(most, color="0.55", linewidth=0.8, linestyle="-.")
        axes.annotate(
            f"{elongation:g}",
            (1.01, most),
            xycoords=axes.get_yaxis_transform(),
            va="center",
            color=ink(0.6),
            fontsize="small",
        )
