"""The base of the rigid bodies of any shape."""

import os
import warnings
from abc import abstractmethod
from collections.abc import Callable, Iterator
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar, Self, TypedDict

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field, ValidationInfo

from restitution import _core
from restitution._internal import files
from restitution._internal import text as _text
from restitution._internal.arrays import FloatArray, check_each, real, reals
from restitution._internal.parameters import (
    Allowed,
    Number,
    ParameterError,
    Problem,
    renamed,
    shown,
    wrong,
)
from restitution.bodies._body import AnyBody
from restitution.bodies._clump_files import rows_in

Density = Annotated[Number, Field(gt=0, description="kg/m³")]
Length = Annotated[Number, Field(gt=0, description="m")]
SMALLEST, LARGEST = 1e-60, 1e60
"""Sizes in m whose fifth power is a number."""
Rows = tuple[tuple[float, ...], ...]
_TENSOR = "None or a symmetric matrix, shape (3, 3), in kg m²"
_CENTRE = "None or (x, y, z), finite, in m"
_HALF = np.sqrt(0.5)
_FACES = np.array(
    [
        (1.0, 0.0, 0.0, 0.0),
        (0.0, 1.0, 0.0, 0.0),
        (_HALF, _HALF, 0.0, 0.0),
        (_HALF, -_HALF, 0.0, 0.0),
        (_HALF, 0.0, _HALF, 0.0),
        (_HALF, 0.0, -_HALF, 0.0),
    ]
)
"""Attitudes with each axis of the body up or down."""


def directions(number: int) -> FloatArray:
    """Return unit vectors, shape (number, 3), evenly all around: a spiral that turns by the golden angle."""
    place = np.arange(number) + 0.5
    polar, azimuth = np.arccos(1.0 - 2.0 * place / number), np.pi * (1.0 + 5.0**0.5) * place
    level = np.sin(polar)
    return np.stack([np.cos(azimuth) * level, np.sin(azimuth) * level, np.cos(polar)], axis=1)


def scale_of(scale: Any) -> float:
    """Take what a unit of a file is in m."""
    return real("scale", scale, "a finite number > 0 (m)", lambda x: 0.0 < x < np.inf)


def ask_of_scale(place: Path, scale: float, table: FloatArray) -> None:
    """Warn of a file whose lengths are rather in mm."""
    size = float(np.abs(table).max())
    if scale == 1.0 and size > 1.0:
        text = f"{place}: lengths are in m, and the body is {size:g} m in size; scale=1e-3?"
        warnings.warn(text, UserWarning, stacklevel=3)


def rows(
    allowed: str, columns: int, least: int, good: Callable[[FloatArray], NDArray[np.bool_]] | None = None
) -> BeforeValidator:
    """Take a table with so many columns and at least so many rows, and numbers that are `good`."""

    def checked(value: Any, about: ValidationInfo) -> Rows:
        table = reals(str(about.field_name), value, allowed, unit="m", dimensions=(2,))
        if table.shape[0] < least or table.shape[1] != columns:
            raise ParameterError(wrong(str(about.field_name), value, allowed))
        if good is not None:
            check_each(str(about.field_name), table, good(table), allowed)
        return tuple(map(tuple, table.tolist()))

    return BeforeValidator(checked)


def several(allowed: str, count: int, unit: str | None) -> BeforeValidator:
    """Take so many numbers."""

    def checked(value: Any, about: ValidationInfo) -> tuple[float, ...]:
        numbers = reals(str(about.field_name), value, allowed, unit=unit, dimensions=(1,))
        if numbers.shape != (count,):
            raise ParameterError(wrong(str(about.field_name), value, allowed))
        return tuple(numbers.tolist())

    return BeforeValidator(checked)


def tensor_of(value: Any, allowed: str = _TENSOR) -> Rows:
    """Check that a tensor of inertia is a symmetric matrix."""
    tensor = reals("inertia", value, allowed, unit="kg m2", dimensions=(2,))
    if tensor.shape != (3, 3) or not np.allclose(tensor, tensor.T, rtol=1e-9, atol=0.0):
        raise ParameterError(wrong("inertia", value, allowed))
    return tuple(map(tuple, (0.5 * (tensor + tensor.T)).tolist()))


def _tensor(value: Any) -> Rows | None:
    return None if value is None else tensor_of(value)


def _centre(value: Any, about: ValidationInfo) -> tuple[float, ...] | None:
    if value is None:
        return None
    inertia = about.data.get("inertia", ())  # not there where it is wrong itself
    if inertia is None or isinstance(inertia, str):
        text = f" = {shown(value)}, inertia = {inertia!r}: must be "
        raise ParameterError(
            Problem("centre", text, "left out, or given with the tensor of inertia about it")
        )
    centre = reals("centre", value, _CENTRE, unit="m", dimensions=(1,))
    if centre.shape != (3,):
        raise ParameterError(wrong("centre", value, _CENTRE))
    return tuple(centre.tolist())


Tensor = Annotated[Any, Allowed(_TENSOR), BeforeValidator(_tensor), Field(description="kg m²")]
"""A tensor of inertia that is given; None for that of homogeneous matter."""
Centre = Annotated[Any, Allowed(_CENTRE), BeforeValidator(_centre), Field(description="m")]
"""The centre of mass, where a tensor of inertia is given."""


class RigidBody(AnyBody):
    """A rigid body of any shape.

    Its attitude is the rotation from the axes that it is given in to those of space.
    """

    @cached_property
    def compiled(self) -> _core.Rigid:
        made: _core.Rigid = _core.body(type(self).__name__, self._arguments())
        return made

    def _arguments(self) -> list[Any]:
        return [plain(value) for value in super()._arguments()]

    @property
    def lowest_position(self) -> float:
        """Least height of the centre of mass over the plane with an axis of the body upright, in m."""
        return min(self.compiled.lowest(face[None]) for face in _FACES)

    @property
    def centre_of_mass(self) -> FloatArray:
        """Place of the centre of mass in the axes that the body is given in, in m, shape (3,)."""
        return np.array(self.compiled.centre)

    @property
    def inertia_tensor(self) -> FloatArray:
        """Tensor of inertia about the centre of mass, in the same axes, in kg m², shape (3, 3)."""
        return np.array(self.compiled.inertia_tensor)

    @property
    def principal_moments(self) -> FloatArray:
        """The three principal moments of inertia, in kg m²."""
        return np.array(self.compiled.principal_moments)

    def attributes(self) -> dict[str, Any]:
        """Return every parameter under its own name, rows of tables one after the other."""
        return {
            name: np.ravel(value).tolist() if isinstance(value, tuple) else value
            for name, value in super().attributes().items()
        }

    def _rows(self) -> Iterator[tuple[str, str]]:
        yield from super()._rows()
        for number, moment in enumerate(self.principal_moments, start=1):
            yield f"principal moment {number}", _text.value(float(moment), "kg m²")


class Matter(RigidBody):
    """A body that is homogeneous, unless its inertia is given.

    Parameters
    ----------
    density : float, default 2500
        Density in kg/m³; finite and > 0. Only mass and inertia depend on it, the motion does not.
    inertia : array_like, shape (3, 3), optional
        Tensor of inertia about the centre of mass in kg m², in the axes of the body, where the matter is not
        homogeneous. The mass stays that of the density.
    centre : array_like, shape (3,), optional
        Its centre of mass in m, where a tensor of inertia is given; that of homogeneous matter if left out.
    """

    inertia: Tensor = None
    centre: Centre = None


class OfMatter(TypedDict, total=False):
    """Keyword arguments of every such body, for type checkers where others may be given by place."""

    density: float
    inertia: Any
    centre: Any


class FromFile(Matter):
    """A body whose shape a file may hold."""

    @classmethod
    @abstractmethod
    def _shape(cls, place: Path, scale: float) -> dict[str, Any]:
        """Read the parameters of the shape, the places in it first, from a file in units of `scale` m."""

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        *,
        scale: float = 1.0,
        density: float = 2500.0,
        inertia: Any = None,
        centre: Any = None,
    ) -> Self:
        """Read the shape from a file.

        Parameters
        ----------
        path : str or path-like
            Of points or a profile a text file, numbers with spaces or commas between them, ``#`` before a
            comment; of a mesh STL, OBJ or PLY, in which vertices at the same place are one.
        scale : float, default 1
            What a unit of the file is in m: 1e-3 for millimetres. > 0.
        density, inertia, centre
            As those of the body.

        Raises
        ------
        ValueError
            For another file, a malformed row or an open surface, or without trimesh (``restitution[mesh]``).
        OSError
            If the file cannot be read.
        """
        unit, place = scale_of(scale), files.path_from("path", path)
        shape = cls._shape(place, unit)
        ask_of_scale(place, unit, next(iter(shape.values())))
        given = shape | {"density": density, "inertia": inertia, "centre": centre}
        with renamed(lambda name: f"{place}: {name}" if name.partition("[")[0] in shape else name):
            return cls(**given)


class FromRows(FromFile):
    """A body whose first parameter is a table of places in m."""

    _columns: ClassVar[tuple[str, ...]]
    density: Density = 2500.0

    @classmethod
    def _shape(cls, place: Path, scale: float) -> dict[str, Any]:
        return {cls.by_place[0]: scale * np.array(rows_in(place, cls._columns))}


def plain(value: Any) -> Any:
    """Write a parameter as the core takes it: a table row by row, a distribution with its numbers."""
    if not isinstance(value, tuple):
        return value
    drawn = isinstance(value[0], str)
    return (value[0], list(value[1:])) if drawn else np.ravel(np.array(value, dtype=np.float64))
