"""Files appear whole or not at all, and never over what somebody else has put there; files have an end."""

import errno
import os
import re
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from restitution._internal import files as _files
from restitution._internal.files import (
    check,
    check_regular,
    content,
    draft_of,
    path_from,
    whole_file,
    whole_folder,
    write,
)
from restitution._internal.parameters import ParameterError


def names(folder: Path) -> set[str]:
    return {file.name for file in folder.iterdir()}


def test_a_file_appears_when_the_block_ends(tmp_path: Path) -> None:
    """Until then a draft stands beside its place, whose name says what it is a part of."""
    path = tmp_path / "run.nc"
    with whole_file(path) as draft:
        draft.write_text("half")
        assert not path.exists()
        assert draft.parent == tmp_path
        assert draft.name.startswith(".run.nc.")
        assert draft.suffix == ".part"
    assert (names(tmp_path), path.read_text()) == ({"run.nc"}, "half")
    (tmp_path / "fresh").touch()
    assert path.stat().st_mode == (tmp_path / "fresh").stat().st_mode


@pytest.mark.parametrize("links", [True, False], ids=["links", "a file system without links"])
def test_what_appears_meanwhile_is_replaced_only_if_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, links: bool
) -> None:
    """The last step is the check, so that of two runs to one name the second one is told."""

    def no_links(*_: object) -> None:
        raise OSError(errno.EPERM, os.strerror(errno.EPERM))

    if not links:
        monkeypatch.setattr(os, "link", no_links)
    path = tmp_path / "run.nc"

    def meanwhile(*, replace: bool) -> None:
        with whole_file(path, replace=replace) as draft:
            draft.write_text("mine")
            path.write_text("theirs")

    with pytest.raises(FileExistsError, match=r"exists already.*run\.nc"):
        meanwhile(replace=False)
    assert (names(tmp_path), path.read_text()) == ({"run.nc"}, "theirs")
    meanwhile(replace=True)
    assert (names(tmp_path), path.read_text()) == ({"run.nc"}, "mine")
    path.unlink()
    write(path, "alone")
    assert (names(tmp_path), path.read_text()) == ({"run.nc"}, "alone")


@pytest.mark.parametrize("trouble", [RuntimeError(), KeyboardInterrupt(), OSError(errno.ENOSPC, "disk full")])
def test_trouble_leaves_no_part_of_anything(tmp_path: Path, trouble: BaseException) -> None:
    """An error of the system that names no file names the one that was asked for."""

    def file() -> None:
        with whole_file(tmp_path / "run.nc") as draft:
            draft.write_text("half")
            raise trouble

    def folder(path: Path) -> None:
        with whole_folder(path) as draft:
            (draft / "figure.png").write_text("half")
            raise trouble

    with pytest.raises(type(trouble)) as caught:
        file()
    if isinstance(caught.value, OSError):
        assert (caught.value.errno, caught.value.filename) == (errno.ENOSPC, str(tmp_path / "run.nc"))
    for path in (tmp_path / "made" / "here", tmp_path):
        with pytest.raises(type(trouble)):
            folder(path)
    assert names(tmp_path) == set()


def test_what_cannot_be_written_is_found_out_first(tmp_path: Path) -> None:
    """By `check`, and by a block that never begins; nothing is left of the attempt."""
    (tmp_path / "taken").write_text("precious")
    for path, replace in (
        (tmp_path / "taken", False),
        (tmp_path, True),
        (tmp_path / "none" / "run.nc", True),
    ):
        with pytest.raises(OSError, match=str(tmp_path)):
            check(path, replace=replace)
        with pytest.raises(OSError, match=str(tmp_path)), whole_file(path, replace=replace):
            pytest.fail("the work began")
    check(tmp_path / "taken", replace=True)
    for out in (tmp_path / "taken", tmp_path / "taken" / "below"):
        with pytest.raises(OSError, match=r"out cannot be written to.*taken"), whole_folder(out):
            pytest.fail("the work began")
    assert (names(tmp_path), (tmp_path / "taken").read_text()) == ({"taken"}, "precious")


def test_a_new_folder_appears_in_one_step(tmp_path: Path) -> None:
    out = tmp_path / "new" / "paper"
    with whole_folder(out) as draft:
        (draft / "figure.png").write_text("drawn")
        (draft / "report.html").write_text("report")
        assert not out.exists()
    assert (names(out.parent), names(out)) == ({"paper"}, {"figure.png", "report.html"})
    (tmp_path / "fresh").mkdir()
    assert out.stat().st_mode == (tmp_path / "fresh").stat().st_mode


def test_a_folder_keeps_what_is_in_it(tmp_path: Path) -> None:
    """Nothing is in place while the work is on, and then all of it; other files in the folder stay."""
    (tmp_path / "mine.txt").write_text("mine")
    (tmp_path / "figure.png").write_text("old")
    with whole_folder(tmp_path, replace=True) as draft:
        (draft / "figure.png").write_text("new")
        (draft / "report.html").write_text("report")
        assert (tmp_path / "figure.png").read_text() == "old"
    assert names(tmp_path) == {"mine.txt", "figure.png", "report.html"}
    assert (tmp_path / "figure.png").read_text() == "new"


@pytest.mark.parametrize("form", [whole_file, whole_folder])
def test_what_is_flushed_may_be_written_to(
    form: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Windows flushes no file that is open to be read alone: it gives EBADF, as here."""
    flush, flushed = os.fsync, []

    def writing_nothing(handle: int) -> None:
        os.write(handle, b"")
        flush(handle)
        flushed.append(handle)

    monkeypatch.setattr(os, "fsync", writing_nothing)
    with form(tmp_path / "out") as draft:
        (draft if form is whole_file else draft / "file").write_text("all")
    assert len(flushed) == 1


def test_a_folder_that_appears_meanwhile_is_not_written_over(tmp_path: Path) -> None:
    out = tmp_path / "paper"

    def fill() -> None:
        with whole_folder(out) as draft:
            (draft / "figure.png").write_text("mine")
            out.mkdir()
            (out / "figure.png").write_text("theirs")

    with pytest.raises(FileExistsError, match=r"exists already.*figure\.png"):
        fill()
    assert (names(tmp_path), names(out)) == ({"paper"}, {"figure.png"})
    assert (out / "figure.png").read_text() == "theirs"


def test_a_symbolic_link_stays_one(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(tmp_path / "file")
    write(tmp_path / "link", b"through")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "file").read_bytes() == b"through"


@pytest.mark.parametrize(
    ("make", "number", "text"),
    [
        (lambda folder: folder / "folder", errno.EINVAL, "not a file that can be written"),
        (lambda folder: folder / "there", errno.EEXIST, "exists already; replace=True replaces it"),
    ],
    ids=["folder", "there"],
)
def test_a_refusal_has_number_words_and_name(
    tmp_path: Path, make: Callable[[Path], Path], number: int, text: str
) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "there").touch()
    path = make(tmp_path)
    with pytest.raises(OSError, match=re.escape(text)) as error:
        check(path, replace=False)
    assert (error.value.errno, error.value.filename) == (number, str(path))
    assert str(error.value.strerror).startswith(text)


@contextmanager
def naming(number: int, path: Path | str) -> Iterator[None]:
    with pytest.raises(OSError, match=r"\w") as raised:
        yield
    error = raised.value
    assert (error.errno, error.filename) == (number, str(path))


def test_other_files_keep_their_names(tmp_path: Path) -> None:
    """Also those whose names begin as that of the file does."""
    (tmp_path / "link").symlink_to(tmp_path / "run")
    for name in ("run2", "run.toml", "my run"):
        with naming(errno.ENOENT, tmp_path / name), whole_file(tmp_path / "link"):
            (tmp_path / name).read_text()


def test_an_error_that_is_not_of_the_system_stays(tmp_path: Path) -> None:
    """As a time-out, which a program may raise when a signal comes."""
    if sys.platform == "win32":
        pytest.skip("there are no alarms")

    def late(*_: object) -> None:
        raise TimeoutError("too late")

    before = signal.signal(signal.SIGALRM, late)
    try:
        for block in (whole_file, whole_folder):
            with pytest.raises(TimeoutError, match=r"^too late$"), block(tmp_path / "out"):
                signal.raise_signal(signal.SIGALRM)
    finally:
        signal.signal(signal.SIGALRM, before)


def test_a_link_that_leads_to_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder that is missing is named: beside the link nothing is."""
    monkeypatch.chdir(tmp_path)
    Path("link").symlink_to("nowhere/run.nc")
    for path in (Path("link"), tmp_path / "link"):
        with naming(errno.ENOENT, tmp_path / "nowhere"):
            check(path, replace=False)
        with naming(errno.ENOENT, tmp_path / "nowhere"), whole_file(path):
            pytest.fail("the work began")
    with naming(errno.ENOENT, "none"):
        check(Path("none/run.nc"), replace=False)


def test_a_pipe_is_no_file(tmp_path: Path) -> None:
    """As /dev/stdout is one where the output goes to another program: it leads to no name of a file."""
    if sys.platform == "win32":
        pytest.skip("there is no /dev/fd")
    reading, writing = os.pipe()
    try:
        for replace in (False, True):
            with pytest.raises(OSError, match="not a file that can be written") as raised:
                check(Path(f"/dev/fd/{writing}"), replace=replace)
            assert raised.value.filename == f"/dev/fd/{writing}"
    finally:
        os.close(reading)
        os.close(writing)


@pytest.mark.parametrize("value", ["", ".", "a\0b", 3, None])
def test_what_names_no_file_is_refused(value: Any) -> None:
    with pytest.raises(ParameterError) as raised:
        path_from("out", value)
    text = str(raised.value)
    assert text.startswith("out = ")
    assert text.endswith("must be the path of a file")
    assert repr(value)[:10] in text


def told(error: OSError) -> tuple[int | None, str | None, Any]:
    return error.errno, error.strerror, error.filename


def test_a_file_in_the_way_of_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder is named as it was given, and so is a file that one of its own would replace."""
    monkeypatch.chdir(tmp_path)
    Path("taken").touch()
    with pytest.raises(OSError, match="taken") as raised, whole_folder(Path("taken")):
        pytest.fail("the work began")
    assert told(raised.value) == (errno.ENOTDIR, "out cannot be written to: Not a directory", "taken")
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
        assert draft.parent == tmp_path
        (draft / "one").write_text("1")
    with whole_folder(out) as draft:
        assert draft.parent == out
        (draft / "two").write_text("2")
    assert sorted(file.name for file in out.iterdir()) == ["one", "two"]


def test_an_error_without_a_number_keeps_its_words(tmp_path: Path) -> None:
    """Libraries raise such; the file is named."""
    path = tmp_path / "run.nc"
    with pytest.raises(OSError, match="no room") as raised, whole_file(path):
        raise OSError("no room")
    assert told(raised.value) == (None, "no room", str(path))
    with pytest.raises(OSError, match="disk full") as raised, whole_file(path):
        raise OSError(errno.ENOSPC, "disk full")
    assert told(raised.value) == (errno.ENOSPC, "disk full", str(path))


def test_a_file_is_read_to_its_end_or_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file of just the greatest length is read as it is, one of a byte more is not."""
    monkeypatch.setattr(_files, "MOST", 3 << 20)
    path = tmp_path / "table"
    whole = os.urandom(3 << 20)
    path.write_bytes(whole)
    assert content(path) == whole
    path.write_bytes(whole + b"\r")
    with pytest.raises(OSError, match=r"^\[Errno \d+\] longer than 3 MiB: '") as raised:
        content(path)
    assert (raised.value.errno, raised.value.filename) == (errno.EFBIG, str(path))
    path.write_bytes(b"a\r\n\x1a\x00\xff")  # as it is, without a view on its lines
    assert content(path) == b"a\r\n\x1a\x00\xff"
    with pytest.raises(FileNotFoundError) as missing:
        content(tmp_path / "none")
    assert missing.value.filename == str(tmp_path / "none")


def test_a_file_without_end_is_read_no_farther_than_needed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The byte beyond the greatest length is enough to refuse it, while its writer goes on."""
    if sys.platform == "win32":
        pytest.skip("there are no named pipes")
    monkeypatch.setattr(_files, "MOST", 1000)
    os.mkfifo(tmp_path / "pipe")
    refused = threading.Event()
    in_time = []

    def write() -> None:
        with (tmp_path / "pipe").open("wb", buffering=0) as pipe:
            pipe.write(bytes(1001))
            in_time.append(refused.wait(10.0))

    writer = threading.Thread(target=write)
    writer.start()
    with pytest.raises(OSError, match="longer than 0 MiB"):
        content(tmp_path / "pipe")
    refused.set()
    writer.join()
    assert in_time == [True]


def test_only_files_that_have_an_end_go_to_libraries(tmp_path: Path) -> None:
    if sys.platform == "win32":
        pytest.skip("there are no named pipes")
    path = tmp_path / "run.nc"
    with pytest.raises(FileNotFoundError) as missing:
        check_regular(path)
    assert missing.value.filename == str(path)
    path.touch()
    check_regular(path)
    (tmp_path / "link.nc").symlink_to(path)
    check_regular(tmp_path / "link.nc")
    with pytest.raises(IsADirectoryError, match=r"^\[Errno \d+\] is a folder: '") as folder:
        check_regular(tmp_path)
    assert (folder.value.errno, folder.value.filename) == (errno.EISDIR, str(tmp_path))
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(OSError, match=r"^\[Errno \d+\] not a regular file: save it first: '") as pipe:
        check_regular(tmp_path / "pipe")
    assert (pipe.value.errno, pipe.value.filename) == (errno.EINVAL, str(tmp_path / "pipe"))


@pytest.mark.parametrize("letter", ["n", "é"])
def test_the_longest_names_have_room_for_a_draft(tmp_path: Path, letter: str) -> None:
    """A draft's name is longer than that of its file, which may be as long as the file system allows."""
    name = letter * (252 // len(letter.encode())) + ".nc"
    check(tmp_path / name, replace=False)
    write(tmp_path / name, "all")
    assert [file.name for file in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize("block", [whole_file, whole_folder])
def test_a_name_that_is_too_long_is_refused_before_the_work(
    block: Callable[..., Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Since Python 3.14 Path.exists is False where the system says so, as os.path.exists has always been."""
    monkeypatch.setattr(Path, "exists", os.path.exists)
    with pytest.raises(OSError, match="too long"), block(tmp_path / ("n" * 300)):
        pytest.fail("the work began")


def test_what_a_killed_process_left_goes_after_a_day(tmp_path: Path) -> None:
    """Of the same name; a draft that is younger may be one of a process that is at work."""
    left = [draft_of(tmp_path / name) for name in ("run.nc", "run.nc", "other.nc", "laws")]
    for draft in left[:3]:
        draft.touch()
    left[3].mkdir()
    (left[3] / "laws.nc").touch()
    for draft in (left[0], left[2], left[3]):
        os.utime(draft, (0, time.time() - 90_000))
    write(tmp_path / "run.nc", "all")
    assert names(tmp_path) == {"run.nc", *(draft.name for draft in left[1:])}
    write(tmp_path / "other.nc", "all")
    with whole_folder(tmp_path / "laws") as draft:
        (draft / "file").touch()
    assert names(tmp_path) == {"run.nc", "other.nc", "laws", left[1].name}


@pytest.mark.parametrize("mask", [0o022, 0o077])
def test_new_files_have_the_permissions_of_any(tmp_path: Path, mask: int) -> None:
    if sys.platform == "win32":
        pytest.skip("there is no umask")
    before = os.umask(mask)
    try:
        write(tmp_path / "file", "all")
        with whole_folder(tmp_path / "folder") as draft:
            (draft / "file").touch()
    finally:
        os.umask(before)
    for path, mode in (("file", 0o666), ("folder", 0o777), ("folder/file", 0o666)):
        assert (tmp_path / path).stat().st_mode & 0o777 == mode & ~mask


def test_a_full_disk_in_a_folder_names_the_file_as_it_was_given(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    out, full = Path("laws"), os.strerror(errno.ENOSPC)
    with naming(errno.ENOSPC, "laws/laws.nc"), whole_folder(out) as draft:
        raise OSError(errno.ENOSPC, full, str(draft / "laws.nc"))
    with naming(errno.ENOSPC, "laws/laws.png"), whole_folder(out) as draft, whole_file(draft / "laws.png"):
        raise OSError(errno.ENOSPC, full)
    with naming(errno.ENOSPC, "laws"), whole_folder(out):
        raise OSError(errno.ENOSPC, full)
    assert names(tmp_path) == set()


def test_two_threads_that_write_to_one_name(tmp_path: Path) -> None:
    """One of them gets it, the others are told, and the file is one of theirs."""
    path, ready = tmp_path / "run.nc", threading.Barrier(8)
    results: list[int] = []
    told: list[str] = []

    def work(number: int) -> None:
        try:
            with whole_file(path) as draft:
                draft.write_text(f"{number}" * 1000)
                ready.wait()
            results.append(number)
        except FileExistsError as error:
            told.append(error.filename)

    threads = [threading.Thread(target=work, args=(number,)) for number in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert told == [str(path)] * 7
    assert [path.read_text()] == [f"{number}" * 1000 for number in results]
    assert names(tmp_path) == {"run.nc"}
