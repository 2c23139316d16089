"""A nearly round ball in a measurement: figures and tables of docs/roundness.md.

Run ``python examples/roundness.py OUT`` to write ``roundness.png``, ``budget.png``, ``required.png`` and
``roundness.md`` into the folder OUT: some twenty seconds.
"""

import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

import restitution as rs
from restitution import figures as fg
from restitution.bodies import GRADES, ROUGHNESS, Body
from restitution.figures.style import SITE, Style, colors, column, ink

Array = npt.NDArray[np.float64]

DIAMETER, NORMAL, GRAVITY, DROP, IMPACTS = 6e-3, 0.95, 9.81, 0.1, 20
LAW = rs.Frictionless(normal=NORMAL)
STICKS = rs.Coulomb(normal=NORMAL, friction=0.2)
STEEL, GLASS = 7800.0, 2500.0
BALLS = {
    "glass bead, L/R = 0.01": (6e-3, 0.0025 * 6e-3, GLASS),
    "glass bead, L/R = 0.02": (6e-3, 0.005 * 6e-3, GLASS),
    "glass marble": (16e-3, 0.1e-3, GLASS),
}
"""Diameter and out-of-roundness in m, and density in kg/m³: t = L/2 = (L/R) D/4."""
STATED = {"timing": 1e-5, "gravity_uncertainty": 0.01, "drop_uncertainty": 1e-3, "tilt": 2e-3, "spin": 2.0}
"""A careful experiment with a microphone: 10 µs, g from a table, 1 mm, 2 mrad, a third of a turn a second."""


def kicked(out_of_roundness: float, lobes: int, particles: int, impacts: int, seed: int = 1) -> Array:
    """Give ε of a clock for a ball with the support function R + (t/2) cos nθ, to first order in t.

    The map of a kicked rotor that docs/roundness.md derives; frictionless. It shares nothing with the engine.

    Returns
    -------
    ndarray, shape (particles, impacts)
    """
    n, t, g, radius = lobes, out_of_roundness, GRAVITY, DIAMETER / 2.0

    def height(angle: Array) -> Array:
        return 0.5 * t * np.cos(n * angle)

    def arm(angle: Array) -> Array:
        return -0.5 * t * n * np.sin(n * angle)

    angle = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, particles)
    spin = np.zeros(particles)
    heard = [np.full(particles, np.sqrt(2.0 * g * DROP))]
    speed = np.sqrt(2.0 * g * (DROP - height(angle)))
    for _ in range(impacts):
        d = arm(angle)
        inertia = 0.4 * radius**2
        spin = spin - (1.0 + NORMAL) * speed * d / (inertia + d**2)
        back = NORMAL * speed
        flight = 2.0 * back / g
        later = angle + spin * flight
        nearer = height(later) - height(angle) - d * spin * flight
        flight = flight - nearer / back
        later = angle + spin * flight
        speed = back - g * nearer / back + spin * (arm(later) - d)
        heard.append(0.5 * g * flight)
        angle = later
    times = np.array(heard)
    return np.asarray((times[1:] / times[:-1]).T)


def scatter(body: Body) -> tuple[float, float, float]:
    """Give the standard deviation of the last ε: of a clock, of Eq. 1, in closed form."""
    data = rs.error_budget(body, LAW, drop=DROP, impacts=IMPACTS, particles=2000, drag=None).data
    run = rs.simulate(
        body, LAW, particles=2000, impacts=IMPACTS, release_height=DROP + DIAMETER / 2.0, gravity=GRAVITY
    )
    heard = float(data.standard_deviation.sel(source="shape")[-1])
    return heard, float(run.restitution[:, -1].std()), float(data.turning_standard_deviation[-1])


@fg.styled
def draw(*, style: Style | None = None) -> Figure:
    """Draw the scatter of the last ε against the out-of-roundness."""
    deviations = DIAMETER * np.geomspace(3e-5, 3e-2, 16)
    heard, true, closed = np.array([scatter(rs.from_roundness(DIAMETER, t)) for t in deviations]).T
    figure, [[axes]] = fg.panels(*column(3.0))
    axes.loglog(1e6 * deviations, true, marker="s", color=colors()[1], label="Eq. 1")
    axes.loglog(1e6 * deviations, heard, marker="o", color=colors()[0], label="times of flight")
    axes.loglog(1e6 * deviations, closed, "--", color=ink(0.7), label="closed form, angles independent")
    v, last = np.sqrt(2.0 * GRAVITY * DROP), IMPACTS - 1
    slope = 4.0 * (1.0 + NORMAL) * NORMAL * (v * NORMAL**last) ** 2 / (0.4 * (DIAMETER / 2.0) ** 2) / GRAVITY
    axes.axvline(1e6 / slope, color="0.6", linewidth=0.7)
    axes.text(1e6 / slope, 3e-9, " K = 1", fontsize="small")
    axes.set_xlabel("out-of-roundness (µm)")
    axes.set_ylabel(r"standard deviation of $\varepsilon$ at 0.5 m/s")
    axes.legend()
    return figure


def forms() -> str:
    """Tabulate the same out-of-roundness in different forms."""
    lines = ["| form | " + " | ".join(f"t = {1e6 * t:g} µm" for t in FORMS_AT) + " |"]
    lines.append("|---" * (1 + len(FORMS_AT)) + "|")
    bodies = {
        "two lobes (prolate)": {"form": "lobed"},
        "flattened (oblate)": {"form": "flattened"},
        "dumbbell": {"form": "dumbbell"},
        "centre of mass off by t": {"form": "off-centre"},
        "three lobes, equivalent body": {"form": "lobed", "lobes": 3},
        "five lobes, equivalent body": {"form": "lobed", "lobes": 5},
    }
    for name, form in bodies.items():
        cells = [f"{scatter(rs.from_roundness(DIAMETER, t, **form))[0]:.1e}" for t in FORMS_AT]  # type: ignore[arg-type]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    for lobes, name in ((2, "two"), (3, "three"), (5, "five")):
        cells = [f"{kicked(t, lobes, 2000, IMPACTS)[:, -1].std():.1e}" for t in FORMS_AT]
        lines.append(f"| {name} lobes, map of the kicked rotor | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


FORMS_AT = (3e-6, 1e-5, 3e-5, 1e-4)


def balls() -> str:
    """Tabulate what balls are, and what their shape does beside everything else."""
    lines = [
        "| ball | t (µm) | Ra (µm) | L/R | kick K | one ε: shape | and friction | one ε: roughness "
        "| one ε: the rest | mean: shape | and friction | mean: roughness | mean: the rest |"
    ]
    lines.append("|---" * 13 + "|")
    every = {
        f"steel, grade {grade}": (6e-3, t, STEEL, ROUGHNESS.get(grade, 0.0)) for grade, t in GRADES.items()
    }
    every |= {name: (*ball, 0.0) for name, ball in BALLS.items()}
    for name, (diameter, t, density, ra) in every.items():
        body = rs.from_roundness(diameter, t, density=density)
        setting = {"drop": DROP, "impacts": IMPACTS, "roughness": ra} | STATED
        data = rs.error_budget(body, LAW, **setting).data  # type: ignore[arg-type]
        sticks = rs.error_budget(body, STICKS, drop=DROP, impacts=IMPACTS).data.sel(source="shape")
        rest = ["timing", "gravity", "drop"]
        parts = []
        for variable, stuck in (
            (data.standard_deviation.isel(impact=-1), sticks.standard_deviation[-1]),
            (data.mean_standard_deviation, sticks.mean_standard_deviation),
        ):
            parts.append(f"{float(variable.sel(source='shape')):.1e}")
            parts.append(f"{float(stuck):.1e}")
            parts.append(f"{float(variable.sel(source='roughness')):.1e}" if ra else "–")
            parts.append(f"{float(np.sqrt((variable.sel(source=rest) ** 2).sum())):.1e}")
        cells = [
            name,
            f"{1e6 * t:g}",
            f"{1e6 * ra:g}" if ra else "–",
            f"{4.0 * t / diameter:.2g}",
            f"{float(data.kick[0]):.2g}",
            *parts,
        ]
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def budget() -> rs.ErrorBudget:
    """Budget of a glass bead, L/R = 0.01."""
    diameter, t, density = BALLS["glass bead, L/R = 0.01"]
    body = rs.from_roundness(diameter, t, density=density)
    return rs.error_budget(body, LAW, drop=DROP, impacts=IMPACTS, **STATED)  # type: ignore[arg-type]


def required(law: rs.Frictionless | rs.Coulomb = LAW) -> rs.RequiredRoundness:
    """Return the out-of-roundness that 6 mm may have for 0.1 %."""
    return rs.required_roundness(1e-3, diameter=DIAMETER, law=law, drop=DROP, impacts=IMPACTS)


def tables() -> dict[str, str]:
    """All tables of the page, by name."""
    return {
        "balls": balls(),
        "forms": forms(),
        "budget": budget().table() + "\n",
        "required": required().table() + "\n",
        "required with friction": required(STICKS).table() + "\n",
    }


def main(out: Path) -> None:
    """Write figures and tables."""
    out.mkdir(parents=True, exist_ok=True)
    errors, needed = budget(), required()
    for style in SITE:
        drawn = {
            "roundness": (draw(style=style), "Scatter of ε against the out-of-roundness"),
            "budget": (errors.figure(style=style), "Errors of ε of a glass bead by source"),
            "required": (needed.figure(style=style), "Error of ε and roundness"),
        }
        for name, (figure, text) in drawn.items():
            fg.save(figure, out / f"{name}{style[4:]}.png", name.title(), text)
    text = "\n".join(f"{name}\n\n{table}" for name, table in tables().items())
    (out / "roundness.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python examples/roundness.py OUT")
    main(Path(sys.argv[1]))
