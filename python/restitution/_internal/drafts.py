"""Drafts: under what name a file or folder stands until it is complete, and who removes it if it never is.

A draft is `.NAME.*.part` on the file system of its place. Its name contains the machine and the process that
writes it, so that what a killed process left is removed by the next one that writes to the same name.
"""

import os
import platform
import re
import secrets
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from hashlib import blake2b
from pathlib import Path

from restitution._internal.signals import surely

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
