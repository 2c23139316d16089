"""A small study, what runs it in processes of its own, and the bits of its store."""

import hashlib
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import restitution as rs
from reference.command import Command

SMALL_STUDY = """
[body]
shape = "dumbbell"
radius = 3e-3

[law]
type = "tangential-restitution"

[run]
particles = 64
impacts = {impacts}
seed = 7

[sweep]
"body.separation" = [1e-4, 3e-4, 2e-3]
"law.normal" = {{ from = 0.7, to = 0.98, points = {normals} }}

[statistics]
velocity_bins = {{ from = 0.0, to = 1.1, bins = 11 }}
restitution_bins = {{ from = -1.0, to = 3.0, bins = 40 }}

[effort]
batches = 4
"""

TINY: dict[str, Any] = {
    "body": rs.Dumbbell(radius=3e-3, separation=3e-4),
    "law": rs.TangentialRestitution(normal=0.98),
    "run": {"particles": 16, "impacts": 20, "seed": 7, "release_height": 0.05},
    "sweep": {"body.separation": [1e-4, 2e-3], "law.normal": [0.9, 0.95, 0.98]},
    "statistics": {
        "velocity_bins": {"from": 0.0, "to": 1.1, "bins": 5},
        "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 8},
    },
    "effort": {"batches": 4},
}
"""A study of six points, for its store alone."""


def written(folder: Path, *, impacts: int = 60, normals: int = 2) -> Path:
    """Write a study of 3 x normals points."""
    path = folder / "study.toml"
    path.write_text(SMALL_STUDY.format(impacts=impacts, normals=normals), encoding="utf-8")
    return path


def when(holds: Callable[[], bool], process: Command | None = None, seconds: float = 120) -> None:
    """Wait until something holds, as long as a process lives."""
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, "it never came to hold"
        assert process is None or process.poll() is None, process.finished()
        time.sleep(0.01)


def chunks(store: Path) -> list[Path]:
    """Chunks of the tasks that are done."""
    return sorted(path for path in (store / "tasks" / "words" / "c").glob("*/*/0"))


def bits(store: Path) -> dict[str, str]:
    """Digests of everything in a store, but for what a killed process left half-written."""
    files = (path for path in store.rglob("*") if path.is_file() and path.suffix != ".partial")
    return {
        os.fspath(path.relative_to(store)): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in files
        if path != store / "zarr.json"  # the order in which it lists the arrays is that of the directory
    }
