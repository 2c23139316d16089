"""Ellipsoids with three semi-axes."""

from functools import cached_property
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field

from restitution import _core
from restitution._internal.arrays import reals
from restitution._internal.parameters import Allowed, ParameterError, wrong
from restitution.bodies._rigid import Density, RigidBody

_AXES = "three finite numbers > 0 in m, the largest at most 1000 times the smallest"


def _semi_axes(value: Any) -> tuple[float, ...]:
    axes = reals("semi_axes", value, _AXES, unit="m", dimensions=(1,))
    if axes.shape != (3,) or not np.all(axes > 0.0) or axes.max() > 1000.0 * axes.min() * (1.0 + 1e-15):
        raise ParameterError(wrong("semi_axes", value, _AXES))
    return tuple(axes.tolist())


class Ellipsoid(RigidBody):
    """A homogeneous ellipsoid.

    Parameters
    ----------
    semi_axes : array_like, shape (3,)
        Semi-axes along x, y and z of the body, in m; > 0, the largest at most 1000 times the smallest.
    density : float, default 2500
        Density in kg/m³; finite and > 0. Only mass and inertia depend on it, the motion does not.

    Examples
    --------
    >>> import restitution as rs
    >>> pebble = rs.Ellipsoid(semi_axes=(3e-3, 2e-3, 1e-3))
    >>> round(pebble.mass * 1e6, 3)  # mg
    62.832
    """

    semi_axes: Annotated[Any, Allowed(_AXES), BeforeValidator(_semi_axes), Field(description="m")]
    density: Density = 2500.0

    @cached_property
    def compiled(self) -> _core.Rigid:
        """The body as the core knows it, made and checked once."""
        return _core.ellipsoid(self.semi_axes, self.density)
