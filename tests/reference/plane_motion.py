"""Any body of revolution bouncing in a vertical plane: a dense search for contacts; SI units, per unit mass.

The outline is known as the height h(θ) of the centre of mass above the plane when the body stands on it with
its axis at the angle θ, of each part that can touch. The lowest point is h′(θ) beside the centre of mass.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

Array = NDArray[np.float64]
SAMPLES = 20_000


class Part(NamedTuple):
    """One part of the outline: h and dh/dθ at given angles."""

    height: Callable[[Array], Array]
    slope: Callable[[Array], Array]


def ball(offset: float, radius: float) -> Part:
    """A sphere around the point at `offset` from the centre of mass."""
    return Part(lambda t: radius - offset * np.cos(t), lambda t: offset * np.sin(t))


def spheroid(equatorial: float, polar: float) -> Part:
    """The whole outline of a spheroid: h² = a² sin²θ + c² cos²θ."""

    def height(theta: Array) -> Array:
        return np.hypot(equatorial * np.sin(theta), polar * np.cos(theta))

    def slope(theta: Array) -> Array:
        return (equatorial**2 - polar**2) * np.sin(theta) * np.cos(theta) / height(theta)

    return Part(height, slope)


class Impact(NamedTuple):
    """One impact, under the names of the variables that `restitution.simulate` returns."""

    time: float
    impact_velocity: float
    rebound_velocity: float
    rotational_fraction: float
    energy_ratio: float
    angle: float
    part: int


def bounce(
    parts: Sequence[Part],
    inertia: float,
    normal: float,
    tangential: float,
    release: tuple[float, float],
    gravity: float = 9.81,
) -> Iterator[Impact]:
    """All impacts after a release from rest at (angle, height); `inertia` is J_xx/m."""
    theta, z = release
    v, w, x = 0.0, 0.0, 0.0  # climb, dθ/dt, glide
    clock, hit = 0.0, -1
    while True:

        def gap(t: Array | float, part: Part) -> Array:
            return z + v * t - 0.5 * gravity * t**2 - part.height(np.asarray(theta + w * t))  # noqa: B023

        longest = (v + np.sqrt(v**2 + 2.0 * gravity * z)) / gravity  # to z = 0, deeper than any contact
        times = np.linspace(0.0, longest, SAMPLES + 1)
        found = []
        for number, part in enumerate(parts):
            below = gap(times, part) < 0.0
            below[0] = False  # the part that was hit is on the plane
            first = int(np.argmax(below))
            if not below[first]:
                continue
            assert first > 1 or number != hit, "the grid is too coarse to see the part that was hit leave"
            low = times[first - 1] if number != hit or first > 1 else times[1]
            found.append((brentq(gap, low, times[first], args=(part,), xtol=1e-18, rtol=1e-15), number))
        assert found, "the body fell through the plane"
        time, hit = min(found)
        clock += time
        z, v, theta = z + v * time - 0.5 * gravity * time**2, v - gravity * time, theta + w * time
        # The point of contact, seen from the centre of mass: h below it and dh/dθ ahead.
        height, ahead = (
            float(parts[hit].height(np.asarray(theta))),
            float(parts[hit].slope(np.asarray(theta))),
        )
        # Turning by dθ moves it by (−h, −h′) dθ, forwards and upwards.
        slip = np.array([x - w * height, v - w * ahead])
        change = np.array([tangential - 1.0, -normal - 1.0]) * slip  # (9)
        lever = np.array([-height, -ahead])
        impulse = np.linalg.solve(np.eye(2) + np.outer(lever, lever) / inertia, change)  # (10)
        before = v**2 + x**2 + inertia * w**2
        fraction, fall = inertia * w**2 / before, -v
        x, v, w = x + impulse[0], v + impulse[1], w + float(lever @ impulse) / inertia  # (11)
        after = v**2 + x**2 + inertia * w**2
        yield Impact(clock, fall, v, fraction, after / before, float(np.arccos(np.cos(theta))), hit)
