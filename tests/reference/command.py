"""The command line, and a small run to give it."""

import os
import sys
from multiprocessing import get_context
from pathlib import Path

import xarray as xr
from typer.testing import CliRunner, Result

import restitution as rs
from reference.signals import arm
from restitution.cli import app, main

COMMAND = [sys.executable, "-c", "from restitution.cli import main; main()"]
AMONG_TESTS = f"import sys; sys.path.insert(0, {str(Path(__file__).parents[1])!r})\n"
"""How a program begins that imports from here."""

SMALL = """
[body]
shape = "dumbbell"
radius = 2e-3
separation = 3e-3
density = 7800

[law]
type = "tangential-restitution"
normal = 0.9
tangential = 0.95

[run]
particles = 7
impacts = 11
release_height = 0.05
gravity = 1.62
orientation = "isotropic"
minimum_speed = 0.1
seed = 18446744073709551615
"""

LONG = """
[body]
shape = "dumbbell"
radius = 3e-3
separation = 3e-4
[law]
type = "tangential-restitution"
normal = 0.98
[run]
impacts = 20
particles = """
"""A run that takes as long as the number that follows says."""


def invoke(*words: object) -> Result:
    """Run a command in this process."""
    return CliRunner().invoke(app, [str(word) for word in words])


SERVER = get_context("forkserver")
SERVER.set_forkserver_preload(["restitution.cli", "xarray", "netCDF4", "scipy.stats", "matplotlib.figure"])


def forked(number: int, name: str, words: list[str], folder: Path, told: Path) -> int | None:
    """Run a command in a process that has imported all, with a signal when it is at work; give its status."""
    process = SERVER.Process(target=_command, args=(number, name, words, folder, told))
    process.start()
    process.join(120)
    process.kill()
    return process.exitcode


def _command(number: int, name: str, words: list[str], folder: Path, told: Path) -> None:
    os.chdir(folder)
    with told.open("wb") as file:
        os.dup2(file.fileno(), 1)
        os.dup2(file.fileno(), 2)
    arm(number, name)
    sys.argv = ["restitution", *words]
    main()


def small() -> xr.Dataset:
    """The same run as a call."""
    return rs.simulate(
        rs.Dumbbell(radius=2e-3, separation=3e-3, density=7800),
        rs.TangentialRestitution(normal=0.9, tangential=0.95),
        particles=7,
        impacts=11,
        release_height=0.05,
        gravity=1.62,
        orientation="isotropic",
        minimum_speed=0.1,
        seed=2**64 - 1,
    )


def load(path: Path) -> xr.Dataset:
    """A netCDF file as xarray reads it without being told anything."""
    return xr.load_dataset(path)
