"""Hold a clock beside the truth: docs/images/clock.png and the table of docs/listening.md.

Run ``python examples/clock.py OUT`` to write ``clock.png``, ``clock.pdf`` and ``clock.md`` into the folder
OUT. A second argument is the number of particles, 2000 unless given: a few seconds.
"""

import sys
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors, column

Array = npt.NDArray[np.float64]

RADIUS, NORMAL, GRAVITY = 3e-3, 0.98, 9.81
ELONGATIONS = (0.1, 0.01)
"""L/R of the dumbbells."""
EDGES = np.geomspace(0.08, 1.0, 21)
"""Bins of the true impact velocity, in m/s."""
SHOWN = (0.1, 0.2, 0.5, 0.9)
"""Speeds of the rows of the table, in m/s: of each the bin that holds it."""


@dataclass(frozen=True)
class Compared:
    """Differences between clock and truth by impact velocity; arrays over the bins.

    Attributes
    ----------
    elongation : float
        L/R.
    speed : ndarray
        Mean of the impact velocity in each bin, in m/s.
    bias, bias_error, deviation : ndarray
        Mean, its standard error over particles, and standard deviation of ε of the clock less the true ε.
    largest : ndarray
        Largest difference met.
    bound : ndarray
        What it cannot exceed, to first order: the largest of g L/(8 w²) (ε_clock + 1/ε_clock) in the bin.
    truth : ndarray
        Standard deviation of the true ε.
    """

    elongation: float
    speed: Array
    bias: Array
    bias_error: Array
    deviation: Array
    largest: Array
    bound: Array
    truth: Array


def compare(elongation: float, particles: int = 2000, seed: int = 1) -> Compared:
    """Simulate dumbbells under the frictionless law and hold a clock beside them."""
    separation = elongation * RADIUS
    data = rs.flight.clock(
        rs.simulate(
            rs.Dumbbell(radius=RADIUS, separation=separation),
            rs.Frictionless(normal=NORMAL),
            particles=particles,
            impacts=200,
            release_height=0.06,
            gravity=GRAVITY,
            seed=seed,
        )
    )
    off = (data.clock_restitution - data.restitution).values
    velocity = data.impact_velocity.values
    before = data.clock_velocity.values
    after = np.roll(before, -1, axis=1)
    # |h_{i+1} - h_i| <= L/2 in both flights.
    bound = GRAVITY * separation / 4.0 * (1.0 / before**2 + 1.0 / after**2) * data.clock_restitution.values
    columns = []
    for low, high in pairwise(EDGES):
        inside = (velocity >= low) & (velocity < high) & np.isfinite(off)
        values = off[inside]
        # Impacts of one particle are correlated: the error is over the sums of particles.
        sums = np.where(inside, off, 0.0).sum(axis=1)
        counts = inside.sum(axis=1)
        mean = values.mean()
        error = np.sqrt(np.sum((sums - mean * counts) ** 2)) / counts.sum()
        truth = data.restitution.values[inside].std()
        largest = np.abs(values).max()
        columns.append(
            (velocity[inside].mean(), mean, error, values.std(), largest, bound[inside].max(), truth)
        )
    return Compared(elongation, *np.array(columns).T)


@fg.styled
def draw(found: list[Compared], *, style: Style | None = None) -> Figure:
    """Draw standard deviation, largest difference and typical bound against the speed."""
    figure, [[axes]] = fg.panels(*column(2.9))
    for number, one in enumerate(found):
        color, name = colors()[number], f"$L/R$ = {one.elongation:g}"
        marker = fg.MARKERS[number]
        axes.loglog(one.speed, one.deviation, color=color, marker=marker, label=f"{name}: standard deviation")
        axes.loglog(one.speed, one.largest, color=color, linestyle="none", marker="x", label="largest of all")
        bound = GRAVITY * one.elongation * RADIUS / (2.0 * one.speed**2)
        axes.loglog(one.speed, bound, color=color, linestyle="--", label="$gL/(2v^2)$")
    axes.set_ylim(2e-5, 1.0)
    axes.set_xlim(0.07, 1.1)
    axes.set_xlabel("impact velocity $v$ (m/s)")
    axes.set_ylabel("$|\\varepsilon_{\\mathrm{clock}} - \\varepsilon|$")
    figure.legend(ncols=2, loc="outside upper center")
    return figure


def table(found: list[Compared]) -> str:
    """Write the table of docs/listening.md."""
    lines = ["| L/R | v (m/s) | bias (10⁻⁴) | deviation | largest | gL/(2v²) | deviation of ε |"]
    lines.append("|---|---|---|---|---|---|---|")
    for one in found:
        for speed in SHOWN:
            k = int(np.searchsorted(EDGES, speed)) - 1
            v = one.speed[k]
            bound = GRAVITY * one.elongation * RADIUS / (2.0 * v**2)
            cells = [
                f"{one.elongation:g}",
                f"{v:.2f}",
                f"{1e4 * one.bias[k]:.2f} ± {1e4 * one.bias_error[k]:.2f}",
            ]
            cells += [f"{value:.2g}" for value in (one.deviation[k], one.largest[k], bound, one.truth[k])]
            lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def main(out: Path, particles: int) -> None:
    """Write figure and table."""
    found = [compare(elongation, particles) for elongation in ELONGATIONS]
    out.mkdir(parents=True, exist_ok=True)
    text = "What a clock makes of the coefficient of restitution"
    for style in SITE:
        fg.save(draw(found, style=style), out / f"clock{style[4:]}.png", "Clock and truth", text)
    (out / "clock.md").write_text(table(found), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: python examples/clock.py OUT [PARTICLES]")
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) == 3 else 2000)
