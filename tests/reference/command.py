"""The command line, and a small run to give it."""

import os
import shutil
import sys
import tempfile
import warnings
from collections.abc import Callable
from functools import partial
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import xarray as xr
from typer.testing import CliRunner, Result

import restitution as rs
from restitution.cli import app, main

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


SERVER: Any = get_context("spawn" if sys.platform == "win32" else "forkserver")
_PRELOADED = "restitution.cli restitution.fit xarray netCDF4 scipy.stats matplotlib.figure zarr soundfile"
SERVER.set_forkserver_preload(_PRELOADED.split())


class Apart:
    """A function in a process of its own, which has imported what commands take."""

    def __init__(self, act: Callable[[], object]) -> None:
        self._told = Path(tempfile.mkdtemp(prefix="apart-"))
        self._process = SERVER.Process(target=_apart, args=(self._told, act, Path.cwd()))
        self._process.start()

    def send_signal(self, number: int) -> None:
        """Send a signal to the process and those that it has started."""
        if sys.platform != "win32":
            os.killpg(self._process.pid or 0, number)

    def poll(self) -> int | None:
        """Give the exit status, once there is one."""
        found: int | None = self._process.exitcode
        return found

    def finished(self, seconds: float = 300.0) -> tuple[int, str, str]:
        """Wait for it; it must not hang. Give its exit status and what it says."""
        self._process.join(seconds)
        self._process.kill()
        self._process.join()
        said = [(self._told / name).read_text(encoding="utf-8") for name in ("out", "error")]
        shutil.rmtree(self._told)
        return self._process.exitcode or 0, said[0], said[1]


class Command(Apart):
    """A command in a process of its own; `before` is called first."""

    def __init__(self, *words: object, before: Callable[[], object] = int) -> None:
        super().__init__(partial(_command, before, [str(word) for word in words]))


class Program(Apart):
    """A program in a process of its own, which may have words and more environment; warnings are silent."""

    def __init__(self, code: str, *words: object, **environment: str) -> None:
        super().__init__(partial(_program, code, [str(word) for word in words], environment))

    def said(self) -> str:
        """Give what it prints when all goes well."""
        status, out, error = self.finished(120.0)
        assert (status, error) == (0, ""), error
        return out


def _apart(told: Path, act: Callable[[], object], folder: Path) -> None:
    if sys.platform != "win32":
        os.setsid()
    os.chdir(folder)
    for number, name in ((1, "out"), (2, "error")):
        os.dup2(os.open(told / name, os.O_WRONLY | os.O_CREAT), number)
    act()


def _command(before: Callable[[], object], words: list[str]) -> None:
    before()
    sys.argv = ["restitution", *words]
    main()


def _program(code: str, words: list[str], environment: dict[str, str]) -> None:
    os.environ |= environment
    sys.argv = ["program", *words]
    warnings.simplefilter("ignore")
    exec(code, {"__name__": "__main__"})


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
