"""An ellipsoid of revolution."""

from typing import Annotated

from pydantic import Field

from restitution import _core
from restitution._parameters import Number
from restitution.bodies._body import Body


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

    @property
    def solid(self) -> _core.Solid:
        """The body as the core knows it."""
        return _core.spheroid(self.equatorial, self.polar, self.density)

    @property
    def elongation(self) -> float:
        """Polar over equatorial semi-axis, all that the motion depends on of the shape; 1 is a sphere."""
        return self.polar / self.equatorial
