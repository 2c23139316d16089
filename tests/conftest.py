"""What all tests share."""

import signal
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib
import pytest
from hypothesis import settings

import restitution as rs
from reference.command import SMALL
from reference.studies import TINY
from restitution.study import study_of, sweep
from restitution.study._study import Study
from restitution.study._tables import Effort

matplotlib.use("Agg")

# Programs inherit what is ignored: in the background of a shell it is Ctrl-C, under nohup the hangup.
signal.signal(signal.SIGINT, signal.default_int_handler)
if sys.platform != "win32":
    signal.signal(signal.SIGHUP, signal.SIG_DFL)

# The same examples in every run, however busy the machine: a test that fails once fails always.
settings.register_profile("repeatable", derandomize=True, deadline=None, database=None)
settings.load_profile("repeatable")


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Say where the time goes, folder by folder."""
    seconds: defaultdict[str, float] = defaultdict(float)
    for reports in terminalreporter.stats.values():
        for one in reports:
            if isinstance(one, pytest.TestReport):
                seconds[Path(one.nodeid.partition("::")[0]).parent.name] += one.duration
    longest = sorted(seconds, key=seconds.__getitem__, reverse=True)
    parts = ", ".join(f"{folder} {seconds[folder]:.0f}" for folder in longest)
    terminalreporter.write_line(f"Seconds by folder: {parts}")


@pytest.fixture
def body() -> rs.Dumbbell:
    """The paper's particle of Figs. 2-5 and 7, L/R = 0.1."""
    return rs.Dumbbell(radius=3e-3, separation=3e-4)


@pytest.fixture
def law() -> rs.TangentialRestitution:
    """The paper's law of Figs. 2-7."""
    return rs.TangentialRestitution(normal=0.98)


@pytest.fixture
def parameters(tmp_path: Path) -> Path:
    """A file of parameters, none of which has its default value."""
    path = tmp_path / "run.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def small_tasks() -> Iterator[None]:
    """Two batches to a task, so that a point of the study of six points has two of them."""
    whole = Effort.task_batches
    Effort.task_batches = property(lambda _: 2)  # type: ignore[assignment]
    yield
    Effort.task_batches = whole  # type: ignore[method-assign]


@pytest.fixture(scope="module")
def tiny() -> Study:
    """The study of six points."""
    return study_of(TINY)


@pytest.fixture(scope="module")
def done(tmp_path_factory: pytest.TempPathFactory, small_tasks: None) -> Path:
    """Its store, finished; to be left as it is."""
    path = tmp_path_factory.mktemp("done") / "done.zarr"
    sweep(TINY, path, threads=1)
    return path
