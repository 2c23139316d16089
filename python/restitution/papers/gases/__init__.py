"""Gases of aspherical grains, of spheres in their place, and with friction; published claims, judged."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr

import restitution as rs
from restitution.figures import report as html
from restitution.figures.report import Section, grouped
from restitution.papers import redraw as machinery
from restitution.papers.gases._claims import CLAIMS
from restitution.papers.gases._figures import FIGURES, rate
from restitution.papers.gases._runs import Runs, across, beta, fall, number, ratio, simulate
from restitution.papers.gases._settings import Settings
from restitution.papers.paper import Paper

__all__ = ["PAPER", "Table", "redraw", "tables"]

Table = tuple[str, tuple[str, ...], list[tuple[str, ...]]]
"""Caption, heads, and rows of text."""
_SAME = 0.1
"""Largest change of the logarithm of a ratio that counts as none."""


def tables(runs: Runs, s: Settings) -> list[Table]:
    """Return what the gases have: smooth dumbbells, spheres by the rules, and grains with friction."""
    return [_grains(runs, s), _by_rules(runs, s), _friction(runs, s)]


def _grains(runs: Runs, s: Settings) -> Table:
    heads = (
        "L/R",
        "T_rot/T_tr",
        "closure",
        "-d ln T_tr/d(collisions)",
        "over that of spheres",
        "contacts a collision",
        "collapses",
    )
    rows = []
    for x in s.elongations:
        data = runs.grains[s.normals[0], x]
        steady = rs.gas.theory.steady_ratio(s.dumbbell(x), rs.Frictionless(normal=s.normals[0]))
        found, error = ratio(data)
        slope, each = fall(data), float(data["contacts"][-1] / data["collisions"][-1])
        cells = [f"{x:g}", f"{found:.3f} ± {error:.3f}", f"{steady:.3f}", f"{slope:.4f}"]
        cells += [f"{slope / s.spheres(s.normals[0]):.2f}", f"{each:.3f}"]
        rows.append((*cells, f"{data.attrs['collapse_share']:.0e}"))
    return f"Smooth dumbbells, ε_n = {s.normals[0]:g}, second half of each gas", heads, rows


def _by_rules(runs: Runs, s: Settings) -> Table:
    names = ("grains", "kernel", "scaled")
    heads = (
        "ε_n",
        "L/R",
        "rate, grains",
        "with E_rot",
        "of v/√T_tr",
        "a₂, grains",
        "with E_rot",
        "of v/√T_tr",
        "T_tr/T₀ at the end, pair",
        "plane",
    )
    rows = []
    for (e, x), rules in runs.rules.items():
        gases = {"grains": runs.grains[e, x], **rules}
        cells = [f"{e:g}", f"{x:g}", *(f"{rate(runs, s, (e, x), name):.3f}" for name in names)]
        for name in names:
            a2 = gases[name]["a20"]
            cells.append(f"{float(a2[len(a2) // 2 :].mean()):.3f}")
        for name in ("pair", "plane"):
            end = gases[name]["translational_temperature"][-1] / s.temperature if name in gases else None
            cells.append("" if end is None else f"{float(end):.3f}")
        rows.append(tuple(cells))
    caption = "Rates of cooling over that of smooth spheres, and Sonine coefficients, second half"
    return caption, heads, rows


def _friction(runs: Runs, s: Settings) -> Table:
    heads = (
        "ε_n",
        "μ",
        "spheres, T_rot/T_tr",
        "rate",
        "β",
        "its rate",
        "dumbbells, across",
        "about their axis",
        "rate",
    )
    rows = []
    for key, data in runs.friction["spheres"].items():
        long = runs.friction["dumbbells"][key]
        middle, end = _ends(data["rotational_temperature"] / data["translational_temperature"])
        steady = abs(np.log(end / middle)) < _SAME
        like = beta(s, key[0], float(np.sqrt(middle * end))) if steady else None
        cells = [f"{key[0]:g}", f"{key[1]:g}", f"{middle:.3g}, {end:.3g}", f"{fall(data):.4f}"]
        cells += [f"{like[0]:.2f}", f"{like[1]:.4f}"] if like else ["none", ""]
        about = _ends(long["axis_temperature"].isel(axis=2) / long["translational_temperature"])
        cells += [f"{across(long)[0]:.3g}", "{:.3g}, {:.3g}".format(*about), f"{fall(long):.4f}"]
        rows.append(tuple(cells))
    return "Grains with Coulomb friction, after half of the collisions and at the end", heads, rows


def _ends(values: xr.DataArray) -> tuple[float, float]:
    return float(values[len(values) // 2]), float(values[-1])


def _sections(runs: Runs, s: Settings) -> Sequence[Section]:
    parts = []
    for caption, heads, rows in tables(runs, s):
        cells = [tuple(map(html.prose, row)) for row in rows]
        numbers = range(1, len(heads))
        parts.append(html.table(tuple(map(html.prose, heads)), cells, caption=caption, numbers=numbers))
    about = html.paragraph(
        "A collision is an encounter with contact. “With E_rot” and “of v/√T_tr” are spheres that draw ε by "
        "the rules of the third figure. β: rough spheres with the same steady ratio by the theory of "
        "Huthmann and Zippelius (1997), and their rate; “none”: the ratio is not steady."
    )
    return [Section("tables", "Tables", [*parts, about])]


def _about(runs: Runs) -> str:
    return (
        "Homogeneous, dilute gases of grains, in which every encounter is followed exactly, by direct "
        f"simulation Monte Carlo; {grouped(runs.asked)} particles each. The claims are the last sentences of "
        "PRE 90, 052204, and what is published on gases of rough and of long grains."
    )


PAPER = Paper(
    title="Gases of aspherical grains: figures, claims checked",
    reference="A. Glielmo, N. Gunkelmann, T. Pöschel, Phys. Rev. E 90, 052204 (2014), Sec. V, "
    "DOI 10.1103/PhysRevE.90.052204",
    command="restitution gas-figures --out gas",
    settings=Settings(),
    least=100,
    usual=10_000,  # in each gas
    number=number(Settings()),
    simulate=simulate,
    about=_about,
    columns={
        "body": lambda run: str(run["body"]),
        "law": lambda run: str(run["law"]),
    },
    figures=FIGURES,
    claims=CLAIMS,
    sections=_sections,
    size="particles",
    sizes={
        "particles": lambda data: grouped(int(np.sum(data.attrs["particles"]))),
        "collisions of a particle": lambda data: f"{float(data['collisions'][-1]):.0f}",
    },
    errors="Standard errors are over ten independent gases; that of a mean over looks at the same gas is "
    "that of one look.",
    ends="Gases end after a number of collisions. An encounter in which contacts accumulate ends as a "
    "collapse, and nothing is regularised.",
)
redraw = partial(machinery.redraw, PAPER)
"""As `restitution.papers.redraw.redraw`, of this paper."""
