"""Solids of revolution: any profile, and cylinders, rings and eggs."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Unpack

import numpy as np
from pydantic import Field

from restitution._internal.arrays import FloatArray
from restitution._internal.parameters import Allowed, Number
from restitution.bodies._rigid import Density, FromRows, Length, Matter, OfMatter, rows

_PROFILE = "two or more points (z, r) in m, finite, r >= 0, around an area"


class Turned(Matter):
    """A solid of revolution about z of the body: circles, or bands, about its axis touch."""


class Revolution(FromRows, Turned):
    """A homogeneous solid of revolution with any profile.

    Its axis is z of the body. Only its convex hull touches the plane, with circular rims; `contact` numbers
    those of `rims`, from 1.

    Parameters
    ----------
    profile : array_like, shape (n, 2)
        Points (z, r) of its outline from end to end, in m, joined by straight lines; r ≥ 0 is the distance
        from the axis. A flat face closes one that ends off the axis, unless it ends at its first point.

    Examples
    --------
    >>> import restitution as rs
    >>> cone = rs.Revolution(profile=[(0, 4e-3), (12e-3, 0)])
    >>> cone.centre_of_mass.round(9).tolist()
    [0.0, 0.0, 0.003]
    """

    by_place: ClassVar[tuple[str, ...]] = ("profile",)
    _columns: ClassVar[tuple[str, ...]] = ("z", "r")

    profile: Annotated[
        Any,
        Allowed(_PROFILE),
        rows(_PROFILE, 2, 2, lambda points: (points >= 0.0) | [True, False]),
        Field(description="m"),
    ]

    if TYPE_CHECKING:  # or type checkers would take the fields for keyword arguments

        def __init__(self, profile: Any, **matter: Unpack[OfMatter]) -> None: ...

    @property
    def rims(self) -> FloatArray:
        """Where the rims of its convex hull are, (z, r) in m, from the end at the largest z; shape (n, 2)."""
        return np.array(self.compiled.rims)


class Cylinder(Turned):
    """A homogeneous cylinder with its axis along z of the body: a coin, a tablet, a rod.

    Parameters
    ----------
    radius, height : float
        In m; finite and > 0.

    Examples
    --------
    >>> import restitution as rs
    >>> coin = rs.Cylinder(radius=1e-2, height=2e-3)
    >>> round(coin.mass * 1e3, 4)  # g
    1.5708
    """

    by_place: ClassVar[tuple[str, ...]] = ("radius", "height")

    radius: Length
    height: Length
    density: Density = 2500.0

    if TYPE_CHECKING:

        def __init__(self, radius: float, height: float, **matter: Unpack[OfMatter]) -> None: ...


class Ring(Turned):
    """A homogeneous ring, or washer, or tube, with its axis along z of the body.

    Parameters
    ----------
    outer, inner, height : float
        Outer and inner radius and height, in m; finite and > 0, the inner radius below the outer one.

    Examples
    --------
    >>> import numpy as np, restitution as rs
    >>> washer = rs.Ring(outer=10e-3, inner=5e-3, height=2e-3)
    >>> bool(np.isclose(washer.mass, 2500 * np.pi * (10e-3**2 - 5e-3**2) * 2e-3))
    True
    """

    by_place: ClassVar[tuple[str, ...]] = ("outer", "inner", "height")

    outer: Length
    inner: Length
    height: Length
    density: Density = 2500.0

    if TYPE_CHECKING:

        def __init__(self, outer: float, inner: float, height: float, **matter: Unpack[OfMatter]) -> None: ...


class TruncatedCone(Turned):
    """A homogeneous truncated cone, or cone, with its axis along z of the body: a cup, a bullet, a bead.

    Its base is at z = 0 of the body.

    Parameters
    ----------
    base : float
        Radius of the face at z = 0, in m; finite and > 0.
    top : float
        Radius of the other face, in m; finite and >= 0. With 0 it is a cone.
    height : float
        Distance of the faces, in m; finite and > 0.

    Examples
    --------
    >>> import restitution as rs
    >>> cone = rs.TruncatedCone(base=4e-3, top=0.0, height=12e-3)
    >>> cone.centre_of_mass.round(9).tolist()
    [0.0, 0.0, 0.003]
    """

    by_place: ClassVar[tuple[str, ...]] = ("base", "top", "height")

    base: Length
    top: Annotated[Number, Field(ge=0, description="m")]
    height: Length
    density: Density = 2500.0

    if TYPE_CHECKING:

        def __init__(self, base: float, top: float, height: float, **matter: Unpack[OfMatter]) -> None: ...


class Egg(Turned):
    """A homogeneous egg: two spherical caps, joined by an arc that is tangent to both.

    It stands on its blunt end at z = 0 of the body. `contact` is 1 at the tip, 2 at the flank, 3 at the blunt
    end.

    Parameters
    ----------
    length, width : float
        In m; finite and > 0, the width at most the length.
    blunt_end, tip : float
        Radii of curvature at the ends in m; > 0 and at most half of the width, one of them less.

    Examples
    --------
    >>> import restitution as rs
    >>> egg = rs.Egg(length=57e-3, width=44e-3, blunt_end=20e-3, tip=14e-3, density=1050.0)
    >>> round(egg.mass * 1e3, 1)  # g
    59.6
    """

    length: Length
    width: Length
    blunt_end: Length
    tip: Length
    density: Density = 2500.0
