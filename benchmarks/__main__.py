"""`python -m benchmarks`: check the physics, time the peers in turns, print tables; `--rows` chooses some."""

import argparse
import warnings
from collections.abc import Iterable
from time import perf_counter
from typing import Any

import restitution as rs
from benchmarks import agreement, bodies, encounters, footprint, machine, studies, timing
from benchmarks.peers import Peers, available, statistics
from benchmarks.work import Peer, Work

CHECKED = 5000  # particles of the fast peers
WINDOW = 8  # of the impact velocity: 0.40 to 0.45 m/s
LONG = 500_000  # particles
PARTS = ("planar", "bodies", "loops", "threads", "encounters", "memory", "studies")


def check(peers: Peers, work: Work, particles: int) -> None:
    """Print how well the peers agree.

    Raises
    ------
    agreement.Disagreement
        Naming the peer that does not.
    """
    worst = agreement.same_impacts(peers.recording, work)
    print(f"\nthe same first impacts: largest difference {worst:.2g} of what rounding allows")
    impacts = agreement.same_counts(peers.engine, work)
    print(f"the same grid of {impacts} impacts, count by count, from every level and number of threads")
    rows: list[Peer[Any]] = [*peers.engine, *peers.counting, *peers.recording]
    spreads, distance = agreement.same_spread(rows, work, min(particles, CHECKED))
    print(f"the same σ(ε) at all impact velocities: largest difference {distance:.2g} standard errors")
    for row, spread in zip(rows, spreads, strict=True):
        print(f"  {spread.value[WINDOW]:.4f} ± {spread.error[WINDOW]:.4f} at 0.40 to 0.45 m/s  {row.name}")


def speed(peers: Peers, work: Work, particles: int, rounds: int) -> None:
    """Time the peers and print the table."""
    start = perf_counter()
    times = timing.rounds(peers.rows, work, particles, rounds)
    yardstick = (peers.counting or peers.engine)[0].name
    print(f"\n{timing.table(times, yardstick)}")
    print(f"\n{rounds} rounds in {perf_counter() - start:.0f} s. Ratios of times, taken within a round:")
    best = rs.build_info()["simd_available"][-1]
    for call, counts_only in (("statistics", False), ("statistics, counts only", True)):
        one, two = (statistics.name(best, threads, counts_only) for threads in (1, 2))
        print(timing.comparison(times, f"{call}: one thread over two", one, two))
    one, two = (row.name for row in peers.recording[:2])
    print(timing.comparison(times, "simulate: one thread over two", one, two))
    for row in peers.writing:
        print(timing.comparison(times, f"simulate, one thread, over {row.name}", one, row.name))
    if peers.counting:  # the clock needs Numba as well
        print("\nshare of the vector units' throughput, best round")
        for line in throughput(times):
            print(line)


def throughput(times: timing.Times) -> list[str]:
    """The share of the vector units' throughput that each level reached."""
    from benchmarks.throughput import clock, shares

    best = {
        level: float(times.wall[:, times.names.index(statistics.name(level, 1))].min())
        for level in rs.build_info()["simd_available"]
    }
    return shares(best, clock(), machine.generation())


def rest(long: bool, only: str) -> None:
    """Print what starting takes, and the memory that statistics need: of every row with `long`."""
    seconds = footprint.start_up()
    print("\nstart   ", ", ".join(f"{name} {value:.3f} s" for name, value in seconds.items()))
    for name in (row.name for row in bodies.EVERY if only in row.name):
        if not long and name != bodies.YARDSTICK.name:
            continue
        for number in (LONG // 100, 10 * LONG if long else LONG):
            found = footprint.memory(number, name)
            print(
                f"memory   at most {found['peak']:.0f} MB, of which {found['before']:.0f} MB before the run "
                f"(<= {MEMORY} MB): {name}, {found['impacts']:.3g} impacts, all threads, "
                f"{found['seconds']:.2f} s"
            )


MEMORY = 200
"""MB that a run of any length may take."""


def planar(options: argparse.Namespace) -> None:
    """The job of Fig. 2 beside the peers."""
    work = Work(impacts=options.impacts)
    peers = available()
    print(f"\nwork     {options.particles} particles, {work}")
    for text in peers.missing:
        print(text)
    check(peers, work, options.particles)
    speed(peers, work, options.particles, options.rounds)


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__)
    parser.add_argument(
        "--rows", nargs="+", choices=PARTS, default=PARTS, help="which tables (default: all of them)"
    )
    parser.add_argument(
        "--only", default="", help="of bodies, threads, encounters and memory: rows whose name contains this"
    )
    parser.add_argument("--rounds", type=int, default=9, help="how often each row is timed (default 9)")
    parser.add_argument("--particles", type=int, default=25_000, help="of the planar job (default 25000)")
    parser.add_argument(
        "--impacts", type=int, default=200, help="of the planar job, a particle (default 200)"
    )
    parser.add_argument("--long", action="store_true", help="memory of every row over 10⁹ impacts")
    options = parser.parse_args()
    if min(options.rounds, options.particles, options.impacts) < 1:
        parser.error("--rounds, --particles and --impacts must be at least 1")

    warnings.simplefilter("ignore", rs.EnergyWarning)
    print(machine.describe())
    if "planar" in options.rows:
        planar(options)
    if "bodies" in options.rows:
        print(f"\n{bodies.HEAD}   over the first row; one thread, ns an impact")
        show(bodies.table(options.rounds, options.only))
    if "loops" in options.rows:
        print(f"\n{bodies.HEAD}   over `statistics` of the same; one thread")
        show(bodies.loops(options.rounds))
    if "threads" in options.rows:
        print(f"\n{bodies.HEAD}   one thread over two; ns with two")
        show(bodies.threads(options.rounds, options.only))
    if "encounters" in options.rows:
        print(f"\n{bodies.HEAD}   over the target; one thread, ns an encounter or a collision")
        show(encounters.table(options.rounds, options.only))
    if "memory" in options.rows:
        rest(options.long, options.only)
    if "studies" in options.rows:
        print()
        show(studies.report())


def show(lines: Iterable[str]) -> None:
    """Print each line as soon as it is known."""
    for text in lines:
        print(text, flush=True)


main()
