"""`python -m benchmarks`: check the physics, time the peers in turns, print one table."""

import argparse

from benchmarks import agreement, machine, timing
from benchmarks.peers import available
from benchmarks.work import Work


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument("--rounds", type=int, default=7, help="how often each peer is timed (default 7)")
    parser.add_argument("--particles", type=int, default=5000, help="particles a round (default 5000)")
    parser.add_argument("--impacts", type=int, default=200, help="impacts a particle (default 200)")
    options = parser.parse_args()
    if min(options.rounds, options.particles, options.impacts) < 1:
        parser.error("--rounds, --particles and --impacts must be at least 1")

    work = Work(impacts=options.impacts)
    peers, missing = available()
    print(machine.describe())
    print(f"work     {options.particles} particles, {work}")
    for line in missing:
        print(line)

    worst = agreement.same_impacts(peers, work)
    print(f"\nthe same first impacts: largest difference {worst:.2g} of what rounding allows")
    for name, value, error in agreement.same_spread(peers, work, options.particles):
        print(f"  sigma(ε) at {agreement.SPEED} m/s: {value:.4f} ± {error:.4f}  {name}")

    times = timing.rounds(peers, work, options.particles, options.rounds)
    print(f"\n{timing.table([peer.name for peer in peers], times)}")


main()
