"""Threads, the memory of records, and the progress bar."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from restitution._internal.arrays import flag, whole
from restitution._internal.memory import available_memory
from restitution._internal.parameters import ParameterError, Problem, TooLargeError, wrong
from restitution._internal.streams import Forgiving, writable

_MOST_THREADS = 1024


def checked_threads(threads: int | None) -> int:
    """Give the number of threads to the core, where 0 means one for each core that this process may use."""
    if threads is None:
        return 0
    try:
        return whole("threads", threads, 1, _MOST_THREADS)
    except ParameterError:
        allowed = f"a whole number in [1, {_MOST_THREADS}] or None"
        raise ParameterError(wrong("threads", threads, allowed)) from None


def check_memory(impacts: int, bytes_per_impact: int) -> None:
    """Refuse tables that this process cannot hold before anything is computed.

    Raises
    ------
    TooLargeError
        Naming what was asked for.
    """
    needed, available = impacts * bytes_per_impact, available_memory()
    if needed > available:
        allowed = (
            f"at most {available // bytes_per_impact:.4g} here; the records take {needed / 1e9:.3g} GB "
            f"and this process can have {available / 1e9:.3g} GB"
        )
        raise TooLargeError(Problem("particles * impacts", f" = {impacts:.4g}: must be {allowed}"))


def check_size(name: str, value: Any, number: int, bytes_of_each: int, what: str) -> None:
    """Refuse an argument by which an array is larger than this process can hold.

    Raises
    ------
    TooLargeError
        Naming the argument.
    """
    available = available_memory()
    if number * bytes_of_each > available:
        allowed = f"at most {available // bytes_of_each:.4g} {what}, which this process can hold"
        raise TooLargeError(wrong(name, value, allowed))


@contextmanager
def progress_bar(what: str, total: int, unit: str, *, show: bool) -> Iterator[Callable[[int], None] | None]:
    """Show a bar on standard error; yields what takes the amount done, or None where none is shown.

    A standard error that is closed, or none, shows nothing and stops nothing.
    """
    if not flag("progress", show) or not writable(sys.stderr):
        yield None
        return
    with bar(show=True, total=total, desc=what, unit=f" {unit}", smoothing=0) as shown:
        yield lambda done: shown.update(done - shown.n) and None


def bar(*what: Any, show: bool, **options: Any) -> Any:
    """Make a tqdm bar on standard error; one that is closed, or none, shows nothing and stops nothing."""
    from tqdm import tqdm

    visible = show and writable(sys.stderr)
    return tqdm(*what, file=Forgiving(sys.stderr), disable=not visible, **options)
