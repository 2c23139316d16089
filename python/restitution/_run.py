"""The parameters of a run: one validation for `simulate`, `statistics` and the TOML file."""

import math
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import ConfigDict, Field, InstanceOf, model_validator

from restitution._parameters import Allowed, Number, ParameterError, Parameters, Problem, Whole, wrong
from restitution._release import FloatArray, OrientationOfRun, RandomSpin, SpinOfRun, VelocityOfRun
from restitution.bodies import BODIES, Body
from restitution.laws import LAWS, Law


class Run(Parameters):
    """What `simulate` needs to know, checked.

    Parameters
    ----------
    body, law
        What falls and what an impact does.
    particles, impacts : int
        Number of particles and most impacts of each; > 0.
    release_height : float
        Distance of the centre of mass from the plane at release, in m. No part may be below the plane.
    gravity : float
        Acceleration of gravity in m/s², > 0.
    orientation : {"uniform-angle", "isotropic"} or array of float, shape (particles,) or (particles, 2)
        Angle θ between symmetry axis and plane normal at release: uniform in [0, π), every direction alike,
        or given in rad. The azimuth φ of the axis is uniform in [0, 2π), or given beside θ.
    spin : tuple of three floats, array of float, shape (particles, 3), or RandomSpin
        Angular velocity at release, in rad/s; the same for all, one each, or drawn at random.
    velocity : tuple of three floats
        Velocity of the centre of mass at release, in m/s.
    incline : float
        Angle in [0, π/2) by which the plane is inclined, in rad. In its frame gravity is
        g (sin α, 0, -cos α): z is the plane normal, and the plane falls along x.
    minimum_speed : float
        A particle ends when √(2 E_kin/m) after an impact falls below this, in m/s; 0 never does.
    seed : int
        Seed of the random numbers, in [0, 2⁶⁴).
    """

    body: Annotated[InstanceOf[Body], Allowed(BODIES)]
    law: Annotated[InstanceOf[Law], Allowed(LAWS)]
    particles: Annotated[Whole, Field(ge=1, lt=2**40, description="number of particles")] = 1000
    impacts: Annotated[Whole, Field(ge=1, lt=2**40, description="most impacts of a particle")] = 400
    release_height: Annotated[Number, Field(gt=0, description="height of the centre of mass, m")] = 0.06
    gravity: Annotated[Number, Field(gt=0, description="m/s²")] = 9.81
    orientation: OrientationOfRun = "uniform-angle"
    spin: SpinOfRun = (0.0, 0.0, 0.0)
    velocity: VelocityOfRun = (0.0, 0.0, 0.0)
    incline: Annotated[Number, Field(ge=0, lt=math.pi / 2, description="rad")] = 0.0
    minimum_speed: Annotated[Number, Field(ge=0, description="m/s; 0 never stops a particle")] = 0.0
    seed: Annotated[Whole, Field(ge=0, lt=2**64)] = 1

    model_config: ClassVar[ConfigDict] = ConfigDict(validate_default=True)
    NUMBERS: ClassVar = ("particles", "impacts", "release_height", "gravity", "minimum_speed", "incline")

    @model_validator(mode="after")
    def _nothing_below_the_plane(self) -> "Run":
        angles = self.angles
        if angles is not None and angles.size != self.particles:
            given = f"an array of {angles.size} angles"
            allowed = f"one angle per particle, and particles = {self.particles}"
            raise ParameterError(Problem("orientation", f" = {given}: must be {allowed}"))
        solid = self.body.solid
        lowest = solid.farthest()
        # A body put down on the plane may be off by the rounding of its height.
        rounding = 1.0 - 4.0 * np.finfo(np.float64).eps
        if angles is not None and self.release_height < lowest * rounding:
            lowest = solid.lowest(np.cos(angles))
        if self.release_height < lowest * rounding:
            allowed = f"at least {lowest!r} m, or a part of the body would reach below the plane"
            raise ParameterError(wrong("release_height", self.release_height, allowed))
        return self

    @model_validator(mode="after")
    def _one_spin_per_particle(self) -> "Run":
        spins = self.spins
        if spins is not None and len(spins) != self.particles:
            given = f"an array of {len(spins)} angular velocities"
            allowed = f"one per particle, and particles = {self.particles}"
            raise ParameterError(Problem("spin", f" = {given}: must be {allowed}"))
        return self

    @property
    def angles(self) -> FloatArray | None:
        """The angles θ at release where they were given, in rad, shape (particles,)."""
        if isinstance(self.orientation, str):
            return None
        angles: FloatArray = self.orientation
        return angles if angles.ndim == 1 else angles[:, 0]

    @property
    def spins(self) -> FloatArray | None:
        """The angular velocities where each particle has its own, in rad/s, shape (particles, 3)."""
        return self.spin if isinstance(self.spin, np.ndarray) else None

    def fall_speed(self, drop: float) -> float:
        """Give the normal velocity in m/s after the centre of mass has come nearer by `drop`, in m."""
        fall = 2.0 * self.gravity * math.cos(self.incline) * drop
        return math.sqrt(fall + self.velocity[2] ** 2)

    def parameters(self) -> dict[str, Any]:
        """Name every parameter as the core does."""
        spin = self.spin
        return {
            "body": self.body.solid,
            "law": self.law.parameters(),
            **{name: getattr(self, name) for name in (*self.NUMBERS, "orientation", "seed")},
            "spin": spin.parameters() if isinstance(spin, RandomSpin) else spin,
            "velocity": self.velocity,
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
            **self._spin_attributes(),
            "velocity": self.velocity,
            "seed": np.uint64(self.seed),
        }

    def _spin_attributes(self) -> dict[str, Any]:
        if isinstance(self.spin, RandomSpin):
            return {"spin": "random", "spin_rate": self.spin.rates, "spin_axis": self.spin.axis}
        return {"spin": self.spin if self.spins is None else "given"}
