"""What is said of paths and folders that cannot be used: number, words and name, all three."""

import errno
import os
import stat
from pathlib import Path
from typing import Any

import pytest

from restitution._internal import files as _files
from restitution._internal.files import followed, path_from, permit, whole_file, whole_files, whole_folder
from restitution._internal.parameters import ParameterError

NO_TEXT = "must be the path of a file, without null characters or lone surrogates"


class Unreadable:
    def __fspath__(self) -> str:
        raise RuntimeError("who knows")


@pytest.mark.parametrize("value", ["", ".", "a\0b", "\ud800", 3, None, Unreadable()])
def test_what_names_no_file_is_refused(value: Any) -> None:
    with pytest.raises(ParameterError) as raised:
        path_from("out", value)
    text = str(raised.value)
    assert text.startswith("out = ")
    assert text.endswith(NO_TEXT)
    assert repr(value)[:10] in text


def test_the_longest_path() -> None:
    """4095 bytes, not characters, are the most that Linux opens."""
    for longest in ("x" * 4095, "é" * 2047 + "x"):
        assert path_from("out", longest) == Path(longest)
        with pytest.raises(
            ParameterError, match=r"^out = .*: must be the path of a file, of at most 4095 bytes$"
        ):
            path_from("out", longest + "x")


def told(error: OSError) -> tuple[int | None, str | None, Any]:
    return error.errno, error.strerror, error.filename


def test_a_file_in_the_way_of_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder is named as it was given, and so is a file that one of its own would replace."""
    monkeypatch.chdir(tmp_path)
    Path("taken").touch()
    with pytest.raises(OSError, match="taken") as raised, whole_folder(Path("taken")):
        pytest.fail("the work began")
    assert told(raised.value) == (errno.EEXIST, "out cannot be written to: File exists", "taken")
    Path("out").mkdir()
    Path("out/laws.md").touch()
    with pytest.raises(OSError, match="laws") as raised, whole_folder(Path("out"), names=["new", "laws.md"]):
        pytest.fail("the work began")
    assert told(raised.value) == (errno.EEXIST, "exists already", "out/laws.md")
    with whole_folder(Path("out"), replace=True, names=["laws.md"]) as draft:
        (draft / "laws.md").write_text("new")
    assert Path("out/laws.md").read_text() == "new"


def test_folders_above_are_made(tmp_path: Path) -> None:
    """And a folder that is there already has its draft inside: it may be a file system of its own."""
    out = tmp_path / "a" / "b" / "c"
    with whole_folder(out) as draft:
        assert draft.parent == out.parent
        (draft / "one").write_text("1")
    with whole_folder(out) as draft:
        assert draft.parent == out
        (draft / "two").write_text("2")
    assert sorted(file.name for file in out.iterdir()) == ["one", "two"]
    assert stat.S_IMODE((out / "two").stat().st_mode) == 0o666 & ~_files._mask()


def test_a_working_folder_that_is_no_more(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gone = tmp_path / "gone"
    gone.mkdir()
    monkeypatch.chdir(gone)
    gone.rmdir()
    with pytest.raises(FileNotFoundError) as raised:
        followed(Path("run.nc"))
    assert told(raised.value) == (errno.ENOENT, "the working folder is no more", "run.nc")


def test_an_error_without_a_number_keeps_its_words(tmp_path: Path) -> None:
    """Libraries raise such; the file is named."""
    path = tmp_path / "run.nc"
    with pytest.raises(OSError, match="no room") as raised, whole_file(path):
        raise OSError("no room")
    assert told(raised.value) == (None, "no room", str(path))
    with pytest.raises(OSError, match="disk full") as raised, whole_file(path):
        raise OSError(errno.ENOSPC, "disk full")
    assert told(raised.value) == (errno.ENOSPC, "disk full", str(path))


def test_what_takes_the_place_of_one_of_several_meanwhile(tmp_path: Path) -> None:
    paths = [tmp_path / "a", tmp_path / "b"]
    with pytest.raises(FileExistsError) as raised, whole_files(paths):
        paths[1].write_text("another")
    assert told(raised.value) == (errno.EEXIST, "exists already", str(paths[1]))
    assert [file.name for file in tmp_path.iterdir()] == ["b"]


@pytest.mark.parametrize("mask", [0o022, 0o077, 0o001])
def test_the_mask_of_permissions_is_read_and_stays(
    mask: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the system tells it, among words of another alphabet too, and where it must be set to be read."""
    before = os.umask(mask)
    try:
        (tmp_path / "file").touch()
        permit(tmp_path / "file", 0o666)
        assert stat.S_IMODE((tmp_path / "file").stat().st_mode) == 0o666 & ~mask
        read = Path.read_text
        told = (
            read(Path("/proc/self/status"), encoding="ascii", errors="replace").encode() + b"Name: \xff\xfe\n"
        )

        def strange(self: Path, **how: Any) -> str:
            assert how["encoding"] == "ascii"
            return (b"Name: \xff\n" + told).decode(**how)

        def none(self: Path, **_: Any) -> str:
            raise OSError(errno.ENOENT, "no /proc", str(self))

        for reading in (strange, none):
            monkeypatch.setattr(Path, "read_text", reading)
            assert _files._mask() == mask
            monkeypatch.undo()
        assert os.umask(mask) == mask
    finally:
        os.umask(before)
