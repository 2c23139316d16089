"""Bodies, a law and heights of release that tests of learned distributions share."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

import restitution as rs
from restitution.distribution._ensemble import Ensemble
from restitution.drop.run import Run

Floats = NDArray[np.float64]

BODY = rs.Dumbbell(radius=3e-3, separation=3e-4)
TOUCHING = rs.Dumbbell(radius=3e-3, separation=6e-3)
LAW = rs.TangentialRestitution(normal=0.98)
EMPTY = np.empty((0, 0))
"""Conditions of impacts that have none."""


def heights(number: int, normal: float = 0.98) -> Floats:
    """Heights of release that span the loss of one impact."""
    return np.asarray(3e-3 + 0.057 * np.geomspace(normal**2, 1.0, number))


def ensemble_of(heights: tuple[Any, ...] = (0.06,), *, fraction: bool = False, **run: Any) -> Ensemble:
    return Ensemble(Run(body=BODY, law=LAW, **run), heights, fraction=fraction)
