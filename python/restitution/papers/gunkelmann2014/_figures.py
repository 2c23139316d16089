"""The figures: each is reduced in `_data`, drawn here, and explained here."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from restitution import figures as fg
from restitution.figures.report import grouped
from restitution.figures.style import DEVIATION, FRACTION
from restitution.papers.figures import Caption, PaperFigure, listing
from restitution.papers.gunkelmann2014 import _data as data
from restitution.papers.gunkelmann2014._runs import Runs
from restitution.papers.gunkelmann2014._settings import Settings

_VELOCITY = r"impact velocity $v$ (m/s)"
_TICKS = (0.05, 0.1, 0.2, 0.5, 1.0)


def _densities(drawn: xr.Dataset) -> Figure:
    figure, panels = fg.panels(fg.PAGE, 4.6, 2, 2)
    for k, axes in enumerate([axes for row in panels for axes in row]):
        part = drawn.isel(speed=k)
        edges, density, error = (part[name].to_numpy() for name in ("edges", "density", "density_error"))
        fg.histogram(
            axes, edges, density, error, marker="o", markersize=2.5, color=fg.COLORS[0], label="simulation"
        )
        axes.plot(part["point"], part["fit_density"], color=fg.COLORS[1], label="asymmetric Laplace, fitted")
        axes.plot(part["point"], part["closed_density"], "k--", label="closed form, nothing fitted")
        axes.set_yscale("log")
        filled = density[density > 0]
        axes.set_ylim(filled.min() / 2, 4 * filled.max())  # above the peak is the panel's letter
        axes.set_xlim(edges[0], edges[-1])
        fg.letter(axes, f"({'abcd'[k]}) {float(part['speed']):g} m/s")
        axes.set_xlabel(r"$\varepsilon$")
        axes.set_ylabel(r"$p(\varepsilon \mid v)$")
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", ncols=3, reverse=True)
    return figure


def _two_panels(drawn: xr.Dataset, quantity: str) -> Figure:
    figure, [panels] = fg.panels(fg.PAGE, 2.7, 1, 2, sharey=True)
    names: dict[str, Callable[[Any], str]] = {
        "number": lambda n: f"$N = 10^{round(np.log10(n))}$",
        "height": lambda h: rf"$\langle h\rangle = {1e6 * h:g}$ µm",
    }
    for axes, (axis, name), text in zip(panels, names.items(), ("(a)", "(b)"), strict=True):
        for k, value in enumerate(drawn[axis].to_numpy()):
            part = drawn.isel({axis: k})
            x, y, error, closed = (
                part[f"{prefix}by_{axis}"].to_numpy() for prefix in ("velocity_", "", "error_", "closed_")
            )
            look: dict[str, Any] = {"color": fg.COLORS[k], "marker": fg.MARKERS[k], "label": name(value)}
            fg.line(axes, x, y, error, linestyle="none", **look)
            axes.plot(x, closed, color=fg.COLORS[k], linewidth=0.8)
        axes.set_xlabel(_VELOCITY)
        fg.plain_log(axes, _TICKS)
        axes.set_yscale("log")
        fg.letter(axes, text, left=False)
        axes.legend(loc="lower left")
    panels[0].set_ylabel(quantity)
    return figure


def _model(s: Settings) -> list[str]:
    return [f"N = {grouped(s.asperities)} in the main run"]


def _ours(s: Settings) -> list[str]:
    return [
        f"R = {1e3 * s.radius:g} mm",
        f"ρ = {1e6 * s.asperity_radius:g} µm",
        f"heights exponential with mean {1e6 * s.mean_height:g} µm",
        f"ε_n = {s.normal:g}, ε_t = {s.tangential:g}",
        f"released at rest from {1e3 * s.release_height:g} mm",
        f"g = {s.gravity:g} m/s²",
    ]


def _explain_map(drawn: xr.Dataset, s: Settings) -> Caption:
    return Caption(
        "Coefficient of restitution ε of a rough sphere against impact velocity. Colour: impacts at a "
        "lattice site divided by those at the most populated one; blank: none.",
        _model(s),
        [f"lattice with mesh {s.velocity_mesh:g} m/s × {s.restitution_mesh:g}", *_ours(s)],
    )


def _explain_densities(drawn: xr.Dataset, s: Settings) -> Caption:
    fits = "; ".join(
        f"{float(part['speed']):g} m/s: a = {float(part['fit_above']):.4f}, b = "
        f"{float(part['fit_below']):.4f}"
        for part in (drawn.isel(speed=k) for k in range(drawn.sizes["speed"]))
    )
    return Caption(
        "Probability density of the coefficient of restitution ε of a rough sphere at four impact "
        "velocities. Points: simulation, ± one standard error, each particle counting as one draw. Lines: "
        "asymmetric Laplace density with decay lengths a above and b below its cusp, by maximum likelihood: "
        f"{fits}. Dashed: Eqs. 11 and 12 of “The closed form”.",
        _model(s),
        [f"windows of ± {s.speed_tolerance:.0%} about {listing(s.speeds)} m/s", *_ours(s)],
        recorded="all",
    )


def _explain_curves(drawn: xr.Dataset, s: Settings, what: str) -> Caption:
    return Caption(
        f"{what} against impact velocity (a) for spheres with N asperities of equal height, (b) for "
        f"{grouped(s.asperities)} asperities whose heights are exponential with the mean ⟨h⟩. Points: "
        "simulation, ± one standard error, each particle counting as one draw. Lines: Eqs. 10 and 12 of "
        "“The closed form”.",
        _model(s),
        [
            f"N = {', '.join(map(grouped, s.numbers))} with h = {1e6 * s.height:g} µm",
            f"⟨h⟩ = {listing(s.mean_heights, 1e6)} µm",
            *_ours(s),
        ],
        each="for each curve",
    )


FIGURES: tuple[PaperFigure[Runs, Settings], ...] = (
    PaperFigure(
        "restitution",
        "Restitution of a rough sphere against impact velocity",
        "Map of ε against impact velocity",
        "A narrow band about 0.98 at the velocity of the first impacts, which widens on both sides as the "
        "velocity falls.",
        data.lattice,
        fg.map,
        _explain_map,
    ),
    PaperFigure(
        "densities",
        "Densities of restitution at four velocities",
        "Four densities of ε on a logarithmic axis",
        "Each is a peak with two straight flanks. They lie on the fitted line and on the closed form, in "
        "which nothing is fitted.",
        data.densities,
        _densities,
        _explain_densities,
    ),
    PaperFigure(
        "deviation",
        "Scatter of restitution, by number and height of the asperities",
        "Standard deviation of ε against impact velocity, both axes logarithmic",
        "It grows as the velocity falls, with fewer asperities, and with higher ones, along the lines of "
        "the closed form.",
        data.deviations,
        partial(_two_panels, quantity=DEVIATION),
        partial(_explain_curves, what="Standard deviation σ of the coefficient of restitution ε"),
    ),
    PaperFigure(
        "rotation",
        "Rotational share of the energy, by number and height of the asperities",
        "Mean rotational share of the energy against impact velocity, both axes logarithmic",
        "It grows as the velocity falls.",
        data.rotation,
        partial(_two_panels, quantity=f"mean {FRACTION}"),
        partial(_explain_curves, what="Mean share of the rotational in the kinetic energy before the impact"),
    ),
)
