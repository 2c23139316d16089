"""The memory and the threads that this process can have, and the progress bar."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from restitution._internal.arrays import flag, whole
from restitution._internal.parameters import ParameterError, Problem, TooLargeError, wrong
from restitution._internal.process import Forgiving, writable


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


def _limits(root: Path) -> tuple[int | None, int | None]:
    """Give what is left under the limits on address space and data, where there are any."""
    try:
        import resource
    except ImportError:  # Windows
        return None, None
    used = [int(pages) for line in _lines(root / "proc/self/statm") for pages in line.split()]

    def left(limit: int, field: int) -> int | None:
        soft, _ = resource.getrlimit(limit)
        if soft == resource.RLIM_INFINITY:
            return None
        return soft - (used[field] * resource.getpagesize() if used else 0)

    return left(resource.RLIMIT_AS, 0), left(resource.RLIMIT_DATA, 5)


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


def check_room(what: str, needed: int) -> None:
    """Refuse work whose libraries do not fit into memory: OpenBLAS tries for ever to get its buffers.

    Raises
    ------
    MemoryError
        Naming the work, what it takes, and what there is.
    """
    _check_bytes(what, "memory", needed, available_memory())


def check_address_space(what: str, needed: int) -> None:
    """Refuse work whose libraries have no room below the limit on address space, where each fails in its way.

    Of the memory itself they take a part: what the machine has free does not matter here.

    Raises
    ------
    MemoryError
        As `check_room`.
    """
    _check_limit(what, "address space", needed)


def check_data(what: str, needed: int) -> None:
    """Refuse work that has no room below the limit on data (`ulimit -d`), where libraries end the process.

    Raises
    ------
    MemoryError
        As `check_room`.
    """
    _check_limit(what, "data", needed)


def _check_limit(what: str, kind: str, needed: int) -> None:
    left = dict(zip(("address space", "data"), _limits(Path("/")), strict=True))[kind]
    if left is not None:
        _check_bytes(what, kind, needed, left)


def _check_bytes(what: str, kind: str, needed: int, available: int) -> None:
    if needed > available:
        took, has = (f"{size / 1e6:.0f} MB" for size in (needed, max(0, available)))
        raise MemoryError(f"{what}: takes {took} of {kind}, and this process can have {has}")


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
