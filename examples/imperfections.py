"""Shape or roughness? Rough dumbbells beside smooth ones and rough spheres: docs/imperfections.md.

    python examples/imperfections.py imperfections.png

draws docs/images/imperfections.png; `python docs/pages.py imperfections` also writes the table of the page.
"""

import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style
from restitution.papers.estimate import in_windows

Array = npt.NDArray[np.float64]

RADIUS, RELEASE, ASPERITY = 3e-3, 0.06, 3e-5
LAW = rs.TangentialRestitution(normal=0.9)
ELONGATIONS = (0.02, 0.05, 0.1, 0.2)
"""L/R."""
HEIGHTS = (3e-7, 1e-6, 3e-6, 1e-5, 3e-5)
"""Mean heights of the asperities in m, exponentially distributed."""
ENOUGH = 14.0
"""Number of asperities times mean height over R: the body itself touches with probability exp(-7)."""
SPEEDS = (0.8, 0.55, 0.35, 0.2)
IMPACTS = 26


def body(elongation: float, height: float, surface: int) -> rs.Dumbbell | rs.Rough:
    """Make a dumbbell, with asperities if they have a height."""
    smooth = rs.Dumbbell(radius=RADIUS, separation=elongation * RADIUS)
    if height == 0.0:
        return smooth
    return rs.Rough(
        smooth,
        asperities=round(ENOUGH * RADIUS / height),
        asperity_radius=ASPERITY,
        heights=("exponential", height),
        seed=surface,
    )


def scatter(
    elongation: float, height: float, particles: int, surfaces: int, law: rs.laws.Law = LAW
) -> tuple[Array, Array]:
    """Return σ(ε) at the speeds, within a tenth, and its standard error.

    Every surface has so many particles of its own; the error is that of the mean over the surfaces.
    """
    windows = [(0.9 * v, 1.1 * v) for v in reversed(SPEEDS)]
    found = []
    for surface in range(1, surfaces + 1):
        data = rs.simulate(
            body(elongation, height, surface),
            law,
            particles=particles,
            impacts=IMPACTS,
            release_height=RELEASE,
            orientation="isotropic",
            seed=surface,
        )
        impacts = in_windows(data["impact_velocity"], windows)
        found.append(impacts.deviations(impacts.of(data["restitution"])).value[::-1])
    return np.mean(found, axis=0), np.std(found, axis=0, ddof=1) / np.sqrt(surfaces)


def measure(particles: int = 100, surfaces: int = 12) -> dict[str, Array]:
    """Measure σ of both, of the shape alone and of roughness alone, and their standard errors.

    Returns
    -------
    dict of ndarray, shapes (elongations, heights, speeds), (elongations, speeds), (heights, speeds)
        "both", "shape" and "roughness", and each with "_error".
    """
    cases = {
        "shape": [[scatter(x, 0.0, particles, surfaces) for x in ELONGATIONS]],
        "roughness": [[scatter(0.0, h, particles, surfaces) for h in HEIGHTS]],
        "both": [[scatter(x, h, particles, surfaces) for h in HEIGHTS] for x in ELONGATIONS],
    }
    found = {}
    for name, rows in cases.items():
        value, error = np.moveaxis(np.array(rows), 2, 0)
        found[name], found[f"{name}_error"] = (x if name == "both" else x[0] for x in (value, error))
    return found


def share(found: dict[str, Array]) -> tuple[Array, Array]:
    """Return the share of roughness in the sum of both scatters, and its standard error."""
    s, r = found["shape"][:, None], found["roughness"][None]
    ds, dr = found["shape_error"][:, None], found["roughness_error"][None]
    return r / (s + r), np.hypot(s * dr, r * ds) / (s + r) ** 2


def on_the_line(elongation: float, law: rs.laws.Law) -> tuple[float, float]:
    """Return σ of both over the sum where both alone are alike, the mean over the speeds, and its error."""
    height = RADIUS * elongation**2 / (8 * np.sqrt(2))
    cases = ((elongation, 0.0), (0.0, height), (elongation, height))
    (shape, ds), (rough, dr), (both, db) = (scatter(*case, 100, 16, law) for case in cases)
    ratio = both / (shape + rough)
    error = ratio * np.hypot(db / both, np.hypot(ds, dr) / (shape + rough))
    return float(ratio.mean()), float(error.mean())  # speeds of one fall are not independent


@fg.styled
def draw(found: dict[str, Array], *, style: Style | None = None) -> Figure:
    """Draw the share of roughness over L/R and the mean height, at each speed."""
    figure, panels = fg.panels(fg.PAGE, 5.8, 2, 2, sharex=True, sharey=True)
    value, error = share(found)
    x, y = np.log10(ELONGATIONS), np.log10(np.array(HEIGHTS) * 1e6)
    for k, axes in enumerate([axes for row in panels for axes in row]):
        image = axes.pcolormesh(x, y, value[..., k].T, cmap="RdBu_r", vmin=0.0, vmax=1.0, shading="nearest")
        for i in range(x.size):
            for j in range(y.size):
                text = f"{value[i, j, k]:.2f}\n±{max(error[i, j, k], 0.005):.2f}"
                color = "w" if abs(value[i, j, k] - 0.5) > 0.35 else "k"
                axes.text(
                    x[i], y[j], text, ha="center", va="center", fontsize="x-small", color=color
                ).set_bbox({"facecolor": image.cmap(value[i, j, k]), "edgecolor": "none", "pad": 0.5})
        ends = axes.axis()
        line = np.linspace(*ends[:2], 50)
        axes.plot(line, np.log10(1e6 * RADIUS * 10 ** (2 * line) / (8 * np.sqrt(2))), "k--", zorder=1.5)
        axes.axis(ends)
        axes.set_xticks(x, [f"{e:g}" for e in ELONGATIONS])
        axes.set_yticks(y, [f"{1e6 * h:g}" for h in HEIGHTS])
        axes.minorticks_off()
        axes.set_title(f"{SPEEDS[k]:g} m/s", fontsize="medium")
    for axes in panels[1]:
        axes.set_xlabel("$L/R$")
    for row in panels:
        row[0].set_ylabel("mean height (µm)")
    figure.colorbar(
        image, ax=[axes for row in panels for axes in row], label="share of roughness in the scatter"
    )
    return figure


def table(found: dict[str, Array]) -> str:
    """Tabulate σ of both over the sum of σ of either, the mean over the speeds."""
    lines = ["| L/R | " + " | ".join(f"{1e6 * h:g} µm" for h in HEIGHTS) + " |"]
    lines.append("|---" * (1 + len(HEIGHTS)) + "|")
    total = found["shape"][:, None] + found["roughness"]
    ratio = found["both"] / total
    parts = (found["both_error"] / found["both"], found["shape_error"][:, None] / total)
    error = ratio * np.sqrt(parts[0] ** 2 + parts[1] ** 2 + (found["roughness_error"] / total) ** 2)
    # Speeds of one fall are not independent: the error is that at one speed.
    for x, row, errors in zip(ELONGATIONS, ratio.mean(axis=2), error.mean(axis=2), strict=True):
        cells = (f"{a:.2f} ± {b:.2f}" for a, b in zip(row, errors, strict=True))
        lines.append(f"| {x:g} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    measured, path = measure(), Path(sys.argv[1])
    for style in SITE:
        draw(measured, style=style).savefig(path.with_stem(path.stem + style[4:]), dpi=200)
