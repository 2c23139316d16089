"""The memory and the threads that this process can have, and the progress bar."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from restitution._internal.arrays import flag, whole
from restitution._internal.parameters import ParameterError, TooLargeError, wrong

_MOST_THREADS = 1024
_LITTLE = 1 << 16  # bytes that any process can have; to ask how many it can have takes milliseconds


def available_memory() -> int:
    """Return how many bytes this process can still allocate: what is free, within its limits and groups."""
    import psutil

    found = [psutil.virtual_memory().available, *control_groups(Path("/"))]
    if hasattr(psutil, "RLIMIT_AS"):  # `ulimit -v`, as batch systems set it
        process = psutil.Process()
        limit, _ = process.rlimit(psutil.RLIMIT_AS)
        if limit != psutil.RLIM_INFINITY:
            found.append(limit - process.memory_info().vms)
    return max(0, min(map(int, found)))


def control_groups(root: Path) -> Iterator[int]:
    """Yield the memory left under the limits of the control groups, of either version, up to the root."""
    for line in _lines(root / "proc/self/cgroup"):
        _, controllers, path = line.split(":", 2)
        if controllers and "memory" not in controllers.split(","):
            continue
        top, names = root / "sys/fs/cgroup", ("memory.max", "memory.current", "inactive_file")
        if controllers:
            top /= "memory"
            names = ("memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file")
        group = Path(path.lstrip("/"))
        for folder in (top / part for part in (group, *group.parents)):
            with suppress(ValueError):  # there is none, or "max"
                most, used = (int("".join(_lines(folder / name))) for name in names[:2])
                cached = [row.split() for row in _lines(folder / "memory.stat")]
                # What files left in memory makes room when it is needed.
                yield most - used + sum(int(size) for name, size in cached if name == names[2])


def _lines(path: Path) -> list[str]:
    with suppress(OSError):
        return path.read_text(encoding="ascii", errors="replace").splitlines()
    return []


def check_room(what: str, needed: int) -> None:
    """Refuse work that does not fit into memory; raises a MemoryError that names it."""
    if needed > (available := available_memory()):
        took, has = (f"{size / 1e6:.0f} MB" for size in (needed, available))
        raise MemoryError(f"{what}: takes {took} of memory, and this process can have {has}")


def check_size(name: str, value: Any, number: int, bytes_of_each: int, what: str) -> None:
    """Refuse an argument by which an array is larger than this process can hold; raises a TooLargeError."""
    if number * bytes_of_each < _LITTLE:
        return
    if number * bytes_of_each > (available := available_memory()):
        allowed = f"at most {available // bytes_of_each:.4g} {what}, which this process can hold"
        raise TooLargeError(wrong(name, value, allowed))


def checked_threads(threads: int | None) -> int:
    """Return the number of threads as the core takes it: 0 is one for each core that this process may use."""
    try:
        return 0 if threads is None else whole("threads", threads, 1, _MOST_THREADS)
    except ParameterError:
        allowed = f"a whole number in [1, {_MOST_THREADS}] or None"
        raise ParameterError(wrong("threads", threads, allowed)) from None


@contextmanager
def progress_bar(what: str, total: int, unit: str, *, show: bool) -> Iterator[Callable[[int], None] | None]:
    """Show a bar on standard error; yields what takes the amount done, or None where none is shown."""
    with bar(show=flag("progress", show), total=total, desc=what, unit=f" {unit}", smoothing=0) as shown:
        yield None if shown.disable else lambda done: shown.update(done - shown.n) and None


def bar(*what: Any, show: bool, **options: Any) -> Any:
    """Make a tqdm bar on standard error; one that is closed, or none, shows nothing and stops nothing."""
    from tqdm import tqdm

    visible = show and not getattr(sys.stderr, "closed", sys.stderr is None)
    return tqdm(*what, disable=not visible, **options)
