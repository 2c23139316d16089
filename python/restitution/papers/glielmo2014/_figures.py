"""The redrawn figures in the paper's order: each is reduced in `_data`, drawn here, and explained here."""

from collections.abc import Callable
from functools import partial
from typing import Any, Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MultipleLocator

from restitution import figures as fg
from restitution.figures.report import grouped
from restitution.figures.style import DEVIATION, FRACTION, RESTITUTION, VELOCITY
from restitution.papers.figures import Caption, PaperFigure, listing
from restitution.papers.glielmo2014 import _data as data
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

_SPEED_TICKS = (0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0)
_BAND = "Band: ± one standard error, each particle counting as one draw; mostly narrower than the line."


def _slow(drawn: xr.Dataset) -> Figure:
    figure = fg.map(drawn)
    axes = figure.axes[0]
    axes.xaxis.set_major_locator(MultipleLocator(0.02))
    for line in (axes.axhline, axes.axvline):
        line(0.0, color="black", linewidth=0.4)
    return figure


def _restitution_histograms(drawn: xr.Dataset) -> Figure:
    figure, panels = fg.panels(fg.PAGE, 4.6, 2, 2)
    for k, axes in enumerate([axes for row in panels for axes in row]):
        part = drawn.isel(speed=k)
        _histogram(axes, part, marker="o", markersize=2.5, color=fg.COLORS[0], label="simulation")
        axes.plot(part["fit_point"], part["fit_density"], color=fg.COLORS[1], label="asymmetric Laplace")
        axes.set_yscale("log")
        filled = part["density"].where(part["density"] > 0)
        # Above the points there is room for the panel's letter.
        axes.set_ylim(float(filled.min()) / 2, 4 * float(filled.max()))
        axes.set_xlim(float(part["edges"][0]), float(part["edges"][-1]))
        fg.letter(axes, f"({'abcd'[k]}) {float(part['speed']):g} m/s")
        axes.set_xlabel(RESTITUTION)
        axes.set_ylabel(r"$p_\varepsilon$")
    panels[1][1].legend(loc="upper right", reverse=True)
    return figure


def _fraction_histograms(drawn: xr.Dataset) -> Figure:
    figure, [[axes]] = fg.panels(fg.COLUMN, 2.7)
    for k, speed in enumerate(drawn["speed"].to_numpy()):
        look: dict[str, Any] = {"marker": fg.MARKERS[k], "color": fg.COLORS[k], "markersize": 2.0}
        _histogram(axes, drawn.isel(speed=k), **look, linestyle="-", linewidth=0.5, label=f"{speed:g} m/s")
    axes.set_yscale("log")
    axes.set_xlim(float(drawn["edges"].min()), float(drawn["edges"].max()))
    # Above the points there is room for the legend; an error bar may reach below them.
    filled = drawn["density"].where(drawn["density"] > 0)
    axes.set_ylim(float(filled.min()) / 2, 30 * float(filled.max()))
    axes.set_xlabel(FRACTION)
    axes.set_ylabel(r"$p_{E_\mathrm{rot}/E_\mathrm{tot}}$")
    axes.legend(title="impact velocity", ncols=2, loc="upper right")
    return figure


def _bead_deviation(drawn: xr.Dataset) -> Figure:
    figure, [[axes]] = fg.panels(fg.COLUMN, 2.5)
    for k, x in enumerate(drawn["elongation"].to_numpy()):
        _deviation(axes, drawn.isel(elongation=k), "", k, f"$L/R = {x:g}$")
    axes.set_ylabel(DEVIATION)
    axes.legend()
    return figure


def _first_impact(drawn: xr.Dataset) -> Figure:
    figure, [[axes], [below]] = fg.panels(fg.COLUMN, 3.4, 2, 1, sharex=True, height_ratios=[3, 1])
    points: dict[str, Any] = {"marker": "o", "markersize": 2.0, "color": fg.COLORS[0]}
    _histogram(axes, drawn, **points, label="simulation")
    at, printed = drawn["point"], drawn["printed_density"]
    axes.plot(at, drawn["exact_density"], color=fg.COLORS[1], label="Eq. (21), corrected")
    axes.plot(at, printed, color="black", linestyle="--", label="Eq. (21), as printed")
    axes.set_yscale("log")
    # The densities are infinite at the upper end.
    axes.set_ylim(0.7, 2 * float(drawn["density"].max()))
    axes.set_ylabel(r"$p_\varepsilon$")
    axes.legend(reverse=True)
    centres = 0.5 * (drawn["edges"].to_numpy()[1:] + drawn["edges"].to_numpy()[:-1])
    below.plot(centres, drawn["pull"], linestyle="none", **points)
    below.axhline(0.0, color=fg.COLORS[1])
    reach = max(4.0, 1.2 * float(np.abs(drawn["pull"]).max()))
    below.set_ylim(-reach, reach)
    below.set_xlabel(RESTITUTION)
    below.set_ylabel("pull")
    below.set_xlim(-0.05, 0.42)
    for panel, text in ((axes, "(a)"), (below, "(b)")):
        panel.axvline(0.0, color="black", linewidth=0.4)
        fg.letter(panel, text)
    return figure


def _map_sensitivity(drawn: xr.Dataset) -> Figure:
    def quantiles(axes: Axes, axis: str, k: int, label: str) -> None:
        for q, style in enumerate((":", "-", ":")):
            line = drawn[f"by_{axis}"].isel({axis: k, "quantile": q})
            name = label if style == "-" else None
            axes.plot(drawn["velocity"], line, color=fg.COLORS[k], linestyle=style, label=name)

    return _two_panels(drawn, quantiles, RESTITUTION, "lower right")


def _deviation_sensitivity(drawn: xr.Dataset) -> Figure:
    def deviation(axes: Axes, axis: str, k: int, label: str) -> None:
        _deviation(axes, drawn.isel({axis: k}), f"_by_{axis}", k, label)

    return _two_panels(drawn, deviation, DEVIATION, "lower left")


def _two_panels(
    drawn: xr.Dataset,
    draw: Callable[[Axes, str, int, str], None],
    quantity: str,
    legend: Literal["lower left", "lower right"],
) -> Figure:
    """Draw a line for each radius in one panel, and for each release height in the other."""
    figure, [panels] = fg.panels(fg.PAGE, 2.7, 1, 2, sharey=True)
    for axes, axis, symbol, text in zip(panels, ("radius", "height"), "Rh", ("(a)", "(b)"), strict=True):
        for k, value in enumerate(drawn[axis].to_numpy()):
            draw(axes, axis, k, f"${symbol}$ = {1e3 * value:g} mm")
        fg.letter(axes, text, left=False)
        axes.set_xlabel(VELOCITY)
        axes.legend(loc=legend)
    panels[0].set_ylabel(quantity)
    return figure


def _histogram(axes: Axes, part: xr.Dataset, **style: Any) -> None:
    edges, density, error = (part[name].to_numpy() for name in ("edges", "density", "density_error"))
    fg.histogram(axes, edges, density, error, **style)


def _deviation(axes: Axes, drawn: xr.Dataset, suffix: str, k: int, label: str) -> None:
    x, y, error = (
        drawn[name].to_numpy() for name in ("velocity", f"deviation{suffix}", f"deviation_error{suffix}")
    )
    fg.line(axes, x, np.where(y > 0, y, np.nan), error, color=fg.COLORS[k], marker=fg.MARKERS[k], label=label)
    axes.set_xlabel(VELOCITY)
    fg.plain_log(axes, _SPEED_TICKS)
    axes.set_yscale("log")


def _explain_map(drawn: xr.Dataset, s: Settings) -> Caption:
    return Caption(
        "Fig. 2 redrawn. Coefficient of restitution ε (Eq. 1) against impact velocity v_G^n. "
        f"{_colour(drawn['restitution_count'])} The largest population is that of the first impacts, which "
        f"arrive with nearly one velocity. {_share(drawn, 'restitution_count')}",
        [_lattice(s), *_stated(drawn, s.elongation)],
        _drop(drawn),
    )


def _explain_fraction_map(drawn: xr.Dataset, s: Settings) -> Caption:
    return Caption(
        "Fig. 3 redrawn. Rotational over total kinetic energy before the impact (Eq. 12) against impact "
        f"velocity v_G^n. {_colour(drawn['fraction_count'])} {_share(drawn, 'fraction_count')}",
        _stated(drawn, s.elongation),
        [f"lattice with origin (0, 0), mesh {s.velocity_mesh:g} m/s × {s.fraction_mesh:g}", *_drop(drawn)],
    )


def _explain_restitution_histograms(drawn: xr.Dataset, s: Settings) -> Caption:
    fits = "; ".join(
        f"{float(part['speed']):g} m/s: {_number(part['number'])} impacts ({_number(part['outside'])} outside"
        f" the bins), m = {float(part['fit_location']):.4f}, a = {float(part['fit_above']):.4f},"
        f" b = {float(part['fit_below']):.4f} from {_number(part['fit_number'])} recorded ones"
        for part in (drawn.isel(speed=k) for k in range(drawn.sizes["speed"]))
    )
    return Caption(
        "Fig. 4 redrawn. Probability density of the coefficient of restitution ε (Eq. 1) at four impact "
        "velocities. Points: simulation, ± one standard error, each particle counting as one draw. "
        "Lines: asymmetric Laplace density, exp[−(ε−m)/a]/(a+b) above m and exp[−(m−ε)/b]/(a+b) below, "
        f"by maximum likelihood from the recorded impacts. {fits}.",
        [_named_speed(s), *_stated(drawn, s.elongation)],
        [*_windows(s), f"bin widths {listing(s.histogram_widths)} in (a)-(d)", *_drop(drawn)],
        recorded="the fits and the standard errors",
    )


def _explain_fraction_histograms(drawn: xr.Dataset, s: Settings) -> Caption:
    numbers = ", ".join(f"{_number(n)} at {v}" for n, v in zip(drawn["number"], s.labels, strict=True))
    return Caption(
        "Fig. 5 redrawn. Probability density of the rotational over the total kinetic energy before the "
        f"impact (Eq. 12) at four impact velocities; impacts: {numbers}. Bars: ± one standard error, each "
        "particle counting as one draw. Lines join the points.",
        [_named_speed(s), *_stated(drawn, s.elongation)],
        [*_windows(s), f"bin width {s.fraction_mesh:g}", *_drop(drawn)],
    )


def _explain_bead_deviation(drawn: xr.Dataset, s: Settings) -> Caption:
    return Caption(
        "Fig. 6 redrawn. Standard deviation σ of the coefficient of restitution (Eq. 1) against impact "
        f"velocity v_G^n. {_BAND} Steps above 0.5 m/s: beads so nearly round keep nearly the same share of "
        "their velocity at each impact, so that a bin holds the impacts of only one or two generations.",
        _stated(drawn, *s.bead_elongations),
        [f"velocity bins of {s.deviation_mesh:g} m/s", *_drop(drawn)],
        each="for each L/R",
    )


def _explain_slow(drawn: xr.Dataset, s: Settings) -> Caption:
    return Caption(
        "Fig. 7 redrawn. As Fig. 2, the same data, at low impact velocity v_G^n. Right branch of ε < 0, "
        "v_G^n > 0: the centre of mass falls before and after the impact. Left branch, v_G^n < 0: it rises "
        f"before and after, and ε < −1 as the plane can only push. {_colour(drawn['restitution_count'])} "
        "The most populated sites, at ε ≈ −1 and v_G^n ≈ 0, are the ever weaker impacts by which one "
        f"sphere comes to lasting contact with the plane. {_share(drawn, 'restitution_count')}",
        [_lattice(s), *_stated(drawn, s.elongation)],
        _drop(drawn),
    )


def _explain_first_impact(drawn: xr.Dataset, s: Settings) -> Caption:
    share, exact = float(drawn["negative"]), float(drawn["negative_exact"])
    error = np.sqrt(share * (1 - share) / float(drawn["number"]))
    return Caption(
        "Fig. 9 redrawn. (a) Probability density of the coefficient of restitution ε (Eq. 1) at the first "
        "impact from rest: simulation, Eq. 21 with its misprints corrected, and Eq. 21 as printed. (b) Pull: "
        "(count − expected count) / standard error in each bin, expected from the corrected equation. "
        f"Simulated probability of ε < 0: {share:.3%} ± {error:.3%}; by the corrected equation {exact:.3%}.",
        _stated(drawn, s.first_elongation),
        [
            f"bin width {s.first_mesh:g}, the lowest bin cut off where the density begins",
            *_drop(drawn),
            "of which none matters here, since ε of a first impact depends on the angle alone",
        ],
    )


def _explain_map_sensitivity(drawn: xr.Dataset, s: Settings) -> Caption:
    low, _, high = data.QUANTILES
    return Caption(
        f"How Fig. 2 depends on what the paper does not state: median (solid) and quantiles {low:g} and "
        f"{high:g} (dotted) of the coefficient of restitution ε (Eq. 1) against impact velocity v_G^n, "
        f"{_varied(s)}.",
        _stated(drawn, s.elongation),
        _variation(drawn, s),
        each="for each curve",
    )


def _explain_deviation_sensitivity(drawn: xr.Dataset, s: Settings) -> Caption:
    return Caption(
        "How Fig. 6 depends on what the paper does not state: standard deviation σ of the coefficient of "
        f"restitution (Eq. 1) against impact velocity v_G^n, {_varied(s)}. {_BAND}",
        _stated(drawn, s.bead_elongations[0]),
        _variation(drawn, s),
        each="for each curve",
    )


def _colour(count: xr.DataArray) -> str:
    most = _number(count.max())
    return (
        f"Colour: impacts at a lattice site divided by those at the most populated one ({most}); blank: none."
    )


def _share(drawn: xr.Dataset, count: str) -> str:
    share = float(drawn[count].sum()) / drawn.attrs["impacts_counted"]
    return f"{share:.1%} of all impacts lie in the range drawn."


def _lattice(s: Settings) -> str:
    return f"lattice with origin (0, 0), mesh {s.velocity_mesh:g} m/s × {s.restitution_mesh:g}"


def _stated(drawn: xr.Dataset, *elongations: float) -> list[str]:
    about = drawn.attrs
    angle = {"uniform-angle": "θ uniform in [0, π)", "isotropic": "isotropic orientation"}
    return [
        f"L/R = {listing(elongations)}",
        f"ε_n = {about['normal']:g}",
        f"ε_t = {about['tangential']:g}",
        f"released from rest with {angle[about['orientation']]}",
    ]


def _drop(drawn: xr.Dataset) -> list[str]:
    about = drawn.attrs
    return [
        f"R = {1e3 * about['radius']:g} mm",
        f"centre of mass released at {1e3 * about['release_height']:g} mm",
        f"g = {about['gravity']:g} m/s²",
    ]


def _varied(s: Settings) -> str:
    return (
        f"by (a) radius R, at h = {1e3 * s.release_height:g} mm;"
        f" (b) release height h of the centre of mass, at R = {1e3 * s.radius:g} mm"
    )


def _variation(drawn: xr.Dataset, s: Settings) -> list[str]:
    return [
        f"R = {listing(s.radii, 1e3)} mm",
        f"h = {listing(s.heights, 1e3)} mm",
        f"g = {drawn.attrs['gravity']:g} m/s²",
        f"velocity bins of {s.sensitivity_mesh:g} m/s",
    ]


def _named_speed(s: Settings) -> str:
    return f"impact velocity {s.lowest_speed:g} m/s"


def _windows(s: Settings) -> list[str]:
    others = f"impact velocities {listing(s.other_speeds)} m/s"
    return [others, f"windows of ± {s.speed_tolerance:.0%} about each velocity"]


def _number(value: xr.DataArray) -> str:
    return grouped(int(value))


FIGURES: tuple[PaperFigure[Runs, Settings], ...] = (
    PaperFigure(
        "figure-2",
        "Fig. 2: restitution against impact velocity",
        "Map of ε against impact velocity",
        "At the velocity of the first impacts all ε lie close below 0.98; towards lower velocities they fan "
        "out on both sides of it, to between 0.6 and 1.4 and beyond.",
        data.lattice,
        fg.map,
        _explain_map,
        stop=2,
    ),
    PaperFigure(
        "figure-3",
        "Fig. 3: rotational energy against impact velocity",
        "Map of the rotational share of the energy against impact velocity",
        "It is close to 0 at the velocity of the first impacts; towards lower velocities it spreads over a "
        "growing range, up to about 0.3.",
        data.lattice,
        partial(fg.map, of="fraction"),
        _explain_fraction_map,
        stop=4,
    ),
    PaperFigure(
        "figure-4",
        "Fig. 4: histograms of restitution",
        "Four histograms of ε on a logarithmic axis, with asymmetric Laplace densities",
        "At 0.8, 0.4 and 0.2 m/s each is a peak at 0.98 with nearly straight flanks, narrower at higher "
        "velocity, which fall below the lines at their ends; at 0.1 m/s the histogram is broad, with "
        "shoulders, and leaves the straight lines.",
        data.restitution_histograms,
        _restitution_histograms,
        _explain_restitution_histograms,
        stop=5,
    ),
    PaperFigure(
        "figure-5",
        "Fig. 5: histograms of the rotational energy",
        "Densities of the rotational share of the energy at four velocities, on a logarithmic axis",
        "At 0.8 m/s the density falls steeply from 0 to 0.08; at lower velocities it reaches farther and is "
        "flatter; at 0.2 and 0.1 m/s it rises again towards its upper end near 0.28.",
        data.fraction_histograms,
        _fraction_histograms,
        _explain_fraction_histograms,
        stop=4,
    ),
    PaperFigure(
        "figure-6",
        "Fig. 6: standard deviation of restitution",
        "Standard deviation of ε against impact velocity for L/R = 0.01 and 0.02, both axes logarithmic",
        "It falls as the velocity grows, faster near the velocity of the first impacts, and is larger for "
        "0.02.",
        data.bead_deviation,
        _bead_deviation,
        _explain_bead_deviation,
        stop=6,
    ),
    PaperFigure(
        "figure-7",
        "Fig. 7: negative restitution",
        "Map of ε from −3 to 4 at velocities below 0.1 m/s",
        "The slower the impact, the wider the range of ε. It reaches below 0 at velocities below 0.02 m/s; "
        "at negative velocities all ε are below −1.",
        data.slow,
        _slow,
        _explain_slow,
        stop=7,
    ),
    PaperFigure(
        "figure-9",
        "Fig. 9: first impact from rest",
        "Density of ε at the first impact, and below it the differences between simulation and closed form",
        "The density falls from −0.01 to 0.15 and rises steeply towards 0.4. Simulated points lie on the "
        "corrected Eq. 21 and well above Eq. 21 as printed. Below, the differences between simulation and "
        "corrected equation scatter about 0 by a few standard errors.",
        data.first_impact,
        _first_impact,
        _explain_first_impact,
        stop=8,
    ),
    PaperFigure(
        "figure-2-sensitivity",
        "Fig. 2 for other radii and release heights",
        "Median and outer quantiles of ε against impact velocity, for three radii and three release heights",
        "The medians nearly agree; the quantiles of the radii differ at low velocity, and those of the "
        "heights differ at all velocities, wider for higher releases.",
        data.map_sensitivity,
        _map_sensitivity,
        _explain_map_sensitivity,
        stop=2,
    ),
    PaperFigure(
        "figure-6-sensitivity",
        "Fig. 6 for other radii and release heights",
        "Standard deviation of ε against impact velocity, for three radii and three release heights",
        "The curves for three radii lie close together; those for three release heights lie well apart, "
        "higher for higher releases.",
        data.deviation_sensitivity,
        _deviation_sensitivity,
        _explain_deviation_sensitivity,
        stop=6,
    ),
)
