"""Signals, kills and streams: what is finished is kept, what is not leaves nothing behind."""

import io
import os
import re
import signal
import subprocess
import sys
import time
import tomllib
from functools import partial
from pathlib import Path

import pytest

import restitution as rs
from reference.command import LONG, SMALL, Command, Program, invoke, load


@pytest.fixture
def long(tmp_path: Path) -> Path:
    path = tmp_path / "long.toml"
    path.write_text(f"{LONG}3000000", encoding="utf-8")
    return path


def wait_for(pattern: str, folder: Path) -> None:
    """Until a file of that name is there."""
    for _ in range(12_000):
        if any(re.fullmatch(pattern, file.name) for file in folder.iterdir()):
            return
        time.sleep(0.01)
    pytest.fail(f"no {pattern} appeared in {folder}")


# The command, which tells by a file when the engine is at work.
TELLING = """
import pathlib, sys
from reference.signals import watched
from restitution.cli import main

marker = sys.argv.pop()
watched(lambda finished, _: finished and pathlib.Path(marker).touch())
main()
"""


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_ends_a_run_as_ctrl_c_does(long: Path, tmp_path: Path, number: signal.Signals) -> None:
    """The impacts so far are written, nothing else is left, and the exit status names the signal."""
    if sys.platform == "win32":
        pytest.skip("no signal ends another process in order")
    out = tmp_path / "run.nc"
    words = ["simulate", str(long), "--out", str(out), "--threads", "1", str(tmp_path / "begun")]
    process = Program(TELLING, *words)
    wait_for("begun", tmp_path)
    process.send_signal(number)
    status, _, told = process.finished(60)
    assert (status, told) == (128 + number, "interrupted; writing the impacts so far\n")
    assert "incomplete" in load(out).attrs
    assert {file.name for file in tmp_path.iterdir()} == {"run.nc", "long.toml", "begun"}
    out.unlink()


def close(numbers: tuple[int, ...]) -> None:
    """Have no standard streams of these numbers, as after `>&-` of a shell."""
    for number in numbers:
        setattr(sys, ("stdin", "stdout", "stderr")[number], None)
        os.close(number)


@pytest.mark.parametrize("closed", [(1,), (0, 1, 2)])
def test_closed_streams_do_not_matter(parameters: Path, closed: tuple[int, ...]) -> None:
    """The file is written, whole: no other takes the place of a standard stream."""
    out = parameters.with_name("run.nc")
    status, _, told = Command("simulate", parameters, "--out", out, before=partial(close, closed)).finished()
    assert (status, told) == (0, "")
    assert load(out).sizes["particle"] == 7


def test_a_pipe_that_nobody_reads_does_not_matter(parameters: Path) -> None:
    if sys.platform == "win32":
        pytest.skip("there is no bash")
    out = parameters.with_name("run.nc")
    code = "from restitution.cli import main; main()"
    line = f"'{sys.executable}' -c '{code}' simulate '{parameters}' --out '{out}' 2>&1 | true"
    done = subprocess.run(["bash", "-o", "pipefail", "-c", line], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert load(out).sizes["particle"] == 7


@pytest.mark.parametrize("closed", [False, True])
def test_progress_without_a_standard_error(
    body: rs.Dumbbell, law: rs.TangentialRestitution, monkeypatch: pytest.MonkeyPatch, closed: bool
) -> None:
    """None, or one that is closed: as in a service, or under pythonw."""
    stream = io.StringIO()
    stream.close()
    monkeypatch.setattr(sys, "stderr", stream if closed else None)
    assert rs.simulate(body, law, particles=2, impacts=2, progress=True).sizes["particle"] == 2


def test_two_runs_to_one_name(tmp_path: Path) -> None:
    """One of them gets it, the other is told; the file is whole and that of one run."""
    for seed in range(2):
        text = re.sub("seed = .*", f"seed = {seed}", SMALL)
        (tmp_path / f"{seed}.toml").write_text(text, encoding="utf-8")
    out = tmp_path / "run.nc"
    runs = [Command("simulate", tmp_path / f"{seed}.toml", "--out", out) for seed in range(2)]
    told = [run.finished(120) for run in runs]
    assert sorted(code for code, *_ in told) == [0, 1]
    assert all(
        text == f"error: {out}: exists already; --overwrite replaces it\n" for code, _, text in told if code
    )
    winner = next(seed for seed, (code, *_) in enumerate(told) if code == 0)
    assert load(out).attrs["seed"] == winner
    assert len(list(tmp_path.iterdir())) == 3


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("run.toml", "is what is read: give another name to write to"),
        ("link.toml", "is what is read: give another name to write to"),
        ("n" * 300, "File name too long"),
        ("folder", "not a file that can be written"),
        ("none/run.nc", "No such file or directory"),
        ("run.toml/run.nc", "Not a directory"),
        ("/dev/null", "not a file that can be written"),
    ],
    ids=str,
)
def test_names_that_are_refused_at_once(
    parameters: Path, monkeypatch: pytest.MonkeyPatch, name: str, text: str
) -> None:
    """Before anything is computed, with --overwrite too, and nothing is touched."""
    if sys.platform == "win32":
        pytest.skip("the system has other words")
    monkeypatch.setattr("restitution.drop.simulate.simulate_run", lambda *_, **__: pytest.fail("begun"))
    folder = parameters.parent
    (folder / "link.toml").symlink_to(parameters)
    (folder / "folder").mkdir()
    before = sorted(folder.iterdir())
    done = invoke("simulate", parameters, "--overwrite", "--out", folder / name)
    assert (done.exit_code, done.stdout) == (1, "")
    assert done.stderr.startswith("error: ")
    assert text in done.stderr
    assert sorted(folder.iterdir()) == before


def test_one_output_twice(parameters: Path) -> None:
    out = parameters.with_name("dist.nc")
    done = invoke("distribution", parameters, "--out", out, "--header", f"{out.parent}/./dist.nc")
    told = f"error: {out}: is to be written twice: give another name to write to\n"
    assert (done.exit_code, done.stderr) == (1, told)


BROKEN = """
import os, signal, typer
from restitution.cli._common import errors_in_a_line

def work():
    with errors_in_a_line():
        try:
            os.kill(os.getpid(), signal.SIGHUP)
        except BaseException as error:
            kept = error
            raise ImportError("initialization failed")

typer.run(work)
"""


def test_a_signal_in_an_import() -> None:
    """Of which a compiled library makes an error of its own: the command was interrupted all the same."""
    if sys.platform == "win32":
        pytest.skip("there is no hangup")
    status, _, told = Program(BROKEN).finished(30)
    assert (status, told) == (128 + signal.SIGHUP, "interrupted\n")


EARLY = """
import os, signal, sys

class Finder:
    def find_spec(self, name, *_):
        if name == "typer":
            os.kill(os.getpid(), signal.SIGINT)

sys.meta_path.insert(0, Finder())
"""
LATE = """
import atexit, os, signal, sys

atexit.register(os.kill, os.getpid(), signal.SIGINT)
"""


@pytest.mark.parametrize("when", [EARLY, LATE], ids=["early", "late"])
def test_ctrl_c_in_the_first_and_the_last_moment(when: str) -> None:
    """While the command line is imported, and when it has done its work: no traceback."""
    if sys.platform == "win32":
        pytest.skip("no signal ends a process")
    code = when + "sys.argv = ['restitution', '--version']\nfrom restitution.__main__ import main\nmain()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (-signal.SIGINT, "")
    settings = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))
    assert settings["project"]["scripts"] == {"restitution": "restitution.__main__:main"}


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("a\x1b]0;owned\x07\nerror: b", "a\\x1b]0;owned\\x07\\nerror: b: No such file or directory"),
        ("n" * 100_000, "n" * 500 + " ... " + "n" * 480 + ": File name too long"),
    ],
    ids=["obeyed", "long"],
)
def test_a_name_that_is_told_stays_in_its_line(name: str, told: str, tmp_path: Path) -> None:
    """And no terminal obeys it."""
    done = invoke("simulate", name, "--out", tmp_path / "run.nc")
    assert (done.exit_code, done.stderr) == (1, f"error: {told}\n")
