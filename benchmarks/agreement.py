"""Do all peers compute the same physics? Asked before anything is timed."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchmarks.work import Array, Peer, Records, Work

ULP = 2.0**-52
ROUNDINGS = 100.0  # of one impact in any peer, each counted in full
NUDGE = 1e-9  # rad
SPEED, HALF_WIDTH = 0.4, 0.01  # m/s
STANDARD_ERRORS = 5.0  # a false alarm in 2 million comparisons, were the errors normal
GROUPS = 10


class Disagreement(RuntimeError):
    """Two peers do not compute the same physics, so that their times cannot be compared."""


def same_impacts(peers: Sequence[Peer], work: Work, particles: int = 50, impacts: int = 20) -> float:
    """Compare the first impacts of the same particles with the first peer's; largest error over allowance.

    Errors grow along a trajectory. How fast is measured for each particle: the first peer runs again with
    angles off by `NUDGE`, and the largest departure so far, over `NUDGE`, is by how much rounding has grown.

    Raises
    ------
    Disagreement
        Naming the peer, if it disagrees.
    """
    work = replace(work, impacts=impacts)
    angles = work.angles(particles)
    right, nudged = peers[0].run(work, angles), peers[0].run(work, angles + NUDGE)
    grown = np.max([np.abs(nudged[name] - right[name]) for name in right], axis=0) / NUDGE
    factor = 1.0 + np.maximum.accumulate(grown, axis=1)
    worst = 0.0
    for peer in peers[1:]:
        mine = peer.run(work, angles)
        for name, values in right.items():
            allowance = ROUNDINGS * ULP * factor * (1.0 + np.abs(values))
            error = np.abs(mine[name] - values) / allowance
            if not (error <= 1.0).all():
                particle, impact = np.unravel_index(np.argmax(~(error <= 1.0)), error.shape)
                raise Disagreement(
                    f"{peer.name}: {name} of particle {particle}, impact {impact} is "
                    f"{mine[name][particle, impact]!r}, not {values[particle, impact]!r}"
                )
            worst = max(worst, float(error.max()))
    return worst


def spread(records: Records) -> tuple[float, float]:
    """Standard deviation of ε at `SPEED` ± `HALF_WIDTH`, and its standard error.

    The impacts of one particle are correlated, so the error is a jackknife over groups of particles.
    """
    speed, restitution = records["impact_velocity"].astype(float), records["restitution"].astype(float)
    inside = np.abs(speed - SPEED) < HALF_WIDTH
    group = np.broadcast_to(np.arange(len(speed))[:, None] * GROUPS // len(speed), speed.shape)
    left_out: Array = np.array([restitution[inside & (group != g)].std() for g in range(GROUPS)])
    error = np.sqrt((GROUPS - 1) / GROUPS * np.sum((left_out - left_out.mean()) ** 2))
    return float(restitution[inside].std()), float(error)


def same_spread(peers: Sequence[Peer], work: Work, particles: int) -> list[tuple[str, float, float]]:
    """The spread of each peer, held to the first one's within their joint standard error.

    Raises
    ------
    Disagreement
        Naming the peer, if it disagrees.
    """
    found = []
    for number, peer in enumerate(peers):
        # its own particles, so that the samples are independent and the errors add in squares
        angles = work.angles(max(GROUPS, round(particles * peer.share)), seed=100 + number)
        found.append((peer.name, *spread(peer.run(work, angles))))
    _, right, its_error = found[0]
    for name, value, error in found:
        if abs(value - right) > STANDARD_ERRORS * np.hypot(error, its_error):
            raise Disagreement(
                f"{name}: sigma(ε) = {value:.4f} ± {error:.4f}, not {right:.4f} ± {its_error:.4f}"
            )
    return found
