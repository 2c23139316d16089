"""Files and folders appear whole or not at all, and never over what somebody else has put there."""

import errno
import os
import re
import shutil
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from restitution._internal import files as _files
from restitution._internal.files import check, draft_folder, prefix, whole_file, whole_folder, write


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


@pytest.mark.parametrize("replace", [False, True])
def test_a_folder_that_cannot_take_all_takes_none(tmp_path: Path, replace: bool) -> None:
    """Where something is in the way, here a folder, the files that were moved before are taken back."""
    (tmp_path / "report.html").mkdir()
    if replace:
        (tmp_path / "figure.png").write_text("old")

    def fill() -> None:
        with whole_folder(tmp_path, replace=replace) as draft:
            (draft / "figure.png").write_text("new")
            (draft / "report.html").write_text("report")

    with pytest.raises(OSError, match=r"report\.html"):
        fill()
    assert names(tmp_path) == ({"report.html", "figure.png"} if replace else {"report.html"})
    assert not replace or (tmp_path / "figure.png").read_text() == "old"


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
        (lambda folder: folder / os.fsdecode(b"\xff.nc"), errno.EILSEQ, "the name is not UTF-8"),
        (lambda folder: folder / "circle", errno.EINVAL, "no name of a file: Symlink loop"),
        (lambda folder: folder / "folder", errno.EINVAL, "not a file that can be written"),
        (lambda folder: folder / "there", errno.EEXIST, "exists already"),
    ],
    ids=["bytes", "circle", "folder", "there"],
)
def test_a_refusal_has_number_words_and_name(
    tmp_path: Path, make: Callable[[Path], Path], number: int, text: str
) -> None:
    (tmp_path / "circle").symlink_to(tmp_path / "circle")
    (tmp_path / "folder").mkdir()
    (tmp_path / "there").touch()
    path = make(tmp_path)
    with pytest.raises(OSError, match=re.escape(text)) as error:
        check(path, replace=False)
    assert (error.value.errno, error.value.filename) == (number, str(path))
    assert str(error.value.strerror).startswith(text)


def test_a_folder_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError) as error:
        check(tmp_path / "none" / "run.nc", replace=True)
    assert (error.value.filename, error.value.strerror) == (str(tmp_path / "none"), os.strerror(errno.ENOENT))


def test_write_replaces_only_if_asked(tmp_path: Path) -> None:
    path = tmp_path / "dist.h"
    write(path, "old")
    with pytest.raises(FileExistsError):
        write(path, "new")
    assert path.read_text() == "old"
    write(path, b"new", replace=True)
    assert path.read_text() == "new"


@pytest.mark.parametrize("folder", [False, True])
def test_a_second_signal_leaves_no_draft(
    folder: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It comes while the drafts are removed, after a first one, and counts when they are gone."""
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)
    remove: Any = shutil.rmtree if folder else Path.unlink

    def removed(*what: Any, **how: Any) -> None:
        os.kill(os.getpid(), signal.SIGINT)
        time.sleep(0.01)
        remove(*what, **how)

    def work() -> None:
        with (whole_folder if folder else whole_file)(tmp_path / "new"):
            os.kill(os.getpid(), signal.SIGINT)
            time.sleep(1.0)

    monkeypatch.setattr(shutil if folder else Path, "rmtree" if folder else "unlink", removed)
    try:
        with pytest.raises(KeyboardInterrupt):
            work()
    finally:
        signal.signal(signal.SIGINT, handler)
    assert names(tmp_path) == set()


def test_a_draft_of_a_folder_is_known_as_one(tmp_path: Path) -> None:
    """By its name and its place, so that the next process removes what a dead one left."""
    draft = draft_folder(tmp_path / "study.zarr")
    assert draft.parent == tmp_path
    name = re.fullmatch(rf"\.study\.zarr\.([0-9a-f]{{8}})-{os.getpid()}\.\w+\.part", draft.name)
    assert name
    dead = tmp_path / f".study.zarr.{name[1]}-{2**22 + 1}.left.part"  # no process has such a number
    dead.mkdir()
    (dead / "zarr.json").touch()
    other = draft_folder(tmp_path / "study.zarr")
    assert names(tmp_path) == {draft.name, other.name}


def test_files_that_are_replaced_are_kept_until_all_are_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beside their places, in folders that are known as drafts; pages come after all they show."""
    order: list[str] = []
    there: list[str] = []

    def put(draft: Path, target: Path, replace: bool) -> None:
        order.append(target.name)
        there.extend(names(tmp_path) - {draft.parent.name})
        os.replace(draft, target)

    for name in ("a.html", "b.csv", "c.html"):
        (tmp_path / name).write_text("old")
    monkeypatch.setattr(_files, "_put", put)
    with whole_folder(tmp_path, replace=True) as draft:
        for name in ("a.html", "b.csv", "c.html"):
            (draft / name).write_text("new")
    assert (order[0], set(order[1:])) == ("b.csv", {"a.html", "c.html"})
    kept = {name for name in there if name.startswith(".b.csv.")}
    assert kept
    assert all(f"-{os.getpid()}." in name and name.endswith(".part") for name in kept)
    assert names(tmp_path) == {"a.html", "b.csv", "c.html"}


def test_a_folder_that_was_made_stays_if_something_was_put_there(tmp_path: Path) -> None:
    def troubled() -> None:
        with whole_folder(tmp_path / "above" / "laws"):
            (tmp_path / "above" / "theirs").touch()
            raise RuntimeError("trouble")

    with pytest.raises(RuntimeError, match="trouble"):
        troubled()
    assert names(tmp_path / "above") == {"theirs"}


@pytest.mark.parametrize("letter", ["n", "é"])
def test_the_longest_names_have_room_for_a_draft(tmp_path: Path, letter: str) -> None:
    """A draft's name is longer than that of its file, which may be as long as the file system allows."""
    name = letter * (252 // len(letter.encode())) + ".nc"
    check(tmp_path / name, replace=False)
    left = tmp_path / f"{prefix(name)}x.part".replace(f"-{os.getpid()}.", f"-{2**22 + 1}.")
    left.touch()  # of a process that is no more
    write(tmp_path / name, "all")
    assert [file.name for file in tmp_path.iterdir()] == [name]
    assert prefix(name) != prefix(name.replace(".nc", ".cn"))


def test_permissions_of_new_files_are_not_touched(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Between two calls of umask a signal would leave every later file of the process open to all."""
    monkeypatch.setattr("os.umask", lambda mask: pytest.fail("another thread would see it"))
    write(tmp_path / "one", "all")
    monkeypatch.undo()
    before = os.umask(0o027)
    try:
        write(tmp_path / "two", "all")
    finally:
        assert os.umask(before) == 0o027
    assert (tmp_path / "two").stat().st_mode & 0o777 == 0o640
