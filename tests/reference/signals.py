"""A signal that comes when a command has begun its work, and not before."""

import os
import pkgutil
import threading
import time
from collections.abc import Callable
from typing import Any

_FIRST = {
    "explore": ("http.server", "ThreadingHTTPServer.serve_forever"),
    "fit": ("xarray", "open_dataset"),
    "listen": ("soundfile", "read"),
    "template": ("restitution.cli._template", "say"),
}
"""Where the work of a command begins that has the core do nothing."""


def arm(number: int, name: str) -> None:
    """Send this process a signal once a command is at work."""
    if name in _FIRST:
        module, _, attribute = ".".join(_FIRST[name]).rpartition(".")
        home = pkgutil.resolve_name(module)
        delay = 0.0 if name == "template" else 0.1  # what ends at once is hit as it begins
        setattr(home, attribute, _sending(getattr(home, attribute), number, delay))
        return
    from restitution import _core

    for work in ("simulate", "simulate_series", "statistics", "histogram"):
        setattr(_core, work, _sending(getattr(_core, work), number))
    _core.Histogram = _Sending(_core.Histogram, number)  # type: ignore[assignment,misc]


def watched(tell: Callable[[int, int], object]) -> None:
    """Have the engine tell how many particles are finished, of how many, instead of showing its progress."""
    from restitution import _core

    engine = _core.simulate

    def simulate(run: Any, threads: Any, _: Any, **columns: Any) -> Any:
        def progress(finished: int) -> None:
            tell(finished, run["particles"])

        return engine(run, threads, progress, **columns)

    _core.simulate = simulate  # type: ignore[assignment]


_sent = threading.Event()
"""One signal only: a second one would find nothing to catch it at the end of the process."""


def _sending(function: Callable[..., Any], number: int, delay: float = 0.1) -> Callable[..., Any]:
    def sending(*args: Any, **how: Any) -> Any:
        def send() -> None:
            time.sleep(delay)
            os.kill(os.getpid(), number)

        if not _sent.is_set():
            _sent.set()
            if delay:
                threading.Thread(target=send, daemon=True).start()
            else:
                send()
        return function(*args, **how)

    return sending


class _Sending:
    """A class whose making sends the signal."""

    def __init__(self, kind: Any, number: int) -> None:
        self._make = _sending(kind, number)
        self._kind = kind

    def __call__(self, *args: Any, **how: Any) -> Any:
        return self._make(*args, **how)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._kind, name)
