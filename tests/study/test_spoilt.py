"""Stores in which something else stands where a file was, and disks that spoil what is written."""

import asyncio
import errno
import os
import shutil
import stat
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from zarr.abc.store import RangeByteRequest
from zarr.core.buffer import default_buffer_prototype
from zarr.storage import LocalStore

from reference.studies import TINY, bits
from restitution._internal import files as _files
from restitution.study import Refused, _folder, merge, status, sweep
from restitution.study._status import open_store
from restitution.study._store import Store

pytestmark = pytest.mark.usefixtures("small_tasks")
TASK = "tasks/words/c/0/1/0"


def linked(target: str) -> Callable[[Path], object]:
    return lambda path: path.symlink_to(target)


KINDS: dict[str, Callable[[Path], object]] = {
    "pipe": os.mkfifo,
    "folder": Path.mkdir,
    "circle": lambda path: path.symlink_to(path.name),
    "device without end": linked("/dev/zero"),
    "link to nothing": linked("nothing"),
}


@pytest.fixture
def copy(done: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(done, tmp_path / "copy.zarr"))


def instead(file: Path, kind: str) -> None:
    if file.is_dir():
        shutil.rmtree(file)
    else:
        file.unlink()
    KINDS[kind](file)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", [TASK, "mean_restitution/c/0/0/0", "normal/c/0", "status/c/0/0"])
def test_a_chunk_that_is_no_file(kind: str, name: str, copy: Path, done: Path, tmp_path: Path) -> None:
    """Is damaged for a sweep, which writes it again, and for a merge; whoever wants its numbers is told.

    A folder is left as it is: it may hold anything.
    """
    file = copy / name
    instead(file, kind)
    missing = kind == "link to nothing"  # as chunks are that hold zeros alone
    if name.startswith("status") and not missing:
        with pytest.raises(OSError, match=r"\[Errno \d+\] .*: .*copy\.zarr") as raised:
            status(copy)
        assert raised.value.filename == str(file)
    else:
        assert status(copy).points == 6
    if name == TASK or missing:
        open_store(copy).load()
    else:
        with pytest.raises(OSError, match=r"\[Errno \d+\] .*: .*copy\.zarr") as raised:
            open_store(copy).load()
        assert raised.value.filename == str(file)
    if name == TASK:
        assert merge(tmp_path / "merged.zarr", [copy], threads=1).finished == 5
    if kind == "folder":
        with pytest.raises(IsADirectoryError) as raised:
            sweep(TINY, copy, threads=1)
        assert raised.value.filename == str(file)
        assert file.is_dir()
    else:
        sweep(TINY, copy, threads=1)
        assert stat.S_ISREG(file.lstat().st_mode)
        assert bits(copy) == bits(done)


@pytest.mark.parametrize("kind", ["pipe", "circle", "link to nothing"])
@pytest.mark.parametrize(
    "name", ["zarr.json", "tasks/words/zarr.json", "status/zarr.json", "mean_restitution/zarr.json"]
)
def test_metadata_that_are_no_file(kind: str, name: str, copy: Path) -> None:
    """The store is refused, and nothing is written to it."""
    instead(copy / name, kind)
    before = bits(copy)
    if name.startswith("mean") and kind == "link to nothing":  # an array that was not made yet
        sweep(TINY, copy, threads=1)
        return
    with pytest.raises((Refused, OSError), match=r"copy\.zarr"):
        sweep(TINY, copy, threads=1)
    if not name.startswith("mean"):
        with pytest.raises((Refused, OSError), match=r"copy\.zarr"):
            status(copy)
    assert bits(copy) == before


@pytest.mark.parametrize("kind", ["pipe", "circle"])
@pytest.mark.parametrize("name", ["tasks/words/c/0", "tasks/words/c/0/1"])
def test_a_folder_of_chunks_that_is_none(kind: str, name: str, copy: Path) -> None:
    instead(copy / name, kind)
    with pytest.raises(OSError, match=r"\[Errno \d+\] .*: .*copy\.zarr") as raised:
        sweep(TINY, copy, threads=1)
    assert str(raised.value.filename).startswith(str(copy / name))


def test_what_others_put_into_a_store(copy: Path, done: Path) -> None:
    """Is passed over without a word."""
    others = [name for name in KINDS if name != "circle"]  # who looks into one is told by the system
    for name in others:
        KINDS[name](copy / name)
    (copy / "mine").mkdir()
    (copy / "mine" / "zarr.json").write_text('{"zarr_format": 3, "node_type": "group"}')
    (copy / "mean_restitution" / "c" / "0" / "0" / "0").write_bytes(b"spoilt")
    sweep(TINY, copy, threads=1)
    for name in others:
        if name == "folder":
            (copy / name).rmdir()
        else:
            (copy / name).unlink()
    shutil.rmtree(copy / "mine")
    assert bits(copy) == bits(done)


NUMBERS = {"pipe": errno.EINVAL, "folder": errno.EISDIR, "circle": errno.ELOOP}


@pytest.mark.skipif(not hasattr(LocalStore, "get_sync"), reason="Zarr of this version has fewer ways")
@pytest.mark.parametrize("kind", NUMBERS)
def test_every_way_to_read_a_file(kind: str, tmp_path: Path) -> None:
    """All that Zarr has, whichever of them it takes in a version; what is not there is not there."""
    folder, prototype = _folder.Folder(tmp_path), default_buffer_prototype()
    part = [("file", RangeByteRequest(1, 3)), ("other", None)]
    asyncio.run(folder.set("file", prototype.buffer.from_bytes(b"content")))
    folder.set_sync("other", prototype.buffer.from_bytes(b"else"))
    assert (tmp_path / "other").read_bytes() == b"else"
    whole = asyncio.run(folder.get("file", prototype))
    ranged = asyncio.run(folder.get("file", prototype, RangeByteRequest(1, 3)))
    at_once = folder.get_sync("file", prototype=prototype)
    ranged_at_once = folder.get_sync("file", prototype=prototype, byte_range=RangeByteRequest(1, 3))
    parts = asyncio.run(folder.get_partial_values(prototype, part))
    found = [whole, ranged, at_once, ranged_at_once, *parts]
    told = [one.to_bytes() for one in found if one is not None]
    assert told == [b"content", b"on", b"content", b"on", b"on", b"else"]
    assert asyncio.run(folder.get("none")) is None
    assert folder.get_sync("file/none") is None
    instead(tmp_path / "file", kind)
    for read in (
        lambda: asyncio.run(folder.get("file")),
        lambda: folder.get_sync("file"),
        lambda: asyncio.run(folder.get_partial_values(prototype, part)),
    ):
        with pytest.raises(OSError, match=r"\[Errno \d+\] \w.*file") as raised:
            read()
        assert raised.value.filename == str(tmp_path / "file")
        assert (
            raised.value.errno == {"pipe": errno.EINVAL, "folder": errno.EISDIR, "circle": errno.ELOOP}[kind]
        )


def test_an_error_of_writing_names_the_file_and_not_its_draft(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder, content = _folder.Folder(tmp_path), default_buffer_prototype().buffer.from_bytes(b"content")

    def refuse(error: OSError) -> None:
        raise error

    for error, told in (
        (OSError(errno.EISDIR, "Is a directory", "draft"), "Is a directory"),
        (OSError("of nobody"), "of nobody"),
    ):
        monkeypatch.setattr(_folder, "_write", lambda *_, error=error: refuse(error))
        ways: list[Callable[[], Any]] = [
            lambda: asyncio.run(folder.set("file", content)),
            lambda: folder.set_sync("file", content),
            lambda: asyncio.run(folder.set_if_not_exists("file", content)),
        ]
        for write in ways:
            with pytest.raises(OSError, match=told) as raised:
                write()
            assert (raised.value.errno, raised.value.strerror) == (error.errno, told)
            assert raised.value.filename == str(tmp_path / "file")


def test_a_file_that_is_there_is_kept(tmp_path: Path) -> None:
    """By what writes only if there is none; no draft stays."""
    folder, buffer = _folder.Folder(tmp_path), default_buffer_prototype().buffer
    for content in (b"first", b"second"):
        asyncio.run(folder.set_if_not_exists("file", buffer.from_bytes(content)))
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {"file": b"first"}


def test_a_chunk_longer_than_memory(copy: Path, done: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Is not read: it is damaged for a sweep, and refused where its numbers are wanted."""
    monkeypatch.setattr(_folder, "MOST", 2**20)
    for name in (TASK, "mean_restitution/c/0/0/0"):
        with (copy / name).open("wb") as file:
            file.truncate(_files.MOST)
    with monkeypatch.context() as patched:
        patched.setattr(_folder, "available_memory", lambda: _files.MOST - 1)
        with pytest.raises(OSError, match="longer") as raised:
            open_store(copy).load()
        assert raised.value.strerror == "longer than this process has memory"
        assert raised.value.errno == errno.EFBIG
        assert raised.value.filename == str(copy / "mean_restitution/c/0/0/0")
        sweep(TINY, copy, threads=1)
    assert bits(copy) == bits(done)


def test_a_short_chunk_is_read_whatever_memory_there_is(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither is memory looked at for every chunk, nor is one refused that exactly fits."""
    name = copy / "status" / "c" / "0" / "0"
    size = name.stat().st_size
    monkeypatch.setattr(_folder, "available_memory", lambda: 0)
    assert status(copy).finished == 6
    monkeypatch.setattr(_folder, "MOST", size - 1)
    monkeypatch.setattr(_folder, "available_memory", lambda: size)
    _folder._check(name)


def test_a_folder_in_the_place_of_a_chunk_is_named(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError) as raised:
        _folder._check(tmp_path)
    assert (raised.value.errno, raised.value.strerror) == (errno.EISDIR, os.strerror(errno.EISDIR))
    assert raised.value.filename == str(tmp_path)


@pytest.fixture
def public() -> Iterator[Path]:
    """A folder that every user of the machine can reach, unlike those of pytest."""
    folder = Path(tempfile.mkdtemp())
    folder.chmod(0o777)
    yield folder
    shutil.rmtree(folder)


def test_a_chunk_that_may_not_be_read(done: Path, public: Path) -> None:
    """Is not called damaged, and not written again: the error of the system names it."""
    copy = Path(shutil.copytree(done, public / "copy.zarr"))
    for path in copy.rglob("*"):
        path.chmod(0o777)
    copy.chmod(0o777)
    (copy / TASK).chmod(0)
    before = (copy / TASK).stat()
    sweep(TINY, public / "first.zarr", threads=1)  # all is imported that the other user could not read
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        if os.geteuid() == 0:
            os.setresuid(65534, 65534, 65534)
        try:
            sweep(TINY, copy, threads=1)
        except BaseException as error:
            os.write(writer, f"{type(error).__name__} {error}".encode())
        os._exit(0)
    os.close(writer)
    os.waitpid(child, 0)
    with os.fdopen(reader) as told:
        assert told.read() == f"PermissionError [Errno 13] Permission denied: '{copy / TASK}'"
    assert (copy / TASK).stat().st_mtime_ns == before.st_mtime_ns


def cut(file: Path) -> None:
    file.write_bytes(file.read_bytes()[:-7])


def swapped(file: Path) -> None:
    """A chunk of another point, which can be read and has another digest."""
    shutil.copyfile(file.parents[2] / "1" / "0" / "0", file)


SPOIL: dict[str, tuple[Callable[[Path], object], str]] = {
    "cut": (cut, "RuntimeError: "),
    "swapped": (swapped, "its digest is not that of the numbers in it"),
    "vanishes": (Path.unlink, "there is no such file"),
    "pipe": (lambda file: instead(file, "pipe"), "OSError: .* not a regular file"),
}


def spoiling(monkeypatch: pytest.MonkeyPatch, spoil: Callable[[Path], object], times: int) -> list[int]:
    """Let a disk spoil what is written to one of the chunks; returns what counts how often it is written."""
    written: list[int] = []
    write = Store.write

    def spoilt(store: Store, point: int, first: int, rows: Any) -> None:
        write(store, point, first, rows)
        if (point, first) == (0, 2):
            written.append(first)
            if len(written) <= times:
                spoil(store.path / TASK)

    monkeypatch.setattr(Store, "write", spoilt)
    return written


@pytest.mark.parametrize("name", SPOIL)
def test_a_disk_that_spoils_what_it_writes(
    name: str, copy: Path, done: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Ends the sweep after three attempts, by an error that names the file and what was found; not sooner."""
    spoil, told = SPOIL[name]
    (copy / TASK).unlink()
    with monkeypatch.context() as patched:
        written = spoiling(patched, spoil, times=1000)
        match = rf"written 3 times, and damaged when it was read back \({told}.*\); what is finished"
        with pytest.raises(OSError, match=match) as raised:
            sweep(TINY, copy, threads=1)
    assert (raised.value.errno, raised.value.filename) == (errno.EIO, str(copy / TASK))
    assert len(written) == 3
    with monkeypatch.context() as patched:
        written = spoiling(patched, spoil, times=2)
        sweep(TINY, copy, threads=1)
    assert len(written) == 3
    assert bits(copy) == bits(done)
