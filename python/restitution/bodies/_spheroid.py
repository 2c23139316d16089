"""An ellipsoid of revolution."""

from typing import Annotated, Self

from pydantic import Field

from restitution._internal.parameters import Number, ParameterError, in_terms_of, wrong
from restitution.bodies._body import Body
from restitution.bodies._hollow import Moments, Wall
from restitution.bodies._length_width import LengthWidth


class Spheroid(Body):
    """A homogeneous ellipsoid of revolution: prolate where ``polar`` is the longer semi-axis, else oblate.

    Parameters
    ----------
    equatorial : float
        Semi-axis across the axis of revolution, in m; finite and > 0.
    polar : float
        Semi-axis along the axis of revolution, in m; between 1/1000 and 1000 times ``equatorial``.
    density : float, default 2500
        Density in kg/m³; finite and > 0. Only mass and inertia depend on it, the motion does not.
    wall : float, optional
        Thickness of the wall of a hollow body, in m; at least 10⁻⁶ of the longer semi-axis and at
        most the shorter. The cavity is all that is farther below the surface; it is no spheroid.
        Mass and inertia are those of the wall.
    inertia : (float, float) or float, optional
        Moments of inertia across and about the axis, in kg m², instead of those of the matter, or one number
        for both; the second at most twice the first. Not together with ``wall``.

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
        """Make a spheroid with this length along the axis and this width across it.

        Parameters
        ----------
        length, width : float
            In m, > 0: twice the polar and twice the equatorial semi-axis.
        density : float
            In kg/m³, > 0.

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
        size = LengthWidth(length=length, width=width)
        if not 1e-3 <= size.length / size.width <= 1e3:
            allowed = f"between 1/1000 and 1000 times width = {size.width!r} (m)"
            raise ParameterError(wrong("length", length, allowed))
        with in_terms_of(length=length, width=width, density=density):
            return cls(equatorial=0.5 * size.width, polar=0.5 * size.length, density=density)

    @property
    def elongation(self) -> float:
        """Polar over equatorial semi-axis, all that the motion depends on of the shape; 1 is a sphere."""
        return self.polar / self.equatorial
