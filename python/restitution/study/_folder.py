"""The folder of a store as Zarr sees it: only regular files are opened, and errors name the file."""

import asyncio
import errno
import os
import stat
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from zarr.abc.store import ByteRequest
from zarr.core.buffer import Buffer, BufferPrototype
from zarr.storage import LocalStore

from restitution._internal.files import MOST, claim, draft_of
from restitution._internal.resources import available_memory


class Folder(LocalStore):
    """A `zarr.storage.LocalStore` that opens regular files only.

    Of others Zarr would wait for the other end of a pipe, read a device without end, or take a folder for a
    chunk that is all zeros.
    """

    async def get(
        self,
        key: str,
        prototype: BufferPrototype | None = None,
        byte_range: ByteRequest | None = None,
    ) -> Buffer | None:
        """Read a file; None where there is none."""
        _check(self.root / key)
        return await super().get(key, prototype, byte_range)

    def get_sync(
        self,
        key: str,
        *,
        prototype: BufferPrototype | None = None,
        byte_range: ByteRequest | None = None,
    ) -> Buffer | None:
        """Likewise, where Zarr has a thread for it already."""
        _check(self.root / key)
        return super().get_sync(key, prototype=prototype, byte_range=byte_range)

    async def get_partial_values(
        self, prototype: BufferPrototype, key_ranges: Iterable[tuple[str, ByteRequest | None]]
    ) -> list[Buffer | None]:
        """Read parts of files."""
        wanted = list(key_ranges)
        for key, _ in wanted:
            _check(self.root / key)
        return await super().get_partial_values(prototype, wanted)

    async def set(self, key: str, value: Buffer) -> None:
        """Write a file in one step."""
        self._check_writable()
        with _naming(self.root / key):
            await asyncio.to_thread(_write, self.root / key, value)

    def set_sync(self, key: str, value: Buffer) -> None:
        """Likewise, where Zarr has a thread for it already."""
        self._check_writable()
        with _naming(self.root / key):
            _write(self.root / key, value)

    async def set_if_not_exists(self, key: str, value: Buffer) -> None:
        """Likewise, unless there is one."""
        self._check_writable()
        with _naming(self.root / key), suppress(FileExistsError):
            await asyncio.to_thread(_write, self.root / key, value, claim)


def _write(path: Path, value: Buffer, put: Callable[[Path, Path], object] = Path.replace) -> None:
    """Put a file in its place by a draft that names its process, unlike Zarr's own.

    Of one that is killed it would stay for good.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = draft_of(path)
    try:
        draft.write_bytes(value.to_bytes())
        put(draft, path)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise


def _check(path: Path) -> None:
    """Refuse what is not a regular file, or longer than memory; the OSError names it."""
    try:
        found = path.stat()
    except (FileNotFoundError, NotADirectoryError):  # Zarr then knows that there is nothing
        return
    if stat.S_ISDIR(found.st_mode):
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    if not stat.S_ISREG(found.st_mode):
        raise OSError(errno.EINVAL, "not a regular file", str(path))
    if found.st_size > MOST and found.st_size > available_memory():
        raise OSError(errno.EFBIG, "longer than this process has memory", str(path))


@contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Name the file in an error, and not the draft that was to take its place."""
    try:
        yield
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error
