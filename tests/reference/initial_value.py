"""The bouncing dumbbell as an initial value problem: two balls of `rigid_motion`, as `simulate` records them.

Nothing here knows that the flight has a closed form.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from reference import rigid_motion
from reference.rigid_motion import SPIN, VELOCITY, frame
from reference.solids import Balls

Array = NDArray[np.float64]


class Impact(NamedTuple):
    """One impact, under the names of the variables that `restitution.simulate` returns."""

    time: float
    impact_velocity: float
    rebound_velocity: float
    restitution: float
    rotational_fraction: float
    energy_ratio: float
    angle: float
    contact: int


def released(
    angle: float,
    height: float,
    velocity: Array | None = None,
    spin: Array | None = None,
    azimuth: float = 0.0,
) -> Array:
    """The axis leans by `angle` from the vertical towards +x, and is turned about the vertical by `azimuth`.

    `velocity` and `spin` are the laboratory's.
    """
    attitude = Rotation.from_euler("ZY", [azimuth, angle]).as_quat(scalar_first=True)
    rest = np.zeros(3)
    return rigid_motion.placed(
        height, attitude, rest if velocity is None else velocity, rest if spin is None else spin
    )


class Problem:
    """Body, law, gravity, and the integrator's tolerance.

    The law is the paper's, or without `tangential` the frictionless one. `gravity` points down, or, over a
    plane inclined by `incline`, also along +x.
    """

    def __init__(
        self,
        radius: float,
        separation: float,
        normal: float,
        tangential: float | None,
        gravity: float = 9.81,
        tolerance: float = 1e-12,
        incline: float = 0.0,
    ) -> None:
        self.solid = Balls([(0.0, 0.0, end * separation / 2.0, radius) for end in (1.0, -1.0)])
        law = rigid_motion.linear(normal, tangential)
        self.problem = rigid_motion.Problem(self.solid, law, gravity, incline, tolerance)

    def bounce(self, state: Array) -> Iterator[Impact]:
        """All impacts from `state` on, without end."""
        for time, part, before, after in self.problem.bounce(state):
            fall, rebound = -before[VELOCITY][2], after[VELOCITY][2]
            rotation, left = (s[SPIN] @ self.solid.tensor @ s[SPIN] for s in (before, after))
            energy = rotation + before[VELOCITY] @ before[VELOCITY]
            axis = frame(before)[:, 2]
            yield Impact(
                time,
                float(fall),
                float(rebound),
                float(rebound / fall),  # (1)
                float(rotation / energy),  # (12)
                float((left + after[VELOCITY] @ after[VELOCITY]) / energy),
                float(np.arctan2(np.hypot(axis[0], axis[1]), axis[2])),
                part + 1,
            )
