"""Signals that end a process: raised, kept from a short block or passed to a function."""

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

T = TypeVar("T")

_ENDING = ("SIGINT", "SIGTERM", "SIGHUP", "SIGBREAK")  # of which a system has some


@contextmanager
def handled(handle: Callable[[int], None]) -> Iterator[None]:
    """Pass signals that end a process to `handle`, except those that are ignored, as under nohup."""
    before: dict[int, Any] = {}
    if threading.current_thread() is threading.main_thread():  # which alone has handlers
        numbers = [getattr(signal, name) for name in _ENDING if hasattr(signal, name)]
        found = {number: signal.getsignal(number) for number in numbers}
        before = {number: old for number, old in found.items() if old not in (signal.SIG_IGN, None)}
    try:
        for number in before:
            signal.signal(number, lambda number, _: handle(number))
        yield
    finally:
        for number, old in before.items():
            signal.signal(number, old)


def uninterrupted(found: T, interrupted: KeyboardInterrupt | None) -> T:
    """Return what the core found, unless a signal ended its work early, which is raised."""
    if interrupted:
        raise KeyboardInterrupt from interrupted
    return found


@contextmanager
def undisturbed() -> Iterator[None]:
    """Defer signals to the end of a short block."""
    late: list[int] = []
    try:
        with handled(late.append):
            yield
    finally:
        for number in late[:1]:
            signal.raise_signal(number)
