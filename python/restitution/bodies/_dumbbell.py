"""Two spheres, equal or not."""

from typing import Annotated, Self

from pydantic import Field

from restitution._internal.arrays import positive
from restitution._internal.parameters import Number, ParameterError, in_terms_of, wrong
from restitution.bodies._body import Body
from restitution.bodies._given import Moments, PositivePair, Wall


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
