"""The recipe for soft spheres: damping beside the closed form of an oscillator, and the compiled gas."""

import runpy
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import restitution as rs

FOLDER = Path(__file__).parents[2] / "examples" / "dem"


def test_damping_gives_the_restitution_that_is_asked() -> None:
    """2000 steps locate the end of the contact to 1/2000 of it; pulling forces are part of the model."""
    rebound = runpy.run_path(str(FOLDER / "soft_spheres.py"))["rebound"]
    asked = np.array([0.05, 0.5, 0.9, 1.5, 4.0])
    np.testing.assert_allclose(rebound(asked, 2000), asked, rtol=4e-3, atol=4e-3)
    without = rebound(asked, 2000, pulls=False)
    assert (without[:2] > 1.1 * asked[:2]).all()
    assert (without[3:] < 0.98 * asked[3:]).all()


@pytest.mark.skipif(shutil.which("g++") is None, reason="no C++ compiler")
@pytest.mark.parametrize(("mode", "low", "high"), [("1", 0.98, 1.02), ("0.5", 0.5, 0.9), ("drawn", 0.3, 1.5)])
@pytest.mark.filterwarnings("ignore::restitution.DistanceWarning")
def test_the_gas(mode: str, low: float, high: float, tmp_path: Path) -> None:
    """A few contacts of each sphere: an elastic gas keeps its energy, a plastic one loses it."""
    grain = rs.FluctuatingRestitution.learn(
        rs.Dumbbell(radius=3e-3, separation=3e-3),
        rs.Frictionless(normal=0.9),
        particles=400,
        velocities=(0.05, 0.8),
    )
    grain.to_c(tmp_path / "grain.h", name="grain")
    assert "energy_created_share = 0.0" in (tmp_path / "grain.h").read_text()
    source, program = FOLDER / "soft_spheres.cpp", tmp_path / "soft_spheres"
    compiler = ["g++", "-O2", "-std=c++17", "-Wall", "-Werror", f"-I{tmp_path}"]
    subprocess.run([*compiler, "-o", program, source], check=True)
    told = subprocess.run(
        [program, mode, "0.4", "0.03", "1"], check=True, capture_output=True, text=True
    ).stdout
    rows = np.array([line.split() for line in told.splitlines()], dtype=float)
    assert rows[-1, 2] > 0.5
    assert low < rows[-1, 1] / rows[0, 1] < high
