"""The peers, one file each."""

from importlib.util import find_spec

from benchmarks.peers import brentq_grid, simulate
from benchmarks.work import Peer


def available() -> tuple[list[Peer], list[str]]:
    """All peers that this installation can run, the yardstick first, and a line for each one left out."""
    peers, missing = simulate.rows(), []
    if find_spec("numba"):
        from benchmarks.peers import numba_loop

        peers += numba_loop.rows()
    else:
        missing.append("Numba loop left out: Numba is not installed (pip install 'restitution[bench]')")
    return peers + brentq_grid.rows(), missing
