"""Files and folders that appear whole or not at all: everything that the package writes goes through here.

What is written stands in a draft, `.NAME.*.part`, on the same file system, and takes its place in one step
when it is complete and on the disk. Unless it may replace, that step fails where something else has appeared
meanwhile. The name of a draft contains the machine and the process that writes it, so that what a killed
process left is removed by the next one that writes to the same name.
"""

import errno
import os
import platform
import re
import secrets
import shutil
import tempfile
from collections.abc import Collection, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import cache
from hashlib import blake2b
from pathlib import Path
from threading import Lock
from typing import Any

from restitution._parameters import ParameterError, wrong
from restitution._signals import undisturbed

_MASKING = Lock()
_LEFT = re.compile(r"\..+\.([0-9a-f]{8})-(\d+)\.[^.]+\.part", re.DOTALL)
"""The name of a draft, with its machine and its process."""
_LONGEST = 200
"""Bytes of a name that a draft's contains as it is: most file systems allow 255 in all."""
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
    _draft_of(path, target).unlink()


def draft_folder(path: Path) -> Path:
    """Make an empty folder beside `path`, whose place it is to take, and remove what the dead left."""
    _remove_leftovers(path.name, path.parent)
    return Path(tempfile.mkdtemp(prefix=_prefix(path.name), suffix=".part", dir=path.parent))


def draft_of(path: Path) -> Path:
    """Name a draft beside `path`, which nothing has yet."""
    return path.with_name(f"{_prefix(path.name)}{secrets.token_hex(8)}.part")


def remove_all_leftovers(folder: Path) -> None:
    """Remove what the dead left in a folder and in those below it, whatever its name was to be."""
    for place, _, names in os.walk(folder):
        for name in names:
            found = _LEFT.fullmatch(name)
            if found and found[1] == _machine() and not _is_alive(int(found[2])):
                discard([Path(place, name)])


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
        for path, target in zip(paths, targets, strict=True):
            drafts.append(_draft_of(path, target))
        yield drafts
        for draft in drafts:
            _finish(draft, 0o666)
        _put_all(list(zip(drafts, targets, strict=True)), replace)
        for folder in {target.parent for target in targets}:
            _flush(folder)
    except OSError as error:
        with undisturbed():
            discard(drafts)
        for path, *ours in zip(paths, drafts, targets, strict=False):
            if str(error.filename) in map(str, ours):
                raise OSError(error.errno, error.strerror or str(error), str(path)) from error
        if error.filename is None:
            names = ", ".join(map(str, paths))
            raise OSError(error.errno, error.strerror or str(error), names) from error
        raise
    except BaseException:
        with undisturbed():
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
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if target.exists() and not target.is_dir():
            raise FileExistsError(errno.EEXIST, os.strerror(errno.EEXIST))
        # Inside a folder that exists, which may be a file system of its own; else beside its place.
        place = target if target.is_dir() else target.parent
        draft = draft_folder(place / target.name)
    except OSError as error:
        _remove(above)
        raise OSError(error.errno, f"out cannot be written to: {error.strerror}", str(path)) from None
    try:
        with discarding(draft):
            yield draft
            for file in draft.iterdir():
                _finish(file, 0o666)
            _finish(draft, 0o777)
            if place == target or target.exists():
                _move_up(draft, target, replace)
            else:
                os.rename(draft, target)
            _flush(place)
    except BaseException:
        with undisturbed():
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
    if target.exists() and not target.is_file():
        raise OSError(errno.EINVAL, "not a file that can be written", str(path))
    if target.exists() and not replace:
        raise FileExistsError(errno.EEXIST, "exists already", str(path))


def _draft_of(path: Path, target: Path) -> Path:
    """Make an empty file beside `target`."""
    _remove_leftovers(target.name, target.parent)
    try:
        handle, name = tempfile.mkstemp(prefix=_prefix(target.name), suffix=".part", dir=target.parent)
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path.parent)) from None
    os.close(handle)
    return Path(name)


def _prefix(name: str) -> str:
    return f".{_short(name)}.{_machine()}-{os.getpid()}."


def _short(name: str) -> str:
    """Shorten a name that leaves no room for what a draft's has besides, in the same way always."""
    whole = os.fsencode(name)
    if len(whole) <= _LONGEST:
        return name
    return whole[: _LONGEST // 2].decode("utf-8", "ignore") + "-" + blake2b(whole, digest_size=8).hexdigest()


@cache
def _machine() -> str:
    return blake2b(platform.node().encode(), digest_size=4).hexdigest()


def _remove_leftovers(name: str, folder: Path) -> None:
    """Remove drafts of this name whose process, on this machine, has ended."""
    draft = re.compile(rf"\.{re.escape(_short(name))}\.{_machine()}-(\d+)\.[^.]+\.part")
    with suppress(OSError):  # a folder that is not there, or cannot be looked into
        for entry in os.scandir(folder):
            found = draft.fullmatch(entry.name)
            if found and not _is_alive(int(found[1])):
                discard([Path(entry.path)])


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


def discard(drafts: Iterable[Path]) -> None:
    """Remove drafts and all that is in them, as far as possible, with one open file at a time."""
    for draft in drafts:
        for folder, _, names in os.walk(draft, topdown=False):
            for name in names:
                with suppress(OSError):
                    Path(folder, name).unlink()
            with suppress(OSError):
                Path(folder).rmdir()
        with suppress(OSError):  # a file
            draft.unlink()


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
            spare.close()
            with undisturbed():
                discard([draft])
            raise


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
    try:
        os.link(draft, target)
        draft.unlink()
    except FileExistsError:
        raise
    except OSError:  # a file system without links: the name first, then what is in it
        os.close(os.open(target, os.O_CREAT | os.O_EXCL | os.O_WRONLY))
        os.replace(draft, target)


def _move_up(draft: Path, target: Path, replace: bool) -> None:
    """Move all files of a draft into a folder, or none."""
    files = sorted(draft.iterdir(), key=lambda file: file.suffix == ".html")
    _put_all([(file, target / file.name) for file in files], replace)
    draft.rmdir()


def _put_all(moves: Sequence[tuple[Path, Path]], replace: bool) -> None:
    """Move drafts to their places, all or none."""
    moved: list[Path] = []
    with ExitStack() as copies:
        old: dict[Path, Path] = {}
        try:
            for draft, target in moves:
                if replace and target.exists() and len(moves) > 1:
                    folder = tempfile.mkdtemp(prefix=_prefix(target.name), suffix=".part", dir=target.parent)
                    copies.callback(discard, [Path(folder)])
                    _keep(target, Path(folder) / target.name)
                    old[target] = Path(folder) / target.name
                _put(draft, target, replace)
                moved.append(target)
        except BaseException:
            for target in moved:
                if target in old:
                    os.replace(old[target], target)
                else:
                    target.unlink()
            raise


def _keep(file: Path, copy: Path) -> None:
    try:
        os.link(file, copy)
    except OSError:  # a file system without links
        shutil.copy2(file, copy)


def _remove(folders: list[Path]) -> None:
    """Take back folders that were made; if something else was put there meanwhile, it stays."""
    with suppress(OSError):
        for folder in reversed(folders):
            folder.rmdir()
