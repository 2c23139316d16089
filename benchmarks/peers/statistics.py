"""`restitution.statistics`, at every SIMD level, including the Dataset it returns.

It does more than is asked for: it also counts E_rot/E_tot, sums the moments exactly, and keeps the ledger of
energy. Asked for counts only it still does the last.
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


def run(work: Work, angles: Array, threads: int, level: str, counts_only: bool) -> Grid:
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
            counts_only=counts_only,
            batches=1,  # its peers give no standard errors either
        )
    return Grid.of(found)


def rows() -> list[Peer[Grid]]:
    """The best level with one thread and with two, then the others with one; the same for counts only."""
    best, *others = reversed(rs.build_info()["simd_available"])
    return [
        row(level, threads, counts_only)
        for counts_only in (False, True)
        for level, threads in [(best, 1), (best, 2), *((level, 1) for level in others)]
    ]


def name(level: str, threads: int, counts_only: bool = False) -> str:
    """The name of the row."""
    call = "counts only" if counts_only else "statistics"
    return f"{call}, {level}, {threads} thread{'s' * (threads > 1)}"


def row(level: str, threads: int, counts_only: bool) -> Peer[Grid]:
    return Peer(
        name(level, threads, counts_only),
        partial(run, threads=threads, level=level, counts_only=counts_only),
        share=1.0 if level == "scalar" else 4.0,
    )
