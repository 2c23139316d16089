"""`restitution.statistics`, at every SIMD level, including the Dataset it returns.

It does more than is asked for: it also counts E_rot/E_tot, and sums the moments exactly.
"""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial

import restitution as rs
from benchmarks.work import Array, Grid, Peer, Work

LEVEL = "RESTITUTION_SIMD"


@contextmanager
def forced(level: str) -> Iterator[None]:
    """Have the engine use this SIMD level."""
    before = os.environ.get(LEVEL)
    os.environ[LEVEL] = level
    try:
        yield
    finally:
        if before is None:
            del os.environ[LEVEL]
        else:
            os.environ[LEVEL] = before


def run(work: Work, angles: Array, threads: int, level: str) -> Grid:
    with forced(level):
        found = rs.statistics(
            rs.Dumbbell(radius=work.radius, separation=work.separation),
            rs.TangentialRestitution(normal=work.normal, tangential=work.tangential),
            particles=angles.size,
            impacts=work.impacts,
            release_height=work.release_height,
            gravity=work.gravity,
            orientation=angles,
            threads=threads,
            velocity_bins=work.lattice.velocity,
            restitution_bins=work.lattice.restitution,
        )
    beside = ("number", "undefined", "velocity_underflow", "velocity_overflow")
    return Grid(found["count"].to_numpy(), sum(int(found[name].sum()) for name in beside))


def rows() -> list[Peer[Grid]]:
    """The best level with one thread and with two, then the others with one."""
    best, *others = reversed(rs.build_info()["simd_available"])
    return [row(best, 1), row(best, 2), *(row(level, 1) for level in others)]


def name(level: str, threads: int) -> str:
    """What the row is called."""
    return f"statistics, {level}, {threads} thread{'s' * (threads > 1)}"


def row(level: str, threads: int) -> Peer[Grid]:
    return Peer(
        name(level, threads),
        partial(run, threads=threads, level=level),
        share=1.0 if level == "scalar" else 4.0,
    )
