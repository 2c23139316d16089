"""On which face a square cuboid comes to rest, beside counts that were published.

`python docs/pages.py dice` makes the table and the figure of docs/dice.md, in ten minutes.
"""

from functools import cache
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors, ink

SIDE, HEIGHT = 1e-2, 0.1
"""Side of the square and height of the fall, in m."""
COUNTS = {
    0.47: (0.916, 332),
    0.63: (0.738, 840),
    0.75: (0.548, 799),
    0.81: (0.496, 740),
    0.93: (0.399, 516),
    0.97: (0.385, 530),
    1.16: (0.148, 1011),
    1.23: (0.154, 532),
    1.44: (0.052, 654),
    1.55: (0.040, 606),
}
"""Math. Gazette 97 (2013), 97.16, Table 1: height over side, share of throws on a square face, throws."""
LAWS = {"0.5": (0.5, 0.3), "0.7": (0.7, 0.3), "0.9": (0.9, 0.3), "0.9, μ = 0": (0.9, 0.0)}
"""The caption of a law, ε_n and μ."""
WIDTHS = (0.1, 0.3, 0.5, 0.7, 0.9)
NICKEL = rs.Cylinder(radius=10.605e-3, height=1.95e-3)


@cache
def rests(body: rs.Box | rs.Cylinder, normal: float, friction: float, particles: int) -> tuple[float, float]:
    """Return the share of the particles at rest with the axis z upright, and that of the undecided ones."""
    data = rs.simulate(
        body,
        rs.Coulomb(normal=normal, friction=friction) if friction else rs.Frictionless(normal=normal),
        particles=particles,
        impacts=1000,
        release_height=HEIGHT,
        spin=rs.RandomSpin(rate=(0.0, 60.0)),
        seed=1,
        record="state",
    )
    found = rs.resting(body, data)
    upright = np.abs(found.normal.to_numpy()[:, 2]) > 0.5
    return float(found.least[upright].sum()), float(found.attrs["undecided"])


def cuboid(ratio: float) -> rs.Box:
    """Return a square cuboid of a height over side."""
    return rs.Box(a=SIDE, b=SIDE, c=ratio * SIDE)


def table(particles: int = 1000, rows: int | None = None) -> str:
    """Write the table of docs/dice.md, or its first rows: least to most."""
    lines = [
        "| height/side | published | " + " | ".join(f"ε_n = {law}" for law in LAWS) + " |",
        "|---" * (2 + len(LAWS)) + "|",
    ]

    def cells(body: rs.Box | rs.Cylinder, edge: bool = False) -> str:
        each = []
        for law in LAWS.values():
            least, undecided = rests(body, *law, particles)
            least = 1.0 - least - undecided if edge else least
            each.append(f"{abs(least):.3f} to {least + undecided:.3f}")
        return " | ".join(each)

    for ratio, (share, throws) in list(COUNTS.items())[:rows]:
        error = np.sqrt(share * (1 - share) / throws)
        lines.append(f"| {ratio:.2f} | {share:.3f} ± {error:.3f} | {cells(cuboid(ratio))} |")
    lines.append(f"| nickel on its edge | 1/6000 | {cells(NICKEL, edge=True)} |")
    return "\n".join(lines)


def draw(path: Path, particles: int = 1000) -> None:
    """Draw the intervals beside the counts, and their width over ε_n."""
    for style in SITE:
        _draw(particles, style=style).savefig(path.with_stem(path.stem + style[4:]), dpi=200)


@fg.styled
def _draw(particles: int, *, style: Style | None = None) -> Figure:
    figure, [[left, right]] = fg.panels(fg.PAGE, 2.9, 1, 2)
    ratios = np.array(list(COUNTS))
    share, throws = np.array(list(COUNTS.values())).T
    for law, color, shift in (("0.5", 3, -0.012), ("0.9", 0, 0.0), ("0.9, μ = 0", 2, 0.012)):
        normal, friction = LAWS[law]
        found = np.array([rests(cuboid(r), normal, friction, particles) for r in COUNTS])
        name = f"$\\varepsilon_n = {normal:g}$, $\\mu = {friction:g}$"
        ends = found[:, 0], found.sum(axis=1)
        left.vlines(ratios + shift, *ends, color=colors()[color], linewidth=3, alpha=0.7, label=name)
    error = np.sqrt(share * (1 - share) / throws)
    left.errorbar(ratios, share, error, fmt="o", color=ink(), markersize=3, label="published", zorder=3)
    left.set(xlabel="height/side", ylabel="share on a square face", ylim=(0.0, 1.1))
    left.legend(loc="upper right")
    fg.letter(left, "(a)", left=True)
    for friction, mark in ((0.3, "o"), (0.0, "s")):
        wide = [rests(cuboid(1.0), normal, friction, particles)[1] for normal in WIDTHS]
        right.plot(WIDTHS, wide, mark + "-", label=f"cube, $\\mu = {friction:g}$")
    right.set(xlabel=r"$\varepsilon_n$", ylabel="share that is undecided", ylim=(0.0, 1.1))
    right.legend(loc="upper right")
    fg.letter(right, "(b)", left=True)
    return figure
