"""The base of the bodies without a symmetry axis."""

from abc import abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field, ValidationInfo

from restitution import _core
from restitution._internal import text as _text
from restitution._internal.arrays import FloatArray, real, reals
from restitution._internal.parameters import Allowed, Number, ParameterError, Problem, shown, wrong
from restitution.bodies._body import AnyBody

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


@contextmanager
def of_lengths(**lengths: float) -> Iterator[None]:
    """Name the lengths of a body, where the points made of them have no volume that is a number."""
    try:
        yield
    except _core.ParameterError as error:
        if error.name not in ("points", "profile"):
            raise
        first, *others = (f"{name} = {length!r}" for name, length in lengths.items())
        name, _, value = first.partition(" = ")
        text = f" = {', '.join([value, *others])}: must be "
        allowed = "such that the volume neither overflows nor underflows"
        raise ParameterError(Problem(name, text, allowed)) from None


def scale_of(scale: Any) -> float:
    """Take what a unit of a file is in m."""
    return real("scale", scale, "a finite number > 0 (m)", lambda x: 0.0 < x < np.inf)


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
    @abstractmethod
    def compiled(self) -> _core.Rigid:
        """The body as the core knows it, made and checked once."""

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
    """A body that is homogeneous, unless its inertia is given."""

    inertia: Tensor = None
    centre: Centre = None

    @abstractmethod
    def _homogeneous(self) -> _core.Rigid:
        """Make the body of homogeneous matter."""

    @cached_property
    def compiled(self) -> _core.Rigid:
        """The body as the core knows it, made and checked once."""
        body = self._homogeneous()
        return body if self.inertia is None else with_inertia(body, self.inertia, self.centre)


def with_inertia(body: _core.Rigid, tensor: Rows, centre: tuple[float, ...] | None) -> _core.Rigid:
    """Give a body of the same mass a tensor of inertia, about another centre of mass or its own."""
    place = body.centre if centre is None else centre
    given = body.with_inertia({"mass": body.mass, "centre": place, "tensor": tensor})
    if (given.supports(directions(400)) <= 0.0).any():
        raise ParameterError(wrong("centre", place, "within the body (m)"))
    return given
