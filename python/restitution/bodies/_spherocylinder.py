"""A cylinder with hemispherical caps."""

from typing import Annotated

from pydantic import Field

from restitution._internal.parameters import Number
from restitution.bodies._body import Body
from restitution.bodies._given import Moments, Wall


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
