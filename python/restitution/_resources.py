"""Threads, memory and the progress bar."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from operator import index

from restitution._parameters import shown

_MOST_THREADS = 1024


def checked_threads(threads: int | None) -> int:
    """Give the number of threads to the core, where 0 means one for each core."""
    if threads is None:
        return 0
    try:
        number = index(threads)
    except TypeError:
        number = 0
    if not 1 <= number <= _MOST_THREADS or isinstance(threads, bool):
        raise ValueError(
            f"threads = {shown(threads)}: must be a whole number in [1, {_MOST_THREADS}] or None"
        )
    return number


def available_memory() -> int:
    """Tell the bytes of memory of this machine."""
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")


def check_memory(impacts: int, bytes_per_impact: int) -> None:
    """Refuse tables that the machine cannot hold before anything is computed."""
    needed = impacts * bytes_per_impact
    available = available_memory()
    if needed > available:
        raise ValueError(
            f"particles * impacts = {impacts:.4g}: must be at most {available // bytes_per_impact:.4g} here; "
            f"the records take {needed / 1e9:.3g} GB and this machine has {available / 1e9:.3g} GB"
        )


@contextmanager
def progress_bar(what: str, total: int, unit: str, *, show: bool) -> Iterator[Callable[[int], None] | None]:
    """Show a bar on standard error that is told how much is done; yields None where it is not to be shown."""
    if not show:
        yield None
        return
    from tqdm import tqdm

    with tqdm(total=total, desc=what, unit=f" {unit}", file=sys.stderr, smoothing=0) as bar:
        yield lambda done: bar.update(done - bar.n) and None
