"""Bodies, a law and heights of release that tests of learned distributions share."""

import numpy as np
from numpy.typing import NDArray

import restitution as rs

Floats = NDArray[np.float64]

BODY = rs.Dumbbell(radius=3e-3, separation=3e-4)
TOUCHING = rs.Dumbbell(radius=3e-3, separation=6e-3)
LAW = rs.TangentialRestitution(normal=0.98)


def heights(number: int, normal: float = 0.98) -> Floats:
    """Heights of release that span the loss of one impact."""
    return np.asarray(3e-3 + 0.057 * np.geomspace(normal**2, 1.0, number))
