"""Every command with what it reads, and whether what it gives is the same again."""

import shutil
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import matplotlib.figure
import numpy as np
import xarray as xr

from reference import measuring
from reference.contract import CALLS
from restitution import study

RUN = """
body = { shape = "dumbbell", radius = 3e-3, separation = 3e-3 }
law = { type = "tangential-restitution", normal = 0.9 }
[run]
particles = PARTICLES
impacts = 20
[statistics]
velocity_bins = 12
velocity_range = [0.0, 1.2]
restitution_bins = 40
restitution_range = [-1.0, 3.0]
[distribution]
velocities = [0.4, 0.7]
"""
STUDY = RUN.partition("[distribution]")[0] + '[sweep]\n"law.normal" = [0.8, 0.9]\n'

GRAINS = """
body = { shape = "dumbbell", radius = 3e-3, separation = 3e-3 }
law = { type = "frictionless", normal = 0.9 }
"""
PAIR = (
    GRAINS + "pair = { translational_temperature = 1e-9, rotational_temperature = 1e-9, encounters = 2000 }"
)
GAS = GRAINS + "gas = { translational_temperature = 1e-9, particles = 400, collisions = 5 }"

COMMANDS: dict[str, tuple[str, str]] = {
    # name: the words, and the files that they write
    "template": ("template", ""),
    "version": ("--version", ""),
    "help": ("simulate --help", ""),
    "simulate": ("simulate run.toml --out run.nc", "run.nc"),
    "statistics": ("statistics run.toml --out counts.nc", "counts.nc"),
    "compare": ("compare run.toml --out compared.nc", "compared.nc"),
    "distribution": (
        "distribution learn.toml --out dist.nc --header dist.h --fortran dist.f90 --figure dist.png",
        "dist.nc dist.h dist.f90 dist.png",
    ),
    "pair": ("pair pair.toml --out pairs.nc", "pairs.nc"),
    "gas": ("gas gas.toml --out gas.nc", "gas.nc"),
    "fit": ("fit data.nc --velocity 0.5 0.9 --resamples 5", ""),
    "listen": ("listen ball.wav --diameter 0.02 --out ball.html", "ball.html ball.csv ball.nc"),
    "laws": ("laws --out laws --impacts 19680", "laws"),
    "paper": ("paper --out paper --impacts 400000", "paper"),
    "rough": ("rough --out rough --impacts 400000", "rough"),
    "gas-figures": ("gas-figures --out gas --particles 1000", "gas"),
    "explore": ("explore run.toml --no-browser", ""),
    "sweep": ("sweep study.toml --out study.zarr", "study.zarr"),
    "sweep merge": ("sweep merge --out done.zarr", ""),
    "sweep status": ("sweep --status study.toml --out done.zarr", ""),
}
"""Every command, small. `explore` ends by a signal alone."""
LONG = {"paper", "rough", "gas-figures"}
"""Commands that take minutes, which only `make hostile` runs."""


@cache
def inputs() -> Path:
    """Give a folder with what commands read."""
    folder = Path(tempfile.mkdtemp(prefix="inputs-"))
    (folder / "run.toml").write_text(RUN.replace("PARTICLES", "3000"), encoding="utf-8")
    (folder / "learn.toml").write_text(RUN.replace("PARTICLES", "3000"), encoding="utf-8")
    (folder / "pair.toml").write_text(PAIR, encoding="utf-8")
    (folder / "gas.toml").write_text(GAS, encoding="utf-8")
    (folder / "study.toml").write_text(STUDY.replace("PARTICLES", "256"), encoding="utf-8")
    CALLS["simulate"][0](**CALLS["simulate"][1]() | {"particles": 300}).to_netcdf(folder / "data.nc")
    shutil.copy(measuring.recording(), folder / "ball.wav")
    shutil.copytree(measuring.store(), folder / "done.zarr")
    return folder


def same(found: Any, expected: Any) -> bool:
    """Whether two results are equal, as far as such results can be compared."""
    if isinstance(found, xr.Dataset | xr.DataArray | xr.DataTree):
        return bool(found.identical(expected))
    if isinstance(found, np.ndarray | np.generic | float | int | str | bytes):
        return bool(np.array_equal(found, expected, equal_nan=isinstance(found, np.ndarray | float)))
    if isinstance(found, study.Estimate):  # which measures how long something takes
        return (found.points, found.tasks, found.store) == (expected.points, expected.tasks, expected.store)
    if isinstance(found, dict):
        return set(found) == set(expected)  # of build_info, which tells how many cores there are
    if isinstance(found, tuple | list):
        return len(found) == len(expected) and all(map(same, found, expected))
    if "Explorer" in type(found).__name__:  # a class that is made by each call
        return type(found).__name__ == type(expected).__name__
    kind: Any = type(found)
    if isinstance(found, matplotlib.figure.Figure) or kind.__eq__ is object.__eq__:
        return type(found) is type(expected)
    return bool(found == expected)
