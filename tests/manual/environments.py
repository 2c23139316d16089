"""Every command in every hostile environment; `make hostile` does all, tests a part."""

import argparse
import random
import sys
import warnings

import restitution as rs
from reference.commands import COMMANDS, LONG
from reference.environments import ENVIRONMENTS
from reference.processes import command


def main() -> int:
    """Tell what breaks the contract."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--commands", type=int, help="draw so many commands")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("only", nargs="*", help="words of names, of commands or environments")
    asked = parser.parse_args()
    warnings.filterwarnings("ignore", category=rs.EnergyWarning)
    draw = random.Random(asked.seed)
    jobs = [(name, place) for name in COMMANDS for place in ENVIRONMENTS]
    if asked.commands is not None:
        jobs = draw.sample([job for job in jobs if job[0] not in LONG], asked.commands)
    failures = 0
    chosen = [job for job in jobs if all(word in job for word in asked.only)]
    for name, place in chosen:
        found = command(name, place, draw)
        if found is not None:
            failures += 1
            print(f"{name}, {place}: {found}", flush=True)
    print(f"{len(chosen)} trials, {failures} break the contract")
    return min(failures, 1)


# To be run with OPENBLAS_NUM_THREADS=1: a process with threads had better not fork.
if __name__ == "__main__":
    sys.exit(main())
