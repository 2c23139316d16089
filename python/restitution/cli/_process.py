"""Signals that end a command, and standard streams, which may be closed or missing."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from typing import Any

import typer

from restitution._internal.process import handled

# What a terminal would obey, as it may stand in the name of a file.
_CONTROLS = {code: f"\\x{code:02x}" for code in (*range(32), *range(127, 160)) if chr(code) not in "\n\t"}


@contextmanager
def ending() -> Iterator[list[int]]:
    """Raise a KeyboardInterrupt in the block for each signal that ends a process; yields those that came."""
    came: list[int] = []

    def end(number: int) -> None:
        came.append(number)
        raise KeyboardInterrupt

    with handled(end):
        yield came


def leaving() -> AbstractContextManager[None]:
    """Leave at once at a signal that ends a process: before a command begins, and after it has ended."""

    def leave(number: int) -> None:
        raise SystemExit(128 + number)

    return handled(leave)


@contextmanager
def put_off(notify: Callable[[], None]) -> Iterator[list[int]]:
    """Defer a signal to the end of the block and put it into the list; a second one ends the block."""
    late: list[int] = []

    def wait(number: int) -> None:
        late.append(number)
        if len(late) > 1:
            raise KeyboardInterrupt
        notify()

    with handled(wait):
        yield late


def is_terminal(stream: Any) -> bool:
    """Test whether a stream is a terminal; one that is closed or missing is not."""
    try:
        return bool(stream.isatty())
    except (AttributeError, OSError, ValueError):  # there is none, or it is closed
        return False


def say(line: str) -> None:
    """Write a line to standard output; one that is missing, or a pipe that was closed, takes nothing."""
    try:
        typer.echo(line.translate(_CONTROLS))
    except BrokenPipeError:  # as after `head`
        sys.stdout = open(os.devnull, "w", encoding="utf-8")  # noqa: SIM115


def tell(line: str) -> None:
    """Write a line to standard error, if that can be."""
    with suppress(OSError, ValueError, RuntimeError):  # RuntimeError: a signal in the midst of another line
        typer.echo(line.translate(_CONTROLS), err=True)


def open_missing() -> None:
    """Replace missing standard streams by the null device; escape letters that the others cannot encode."""
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        stream: Any = getattr(sys, name)
        if stream is None:
            setattr(sys, name, open(os.devnull, "r" if number == 0 else "w", encoding="utf-8"))  # noqa: SIM115
        elif number > 0 and hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
