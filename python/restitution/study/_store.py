"""The Zarr store of a study (format 3): what every task counted, and the labelled results.

The array ``tasks/words`` holds a row for each batch of each point: the words of a `_core.Histogram`. A task
writes its rows as one chunk, which takes its place in one step. Everything else in the store follows from
these rows. Every chunk has Zarr's checksum, CRC-32C: what is read back as it was not written ends the study
with an error that names what is to be deleted, and then is computed again.
"""

import contextlib
import errno
import math
import os
import re
import shutil
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.files import draft_of, there
from restitution._internal.parameters import Parameters
from restitution._internal.process import undisturbed
from restitution.drop.compare import unit_of
from restitution.drop.dataset import PAPER, made_here
from restitution.study._axes import Axis, Design
from restitution.study._identity import attribute, check, readable
from restitution.study._point import Words
from restitution.study._study import Study

_LARGE = 4096  # numbers of a variable at a point, from which on each point has a chunk of its own
_NO_WORD = 2**64 - 1
_CHUNK = 4_000_000  # bytes of a chunk of the other variables, at most where the shape allows it


def need_zarr() -> None:
    """Name the package to install where Zarr is missing or too old."""
    install = "pip install 'restitution[sweep]'"
    try:
        import zarr
    except ImportError:
        raise ImportError(f"parameter studies need zarr: {install}") from None
    if tuple(map(int, re.findall(r"\d+", zarr.__version__)[:3])) < (3, 1, 3):
        raise ImportError(f"parameter studies need zarr 3.1.3, not zarr {zarr.__version__}: {install}")
    if not __debug__:  # it reads metadata of groups in assertions
        raise RuntimeError("parameter studies: zarr does not work under python -O or PYTHONOPTIMIZE")


def create_or_open(path: Path, study: Study, words: int) -> "Store":
    """Open the store of a study, whose batches have so many words; make it first if nothing is there.

    Another study, another version of the physics, and what is no store are `Refused`.
    """
    if not there(path):
        _make(path, study, words)
    check(path, study)
    store = Store(path)
    store.check_layout(study, words)
    return store


def _make(path: Path, study: Study, width: int) -> None:
    """Move a new store to its place in one step, unless another has taken it meanwhile."""
    target = Path(os.path.realpath(path))
    draft = draft_of(target)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        # A signal within the first call would leave half a loop of asyncio, which complains at the end.
        with undisturbed(), readable(path):
            _fill(draft, study, width)
        os.rename(draft, target)
    except OSError as error:
        if not there(path):
            raise OSError(error.errno, error.strerror, str(path)) from error
    finally:
        shutil.rmtree(draft, ignore_errors=True)


def _fill(path: Path, study: Study, width: int) -> None:
    """Write the axes, the marks of the points, and room for the tasks."""
    import zarr

    effort, design = study.effort, study.design
    title = "Parameter study of the coefficient of restitution of bouncing aspherical bodies"
    about = made_here(title) | PAPER | attribute(study)
    group = zarr.create_group(str(path), zarr_format=3, attributes=about)
    for axis in design.axes:
        group.create_array(
            axis.name,
            data=np.array(axis.values, dtype=np.float64),
            chunks=(len(axis.values),),
            dimension_names=(axis.name,) if design.kind == "grid" else ("point",),
            attributes={
                "long_name": axis.parameter,
                "units": unit_at(study, axis.parameter),
                **_names(study, axis),
            },
            fill_value=np.nan,
            compressors=_compressed(8),
        )
    states: dict[str, Any] = {"flag_values": [0, 1], "flag_meanings": "unfinished finished"}
    group.create_array(
        "status",
        data=np.zeros(design.shape, dtype=np.uint8),
        chunks=design.shape,
        dimension_names=design.dims,
        attributes={"long_name": "state of the point", **states},
        compressors=_compressed(1),
    )
    group.create_group("tasks").create_array(
        "words",
        shape=(design.points, effort.blocks * effort.batches, width),
        chunks=(1, effort.task_batches, width),
        dtype=np.uint64,
        dimension_names=("point", "batch", "word"),
        compressors=_compressed(8),
        attributes={"long_name": "what each batch of particles counted"},
        fill_value=_NO_WORD,  # a chunk of nothing else is not written; zeros may be counted
    )
    Store(path).consolidate()


def _names(study: Study, axis: Axis) -> dict[str, Any]:
    """Return the names of several bodies, as the CF conventions write those of numbers."""
    if axis.parameter != "body":
        return {}
    words = ("_".join(name.split()) for name in study.bodies)
    return {"flag_values": list(axis.values), "flag_meanings": " ".join(words)}


def unit_at(study: Study, parameter: str) -> str:
    """Return the unit of a parameter, as its description has it; that of a list for its elements."""
    target: Any = study.base
    unit = "1"
    for part in parameter.removeprefix("run.").split("."):
        if not isinstance(target, Parameters):
            break
        unit, target = unit_of(type(target), part), getattr(target, part)
    return unit


class Store:
    """A store that is open: a directory, which every worker can reach under this name."""

    def __init__(self, path: Path) -> None:
        import zarr

        self.path = path
        self._ensured: set[str] = set()
        self._arrays: dict[str, Any] = {}  # those that were seen; what they are does not change
        self.group: Any
        self.words: Any
        with undisturbed(), readable(path):
            path.stat()  # Zarr would make a folder that is not there
            self.group = zarr.open_group(str(path), mode="r+", zarr_format=3, use_consolidated=False)
            self.words = self.group["tasks/words"]
            self.task_batches = int(self.words.chunks[1])

    def check_layout(self, study: Study, width: int) -> None:
        """Refuse tasks of other than `width` words, or other marks or axes than those of the study."""
        with readable(self.path):
            effort, design = study.effort, study.design
            _check_array(self.words, (design.points, effort.blocks * effort.batches, width), np.uint64)
            _check_array(self.group["status"], design.shape, np.uint8)
            for axis in design.axes:
                _check_array(self.group[axis.name], (len(axis.values),), np.float64)
            if self.words.chunks != (1, effort.task_batches, width):
                raise ValueError(f"the chunks of tasks/words are {self.words.chunks}")

    def there(self, point: int) -> set[int]:
        """Return which tasks of a point have a chunk, damaged or not."""
        return {int(file.parent.name) for file in self._chunks(str(point))}

    def number_there(self) -> int:
        """Count the tasks that have a chunk."""
        return sum(1 for _ in self._chunks("*"))

    def _chunks(self, point: str) -> Iterator[Path]:
        files = (self.path / "tasks" / "words" / "c").glob(f"{point}/*/0")
        return (file for file in files if file.parent.name.isdecimal())

    def file(self, point: int, task: int) -> Path:
        """Name the chunk of a task; the words of a batch are never divided."""
        return self.path / "tasks" / "words" / "c" / str(point) / str(task) / "0"

    def read(self, point: int, first: int, count: int) -> Words:
        """Read the rows of whole tasks of a point, which are there."""
        rows = np.zeros((count, self.words.shape[2]), np.uint64)
        for start in range(0, count, self.task_batches):
            file = self.file(point, (first + start) // self.task_batches)
            file.stat()  # Zarr would give what no chunk holds
            part = slice(start, start + self.task_batches)
            rows[part] = _read(self.words, (point, slice(first + part.start, first + part.stop)), file)
        return rows

    def write(self, point: int, first: int, rows: Words) -> None:
        """Commit the rows of a task, in one step."""
        with readable(self.path):
            self.words[point, first : first + len(rows)] = rows

    def ensure(self, found: xr.Dataset, design: Design) -> None:
        """Create an array for each variable of a point, and check the values common to all points."""
        with readable(self.path):
            for axis in design.axes:
                if axis.name not in self._ensured:
                    self._correct(axis.name, np.array(axis.values, dtype=np.float64))
                    self._ensured.add(axis.name)
            for name, variable in ((str(name), v) for name, v in found.variables.items()):
                if name in self._ensured:
                    continue
                own = name in found.data_vars and not _is_common(name, variable)
                shape = (*design.shape, *variable.shape) if own else variable.shape
                if name not in self._arrays and name not in self.group:
                    attrs = _plain(variable.attrs)
                    if own and design.kind != "grid":  # Xarray must be given the names of the coordinates
                        attrs["coordinates"] = " ".join(axis.name for axis in design.axes)
                    with contextlib.suppress(FileExistsError, ValueError):  # another worker was faster
                        self.group.create_array(
                            name,
                            shape=shape,
                            chunks=tuple(max(1, n) for n in (chunks(design, variable) if own else shape)),
                            dtype=variable.dtype,
                            dimension_names=(*(design.dims if own else ()), *map(str, variable.dims)),
                            attributes=attrs,
                            compressors=_compressed(variable.dtype.itemsize),
                            fill_value=np.nan if variable.dtype.kind == "f" else 0,
                        )
                _check_array(self._array(name), shape, variable.dtype)
                if not own:
                    self._correct(name, variable.to_numpy())
                self._ensured.add(name)

    def _correct(self, name: str, values: npt.NDArray[Any]) -> None:
        """Write an array again where it is not what it should be."""
        if not np.array_equal(self._values(name), values):
            self._array(name)[...] = values

    def _array(self, name: str) -> Any:
        if name not in self._arrays:
            self._arrays[name] = self.group[name]
        return self._arrays[name]

    def write_large(self, found: xr.Dataset, place: tuple[int, ...]) -> None:
        """Write the variables that have a chunk for each point."""
        with readable(self.path):
            for name in large(found):
                self._array(name)[place] = found.variables[name].to_numpy()

    def read_small(self, design: Design) -> dict[str, npt.NDArray[Any]]:
        """Read the smaller variables of all points."""
        with readable(self.path):
            own, axes = len(design.shape), {axis.name for axis in design.axes}
            return {
                name: self._values(name).reshape(design.points, *array.shape[own:])
                for name, array in self._by_point(design)
                if name not in axes and math.prod(array.shape[own:]) < _LARGE
            }

    def write_small(self, values: Mapping[str, npt.NDArray[Any]]) -> None:
        """Write them, the marks of what is finished last."""
        with readable(self.path):
            for name in sorted(values, key=lambda name: (name == "status", name)):
                array = self._array(name)
                array[...] = values[name].reshape(array.shape)
            self.consolidate()

    def _by_point(self, design: Design) -> Iterator[tuple[str, Any]]:
        """Return the arrays that have a value for each point; other files in the folder are ignored."""
        import zarr

        own = len(design.shape)
        for name in sorted(os.listdir(self.path)):
            there = name in self._arrays or (self.path / name / "zarr.json").is_file()
            array = self._array(name) if there else None
            if isinstance(array, zarr.Array) and array.shape[:own] == design.shape:
                names: Any = array.metadata.dimension_names or ()  # type: ignore[union-attr]
                if tuple(names[:own]) == design.dims:
                    yield name, array

    def _values(self, name: str) -> npt.NDArray[Any]:
        """Read an array."""
        return _read(self._array(name), ..., self.path / name / "c")

    def consolidate(self) -> None:
        """Put the metadata of all arrays in one place, so that the store opens at once."""
        with readable(self.path):
            import zarr

            with warnings.catch_warnings():
                # Consolidation is not in the specification of format 3, and Xarray uses it.
                warnings.simplefilter("ignore")
                zarr.consolidate_metadata(str(self.path), zarr_format=3)


def _read(array: Any, place: Any, path: Path) -> npt.NDArray[Any]:
    """Read what an array has at a place; one that is cut or spoilt, as any decoder finds it, is an error."""
    try:
        return np.asarray(array[place])
    except Exception as error:
        if isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno is not None):
            raise
        text = "is damaged; delete it, and the same command continues"
        raise OSError(errno.EIO, text, str(path)) from error


def _check_array(array: Any, shape: tuple[int, ...], kind: npt.DTypeLike) -> None:
    """Raise a ValueError for an array of another shape, or of another kind of numbers."""
    if array.shape != shape or array.dtype.kind != np.dtype(kind).kind:
        about = f"{array.dtype} of shape {array.shape} instead of {np.dtype(kind)} of shape {shape}"
        raise ValueError(f"{array.path} is {about}")


def large(found: xr.Dataset) -> list[str]:
    """Name the variables that have a chunk for each point."""
    return sorted(name for name, v in _own(found) if v.size >= _LARGE)


def small(found: xr.Dataset) -> list[str]:
    """Name the other variables that every point has."""
    return sorted(name for name, v in _own(found) if v.size < _LARGE and not _is_common(name, v))


def _own(found: xr.Dataset) -> Iterator[tuple[str, xr.Variable]]:
    """Return the variables that are not coordinates; a DataArray of each would take longer to make."""
    return ((str(name), v) for name, v in found.variables.items() if name not in found.coords)


def _is_common(name: str, variable: Any) -> bool:
    """Find out whether a variable is the same at every point: edges of bins are."""
    return name.endswith("_edges") and variable.dims == (f"{name[:-1]}",)


def _compressed(size: int) -> Any:
    """Choose a compressor that costs next to nothing: most of what is stored are small numbers and zeros."""
    from zarr.codecs import BloscCodec, Crc32cCodec

    return BloscCodec(cname="lz4", clevel=5, shuffle="shuffle", typesize=size), Crc32cCodec()


def chunks(design: Design, variable: Any) -> tuple[int, ...]:
    """Choose the chunks of a variable: a point each where it is large, else as many points as fit."""
    if variable.size >= _LARGE:
        return (*(1 for _ in design.shape), *variable.shape)
    room = _CHUNK // max(1, variable.size * variable.dtype.itemsize)
    sizes = []
    for size in reversed(design.shape):
        sizes.append(min(size, room))
        room = max(1, room // size)
    return (*reversed(sizes), *variable.shape)


def _plain(attrs: Mapping[Any, Any]) -> dict[str, Any]:
    return {
        str(key): value.tolist() if isinstance(value, np.ndarray) else value for key, value in attrs.items()
    }
