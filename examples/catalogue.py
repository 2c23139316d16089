"""Learned distributions p(ε | v) of a standard set of bodies and laws.

    python examples/catalogue.py FOLDER

runs a study for each kind of body and law, goes on where it was stopped, and writes a file for each point:
`rs.FluctuatingRestitution.load(file)` reads one, and its `to_c` and `to_fortran` write it for a simulation in
another language. It prints the table of docs/studies.md.
"""

import sys
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import restitution as rs
from restitution.study import learned

RADIUS = 3e-3
NORMALS = [0.7, 0.9, 0.98]
BODIES: dict[str, tuple[Any, str, list[float]]] = {
    "dumbbell": (rs.Dumbbell(radius=RADIUS, separation=RADIUS), "separation", [3e-4, 1.5e-3, 6e-3]),
    "spheroid": (rs.Spheroid(equatorial=RADIUS, polar=RADIUS), "polar", [2.4e-3, 3.3e-3, 6e-3]),
}
"""A body, the parameter that is varied, in m, and its values."""
LAWS: dict[str, Any] = {
    "tangential-restitution": rs.TangentialRestitution(normal=0.9),
    "frictionless": rs.Frictionless(normal=0.9),
    "coulomb": rs.Coulomb(normal=0.9, friction=0.3),
}
HEIGHTS = {"from": 0.02, "to": 0.12, "points": 16, "scale": "log"}
"""Heights of release, in m: of one height, a nearly round body meets some speeds never."""
PARTICLES = 500
"""Of each height."""


def studies(particles: int = PARTICLES) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Give the kind of body, the kind of law and the study of each pair."""
    for (body, (base, parameter, values)), (law, impulse) in product(BODIES.items(), LAWS.items()):
        varied = {f"body.{parameter}": values, "law.normal": NORMALS, "run.release_height": HEIGHTS}
        statistics = {
            "velocity_bins": {"from": 0.0, "to": 1.1, "bins": 11},
            "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 800},
        }
        run = {"particles": particles, "impacts": 300}
        yield body, law, {"body": base, "law": impulse, "run": run, "sweep": varied, "statistics": statistics}


def make(folder: Path, particles: int = PARTICLES) -> Iterator[str]:
    """Run the studies, write the files, and give the lines of the table."""
    yield "| body | law | ε_n | σ at 0.35 m/s | kB |"
    yield "|---|---|---|---|---|"
    for body, law, study in studies(particles):
        store = folder / f"{body}_{law}.zarr"
        rs.sweep(study, out=store, progress=sys.stderr.isatty())
        _, parameter, values = BODIES[body]
        for value in values:
            files, spreads = [], []
            for normal in NORMALS:
                distribution = learned(store, normal=normal, **{parameter: value})
                file = folder / f"{body}_{value / RADIUS:g}_{law}_{normal:g}.nc"
                distribution.save(file, replace=True)
                files.append(file.stat().st_size)
                spreads.append(f"{float(distribution.std(0.35)):.2g}")
            ratio = f"{parameter}/{RADIUS * 1e3:g} mm = {value / RADIUS:g}"
            normals = ", ".join(f"{normal:g}" for normal in NORMALS)
            yield f"| {body}, {ratio} | {law} | {normals} | {', '.join(spreads)} | {sum(files) / 1e3:.0f} |"


if __name__ == "__main__":
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    for line in make(target):
        print(line, flush=True)
