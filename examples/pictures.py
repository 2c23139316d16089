"""Pictures and films of bodies and impacts: `python examples/pictures.py OUT` writes them into a folder."""

import sys
from pathlib import Path

import xarray as xr

import restitution as rs

IMPACT, GAIN, NEGATIVE = (79, 7), (391, 4), (24, (9, 10))
"""Particle and impacts: of the drawing, and of the films, one with ε > 1, one with ε < 0 and the next."""


def drops() -> xr.Dataset:
    """Drop dumbbells of two touching spheres; friction takes energy from every impact."""
    body, law = rs.Dumbbell(radius=3e-3, separation=6e-3), rs.Coulomb(normal=0.9, friction=0.3)
    return rs.simulate(body, law, particles=400, impacts=12, record="state", seed=1)


def main(folder: Path) -> None:
    """Write everything."""
    data = drops()
    for ground in ("page", "page-dark"):
        drawn = rs.figures.impact(data, *IMPACT, style=ground)
        name = f"impact{ground.removeprefix('page')}.png"
        rs.figures.save(drawn, folder / name, title="An impact before and after")
    for name, (particle, impacts) in (("gain", GAIN), ("negative", NEGATIVE)):
        rs.figures.animate(data, particle, impacts, style="page").save(folder / f"{name}.gif")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
