"""The figure: a column for each L/R, a row for each quantity, a line for each law."""

from typing import Literal

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

from restitution import figures as fg

_LINES: tuple[Literal["-", "--", ":"], ...] = ("-", "-", "-", "--", ":", "-")
_COLORS = ("#D55E00", "#000000", "#0072B2", "#56B4E9", "#009E73", "#CC79A7")
_VELOCITY_TICKS = (0.03, 0.1, 0.3, 1.0)
_RANGE = (0.018, 1.1)
_LETTERS = "abcdefghijklmnopqrst"
_VELOCITY = r"impact velocity $v_G^n$ (m/s)"


@fg.styled
def draw(data: xr.Dataset) -> Figure:
    """Draw what `measure` found."""
    columns = data.sizes["elongation"]
    figure, panels = fg.panels(fg.PAGE, 8.8, 5, columns)
    for k in range(columns):
        body = data.isel(elongation=k)
        panels[0][k].set_title(rf"$L/R = {float(body['elongation']):g}$", fontsize=9.0)
        _density(panels[0][k], body)
        _by_velocity(panels[1][k], body, "deviation", logarithmic=True)
        _by_velocity(panels[2][k], body, "mean_fraction")
        _by_velocity(panels[3][k], body, "created_share", only_created=True)
        _gain(panels[4][k], body)
        for row in panels[1:]:
            row[k].set_xlim(*_RANGE)
            fg.plain_log(row[k], _VELOCITY_TICKS)
            row[k].sharex(panels[1][k])
        for row in panels[1:-1]:
            row[k].tick_params(labelbottom=False)
        panels[4][k].set_xlabel(_VELOCITY)
    labels = (
        rf"$p(\varepsilon\,|\,{float(data.attrs['speed']):g}$ m/s$)$",
        r"standard deviation $\sigma(\varepsilon)$",
        r"mean $E_\mathrm{rot}/E_\mathrm{tot}$",
        "share creating energy",
        "largest relative gain",
    )
    for number, (row, label) in enumerate(zip(panels, labels, strict=True)):
        row[0].set_ylabel(label)
        for k, axes in enumerate(row):
            fg.letter(axes, f"({_LETTERS[number * columns + k]})", left=number == 0)
    _legend(figure, data)
    figure.align_ylabels([row[0] for row in panels])
    return figure


def _legend(figure: Figure, data: xr.Dataset) -> None:
    names = [str(name).replace("ε_t", r"$\varepsilon_t$") for name in data["law"].values]
    lines = [
        Line2D([], [], color=color, linestyle=style, label=name)
        for name, color, style in zip(names, _COLORS, _LINES, strict=True)
    ]
    lines.append(
        Line2D([], [], color="0.55", linewidth=0.8, linestyle="-.", label=r"bound, $\varepsilon_t$ = 1")
    )
    figure.legend(handles=lines, loc="outside upper center", ncols=4)


def _density(axes: Axes, body: xr.Dataset) -> None:
    for law in range(body.sizes["law"]):
        density = body["density"].isel(law=law)
        axes.plot(
            body["restitution"],
            density.where(density > 0),
            color=_COLORS[law],
            linestyle=_LINES[law],
            drawstyle="steps-mid",
            linewidth=0.8,
        )
    axes.set_yscale("log")
    top, low = float(body["density"].max()), float(body["density"].where(body["density"] > 0).min())
    axes.set_ylim(max(low / 2, 1e-5 * top), 6 * top)
    half = float(body["restitution"][1] - body["restitution"][0]) / 2
    axes.set_xlim(float(body["restitution"][0]) - half, float(body["restitution"][-1]) + half)
    axes.set_xlabel(r"coefficient of restitution $\varepsilon$")


def _by_velocity(
    axes: Axes, body: xr.Dataset, name: str, *, only_created: bool = False, logarithmic: bool = False
) -> None:
    top = 0.0
    for law in range(body.sizes["law"]):
        values, error = (body[each].isel(law=law).to_numpy() for each in (name, f"{name}_error"))
        if only_created and not np.nanmax(values) > 0:
            continue
        top = max(top, float(np.nanmax(values[_drawn(body)])))
        fg.line(axes, body["velocity"].to_numpy(), values, error, color=_COLORS[law], linestyle=_LINES[law])
    if logarithmic:
        axes.set_yscale("log")
        return
    axes.set_ylim(0, 1.25 * top if top else 1)
    axes.yaxis.set_major_locator(MaxNLocator(5))
    if not top:
        _say_none(axes)


def _gain(axes: Axes, body: xr.Dataset) -> None:
    """Draw what the largest factor is above 1; laws without any gain are not there."""
    bound = float(body["bound"]) - 1
    lowest = 1e-4 * bound
    axes.axhline(bound, color="0.55", linewidth=0.8, linestyle="-.")
    for law in range(body.sizes["law"]):
        gain = body["largest_energy_ratio"].isel(law=law) - 1
        axes.plot(body["velocity"], gain, color=_COLORS[law], linestyle=_LINES[law])
    axes.set_yscale("log")
    axes.set_ylim(lowest, 30 * bound)
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_minor_formatter(NullFormatter())
    if not np.any((body["largest_energy_ratio"].to_numpy() - 1 > lowest)[:, _drawn(body)]):
        _say_none(axes)


def _say_none(axes: Axes) -> None:
    axes.text(0.5, 0.4, "none", transform=axes.transAxes, ha="center", color="0.4")


def _drawn(body: xr.Dataset) -> npt.NDArray[np.bool_]:
    velocity = body["velocity"].to_numpy()
    chosen: npt.NDArray[np.bool_] = (velocity >= _RANGE[0]) & (velocity <= _RANGE[1])
    return chosen
