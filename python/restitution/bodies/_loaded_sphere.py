"""A sphere with an off-centre load."""

from typing import Annotated

from pydantic import Field

from restitution._internal.parameters import Number
from restitution.bodies._body import Body
from restitution.bodies._given import Moments, Wall


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
