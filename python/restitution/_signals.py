"""What ends a command: SIGTERM and SIGHUP, as Ctrl-C; what is finished is kept, and no draft stays."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

_ENDING = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]


@contextmanager
def _handled(handler: Callable[[int, Any], None]) -> Iterator[None]:
    """Give the signals that end a process to `handler`, but for those that are ignored, as under nohup."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous = {number: signal.getsignal(number) for number in _ENDING}
    taken = [number for number, old in previous.items() if old not in (signal.SIG_IGN, None)]
    for number in taken:
        signal.signal(number, handler)
    try:
        yield
    finally:
        for number in taken:
            signal.signal(number, previous[number])


@contextmanager
def ending() -> Iterator[list[int]]:
    """Raise a KeyboardInterrupt in the block for each signal that ends a process; yields those that came."""
    came: list[int] = []

    def end(number: int, _: Any) -> None:
        came.append(number)
        raise KeyboardInterrupt

    with _handled(end):
        yield came


@contextmanager
def leaving() -> Iterator[None]:
    """Leave at once at a signal that ends a process: before a command begins, and after it has ended."""

    def leave(number: int, _: Any) -> None:
        raise SystemExit(128 + number)

    with _handled(leave):
        yield


@contextmanager
def put_off(tell: Callable[[], None]) -> Iterator[list[int]]:
    """Let the block end before a signal counts, which is put into the list; a second one ends the block."""
    late: list[int] = []

    def wait(number: int, _: Any) -> None:
        late.append(number)
        if len(late) > 1:
            raise KeyboardInterrupt
        tell()

    with _handled(wait):
        yield late
