"""Bodies of revolution whose hull has a closed form, and the parameters that they share."""

from typing import Annotated, Any, Self

import numpy as np
from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError, ValidationInfo

from restitution._internal.arrays import positive
from restitution._internal.parameters import Allowed, Number, ParameterError, in_terms_of, wrong
from restitution.bodies._body import Body

_POSITIVE = "a finite number > 0"
_EACH = f"{_POSITIVE} (or one for each sphere)"
_MOMENTS = "(transverse, axial), each > 0 in kg m², or one number for both, or None"
_number = TypeAdapter(Annotated[Number, Field(gt=0)])


def _positive(value: Any) -> float | None:
    try:
        return _number.validate_python(value)
    except ValidationError:
        return None


def _one_or_two(allowed: str, *, or_none: bool = False) -> BeforeValidator:
    """Take a positive number, or two."""

    def checked(value: Any, about: ValidationInfo) -> Any:
        if value is None and or_none:
            return None
        name = str(about.field_name)
        if isinstance(value, np.ndarray) and value.shape == (2,):
            value = value.tolist()
        given = [(name, value, allowed)]
        if two := isinstance(value, list | tuple) and len(value) == 2:
            given = [(f"{name}[{index}]", part, _POSITIVE) for index, part in enumerate(value)]
        numbers = [_positive(part) for _, part, _ in given]
        if None in numbers:
            problems = zip(given, numbers, strict=True)
            raise ParameterError(*(wrong(*one) for one, number in problems if number is None))
        return tuple(numbers) if two else numbers[0]

    return BeforeValidator(checked)


PositivePair = Annotated[float | tuple[float, float], Allowed(_EACH), _one_or_two(_EACH)]
"""One positive number for both spheres, or a pair: that of sphere 1 and that of sphere 2."""
Moments = Annotated[
    float | tuple[float, float] | None,
    Allowed(_MOMENTS),
    _one_or_two(_MOMENTS, or_none=True),
    Field(description="kg m²"),
]
"""Moments of inertia across and about the axis; None for those of the matter."""
Wall = Annotated[Number | None, Field(gt=0, description="m"), Allowed("a finite number > 0 (m), or None")]
"""Thickness of the wall of a hollow body; None of a full one."""


class Dumbbell(Body):
    """Two spheres whose centres are ``separation`` apart; equal ones are the paper's body (Sec. II).

    Where the spheres overlap the body is their union, cut at the plane of their intersection, each side with
    its sphere's density. Where they do not, beyond the paper, it is two full spheres on a massless rod; where
    one contains the other it is that one. ``separation = 0`` is a sphere. The axis points from sphere 2 to
    sphere 1. Mass and inertia of equal spheres are (A3), (A5) with L⁵/160 for L⁵/180, and (A8).

    Parameters
    ----------
    radius : float or (float, float)
        Radius R of either sphere, or of sphere 1 and of sphere 2, in m; finite and > 0.
    separation : float
        Distance L between the two centres, in m; finite and >= 0.
    density : float or (float, float), default 2500
        Density of both spheres, or of sphere 1 and of sphere 2, in kg/m³; finite and > 0. If it is the same,
        the motion does not depend on it.
    wall : float, optional
        Thickness of the wall of a hollow body, in m; at least 10⁻⁶ R and at most the larger radius. Spheres
        whose radii are shorter by it are missing then, and mass and inertia are those of the wall. Left out
        where both radius and density differ.

    Examples
    --------
    >>> import restitution as rs
    >>> round(rs.Dumbbell(radius=3e-3, separation=3e-4).elongation, 12)
    0.1
    >>> round(rs.Dumbbell.from_length_width(6.3e-3, 6e-3).elongation, 9)
    0.1
    >>> club = rs.Dumbbell(radius=(3e-3, 2e-3), separation=4e-3, density=(2500, 7800))
    >>> round(club.centre_of_mass, 6)  # towards sphere 1, which is heavier
    0.0001
    """

    radius: Annotated[PositivePair, Field(description="m")]
    separation: Annotated[Number, Field(ge=0, description="m")]
    density: Annotated[PositivePair, Field(description="kg/m³")] = 2500.0
    wall: Wall = None
    inertia: Moments = None

    @classmethod
    def from_length_width(
        cls, length: float, width: float, *, density: float | tuple[float, float] = 2500.0
    ) -> Self:
        """Make equal spheres whose length along the axis, L + 2R, and width across it, 2R, are given in m.

        Raises
        ------
        ValueError
            If a value is out of range, or the length less than the width; the message names it.
        """
        long, wide = positive("length", length, "m"), positive("width", width, "m")
        if long < wide:
            raise ParameterError(wrong("length", long, f">= width = {wide!r} (m)"))
        with in_terms_of(length=length, width=width, density=density):
            return cls(radius=0.5 * wide, separation=long - wide, density=density)

    @property
    def radii(self) -> tuple[float, float]:
        """Radii of sphere 1 and sphere 2, in m."""
        return _both(self.radius)

    @property
    def densities(self) -> tuple[float, float]:
        """Densities of sphere 1 and sphere 2, in kg/m³."""
        return _both(self.density)

    @property
    def is_equal(self) -> bool:
        """Tell if both spheres are the same, as in the paper."""
        return self.radii[0] == self.radii[1] and self.densities[0] == self.densities[1]

    @property
    def elongation(self) -> float:
        """L/R, R the radius of sphere 1; of equal spheres the only number that the motion depends on."""
        return self.separation / self.radii[0]

    @property
    def centre_of_mass(self) -> float:
        """Place of the centre of mass on the axis, from the middle of both centres towards sphere 1, in m."""
        return self.compiled.centre_of_mass


def _both(value: float | tuple[float, float]) -> tuple[float, float]:
    """Return one value for each sphere."""
    return value if isinstance(value, tuple) else (value, value)


class Spherocylinder(Body):
    """A homogeneous cylinder with hemispherical caps: it touches like a `Dumbbell` and has its own inertia.

    Lying flat it touches with both caps only, one after the other, as a dumbbell does.

    Parameters
    ----------
    radius : float
        Radius R of the cylinder and of its caps, in m; finite and > 0.
    separation : float
        Distance L between the centres of the caps, the length of the cylinder, in m; finite and >= 0.
    wall : float, optional
        Thickness of the wall of a hollow body, in m; at least 10⁻⁶ R and at most R. The cavity is the
        spherocylinder of the radius R - wall. Mass and inertia are those of the wall.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.Spherocylinder(radius=3e-3, separation=6e-3)
    >>> body.elongation
    2.0
    """

    radius: Annotated[Number, Field(gt=0, description="m")]
    separation: Annotated[Number, Field(ge=0, description="m")]
    density: Annotated[Number, Field(gt=0, description="kg/m³")] = 2500.0
    wall: Wall = None
    inertia: Moments = None

    @property
    def elongation(self) -> float:
        """L/R, the only number of the shape that the motion depends on (dimensionless)."""
        return self.separation / self.radius


class Spheroid(Body):
    """A homogeneous ellipsoid of revolution: prolate where ``polar`` is the longer semi-axis, else oblate.

    Parameters
    ----------
    equatorial : float
        Semi-axis across the axis of revolution, in m; finite and > 0.
    polar : float
        Semi-axis along the axis of revolution, in m; between 1/1000 and 1000 times ``equatorial``.
    wall : float, optional
        Thickness of the wall of a hollow body, in m; at least 10⁻⁶ of the longer semi-axis and at
        most the shorter. The cavity is all that is farther below the surface; it is no spheroid. Mass and
        inertia are those of the wall.

    Examples
    --------
    >>> import restitution as rs
    >>> egg = rs.Spheroid(equatorial=2e-2, polar=3e-2)
    >>> egg.elongation
    1.5
    """

    equatorial: Annotated[Number, Field(gt=0, description="m")]
    polar: Annotated[Number, Field(gt=0, description="m")]
    density: Annotated[Number, Field(gt=0, description="kg/m³")] = 2500.0
    wall: Wall = None
    inertia: Moments = None

    @classmethod
    def from_length_width(cls, length: float, width: float, *, density: float = 2500.0) -> Self:
        """Make a spheroid whose length along the axis and width across it, in m, are twice its semi-axes.

        Raises
        ------
        ValueError
            If a value is out of range; the message names it.

        Examples
        --------
        >>> import restitution as rs
        >>> rs.Spheroid.from_length_width(6e-2, 4e-2).elongation
        1.5
        """
        long, wide = positive("length", length, "m"), positive("width", width, "m")
        if not 1e-3 <= long / wide <= 1e3:
            allowed = f"between 1/1000 and 1000 times width = {wide!r} (m)"
            raise ParameterError(wrong("length", length, allowed))
        with in_terms_of(length=length, width=width, density=density):
            return cls(equatorial=0.5 * wide, polar=0.5 * long, density=density)

    @property
    def elongation(self) -> float:
        """Polar over equatorial semi-axis, all that the motion depends on of the shape; 1 is a sphere."""
        return self.polar / self.equatorial


class LoadedSphere(Body):
    """A homogeneous sphere with a point mass inside: round, but with its centre of mass off the centre.

    The axis points from the centre to the load, so that θ = π is the position of rest.

    Parameters
    ----------
    radius : float
        Radius R, in m; finite and > 0.
    density : float, default 2500
        Density of the sphere without its load, in kg/m³; finite and > 0.
    load : float
        Mass of the load, in kg; finite and >= 0.
    offset : float
        Distance of the load from the centre, in m; in [0, radius].
    wall : float, optional
        Thickness of the wall of a hollow body, in m; at least 10⁻⁶ R and at most R. The load comes on top.
        Mass and inertia are those of the wall.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.LoadedSphere(radius=3e-3, density=2500, load=1e-4, offset=2e-3)
    >>> round(body.centre_of_mass, 6)
    0.000523
    """

    radius: Annotated[Number, Field(gt=0, description="m")]
    density: Annotated[Number, Field(gt=0, description="kg/m³")] = 2500.0
    load: Annotated[Number, Field(ge=0, description="kg")]
    offset: Annotated[Number, Field(ge=0, description="m")]
    wall: Wall = None
    inertia: Moments = None

    @property
    def centre_of_mass(self) -> float:
        """Distance of the centre of mass from the centre of the sphere, towards the load, in m."""
        return self.compiled.centre_of_mass
