"""Simulated flights of a round ball with asperities, by the map of docs/rough.md.

A contact lies at d = s (X, Y), s² = h_0 R, X and Y Gaussian for exponential heights of mean h_0. With the
horizontal velocity u that the spin gives to the lowest point, and c = 1 + ε_n,

    ε = c (1 + u·d/v)/(1 + q d²) - 1,    Δu = -q d c (v + u·d)/(1 + q d²),

q as of `coupling`. Contacts are met in proportion to their speed of approach, which shifts the mean of d by
s² u/v. With w = s u all of this depends on one number only, k = q s²: friction changes q, and so what h_0 is
that a k stands for. Contacts of different impacts are independent.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import Akima1DInterpolator

from restitution._internal.arrays import FloatArray as Array
from restitution.experiment.inference._series import Series
from restitution.experiment.inference._table import Table

PER_SHAPE = 1.0 / (8.0 * np.sqrt(2.0))
"""Mean height over R of asperities that make ε scatter as a ball of two lobes does, over (L/R)²."""


def flights(one: Series, parameter: float, kick: float, particles: int, seed: int) -> Array:
    """Drop such balls as the series was, without spin; return their flights in s, (particles, n - 1)."""
    rng = np.random.default_rng(seed)
    speed = np.full(particles, np.sqrt(2.0 * one.gravity * one.drop))
    drift = np.zeros((particles, 2))
    found = np.empty((particles, one.errors.size - 1))
    for impact in range(one.errors.size - 1):
        moving = speed > 0.0  # others have come to rest, and are no series
        here = np.where(moving, speed, np.nan)
        usual = np.full(particles, np.nan)
        usual[moving] = one.form.coefficient(speed[moving], np.array([parameter]))
        arm = rng.standard_normal((particles, 2)) + drift / here[:, None]
        approach = here + np.sum(drift * arm, axis=1)
        impulse = (1.0 + usual) * approach / (1.0 + kick * np.sum(arm**2, axis=1))
        drift = drift - kick * impulse[:, None] * arm
        speed = impulse - here
        found[:, impact] = 2.0 * speed / one.gravity
    return found


def over_heights(
    found: Table, heights: Array, couplings: Sequence[float], frictions: Sequence[float]
) -> Table:
    """Return a likelihood over ln k as one over ln h_0, and over the friction where there are several.

    Parameters
    ----------
    found : Table
        Its second axis is ln k.
    heights : ndarray
        h_0 in m, increasing.
    couplings : sequence of float
        k/h_0 in 1/m with each friction.
    frictions : sequence of float
    """
    between = Akima1DInterpolator(found.axes[1], found.values, axis=1)
    places = [np.clip(np.log(heights * one), *found.axes[1][[0, -1]]) for one in couplings]
    axes = (found.axes[0], np.log(heights), *found.axes[2:])
    if len(couplings) == 1:
        return replace(found, axes=axes, values=np.asarray(between(places[0])))
    values = np.stack([between(place) for place in places], axis=-1)
    return replace(found, axes=(*axes, np.array(frictions)), values=values)
