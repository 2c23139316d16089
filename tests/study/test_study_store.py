"""The store of a study, by itself: what is written, and what is read back."""

import hashlib
import re
import shutil
import struct
from functools import partial
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
import xarray as xr
import zarr

import restitution as rs
from reference.studies import TINY
from restitution.study import Refused, _create, _store, study_of, sweep
from restitution.study._axes import Design
from restitution.study._create import create_or_open
from restitution.study._store import Store
from restitution.study._study import Study

WORDS = 5
AXES = ("separation", "normal")
PAPER = "A. Glielmo, N. Gunkelmann, T. Pöschel, Phys. Rev. E 90, 052204 (2014)"


pytestmark = pytest.mark.usefixtures("small_tasks")


@pytest.fixture
def store(tiny: Study, tmp_path: Path) -> Store:
    return create_or_open(tmp_path / "new.zarr", tiny, WORDS)[0]


def rows(number: int = 2) -> Any:
    return np.arange(number * WORDS, dtype=np.uint64).reshape(number, WORDS)


def test_a_new_store(tiny: Study, tmp_path: Path) -> None:
    """Its axes, with their units; no point is finished, no task is there, and no draft beside it."""
    path = tmp_path / "a" / "b" / "new.zarr"
    made, existed = create_or_open(path, tiny, WORDS)
    assert (existed, made.path, made.study, made.task_batches) == (False, path, tiny.digest, 2)
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
    assert made.words.shape == (6, 4, WORDS + 4)
    assert made.words.chunks == (1, 2, WORDS + 4)
    assert made.words.dtype == np.uint64
    assert made.points_there() == []
    assert made.words.metadata.dimension_names == ("point", "batch", "word")
    assert all(array.attrs["long_name"] for array in (made.words, *(array for _, array in made.arrays())))
    again, existed = create_or_open(path, tiny, WORDS)
    assert (existed, again.path) == (True, path)


def test_the_format_of_a_store_is_not_that_of_the_settings(tiny: Study, tmp_path: Path) -> None:
    with zarr.config.set({"default_zarr_format": 2}):
        create_or_open(tmp_path / "new.zarr", tiny, WORDS)
    assert zarr.open_group(tmp_path / "new.zarr", mode="r").metadata.zarr_format == 3


def test_a_design_without_a_grid(tmp_path: Path) -> None:
    """Its parameters are coordinates of the points."""
    axes = {"body.separation": {"from": 1e-4, "to": 1e-3}, "law.normal": {"from": 0.8, "to": 0.9}}
    found = sweep(
        TINY | {"sweep": axes | {"design": "sobol", "points": 2}}, tmp_path / "points.zarr", threads=1
    )
    assert found["separation"].dims == found["normal"].dims == ("point",)
    assert found["mean_restitution"].dims == ("point", "velocity")
    assert {"separation", "normal"} <= set(found["mean_restitution"].coords)


def test_rows_come_back_with_their_digests(store: Store) -> None:
    assert store.there(1) == set()
    store.write(1, 2, rows())
    assert store.there(1) == {1}
    assert store.valid(1, 0, 4).tolist() == [False, False, True, True]
    found, good, digests = store.read(1, 2, 2)
    assert np.array_equal(found, rows())
    assert found.dtype == np.uint64
    assert good.dtype == np.bool_
    assert good.all()
    assert len(digests) == 2 * 32
    assert digests[:32] != digests[32:]
    store.write(1, 0, rows())
    assert store.there(1) == {0, 1}
    assert store.valid(1, 0, 4).all()
    assert not store.valid(0, 0, 4).any()
    assert store.read(1, 0, 2)[2] != digests, "the same words of another batch have another digest"


def test_a_digest_is_that_of_the_study_the_place_and_the_words(store: Store) -> None:
    """As the format says, so that stores of before can be read: BLAKE2b of 32 bytes, numbers in 8 of them."""
    store.write(3, 2, rows())
    for i, row in enumerate(rows()):
        place = struct.pack("<QQ", 3, 2 + i)
        digest = hashlib.blake2b(store.study + place + row.tobytes(), digest_size=32).digest()
        assert store.words[3, 2 + i].tobytes() == row.tobytes() + digest


def test_what_is_there(store: Store) -> None:
    """Points of the study that have a chunk; folders of others are passed over."""
    for point in (0, 5):
        store.write(point, 0, rows())
    words = store.path / "tasks" / "words" / "c"
    for name in ("6", "-1", "x", ".nfs01"):
        (words / name).mkdir()
    assert sorted(store.points_there()) == [0, 5]


def test_why_a_chunk_is_not_taken(store: Store) -> None:
    for point in (1, 2):
        store.write(point, 2, rows())
    file = store.path / "tasks" / "words" / "c" / "1" / "1" / "0"
    file.write_bytes((words := file.parents[2] / "2" / "1" / "0").read_bytes())
    assert store.fault(1, 1) == (file, "its digest is not that of the numbers in it")
    words.write_bytes(b"cut")
    named, told = store.fault(2, 1)
    assert named == words
    assert re.match(r"\w+: .", told)
    assert "None" not in told
    assert store.fault(1, 0) == (file.parents[1] / "0" / "0", "there is no such file")


def test_rows_of_many_tasks(tmp_path: Path) -> None:
    """Each stands at its place, from wherever they are read."""
    study = study_of(TINY | {"effort": {"batches": 8}})
    store = create_or_open(tmp_path / "new.zarr", study, WORDS)[0]
    whole = rows(8)
    for first in (0, 4, 6):
        store.write(0, first, whole[first : first + 2])
    found, good, _ = store.read(0, 2, 6)
    assert good.tolist() == [False, False, True, True, True, True]
    assert np.array_equal(found[2:], whole[4:])
    assert store.valid(0, 0, 8).tolist() == [True, True, False, False, True, True, True, True]


def test_what_is_no_store(tmp_path: Path) -> None:
    """An empty folder stays one; a store of Zarr's other format is none of a study's."""
    (empty := tmp_path / "empty").mkdir()
    with pytest.raises(Refused, match=f"^{re.escape(str(empty))}: is damaged"):
        Store(empty, b"")
    assert not list(empty.iterdir())
    group = zarr.open_group(old := tmp_path / "old", mode="w", zarr_format=2)
    group.create_array("tasks/words", shape=(1, 2, 9), chunks=(1, 2, 9), dtype=np.uint64)
    with pytest.raises(Refused, match=f"^{re.escape(str(old))}: is damaged"):
        Store(old, b"")


@pytest.mark.parametrize("chunk", [b"", b"\0" * 40, None])
def test_a_chunk_that_cannot_be_read_is_damaged(store: Store, chunk: bytes | None) -> None:
    """Others of the point are not; and the digest is that of the study, the point and the batch."""
    for first in (0, 2):
        store.write(2, first, rows())
    file = store.path / "tasks" / "words" / "c" / "2" / "0" / "0"
    if chunk is None:
        file.unlink()
    else:
        file.write_bytes(chunk)
    assert store.valid(2, 0, 4).tolist() == [False, False, True, True]
    other = Store(store.path, b"another study")
    assert not other.valid(2, 0, 4).any()


def test_what_is_no_task_is_passed_over(store: Store) -> None:
    """Folders that Zarr or a file system puts there."""
    store.write(0, 0, rows())
    (store.path / "tasks" / "words" / "c" / "0" / ".nfs01").mkdir()
    assert store.there(0) == {0}


@pytest.mark.parametrize("method", ["words", "results", "large"])
def test_what_may_not_be_read_is_not_taken_as_damaged(
    store: Store, method: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else it would be computed again, and overwritten."""

    class Forbidden:
        shape = (1, 1, 1)

        def __getitem__(self, _: object) -> None:
            raise PermissionError(13, "Permission denied", "chunk")

    if method == "words":
        monkeypatch.setattr(store, "words", Forbidden())
        with pytest.raises(PermissionError):
            store.read(0, 0, 2)
        return
    monkeypatch.setattr(store, "group", {"large": Forbidden(), "separation": Forbidden()})
    design = study_of(TINY).design
    read = (
        partial(store.read_large, ["large"], (0,))
        if method == "large"
        else partial(store.restore, xr.Dataset(), design)
    )
    with pytest.raises(PermissionError):
        read()


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
    assert _store.common(found) == ["velocity_edges"]
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
    again = store.read_large(["grid"], (1, 2))
    assert again is not None
    assert np.array_equal(again["grid"], found["grid"].to_numpy())
    assert store.read_large(["none"], (1, 2)) is None
    assert store.large_arrays(tiny.design) == ["grid"]
    assert [name for name, _ in store.arrays()] == sorted({*map(str, found.variables), *AXES, "status"})
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


def test_a_worker_that_was_faster(store: Store, tiny: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    """Has made the array that another is about to make."""
    found = found_at_a_point()[["mean"]]
    Store(store.path, store.study).ensure(found, tiny.design)
    monkeypatch.setattr(type(store.group), "__contains__", lambda *_: False)
    store.ensure(found, tiny.design)
    monkeypatch.undo()
    assert store.group["mean"].shape == (2, 3, 2)


def test_a_worker_that_makes_the_same_array(
    store: Store, tiny: Study, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At the same time, so that Zarr finds its files, is no error."""

    def there(*_: object, **__: object) -> None:
        raise FileExistsError(17, "File exists", "zarr.json")

    monkeypatch.setattr(type(store.group), "create_array", there)
    store.ensure(found_at_a_point()[["mean"]], tiny.design)


def test_what_is_lost_is_not_taken_for_a_result(store: Store, tiny: Study) -> None:
    """A chunk that vanished leaves points unfinished, and axes without values until they are restored."""
    store.group["status"][...] = 1
    for file in ("status/c/0/0", "separation/c/0"):
        (store.path / file).unlink()
    assert not store.group["status"][...].any()
    assert np.isnan(store.group["separation"][...]).all()
    store.restore(xr.Dataset(), tiny.design)
    assert store.group["separation"][...].tolist() == [1e-4, 2e-3]
    shutil.rmtree(store.path / "separation")
    with pytest.raises(Refused, match="KeyError: 'separation'"):
        store.restore(xr.Dataset(), tiny.design)


@pytest.mark.parametrize(
    ("parameter", "unit"),
    [
        ("run.release_height", "m"),
        ("run.gravity", "m s-2"),
        ("run.incline", "rad"),
        ("run.minimum_speed", "m s-1"),
        ("run.seed", "1"),
        ("body.density", "kg m-3"),
        ("law.normal", "1"),
    ],
)
def test_axes_have_units(parameter: str, unit: str, tiny: Study) -> None:
    assert _create._unit(tiny, parameter) == unit


def test_what_all_points_share_is_restored(store: Store, tiny: Study) -> None:
    """Where it is not what it should be, and is left alone where it is."""
    found = found_at_a_point()
    store.ensure(found, tiny.design)
    store.group["velocity_edges"][0] = -1.0
    (store.path / "separation" / "c" / "0").write_bytes(b"spoilt")
    before = (store.path / "velocity" / "c" / "0").stat().st_mtime_ns
    store.restore(found, tiny.design)
    assert store.group["velocity_edges"][...].tolist() == [0.0, 1.0, 2.0]
    assert store.group["separation"][...].tolist() == [1e-4, 2e-3]
    assert (store.path / "velocity" / "c" / "0").stat().st_mtime_ns == before


def test_chunks_hold_many_points_up_to_four_megabytes(tiny: Study) -> None:
    variable = xr.Variable(("velocity",), np.zeros(4000))
    assert _store._chunks(tiny.design, variable) == (2, 3, 4000)
    wide = study_of(TINY | {"sweep": {"law.normal": {"from": 0.1, "to": 0.9, "points": 300}}}).design
    assert _store._chunks(wide, variable) == (125, 4000)
    tall = {"body.separation": [1e-4, 2e-3], "law.normal": {"from": 0.1, "to": 0.9, "points": 100}}
    assert _store._chunks(study_of(TINY | {"sweep": tall}).design, variable) == (1, 100, 4000)
    found = _store._chunks(wide, xr.Variable(("velocity",), np.zeros(3000)))
    assert found == (166, 3000)
    assert all(isinstance(size, int) for size in found)
    assert _store._chunks(wide, xr.Variable(("cell",), np.zeros(4096))) == (1, 4096)
    many = cast(Design, SimpleNamespace(shape=(3_000_000,)))
    assert _store._chunks(many, xr.Variable((), np.int8(1))) == (3_000_000,)
