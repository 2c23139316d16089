"""Making the store of a study: what it takes, and what may come between."""

import os
import re
import shutil
import sys
from pathlib import Path

import pytest
import zarr

from reference.studies import TINY
from restitution.study import Refused, _create, merge, status, sweep
from restitution.study._create import create_or_open
from restitution.study._status import open_store
from restitution.study._store import Store, need_zarr
from restitution.study._study import Study

WORDS = 5
AXES = ("separation", "normal")
PAPER = "A. Glielmo, N. Gunkelmann, T. Pöschel, Phys. Rev. E 90, 052204 (2014)"


pytestmark = pytest.mark.usefixtures("small_tasks")


def test_what_zarr_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    """The library in its version, room, files that may be open, and a thread."""
    need_zarr(Path("store"))
    with monkeypatch.context() as patched:
        patched.setattr(zarr, "__version__", "2.18.3")
        with pytest.raises(
            ImportError, match=r"^parameter studies need zarr 3, here is 2\.18\.3: pip install"
        ):
            need_zarr(Path("store"))
    with monkeypatch.context() as patched:
        patched.setitem(sys.modules, "zarr", None)
        with pytest.raises(
            ImportError, match=r"^parameter studies need zarr: pip install 'restitution\[sweep\]'$"
        ):
            need_zarr(Path("store"))
    with monkeypatch.context() as patched:
        patched.delitem(sys.modules, "zarr")  # what is there has its room
        patched.setattr("restitution._internal.resources.available_memory", lambda: 99_999_999)
        with pytest.raises(MemoryError, match=r"a study: takes 100 MB of memory"):
            need_zarr(Path("store"))

    with monkeypatch.context() as patched:
        opened: list[int] = []

        def three(*_: object) -> int:
            if len(opened) == 3:
                raise OSError(24, "Too many open files", os.devnull)
            opened.append(os.dup(2))
            return opened[-1]

        patched.setattr(os, "open", three)
        with pytest.raises(OSError, match="a study takes 4 open files: Too many open files") as raised:
            need_zarr(Path("store"))
    assert (raised.value.errno, raised.value.filename) == (24, "store")
    for file in opened:
        with pytest.raises(OSError, match="Bad file descriptor"):
            os.fstat(file)

    def none(_: object) -> None:
        raise RuntimeError("can't start new thread")

    monkeypatch.setattr("threading.Thread.start", none)
    for action in (
        lambda: need_zarr(Path("store")),
        lambda: status("store"),
        lambda: open_store(Path("store")),
        lambda: merge("store", ["store"]),
        lambda: sweep(TINY, "store"),
    ):
        with pytest.raises(OSError, match="the system gives no thread") as raised:
            action()
        assert raised.value.filename == "store"


def test_a_store_that_appears_meanwhile(
    done: Path, tiny: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As that of another driver: it is taken, and no draft is left."""
    rename = os.rename
    path = tmp_path / "new.zarr"

    def late(source: Path, target: Path) -> None:
        shutil.copytree(done, path)
        rename(source, target)

    monkeypatch.setattr(os, "rename", late)
    store, existed = create_or_open(path, tiny, Store(done, b"").words.shape[2] - 4)
    assert existed
    assert store.there(0) == {0, 1}
    assert [file.name for file in tmp_path.iterdir()] == ["new.zarr"]


def test_a_store_with_other_arrays_is_named(tiny: Study, tmp_path: Path) -> None:
    create_or_open(path := tmp_path / "new.zarr", tiny, WORDS)
    with pytest.raises(Refused, match=rf"^{re.escape(str(path))}: is damaged \(ValueError: tasks/words is "):
        create_or_open(path, tiny, WORDS + 1)


def test_a_store_that_cannot_take_its_place(
    tiny: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object) -> None:
        raise OSError(28, "No space left on device", "draft")

    monkeypatch.setattr(os, "rename", refuse)
    with pytest.raises(OSError, match="No space left") as raised:
        create_or_open(tmp_path / "new.zarr", tiny, WORDS)
    assert (raised.value.errno, raised.value.filename) == (28, str(tmp_path / "new.zarr"))
    assert raised.value.strerror == "No space left on device"
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("error", "told"),
    [(RuntimeError("can't start new thread"), "the system gives no thread"), (OSError("of Zarr"), "of Zarr")],
)
def test_a_store_that_zarr_cannot_make(
    error: Exception, told: str, tiny: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Is named, and nothing is left of it."""

    def refuse(*_: object) -> None:
        raise error

    monkeypatch.setattr(_create, "_create", refuse)
    with pytest.raises(OSError, match=told) as raised:
        create_or_open(tmp_path / "new.zarr", tiny, WORDS)
    assert raised.value.filename == str(tmp_path / "new.zarr")
    assert not list(tmp_path.iterdir())
