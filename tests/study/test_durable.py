"""Whatever happens to a study, the same command continues, and ends with the bits of an undisturbed one."""

import errno
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zarr

from reference.command import Command
from reference.studies import bits, chunks, when, written
from restitution.study import status, sweep

if sys.platform == "win32":
    pytest.skip("signals and limits of POSIX", allow_module_level=True)

import resource

# Each batch takes 20 ms longer, so that there is a middle of the study to strike in.
SLOWLY = """
import time
import restitution.study._drive as work
count = work.count
def slow_count(*arguments):
    time.sleep(0.02)
    return count(*arguments)
work.count = slow_count
"""


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The store of the study of 12 points, to be left as it is."""
    folder = tmp_path_factory.mktemp("undisturbed")
    sweep(written(folder, normals=4), folder / "study.zarr")
    assert status(folder / "study.zarr").finished == 12
    return folder / "study.zarr"


@pytest.fixture(scope="module")
def whole(undisturbed: Path) -> dict[str, str]:
    return bits(undisturbed)


def has_chunks(store: Path, number: int) -> bool:
    return len(chunks(store)) >= number


# The clock on the wall jumps back and forth by years at every look.
JUMPS = """
import itertools, time
jumps = itertools.cycle((0.0, 1e9, -1e9, 5e8))
wall = time.time
time.time = lambda: wall() + next(jumps)
time.time_ns = lambda: int(1e9 * time.time())
"""


def test_killed_drivers(whole: dict[str, str], tmp_path: Path) -> None:
    """Two are killed, one after the other, and their work is not done again, whatever the clocks show."""
    study, store = written(tmp_path, normals=4), tmp_path / "study.zarr"
    for target, code in ((3, SLOWLY), (7, SLOWLY + JUMPS)):
        process = Command("sweep", study, "--out", store, before=partial(exec, code, {}))
        when(partial(has_chunks, store, target), process)
        process.send_signal(signal.SIGKILL)
        process.finished()
        for i, path in enumerate(chunks(store)):
            at = (0, 4_000_000_000)[i % 2]
            os.utime(path, (at, at))
    there = {path: path.stat().st_mtime_ns for path in chunks(store)}
    assert 7 <= len(there) < 12
    sweep(study, store)
    assert {path: path.stat().st_mtime_ns for path in there} == there
    assert bits(store) == whole


def test_ctrl_c_leaves_a_store_that_can_be_read(whole: dict[str, str], tmp_path: Path) -> None:
    import xarray as xr

    study, store = written(tmp_path, normals=4), tmp_path / "study.zarr"
    process = Command("sweep", study, "--out", store, before=partial(exec, SLOWLY, {}))
    when(lambda: len(chunks(store)) >= 9, process)
    process.send_signal(signal.SIGINT)
    code, _, error = process.finished(60.0)
    assert code == 130, error
    assert "The same command continues" in error
    found = xr.open_zarr(store, chunks=None)
    done = int((found["status"] == 1).sum())
    assert 1 <= done < 12
    assert bool(found["mean_restitution"].where(found["status"] == 1).notnull().any())
    sweep(study, store)
    assert bits(store) == whole


def flip(data: bytes) -> bytes:
    at = 2 * len(data) // 3
    return data[:at] + bytes([data[at] ^ 4]) + data[at + 1 :]


HARMS: dict[str, Callable[[Path], object]] = {
    "cut": lambda path: path.write_bytes(path.read_bytes()[: path.stat().st_size // 2]),
    "a flipped bit": lambda path: path.write_bytes(flip(path.read_bytes())),
    "empty": lambda path: path.write_bytes(b""),
    "vanished": Path.unlink,
}


def resumed(study: Path, store: Path) -> list[Path]:
    """Go on with a study, and delete what it says is damaged, as long as it says so."""
    deleted: list[Path] = []
    while True:
        try:
            sweep(study, store)
            return deleted
        except OSError as error:
            if (error.errno, error.strerror) != (errno.EIO, DAMAGED):
                raise
            deleted.append(Path(error.filename))
            shutil.rmtree(deleted[-1]) if deleted[-1].is_dir() else deleted[-1].unlink()


DAMAGED = "is damaged; delete it, and the same command continues"


@pytest.mark.parametrize("harm", HARMS)
def test_damaged_chunks(undisturbed: Path, whole: dict[str, str], tmp_path: Path, harm: str) -> None:
    """Of the tasks and of every array: each is named, and deleted; of the tasks only these are done again."""
    study, store = written(tmp_path, normals=4), tmp_path / "study.zarr"
    shutil.copytree(undisturbed, store)
    arrays = sorted({path.parent for path in store.rglob("zarr.json")} - {store, store / "tasks"})
    files = [
        sorted(path for path in array.rglob("*") if path.is_file() and path.name != "zarr.json")
        for array in arrays
    ]
    struck = [chunk[0] for chunk in files if chunk]  # of zeros alone no chunk is written
    assert len(struck) > 20
    kept = {path: path.stat().st_mtime_ns for path in chunks(store)}
    for path in struck:
        HARMS[harm](path)
    deleted = resumed(study, store)
    assert len(deleted) == (0 if harm == "vanished" else len(struck))
    assert all(any(path.is_relative_to(one) for one in deleted) for path in struck) or harm == "vanished"
    assert bits(store) == whole
    changed = {path for path, at in kept.items() if path.stat().st_mtime_ns != at}
    assert changed == {path for path in struck if path in kept}


def test_results_that_do_not_belong_together(
    undisturbed: Path, whole: dict[str, str], tmp_path: Path
) -> None:
    """As of two drivers that wrote theirs at a time, one of which was killed: they are worked out again."""
    study, store = written(tmp_path, normals=4), tmp_path / "study.zarr"
    shutil.copytree(undisturbed, store)
    array: Any = zarr.open_group(str(store), mode="r+")["std_restitution"]
    array[1:] = np.nan
    sweep(study, store)
    assert bits(store) == whole


def test_one_recipe_for_all_results(undisturbed: Path, whole: dict[str, str], tmp_path: Path) -> None:
    """Without the marks all results are worked out again, from the tasks as they are."""
    study, store = written(tmp_path, normals=4), tmp_path / "study.zarr"
    shutil.copytree(undisturbed, store)
    kept = {path: path.stat().st_mtime_ns for path in chunks(store)}
    for path in store.glob("*_restitution/c"):
        shutil.rmtree(path)
    shutil.rmtree(store / "status" / "c")
    sweep(study, store)
    assert bits(store) == whole
    assert kept == {path: path.stat().st_mtime_ns for path in chunks(store)}


def limited() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)


def test_files_that_cannot_grow(whole: dict[str, str], tmp_path: Path) -> None:
    """No file may have more than 3000 bytes: tasks fit, results do not. The error names the reason."""
    study, store = written(tmp_path, normals=4), tmp_path / "study.zarr"
    code, _, error = Command("sweep", study, "--out", store, before=limited).finished()
    assert code == 1
    assert "File too large" in error
    assert len(error.splitlines()) <= 2
    if store.exists():
        assert status(store).points == 12
    sweep(study, store)
    assert bits(store) == whole


def test_a_full_disk(whole: dict[str, str], tmp_path: Path) -> None:
    """On a file system of 300 kB, which has more room later."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=300k", "tmpfs", str(disk)]
    if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
        pytest.skip("no right to mount a small file system here; test_files_that_cannot_grow does without")
    try:
        study, store = written(tmp_path, normals=4), disk / "study.zarr"
        code, _, error = Command("sweep", study, "--out", store).finished()
        assert code == 1
        assert error.startswith(f"error: {disk}")
        assert "No space left on device" in error
        assert len(error.splitlines()) <= 2
        assert len(chunks(store)) > 0
        assert status(store).points == 12
        subprocess.run(["mount", "-o", "remount,size=50m", str(disk)], check=True)
        sweep(study, store)
        assert bits(store) == whole
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def test_two_drivers_on_one_store(whole: dict[str, str], tmp_path: Path) -> None:
    """Both end well, and the second spares itself what the first has done."""
    study, store = written(tmp_path, normals=4), tmp_path / "study.zarr"
    words = ("sweep", study, "--out", store, "--threads", 1)
    both = [Command(*words, before=partial(exec, SLOWLY, {})) for _ in range(2)]
    for process in both:
        code, out, error = process.finished()
        assert code == 0, error
        assert "12 of 12 points are finished" in out
    assert bits(store) == whole
