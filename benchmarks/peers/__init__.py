"""The peers, one file each."""

from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

from benchmarks.peers import brentq_grid, pages, simulate, statistics
from benchmarks.work import Grid, Peer, Records


@dataclass(frozen=True)
class Peers:
    """All rows that this installation can run: statistics of the engine, other grids, records, arrays."""

    engine: list[Peer[Grid]]
    counting: list[Peer[Grid]]
    recording: list[Peer[Records]]
    writing: list[Peer[None]]
    missing: list[str]

    @property
    def rows(self) -> list[Peer[Any]]:
        return [*self.engine, *self.counting, *self.recording, *self.writing]


def available() -> Peers:
    """Find the peers; a line in `missing` for each one left out."""
    counting: list[Peer[Grid]] = []
    recording, missing = simulate.rows(), []
    if find_spec("numba"):
        from benchmarks.peers import numba_grid, numba_records

        counting += numba_grid.rows()
        recording += numba_records.rows()
    else:
        missing.append("Numba loops left out: Numba is not installed (pip install 'restitution[bench]')")
    return Peers(statistics.rows(), counting, recording + brentq_grid.rows(), pages.rows(), missing)
