"""Standard streams that are closed, missing or gone: what is said is lost then, and nothing else."""

import os
import sys
from contextlib import suppress
from typing import IO, Any


def writable(stream: object) -> bool:
    """Whether a stream is there and open."""
    return stream is not None and not getattr(stream, "closed", False)


def is_terminal(stream: Any) -> bool:
    """Whether somebody watches a stream."""
    try:
        return writable(stream) and bool(stream.isatty())
    except (AttributeError, OSError, ValueError):
        return False


def say(line: str) -> None:
    """Write a line to standard output; a closed pipe, as after `head`, is not an error."""
    _put(line, "stdout")


def tell(line: str) -> None:
    """Write a line to standard error, if that can be."""
    with suppress(OSError, ValueError, RuntimeError):  # RuntimeError: a signal in the midst of another line
        _put(line, "stderr")


def _put(line: str, name: str) -> None:
    stream = getattr(sys, name)
    if not writable(stream):
        return
    try:
        stream.write(_encodable(line, stream) + "\n")
        stream.flush()
    except BrokenPipeError:
        setattr(sys, name, None)  # or what is left in it would be an error at the end of the process
        with suppress(OSError, ValueError, AttributeError):
            _null(stream.fileno())
    except OSError as error:  # as of a disk that is full
        setattr(sys, name, None)
        raise OSError(error.errno, error.strerror, "standard output") from None


_CONTROLS = {code: f"\\x{code:02x}" for code in (*range(32), *range(127, 160)) if chr(code) not in "\n\t"}
"""What a terminal would obey, as it may stand in the name of a file."""


def _encodable(line: str, stream: Any) -> str:
    """Escape what the stream has no letter for, as µ in ASCII, and control characters."""
    encoding = getattr(stream, "encoding", None) or "utf-8"
    return line.translate(_CONTROLS).encode(encoding, "backslashreplace").decode(encoding)


def open_missing() -> None:
    """Put the null device where a standard stream is closed, lest a file be opened in its place."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            _null(number)
        if getattr(sys, name) is None:
            setattr(sys, name, open(os.devnull, "r" if number == 0 else "w", encoding="utf-8"))  # noqa: SIM115


def _null(number: int) -> None:
    null = os.open(os.devnull, os.O_RDWR)
    if null != number:
        os.dup2(null, number)
        os.close(null)


class Forgiving:
    """A stream for a progress bar, which may lose what is written and raises nothing."""

    def __init__(self, stream: IO[str] | None) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write, or do not."""
        if self._stream is not None:
            with suppress(OSError, ValueError):
                self._stream.write(text)
        return len(text)

    def flush(self) -> None:
        """Flush, or do not."""
        if self._stream is not None:
            with suppress(OSError, ValueError):
                self._stream.flush()

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)
