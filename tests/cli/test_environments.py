"""Commands where something is missing: a part, drawn with a fixed seed, of `make hostile`."""

import contextlib
import random
import signal
import sys
from functools import partial
from pathlib import Path

import pytest

from reference.command import Command
from reference.commands import COMMANDS, LONG, RUN, STUDY, inputs
from reference.signals import arm
from restitution.cli import app

if sys.platform != "linux":
    pytest.skip("limits of a process, and files in /dev and /proc", allow_module_level=True)

from reference.environments import ENVIRONMENTS
from reference.processes import command

TESTS = Path(__file__).parents[1]


def test_commands_in_hostile_environments() -> None:
    """Give our error, or a right result, within a time; never abort or hang, and leave nothing behind."""
    draw = random.Random(1)
    pairs = [(name, place) for name in COMMANDS for place in ENVIRONMENTS if name not in LONG]
    for name, surroundings in draw.sample(pairs, 1):
        assert command(name, surroundings, draw) is None, (name, surroundings)


def test_every_command_is_tried() -> None:
    """Find commands that are called by their name, and those in groups."""
    names = {command.callback.__name__ for command in app.registered_commands if command.callback}
    names |= {group.name or "" for group in app.registered_groups}
    assert {name.replace("_", "-") for name in names} <= {name.split()[0] for name in COMMANDS}
    sent = {number for one in ENVIRONMENTS.values() for number in one.signals}
    assert sent == {signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGSTOP, signal.SIGCONT}


@pytest.mark.parametrize(
    ("name", "surroundings"),
    [
        pytest.param("laws", "four files", marks=pytest.mark.slow),  # which figures take for their fonts
        ("sweep", "six files"),
        ("simulate", "two files"),
        pytest.param("distribution", "ten files", marks=pytest.mark.slow),
    ],
)
def test_few_open_files(name: str, surroundings: str) -> None:
    """Their error names what cannot be opened; nothing is left, though listing a folder takes one."""
    assert command(name, surroundings, random.Random(1)) is None


@pytest.mark.parametrize(
    ("name", "surroundings"),
    [
        ("sweep", "stopped and continued"),
        pytest.param("statistics", "stopped and continued", marks=pytest.mark.slow),
        pytest.param("sweep", "no assertions", marks=pytest.mark.slow),
        pytest.param("statistics", "no assertions", marks=pytest.mark.slow),
    ],
)
def test_other_surroundings(name: str, surroundings: str) -> None:
    """Who is stopped goes on, and ends at Ctrl-C; where Python leaves assertions out, Zarr's are named."""
    assert command(name, surroundings, random.Random(1)) is None


HOURS = "100000000"
"""Particles."""
ENDED = {
    # the words, the signal, and what may be there afterwards
    "statistics": ("statistics run.toml --out counts.nc", signal.SIGTERM, {"counts.nc"}),
    "compare": ("compare run.toml --out counts.nc", signal.SIGHUP, {"counts.nc"}),
    "distribution": ("distribution run.toml --out dist.nc --header dist.h", signal.SIGINT, set()),
    "laws": ("laws --out laws --impacts 100000000", signal.SIGTERM, set()),
    "paper": ("paper --out paper", signal.SIGHUP, set()),
    "rough": ("rough --out rough --impacts 1000000000", signal.SIGTERM, set()),
    "sweep": ("sweep study.toml --out study.zarr", signal.SIGTERM, {"study.zarr"}),
    "fit": ("fit data.nc --velocity 0.5 0.9 --resamples 1000000", signal.SIGTERM, set()),
    "listen": ("listen ball.wav --diameter 0.02 --out ball.html", signal.SIGHUP, set()),
    "template": ("template", signal.SIGTERM, set()),
    "explore": ("explore run.toml --no-browser", signal.SIGHUP, set()),
}


@pytest.mark.parametrize("name", ENDED)
def test_a_signal_ends_a_command(name: str, tmp_path: Path) -> None:
    """In the midst of work that would take hours: the status names the signal, and no draft is left."""
    line, number, files = ENDED[name]
    (tmp_path / "run.toml").write_text(RUN.replace("PARTICLES", HOURS), encoding="utf-8")
    (tmp_path / "study.toml").write_text(STUDY.replace("PARTICLES", HOURS), encoding="utf-8")
    for read in {"data.nc", "ball.wav"} & set(line.split()):
        (tmp_path / read).symlink_to(inputs() / read)
    before = set(tmp_path.iterdir())
    # The signal comes at the first step of the work, whatever this machine takes to get there.
    with contextlib.chdir(tmp_path):
        started = Command(*line.split(), before=partial(arm, number, name))
    status, _, error = started.finished(120.0)
    assert (status, "Traceback" in error) == (128 + number, False), error
    assert {file.name for file in set(tmp_path.iterdir()) - before} <= files
