"""How files are read as a whole, and what files that are written may be called."""

import errno
import os
import threading
from pathlib import Path

import pytest

from restitution._internal import files as _files
from restitution._internal.files import (
    FOLDER,
    HEADER,
    IMAGE,
    MODULE,
    NETCDF,
    ZARR,
    check_name,
    check_regular,
    content,
    path_for,
)
from restitution._internal.parameters import ParameterError

OWN = {
    NETCDF: "run.nc",
    ZARR: "study.zarr",
    HEADER: "dist.h",
    MODULE: "dist.f90",
    IMAGE: "map.pdf",
}


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


@pytest.mark.parametrize("kind", [NETCDF, ZARR, HEADER, MODULE, IMAGE, FOLDER])
def test_a_kind_has_its_own_names_and_no_others(kind: str) -> None:
    for other, name in OWN.items():
        for written in (name, name.upper()):
            if other == kind:
                check_name("out", Path(written), kind)
                assert path_for("out", written, kind) == Path(written)
                continue
            with pytest.raises(ParameterError) as raised:
                check_name("header", Path(written), kind)
            assert str(raised.value).startswith(f"header = {written!r}: must be the name of {kind}")
            with pytest.raises(ParameterError, match=r"^image = ") as again:
                path_for("image", written, kind)
            assert str(again.value).removeprefix("image") == str(raised.value).removeprefix("header")
    for strange in ("-", "folder/-", "a.csv", "A.PNG.gz"):
        with pytest.raises(ParameterError, match=r"^out = '.*': must be the name of "):
            check_name("out", Path(strange), kind)
    for fine in ("-run", "run-", "-/run", "csv", "run.1"):
        check_name("out", Path(fine), kind)
    with pytest.raises(ParameterError, match=r"^dist = 3: must be the path"):
        path_for("dist", 3, kind)
