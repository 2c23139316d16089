"""The command line: the results of the call, errors in a line, files whole or not at all, nothing lost."""

import os
import pty
import re
import resource
import signal
import subprocess
import sys
import termios
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner, Result

import restitution as rs
from restitution._cli import BAD_INPUT, FAILED, INTERRUPTED, app
from restitution._dataset import STOP_REASONS, save
from restitution._toml import read

ROOT = Path(__file__).parents[1]
COMMAND = [sys.executable, "-c", "from restitution._cli import main; main()"]

SMALL = """
[body]
shape = "dumbbell"
radius = 2e-3
separation = 3e-3
density = 7800

[law]
type = "tangential-restitution"
normal = 0.9
tangential = 0.95

[run]
particles = 7
impacts = 11
release_height = 0.05
gravity = 1.62
orientation = "isotropic"
minimum_speed = 0.1
seed = 18446744073709551615
"""


def invoke(*words: object) -> Result:
    """Run a command in this process."""
    return CliRunner().invoke(app, [str(word) for word in words])


@pytest.fixture
def parameters(tmp_path: Path) -> Path:
    """A file of parameters, none of which has its default value."""
    path = tmp_path / "run.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


def small() -> xr.Dataset:
    """The same run as a call."""
    return rs.simulate(
        rs.Dumbbell(radius=2e-3, separation=3e-3, density=7800),
        rs.TangentialRestitution(normal=0.9, tangential=0.95),
        particles=7,
        impacts=11,
        release_height=0.05,
        gravity=1.62,
        orientation="isotropic",
        minimum_speed=0.1,
        seed=2**64 - 1,
    )


def load(path: Path) -> xr.Dataset:
    """A netCDF file as xarray reads it without being told anything."""
    return xr.load_dataset(path)


def test_a_file_gives_what_the_call_gives(parameters: Path) -> None:
    """Values, names, types and attributes, bit for bit, after the way through TOML and netCDF."""
    out = parameters.with_name("run.nc")
    result = invoke("simulate", parameters, "--out", out, "--threads", 2)
    assert (result.exit_code, result.stderr) == (0, "")
    data = load(out)
    xr.testing.assert_identical(data, small())
    assert {name: v.dtype for name, v in data.variables.items()} == {
        name: v.dtype for name, v in small().variables.items()
    }
    assert data.attrs["seed"] == 2**64 - 1
    assert "incomplete" not in data.attrs


def test_the_summary(parameters: Path) -> None:
    """What was done, why the particles stopped, and how much kinetic energy appeared, counted here anew."""
    result = invoke("simulate", parameters, "--out", parameters.with_name("run.nc"))
    data = small()
    ratio = data.energy_ratio.to_numpy()
    gains = ratio[ratio > 1]
    reasons, counts = np.unique(data.stop_reason, return_counts=True)
    stops = [f"{STOP_REASONS[reason]} {count}" for reason, count in zip(reasons, counts, strict=True)]
    assert result.stdout.splitlines() == [
        f"7 particles, {np.isfinite(ratio).sum()} impacts",
        f"stop reasons: {', '.join(stops)}",
        f"{gains.size} impacts created kinetic energy, at most by a factor of {gains.max():.6g}",
    ]


def test_angles_and_defaults_in_a_file(tmp_path: Path) -> None:
    """Angles may be given; all of [run] may be left out, then the defaults of `simulate` hold."""
    head = SMALL.partition("[run]")[0]
    path = tmp_path / "run.toml"
    path.write_text(head + "[run]\nparticles = 2\nimpacts = 3\norientation = [0, 0.7]", encoding="utf-8")
    assert invoke("simulate", path, "--out", tmp_path / "angles.nc").exit_code == 0
    xr.testing.assert_identical(
        load(tmp_path / "angles.nc"),
        rs.simulate(read(path).body, read(path).law, particles=2, impacts=3, orientation=np.array([0, 0.7])),
    )
    path.write_text(head, encoding="utf-8")
    run = read(path)
    xr.testing.assert_identical(
        rs.simulate(run.body, run.law),
        rs.simulate(
            run.body,
            run.law,
            particles=1000,
            impacts=400,
            release_height=0.06,
            gravity=9.81,
            orientation="uniform-angle",
            minimum_speed=0.0,
            seed=1,
            threads=1,
        ),
    )
    assert (run.particles, run.impacts, run.release_height, run.seed) == (1000, 400, 0.06, 1)


def test_the_example_and_the_help_describe_the_same_run() -> None:
    """examples/run.toml, the file in the help text, and the defaults are one."""
    run = read(ROOT / "examples/run.toml")
    help_text = invoke("simulate", "--help").stdout
    shown = help_text[help_text.index("[body]") : help_text.index("seed = 1") + len("seed = 1")]
    assert tomllib.loads(shown) == tomllib.loads((ROOT / "examples/run.toml").read_text(encoding="utf-8"))
    assert run == type(run)(body=run.body, law=run.law)
    assert (run.body, run.law) == (
        rs.Dumbbell(radius=3e-3, separation=3e-4),
        rs.TangentialRestitution(normal=0.98),
    )


@pytest.mark.parametrize("words", [[], ["simulate"], ["paper"]], ids=str)
def test_help(words: list[str]) -> None:
    """Every command explains itself in characters that every terminal has, and its options too."""
    result = invoke(*words, "--help")
    assert result.exit_code == 0
    prose = re.sub("[─│╭╮╰╯]", "", result.stdout)  # the frames, which are ASCII where the terminal is
    assert prose.isascii()
    expected = {"": ["simulate", "paper", "--version"], "simulate": ["--out", "--threads", "--force"]}
    for option in expected.get(" ".join(words), ["--out", "--impacts", "--seed", "--threads", "100000000"]):
        assert option in prose


def test_version() -> None:
    assert invoke("--version").stdout == f"restitution {rs.__version__}\n"


def test_what_is_no_command_or_lacks_an_option(parameters: Path) -> None:
    for words in ([], ["simulat"], ["simulate", parameters], ["simulate"], ["paper"], ["paper", "--out"]):
        assert invoke(*words).exit_code == BAD_INPUT


# Files


def test_an_existing_file_is_replaced_only_if_asked(parameters: Path) -> None:
    """Also through a symbolic link, which stays one; permissions are those of any new file."""
    out, link = parameters.with_name("run.nc"), parameters.with_name("link.nc")
    out.write_text("precious", encoding="utf-8")
    link.symlink_to(out)
    refused = invoke("simulate", parameters, "--out", link)
    assert (refused.exit_code, refused.stderr) == (FAILED, f"error: {link}: exists already\n")
    assert out.read_text(encoding="utf-8") == "precious"
    assert invoke("simulate", parameters, "--out", link, "--force").exit_code == 0
    assert link.is_symlink()
    xr.testing.assert_identical(load(out), small())
    fresh = parameters.with_name("fresh")
    fresh.touch()
    assert out.stat().st_mode == fresh.stat().st_mode


def places(folder: Path) -> dict[Path, str]:
    """Where nothing can be written, and what is said of it."""
    (folder / "taken.nc").write_text("precious", encoding="utf-8")
    (folder / "folder.nc").mkdir()
    no_file = "not a file that can be written"
    return {
        folder / "none" / "run.nc": f"{folder / 'none'}: No such file or directory",
        folder / "taken.nc" / "run.nc": f"{folder / 'taken.nc'}: Not a directory",
        folder / "taken.nc": f"{folder / 'taken.nc'}: exists already",
        folder / "folder.nc": f"{folder / 'folder.nc'}: {no_file}",
        Path("/dev/null"): f"/dev/null: {no_file}",
    }


def test_an_output_that_cannot_be_written(parameters: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is refused before the work begins, and what was there is untouched."""

    def begun(*_: object, **__: object) -> None:
        raise AssertionError("the work began")

    monkeypatch.setattr("restitution._simulate.simulate_run", begun)
    for out, expected in places(parameters.parent).items():
        before = sorted(parameters.parent.rglob("*"))
        result = invoke("simulate", parameters, "--out", out)
        assert (result.exit_code, result.stderr) == (FAILED, f"error: {expected}\n")
        assert sorted(parameters.parent.rglob("*")) == before
    assert (parameters.parent / "taken.nc").read_text(encoding="utf-8") == "precious"


def test_a_run_file_that_cannot_be_read(tmp_path: Path) -> None:
    for path, reason in ((tmp_path / "none.toml", "No such file or directory"), (tmp_path, "Is a directory")):
        result = invoke("simulate", path, "--out", tmp_path / "run.nc")
        assert (result.exit_code, result.stderr) == (FAILED, f"error: {path}: {reason}\n")
    assert list(tmp_path.iterdir()) == []


def test_threads(parameters: Path) -> None:
    result = invoke("simulate", parameters, "--out", parameters.with_name("run.nc"), "--threads", 0)
    expected = "error: threads = 0: must be a whole number in [1, 1024] or None\n"
    assert (result.exit_code, result.stderr) == (BAD_INPUT, expected)
    assert list(parameters.parent.iterdir()) == [parameters]


def test_a_full_disk_leaves_nothing(parameters: Path) -> None:
    """A limit on the size of files stands for the disk; the old file stays, no part of the new one does."""
    out = parameters.with_name("run.nc")
    out.write_text("precious", encoding="utf-8")
    done = subprocess.run(
        [*COMMAND, "simulate", str(parameters), "--out", str(out), "--force"],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)),
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == FAILED
    assert done.stderr.startswith(f"error: {out}: cannot be written: ")
    assert done.stderr.count("\n") == 1
    assert sorted(parameters.parent.iterdir()) == [out, parameters]
    assert out.read_text(encoding="utf-8") == "precious"


@pytest.mark.parametrize(
    ("error", "code", "text"),
    [
        (rs.NumericalError("particle 3 (seed 1): ..."), FAILED, "error: particle 3 (seed 1): ...\n"),
        (MemoryError(), FAILED, "error: out of memory\n"),
        (KeyboardInterrupt(), INTERRUPTED, "interrupted\n"),
    ],
    ids=["numerics", "memory", "Ctrl-C while saving"],
)
def test_other_trouble_is_a_line_too(
    parameters: Path, monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int, text: str
) -> None:
    """Nothing is written, nor stays if the file was begun (the work itself is done by then)."""

    def fail(*_: object, **__: object) -> None:
        raise error

    target = (
        "restitution._core.simulate" if isinstance(error, rs.NumericalError) else "xarray.Dataset.to_netcdf"
    )
    monkeypatch.setattr(target, fail)
    result = invoke("simulate", parameters, "--out", parameters.with_name("run.nc"))
    assert (result.exit_code, result.stderr) == (code, text)
    assert list(parameters.parent.iterdir()) == [parameters]


def test_a_saved_dataset_is_read_unchanged(tmp_path: Path) -> None:
    data = small()
    save(data, tmp_path / "run.nc")
    xr.testing.assert_identical(load(tmp_path / "run.nc"), data)


# Ctrl-C

LONG = """
[body]
shape = "dumbbell"
radius = 3e-3
separation = 3e-4
[law]
type = "tangential-restitution"
normal = 0.98
[run]
impacts = 20
particles = """


# The command, with a Ctrl-C as soon as some particles have finished and others have not.
PRESSING = """
import signal
from restitution import _core
from restitution._cli import main

engine = _core.simulate


def simulate(run, threads, progress):
    def press(finished):
        if 0 < finished < run["particles"]:
            signal.raise_signal(signal.SIGINT)

    return engine(run, threads, press)


_core.simulate = simulate
main()
"""


def test_ctrl_c_keeps_what_was_finished(tmp_path: Path) -> None:
    """A true signal in a true process, in the midst of its work.

    The file has the particles that were begun: those that finished have the bits that an uninterrupted run
    gives them, the others have the stop reason "interrupted", and the file says that it is incomplete.
    """
    parameters, out = tmp_path / "run.toml", tmp_path / "run.nc"
    words = ["simulate", str(parameters), "--out", str(out), "--force", "--threads", "1"]
    for particles in (400_000, 800_000, 1_600_000):  # until this machine takes long enough to be interrupted
        parameters.write_text(f"{LONG}{particles}", encoding="utf-8")
        command = [sys.executable, "-c", PRESSING, *words]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            break
    assert (done.returncode, done.stderr) == (INTERRUPTED, "interrupted; writing the impacts so far\n")

    data = load(out)
    cut = (data.stop_reason == STOP_REASONS.index("interrupted")).to_numpy()
    assert 0 < cut.sum() < cut.size < particles
    done_and_cut = f"{(~cut).sum()} of {particles} particles are finished, {cut.sum()} cut short"
    assert data.attrs["incomplete"] == f"interrupted: {done_and_cut}"
    assert f"interrupted {cut.sum()}" in done.stdout
    run = read(parameters)
    whole = rs.simulate(run.body, run.law, particles=run.particles, impacts=run.impacts)
    for name in whole.data_vars:
        np.testing.assert_array_equal(data[name].to_numpy()[~cut], whole[name].to_numpy()[: cut.size][~cut])
    assert sorted(tmp_path.iterdir()) == [out, parameters]
    out.unlink()


def test_a_terminal_gets_a_progress_bar(parameters: Path) -> None:
    """And nothing else does, as the empty standard error of the other tests shows."""
    terminal, end = pty.openpty()
    termios.tcsetwinsize(end, (24, 80))  # a bar needs room
    command = [*COMMAND, "simulate", str(parameters), "--out", str(parameters.with_name("run.nc"))]
    subprocess.run(command, stderr=end, stdout=subprocess.DEVNULL, check=True)
    os.close(end)
    assert "simulate: 100%" in os.read(terminal, 10_000).decode()
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


def test_paper_hands_over_its_options(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The command adds nothing to `redraw` but the report of errors."""
    import restitution.paper

    given: list[Any] = []

    def redraw(out: Path, **options: Any) -> Path:
        given.extend([out, options])
        if options["impacts"] < 400_000:
            raise ValueError(f"impacts = {options['impacts']}: must be at least 400000")
        return out / "report.html"

    monkeypatch.setattr(restitution.paper, "redraw", redraw, raising=False)
    result = invoke("paper", "--out", tmp_path, "--impacts", 500_000, "--seed", 7, "--threads", 2)
    assert (result.exit_code, result.stdout) == (0, f"{tmp_path / 'report.html'}\n")
    assert given == [tmp_path, {"impacts": 500_000, "seed": 7, "threads": 2, "progress": False}]
    result = invoke("paper", "--out", tmp_path, "--impacts", 3)
    assert (result.exit_code, result.stderr) == (BAD_INPUT, "error: impacts = 3: must be at least 400000\n")
