"""Bodies: what falls."""

from functools import cached_property
from typing import Annotated

from pydantic import Field, model_validator

from restitution import _core
from restitution._parameters import Number, ParameterError, Parameters, Problem


class Dumbbell(Parameters):
    """Two equal spheres whose centres are ``separation`` apart, homogeneous (the paper, Sec. II).

    For ``separation < 2 * radius`` the body is the union of the overlapping spheres; beyond that, where the
    paper stops, it is two full spheres on a massless rod. ``separation = 0`` is a sphere.

    Parameters
    ----------
    radius : float
        Radius R of either sphere, in m; finite and > 0.
    separation : float
        Distance L between the two centres, in m; finite and >= 0.
    density : float, default 2500
        Density in kg/m³; finite and > 0. Only `mass`, `transverse_inertia` and `axial_inertia` depend on it.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4, density=2500.0)
    >>> round(body.elongation, 12)
    0.1
    """

    radius: Annotated[Number, Field(gt=0, description="m")]
    separation: Annotated[Number, Field(ge=0, description="m")]
    density: Annotated[Number, Field(gt=0, description="kg/m³")] = 2500.0

    @model_validator(mode="after")
    def _representable(self) -> "Dumbbell":
        try:
            _core.dumbbell_inertia(self.radius, self.separation, self.density)
        except ValueError:
            given = f" = {self.radius}, separation = {self.separation}, density = {self.density}"
            allowed = "such that mass and inertia neither overflow nor underflow"
            raise ParameterError(Problem("radius", f"{given}: must be {allowed}")) from None
        return self

    @property
    def elongation(self) -> float:
        """L/R, the only number of the shape that the motion depends on (dimensionless)."""
        return self.separation / self.radius

    @property
    def mass(self) -> float:
        """Mass m in kg (Eq. A3)."""
        return self._inertia[0]

    @property
    def transverse_inertia(self) -> float:
        """Moment of inertia J_xx across the symmetry axis, in kg m² (Eq. A8)."""
        return self._inertia[1]

    @property
    def axial_inertia(self) -> float:
        """Moment of inertia J_zz about the symmetry axis, in kg m² (Eq. A5 with L⁵/160 for L⁵/180)."""
        return self._inertia[2]

    @cached_property
    def _inertia(self) -> tuple[float, float, float]:
        return _core.dumbbell_inertia(self.radius, self.separation, self.density)
