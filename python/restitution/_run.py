"""The parameters of a run: one validation for `simulate`, `statistics` and the TOML file."""

from typing import Annotated, Any, ClassVar, Literal, get_args

import numpy as np
import numpy.typing as npt
from pydantic import BeforeValidator, Field, InstanceOf, model_validator

from restitution._parameters import Allowed, Number, ParameterError, Parameters, Problem, Whole, wrong
from restitution.bodies import Body
from restitution.laws import LAWS, Law

Orientation = Literal["uniform-angle", "isotropic"]

_ORIENTATIONS = "'uniform-angle', 'isotropic' or a 1-D array of angles in rad, one per particle"

_MOST_RADIANS = 2.0**20
"""Range of the engine's sine and cosine."""


def _orientation(value: Any) -> Any:
    if isinstance(value, str) and value in get_args(Orientation):
        return value
    try:
        angles = np.asarray(value)
    except ValueError:  # lists of different lengths
        angles = np.empty(())
    if angles.ndim != 1 or angles.dtype.kind not in "iuf":
        raise ParameterError(wrong("orientation", value, _ORIENTATIONS))
    angles = angles.astype(np.float64)
    beyond = np.flatnonzero(~(np.abs(angles) <= _MOST_RADIANS))
    if beyond.size:
        first = int(beyond[0])
        allowed = "a finite angle in rad, at most 2**20 either way"
        raise ParameterError(wrong(f"orientation[{first}]", float(angles[first]), allowed))
    angles.flags.writeable = False
    return angles


class Run(Parameters):
    """What `simulate` needs to know, checked.

    Parameters
    ----------
    body, law
        What falls and what an impact does.
    particles, impacts : int
        Number of particles and most impacts of each; > 0.
    release_height : float
        Height of the centre of mass at release, in m. No part of it may be below the plane.
    gravity : float
        Acceleration of gravity in m/s², > 0.
    orientation : {"uniform-angle", "isotropic"} or array of float, shape (particles,)
        Angle θ between symmetry axis and plane normal at release: uniform in [0, π), every direction alike,
        or given in rad.
    minimum_speed : float
        A particle ends when √(2 E_kin/m) after an impact falls below this, in m/s; 0 never does.
    seed : int
        Seed of the random numbers, in [0, 2⁶⁴).
    """

    body: Annotated[InstanceOf[Body], Allowed("a Dumbbell, LoadedSphere, Spherocylinder or Spheroid")]
    law: Annotated[InstanceOf[Law], Allowed(LAWS)]
    particles: Annotated[Whole, Field(ge=1, lt=2**40, description="number of particles")] = 1000
    impacts: Annotated[Whole, Field(ge=1, lt=2**40, description="most impacts of a particle")] = 400
    release_height: Annotated[Number, Field(gt=0, description="height of the centre of mass, m")] = 0.06
    gravity: Annotated[Number, Field(gt=0, description="m/s²")] = 9.81
    orientation: Annotated[Any, BeforeValidator(_orientation)] = "uniform-angle"
    minimum_speed: Annotated[Number, Field(ge=0, description="m/s; 0 never stops a particle")] = 0.0
    seed: Annotated[Whole, Field(ge=0, lt=2**64)] = 1

    NUMBERS: ClassVar = ("particles", "impacts", "release_height", "gravity", "minimum_speed")

    @model_validator(mode="after")
    def _nothing_below_the_plane(self) -> "Run":
        angles = self.angles
        if angles is not None and angles.size != self.particles:
            given = f"an array of {angles.size} angles"
            allowed = f"one angle per particle, and particles = {self.particles}"
            raise ParameterError(Problem("orientation", f" = {given}: must be {allowed}"))
        solid = self.body.solid
        lowest = solid.farthest() if angles is None else solid.lowest(np.cos(angles))
        # A body put down on the plane may be off by the rounding of its height.
        if self.release_height < lowest * (1.0 - 4.0 * np.finfo(np.float64).eps):
            allowed = f"at least {lowest!r} m, or a part of the body would reach below the plane"
            raise ParameterError(wrong("release_height", self.release_height, allowed))
        return self

    @property
    def angles(self) -> npt.NDArray[np.float64] | None:
        """The angles at release where they were given, in rad, shape (particles,)."""
        return None if isinstance(self.orientation, str) else self.orientation

    def parameters(self) -> dict[str, Any]:
        """Name every parameter as the core does."""
        return {
            "body": self.body.solid,
            "law": self.law.parameters(),
            **{name: getattr(self, name) for name in (*self.NUMBERS, "orientation", "seed")},
        }

    def attributes(self) -> dict[str, Any]:
        """Every parameter under its own name, as plain values that a netCDF file can hold."""
        return {
            "body": type(self.body).__name__,
            **self.body.model_dump(),
            "law": type(self.law).__name__,
            **self.law.attributes(),
            **{name: getattr(self, name) for name in self.NUMBERS},
            "orientation": self.orientation if self.angles is None else "given",
            "seed": np.uint64(self.seed),
        }
