"""What all tests share."""

import signal
from pathlib import Path

import matplotlib
import pytest
from hypothesis import settings

import restitution as rs
from reference.command import SMALL

matplotlib.use("Agg")

# Programs inherit what is ignored: in the background of a shell it is Ctrl-C, under nohup the hangup.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

# The same examples in every run, however busy the machine: a test that fails once fails always.
settings.register_profile("repeatable", derandomize=True, deadline=None, database=None)
settings.load_profile("repeatable")


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
