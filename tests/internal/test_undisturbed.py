"""What waits for a short block to end, and comes after it: signals of every kind, each once."""

import asyncio
import os
import signal
import sys
import threading
from collections.abc import Iterator
from types import FrameType
from typing import Any

import pytest

from restitution._internal.process import ending, put_off, surely, undisturbed

NUMBERS = [signal.SIGINT, signal.SIGTERM, signal.SIGALRM]


class Told(BaseException):
    """What a handler raises, with the number of the signal."""


@pytest.fixture(autouse=True)
def came() -> Iterator[list[int]]:
    """The signals that came; each raises an exception, as a program's own handlers may."""
    seen: list[int] = []

    def tell(number: int, _: Any) -> None:
        seen.append(number)
        raise Told(number)

    before = [signal.signal(number, tell) for number in NUMBERS]
    tracing = sys.gettrace()
    yield seen
    sys.settrace(tracing)
    for number, handler in zip(NUMBERS, before, strict=True):
        signal.signal(number, handler)


def block(*numbers: int) -> None:
    """Be in a block when signals come, which goes on to its end."""
    done = False
    try:
        with undisturbed():
            for number in numbers:
                signal.raise_signal(number)
            done = True
    finally:
        assert done


def blocked(*numbers: int) -> tuple[object, ...]:
    """Give the number that the last of the signals raised, after the block."""
    with pytest.raises(Told) as raised:
        block(*numbers)
    return raised.value.args


@pytest.mark.parametrize("number", NUMBERS)
def test_signals_wait_however_many(number: int, came: list[int]) -> None:
    """A second one, too, unlike in `put_off`; those of one number come as one, as from the system."""
    assert blocked(number, number, number) == (number,)
    assert came == [number]


def test_all_that_waited_come(came: list[int]) -> None:
    """In their order, though the first one raises."""
    assert blocked(signal.SIGTERM, signal.SIGALRM, signal.SIGINT) == (signal.SIGINT,)
    assert came == [signal.SIGTERM, signal.SIGALRM, signal.SIGINT]


def test_a_handler_is_told_where_the_signal_came() -> None:
    """In the block, and not where the handler is called: debuggers look there."""
    frames: list[FrameType | None] = []

    def look(_: int, frame: FrameType | None) -> None:
        frames.append(frame)

    signal.signal(signal.SIGALRM, look)
    with undisturbed():
        signal.raise_signal(signal.SIGALRM)
    assert frames[0] is not None
    assert frames[0].f_code.co_name == "test_a_handler_is_told_where_the_signal_came"


def test_a_block_that_fails_does_not_swallow_a_signal(came: list[int]) -> None:
    """What it raises has the error as its context; one that raises nothing hides no error."""

    def failing() -> None:
        with undisturbed():
            signal.raise_signal(signal.SIGTERM)
            raise ZeroDivisionError

    with pytest.raises(Told) as raised:
        failing()
    assert isinstance(raised.value.__context__, ZeroDivisionError)
    assert came == [signal.SIGTERM]
    with pytest.raises(ZeroDivisionError), put_off(lambda: None) as late:
        failing()
    assert late == [signal.SIGTERM]


def test_blocks_within_one_another(came: list[int]) -> None:
    """What comes in the inner one waits for the outer one, too."""
    done = []

    def work() -> None:
        with undisturbed():
            with undisturbed():
                signal.raise_signal(signal.SIGINT)
            done.append("outer")

    with pytest.raises(Told):
        work()
    assert (done, came) == (["outer"], [signal.SIGINT])


def test_a_process_stays_as_it_was() -> None:
    """Handlers, and the hook for what Python drops, which only a command that is about to end may silence."""
    before = [signal.getsignal(number) for number in signal.valid_signals()]
    hook = sys.unraisablehook
    blocked(signal.SIGTERM, signal.SIGTERM)
    assert [signal.getsignal(number) for number in signal.valid_signals()] == before
    assert sys.unraisablehook is hook


def test_a_signal_without_a_handler() -> None:
    """It ends the process, after the block."""
    reading, writing = os.pipe()
    process = os.fork()
    if not process:
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        with undisturbed():
            os.kill(os.getpid(), signal.SIGTERM)
            os.write(writing, b"block")
        os._exit(0)
    os.close(writing)
    _, status = os.waitpid(process, 0)
    assert os.read(reading, 10) == b"block"
    os.close(reading)
    assert os.waitstatus_to_exitcode(status) == -signal.SIGTERM


def test_asyncio_is_told_once() -> None:
    """It is told beside the handlers, at once; a program that ends at a second signal must not end at one."""
    told = []

    async def work() -> None:
        loop = asyncio.get_running_loop()
        loop.add_signal_handler(signal.SIGTERM, lambda: told.append(signal.SIGTERM))
        with undisturbed():
            signal.raise_signal(signal.SIGTERM)
        await asyncio.sleep(0.05)
        loop.remove_signal_handler(signal.SIGTERM)

    asyncio.run(work())
    assert told == [signal.SIGTERM]


def test_other_threads_have_no_signals(came: list[int]) -> None:
    """They run the block as it is."""
    done = []

    def in_a_thread() -> None:
        with undisturbed():
            done.append("block")

    thread = threading.Thread(target=in_a_thread)
    thread.start()
    thread.join()
    assert (done, came) == (["block"], [])


@pytest.mark.parametrize("also", [False, True], ids=["undisturbed", "surely"])
def test_a_signal_at_every_line(also: bool, came: list[int]) -> None:
    """Of what holds signals back and lets them come: the block is run as a whole or not, and none is lost."""
    done: list[int] = []
    seen = last = 0

    def steady() -> None:
        for number in range(3):
            done.append(number)

    def step(_: FrameType, event: str, __: object) -> Any:
        nonlocal seen
        seen += event == "line"
        if seen == last:
            sys.settrace(None)
            signal.raise_signal(signal.SIGALRM)
        return step

    def call(frame: FrameType, *_: object) -> Any:
        own = frame.f_code.co_filename.endswith("_signals.py") or frame.f_code is steady.__code__
        # The lines of `surely` call nothing, and signals count after calls.
        return step if own and frame.f_code.co_name != "surely" else None

    def do() -> None:
        nonlocal seen
        seen = 0
        done.clear()
        came.clear()
        sys.settrace(call)
        if also:
            surely(steady)
        else:
            with undisturbed():
                steady()
        sys.settrace(None)

    handlers = [signal.getsignal(number) for number in NUMBERS]
    do()
    assert seen > 20
    for line in range(1, seen + 1):
        last = line
        with pytest.raises(Told):
            do()
        assert done in ([0, 1, 2], [] if not also else [0, 1, 2])
        assert came == [signal.SIGALRM]
        assert [signal.getsignal(number) for number in NUMBERS] == handlers


def test_a_command_hears_of_what_waited() -> None:
    """Of all, in their order: its exit status is that of the last."""
    with ending() as heard, pytest.raises(KeyboardInterrupt):
        block(signal.SIGTERM, signal.SIGINT)
    assert heard == [signal.SIGTERM, signal.SIGINT]
