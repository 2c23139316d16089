"""Files that appear whole or not at all, and files that are read to their end.

What is written stands in a draft ``.NAME.*.part`` beside its place, and takes that place in one step when it
is complete and on the disk. Where nothing may be replaced, this step fails if something has appeared there.
"""

import errno
import glob
import os
import secrets
import shutil
import time
from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NoReturn

from restitution._internal.parameters import ParameterError, wrong

MOST = 2**28  # bytes of a file that is read as a whole: far above tables of times and parameters of runs
_LONGEST = 50  # letters of a name that a draft's contains: most file systems allow 255 bytes in all

_OWN = {
    "a netCDF file, such as run.nc": ".nc .nc3 .nc4 .netcdf .cdf .h5 .hdf5",
    "a Zarr store, such as study.zarr": ".zarr",
    "a header of C and C++, such as dist.h": ".h .hh .hpp .hxx",
    "a Fortran source, such as dist.f90": ".f90 .f95 .f03 .f08",
    "a figure, which is written as .png, .pdf or .svg": ".png .pdf .svg",
    "a film, which is written as .gif or .mp4": ".gif .mp4",
    "a table, which is written as .csv or .parquet": ".csv .parquet",
    "a LaTeX source, such as fit.tex": ".tex",
    "a folder": "",
}
"""Files that the package writes under names that are given, in the words of an error, and their endings."""
NETCDF, ZARR, HEADER, MODULE, IMAGE, FILM, TABLE, LATEX, FOLDER = _OWN
_OTHERS = (
    ".c .cc .cpp .f .for .py .rs .jl .m .r .ipynb .tsv .txt .md .html .htm .json .toml .yaml .yml "
    ".xml .xls .xlsx .ods .npy .npz .mat .pkl .pickle .jpg .jpeg .tif .tiff .bmp .eps .ps "
    ".wav .flac .ogg .mp3 .aiff .zip .tar .gz .bz2 .xz .7z .sqlite"
)


def path_from(name: str, value: Any) -> Path:
    """Check the name of a file; raises a ParameterError for any other value."""
    try:
        path = Path(value)
    except TypeError:
        path = Path()
    if path == Path() or "\0" in str(path):
        raise ParameterError(wrong(name, value, "the path of a file"))
    return path


def path_for(argument: str, value: Any, kind: str) -> Path:
    """Check the name of a file to be written: not of another format, nor a dash, as for standard output."""
    path = path_from(argument, value)
    # Any other name will do: what follows the last dot may be part of a number.
    strange = " ".join([_OTHERS, *(own for other, own in _OWN.items() if other != kind)]).split()
    nameless = path.name in ("", "..") and kind != FOLDER
    if nameless or path.suffix.lower() in strange or path.name == "-":
        raise ParameterError(wrong(argument, str(path), f"the name of {kind}"))
    return path


def content(path: Path) -> bytes:
    """Read a file as a whole; an OSError that names it if it cannot be read, or is longer than any table."""
    with path.open("rb") as file:
        found = file.read(MOST + 1)
    if len(found) > MOST:
        raise OSError(errno.EFBIG, f"longer than {MOST >> 20} MiB", str(path))
    return found


def check_regular(path: Path) -> None:
    """Refuse folders, pipes and devices for libraries that go back and forth in a file, or wait for ever."""
    path.stat()  # whose OSError names what is not there
    if path.is_dir():
        raise OSError(errno.EISDIR, "is a folder", str(path))
    if not path.is_file():
        raise OSError(errno.EINVAL, "not a regular file: save it first", str(path))


def there(path: Path) -> bool:
    """Test whether there is anything of this name; an OSError that Path.exists hides if it is not known."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    return True


def check(path: Path, *, replace: bool) -> None:
    """Find out before the work begins whether a file can be written; raises the OSError if it cannot."""
    draft, _ = _begin(path, replace)
    draft.unlink()


def check_folder(path: Path, *, replace: bool) -> None:
    """Refuse a folder that holds anything, before the work begins, unless files may be replaced."""
    if not replace and path.is_dir() and any(path.iterdir()):
        raise FileExistsError(errno.EEXIST, "is not empty", str(path))


def check_apart(inputs: Sequence[Path], outputs: Sequence[Path]) -> None:
    """Refuse a file that is to be written twice, or over what is read; raises an OSError."""
    seen = {os.path.realpath(path): "is what is read" for path in inputs}
    for path in outputs:
        target = os.path.realpath(path)
        if target in seen:
            raise OSError(errno.EINVAL, f"{seen[target]}: give another name to write to", str(path))
        seen[target] = "is to be written twice"


@contextmanager
def whole_file(path: Path, *, replace: bool = False) -> Iterator[Path]:
    """Yield the path of an empty draft that becomes the file when the block ends well.

    Of a symbolic link the file is what the link leads to. An OSError names `path`.
    """
    draft, target = _begin(path, replace)
    try:
        yield draft
        _flush(draft)
        _place(draft, target, replace=replace)
    except OSError as error:
        _raise_named(error, draft, path)
    finally:
        with suppress(OSError):
            draft.unlink()


def write(path: Path, content: str | bytes, *, replace: bool = False) -> None:
    """Write a file whole or not at all; text as UTF-8."""
    with whole_file(path, replace=replace) as draft:
        draft.write_bytes(content.encode() if isinstance(content, str) else content)


@contextmanager
def whole_folder(path: Path, *, replace: bool = False, names: Collection[str] = ()) -> Iterator[Path]:
    """Yield a draft folder whose files stand in `path` when the block ends well, else none of them.

    A folder that was not there appears in one step, with those above it. Into one that was, files move one by
    one, HTML last: where a report is, all that it shows is. What is in the way of `names` is found out first.
    """
    for name in names:
        _target(path / name, replace)
    target = Path(os.path.realpath(path))
    place = next(folder for folder in (target, *target.parents) if there(folder))
    _remove_old_drafts(place, target.name)
    draft = draft_of(place / target.name)
    # To list the draft where no more may be open.
    spare = [os.open(os.devnull, os.O_RDONLY) for _ in range(2)]
    try:
        try:
            draft.mkdir()
        except OSError as error:
            raise OSError(error.errno, f"out cannot be written to: {error.strerror}", str(path)) from None
        yield draft
        files = sorted(draft.iterdir(), key=lambda file: file.suffix == ".html")
        for file in files:
            _flush(file)
        if there(target):
            for file in files:
                _place(file, target / file.name, replace=replace)
        else:
            target.parent.mkdir(parents=True, exist_ok=True)
            os.rename(draft, target)
    except OSError as error:
        _raise_named(error, draft, path)
    finally:
        for handle in spare:
            os.close(handle)
        shutil.rmtree(draft, ignore_errors=True)


def draft_of(path: Path) -> Path:
    """Choose an unused name for a draft beside `path`."""
    return path.with_name(f".{path.name[:_LONGEST]}.{secrets.token_hex(8)}.part")


def _remove_old_drafts(folder: Path, name: str) -> None:
    """Remove the drafts of a name in a folder that a process left which was killed."""
    for draft in list(folder.glob(f".{glob.escape(name[:_LONGEST])}.*.part")):
        with suppress(OSError):
            if time.time() - draft.stat().st_mtime > 86_400.0:  # nobody writes for a day
                if draft.is_dir():
                    shutil.rmtree(draft)
                else:
                    draft.unlink()


def _place(draft: Path, target: Path, *, replace: bool) -> None:
    """Move a draft to its place; a FileExistsError where something has taken it that may not be replaced."""
    if replace:
        os.replace(draft, target)
        return
    try:
        try:
            os.link(draft, target)
        except FileExistsError:
            raise
        except OSError:  # a file system without links: the name first, then what is in it
            target.touch(exist_ok=False)
            os.replace(draft, target)
    except FileExistsError:
        raise FileExistsError(errno.EEXIST, "exists already", str(target)) from None


def _begin(path: Path, replace: bool) -> tuple[Path, Path]:
    """Make an empty draft of a file; give also the place that it is to take."""
    target = _target(path, replace, "exists already; replace=True replaces it")
    _remove_old_drafts(target.parent, target.name)
    draft = draft_of(target)
    try:
        draft.touch(exist_ok=False)
    except OSError as error:  # of the folder: as it was given, but that of a link is where it leads to
        folder = target.parent if path.is_symlink() else path.parent
        raise OSError(error.errno, error.strerror, str(folder)) from None
    return draft, target


def _target(path: Path, replace: bool, taken: str = "exists already") -> Path:
    """Follow links to where a file is to be, and refuse what is in its way."""
    target = Path(os.path.realpath(path))
    if there(path) and not target.is_file():  # a pipe in /dev/fd is there, and leads to no name of a file
        raise OSError(errno.EINVAL, "not a file that can be written", str(path))
    if there(target) and not replace:
        raise FileExistsError(errno.EEXIST, taken, str(path))
    return target


def _raise_named(error: OSError, draft: Path, path: Path) -> NoReturn:
    """Raise an error of the system by the name that was given, where it has none or that of the draft."""
    if error.errno is None and type(error) is not OSError:  # what a signal may raise
        raise error
    name = Path(error.filename or draft)
    for ours in (draft, Path(os.path.realpath(path))):
        if name.is_relative_to(ours):
            given = path / name.relative_to(ours)
            raise OSError(error.errno, error.strerror or str(error), str(given)) from error
    raise error


def _flush(path: Path) -> None:
    """Flush a file to the disk; Windows does so only for those who may write to it."""
    with path.open("rb+") as file:
        os.fsync(file.fileno())
