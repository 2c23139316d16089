"""The command line: the results of the call, errors in a line, files whole or not at all, nothing lost."""

import importlib
import re
import sys
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.command import SMALL, Command, invoke, load, small
from restitution._core import STOP_REASONS
from restitution.cli import BAD_INPUT, FAILED, INTERRUPTED
from restitution.drop.toml import read

ROOT = Path(__file__).parents[2]


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
    """Count anew what was done, why the particles stopped, and how much kinetic energy appeared."""
    result = invoke("simulate", parameters, "--out", parameters.with_name("run.nc"))
    data = small()
    ratio = data.energy_ratio.to_numpy()
    gains = ratio[ratio > 1]
    reasons, counts = np.unique(data.stop_reason, return_counts=True)
    why = {"impacts_reached": "all impacts asked for were made", "collapse": "impacts accumulate"}
    stops = [
        f"{count} particles ended because {why[STOP_REASONS[reason]]} ({STOP_REASONS[reason]})."
        for reason, count in zip(reasons, counts, strict=True)
    ]
    assert result.stdout.splitlines() == [
        f"7 particles made {np.isfinite(ratio).sum()} impacts.",
        *stops,
        f"{gains.size} impacts created kinetic energy, by a factor of {gains.max():.6g} at most.",
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


def test_the_example_is_the_default_run() -> None:
    run = read(ROOT / "examples/run.toml")
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
    expected = {"": ["simulate", "paper", "--version"], "simulate": ["--out", "--threads", "--overwrite"]}
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
    assert (refused.exit_code, refused.stderr) == (
        FAILED,
        f"error: {link}: exists already; --overwrite replaces it\n",
    )
    assert out.read_text(encoding="utf-8") == "precious"
    assert invoke("simulate", parameters, "--out", link, "--overwrite").exit_code == 0
    assert link.is_symlink()
    xr.testing.assert_identical(load(out), small())
    fresh = parameters.with_name("fresh")
    fresh.touch()
    assert out.stat().st_mode == fresh.stat().st_mode


def test_a_run_file_that_cannot_be_read(tmp_path: Path) -> None:
    for path, reason in ((tmp_path / "none.toml", "No such file or directory"), (tmp_path, "Is a directory")):
        result = invoke("simulate", path, "--out", tmp_path / "run.nc")
        assert (result.exit_code, result.stderr) == (FAILED, f"error: {path}: {reason}\n")
    assert list(tmp_path.iterdir()) == []


def test_a_full_disk_leaves_nothing(parameters: Path) -> None:
    """A limit on the size of files stands for the disk; the old file stays, no part of the new one does."""
    if sys.platform == "win32":
        pytest.skip("there are no limits of a process")
    out = parameters.with_name("run.nc")
    out.write_text("precious", encoding="utf-8")
    import resource

    limited = partial(resource.setrlimit, resource.RLIMIT_FSIZE, (4096, 4096))
    status, _, told = Command("simulate", parameters, "--out", out, "--overwrite", before=limited).finished()
    assert (status, told) == (FAILED, f"error: {out}: File too large\n")
    assert sorted(parameters.parent.iterdir()) == [out, parameters]
    assert out.read_text(encoding="utf-8") == "precious"


@pytest.mark.parametrize(
    ("error", "code", "text"),
    [
        (rs.NumericalError("particle 3 (seed 1): ..."), FAILED, "error: particle 3 (seed 1): ...\n"),
        (MemoryError(), FAILED, "error: root simulate: out of memory\n"),
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


@pytest.mark.parametrize(("command", "name"), [("paper", "glielmo2014"), ("rough", "gunkelmann2014")])
def test_papers_hand_over_their_options(
    command: str, name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The command adds nothing to `redraw` but the report of errors."""
    module = importlib.import_module(f"restitution.papers.{name}")

    given: list[Any] = []

    def redraw(
        out: Path, impacts: int, seed: int, threads: int | None, progress: bool, *, overwrite: bool
    ) -> Path:
        given.extend([out, impacts, seed, threads, progress, overwrite])
        if impacts < 400_000:
            raise ValueError(f"impacts = {impacts}: must be at least 400000")
        return out / "report.html"

    monkeypatch.setattr(module, "redraw", redraw, raising=False)
    result = invoke(command, "--out", tmp_path, "--impacts", 500_000, "--seed", 7, "--threads", 2)
    assert (result.exit_code, result.stdout) == (0, f"{tmp_path / 'report.html'}\n")
    assert given == [tmp_path, 500_000, 7, 2, False, False]
    result = invoke(command, "--out", tmp_path, "--impacts", 3)
    assert (result.exit_code, result.stderr) == (BAD_INPUT, "error: impacts = 3: must be at least 400000\n")


def test_the_summary_says_where_the_plane_pulled(tmp_path: Path) -> None:
    path = tmp_path / "run.toml"
    path.write_text(
        '[body]\nshape = "dumbbell"\nradius = 3e-3\nseparation = 6e-3\n'
        '[law]\ntype = "tangential-restitution"\nnormal = 0.5\ntangential = -0.5\n'
        "[run]\nparticles = 500\nimpacts = 50\nspin = [0.0, 30.0, 0.0]\n",
        encoding="utf-8",
    )
    result = invoke("simulate", path, "--out", tmp_path / "run.nc")
    pulls = load(tmp_path / "run.nc").attrs["pulling_impacts"]
    assert (
        result.stdout.splitlines()[-1].replace("impact ", "impacts ")
        == f"{pulls} impacts let the plane pull."
    )
