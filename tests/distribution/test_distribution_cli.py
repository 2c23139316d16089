"""`restitution distribution`: the results of the call, files whole or not at all, the accuracy told."""

import warnings
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.command import invoke
from restitution.cli import BAD_INPUT, FAILED, WARNED
from restitution.distribution import image

RUN = """
[body]
shape = "dumbbell"
radius = 3e-3
separation = 3e-3

[law]
type = "tangential-restitution"
normal = 0.9

[run]
particles = 3000
impacts = 50
seed = 3
"""


@pytest.fixture
def run(tmp_path: Path) -> Path:
    path = tmp_path / "run.toml"
    path.write_text(RUN, encoding="utf-8")
    return path


def learned() -> rs.FluctuatingRestitution:
    """The same as a call."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    how: dict[str, Any] = {"particles": 3000, "impacts": 50, "seed": 3}
    return rs.FluctuatingRestitution.learn(body, law, **how, velocities=(0.1, 0.5), given="previous")


def test_files_give_what_the_call_gives(run: Path) -> None:
    """The distribution to the bit; the sources and the figure that the methods write, to the byte."""
    names = {"out": "dist.nc", "header": "dist.h", "fortran": "dist.f90", "figure": "dist.png"}
    paths = {option: run.with_name(name) for option, name in names.items()}
    options = [word for option, path in paths.items() for word in (f"--{option}", path)]
    chosen = ["--velocities", 0.1, 0.5, "--given", "previous"]
    result = invoke("distribution", run, *options, *chosen)
    assert (result.exit_code, result.stderr) == (0, "")
    expected = learned()
    xr.testing.assert_identical(rs.FluctuatingRestitution.load(paths["out"]).data, expected.data)
    again = run.with_name("again")
    for write, option in ((expected.to_c, "header"), (expected.to_fortran, "fortran")):
        write(again, replace=True)
        assert again.read_bytes() == paths[option].read_bytes()
    again = run.with_name("again.png")
    expected.figure().savefig(again, dpi=300)
    assert again.read_bytes() == paths["figure"].read_bytes()
    assert paths["figure"].read_bytes().startswith(b"\x89PNG")
    assert result.stdout.splitlines() == expected.summary().splitlines()
    worst = float(expected.data.ks_distance.max())
    assert f"at most {worst:.4f} from fresh impacts" in result.stdout


def test_a_file_may_list_heights_of_release(run: Path) -> None:
    """As `learn` takes them: in equal parts from each."""
    heights = [0.05, 0.055, 0.06]
    run.write_text(f"{RUN}\n[distribution]\nrelease_height = {heights}\nvelocities = [0.2, 0.5]\n")
    out = run.with_name("dist.nc")
    result = invoke("distribution", run, "--out", out, "--quiet")
    assert result.exit_code in (0, WARNED), result.stderr
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    how: dict[str, Any] = {"particles": 3000, "impacts": 50, "seed": 3, "velocities": (0.2, 0.5)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rs.DistanceWarning)
        called = rs.FluctuatingRestitution.learn(body, law, **how, release_height=heights)
    xr.testing.assert_identical(rs.FluctuatingRestitution.load(out).data, called.data)
    run.write_text(f"{RUN}\n[distribution]\nrelease_height = [0.05, -1]\n")
    refused = invoke("distribution", run, "--out", out, "--overwrite")
    assert (refused.exit_code, "release_height" in refused.stderr) == (BAD_INPUT, True)


def test_nothing_is_replaced_unasked_and_nothing_begun_in_vain(run: Path, tmp_path: Path) -> None:
    out, header = run.with_name("dist.nc"), run.with_name("dist.h")
    header.write_text("mine", encoding="utf-8")
    result = invoke("distribution", run, "--out", out, "--header", header)
    assert result.exit_code == FAILED
    assert result.stderr == f"error: {header}: exists already; --overwrite replaces it\n"
    result = invoke("distribution", run, "--out", out, "--given", "spin")
    assert result.exit_code == BAD_INPUT
    assert "given = 'spin': must be 'rotational_fraction' or 'previous'" in result.stderr
    result = invoke("distribution", run, "--out", out, "--velocities", 3.0, 4.0)
    assert result.exit_code == BAD_INPUT
    assert result.stderr.startswith("error: velocities: 0 impacts between 3 and")
    result = invoke("distribution", run, "--out", out, "--figure", tmp_path / "dist.tiff")
    assert result.exit_code == BAD_INPUT
    assert "figure = 'dist.tiff': must be a name that ends in .png, .pdf, .svg" in result.stderr
    assert header.read_text(encoding="utf-8") == "mine"
    assert not out.exists()
    result = invoke("distribution", run, "--out", out, "--header", header, "--overwrite")
    assert result.exit_code == 0
    assert header.read_text(encoding="utf-8") != "mine"


def test_the_figure_is_for_counts_too(tmp_path: Path) -> None:
    """Without particles there are no bands and no fresh impacts, but a figure there is."""
    counts = rs.statistics(
        rs.Dumbbell(radius=3e-3, separation=3e-3),
        rs.TangentialRestitution(normal=0.9),
        particles=200,
        velocity_bins=np.linspace(0.1, 0.5, 9),
        restitution_bins=np.linspace(-1.0, 3.0, 401),
    )
    dist = rs.FluctuatingRestitution.from_statistics(counts)
    with mpl.rc_context({"text.usetex": True}):  # as a user's settings may ask for: there is no LaTeX here
        assert image(dist, "png").startswith(b"\x89PNG")
    dist.figure().savefig(tmp_path / "dist.pdf")
    assert (tmp_path / "dist.pdf").read_bytes().startswith(b"%PDF")
