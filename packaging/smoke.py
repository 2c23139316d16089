"""Run what is installed in an empty folder: the command, and files of every kind that it writes."""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

LINES = (
    "--version",
    "simulate run.toml --out run.nc",
    "statistics run.toml --out counts.nc",
    "distribution run.toml --out dist.nc --header dist.h --fortran dist.f90 --figure dist.png",
    "fit run.nc --velocity 0.5 0.9 --resamples 5",
)
RUN = """
body = { shape = "dumbbell", radius = 3e-3, separation = 3e-3 }
law = { type = "tangential-restitution", normal = 0.9 }
[run]
particles = 3000
impacts = 20
[statistics]
velocity_bins = 12
velocity_range = [0.0, 1.2]
restitution_bins = 40
restitution_range = [-1.0, 3.0]
[distribution]
velocities = [0.4, 0.7]
"""

with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    Path("run.toml").write_text(RUN, encoding="utf-8")
    for line in LINES:
        print(f"restitution {line}", flush=True)
        subprocess.run([sys.executable, "-m", "restitution", *line.split()], check=True)
    for name in ("run.nc", "counts.nc", "dist.nc", "dist.h", "dist.f90", "dist.png"):
        assert Path(name).stat().st_size > 0
    os.chdir("/")  # Windows removes no folder that a process is in
