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
    return [
        Peer(f"statistics, {best}, 1 thread", partial(run, threads=1, level=best), share=4.0),
        Peer(f"statistics, {best}, 2 threads", partial(run, threads=2, level=best), share=4.0),
        *(Peer(f"statistics, {level}, 1 thread", partial(run, threads=1, level=level)) for level in others),
    ]
