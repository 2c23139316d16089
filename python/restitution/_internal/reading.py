"""Files that are read: those that have no end, or cannot be read twice, are refused."""

import errno
from pathlib import Path

MOST = 2**28
"""Bytes of a file that is read as a whole; tables of times and parameters of runs are far below it."""
_PIECE = 2**20
"""Bytes that are read at a time."""


def content(path: Path) -> bytes:
    """Read a file as a whole; an OSError that names it if it cannot be read, or is longer than any table."""
    try:
        found = bytearray()
        with path.open("rb") as file:
            # Python takes room for all that is asked for, however short the file is.
            while piece := file.read(min(_PIECE, MOST + 1 - len(found))):
                found += piece
    except OSError as error:  # while it is read, it names no file
        raise OSError(error.errno, error.strerror, str(path)) from error
    if len(found) > MOST:
        raise OSError(errno.EFBIG, f"longer than {MOST >> 20} MiB", str(path))
    return bytes(found)


def check_regular(path: Path) -> None:
    """Refuse folders, pipes and devices for libraries that go back and forth in a file, or wait for ever."""
    path.stat()  # whose OSError names what is not there
    if not path.is_file():
        number = errno.EISDIR if path.is_dir() else errno.EINVAL
        text = "is a folder" if path.is_dir() else "not a regular file: save it first"
        raise OSError(number, text, str(path))
