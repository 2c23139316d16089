"""What is not speed: how long the start takes, and how much memory statistics need.

`python -m benchmarks.footprint PARTICLES` runs statistics and prints what they took; `memory` does that in a
process of its own.
"""

import json
import subprocess
import sys
import sysconfig
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


def memory(particles: int) -> dict[str, float]:
    """Impacts, seconds, and the most memory resident (MB) before and at the end; NaN where unknown."""
    command = [sys.executable, "-m", "benchmarks.footprint", str(particles)]
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
    from benchmarks.work import Work

    work = Work()

    def run(particles: int) -> int:
        found = rs.statistics(
            rs.Dumbbell(radius=work.radius, separation=work.separation),
            rs.TangentialRestitution(normal=work.normal, tangential=work.tangential),
            particles=particles,
            impacts=work.impacts,
            release_height=work.release_height,
            gravity=work.gravity,
            velocity_bins=work.lattice.velocity,
            restitution_bins=work.lattice.restitution,
        )
        return int(found["number"].sum() + found["velocity_underflow"] + found["velocity_overflow"])

    run(1)  # imports
    before, start = peak(), perf_counter()
    number = run(int(sys.argv[1]))
    seconds = perf_counter() - start
    print(json.dumps({"impacts": number, "seconds": seconds, "before": before, "peak": peak()}))


if __name__ == "__main__":
    main()
