"""The command line in a terminal: Ctrl-C loses nothing that was finished, and progress is shown."""

import os
import signal
import sys
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.command import LONG, Command, Program, invoke, load, small
from restitution._core import STOP_REASONS
from restitution.cli import INTERRUPTED
from restitution.drop.toml import read

if sys.platform == "win32":
    pytest.skip("signals and terminals of POSIX", allow_module_level=True)

import pty
import termios

# The command, with a Ctrl-C as soon as some particles have finished and others have not.
PRESSING = """
import signal
from reference.signals import watched
from restitution.cli import main

watched(lambda finished, all: 0 < finished < all and signal.raise_signal(signal.SIGINT))
main()
"""


def test_ctrl_c_keeps_what_was_finished(tmp_path: Path) -> None:
    """A true signal in a true process, in the midst of its work.

    The file has the particles that were begun: those that finished have the bits that an uninterrupted run
    gives them, the others have the stop reason "interrupted", and the file says that it is incomplete.
    """
    parameters, out = tmp_path / "run.toml", tmp_path / "run.nc"
    words = ["simulate", str(parameters), "--out", str(out), "--overwrite", "--threads", "1"]
    # Until this machine takes long enough to be interrupted, and not between two blocks of particles.
    for particles in (400_000, 800_000, 1_600_000):
        parameters.write_text(f"{LONG}{particles}", encoding="utf-8")
        status, said, told = Program(PRESSING, *words).finished()
        data = load(out)
        cut = (data.stop_reason == STOP_REASONS.index("interrupted")).to_numpy()
        if status != 0 and cut.any():
            break
    assert (status, told) == (INTERRUPTED, "interrupted; writing the impacts so far\n")
    assert 0 < cut.sum() < cut.size < particles
    done_and_cut = f"{(~cut).sum()} of {particles} particles are finished, {cut.sum()} cut short"
    assert data.attrs["incomplete"] == f"interrupted: {done_and_cut}"
    assert f"{cut.sum()} particles ended because the run was interrupted" in said
    run = read(parameters)
    whole = rs.simulate(run.body, run.law, particles=run.particles, impacts=run.impacts)
    for name in whole.data_vars:
        np.testing.assert_array_equal(data[name].to_numpy()[~cut], whole[name].to_numpy()[: cut.size][~cut])
    assert sorted(tmp_path.iterdir()) == [out, parameters]
    out.unlink()


def in_terminal(name: str) -> None:
    """Have the terminal as standard error."""
    sys.stderr = open(os.open(name, os.O_WRONLY | os.O_NOCTTY), "w", encoding="utf-8")  # noqa: SIM115


def test_a_terminal_gets_a_progress_bar(parameters: Path) -> None:
    """And nothing else does, as the empty standard error of the other tests shows."""
    terminal, end = pty.openpty()
    termios.tcsetwinsize(end, (24, 80))  # a bar needs room
    words = ("simulate", parameters, "--out", parameters.with_name("run.nc"))
    status = Command(*words, before=partial(in_terminal, os.ttyname(end))).finished()[0]
    shown = os.read(terminal, 10_000).decode()
    assert (status, "simulate: 100%" in shown) == (0, True), shown
    os.close(end)
    os.close(terminal)


@pytest.mark.parametrize("presses", [1, 2])
def test_ctrl_c_while_the_file_is_written(
    parameters: Path, monkeypatch: pytest.MonkeyPatch, presses: int
) -> None:
    """The first one waits for the file, the second one gives it up; either way no part of a file is left."""
    out = parameters.with_name("run.nc")
    write = xr.Dataset.to_netcdf

    def pressed(data: xr.Dataset, *where: Any, **how: Any) -> None:
        for _ in range(presses):
            signal.raise_signal(signal.SIGINT)
        write(data, *where, **how)

    monkeypatch.setattr(xr.Dataset, "to_netcdf", pressed)
    result = invoke("simulate", parameters, "--out", out)
    assert result.exit_code == INTERRUPTED
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if presses == 1:
        xr.testing.assert_identical(load(out), small())
    else:
        assert list(parameters.parent.iterdir()) == [parameters]
