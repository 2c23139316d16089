"""The cost of writing the arrays of `simulate` to memory, and nothing else.

As in every program, the system hands out the pages when they are first written. NumPy asks for huge ones
where the system leaves that to the program; the other row is the same on pages of the usual size.
"""

from functools import partial
from mmap import mmap

import numpy as np

from benchmarks.work import Array, Peer, Work

ITEMS = (*[np.float64] * 7, np.int8)
"""Of the variables over (particle, impact)."""


def run(work: Work, angles: Array, huge: bool) -> None:
    shape = (angles.size, work.impacts)
    tables = []
    for item in ITEMS:
        size = np.dtype(item).itemsize * angles.size * work.impacts
        table = np.empty(shape, item) if huge else np.frombuffer(mmap(-1, size), item).reshape(shape)
        table.fill(1)
        tables.append(table)  # kept, as `simulate` does, so that no page is used twice


def rows() -> list[Peer[None]]:
    return [
        Peer("its arrays filled, np.empty", partial(run, huge=True)),
        Peer("its arrays filled, plain pages", partial(run, huge=False)),
    ]
