"""Harmed files and random tables: a moment of what `make hostile` does for long."""

import os
import subprocess
import sys
from pathlib import Path

TESTS = Path(__file__).parents[1]


def test_harmed_files_and_random_tables() -> None:
    """An error of ours that names the file or the argument, or a right result; never an abort or a hang."""
    words = [sys.executable, str(TESTS / "manual" / "fuzz.py"), "--rounds", "3"]
    env = os.environ | {"PYTHONPATH": str(TESTS), "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    done = subprocess.run(words, capture_output=True, text=True, check=False, timeout=900, env=env)
    assert (done.returncode, done.stderr) == (0, ""), done.stdout
