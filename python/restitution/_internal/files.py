"""Files and folders that appear whole or not at all: everything that the package writes goes through here.

What is written stands in a draft on the same file system, and takes its place in one step when it is complete
and on the disk. Unless it may replace, that step fails where something else has appeared meanwhile.

Signals wait (`undisturbed`) from the making of a draft until who removes it knows of it, while drafts take
their places or what stood there is put back, and while drafts are removed. Then they count, and all of what
is written is there or nothing.
"""

import errno
import os
import platform
import re
import secrets
import shutil
import tempfile
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from hashlib import blake2b
from pathlib import Path
from threading import Lock
from typing import Any, NoReturn

from restitution._internal.parameters import ParameterError, wrong
from restitution._internal.process import surely, undisturbed

NETCDF, ZARR, HEADER, MODULE, IMAGE, TABLE, LATEX, FOLDER = (
    "a netCDF file, such as run.nc",
    "a Zarr store, such as study.zarr",
    "a header of C and C++, such as dist.h",
    "a Fortran source, such as dist.f90",
    "a figure, which is written as .png, .pdf or .svg",
    "a table, which is written as .csv or .parquet",
    "a LaTeX source, such as fit.tex",
    "a folder",
)
"""What the package writes under names that are given, in the words of an error."""

_OWN = {
    NETCDF: {".nc", ".nc3", ".nc4", ".netcdf", ".cdf", ".h5", ".hdf5"},
    ZARR: {".zarr"},
    HEADER: {".h", ".hh", ".hpp", ".hxx"},
    MODULE: {".f90", ".f95", ".f03", ".f08"},
    IMAGE: {".png", ".pdf", ".svg"},
    TABLE: {".csv", ".parquet"},
    LATEX: {".tex"},
    FOLDER: set(),
}
_OTHERS = {
    *(".c", ".cc", ".cpp", ".cxx", ".f", ".for", ".py", ".rs", ".jl", ".m", ".r", ".ipynb"),
    *(".tsv", ".txt", ".md", ".html", ".htm", ".json", ".toml", ".yaml", ".yml", ".xml"),
    *(".xls", ".xlsx", ".ods", ".feather", ".arrow", ".npy", ".npz", ".mat", ".pkl", ".pickle"),
    *(".jpg", ".jpeg", ".gif", ".tif", ".tiff", ".bmp", ".webp", ".eps", ".ps", ".mp4"),
    *(".wav", ".flac", ".ogg", ".mp3", ".aiff", ".zip", ".tar", ".gz", ".bz2", ".xz", ".7z", ".sqlite"),
}


def check_name(argument: str, path: Path, kind: str) -> None:
    """Refuse the name of another format, a folder's, and a dash, which to other programs is standard output.

    Any other name will do: what follows the last dot may be part of a number.

    Parameters
    ----------
    argument : str
        What the name is given as.
    path : Path
        The name.
    kind : str
        What is written: `NETCDF`, `ZARR`, `HEADER`, `MODULE`, `IMAGE`, `TABLE`, `LATEX` or `FOLDER`.

    Raises
    ------
    ParameterError
        Saying what is written.
    """
    strange = _OTHERS.union(*(own for other, own in _OWN.items() if other != kind))
    nameless = path.name in ("", "..") and kind != FOLDER
    if nameless or path.suffix.lower() in strange or path.name == "-":
        raise ParameterError(wrong(argument, str(path), f"the name of {kind}"))


def path_for(argument: str, value: Any, kind: str) -> Path:
    """Take what names a file that is to be written; errors as of `path_from` and `check_name`."""
    path = path_from(argument, value)
    check_name(argument, path, kind)
    return path


MOST = 2**28
"""Bytes of a file that is read as a whole; tables of times and parameters of runs are far below it."""
_PIECE = 2**20
"""Bytes that are read at a time."""


def content(path: Path) -> bytes:
    """Read a file as a whole; an OSError that names it if it cannot be read, or is longer than any table."""
    try:
        found = bytearray()
        with path.open("rb") as file:
            # Python takes room for all that is asked for, however short the file is.
            while piece := file.read(min(_PIECE, MOST + 1 - len(found))):
                found += piece
    except OSError as error:  # while it is read, it names no file
        raise OSError(error.errno, error.strerror, str(path)) from error
    if len(found) > MOST:
        raise OSError(errno.EFBIG, f"longer than {MOST >> 20} MiB", str(path))
    return bytes(found)


def check_regular(path: Path) -> None:
    """Refuse folders, pipes and devices for libraries that go back and forth in a file, or wait for ever."""
    path.stat()  # whose OSError names what is not there
    if not path.is_file():
        number = errno.EISDIR if path.is_dir() else errno.EINVAL
        text = "is a folder" if path.is_dir() else "not a regular file: save it first"
        raise OSError(number, text, str(path))


_NAME = re.compile(r"\.(.+)\.([0-9a-f]{8})-(\d+)\.[^.]+\.part", re.DOTALL)
"""The name of a draft: whose it is, its machine and its process."""
_LONGEST = 200
"""Bytes of a name that a draft's contains as it is: most file systems allow 255 in all."""


def draft_of(path: Path) -> Path:
    """Name a draft beside `path`, which nothing has yet."""
    return path.with_name(f"{prefix(path.name)}{secrets.token_hex(8)}.part")


def draft_file(path: Path) -> Path:
    """Make an empty file beside `path`, whose place it is to take, and remove what the dead left."""
    remove_leftovers(path.parent, [path.name])
    handle, name = tempfile.mkstemp(prefix=prefix(path.name), suffix=".part", dir=path.parent)
    os.close(handle)
    return Path(name)


def draft_folder(path: Path) -> Path:
    """Make an empty folder beside `path`, whose place it is to take, and remove what the dead left."""
    remove_leftovers(path.parent, [path.name])
    return Path(tempfile.mkdtemp(prefix=prefix(path.name), suffix=".part", dir=path.parent))


def prefix(name: str) -> str:
    """Begin the name of a draft."""
    return f".{_short(name)}.{_machine()}-{os.getpid()}."


def _short(name: str) -> str:
    """Shorten a name that leaves no room for what a draft's has besides, in the same way always."""
    whole = os.fsencode(name)
    if len(whole) <= _LONGEST:
        return name
    return whole[: _LONGEST // 2].decode("utf-8", "ignore") + "-" + blake2b(whole, digest_size=8).hexdigest()


def _machine() -> str:
    """Tell apart what has process numbers of its own: machines, and the containers of one."""
    whole = platform.node()
    with suppress(OSError):  # not Linux, or without /proc
        whole += os.readlink("/proc/self/ns/pid")
    return blake2b(whole.encode(), digest_size=4).hexdigest()


def remove_leftovers(folder: Path, names: Iterable[str]) -> None:
    """Remove drafts of these names in a folder whose process, on this machine, has ended."""
    wanted = set(map(_short, names))
    with suppress(OSError), os.scandir(folder) as entries:  # there may be none, or none that can be listed
        for entry in entries:
            if _whom_the_dead_left(entry.name) in wanted:
                discard([Path(entry.path)])


def remove_all_leftovers(folder: Path) -> None:
    """Remove what the dead left in a folder and in those below it, whatever its name was to be."""
    for place, _, names in os.walk(folder):
        for name in names:
            if _whom_the_dead_left(name):
                discard([Path(place, name)])


def _whom_the_dead_left(draft: str) -> str | None:
    """Give the name that a draft was to have, if its process, on this machine, has ended."""
    found = _NAME.fullmatch(draft)
    if found and found[2] == _machine() and not _is_alive(int(found[3])):
        return found[1]
    return None


def _is_alive(process: int) -> bool:
    if os.name != "posix":  # elsewhere the call would end it
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):  # of another user
        return True
    return True


def discard(drafts: Sequence[Path]) -> None:
    """Remove drafts and all that is in them, as far as possible, with one open file at a time."""

    def remove() -> None:
        for draft in drafts:
            for folder, _, names in os.walk(draft, topdown=False):
                for name in names:
                    with suppress(OSError):
                        Path(folder, name).unlink()
                with suppress(OSError):
                    Path(folder).rmdir()
            with suppress(OSError):  # a file
                draft.unlink()

    surely(remove)


@contextmanager
def discarding(draft: Path) -> Iterator[None]:
    """Discard a folder's draft if the block fails, whatever files it leaves open.

    Those of fonts stay open with a figure that could not be drawn, and the process may have no more.
    """
    with ExitStack() as spare:
        try:
            spare.callback(os.close, os.open(os.devnull, os.O_RDONLY))
            yield
        except BaseException:
            try:
                spare.close()
            finally:
                discard([draft])
            raise


_MASKING = Lock()
_LONGEST_PATH = 4095 if os.name == "posix" else 32_767  # bytes of any path that a system opens


def path_from(name: str, value: Any) -> Path:
    """Take what names a file; raises a ParameterError for what does not."""
    try:
        path = Path(value)
        length = len(os.fsencode(path))
    except Exception:  # whatever the object raises
        path, length = Path(), 0
    bad = path == Path() or "\0" in str(path)
    if bad or length > _LONGEST_PATH:
        how = "without null characters or lone surrogates" if bad else f"of at most {_LONGEST_PATH} bytes"
        raise ParameterError(wrong(name, value, f"the path of a file, {how}"))
    return path


def check(path: Path, *, replace: bool) -> None:
    """Find out before the work begins whether a file can be written; raises the OSError if it cannot."""
    target = followed(path)
    _refuse_existing(path, target, replace)
    with undisturbed():
        _draft_of(path, target).unlink()


def check_folder(path: Path, *, replace: bool) -> None:
    """Refuse a folder that holds anything, before the work begins, unless files may be replaced."""
    if not replace and path.is_dir() and any(path.iterdir()):
        raise FileExistsError(errno.EEXIST, "is not empty", str(path))


def check_apart(inputs: Sequence[Path], outputs: Sequence[Path]) -> None:
    """Refuse a file that is to be written twice, or over what is read; raises an OSError."""
    seen = {followed(path): "is what is read" for path in inputs}
    for path in outputs:
        target = followed(path)
        if target in seen:
            raise OSError(errno.EINVAL, f"{seen[target]}: give another name to write to", str(path))
        seen[target] = "is to be written twice"


@contextmanager
def whole_file(path: Path, *, replace: bool = False) -> Iterator[Path]:
    """Yield the path of an empty draft that becomes the file when the block ends well.

    Parameters
    ----------
    path : Path
        The file; of a symbolic link it is what the link leads to.
    replace : bool
        Whether a file that is there already, or appears meanwhile, is replaced.

    Raises
    ------
    OSError
        If the file cannot be written, or exists and is not to be replaced; its `filename` is `path`.
    """
    with whole_files([path], replace=replace) as (draft,):
        yield draft


@contextmanager
def whole_files(paths: Sequence[Path], *, replace: bool = False) -> Iterator[list[Path]]:
    """Yield a draft for each of several files, which appear together when the block ends well, else none.

    As `whole_file`.
    """
    targets = [followed(path) for path in paths]
    for path, target in zip(paths, targets, strict=True):
        _refuse_existing(path, target, replace)
    drafts: list[Path] = []
    try:
        with undisturbed():
            for path, target in zip(paths, targets, strict=True):
                drafts.append(_draft_of(path, target))
        yield drafts
        for draft in drafts:
            _finish(draft, 0o666)
        _put_all(list(zip(drafts, targets, strict=True)), replace)
        for folder in {target.parent for target in targets}:
            _flush(folder)
    except OSError as error:
        discard(drafts)
        _raise_named(error, dict(zip([*targets, *drafts], [*paths, *paths], strict=False)))
    except BaseException:
        discard(drafts)
        raise


def write(path: Path, content: str | bytes, *, replace: bool = False) -> None:
    """Write a file whole or not at all; text as UTF-8."""
    with whole_file(path, replace=replace) as draft:
        draft.write_bytes(content.encode() if isinstance(content, str) else content)


@contextmanager
def whole_folder(path: Path, *, replace: bool = False, names: Collection[str] = ()) -> Iterator[Path]:
    """Yield a draft folder whose files stand in `path` when the block ends well, else none of them.

    A folder that was not there appears in one step. In one that was, files move up one by one, HTML files
    last: where the report is, all that it shows is. If one cannot, those that could are taken back.

    Parameters
    ----------
    path : Path
        The folder; it is made with those above it. Other files in it stay.
    replace : bool
        Whether files of the same names are replaced.
    names : collection of str
        Names of the files, as far as they are known: what is in their way is found out first.

    Raises
    ------
    OSError
        If the folder cannot be made or written to, or something is in the way; before the block runs.
    """
    target = followed(path)
    for name in names:
        _refuse_existing(path / name, target / name, replace)
    above = [folder for folder in reversed(target.parents) if not folder.exists()]
    named = {target: path}
    try:
        with ExitStack() as drafts:
            with undisturbed():
                place, draft = _begin(path, target)
                drafts.enter_context(discarding(draft))
            named[draft] = path
            yield draft
            for file in draft.iterdir():
                _finish(file, 0o666)
            _finish(draft, 0o777)
            if place == target or target.exists():
                _move_up(draft, target, replace)
            else:
                os.rename(draft, target)
            _flush(place)
    except OSError as error:
        _remove(above)
        _raise_named(error, named)
    except BaseException:
        _remove(above)
        raise


def followed(path: Path) -> Path:
    """Follow links to where a file is to be; raises an OSError for a name that no file of ours can have."""
    try:
        os.fsencode(path).decode("utf-8")
        return path.resolve()
    except UnicodeDecodeError:
        raise OSError(errno.EILSEQ, "the name is not UTF-8", str(path)) from None
    except FileNotFoundError:
        raise FileNotFoundError(errno.ENOENT, "the working folder is no more", str(path)) from None
    except (ValueError, RuntimeError) as error:  # a null character; links in a circle
        raise OSError(errno.EINVAL, f"no name of a file: {error}", str(path)) from None


def _refuse_existing(path: Path, target: Path, replace: bool) -> None:
    if path.exists() and not target.is_file():  # a pipe in /dev/fd is there, and leads to no name of a file
        raise OSError(errno.EINVAL, "not a file that can be written", str(path))
    if target.exists() and not replace:
        raise FileExistsError(errno.EEXIST, "exists already", str(path))


def _draft_of(path: Path, target: Path) -> Path:
    """Make an empty file beside `target`."""
    try:
        return draft_file(target)
    except OSError as error:
        # The folder as it was given, but that of a link is where it leads to.
        folder = target.parent if path.is_symlink() else path.parent
        raise OSError(error.errno, error.strerror, str(folder)) from None


def _begin(path: Path, target: Path) -> tuple[Path, Path]:
    """Make a draft of a folder, and the folders above it; give also the folder that it is to be moved in."""
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.exists() and not target.is_dir():
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST))
        # Inside a folder that exists, which may be a file system of its own; else beside its place.
        place = target if target.is_dir() else target.parent
        return place, draft_folder(place / target.name)
    except OSError as error:
        raise OSError(error.errno, f"out cannot be written to: {error.strerror}", str(path)) from None


def _raise_named(error: OSError, given: Mapping[Path, Path]) -> NoReturn:
    """Raise an error by the names that were given, where it has none or that of a draft or a target."""
    if error.errno is None and type(error) is not OSError:  # not of the system, as what a signal may raise
        raise error
    name = str(error.filename)
    for ours, path in given.items():
        # Of a folder also what is in it; the names of several files may stand in a row.
        name = str(path).join(re.split(rf"(?<!\S){re.escape(str(ours))}(?=[/\\]|, |$)", name))
    if error.filename is None:
        name = ", ".join(map(str, dict.fromkeys(given.values())))
    elif name == str(error.filename):
        raise error
    raise OSError(error.errno, error.strerror or str(error), name) from error


def _finish(draft: Path, mode: int) -> None:
    """Give a draft the permissions of any new file, and bring it to the disk."""
    permit(draft, mode)
    _flush(draft)


def permit(draft: Path, mode: int) -> None:
    """Give a draft the permissions of any new file or, with a mode of 0o777, folder."""
    draft.chmod(mode & ~_mask())


def _mask() -> int:
    """Read the permissions that new files lack: Linux tells; elsewhere they must be set to be known."""
    with suppress(OSError):
        for line in Path("/proc/self/status").read_text(encoding="ascii", errors="replace").splitlines():
            if line.startswith("Umask:"):
                return int(line.split()[1], 8)
    with _MASKING, undisturbed():  # another thread or a signal between the two would leave it at 0 for good
        mask = os.umask(0)
        os.umask(mask)
    return mask


def _flush(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _put(draft: Path, target: Path, replace: bool) -> None:
    """Move a draft to its place in one step."""
    if replace:
        os.replace(draft, target)
        return
    try:
        claim(draft, target)
    except FileExistsError:
        raise FileExistsError(errno.EEXIST, "exists already", str(target)) from None


def claim(draft: Path, target: Path) -> None:
    """Move a draft to a place that nothing has taken; raises a FileExistsError."""
    with undisturbed():
        try:
            os.link(draft, target)
        except FileExistsError:
            raise
        except OSError:  # a file system without links: the name first, then what is in it
            os.close(os.open(target, os.O_CREAT | os.O_EXCL | os.O_WRONLY))
            try:
                os.replace(draft, target)
            except OSError:
                target.unlink()  # it is ours, and empty
                raise
        else:
            draft.unlink()


def _move_up(draft: Path, target: Path, replace: bool) -> None:
    """Move all files of a draft into a folder, or none."""
    files = sorted(draft.iterdir(), key=lambda file: file.suffix == ".html")
    remove_leftovers(target, [file.name for file in files])  # copies of what stood there
    _put_all([(file, target / file.name) for file in files], replace)
    draft.rmdir()


def _put_all(moves: Sequence[tuple[Path, Path]], replace: bool) -> None:
    """Move drafts to their places, all or none."""
    with undisturbed(), ExitStack() as copies, ExitStack() as taken_back:
        if len(moves) == 1:  # it has its place, or what stood there has
            _put(*moves[0], replace)
            return
        for draft, target in moves:
            take_back: Callable[[], object] = target.unlink
            if replace and target.exists():
                copy = draft_folder(target) / target.name
                copies.callback(discard, [copy.parent])
                _keep(target, copy)
                take_back = partial(os.replace, copy, target)
            _put(draft, target, replace)
            taken_back.callback(take_back)
        taken_back.pop_all()


def _keep(file: Path, copy: Path) -> None:
    try:
        os.link(file, copy)
    except OSError:  # a file system without links
        shutil.copy2(file, copy)


def _remove(folders: list[Path]) -> None:
    """Take back folders that were made; if something else was put there meanwhile, it stays."""

    def remove() -> None:
        with suppress(OSError):
            for folder in reversed(folders):
                folder.rmdir()

    surely(remove)
