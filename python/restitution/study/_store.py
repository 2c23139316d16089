"""The Zarr store of a study (format 3): what every task counted, and the labelled results.

The array ``tasks/words`` holds a row for each batch of each point: the words of `restitution._core.Tally`,
and after them a digest, BLAKE2b, of the study, the point, the batch and the words. A task writes its rows as
one chunk, which takes its place in one step: its digest shows whether what is read back is what was written.
Everything else in the store follows from these rows.
"""

import contextlib
import hashlib
import math
import os
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Mapping
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.resources import check_room
from restitution.study._axes import Design
from restitution.study._identity import readable, threads_for
from restitution.study._layout import check_array
from restitution.study._point import Words

F = TypeVar("F", bound=Callable[..., Any])
DIGEST = 4
"""Words of a digest."""
_LARGE = 4096
"""Numbers of a variable at a point from which on each point has a chunk of its own."""
_CHUNK = 4_000_000
"""Bytes of a chunk of the other variables, at most where the shape allows it."""


_ROOM = 100_000_000
"""Bytes of memory that Zarr takes."""
_FILES = 4
"""Files that Zarr opens at least: three for its loop, of which it leaves pieces otherwise, and a chunk's."""


def need_zarr(path: Path, threads: int | None = None) -> None:
    """Say what to install; refuse a store where there is no room for Zarr, no thread, or no file to open.

    Where it is to be written, `threads` work on it, 0 if others do.
    """
    if "zarr" not in sys.modules:
        check_room("a study", _ROOM)
    with contextlib.ExitStack() as files:
        try:
            for _ in range(_FILES):
                files.callback(os.close, os.open(os.devnull, os.O_RDONLY))
        except OSError as error:
            raise OSError(
                error.errno, f"a study takes {_FILES} open files: {error.strerror}", str(path)
            ) from None
    with threads_for(path):  # before Zarr fails to start its own, which it then cannot end either
        thread = threading.Thread(target=bool)
        thread.start()
        thread.join()
    try:
        import zarr
    except ImportError:
        raise ImportError("parameter studies need zarr: pip install 'restitution[sweep]'") from None
    if int(zarr.__version__.partition(".")[0]) < 3:
        raise ImportError(
            f"parameter studies need zarr 3, here is {zarr.__version__}: pip install 'restitution[sweep]'"
        )
    if not __debug__:
        _try(zarr)


def _try(zarr: Any) -> None:
    """Make groups in memory and open them: Zarr may do in assertions what is left out under `python -O`."""
    memory = zarr.storage.MemoryStore()
    try:
        group = zarr.create_group(memory, zarr_format=3)
        group.create_group("tasks")
        group["tasks"]
        with warnings.catch_warnings(action="ignore"):
            zarr.consolidate_metadata(memory, zarr_format=3)
        zarr.open_group(memory, mode="r")
    except Exception:
        text = f"zarr {zarr.__version__} does not work under python -O or PYTHONOPTIMIZE: leave that out"
        raise RuntimeError(f"parameter studies: {text}") from None


def _naming(method: F) -> F:
    """Name the store in the error of a method, whatever Zarr raises."""

    @wraps(method)
    def named(store: "Store", *args: Any) -> Any:
        with readable(store.path):
            return method(store, *args)

    return cast(F, named)


class Store:
    """A store that is open.

    Parameters
    ----------
    path : Path
        A directory, which every worker can reach under this name.
    study : bytes
        The digest of the study.
    """

    def __init__(self, path: Path, study: bytes) -> None:
        import zarr

        from restitution.study._folder import Folder

        self.path, self.study = path, study
        self._ensured: set[str] = set()
        self._arrays: dict[str, Any] = {}  # those that were seen; what they are does not change
        with readable(path):
            path.stat()  # Zarr would make a folder that is not there
            self.group: Any = zarr.open_group(Folder(path), mode="r+", zarr_format=3, use_consolidated=False)
            words: Any = self.group["tasks/words"]
            self.words = words
            self.task_batches = int(words.chunks[1])

    def points_there(self) -> list[int]:
        """Name the points that have a chunk, of those that the study has."""
        try:
            names = os.listdir(self.path / "tasks" / "words" / "c")
        except FileNotFoundError:
            return []
        numbers = (int(name) for name in names if name.isdecimal())
        return [number for number in numbers if number < self.words.shape[0]]

    def valid(self, point: int, first: int, count: int) -> npt.NDArray[np.bool_]:
        """Return which batches of a point are there, undamaged."""
        return self.read(point, first, count)[1]

    def read(self, point: int, first: int, count: int) -> tuple[Words, npt.NDArray[np.bool_], bytes]:
        """Read rows of whole tasks of a point, return which are undamaged, and their digests."""
        width = self.words.shape[2]
        rows, good = np.zeros((count, width), np.uint64), np.zeros(count, np.bool_)
        for start in range(0, count, self.task_batches):
            part = slice(start, start + self.task_batches)
            try:
                rows[part] = self.words[point, first + part.start : first + part.stop]
            except PermissionError:
                raise
            except Exception:  # a chunk that is cut or spoilt fails in any way that a decoder can
                continue
            for i in range(part.start, part.stop):
                good[i] = rows[i, -DIGEST:].tobytes() == self._digest(point, first + i, rows[i, :-DIGEST])
        return rows[:, :-DIGEST], good, rows[:, -DIGEST:].tobytes()

    def fault(self, point: int, task: int) -> tuple[Path, str]:
        """Name the file of a task's chunk, and say why it is not taken."""
        first = task * self.task_batches
        # The last part of the name is that of the words, which are never divided.
        file = self.path / "tasks" / "words" / "c" / str(point) / str(task) / "0"
        try:
            self.words[point, first : first + self.task_batches]
        except Exception as error:  # as in `read`
            return file, f"{type(error).__name__}: {error}"
        if not file.exists():
            return file, "there is no such file"
        return file, "its digest is not that of the numbers in it"

    @_naming
    def write(self, point: int, first: int, rows: Words) -> None:
        """Commit the rows of a task, in one step."""
        signed = [
            np.concatenate([row, np.frombuffer(self._digest(point, first + i, row), np.uint64)])
            for i, row in enumerate(rows)
        ]
        self.words[point, first : first + len(rows)] = np.stack(signed)

    def there(self, point: int) -> set[int]:
        """Return which tasks of a point have a chunk, whatever is in it."""
        folder = self.path / "tasks" / "words" / "c" / str(point)
        try:
            return {int(entry.name) for entry in os.scandir(folder) if entry.name.isdecimal()}
        except FileNotFoundError:
            return set()

    def _digest(self, point: int, batch: int, row: Words) -> bytes:
        place = point.to_bytes(8, "little") + batch.to_bytes(8, "little")
        digest = hashlib.blake2b(self.study + place, digest_size=8 * DIGEST)
        digest.update(np.ascontiguousarray(row).data)
        return digest.digest()

    @_naming
    def ensure(self, found: xr.Dataset, design: Design) -> None:
        """Make the arrays of the results, if they are not there, from what was found at a point."""
        for name, variable in found.variables.items():
            if name in self._ensured:
                continue
            own = name in found.data_vars and not _is_common(str(name), variable)
            dims = (*design.dims, *map(str, variable.dims)) if own else tuple(map(str, variable.dims))
            shape = (*design.shape, *variable.shape) if own else variable.shape
            if str(name) in self.group:
                check_array(self.group, str(name), shape, variable.dtype, "same_kind")
                self._ensured.add(str(name))
                continue
            chunks = _chunks(design, variable) if own else shape
            with contextlib.suppress(FileExistsError, ValueError):  # another worker was faster
                array = self.group.create_array(
                    str(name),
                    shape=shape,
                    chunks=tuple(max(1, n) for n in chunks),
                    dtype=variable.dtype,
                    dimension_names=dims,
                    attributes={**_plain(variable.attrs), "coordinates": " ".join(_coordinates(design))}
                    if own and _coordinates(design)
                    else _plain(variable.attrs),
                    compressors=fast(variable.dtype.itemsize),
                    fill_value=np.nan if variable.dtype.kind == "f" else 0,
                )
                if not own:
                    array[...] = variable.to_numpy()

    @_naming
    def restore(self, found: xr.Dataset, design: Design) -> None:
        """Write what is the same at every point again, where it is not what it should be."""
        wanted = {axis.name: np.array(axis.values, dtype=np.float64) for axis in design.axes}
        for name, variable in found.variables.items():
            if name not in found.data_vars or _is_common(str(name), variable):
                wanted[str(name)] = variable.to_numpy()
        for name, values in wanted.items():
            try:
                same = np.array_equal(np.asarray(self.group[name][...]), values)
            except (PermissionError, KeyError):
                raise
            except Exception:  # cut or spoilt
                same = False
            if not same:
                self.group[name][...] = values

    @_naming
    def write_large(self, found: xr.Dataset, place: tuple[int, ...]) -> None:
        """Write the variables that have a chunk for each point."""
        for name in large(found):
            self.group[name][place] = found.variables[name].to_numpy()

    def read_large(self, names: list[str], place: tuple[int, ...]) -> dict[str, npt.NDArray[Any]] | None:
        """Read them back; None if they are not there, or damaged."""
        try:
            return {name: np.asarray(self.group[name][place]) for name in names}
        except PermissionError:
            raise
        except Exception:
            return None

    def arrays(self) -> Iterator[tuple[str, Any]]:
        """Give the arrays and their names; what else is in the folder is passed over."""
        import zarr

        for name in sorted(os.listdir(self.path)):
            if name not in self._arrays and (self.path / name / "zarr.json").is_file():
                self._arrays[name] = self.group[name]
            if isinstance(self._arrays.get(name), zarr.Array):
                yield name, self._arrays[name]

    @_naming
    def large_arrays(self, design: Design) -> list[str]:
        """Name the arrays that have a chunk for each point."""
        own = len(design.shape)
        return [
            name
            for name, array in self.arrays()
            if array.shape[:own] == design.shape and math.prod(array.shape[own:]) >= _LARGE
        ]

    @_naming
    def consolidate(self) -> None:
        """Put the metadata of all arrays in one place, so that the store opens at once."""
        import zarr

        from restitution.study._folder import Folder

        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore"
            )  # consolidation is not in the specification of format 3, and Xarray uses it
            zarr.consolidate_metadata(Folder(self.path), zarr_format=3)


def large(found: xr.Dataset) -> list[str]:
    """Name the variables that have a chunk for each point."""
    return sorted(name for name, v in _own(found) if _is_large(v))


def small(found: xr.Dataset) -> list[str]:
    """Name the other variables that every point has."""
    return sorted(name for name, v in _own(found) if not _is_large(v) and not _is_common(name, v))


def common(found: xr.Dataset) -> list[str]:
    """Name the variables that are the same at every point."""
    return sorted(name for name, v in _own(found) if _is_common(name, v))


def _own(found: xr.Dataset) -> Iterator[tuple[str, xr.Variable]]:
    """Give the variables that are not coordinates, as they are: a DataArray of each takes longer to make."""
    return ((str(name), v) for name, v in found.variables.items() if name not in found.coords)


def fast(size: int) -> Any:
    """Choose a compressor that costs next to nothing; most of what is stored are small numbers and zeros."""
    from zarr.codecs import BloscCodec

    return BloscCodec(cname="lz4", clevel=5, shuffle="shuffle", typesize=size)


def _is_common(name: str, variable: Any) -> bool:
    """Whether a variable is the same at every point: edges of bins."""
    return name.endswith("_edges") and variable.dims == (f"{name[:-1]}",)


def _is_large(variable: Any) -> bool:
    return bool(variable.size >= _LARGE)


def _chunks(design: Design, variable: Any) -> tuple[int, ...]:
    if _is_large(variable):
        return (*(1 for _ in design.shape), *variable.shape)
    room = _CHUNK // max(1, variable.size * variable.dtype.itemsize)
    sizes = []
    for size in reversed(design.shape):
        sizes.append(min(size, room))
        room = max(1, room // size)
    return (*reversed(sizes), *variable.shape)


def _coordinates(design: Design) -> list[str]:
    """Name what Xarray must treat as coordinates: parameters of a design that is not a grid."""
    return [] if design.kind == "grid" else [axis.name for axis in design.axes]


def _plain(attrs: Mapping[Any, Any]) -> dict[str, Any]:
    return {
        str(key): value.tolist() if isinstance(value, np.ndarray) else value for key, value in attrs.items()
    }
