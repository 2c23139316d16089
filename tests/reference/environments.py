"""One catalogue of hostile environments, beside that of hostile values. It grows with every find.

Each is entered by a process that was forked for it, which then becomes a command.
"""

import contextlib
import ctypes
import os
import resource
import signal
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

MIB = 2**20
_READ_ANYWHERE = 1 << 2
"""CAP_DAC_READ_SEARCH, without which nobody could read an interpreter that stands in somebody's home."""


@dataclass(frozen=True)
class Environment:
    """What surrounds a call.

    Attributes
    ----------
    enter : callable
        Makes it, in the process itself; takes the address space that a command has without it, in bytes.
    prepare : callable
        Makes it of the folder that the process works in, beforehand.
    signals : tuple of int
        What the process is sent, one after the other.
    ordinary : bool
        Whether the superuser must become somebody else first, whom the limit binds.
    lost : tuple of int
        Standard streams on which nothing can be said.
    """

    enter: Callable[[int], None] = lambda _: None
    prepare: Callable[[Path], None] = lambda _: None
    signals: tuple[int, ...] = ()
    ordinary: bool = False
    lost: tuple[int, ...] = ()


def memory(room: int) -> Environment:
    """So many bytes of address space beyond those that are needed at least."""

    def enter(base: int) -> None:
        resource.setrlimit(resource.RLIMIT_AS, (base + room, resource.RLIM_INFINITY))

    return Environment(enter)


def _soft(limit: int, most: int) -> Callable[[int], None]:
    return lambda _: resource.setrlimit(limit, (most, resource.getrlimit(limit)[1]))


def files(more: int) -> Environment:
    """So many files besides those that are open."""

    def enter(_: int) -> None:
        hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
        free = [number for number in range(1000) if not os.path.lexists(f"/proc/self/fd/{number}")]
        resource.setrlimit(resource.RLIMIT_NOFILE, (free[more - 1] + 1, hard))

    return Environment(enter)


def closed(*numbers: int) -> Environment:
    """Standard streams that are closed."""

    def enter(_: int) -> None:
        for number in numbers:
            _set_stream(number, None)
            os.close(number)

    return Environment(enter, lost=numbers)


def to(path: str, *numbers: int) -> Environment:
    """Standard streams that lead to a file."""

    def enter(_: int) -> None:
        for number in numbers:
            handle = os.open(path, os.O_RDWR)
            os.dup2(handle, number)
            os.close(handle)

    return Environment(enter, lost=numbers)


def broken(*numbers: int) -> Environment:
    """Streams whose reader has left."""

    def enter(_: int) -> None:
        reader, writer = os.pipe()
        os.close(reader)
        for number in numbers:
            os.dup2(writer, number)
        os.close(writer)

    return Environment(enter, lost=numbers)


def _set_stream(number: int, value: None) -> None:
    setattr(sys, ("stdin", "stdout", "stderr")[number], value)


def variables(**values: str | None) -> Environment:
    """Variables of the environment, and such as are missing."""

    def enter(_: int) -> None:
        for name, value in values.items():
            os.environ.pop(name, None)
            if value is not None:
                os.environ[name] = value

    return Environment(enter)


def _gone(_: int) -> None:
    """The temporary folder is a file; so is HOME."""
    (Path.cwd().parent / "gone").touch()
    for name in ("TMPDIR", "HOME", "XDG_CACHE_HOME", "MPLCONFIGDIR"):
        os.environ[name] = str(Path.cwd().parent / "gone")


def _gone_folder(_: int) -> None:
    """The folder that the process works in is no more."""
    folder = Path.cwd().parent / "removed"
    folder.mkdir()
    os.chdir(folder)
    folder.rmdir()


def _private(_: int) -> None:
    os.umask(0o777)


def _one_core(_: int) -> None:
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})


ENVIRONMENTS: dict[str, Environment] = {
    "nothing": Environment(),
    "512 MiB": memory(512 * MIB),
    "no threads": Environment(_soft(resource.RLIMIT_NPROC, 0), ordinary=True),
    "no large files": Environment(_soft(resource.RLIMIT_FSIZE, 256)),
    "no files at all": Environment(_soft(resource.RLIMIT_FSIZE, 0)),
    "two files": files(2),
    "four files": files(4),
    "six files": files(6),
    "ten files": files(10),
    "a full disk": Environment(),
    "a folder to read": Environment(prepare=lambda folder: folder.chmod(0o555), ordinary=True),
    "no input": closed(0),
    "no output": closed(1),
    "no errors": closed(2),
    "no streams": closed(0, 1, 2),
    "a full output": to("/dev/full", 1),
    "a full error stream": to("/dev/full", 2),
    "output that nobody reads": broken(1),
    "errors that nobody reads": broken(2),
    "SIGINT": Environment(signals=(signal.SIGINT,)),
    "SIGTERM": Environment(signals=(signal.SIGTERM,)),
    "SIGHUP": Environment(signals=(signal.SIGHUP,)),
    "stopped and continued": Environment(signals=(signal.SIGSTOP, signal.SIGCONT, signal.SIGINT)),
    "no assertions": variables(PYTHONOPTIMIZE="1"),
    "no home": variables(HOME=None, TMPDIR=None, XDG_CACHE_HOME=None, MPLCONFIGDIR=None),
    "a home that is gone": variables(HOME="/none", TMPDIR="/none", XDG_CACHE_HOME="/none"),
    "files for folders": Environment(_gone),
    "nothing but a path": Environment(lambda _: os.environ.clear()),
    "ASCII": variables(LC_ALL="C", LANG="C", PYTHONUTF8="0", PYTHONCOERCECLOCALE="0", PYTHONIOENCODING=None),
    "ASCII, strictly": variables(PYTHONIOENCODING="ascii:strict", LC_ALL="C", PYTHONUTF8="0"),
    "a locale that is not there": variables(LC_ALL="xx_YY.UTF-8", LANG="xx_YY.UTF-8", LANGUAGE="xx"),
    "Turkish": variables(LC_ALL="tr_TR.UTF-8"),
    "2000 threads": variables(RAYON_NUM_THREADS="2000", OMP_NUM_THREADS="3"),
    "words for threads": variables(RAYON_NUM_THREADS="many"),
    "no backend": variables(MPLBACKEND="none-such", DISPLAY=None),
    "a strange terminal": variables(TERM="none-such", COLUMNS="1", LINES="x"),
    "one core": Environment(_one_core),
    "a private umask": Environment(_private),
    "a folder that is gone": Environment(_gone_folder),
}
"""By name."""


def become_ordinary() -> None:
    """Be nobody, with no rights but to read; nothing where this is not the superuser's process."""
    if os.geteuid() != 0:
        return
    libc = ctypes.CDLL(None, use_errno=True)
    keep, ambient, up = 8, 47, 2
    libc.prctl(keep, 1, 0, 0, 0)
    os.setresgid(65534, 65534, 65534)
    os.setresuid(65534, 65534, 65534)
    header = (ctypes.c_uint32 * 2)(0x20080522, 0)
    data = (ctypes.c_uint32 * 6)(_READ_ANYWHERE, _READ_ANYWHERE, _READ_ANYWHERE, 0, 0, 0)
    if libc.capset(header, data) != 0:
        raise OSError(ctypes.get_errno(), "capset")
    libc.prctl(ambient, up, _READ_ANYWHERE.bit_length() - 1, 0, 0)


@contextlib.contextmanager
def full_disk(folder: Path):  # type: ignore[no-untyped-def]
    """A file system of 16 kB at `folder`; yields whether there is one, which takes rights to mount."""
    libc = ctypes.CDLL(None, use_errno=True)
    done = libc.mount(b"none", os.fsencode(folder), b"tmpfs", 0, b"size=16k") == 0
    try:
        yield done
    finally:
        if done:
            libc.umount2(os.fsencode(folder), 2)
