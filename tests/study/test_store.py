"""The store of a study, by itself: what is written, and what is read back."""

import inspect
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import xarray as xr
import zarr

import restitution as rs
from reference.studies import TINY
from restitution.study import Refused, _store, merge, status, study_of, sweep
from restitution.study._axes import Design
from restitution.study._store import Store, create_or_open, need_zarr, unit_at
from restitution.study._study import Study

WORDS = 5
AXES = ("separation", "normal")
PAPER = "A. Glielmo, N. Gunkelmann, T. Pöschel, Phys. Rev. E 90, 052204 (2014)"


pytestmark = pytest.mark.usefixtures("small_tasks")


@pytest.fixture
def store(tiny: Study, tmp_path: Path) -> Store:
    return create_or_open(tmp_path / "new.zarr", tiny, WORDS)


def rows(number: int = 2) -> Any:
    return np.arange(number * WORDS, dtype=np.uint64).reshape(number, WORDS)


def test_a_new_store(tiny: Study, tmp_path: Path) -> None:
    """Its axes, with their units; no point is finished, no task is there, and no draft beside it."""
    path = tmp_path / "a" / "b" / "new.zarr"
    with zarr.config.set({"default_zarr_format": 2}):
        made = create_or_open(path, tiny, WORDS)
    assert (made.path, made.task_batches) == (path, 2)
    assert made.group.metadata.zarr_format == 3
    assert [file.name for file in path.parent.iterdir()] == ["new.zarr"]
    (tmp_path / "fresh").mkdir()
    assert path.stat().st_mode == (tmp_path / "fresh").stat().st_mode
    found = xr.open_zarr(path, chunks=None)
    assert found["separation"].values.tolist() == [1e-4, 2e-3]
    assert found["separation"].attrs == {"long_name": "body.separation", "units": "m"}
    assert found["normal"].attrs == {"long_name": "law.normal", "units": "1"}
    assert (found["status"].dims, found["status"].shape) == (("separation", "normal"), (2, 3))
    assert not found["status"].any()
    assert found["status"].attrs["flag_meanings"] == "unfinished finished"
    assert found["status"].attrs["flag_values"] == [0, 1]
    assert found.attrs["source"] == f"restitution {rs.__version__}"
    assert found.attrs["Conventions"] == "CF-1.11"
    assert found.attrs["title"].startswith("Parameter study")
    assert found.attrs["references"] == PAPER
    assert made.words.shape == (6, 4, WORDS)
    assert made.words.chunks == (1, 2, WORDS)
    assert made.words.dtype == np.uint64
    assert made.number_there() == 0
    assert made.words.metadata.dimension_names == ("point", "batch", "word")
    assert all(array.attrs["long_name"] for _, array in made.group.arrays())
    units = {"run.release_height": "m", "run.gravity": "m s-2", "run.seed": "1", "body.density": "kg m-3"}
    units |= {"run.spin.1": "rad s-1", "run.release_velocity.0": "m s-1"}
    assert {parameter: unit_at(tiny, parameter) for parameter in units} == units
    made.write(0, 0, rows())
    again = create_or_open(path, tiny, WORDS)
    assert (again.path, again.number_there()) == (path, 1)
    with pytest.raises(Refused, match=rf"^{re.escape(str(path))}: is damaged \(ValueError: tasks/words is "):
        create_or_open(path, tiny, WORDS + 1)


def test_what_zarr_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    """The library, in its version."""
    for version in ("2.18.3", "3.0.8", "3.1.2", "3.1.2.post1"):
        monkeypatch.setattr(zarr, "__version__", version)
        told = rf"^parameter studies need zarr 3\.1\.3, not zarr {re.escape(version)}: pip install"
        with pytest.raises(ImportError, match=told):
            need_zarr()
    monkeypatch.setitem(sys.modules, "zarr", None)
    for action in (lambda: status("store"), lambda: merge("store", ["store"]), lambda: sweep(TINY, "store")):
        with pytest.raises(ImportError, match=r"^parameter studies need zarr: pip install 'restitution\[sw"):
            action()


def test_python_without_assertions() -> None:
    """In one of which Zarr reads the metadata of a group."""
    code = "import sys, types; sys.modules['zarr'] = types.SimpleNamespace(__version__='3.1.3')\n"
    code += f"import re\n{inspect.getsource(need_zarr)}\nneed_zarr()"
    done = subprocess.run([sys.executable, "-O", "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "\nRuntimeError: parameter studies: zarr does not work under python -O or PYTHON" in done.stderr


def test_a_store_that_appears_meanwhile(
    done: Path, tiny: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As that of another driver: it is taken, and no draft is left."""
    rename, path = os.rename, tmp_path / "new.zarr"

    def late(source: Path, target: Path) -> None:
        shutil.copytree(done, path)
        rename(source, target)

    monkeypatch.setattr(os, "rename", late)
    store = create_or_open(path, tiny, Store(done).words.shape[2])
    assert store.there(0) == {0, 1}
    assert [file.name for file in tmp_path.iterdir()] == ["new.zarr"]


@pytest.mark.parametrize("step", ["_fill", "os.rename"])
def test_a_store_that_cannot_be_made(
    step: str, tiny: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Is named, and nothing is left of it."""

    def refuse(*_: object) -> None:
        raise OSError(28, "No space left on device", "draft")

    monkeypatch.setattr(f"restitution.study._store.{step}", refuse)
    with pytest.raises(OSError, match="No space left") as raised:
        create_or_open(tmp_path / "new.zarr", tiny, WORDS)
    assert (raised.value.errno, raised.value.filename) == (28, str(tmp_path / "new.zarr"))
    assert not list(tmp_path.iterdir())


def test_rows_come_back(store: Store) -> None:
    assert store.there(1) == set()
    store.write(1, 2, rows())
    assert store.there(1) == {1}
    found = store.read(1, 2, 2)
    assert np.array_equal(found, rows())
    assert found.dtype == np.uint64
    store.write(1, 0, np.zeros((2, WORDS), np.uint64))
    assert store.there(1) == {0, 1}, "zeros are counted as well as anything"
    assert np.array_equal(store.read(1, 0, 4), np.concatenate([np.zeros((2, WORDS)), rows()]))


def test_what_is_no_store(tmp_path: Path) -> None:
    """An empty folder stays one; a store of Zarr's other format is none of a study's."""
    (empty := tmp_path / "empty").mkdir()
    with pytest.raises(Refused, match=f"^{re.escape(str(empty))}: is damaged"):
        Store(empty)
    assert not list(empty.iterdir())
    group = zarr.open_group(old := tmp_path / "old", mode="w", zarr_format=2)
    group.create_array("tasks/words", shape=(1, 2, 9), chunks=(1, 2, 9), dtype=np.uint64)
    with pytest.raises(Refused, match=f"^{re.escape(str(old))}: is damaged"):
        Store(old)


def test_what_is_there_may_not_be_readable(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is not called damaged, or it would be deleted."""

    class Forbidden:
        shape = (1, 1, 1)

        def __getitem__(self, _: object) -> None:
            raise PermissionError(13, "Permission denied", "chunk")

    store.write(0, 0, rows())
    monkeypatch.setattr(store, "words", Forbidden())
    with pytest.raises(PermissionError):
        store.read(0, 0, 2)


@pytest.mark.parametrize("chunk", [b"", b"\0" * 40, None])
def test_a_chunk_that_cannot_be_read_is_named(store: Store, chunk: bytes | None) -> None:
    """Others of the point can be read, and one that is not there is no row of zeros."""
    for first in (0, 2):
        store.write(2, first, rows())
    file = store.path / "tasks" / "words" / "c" / "2" / "0" / "0"
    if chunk is None:
        file.unlink()
    else:
        file.write_bytes(chunk)
    with pytest.raises(OSError, match="No such file" if chunk is None else "is damaged; delete it") as raised:
        store.read(2, 0, 4)
    assert raised.value.filename == str(file)
    assert np.array_equal(store.read(2, 2, 2), rows())


def found_at_a_point() -> xr.Dataset:
    return xr.Dataset(
        {
            "mean": (("velocity",), [0.5, 0.6], {"units": "1", "flag_values": np.array([1, 2])}),
            "count": (("velocity",), np.array([3, 4])),
            "grid": (("velocity", "cell"), np.arange(2.0 * 2048).reshape(2, 2048)),
            "velocity_edges": (("velocity_edge",), [0.0, 1.0, 2.0], {"units": "m s-1"}),
            "wide_edges": (("velocity",), [1.0, 2.0]),
            "cells": (("cell",), np.zeros(2048)),
            "nothing": (("none", "one"), np.zeros((0, 1))),
        },
        {"velocity": (("velocity",), [0.5, 1.5], {"units": "m s-1"})},
    )


def test_results_have_a_place_for_every_point(store: Store, tiny: Study) -> None:
    """Large ones a chunk each; what all points share stands once."""
    found = found_at_a_point()
    assert _store.large(found) == ["grid"]
    assert _store.small(found) == ["cells", "count", "mean", "nothing", "wide_edges"]
    store.ensure(found.drop_vars("count"), tiny.design)
    for _ in range(2):
        store.ensure(found, tiny.design)
        assert "count" in store.group
    store.ensure(found.assign(later=("velocity", [1.0, 2.0])), tiny.design)
    assert store.group["later"].shape == (2, 3, 2)
    del store.group["later"]
    assert store.group["nothing"].chunks == (2, 3, 1, 1)
    mean, count, grid = (store.group[name] for name in ("mean", "count", "grid"))
    assert (mean.shape, mean.chunks) == ((2, 3, 2), (2, 3, 2))
    assert mean.metadata.dimension_names == ("separation", "normal", "velocity")
    assert dict(mean.attrs) == {"units": "1", "flag_values": [1, 2]}
    assert np.isnan(mean[...]).all()
    assert count[...].tolist() == [[[0, 0]] * 3] * 2
    assert (grid.shape, grid.chunks) == ((2, 3, 2, 2048), (1, 1, 2, 2048))
    assert store.group["velocity_edges"][...].tolist() == [0.0, 1.0, 2.0]
    assert store.group["velocity"].metadata.dimension_names == ("velocity",)
    assert dict(store.group["velocity"].attrs) == {"units": "m s-1"}
    store.write_large(found, (1, 2))
    assert np.array_equal(grid[1, 2], found["grid"].to_numpy())
    assert store.read_small(tiny.design).keys() == {*_store.small(found), "status"}
    store.consolidate()
    assert set(xr.open_zarr(store.path, chunks=None).variables) == {*found.variables, *AXES, "status"}


def test_results_of_another_kind_have_no_place(store: Store, tiny: Study) -> None:
    """Numbers of less precision have; others would be cut, and the store is called damaged."""
    shape = (*tiny.design.shape, 2)
    store.group.create_array("mean", shape=shape, dtype=np.float32)
    store.ensure(found_at_a_point(), tiny.design)
    store.group.create_array("other", shape=shape, dtype=np.int16)
    with pytest.raises(Refused, match=r"new\.zarr: is damaged .*other is int16 of shape .* instead of f"):
        store.ensure(found_at_a_point().rename(mean="other"), tiny.design)


def test_what_all_points_share_is_restored(store: Store, tiny: Study) -> None:
    """Where it is not what it should be, by whoever opens the store anew; else it is left alone."""
    found = found_at_a_point()
    store.ensure(found, tiny.design)
    store.group["status"][...] = 1
    store.group["velocity_edges"][0] = -1.0
    for file in ("status/c/0/0", "normal/c/0", "separation/c/0"):
        (store.path / file).unlink()
    assert not store.group["status"][...].any(), "a chunk that vanished leaves points unfinished"
    before = (store.path / "velocity" / "c" / "0").stat().st_mtime_ns
    Store(store.path).ensure(found, tiny.design)
    assert store.group["velocity_edges"][...].tolist() == [0.0, 1.0, 2.0]
    assert store.group["separation"][...].tolist() == [1e-4, 2e-3]
    assert store.group["normal"][...].tolist() == [0.9, 0.95, 0.98]
    assert (store.path / "velocity" / "c" / "0").stat().st_mtime_ns == before


def test_chunks_hold_many_points_up_to_four_megabytes(tiny: Study) -> None:
    variable = xr.Variable(("velocity",), np.zeros(4000))
    assert _store.chunks(tiny.design, variable) == (2, 3, 4000)
    wide = study_of(TINY | {"sweep": {"law.normal": {"from": 0.1, "to": 0.9, "points": 300}}}).design
    assert _store.chunks(wide, variable) == (125, 4000)
    tall = {"body.separation": [1e-4, 2e-3], "law.normal": {"from": 0.1, "to": 0.9, "points": 100}}
    assert _store.chunks(study_of(TINY | {"sweep": tall}).design, variable) == (1, 100, 4000)
    found = _store.chunks(wide, xr.Variable(("velocity",), np.zeros(3000)))
    assert found == (166, 3000)
    assert all(isinstance(size, int) for size in found)
    assert _store.chunks(wide, xr.Variable(("cell",), np.zeros(4096))) == (1, 4096)
    many = cast(Design, SimpleNamespace(shape=(3_000_000,)))
    assert _store.chunks(many, xr.Variable((), np.int8(1))) == (3_000_000,)
