"""Time the peers in turns, so that the machine's drift hits all of them alike."""

from collections.abc import Sequence
from time import perf_counter

import numpy as np

from benchmarks.work import Array, Peer, Work


def rounds(peers: Sequence[Peer], work: Work, particles: int, repeats: int) -> Array:
    """Nanoseconds an impact, shape (repeats, peers).

    Every peer has run before, so nothing is compiled or imported here. Every other round goes through the
    peers backwards. Only impacts that happened count.
    """
    times = np.empty((repeats, len(peers)))
    for turn in range(repeats):
        order = range(len(peers)) if turn % 2 == 0 else reversed(range(len(peers)))
        for column in order:
            peer = peers[column]
            angles = work.angles(max(1, round(particles * peer.share)), seed=turn)
            start = perf_counter()
            records = peer.run(work, angles)
            elapsed = perf_counter() - start
            times[turn, column] = 1e9 * elapsed / np.isfinite(records["time"]).sum()
            del records
    return times


def table(names: Sequence[str], times: Array) -> str:
    """One row a peer: medians over the rounds, and the ratio to the first peer taken within each round."""
    ratios = times / times[:, :1]
    lines = [
        f"{'peer':<26}{'ns/impact':>11}{'impacts/s':>12}    time / time of the first row",
        f"{'':<26}{'median':>11}{'median':>12}{'min':>10}{'median':>10}{'max':>10}",
    ]
    for name, time, ratio in zip(names, times.T, ratios.T, strict=True):
        median = np.median(time)
        low, middle, high = ratio.min(), np.median(ratio), ratio.max()
        lines.append(
            f"{name:<26}{median:>11.4g}{1e9 / median:>12.3g}{low:>10.3g}{middle:>10.3g}{high:>10.3g}"
        )
    return "\n".join(lines)
