"""What a signal raises, in whom, and for how long: the handlers themselves, in this process."""

import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from typing import Any

import pytest

from restitution._internal.process import ending, leaving, put_off, undisturbed

ALL = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]
PATIENCE = 20.0
"""Seconds in which a signal that is sent again has come, on a busy machine too."""


def handlers() -> list[Any]:
    return [signal.getsignal(number) for number in ALL]


@pytest.fixture(autouse=True)
def handlers_of_python() -> Iterator[None]:
    """Whatever the handlers are that pytest was started with, each is called here; all are put back."""
    hook = sys.unraisablehook
    before = [signal.signal(number, signal.default_int_handler) for number in ALL]
    yield
    for number, old in zip(ALL, before, strict=True):
        signal.signal(number, old)
    sys.unraisablehook = hook


def send(number: int) -> None:
    os.kill(os.getpid(), number)


def struck(*numbers: int) -> None:
    """Be at work when signals come."""
    for number in numbers:
        send(number)
    until = time.monotonic() + PATIENCE
    while time.monotonic() < until:
        time.sleep(0.001)
    pytest.fail("no signal came")


def caught(number: int) -> KeyboardInterrupt:
    """Be at work when a signal comes, and go on after it with what it raised."""
    with pytest.raises(KeyboardInterrupt) as raised:
        struck(number)
    return raised.value


@pytest.mark.parametrize("number", ALL)
def test_a_signal_ends_the_block(number: int) -> None:
    with pytest.raises(KeyboardInterrupt) as raised, ending() as came:
        struck(number)
    assert (raised.value.args, came) == ((), [number])


def test_each_signal_counts() -> None:
    """Who catches one and goes on can be sent another, and knows of both."""
    with ending() as came:
        kept = [caught(number) for number in (signal.SIGTERM, signal.SIGINT)]
    assert len(kept) == 2
    assert came == [signal.SIGTERM, signal.SIGINT]


@pytest.mark.parametrize("number", ALL)
def test_a_signal_before_and_after_a_command(number: int) -> None:
    with pytest.raises(SystemExit) as raised, leaving():
        struck(number)
    assert raised.value.code == 128 + number


def test_a_signal_is_put_off() -> None:
    """It is told of once, and the block goes on to its end."""
    told: list[None] = []
    with put_off(lambda: told.append(None)) as late:
        send(signal.SIGTERM)
        time.sleep(0.1)
    assert (late, len(told)) == ([signal.SIGTERM], 1)


def test_a_second_signal_is_not_put_off() -> None:
    told: list[None] = []
    with pytest.raises(KeyboardInterrupt) as raised, put_off(lambda: told.append(None)) as late:
        struck(signal.SIGTERM, signal.SIGHUP)
    assert (raised.value.args, late, len(told)) == ((), [signal.SIGTERM, signal.SIGHUP], 1)


def test_a_block_is_not_disturbed() -> None:
    """The signal that came meanwhile counts when it has ended."""
    done: list[str] = []

    def work() -> None:
        with undisturbed():
            send(signal.SIGTERM)
            done.append("block")
        done.append("more")

    with pytest.raises(KeyboardInterrupt):
        work()
    assert done == ["block"]


BLOCKS: list[Callable[[], AbstractContextManager[Any]]] = [ending, leaving, lambda: put_off(lambda: None)]


@pytest.mark.parametrize("block", BLOCKS)
def test_handlers_are_put_back(block: Callable[[], AbstractContextManager[Any]]) -> None:
    """After the block, and after an error in it; those that are ignored, as under nohup, are never taken."""
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    before = handlers()
    with block():
        assert [new == old for new, old in zip(handlers(), before, strict=True)] == [False, False, True]
    assert handlers() == before
    with pytest.raises(ZeroDivisionError), block():
        _ = 1 / 0
    assert handlers() == before


@pytest.mark.parametrize("block", BLOCKS)
def test_signals_are_of_the_main_thread(block: Callable[[], AbstractContextManager[Any]]) -> None:
    """In another one, which may set no handlers, the block runs without them."""
    before, found = handlers(), []

    def work() -> None:
        with block():
            found.append(handlers())

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == [before]


def dropping(number: int) -> None:
    """Send a signal where Python drops what it raises."""

    class Losing:
        def __del__(self) -> None:
            send(number)
            time.sleep(0.01)

    Losing()


def dropped_and_asleep(number: int, *before: int) -> None:
    for other in before:
        send(other)
    dropping(number)
    time.sleep(PATIENCE)  # in one piece, which a signal ends only if it is sent to this thread


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_signal_that_python_drops_comes_again(number: int, capfd: pytest.CaptureFixture[str]) -> None:
    """As the same signal, until it has been seen, and without a word of what was dropped."""
    until = time.monotonic() + PATIENCE
    with pytest.raises(KeyboardInterrupt), ending() as came:
        dropped_and_asleep(number)
    assert time.monotonic() < until
    assert came == [number, number]
    assert capfd.readouterr() == ("", "")


def test_a_signal_before_a_command_that_python_drops_comes_again() -> None:
    """As the same signal, which the exit status tells."""
    with pytest.raises(SystemExit) as raised, leaving():
        dropped_and_asleep(signal.SIGHUP)
    assert raised.value.code == 128 + signal.SIGHUP


def test_a_second_signal_that_python_drops_comes_again() -> None:
    with pytest.raises(KeyboardInterrupt), put_off(lambda: None) as late:
        dropped_and_asleep(signal.SIGHUP, signal.SIGTERM)
    assert late == [signal.SIGTERM, signal.SIGHUP, signal.SIGHUP]


def test_a_signal_that_is_caught_does_not_come_again() -> None:
    """While who caught it keeps it, however long the work after it takes."""
    with ending() as came:
        kept = caught(signal.SIGTERM)
        time.sleep(0.2)
    assert isinstance(kept, KeyboardInterrupt)
    assert came == [signal.SIGTERM]


def test_a_signal_that_was_lost_gives_way_to_another() -> None:
    """Which has come meanwhile, and is kept: the first is not sent once more."""
    with ending() as came:
        dropping(signal.SIGTERM)
        kept = caught(signal.SIGHUP)
        time.sleep(0.2)
    assert isinstance(kept, KeyboardInterrupt)
    assert came[0] == signal.SIGTERM
    assert came[-1] == signal.SIGHUP
    assert len(came) <= 3


def test_a_signal_that_is_kept_stands_for_those_that_are_lost() -> None:
    """Who keeps one knows that the process is to end."""
    with ending() as came:
        kept = caught(signal.SIGTERM)
        dropping(signal.SIGHUP)
        time.sleep(0.2)
    assert isinstance(kept, KeyboardInterrupt)
    assert came == [signal.SIGTERM, signal.SIGHUP]


def test_nothing_comes_after_the_block() -> None:
    """A signal that was lost in its last moment stays lost."""
    came_after: list[int] = []
    for number in ALL:
        signal.signal(number, lambda number, _: came_after.append(number))
    with ending() as came:
        dropping(signal.SIGTERM)
    time.sleep(0.2)
    assert (came, came_after) == ([signal.SIGTERM], [])


def test_a_thread_that_the_system_does_not_give(monkeypatch: pytest.MonkeyPatch) -> None:
    """Then a signal that was lost is lost, and nothing else goes wrong."""
    import _thread

    def refuse(*_: object) -> None:
        raise RuntimeError("can't start new thread")

    with ending() as came:
        monkeypatch.setattr(_thread, "start_new_thread", refuse)
        dropping(signal.SIGTERM)
        monkeypatch.undo()
    assert came == [signal.SIGTERM]
