"""The base of the bodies without a symmetry axis."""

from abc import abstractmethod
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from restitution import _core
from restitution._internal import text as _text
from restitution._internal.arrays import FloatArray, real
from restitution._internal.parameters import Number, ParameterError, Problem
from restitution.bodies._body import AnyBody

Density = Annotated[Number, Field(gt=0, description="kg/m³")]
Length = Annotated[Number, Field(gt=0, description="m")]
SMALLEST, LARGEST = 1e-60, 1e60
"""Sizes in m whose fifth power is a number."""
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
