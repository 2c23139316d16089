"""Draw what a student should get: docs/images/lab-sheet.png.

Run ``python examples/lab_sheet.py OUT`` to write ``lab-sheet.png``, and ``lab-sheet-dark.png`` for the dark,
into the folder OUT: a simulated table-tennis ball that is not quite round, timed with an error of 20 µs.
"""

import sys
from pathlib import Path

import numpy as np
import xarray as xr

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE

ERROR = 20e-6


def measured() -> tuple[xr.Dataset, rs.flight.LawFit]:
    """Drop a shell of L = 0.4 mm once, and fit a constant to it."""
    ball = rs.Dumbbell(radius=19.8e-3, separation=0.4e-3, wall=0.4e-3)
    law = rs.Frictionless(normal=0.94)
    run = rs.simulate(ball, law, particles=1, impacts=40, release_height=0.25, seed=3)
    noise = np.random.default_rng(1).normal(0.0, ERROR, run.sizes["impact"])
    data = rs.flight.restitution(run.time.values[0] + noise, ERROR)
    return data, rs.flight.fit(data, "constant", scatter="fit")


def main(out: Path) -> None:
    """Write the figure."""
    out.mkdir(parents=True, exist_ok=True)
    data, fit = measured()
    for style in SITE:
        figure = rs.flight.figure(data, fit, style=style)
        text = "ε against v of a ball that is not quite round"
        fg.save(figure, out / f"lab-sheet{style[4:]}.png", "Lab sheet", text)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python examples/lab_sheet.py OUT")
    main(Path(sys.argv[1]))
