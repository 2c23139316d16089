"""The time of the start, and the memory that statistics need.

`python -m benchmarks.footprint PARTICLES ROW` runs a row of `bodies` and prints what it took; `memory` does
that in a process of its own.
"""

import json
import subprocess
import sys
import sysconfig
import warnings
from pathlib import Path
from time import perf_counter

import numpy as np

ROOT = Path(__file__).parents[1]


def start_up(repeats: int = 5) -> dict[str, float]:
    """Seconds from start to end, medians: the bare interpreter, the import, the command line."""
    program = Path(sysconfig.get_path("scripts")) / "restitution"
    commands = {
        "python -c pass": [sys.executable, "-c", "pass"],
        "import restitution": [sys.executable, "-c", "import restitution"],
        "restitution --help": [str(program), "--help"],
    }
    return {
        name: float(np.median([_seconds(command) for _ in range(repeats)]))
        for name, command in commands.items()
    }


def _seconds(command: list[str]) -> float:
    start = perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return perf_counter() - start


def memory(particles: int, row: str) -> dict[str, float]:
    """Impacts, seconds, and the most memory resident (MB) before and at the end; NaN where unknown."""
    command = [sys.executable, "-m", "benchmarks.footprint", str(particles), row]
    done = subprocess.run(command, check=True, capture_output=True, text=True, cwd=ROOT)
    found: dict[str, float] = json.loads(done.stdout)
    return found


def peak() -> float:
    """The most memory this process has had resident so far, in MB."""
    path = Path("/proc/self/status")
    for line in path.read_text().splitlines() if path.exists() else ():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) * 1024 / 1e6
    return float("nan")


def main() -> None:
    import restitution as rs
    from benchmarks.bodies import EVERY, LEAST_LEARNED

    warnings.simplefilter("ignore", rs.EnergyWarning)
    row = next(row for row in EVERY if row.name == sys.argv[2])
    row.run(LEAST_LEARNED if row.learned else 1, threads=0, seed=0)  # imports
    before, start = peak(), perf_counter()
    number = row.run(int(sys.argv[1]), threads=0, seed=1)
    seconds = perf_counter() - start
    print(json.dumps({"impacts": number, "seconds": seconds, "before": before, "peak": peak()}))


if __name__ == "__main__":
    main()
