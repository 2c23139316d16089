"""Errors of files name what was given, and not a draft or a place that nobody has heard of."""

import errno
import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from restitution._internal.files import check, claim, whole_file, whole_files, whole_folder

FULL = os.strerror(errno.ENOSPC)


@contextmanager
def naming(number: int, path: Path | str) -> Iterator[None]:
    with pytest.raises(OSError, match=r"\w") as raised:
        yield
    error = raised.value
    assert (error.errno, error.filename) == (number, str(path))


def test_a_full_disk_in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A file of it by its name in the folder as it was given, several in a row, and the folder itself."""
    monkeypatch.chdir(tmp_path)
    out = Path("laws")
    with naming(errno.ENOSPC, "laws/laws.nc"), whole_folder(out) as draft:
        raise OSError(errno.ENOSPC, FULL, str(draft / "laws.nc"))
    both = "laws/laws.png, laws/laws.pdf"
    with (
        naming(errno.ENOSPC, both),
        whole_folder(out) as draft,
        whole_files([draft / "laws.png", draft / "laws.pdf"]),
    ):
        raise OSError(errno.ENOSPC, FULL)
    with naming(errno.ENOSPC, "laws"), whole_folder(out):
        raise OSError(errno.ENOSPC, FULL)
    out.mkdir()
    (out / "laws.nc").touch()
    with naming(errno.EEXIST, "laws/laws.nc"), whole_folder(out) as draft:
        (draft / "laws.nc").touch()


def test_other_files_keep_their_names(tmp_path: Path) -> None:
    """Also those whose names begin as that of the file does."""
    (tmp_path / "link").symlink_to(tmp_path / "run")
    for name in ("run2", "run.toml", "my run"):
        with naming(errno.ENOENT, tmp_path / name), whole_file(tmp_path / "link"):
            (tmp_path / name).read_text()


def test_an_error_that_is_not_of_the_system_stays(tmp_path: Path) -> None:
    """As a time-out, which a program may raise when a signal comes."""

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
    reading, writing = os.pipe()
    try:
        for replace in (False, True):
            with pytest.raises(OSError, match="not a file that can be written") as raised:
                check(Path(f"/dev/fd/{writing}"), replace=replace)
            assert raised.value.filename == f"/dev/fd/{writing}"
    finally:
        os.close(reading)
        os.close(writing)


def test_a_place_that_was_claimed_in_vain_is_free_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """On a file system without links the name is taken first: an empty file would be a part of the whole."""

    def failing(*_: object) -> None:
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(os, "link", failing)
    monkeypatch.setattr(os, "replace", failing)
    (tmp_path / "draft").write_text("new")
    with pytest.raises(OSError, match=os.strerror(errno.EIO)):
        claim(tmp_path / "draft", tmp_path / "run.nc")
    assert [file.name for file in tmp_path.iterdir()] == ["draft"]
