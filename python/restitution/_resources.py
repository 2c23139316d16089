"""Threads, memory and the progress bar."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from restitution._arrays import flag, whole
from restitution._parameters import ParameterError, Problem, TooLargeError, wrong
from restitution._streams import Forgiving, writable

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


def available_memory(root: Path = Path("/")) -> int:
    """Return how many bytes this process can still allocate: the smallest of all limits.

    That is the free memory of the machine, the limits of the process (`ulimit -v`, `ulimit -d`) and those of
    its control groups, as far as the system reports them; else the memory that the machine has.

    Parameters
    ----------
    root : Path
        Where the file systems ``proc`` and ``sys`` are.
    """
    found = [
        bound for bound in (*_machine(root), *_limits(root), *_control_groups(root)) if bound is not None
    ]
    if found:
        return max(0, min(found))
    with suppress(AttributeError, OSError, ValueError):  # where there is no such call, or no such name
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return sys.maxsize


def _machine(root: Path) -> Iterator[int | None]:
    for line in _lines(root / "proc/meminfo"):
        if line.startswith("MemAvailable:"):
            yield 1024 * int(line.split()[1])


def _limits(root: Path) -> Iterator[int | None]:
    """Yield what is left under the limits on address space and data."""
    try:
        import resource
    except ImportError:  # Windows
        return
    used = [int(pages) for line in _lines(root / "proc/self/statm") for pages in line.split()]
    for limit, field in ((resource.RLIMIT_AS, 0), (resource.RLIMIT_DATA, 5)):
        soft, _ = resource.getrlimit(limit)
        if soft != resource.RLIM_INFINITY:
            yield soft - (used[field] * resource.getpagesize() if used else 0)


def _control_groups(root: Path) -> Iterator[int | None]:
    """Yield what is left under the memory limits of the control groups, of either version, up to the root."""
    for line in _lines(root / "proc/self/cgroup"):
        _, controllers, path = line.split(":", 2)
        if controllers and "memory" not in controllers.split(","):
            continue
        top = root / ("sys/fs/cgroup/memory" if controllers else "sys/fs/cgroup")
        limit, usage, idle = (
            ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
            if controllers
            else ("memory.max", "memory.current", "inactive_file")
        )
        group = top / path.lstrip("/")
        for folder in (group, *group.parents):
            if not folder.is_relative_to(top):
                break
            most, used = _number(folder / limit), _number(folder / usage)
            if most is not None and used is not None:
                cached = [
                    int(entry.split()[1]) for entry in _lines(folder / "memory.stat") if idle in entry.split()
                ]
                yield most - used + sum(cached)  # what files left in memory makes room when it is needed


def _number(path: Path) -> int | None:
    """Read a number; None if there is none, or "max"."""
    text = "".join(_lines(path)).strip()
    return int(text) if text.isdecimal() else None


def _lines(path: Path) -> list[str]:
    try:
        return path.read_text(encoding="ascii", errors="replace").splitlines()
    except OSError:
        return []


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


def check_room(what: str, needed: int) -> None:
    """Refuse work whose libraries do not fit into memory: OpenBLAS tries for ever to get its buffers.

    Raises
    ------
    MemoryError
        Naming the work, what it takes, and what there is.
    """
    available = available_memory()
    if needed > available:
        took, has = (f"{size / 1e6:.0f} MB" for size in (needed, available))
        raise MemoryError(f"{what}: takes {took} of memory, and this process can have {has}")


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
