"""A signal that comes when a command has begun its work, and not before."""

import os
import threading
import time
from collections.abc import Callable
from typing import Any


def arm(number: int, name: str) -> None:
    """Send this process a signal once it computes; of `explore`, once it serves."""
    if name == "explore":
        from http.server import ThreadingHTTPServer as Server

        Server.serve_forever = _sending(Server.serve_forever, number)  # type: ignore[method-assign]
        return
    from restitution import _core

    for work in ("simulate", "statistics"):
        setattr(_core, work, _sending(getattr(_core, work), number))
    _core.Tally = _Sending(_core.Tally, number)  # type: ignore[assignment,misc]


_sent = threading.Event()
"""One signal only: a second one would find nothing to catch it at the end of the process."""


def _sending(function: Callable[..., Any], number: int) -> Callable[..., Any]:
    def sending(*args: Any, **how: Any) -> Any:
        def send() -> None:
            time.sleep(0.1)
            os.kill(os.getpid(), number)

        if not _sent.is_set():
            _sent.set()
            threading.Thread(target=send, daemon=True).start()
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
