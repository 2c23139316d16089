"""Files that are given by name to functions and commands: other formats, pipes, devices, links, no end."""

import errno
import os
import shutil
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import pytest
import xarray as xr

import restitution as rs
from reference.command import SMALL, invoke
from reference.refused import message
from reference.studies import written
from restitution import figures, flight
from restitution._internal import files as _files
from restitution._internal.datasets import load
from restitution._internal.files import FOLDER, HEADER, IMAGE, MODULE, NETCDF, ZARR, path_for
from restitution.distribution import FluctuatingRestitution
from restitution.study import status, sweep

BINS = """
[statistics]
velocity_bins = 12
velocity_range = [0.0, 1.2]
restitution_bins = 40
restitution_range = [-1.0, 3.0]
"""


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("simulate run.toml --out run.csv", "out = 'run.csv': must be the name of a netCDF file"),
        ("simulate run.toml --out -", "out = '-': must be the name of a netCDF file"),
        ("statistics run.toml --out counts.JSON", "out = 'counts.JSON': must be the name of a netCDF file"),
        ("compare run.toml --out counts.zarr", "out = 'counts.zarr': must be the name of a netCDF file"),
        ("distribution run.toml --out dist.h", "out = 'dist.h': must be the name of a netCDF file"),
        ("distribution run.toml --out a.nc --header a.f90", "header = 'a.f90': must be the name of a header"),
        ("distribution run.toml --out a.nc --fortran a.h", "fortran = 'a.h': must be the name of a Fortran"),
        ("sweep study.toml --out study.nc", "out = 'study.nc': must be the name of a Zarr store"),
        ("sweep merge --out all.csv study.zarr", "out = 'all.csv': must be the name of a Zarr store"),
        ("laws --out laws.pdf", "out = 'laws.pdf': must be the name of a folder"),
        ("paper --out paper.html", "out = 'paper.html': must be the name of a folder"),
    ],
)
def test_a_name_that_promises_another_format(
    words: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Is refused before anything is computed, by an error that says what is written."""
    (tmp_path / "run.toml").write_text(SMALL.replace("= 7\n", "= 1000000\n") + BINS, encoding="utf-8")
    written(tmp_path)
    before = sorted(tmp_path.iterdir())
    monkeypatch.chdir(tmp_path)
    done = invoke(*words.split(), "--quiet")
    assert done.exit_code == 2
    assert done.stderr.startswith(f"error: {told}")
    assert sorted(tmp_path.iterdir()) == before


@pytest.fixture(scope="module")
def learned() -> FluctuatingRestitution:
    return FluctuatingRestitution.learn(
        rs.Dumbbell(radius=3e-3, separation=3e-3),
        rs.TangentialRestitution(normal=0.9),
        particles=2000,
        impacts=40,
        velocities=(0.4, 0.7),
        threads=1,
    )


@pytest.mark.parametrize(
    ("method", "name", "good"),
    [("save", "d.csv", "d"), ("to_c", "d.nc", "d.hpp"), ("to_fortran", "d.f", "d.inc")],
)
def test_methods_that_write(
    learned: FluctuatingRestitution, method: str, name: str, good: str, tmp_path: Path
) -> None:
    with pytest.raises(ValueError, match=rf"path = '.*{name}': must be the name of"):
        getattr(learned, method)(tmp_path / name)
    assert not list(tmp_path.iterdir())
    getattr(learned, method)(tmp_path / good)
    assert [file.name for file in tmp_path.iterdir()] == [good]


def test_a_figure_of_another_format(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"name = '.*map\.jpg': must be the name of a figure"):
        figures.save(plt.figure(), tmp_path / "map.jpg")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("kind", [NETCDF, ZARR, HEADER, MODULE, IMAGE, FOLDER])
@pytest.mark.parametrize("name", ["run", "run_0.5", "L=0.1.v2", ".hidden", "normal0.98", "a b", "ε.ε"])
def test_names_that_promise_nothing(kind: str, name: str) -> None:
    """What follows the last dot may be part of a number."""
    assert path_for("out", name, kind) == Path(name)


@pytest.mark.parametrize(
    ("read", "error"),
    [
        (load, NETCDF),
        (FluctuatingRestitution.load, NETCDF),
        (lambda path: invoke("fit", path, "--velocity", "0.4", "0.8").stderr, None),
        (lambda path: invoke("listen", path, "--diameter", "0.02", "--out", f"{path}.html").stderr, None),
    ],
    ids=["load", "distribution", "fit", "listen"],
)
@pytest.mark.parametrize("kind", ["pipe", "folder"])
def test_what_is_no_file_is_refused_at_once(
    read: Callable[[Path], Any], error: str | None, kind: str, tmp_path: Path
) -> None:
    """A pipe would be waited for in the libraries, where Ctrl-C does not reach."""
    path = tmp_path / "given"
    if kind == "pipe":
        if sys.platform == "win32":
            pytest.skip("there are no named pipes")
        os.mkfifo(path)
    else:
        path.mkdir()
    told = "not a regular file: save it first" if kind == "pipe" else "is a folder"
    if error is None:
        assert read(path) == f"error: {path}: {told}\n"
        return
    with pytest.raises(OSError, match=told) as raised:
        read(path)
    assert raised.value.filename == str(path)


def test_an_error_names_the_file_as_it_was_given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("run.nc").write_bytes(b"none")
    for name, told in (("run.nc", "Unknown file format"), ("none.nc", "No such file")):
        with pytest.raises(OSError, match=told) as raised:
            load(Path(name))
        assert raised.value.filename == name


def test_a_run_may_come_through_a_pipe(tmp_path: Path) -> None:
    """As of `<(...)` of a shell."""
    if sys.platform == "win32":
        pytest.skip("there is no /dev/fd")
    end, start = os.pipe()
    os.write(start, SMALL.encode())
    os.close(start)
    done = invoke("simulate", f"/dev/fd/{end}", "--out", tmp_path / "run.nc", "--quiet")
    os.close(end)
    assert (done.exit_code, done.stderr) == (0, "")
    assert xr.load_dataset(tmp_path / "run.nc").sizes["particle"] == 7


def test_what_has_no_end(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Is not read until the memory is full."""
    if sys.platform == "win32":
        pytest.skip("there is no /dev/zero")
    monkeypatch.setattr(_files, "MOST", 2**20)
    for words in ("simulate /dev/zero --out run.nc", "sweep /dev/zero --out study.zarr"):
        assert invoke(*words.split()).stderr == "error: /dev/zero: longer than 1 MiB\n"
    with pytest.raises(OSError, match="longer than 1 MiB") as raised:
        flight.read("/dev/zero")
    assert raised.value.errno == errno.EFBIG


@pytest.mark.parametrize("name", ["a.csv", "[Content_Types].xml"])
def test_an_archive_that_unpacks_to_more_than_memory_holds(name: str, tmp_path: Path) -> None:
    """300 MB of zeros in 300 kB; phyphox and spreadsheets pack their tables so."""
    with (
        zipfile.ZipFile(tmp_path / "times.zip", "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open(name, "w", force_zip64=True) as part,
    ):
        for _ in range(300):
            part.write(bytes(2**20))
    with pytest.raises(ValueError, match=r"times\.zip: unpacks to more than 256 MiB"):
        flight.read(tmp_path / "times.zip")


def test_a_store_behind_a_link(tmp_path: Path) -> None:
    """Is made where the link leads to, as any file is."""
    study = written(tmp_path)
    (tmp_path / "link.zarr").symlink_to("there.zarr")
    sweep(study, tmp_path / "link.zarr")
    assert (tmp_path / "link.zarr").is_symlink()
    assert status(tmp_path / "there.zarr").finished == 6
    assert {file.name for file in tmp_path.iterdir()} == {
        "study.toml",
        "link.zarr",
        "there.zarr",
    }


@pytest.mark.parametrize("above", [True, False], ids=["a file for a folder", "a file for the store"])
def test_a_store_that_cannot_be_made_names_itself(above: bool, tmp_path: Path) -> None:
    """And not its draft."""
    study, path = written(tmp_path), tmp_path / "above" / "study.zarr"
    if above:
        path.parent.touch()
    else:
        path.parent.mkdir()
        shutil.copy(study, path)
    with pytest.raises((OSError, ValueError)) as raised:
        sweep(study, path)
    assert str(path) in str(raised.value)
    assert ".part" not in str(raised.value)


@pytest.mark.parametrize("name", ["/", "..", "none/.."])
def test_a_figure_without_a_name(name: str) -> None:
    """There is nothing that an ending could be put to."""
    text = message(lambda: figures.save(figures.panels(3.0, 2.0)[0], name))
    assert text.startswith(f"name = {name!r}: must be the name of a figure")
