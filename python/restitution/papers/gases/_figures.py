"""The figures: each reduced to what is drawn, drawn, and explained here."""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import colors
from restitution.papers.figures import Caption, PaperFigure, listing
from restitution.papers.gases._runs import Runs, across, fall, ratio
from restitution.papers.gases._settings import Settings

_TR, _ROT = "translational_temperature", "rotational_temperature"
_COLLISIONS = "collisions of a particle"
_RATIO = r"$T_\mathrm{rot}/T_\mathrm{tr}$"
_SHOWN = 40
"""Looks at a gas that are drawn, at most."""


class _Caption(Caption):
    """Caption of gases."""

    __slots__ = ()

    def run(self, about: dict[str, Any]) -> str:
        """Write how many particles and gases, and their seeds."""
        return f"{about['particles']} particles in each gas; seed {about['seed']}"


def _about(runs: Runs, data: xr.Dataset) -> xr.Dataset:
    return data.assign_attrs(particles=runs.asked, seed=runs.seed, version=runs.version)


def _course(data: xr.Dataset, s: Settings) -> xr.Dataset:
    """Return temperatures over the collisions of a particle, at `_SHOWN` of them."""
    count = data["collisions"].to_numpy()
    at = np.linspace(0.0, count[-1], _SHOWN)
    logs = [np.interp(at, count, np.log(np.maximum(data[name], 1e-300))) for name in (_TR, _ROT)]
    return xr.Dataset(
        {"collisions": ("look", at), "cooled": ("look", np.exp(logs[0]) / s.temperature)}
        | {"ratio": ("look", np.exp(logs[1] - logs[0]))}
    )


def _cooling(runs: Runs, s: Settings) -> xr.Dataset:
    """Temperatures of the gases of the first ε_n, of that without rotation at first, and by the closure."""
    law = rs.Frictionless(normal=s.normals[0])
    found = []
    for elongation in s.elongations:
        data = runs.grains[s.normals[0], elongation]
        first = {
            "translational_temperature": s.temperature,
            "rotational_temperature": s.temperature,
            "number_density": s.number_density,
        }
        times = np.linspace(0.0, float(data["time"][-1]), 4 * _SHOWN)
        theory = rs.gas.theory.cooling(s.dumbbell(elongation), law, times=times, **first)
        count = np.interp(times, data["time"], data["collisions"])
        both = [_course(data, s), _course(theory.assign(collisions=("time", count)), s)]
        found.append(xr.concat(both, "by"))
    drawn = xr.concat(found, xr.DataArray(list(s.elongations), dims="elongation", name="elongation"))
    drawn = drawn.assign({f"cold_{name}": part for name, part in _course(runs.cold, s).items()})
    return _about(runs, drawn.assign(spheres=s.spheres(s.normals[0])))


def _draw_cooling(drawn: xr.Dataset) -> Figure:
    figure, [[left, right]] = fg.panels(fg.PAGE, 2.8, 1, 2)
    for k, elongation in enumerate(drawn["elongation"].to_numpy()):
        points: dict[str, Any] = {"marker": fg.MARKERS[k], "linestyle": "none", "markevery": 2}
        for by, line in enumerate((points, {})):
            part = drawn.isel(elongation=k, by=by)
            label = f"$L/R = {elongation:g}$" if by == 0 else None
            left.plot(part["collisions"], part["cooled"], color=colors()[k], **line)
            right.plot(part["collisions"], part["ratio"], color=colors()[k], label=label, **line)
    cold = drawn.isel(look=slice(1, None))
    right.plot(cold["cold_collisions"], cold["cold_ratio"], color=colors()[0], linestyle=":", linewidth=1.5)
    end = float(drawn["collisions"].max()) / 3.0
    rate = float(drawn["spheres"])
    left.plot([0.0, end], np.exp([0.0, -rate * end]), color="0.6", linestyle="--")
    left.text(1.03 * end, np.exp(-rate * end), "spheres", color="0.6", va="center")
    left.set(yscale="log", xlabel=_COLLISIONS, ylabel=r"$T_\mathrm{tr}/T_0$")
    right.set(yscale="log", xlabel=_COLLISIONS, ylabel=_RATIO)
    right.set_ylim(0.3, 25)
    return _lettered(figure, [left, right], right)


def _lettered(figure: Figure, panels: list[Axes], named: Axes, columns: int = 4) -> Figure:
    """Name the panels, and put the legend of one of them above all."""
    for axes, name in zip(panels, "abc", strict=False):
        fg.letter(axes, f"({name})", left=False)
    figure.legend(*named.get_legend_handles_labels(), loc="outside upper center", ncols=columns)
    return figure


def _ours(s: Settings) -> list[str]:
    return [f"R = {1e3 * s.radius:g} mm", "T_rot = T_tr at the beginning"]


def _explain_cooling(drawn: xr.Dataset, s: Settings) -> Caption:
    return _Caption(
        f"Gases of smooth dumbbells, ε_n = {s.normals[0]:g}: (a) temperature of translation, (b) over it "
        "that of rotation about the axes across. Points: every encounter followed. Lines: kinetic theory "
        f"for Maxwellians. Dashes: smooth spheres. Dots: L/R = {s.elongations[0]:g} from T_rot = 0.",
        [f"L/R = {s.slightly:g}"],
        [f"L/R = {listing(s.elongations)}", *_ours(s)],
    )


def _ratios(runs: Runs, s: Settings) -> xr.Dataset:
    """Steady ratios over ε_n and over L/R, with the closure, and the limit of round bodies."""
    lengths, elastic = np.geomspace(s.elongations[0] / 2, s.elongations[-1], 12), np.linspace(0.4, 0.98, 12)

    def theory(normal: float, elongation: float) -> float:
        return rs.gas.theory.steady_ratio(s.dumbbell(elongation), rs.Frictionless(normal=normal))

    found = np.array([[ratio(runs.steady[e, x]) for e in s.coefficients] for x in s.elongations[1:]])
    grains = np.array([[ratio(runs.grains[e, x]) for x in s.elongations] for e in s.normals])
    drawn = xr.Dataset(
        {
            "by_normal": (("long", "coefficient", "part"), found),
            "theory_by_normal": (
                ("long", "elastic"),
                [[theory(e, x) for e in elastic] for x in s.elongations[1:]],
            ),
            "by_elongation": (("normal", "elongation", "part"), grains),
            "theory_by_elongation": (
                ("normal", "length"),
                [[theory(e, x) for x in lengths] for e in s.normals],
            ),
            "limit": (("normal", "length"), [[s.limit(e, x) for x in lengths] for e in s.normals]),
        },
        {
            "coefficient": list(s.coefficients),
            "elastic": elastic,
            "long": list(s.elongations[1:]),
            "normal": list(s.normals),
            "elongation": list(s.elongations),
            "length": lengths,
            "part": ["value", "error"],
        },
    )
    return _about(runs, drawn)


def _draw_ratios(drawn: xr.Dataset) -> Figure:
    figure, [[left, right]] = fg.panels(fg.PAGE, 2.8, 1, 2)
    for axes, of, over, line, text in (
        (left, "by_normal", "coefficient", "elastic", "L/R"),
        (right, "by_elongation", "elongation", "length", r"\varepsilon_n"),
    ):
        other = str(drawn[of].dims[0])
        for k, value in enumerate(drawn[other].to_numpy()):
            part = drawn.isel({other: k})
            k += 4 * (axes is right)
            look: dict[str, Any] = {"color": colors()[k], "marker": fg.MARKERS[k], "linestyle": "none"}
            label = f"${text} = {value:g}$"
            points, error = (part[of].isel(part=i).to_numpy() for i in (0, 1))
            axes.errorbar(drawn[over].to_numpy(), points, error, label=label, **look)
            axes.plot(drawn[line], part[f"theory_{of}"], color=colors()[k])
            if axes is right:
                axes.plot(drawn[line], part["limit"], color="0.6", linestyle="--", zorder=0)
        axes.legend(loc="lower left" if axes is right else "center right")
    left.set(xlabel=r"$\varepsilon_n$", ylabel=_RATIO, yscale="log")
    right.set(xlabel="$L/R$", ylabel=_RATIO, xscale="log", yscale="log")
    for axes, name in ((left, "(a)"), (right, "(b)")):
        fg.letter(axes, name, left=False)
    return figure


def _explain_ratios(drawn: xr.Dataset, s: Settings) -> Caption:
    return _Caption(
        "Ratio of the temperatures of smooth dumbbells that cool: (a) over ε_n, (b) over L/R. Points: second "
        "half of gases, in (a) begun at the ratio of the closure, ± the standard error of one look. Lines: "
        "the closure. Dashes: (12/5)(R/L)²(1 - ε_n)/(1 + ε_n), the limit of round bodies.",
        [f"L/R = {s.slightly:g}"],
        [f"L/R = {listing(s.elongations)}", f"ε_n = {listing(s.coefficients)} in (a)", *_ours(s)],
    )


_LABELS = {
    "plane": r"spheres, $p(\varepsilon\,|\,v)$ of a plane",
    "pair": r"of a pair",
    "scaled": r"$p(\varepsilon\,|\,v/\sqrt{T_\mathrm{tr}})$",
    "kernel": r"with $E_\mathrm{rot}$, at $T_\mathrm{rot}/T_\mathrm{tr}$",
}


def _spheres(runs: Runs, s: Settings) -> xr.Dataset:
    """Temperatures of two gases and of spheres by the rules, and rates at the end over those of spheres."""
    shown = [key for key, rules in runs.rules.items() if "plane" in rules]
    rules = ["grains", *_LABELS]
    courses = [
        xr.concat(
            [_course(runs.grains[key] if rule == "grains" else runs.rules[key][rule], s) for rule in rules],
            xr.DataArray(rules, dims="rule", name="rule"),
        )
        for key in shown
    ]
    drawn = xr.concat(courses, xr.DataArray([x for _, x in shown], dims="shown", name="shown"))
    three = ["grains", "scaled", "kernel"]
    rates = [[[rate(runs, s, (e, x), rule) for x in s.elongations] for e in s.normals] for rule in three]
    drawn["rate"] = (("three", "normal", "elongation"), rates)
    drawn = drawn.assign_coords(three=three, normal=list(s.normals), elongation=list(s.elongations))
    return _about(runs, drawn)


def rate(runs: Runs, s: Settings, key: tuple[float, float], rule: str) -> float:
    """Return -d ln T_tr/d(collisions) of grains, or of spheres by a rule, over that of smooth spheres."""
    return fall(runs.grains[key] if rule == "grains" else runs.rules[key][rule]) / s.spheres(key[0])


def _draw_spheres(drawn: xr.Dataset) -> Figure:
    figure, [panels] = fg.panels(fg.PAGE, 2.8, 1, 3)
    look: dict[str, dict[str, Any]] = {"grains": {"color": "0.5", "label": "the grains themselves"}}
    for k, (name, label) in enumerate(_LABELS.items()):
        point = {"color": colors()[k], "marker": fg.MARKERS[k], "linestyle": "none", "label": label}
        look[name] = point | {"fillstyle": "none", "markevery": 3}
    for axes, elongation in zip(panels[:2], drawn["shown"].to_numpy(), strict=True):
        for name, options in look.items():
            part = drawn.sel(shown=elongation, rule=name)
            axes.plot(part["collisions"], part["cooled"], **options)
        axes.set(yscale="log", xlabel=_COLLISIONS, ylabel=r"$T_\mathrm{tr}/T_0$", ylim=(3e-3, 1.5))
        axes.set_title(f"$L/R = {elongation:g}$")
    for k, normal in enumerate(drawn["normal"].to_numpy()):
        for name in drawn["three"].to_numpy():
            values = drawn["rate"].sel(three=name, normal=normal)
            options = look[name] if name == "grains" else look[name] | {"markevery": 1}
            options = options | ({"fillstyle": "full"} if k == 0 and name != "grains" else {})
            panels[2].plot(drawn["elongation"], values, **options)
    panels[2].set(xscale="log", yscale="log", xlabel="$L/R$", ylabel="rate of cooling, of spheres 1")
    return _lettered(figure, list(panels), panels[0], 5)


def _explain_spheres(drawn: xr.Dataset, s: Settings) -> Caption:
    return _Caption(
        f"Temperature of translation of smooth dumbbells, ε_n = {s.normals[0]:g}, and of spheres that draw "
        f"their ε, by four rules: (a) L/R = {float(drawn['shown'][0]):g}, (b) {float(drawn['shown'][1]):g}. "
        "(c) How fast it falls in the second half, over that of smooth spheres; filled: ε_n = "
        f"{s.normals[0]:g}, open: {s.normals[1]:g}.",
        [f"L/R = {s.slightly:g}", "p(ε|v) of a body on a plane"],
        [f"dropped from {s.drop:g} m on the plane", f"√(T_tr/m) = {s.speed:.2g} m/s at first", *_ours(s)],
    )


def _friction(runs: Runs, s: Settings) -> xr.Dataset:
    """T_rot/T_tr over μ, at half of the collisions and at the end."""
    found = []
    for name, gases in runs.friction.items():
        for e in s.normals:
            each = []
            for mu in s.frictions:
                data = gases[e, mu]
                quotients = data["rotational_temperature"] / data["translational_temperature"]
                each.append([float(quotients[len(quotients) // 2]), float(quotients[-1]), across(data)[0]])
            found.append((f"{name}, {e:g}", each))
    drawn = xr.Dataset(
        {"ratio": (("gas", "friction", "when"), [each for _, each in found])},
        {
            "gas": [name for name, _ in found],
            "friction": list(s.frictions),
            "when": ["half", "end", "across"],
        },
    )
    return _about(runs, drawn)


def _draw_friction(drawn: xr.Dataset) -> Figure:
    figure, [[left, right]] = fg.panels(fg.PAGE, 2.8, 1, 2)
    for k, name in enumerate(drawn["gas"].to_numpy()):
        body, normal = name.split(", ")
        axes = left if body == "spheres" else right
        part = drawn["ratio"].sel(gas=name)
        options: dict[str, Any] = {"color": colors()[k % 2], "marker": fg.MARKERS[k % 2]}
        axes.plot(drawn["friction"], part.sel(when="end"), **options, label=rf"$\varepsilon_n = {normal}$")
        axes.plot(drawn["friction"], part.sel(when="half"), **options, fillstyle="none", linestyle=":")
        if axes is right:
            axes.plot(drawn["friction"], part.sel(when="across"), color=colors()[k % 2], linestyle="--")
    for axes, text in ((left, "spheres"), (right, "dumbbells, $L/R = 1$")):
        axes.set(xscale="log", yscale="log", xlabel=r"$\mu$", ylabel=_RATIO)
        axes.set_title(text)
    return _lettered(figure, [left, right], left)


def _explain_friction(drawn: xr.Dataset, s: Settings) -> Caption:
    return _Caption(
        "Ratio of the temperatures of grains with Coulomb friction over μ, (a) spheres, (b) dumbbells: open "
        f"after {s.share * s.friction_collisions / 2:g}, filled after {s.share * s.friction_collisions:g} "
        "collisions of a particle; dashes: of the rotation across the axis of dumbbells alone.",
        [],
        [f"μ = {listing(s.frictions)}", *_ours(s)],
    )


FIGURES: tuple[PaperFigure[Runs, Settings], ...] = (
    PaperFigure(
        "cooling",
        "Two stages of cooling",
        "Temperature of translation, and its ratio to that of rotation, over the collisions of a particle",
        "The rounder the grains, the hotter their rotation becomes, and the slower the gas then cools. A gas "
        "of nearly round grains without rotation at first cools like spheres for some eighty collisions.",
        _cooling,
        _draw_cooling,
        _explain_cooling,
    ),
    PaperFigure(
        "ratios",
        "Steady ratio of the temperatures, and its singular limit",
        "T_rot/T_tr over ε_n and over L/R",
        "The ratio is near 1 for long grains and grows as (R/L)² for round ones; the closure is good to a "
        "few hundredths.",
        _ratios,
        _draw_ratios,
        _explain_ratios,
    ),
    PaperFigure(
        "spheres",
        "Spheres that draw their ε, beside the grains",
        "Temperatures of gases of spheres by four rules for ε, beside the grains",
        "A function of v alone stops the cooling at a temperature that nothing in the gas sets; in thermal "
        "speeds it cools nearly round grains too fast; with the change of E_rot drawn too it cools as they "
        "do.",
        _spheres,
        _draw_spheres,
        _explain_spheres,
    ),
    PaperFigure(
        "friction",
        "Grains with Coulomb friction",
        "T_rot/T_tr over μ of spheres and of dumbbells",
        "Only for large μ and ε_n near 1 is the ratio of spheres steady; else rotation stays. The rotation "
        "of dumbbells across their axis has a steady temperature at any μ.",
        _friction,
        _draw_friction,
        _explain_friction,
    ),
)
