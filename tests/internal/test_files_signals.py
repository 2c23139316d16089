"""A signal at any moment leaves all of what was to be written, or what stood there before, and no draft."""

import errno
import os
import random
import shutil
import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from restitution._internal.files import check, claim, whole_file, whole_files, whole_folder
from restitution._internal.process import ending

NAMES = ("a", "b.html")


Body = Callable[[list[Path]], None]


@dataclass(frozen=True)
class Work:
    """What is written in a folder by a block, and what stands there before it and after it."""

    do: Callable[[Path, Body], None]
    before: dict[str, str]
    after: dict[str, str]


def fill(drafts: list[Path]) -> None:
    for draft in drafts:
        draft.write_text("new")


def one(replace: bool) -> Callable[[Path, Body], None]:
    def do(place: Path, body: Body) -> None:
        with whole_file(place / "a", replace=replace) as draft:
            body([draft])

    return do


def several(replace: bool) -> Callable[[Path, Body], None]:
    def do(place: Path, body: Body) -> None:
        with whole_files([place / name for name in NAMES], replace=replace) as drafts:
            body(drafts)

    return do


def folder(replace: bool, path: str = ".") -> Callable[[Path, Body], None]:
    def do(place: Path, body: Body) -> None:
        with whole_folder(place / path, replace=replace, names=NAMES) as draft:
            body([draft / name for name in NAMES])

    return do


def checking(replace: bool) -> Callable[[Path, Body], None]:
    return lambda place, _: check(place / "a", replace=replace)


def claiming(place: Path, _: Body) -> None:
    claim(place / "draft", place / "a")


def having(text: str, *names: str) -> dict[str, str]:
    return dict.fromkeys(names, text)


OLD = having("old", "d")
"""In a folder, which stays."""
WORK = {
    "a file": Work(one(False), {}, having("new", "a")),
    "a file replaced": Work(one(True), having("old", "a"), having("new", "a")),
    "files": Work(several(False), {}, having("new", *NAMES)),
    "files replaced": Work(several(True), having("old", *NAMES), having("new", *NAMES)),
    "some replaced": Work(several(True), having("old", "a"), having("new", *NAMES)),
    "a new folder": Work(folder(False, "made/f"), {}, having("new", *(f"made/f/{name}" for name in NAMES))),
    "a folder": Work(folder(False), OLD, OLD | having("new", *NAMES)),
    "a folder replaced": Work(folder(True), OLD | having("old", *NAMES), OLD | having("new", *NAMES)),
}
STEPS = WORK | {
    "a check": Work(checking(False), {}, {}),
    "a check of what stands": Work(checking(True), having("old", "a"), having("old", "a")),
    "a claim": Work(claiming, having("new", "draft"), having("new", "a")),
}


def found(place: Path) -> dict[str, str]:
    """Give what is in files; empty folders count, too."""
    return {
        str(path.relative_to(place)): path.read_text() if path.is_file() else "a folder"
        for path in place.rglob("*")
        if path.is_file() or not any(path.iterdir())
    }


def handlers() -> list[Any]:
    return [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)]


@pytest.fixture
def raising() -> Iterator[None]:
    """Signals end a block of ours as they end a user's program that is told of them by exceptions."""
    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGALRM)
    before = [signal.signal(number, signal.default_int_handler) for number in numbers]
    tracing = sys.gettrace()
    yield
    sys.settrace(tracing)
    for number, handler in zip(numbers, before, strict=True):
        signal.signal(number, handler)


def placed(work: Work, place: Path) -> Path:
    """Make the folder with what stands there before."""
    place.mkdir()
    for name, text in work.before.items():
        (place / name).write_text(text)
    return place


def end(work: Work, place: Path, body: Body = fill) -> str:
    """Do the work, which a signal ends, and tell what is there: "all" or "nothing" of it."""
    placed(work, place)
    before = handlers()
    with pytest.raises(KeyboardInterrupt):  # no signal is lost
        work.do(place, body)
    assert handlers() == before
    left = found(place)
    assert left in (work.before, work.after)
    shutil.rmtree(place)
    return "all" if left == work.after else "nothing"


class Steps:
    """Counts the lines that are run of some files, and sends this process a signal at one of them."""

    def __init__(self, *files: str, but: str = "") -> None:
        self.files, self.but = files, but
        self.seen = self.last = 0

    def start(self, last: int) -> None:
        self.seen, self.last = 0, last
        sys.settrace(self._call)

    def _call(self, frame: FrameType, *_: object) -> Any:
        code = frame.f_code
        return self._step if code.co_filename.endswith(self.files) and code.co_name != self.but else None

    def _step(self, _: FrameType, event: str, __: object) -> Any:
        self.seen += event == "line"
        if self.seen == self.last:
            sys.settrace(None)
            signal.raise_signal(signal.SIGTERM)
        return self._step


@pytest.mark.parametrize("name", STEPS)
@pytest.mark.usefixtures("raising")
def test_a_signal_at_every_line(name: str, tmp_path: Path) -> None:
    """Of what makes, moves and removes drafts; test_undisturbed.py has what holds signals back."""
    work = STEPS[name]
    steps = Steps("files.py", "drafts.py", "tempfile.py")

    def do(place: Path, body: Body) -> None:
        steps.start(last)
        work.do(place, body)
        sys.settrace(None)

    last = 0
    for first in ("0", "00"):  # at the first time tempfile has more to do
        do(placed(work, tmp_path / first), fill)
        assert found(tmp_path / first) == work.after
    ends = []
    for last in range(1, steps.seen + 1):
        ends.append(end(Work(do, work.before, work.after), tmp_path / str(last)))
    assert len(ends) >= 5
    if work.before != work.after:
        assert ends == sorted(ends, reverse=True)  # nothing up to one moment, and all from there on
        assert set(ends) == {"nothing", "all"}


CALLS = ("link", "rename", "replace", "unlink", "mkdir", "rmdir", "open", "close", "fsync")


@pytest.mark.parametrize("name", STEPS)
@pytest.mark.usefixtures("raising")
def test_a_signal_in_every_call_of_the_system(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As it ends; in the block of a command, whose exit status then tells the signal."""
    work = STEPS[name]
    calls = last = 0
    at_work = False

    def struck(real: Callable[..., Any], *args: Any, **how: Any) -> Any:
        nonlocal calls
        result = real(*args, **how)
        calls += at_work
        if at_work and calls == last:
            signal.raise_signal(signal.SIGTERM)
        return result

    def do(place: Path, body: Body) -> None:
        nonlocal calls, at_work
        calls, at_work = 0, True
        with ending() as came:
            try:
                work.do(place, body)
            finally:
                at_work = False
                assert came == [signal.SIGTERM] * (last > 0)

    for call in CALLS:
        monkeypatch.setattr(os, call, partial(struck, getattr(os, call)))
    do(placed(work, tmp_path / "0"), fill)
    assert calls > 1
    for last in range(1, calls + 1):
        end(Work(do, work.before, work.after), tmp_path / str(last))


@pytest.mark.parametrize("name", ["a file", "files replaced", "a new folder", "a folder replaced"])
@pytest.mark.parametrize(
    "trouble", [KeyboardInterrupt(), OSError(errno.ENOSPC, "disk full")], ids=["signal", "error"]
)
@pytest.mark.usefixtures("raising")
def test_a_signal_while_drafts_are_removed(name: str, trouble: BaseException, tmp_path: Path) -> None:
    """After another one or an error, and before signals are held back, too."""
    work = WORK[name]
    steps = Steps("_signals.py", but="surely")  # whose own lines call nothing, and signals count after calls

    def failing(drafts: list[Path]) -> None:
        fill(drafts)
        steps.start(last)
        raise trouble

    last = 0
    with pytest.raises(type(trouble)):
        work.do(placed(work, tmp_path / "0"), failing)
    sys.settrace(None)
    assert found(tmp_path / "0") == work.before
    assert steps.seen > 20
    for last in range(1, steps.seen + 1):
        assert end(work, tmp_path / str(last), failing) == "nothing"


@pytest.mark.parametrize("name", WORK)
@pytest.mark.usefixtures("raising")
def test_a_signal_of_a_timer(name: str, tmp_path: Path) -> None:
    """Between the lines, too, and whatever its number, as where a program limits the time of a call."""
    work, draw = WORK[name], random.Random(1)
    begun = time.perf_counter()
    work.do(placed(work, tmp_path / "0"), fill)
    takes = time.perf_counter() - begun
    for number in range(1, 51):
        place = placed(work, tmp_path / str(number))
        with suppress(KeyboardInterrupt):
            signal.setitimer(signal.ITIMER_REAL, draw.uniform(0.1, 1.1) * takes)
            work.do(place, fill)
            signal.setitimer(signal.ITIMER_REAL, 0)
        assert found(place) in (work.before, work.after)
        shutil.rmtree(place)
