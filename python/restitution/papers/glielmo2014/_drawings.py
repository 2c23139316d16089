"""The redrawn figures: from the reduced data of each to a Matplotlib figure."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from restitution import figures as fg

_VELOCITY = r"impact velocity $v_G^n$ (m/s)"
_RESTITUTION = r"coefficient of restitution $\varepsilon$"
_FRACTION = r"$E_\mathrm{rot}/E_\mathrm{tot}$"
_SPEED_TICKS = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0)
_DEVIATION = r"standard deviation $\sigma(\varepsilon)$"


@fg.styled
def restitution_map(drawn: xr.Dataset) -> Figure:
    """Fig. 2 from `restitution_map`."""
    figure, [[axes]] = fg.panels(fg.COLUMN, 2.7)
    _map(figure, axes, drawn, "restitution", "restitution_count")
    axes.set_ylabel(_RESTITUTION)
    return figure


@fg.styled
def fraction_map(drawn: xr.Dataset) -> Figure:
    """Fig. 3 from `fraction_map`."""
    figure, [[axes]] = fg.panels(fg.COLUMN, 2.7)
    _map(figure, axes, drawn, "fraction", "fraction_count")
    axes.set_ylabel(_FRACTION)
    return figure


@fg.styled
def low_velocity_map(drawn: xr.Dataset) -> Figure:
    """Fig. 7 from `low_velocity_map`."""
    figure, [[axes]] = fg.panels(fg.COLUMN, 2.7)
    _map(figure, axes, drawn, "restitution", "restitution_count")
    axes.set_ylabel(_RESTITUTION)
    axes.xaxis.set_major_locator(MultipleLocator(0.02))
    for line in (axes.axhline, axes.axvline):
        line(0.0, color="black", linewidth=0.4)
    return figure


@fg.styled
def restitution_histograms(drawn: xr.Dataset) -> Figure:
    """Fig. 4 from `restitution_histograms`."""
    figure, panels = fg.panels(fg.PAGE, 4.6, 2, 2)
    for k, axes in enumerate([axes for row in panels for axes in row]):
        part = drawn.isel(speed=k)
        fg.histogram(
            axes,
            part["edges"].to_numpy(),
            part["density"].to_numpy(),
            part["density_error"].to_numpy(),
            marker="o",
            markersize=2.5,
            color=fg.COLORS[0],
            label="simulation",
        )
        axes.plot(part["fit_point"], part["fit_density"], color=fg.COLORS[1], label="asymmetric Laplace")
        axes.set_yscale("log")
        filled = part["density"].where(part["density"] > 0)
        # Above the points there is room for the panel's letter.
        axes.set_ylim(float(filled.min()) / 2, 4 * float(filled.max()))
        axes.set_xlim(float(part["edges"][0]), float(part["edges"][-1]))
        fg.letter(axes, f"({'abcd'[k]}) {float(part['speed']):g} m/s")
        axes.set_xlabel(_RESTITUTION)
        axes.set_ylabel(r"$p_\varepsilon$")
    panels[1][1].legend(loc="upper right", reverse=True)
    return figure


@fg.styled
def fraction_histograms(drawn: xr.Dataset) -> Figure:
    """Fig. 5 from `fraction_histograms`."""
    figure, [[axes]] = fg.panels(fg.COLUMN, 2.7)
    for k, speed in enumerate(drawn["speed"].to_numpy()):
        part = drawn.isel(speed=k)
        fg.histogram(
            axes,
            part["edges"].to_numpy(),
            part["density"].to_numpy(),
            part["density_error"].to_numpy(),
            marker=fg.MARKERS[k],
            color=fg.COLORS[k],
            markersize=2.0,
            linestyle="-",
            linewidth=0.5,
            label=f"{speed:g} m/s",
        )
    axes.set_yscale("log")
    axes.set_xlim(float(drawn["edges"].min()), float(drawn["edges"].max()))
    # Above the points there is room for the legend.
    axes.set_ylim(top=30 * float(drawn["density"].max()))
    axes.set_xlabel(_FRACTION)
    axes.set_ylabel(r"$p_{E_\mathrm{rot}/E_\mathrm{tot}}$")
    axes.legend(title="impact velocity", ncols=2, loc="upper right")
    return figure


@fg.styled
def bead_deviation(drawn: xr.Dataset) -> Figure:
    """Fig. 6 from `bead_deviation`."""
    figure, [[axes]] = fg.panels(fg.COLUMN, 2.5)
    for k, x in enumerate(drawn["elongation"].to_numpy()):
        _deviation(axes, drawn.isel(elongation=k), "", k, f"$L/R = {x:g}$")
    axes.set_xlabel(_VELOCITY)
    axes.set_ylabel(_DEVIATION)
    fg.plain_log(axes, _SPEED_TICKS)
    axes.set_yscale("log")
    axes.legend()
    return figure


@fg.styled
def first_impact(drawn: xr.Dataset) -> Figure:
    """Fig. 9 from `first_impact_histogram`."""
    figure, [[axes], [below]] = fg.panels(fg.COLUMN, 3.4, 2, 1, sharex=True, height_ratios=[3, 1])
    fg.histogram(
        axes,
        drawn["edges"].to_numpy(),
        drawn["density"].to_numpy(),
        drawn["density_error"].to_numpy(),
        marker="o",
        markersize=2.0,
        color=fg.COLORS[0],
        label="simulation",
    )
    axes.plot(drawn["point"], drawn["exact_density"], color=fg.COLORS[1], label="Eq. (21), corrected")
    axes.plot(
        drawn["point"], drawn["printed_density"], color="black", linestyle="--", label="Eq. (21), as printed"
    )
    axes.set_yscale("log")
    # The densities are infinite at the upper end.
    axes.set_ylim(0.7, 2 * float(drawn["density"].max()))
    axes.set_ylabel(r"$p_\varepsilon$")
    axes.legend(reverse=True)
    centres = 0.5 * (drawn["edges"].to_numpy()[1:] + drawn["edges"].to_numpy()[:-1])
    below.plot(centres, drawn["pull"], linestyle="none", marker="o", markersize=2.0, color=fg.COLORS[0])
    below.axhline(0.0, color=fg.COLORS[1])
    reach = max(4.0, 1.2 * float(np.abs(drawn["pull"]).max()))
    below.set_ylim(-reach, reach)
    below.set_xlabel(_RESTITUTION)
    below.set_ylabel("pull")
    below.set_xlim(-0.05, 0.42)
    for panel, text in ((axes, "(a)"), (below, "(b)")):
        panel.axvline(0.0, color="black", linewidth=0.4)
        fg.letter(panel, text)
    return figure


@fg.styled
def map_sensitivity(drawn: xr.Dataset) -> Figure:
    """How Fig. 2 changes, from `map_sensitivity`."""
    figure, [panels] = fg.panels(fg.PAGE, 2.7, 1, 2, sharey=True)
    for axes, axis, label, text in _sides(panels):
        for k, value in enumerate(drawn[axis].to_numpy()):
            by = drawn[f"by_{axis}"].isel({axis: k})
            for q, style in zip(range(by.sizes["quantile"]), (":", "-", ":"), strict=True):
                axes.plot(
                    drawn["velocity"],
                    by.isel(quantile=q),
                    color=fg.COLORS[k],
                    linestyle=style,
                    label=f"{label} = {1e3 * value:g} mm" if style == "-" else None,
                )
        fg.letter(axes, text, left=False)
        axes.set_xlabel(_VELOCITY)
        axes.legend(loc="lower right")
    panels[0].set_ylabel(_RESTITUTION)
    return figure


@fg.styled
def deviation_sensitivity(drawn: xr.Dataset) -> Figure:
    """How Fig. 6 changes, from `deviation_sensitivity`."""
    figure, [panels] = fg.panels(fg.PAGE, 2.7, 1, 2, sharey=True)
    for axes, axis, label, text in _sides(panels):
        for k, value in enumerate(drawn[axis].to_numpy()):
            _deviation(axes, drawn.isel({axis: k}), f"_by_{axis}", k, f"{label} = {1e3 * value:g} mm")
        fg.letter(axes, text, left=False)
        axes.set_xlabel(_VELOCITY)
        fg.plain_log(axes, _SPEED_TICKS)
        axes.set_yscale("log")
        axes.legend(loc="lower left")
    panels[0].set_ylabel(_DEVIATION)
    return figure


def _map(figure: Figure, axes: Axes, drawn: xr.Dataset, y: str, count: str) -> None:
    edges = [drawn[f"{name}_edges"].to_numpy() for name in ("velocity", y)]
    sites = fg.population(axes, edges[0], edges[1], drawn[count].to_numpy())
    fg.population_bar(figure, sites, axes)
    axes.set_xlabel(_VELOCITY)


def _deviation(axes: Axes, drawn: xr.Dataset, suffix: str, k: int, label: str) -> None:
    x, y, error = (
        drawn[name].to_numpy() for name in ("velocity", f"deviation{suffix}", f"deviation_error{suffix}")
    )
    fg.line(axes, x, np.where(y > 0, y, np.nan), error, color=fg.COLORS[k], marker=fg.MARKERS[k], label=label)


def _sides(panels: list[Axes]) -> list[tuple[Axes, str, str, str]]:
    return [(panels[0], "radius", "$R$", "(a)"), (panels[1], "height", "$h$", "(b)")]
