"""Do all peers compute the same physics? Asked before anything is timed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import restitution as rs
from benchmarks.spinning import Released, Spinning
from benchmarks.work import Array, Counts, Grid, Lattice, Peer, Records, Work

ULP = 2.0**-52
ROUNDINGS = 100.0  # of one impact in any peer, each counted in full
NUDGE = 1e-9  # rad
IN_SPACE = 1e-13  # relative error of one impact that is rounded in space: several hundred roundings
INTEGRATED = 1e-7  # of one whose friction is integrated
KNOWN = 1e-3  # where more than this is allowed, nothing can be compared
GROUPS = 20
LEAST = 5 * GROUPS  # particles
ROWS = 25  # of the lattice in a window of σ(v): 0.05 m/s
FEWEST = 200  # impacts in a window, for its standard error to be one
STANDARD_ERRORS = 5.0  # a false alarm in 2 million comparisons, were the errors normal


class Disagreement(RuntimeError):
    """Two peers do not compute the same physics, so that their times cannot be compared."""


def same_impacts(peers: Sequence[Peer[Records]], work: Work, particles: int = 50, impacts: int = 20) -> float:
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


def same_spinning(job: Spinning, loop: Callable[..., Any], particles: int = 50, impacts: int = 8) -> float:
    """Compare v and ε of the first impacts of a spinning body; largest error over allowance.

    As `same_impacts`, with more allowed where the loop integrates friction.

    Raises
    ------
    Disagreement
        Naming the job, if the loop disagrees.
    """
    from benchmarks.peers.numba_spinning import run

    released = Released.random(particles, seed=1)
    right = job.first(released, impacts)
    mine, nudged = (run(job, start, loop, impacts)[1] for start in (released, released.nudged()))
    grown = np.abs(nudged - mine).max(axis=2, keepdims=True) / NUDGE
    one = IN_SPACE if isinstance(job.law, rs.TangentialRestitution) else INTEGRATED
    allowance = one * (1.0 + np.maximum.accumulate(grown, axis=1)) * (1.0 + np.abs(right))
    known = allowance <= KNOWN
    error = np.where(known, np.abs(mine - right) / allowance, 0.0)
    if not (error <= 1.0).all() or known.sum() < known.size / 4:
        particle, impact, _ = np.unravel_index(np.argmax(~(error <= 1.0)), error.shape)
        raise Disagreement(
            f"spinning {job.name}: v and ε of particle {particle}, impact {impact} are "
            f"{mine[particle, impact]}, not {right[particle, impact]}"
        )
    return float(error.max())


def same_counts(peers: Sequence[Peer[Grid]], work: Work, particles: int = 1000) -> int:
    """Hold the engine's rows to one another: the same grid to the last impact. Returns the impacts.

    Raises
    ------
    Disagreement
        Naming the row, if it disagrees.
    """
    angles = work.angles(particles)
    first, *others = (peer.run(work, angles) for peer in peers)
    for peer, grid in zip(peers[1:], others, strict=True):
        if grid.impacts != first.impacts or not np.array_equal(grid.count, first.count):
            raise Disagreement(f"{peer.name}: not the grid of {peers[0].name}")
    return first.impacts


@dataclass(frozen=True)
class Spread:
    """σ(ε) and its standard error in windows of the impact velocity; NaN where impacts are few."""

    value: Array
    error: Array


def counts(result: Grid | Records, lattice: Lattice) -> Counts:
    """The impacts on the lattice."""
    if isinstance(result, Grid):
        return result.count
    columns = result["impact_velocity"].ravel(), result["restitution"].ravel()
    grid, _, _ = np.histogram2d(*columns, bins=(lattice.velocity, lattice.restitution))
    return grid.astype(np.int64)


def deviation(grid: Counts, lattice: Lattice) -> Array:
    """Standard deviation of ε in the rows of a grid."""
    with np.errstate(invalid="ignore"):
        number = grid.sum(axis=-1)
        epsilon = 0.5 * (lattice.restitution[1:] + lattice.restitution[:-1])
        mean = grid @ epsilon / number
        variance: Array = grid @ epsilon**2 / number - mean**2
        return np.sqrt(np.maximum(variance, 0.0))


def spread(peer: Peer[Any], work: Work, angles: Array) -> Spread:
    """Measure σ(ε).

    The impacts of one particle are correlated, so the error is a jackknife over groups of particles.
    """
    lattice = work.lattice
    windows = (-1, ROWS, lattice.restitution_bins)
    groups = np.array(
        [
            counts(peer.run(work, group), lattice).reshape(windows).sum(axis=1)
            for group in np.array_split(angles, GROUPS)
        ]
    )
    total = groups.sum(axis=0)
    left_out = deviation(total - groups, lattice)
    error = np.sqrt((GROUPS - 1) / GROUPS * np.sum((left_out - left_out.mean(axis=0)) ** 2, axis=0))
    few = total.sum(axis=1) < FEWEST
    value = deviation(total, lattice)
    value[few] = error[few] = np.nan
    return Spread(value, error)


def same_spread(peers: Sequence[Peer[Any]], work: Work, particles: int) -> tuple[list[Spread], float]:
    """The spread of each peer, held to the first one's; the largest difference in joint standard errors.

    Raises
    ------
    Disagreement
        Naming the peer, if it disagrees.
    """
    found = []
    for number, peer in enumerate(peers):
        # its own particles, so that the samples are independent and the errors add in squares
        angles = work.angles(max(LEAST, peer.particles(particles)), seed=100 + number)
        found.append(spread(peer, work, angles))
    right, worst = found[0], 0.0
    for peer, mine in zip(peers[1:], found[1:], strict=True):
        distance = np.abs(mine.value - right.value) / np.hypot(mine.error, right.error)
        if np.isnan(distance).all():
            raise Disagreement(f"{peer.name}: too few impacts to compare σ(ε)")
        window = int(np.nanargmax(distance))
        if distance[window] > STANDARD_ERRORS:
            raise Disagreement(
                f"{peer.name}: σ(ε) at {work.lattice.velocity[window * ROWS]:.2f} m/s and up is "
                f"{mine.value[window]:.4f} ± {mine.error[window]:.4f}, not "
                f"{right.value[window]:.4f} ± {right.error[window]:.4f}"
            )
        worst = max(worst, float(distance[window]))
    return found, worst
