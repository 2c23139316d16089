"""Eq. 21 as the paper prints it."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from restitution.analytic import first_impact
from restitution.bodies import Dumbbell
from restitution.laws import TangentialRestitution


def printed_density(
    restitution: ArrayLike, body: Dumbbell, law: TangentialRestitution
) -> NDArray[np.float64]:
    """Eq. 21 with Eq. 22 as printed, misprints included: to be compared with `restitution.analytic`, no more.

    Parameters
    ----------
    restitution : array_like
        ε, of any shape.
    body : Dumbbell
        With ``separation > 0``.
    law : TangentialRestitution
        Gives ε_n.

    Returns
    -------
    ndarray
        Of the shape of ``restitution``; 0 outside the support of Eq. 17, nan for nan.
    """
    value = np.asarray(restitution, dtype=np.float64)
    low, high = first_impact(body, law).support()
    s = np.clip(value, low, high)
    radius, length, normal = body.radii[0], body.separation, law.constant
    inertia = body.transverse_inertia / body.mass
    k = 1.0 + normal
    f = np.sqrt(
        4.0 * (s - normal) * ((s + 1.0) * radius**2 + k * inertia) + k * (s + 1.0) * length**2
    )  # (22)
    bracket = 0.5 * k * (4.0 * inertia + length**2) + 4.0 * radius**2 * (2.0 * s - normal + 1.0)
    cosine = (2.0 * radius * (s - normal) + f) / (k * length)
    sine = np.sqrt(np.maximum(1.0 - cosine**2, 0.0))
    with np.errstate(divide="ignore"):
        density = (2.0 * radius * f + bracket) / (np.pi * f * k * length * sine)  # (21)
    return np.where((value < low) | (value > high), 0.0, density)
