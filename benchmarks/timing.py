"""Time the peers in turns, so that the machine's drift hits all of them alike."""

from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter, process_time
from typing import Any

import numpy as np

from benchmarks.work import Array, Grid, Peer, Work


@dataclass(frozen=True)
class Times:
    """Nanoseconds an impact, shape (rounds, peers): on the clock, and of CPU time over all threads."""

    names: Sequence[str]
    wall: Array
    cpu: Array

    def ratios(self, over: str, under: str) -> Array:
        """Time of one row over that of another on the clock, taken within each round."""
        return self.wall[:, self.names.index(over)] / self.wall[:, self.names.index(under)]


def impacts(result: Any, work: Work, particles: int) -> int:
    """Only impacts that happened count."""
    if result is None:
        return particles * work.impacts
    if isinstance(result, Grid):
        return result.impacts
    return int(np.isfinite(result["time"]).sum())


def rounds(peers: Sequence[Peer[Any]], work: Work, particles: int, repeats: int) -> Times:
    """Time every peer once a round; every other round goes through them backwards.

    Every peer has run before, so nothing is compiled or imported here.
    """
    wall, cpu = np.empty((2, repeats, len(peers)))
    for turn in range(repeats):
        order = range(len(peers)) if turn % 2 == 0 else reversed(range(len(peers)))
        for column in order:
            peer = peers[column]
            angles = work.angles(peer.particles(particles), seed=turn)
            start, start_cpu = perf_counter(), process_time()
            result = peer.run(work, angles)
            elapsed, elapsed_cpu = perf_counter() - start, process_time() - start_cpu
            number = impacts(result, work, angles.size)
            wall[turn, column] = 1e9 * elapsed / number
            cpu[turn, column] = 1e9 * elapsed_cpu / number
            del result
    return Times([peer.name for peer in peers], wall, cpu)


def table(times: Times, yardstick: str) -> str:
    """One row a peer: medians over the rounds, and how many times faster than the yardstick.

    By CPU time a row with two threads is compared core by core, and what else the machine had to do is left
    out of all rows.
    """
    lines = [
        f"{'':<32}{'million':>10}{'ns an impact':>18}    speed over that of {yardstick}",
        f"{'':<32}{'impacts/s':>10}{'clock':>9}{'CPU':>9}{'min':>9}{'median':>9}{'max':>9}{'by CPU':>11}",
    ]
    own = times.names.index(yardstick)
    for column, name in enumerate(times.names):
        faster = times.ratios(yardstick, name)
        wall, cpu = np.median(times.wall[:, column]), np.median(times.cpu[:, column])
        by_cpu = np.median(times.cpu[:, own] / times.cpu[:, column])
        digits = ".4g" if wall < 1e4 else ".0f"
        lines.append(
            f"{name:<32}{1e3 / wall:>10.3g}{wall:>9{digits}}{cpu:>9{digits}}"
            f"{faster.min():>9.3g}{np.median(faster):>9.3g}{faster.max():>9.3g}{by_cpu:>11.3g}"
        )
    return "\n".join(lines)


def comparison(times: Times, text: str, over: str, under: str) -> str:
    """One line: the ratio of two rows' times."""
    ratios = times.ratios(over, under)
    return f"{text:<58}{np.median(ratios):>7.3g}   ({ratios.min():.3g} to {ratios.max():.3g})"
