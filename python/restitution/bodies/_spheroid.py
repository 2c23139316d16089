"""An ellipsoid of revolution."""

from typing import Annotated, Self

from pydantic import Field

from restitution._internal.arrays import positive
from restitution._internal.parameters import Number, ParameterError, in_terms_of, wrong
from restitution.bodies._body import Body
from restitution.bodies._given import Moments, Wall


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
