"""Bodies with asperities: small balls on their surface, placed at random."""

from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from pydantic import AfterValidator, BeforeValidator, Field, InstanceOf

from restitution import _core
from restitution._internal.arrays import FloatArray, reals
from restitution._internal.parameters import (
    Allowed,
    ParameterError,
    TooLargeError,
    Whole,
    wrong,
)
from restitution._internal.resources import available_memory
from restitution.bodies._axial import Dumbbell, LoadedSphere, Spherocylinder
from restitution.bodies._body import AnyBody
from restitution.bodies._clump import Clump
from restitution.bodies._rigid import Density, Length, RigidBody, plain

_HEIGHTS = (
    "None, a finite number >= 0 in m, one for each of the asperities, or one of "
    '("exponential", mean), ("normal", mean, deviation) and ("power", exponent, least, most)'
)
_PARAMETERS = {"exponential": 1, "normal": 2, "power": 3}
"""Count of the numbers that a distribution of heights has."""
_BYTES = 56
"""Memory of an asperity, at most."""
_ROUGHENED = (Dumbbell, LoadedSphere, Spherocylinder, Clump)
_BODIES = "a Dumbbell, LoadedSphere, Spherocylinder or Clump"


def _heights(value: Any) -> Any:
    if value is None:
        return None
    if isinstance(value, list | tuple) and value and isinstance(value[0], str):
        name, *numbers = value
        if _PARAMETERS.get(name) != len(numbers):
            raise ParameterError(wrong("heights", value, _HEIGHTS))
        numbers = reals("heights", numbers, _HEIGHTS, unit="m", dimensions=(1,)).tolist()
        return (name, *numbers)
    found = reals("heights", value, _HEIGHTS, unit="m", dimensions=(0, 1))
    if found.size == 0:
        raise ParameterError(wrong("heights", value, _HEIGHTS))
    return tuple(found.tolist()) if found.ndim else float(found)


def _body(value: Any) -> Any:
    if not isinstance(value, _ROUGHENED):
        raise ParameterError(wrong("body", value, _BODIES))
    return value


def _fits(asperities: int) -> int:
    if asperities > 10**6 and asperities * _BYTES > available_memory():
        allowed = f"as many as memory holds, at {_BYTES} bytes each"
        raise TooLargeError(wrong("asperities", asperities, allowed))
    return asperities


Asperities = Annotated[Whole, Field(ge=1, lt=2**31), AfterValidator(_fits)]
Heights = Annotated[Any, Allowed(_HEIGHTS), BeforeValidator(_heights), Field(description="m")]
Seed = Annotated[Whole, Field(ge=0, lt=2**64)]


def _inertia(compiled: _core.Solid | _core.Rigid) -> dict[str, Any]:
    """Return what the core takes as the inertia of a body."""
    if isinstance(compiled, _core.Rigid):
        return {"mass": compiled.mass, "centre": compiled.centre, "tensor": compiled.inertia_tensor}
    across, along = compiled.transverse_inertia, compiled.axial_inertia
    tensor = np.diag([across, across, along]).tolist()
    return {"mass": compiled.mass, "centre": [0.0, 0.0, compiled.centre_of_mass], "tensor": tensor}


def _spheres(body: AnyBody) -> tuple[tuple[float, ...], ...]:
    """Return the spheres that make the surface of a body, sphere 1 first."""
    if isinstance(body, Clump):
        return tuple(body.spheres)
    if isinstance(body, LoadedSphere):
        return ((0.0, 0.0, 0.0, body.radius),)
    assert isinstance(body, Dumbbell | Spherocylinder)
    half = 0.5 * body.separation
    one, other = body.radii if isinstance(body, Dumbbell) else (body.radius, body.radius)
    if half == 0.0:
        return ((0.0, 0.0, 0.0, max(one, other)),)
    return ((0.0, 0.0, half, one), (0.0, 0.0, -half, other))


class RoughSphere(RigidBody):
    """A homogeneous sphere with asperities: small balls, placed uniformly at random on its surface.

    What touches is an asperity or the sphere itself, which is number 1 in ``contact``; asperity i, from 0, is
    number i + 2. Mass and inertia are those of the sphere.

    Parameters
    ----------
    radius : float
        Radius R of the sphere, in m; finite and > 0.
    asperities : int
        Their number, in [1, 2³¹). Asperity i is the same whatever the number is. A million takes 50 MB.
    asperity_radius : float
        Radius ρ of each, in m; > 0 and at most R.
    heights : float, array_like or tuple, optional
        How far the tops stand above the surface, in m, >= 0, at most R and 2ρ: all alike, one each, or drawn
        from ``("exponential", mean)``, ``("normal", mean, deviation)`` where it is not negative, or
        ``("power", exponent, least, most)``, a density proportional to height to the power -exponent. ρ if
        it is left out: half-balls. Of a distribution, of which the mean or the least is at most 2ρ, single
        ones may be above 2ρ: tops of higher asperities, whose stems nothing touches.
    density : float, default 2500
        Density in kg/m³; finite and > 0. Only mass and inertia depend on it, the motion does not.
    seed : int, default 1
        Seed of places and heights, in [0, 2⁶⁴).

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.RoughSphere(radius=3e-3, asperities=1000, asperity_radius=1e-5)
    >>> body.asperity_balls.shape
    (1000, 4)
    """

    radius: Length
    asperities: Asperities
    asperity_radius: Length
    heights: Heights = None
    density: Density = 2500.0
    seed: Seed = 1

    @property
    def asperity_balls(self) -> FloatArray:
        """Centre and radius (x, y, z, ρ) of each asperity, in m, shape (asperities, 4)."""
        return self.compiled.balls()[-self.asperities :]

    def attributes(self) -> dict[str, Any]:
        """Return every parameter under its own name; that of the asperities' seed says whose it is."""
        found = super().attributes()
        return {"asperity_seed" if name == "seed" else name: value for name, value in _flat(found).items()}


class Rough(RigidBody):
    """A body of spheres with asperities: small balls, placed uniformly at random on its free surface.

    What touches is an asperity or a sphere of the body; the numbers in ``contact`` count the spheres first.
    Mass and inertia are those of the body. Its axes are those of a `Clump`; the axis of a body of revolution
    is z.

    Parameters
    ----------
    body : Dumbbell, LoadedSphere, Spherocylinder or Clump
        What is rough. Of a spherocylinder the barrel is so as well.
    asperities : int
        Their number, in [1, 2³¹). Asperity i is the same whatever the number is.
    asperity_radius : float
        Radius ρ of each, in m; > 0 and at most that of the smallest sphere of the body.
    heights : float, array_like or tuple, optional
        How far the tops stand above the surface, as for `RoughSphere`. ρ if it is left out.
    seed : int, default 1
        Seed of places and heights, in [0, 2⁶⁴).

    Examples
    --------
    >>> import restitution as rs
    >>> dumbbell = rs.Dumbbell(radius=3e-3, separation=3e-4)
    >>> body = rs.Rough(dumbbell, asperities=1000, asperity_radius=1e-5)
    >>> body.mass == dumbbell.mass
    True
    """

    by_place: ClassVar[tuple[str, ...]] = ("body",)

    body: Annotated[InstanceOf[AnyBody], Allowed(_BODIES), BeforeValidator(_body)]
    asperities: Asperities
    asperity_radius: Length
    heights: Heights = None
    seed: Seed = 1

    if TYPE_CHECKING:

        def __init__(
            self,
            body: AnyBody,
            *,
            asperities: int,
            asperity_radius: float,
            heights: Any = None,
            seed: int = 1,
        ) -> None: ...

    @cached_property
    def compiled(self) -> _core.Rigid:
        barrel = isinstance(self.body, Spherocylinder)
        spheres, inertia = _spheres(self.body), _inertia(self.body.compiled)
        own = (self.asperities, self.asperity_radius, plain(self.heights), self.seed)
        return _core.rough(spheres, barrel, inertia, *own)

    @property
    def asperity_balls(self) -> FloatArray:
        """Centre and radius (x, y, z, ρ) of each asperity, in m, shape (asperities, 4)."""
        return self.compiled.balls()[-self.asperities :]

    def attributes(self) -> dict[str, Any]:
        """Return every parameter under its own name, and those of the body that is rough under theirs."""
        own = {name: getattr(self, name) for name in ("asperities", "asperity_radius", "heights")}
        return {
            "rough_body": type(self.body).__name__,
            **self.body.attributes(),
            **_flat(own),
            "asperity_seed": self.seed,
        }


def _flat(values: dict[str, Any]) -> dict[str, Any]:
    """Leave out what is None, and write a distribution of heights as text."""
    found = {name: value for name, value in values.items() if value is not None}
    heights = found.get("heights")
    if isinstance(heights, list | tuple):
        drawn = isinstance(heights[0], str)
        found["heights"] = " ".join(map(str, heights)) if drawn else list(heights)
    return found
