"""Shape or roughness? Rough dumbbells beside smooth ones and rough spheres: docs/imperfections.md.

Run ``python examples/imperfections.py OUT`` to write ``imperfections.png`` and ``imperfections.md`` into the
folder OUT: some two minutes.
"""

import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure
from scipy.spatial import ConvexHull

import restitution as rs
from restitution import figures as fg
from restitution.papers.estimate import Estimate, in_windows

Array = npt.NDArray[np.float64]

RADIUS, RELEASE, ASPERITY = 3e-3, 0.06, 3e-5
LAW = rs.TangentialRestitution(normal=0.9)
ELONGATIONS = (0.05, 0.1, 0.2)
"""L/R."""
HEIGHTS = (3e-6, 9e-6, 3e-5)
"""Mean heights of the asperities in m, exponentially distributed."""
ENOUGH = 14.0
"""Number of asperities times mean height over R: the body itself touches with probability exp(-7)."""
SPEEDS = (0.8, 0.55, 0.35, 0.2)
PARTICLES, IMPACTS, SEED = 300, 26, 1


def scatter(body: rs.Dumbbell | rs.Clump) -> Estimate:
    """Return σ(ε) at the speeds, within a tenth, with errors in which a particle is one draw."""
    data = rs.simulate(
        body,
        LAW,
        particles=PARTICLES,
        impacts=IMPACTS,
        release_height=RELEASE,
        orientation="isotropic",
        seed=SEED,
    )
    windows = [(0.9 * v, 1.1 * v) for v in reversed(SPEEDS)]
    impacts = in_windows(data["impact_velocity"], windows)
    return impacts.deviations(impacts.of(data["restitution"])).take(slice(None, None, -1))


def smooth(elongation: float) -> rs.Dumbbell:
    """Make the dumbbell without asperities."""
    return rs.Dumbbell(radius=RADIUS, separation=elongation * RADIUS)


def rough(body: rs.Dumbbell, height: float) -> rs.Clump:
    """Cover a body with asperities, of which only those on their convex hull are kept: no other can touch."""
    random = np.random.default_rng(SEED)
    number = round(ENOUGH * RADIUS / height)
    way = random.normal(size=(number, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    half = 0.5 * body.separation
    places = way * (RADIUS + random.exponential(height, number) - ASPERITY)[:, None]
    places[:, 2] += np.where(way[:, 2] > 0.0, half, -half)
    tops = places[ConvexHull(places).vertices]
    spheres = [(0.0, 0.0, half, RADIUS), (0.0, 0.0, -half, RADIUS)]
    inertia = np.diag([body.transverse_inertia, body.transverse_inertia, body.axial_inertia])
    return rs.Clump(
        spheres=np.vstack([spheres, np.column_stack([tops, np.full(len(tops), ASPERITY)])]),
        inertia=inertia,
        centre=(0.0, 0.0, 0.0),
    )


def measure() -> dict[str, Array]:
    """Measure σ of both, of the shape alone and of roughness alone, and their standard errors.

    Returns
    -------
    dict of ndarray, shapes (elongations, heights, speeds), (elongations, speeds), (heights, speeds)
        "both", "shape" and "roughness", and each with "_error".
    """
    shape = [scatter(smooth(x)) for x in ELONGATIONS]
    surface = [scatter(rough(smooth(0.0), h)) for h in HEIGHTS]
    both = [[scatter(rough(smooth(x), h)) for h in HEIGHTS] for x in ELONGATIONS]
    found = {}
    for name in ("value", "error"):
        end = "" if name == "value" else "_error"
        found["shape" + end] = np.array([getattr(one, name) for one in shape])
        found["roughness" + end] = np.array([getattr(one, name) for one in surface])
        found["both" + end] = np.array([[getattr(one, name) for one in row] for row in both])
    return found


def share(found: dict[str, Array]) -> tuple[Array, Array]:
    """Return the share of roughness in the sum of both scatters, and its standard error."""
    s, r = found["shape"][:, None], found["roughness"][None]
    ds, dr = found["shape_error"][:, None], found["roughness_error"][None]
    return r / (s + r), np.hypot(s * dr, r * ds) / (s + r) ** 2


@fg.styled
def draw(found: dict[str, Array]) -> Figure:
    """Draw the share of roughness over L/R and the mean height, at each speed."""
    figure, panels = fg.panels(fg.PAGE, 5.0, 2, 2, sharex=True, sharey=True)
    value, error = share(found)
    x, y = np.log10(ELONGATIONS), np.log10(np.array(HEIGHTS) * 1e6)
    for k, axes in enumerate([axes for row in panels for axes in row]):
        image = axes.pcolormesh(x, y, value[..., k].T, cmap="RdBu_r", vmin=0.0, vmax=1.0, shading="nearest")
        for i in range(x.size):
            for j in range(y.size):
                text = f"{value[i, j, k]:.2f}\n±{max(error[i, j, k], 0.005):.2f}"
                dark = abs(value[i, j, k] - 0.5) > 0.35
                place = x[i] - 0.07, y[j] + 0.09  # clear of the line
                axes.text(*place, text, ha="center", va="center", fontsize=6, color="w" if dark else "k")
        line = np.linspace(x[0] - 0.2, x[-1] + 0.2, 50)
        axes.plot(line, np.log10(1e6 * RADIUS * 10 ** (2 * line) / (8 * np.sqrt(2))), "k--")
        axes.set_xlim(x[0] - 0.17, x[-1] + 0.17)
        axes.set_ylim(y[0] - 0.26, y[-1] + 0.26)
        axes.set_xticks(x, [f"{e:g}" for e in ELONGATIONS])
        axes.set_yticks(y, [f"{1e6 * h:g}" for h in HEIGHTS])
        axes.set_title(f"{SPEEDS[k]:g} m/s", fontsize=8)
    for axes in panels[1]:
        axes.set_xlabel("$L/R$")
    for row in panels:
        row[0].set_ylabel("mean height (µm)")
    figure.colorbar(
        image, ax=[axes for row in panels for axes in row], label="share of roughness in the scatter"
    )
    return figure


def table(found: dict[str, Array]) -> str:
    """Tabulate σ of both over the sum of σ of either."""
    lines = ["| L/R | mean height | " + " | ".join(f"{v:g} m/s" for v in SPEEDS) + " |"]
    lines.append("|---" * (2 + len(SPEEDS)) + "|")
    for i, x in enumerate(ELONGATIONS):
        for j, height in enumerate(HEIGHTS):
            total = found["shape"][i] + found["roughness"][j]
            ratio = found["both"][i, j] / total
            error = ratio * np.sqrt(
                (found["both_error"][i, j] / found["both"][i, j]) ** 2
                + (found["shape_error"][i] ** 2 + found["roughness_error"][j] ** 2) / total**2
            )
            cells = [f"{a:.2f} ± {b:.2f}" for a, b in zip(ratio, error, strict=True)]
            lines.append(f"| {x:g} | {1e6 * height:g} µm | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    out = Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    measured = measure()
    draw(measured).savefig(out / "imperfections.png", dpi=200)
    (out / "imperfections.md").write_text(table(measured), encoding="utf-8")
