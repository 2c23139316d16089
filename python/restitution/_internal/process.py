"""What ends a command, and where it speaks: signals, and standard streams that may be closed or gone."""

import _thread
import os
import signal
import sys
import threading
import time
import weakref
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import partial
from typing import IO, Any, NoReturn

_ENDING = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
_ALL = sorted(signal.valid_signals())


def _handlers(numbers: Iterable[int]) -> dict[int, Any]:
    """Give what handles these signals now, but for those that are ignored, as under nohup, or end nothing."""
    if threading.current_thread() is not threading.main_thread():  # which alone has handlers
        return {}
    found = {number: signal.getsignal(number) for number in numbers}
    default = {number for number in _ENDING if found.get(number) == signal.SIG_DFL}
    return {number: old for number, old in found.items() if callable(old) or number in default}


@contextmanager
def _handled(handler: Callable[[int, Any], None], before: dict[int, Any]) -> Iterator[None]:
    """Give signals to `handler` instead of what handled them before, which has them again after the block."""
    over = False

    def handle(number: int, frame: Any) -> None:
        if over:
            _pass_on(number, frame, before[number])
        else:
            handler(number, frame)

    def put_back() -> None:
        for number, old in before.items():
            signal.signal(number, old)

    try:
        for number in before:
            signal.signal(number, handle)
        yield
    finally:
        try:
            over = True
            put_back()
        except BaseException:  # of a signal, which counts again
            put_back()
            raise


def _pass_on(number: int, frame: Any, handler: Any) -> None:
    """Do what a signal does; sent again, it would be heard twice by those who have other ways, as asyncio."""
    if callable(handler):
        handler(number, frame)
    else:
        signal.signal(number, handler)
        signal.raise_signal(number)


class _Interrupted(KeyboardInterrupt):
    """Unlike the one of Python, it can be watched."""


class _Leaving(SystemExit):
    """Likewise."""


@contextmanager
def _thrown(kind: type[BaseException]) -> Iterator[Callable[..., NoReturn]]:
    """Give a function that raises an exception of this kind in a handler of signals, and not in vain.

    Python drops what is raised in `__del__` and in callbacks, and libraries drop errors that they believe
    to be their own. So each exception is watched: when none is left and the block still goes on, the signal
    is sent again. Who catches one and goes on, as to write what is finished, keeps it.
    """
    alive: set[weakref.ref[BaseException]] = set()
    thrown = 0
    over = False

    def throw(number: int, *args: object) -> NoReturn:
        nonlocal thrown
        thrown += 1
        sys.unraisablehook = lambda _: None  # of objects that are half made: the process is about to end
        error = kind(*args)
        alive.add(weakref.ref(error, partial(lost, number)))
        try:
            raise error
        finally:
            del error  # its traceback has this frame

    def lost(number: int, one: "weakref.ref[BaseException]") -> None:
        alive.discard(one)
        if not alive and not over:
            # Where the system gives no thread that is an error, of which the hook above says nothing.
            _thread.start_new_thread(send, (number, thrown))

    def send(number: int, last: int) -> None:
        time.sleep(0.01)  # whatever drops exceptions here has ended
        if over or thrown > last:  # another signal has come meanwhile
            return
        if hasattr(signal, "pthread_kill"):
            signal.pthread_kill(threading.main_thread().ident or 0, number)
        else:
            signal.raise_signal(number)

    try:
        yield throw
    finally:
        over = True


@contextmanager
def ending() -> Iterator[list[int]]:
    """Raise a KeyboardInterrupt in the block for each signal that ends a process; yields those that came."""
    came: list[int] = []

    def end(number: int, _: Any) -> None:
        came.append(number)
        throw(number)

    with _thrown(_Interrupted) as throw, _handled(end, _handlers(_ENDING)):
        yield came


@contextmanager
def leaving() -> Iterator[None]:
    """Leave at once at a signal that ends a process: before a command begins, and after it has ended."""

    def leave(number: int, _: Any) -> None:
        throw(number, 128 + number)

    with _thrown(_Leaving) as throw, _handled(leave, _handlers(_ENDING)):
        yield


@contextmanager
def put_off(tell: Callable[[], None]) -> Iterator[list[int]]:
    """Let the block end before a signal counts, which is put into the list; a second one ends the block."""
    late: list[int] = []

    def wait(number: int, _: Any) -> None:
        late.append(number)
        if len(late) > 1:
            throw(number)
        tell()

    with _thrown(_Interrupted) as throw, _handled(wait, _handlers(_ENDING)):
        yield late


@contextmanager
def undisturbed() -> Iterator[None]:
    """Let the block, which is to be short, end well or not before a signal counts, whatever the signal does.

    Those that came meanwhile are then given to who would have had them, each once.
    """
    late: dict[int, Any] = {}

    def hold(number: int, frame: Any) -> None:
        late.setdefault(number, frame)

    def let_come() -> None:
        if late:
            number = next(iter(late))
            try:
                _pass_on(number, late.pop(number), before[number])
            finally:  # the others, too, where this one raises
                let_come()

    before = _handlers(_ALL)
    try:
        with _handled(hold, before):
            yield
    finally:
        let_come()


def surely(work: Callable[[], object]) -> None:
    """Do what is short and must be done, as in `undisturbed`, and also if a signal comes before it begins."""
    begun = False
    try:
        with undisturbed():
            begun = True
            work()
    except BaseException:
        if not begun:
            surely(work)
        raise


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
