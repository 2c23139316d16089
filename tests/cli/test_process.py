"""What a signal raises, and for how long; what is said where a stream is closed or missing."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from typing import Any

import pytest

from reference.command import Program
from restitution._internal.process import undisturbed
from restitution.cli._process import ending, is_terminal, leaving, put_off, say, tell

if sys.platform == "win32":
    pytest.skip("signals of POSIX", allow_module_level=True)

ALL = [signal.SIGINT, signal.SIGTERM, signal.SIGHUP]


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
    until = time.monotonic() + 20.0
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


CODE = """
import json, os, signal, threading
import restitution as rs
from reference.signals import watched
body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
how = {"particles": 4000, "impacts": 100, "threads": 1}
begun, ended, found, alone = threading.Event(), threading.Event(), [], rs.simulate(body, law, **how)
watched(lambda *_: begun.set())
def work():
    try:
        found.append(rs.simulate(body, law, **how))
    finally:
        ended.set()
worker = threading.Thread(target=work)
worker.start()
interrupted = False
try:
    begun.wait()
    os.kill(os.getpid(), signal.SIGINT)
    ended.wait()
except KeyboardInterrupt:
    interrupted = True
ended.wait()
print(json.dumps([interrupted, found[0].identical(alone)]))
"""


def test_a_run_in_another_thread_goes_on_to_its_end() -> None:
    """The main thread is interrupted at once; the run has the result of one that was never disturbed."""
    assert json.loads(Program(CODE).said()) == [True, True]


def test_a_stream_that_lacks_a_letter() -> None:
    """As ε in Latin-1: what was written to files stays written, and the line is said."""
    code = "from restitution.cli._process import open_missing, say, tell\n"
    code += "open_missing(); say('1 ε'); tell('2 ε\\x1b[31m')"
    words = [sys.executable, "-c", code]
    env = os.environ | {"PYTHONIOENCODING": "latin-1:strict"}
    done = subprocess.run(words, capture_output=True, text=True, check=True, env=env)
    assert (done.stdout, done.stderr) == ("1 \\u03b5\n", "2 \\u03b5\\x1b[31m\n")


@pytest.mark.parametrize("name", ["stdout", "stderr"])
@pytest.mark.parametrize("stream", [None, open(os.devnull, encoding="utf-8")])  # noqa: SIM115
def test_nobody_listens(name: str, stream: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a service, where a stream is missing or closed."""
    if stream is not None:
        stream.close()
    monkeypatch.setattr(sys, name, stream)
    assert not is_terminal(getattr(sys, name))
    if name == "stderr" or stream is None:
        (say if name == "stdout" else tell)("a line")
