"""Any body of revolution bouncing in a vertical plane: a dense search for contacts; SI units, per unit mass.

The outline is known as the height h(θ) of the centre of mass above the plane when the body stands on it with
its axis at the angle θ, of each part that can touch. The lowest point is h′(θ) beside the centre of mass.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

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


class Motion(NamedTuple):
    """Height and climb of the centre of mass, angle of the axis and its rate, at the start of a flight."""

    z: float
    v: float
    theta: float
    w: float


def first_contact(parts: Sequence[Part], start: Motion, gravity: float, hit: int) -> tuple[float, int]:
    """When which part comes down; part `hit`, if there is such a one, is on the plane and leaves it."""
    z, v, theta, w = start
    longest = (v + np.sqrt(v**2 + 2.0 * gravity * z)) / gravity  # to z = 0, deeper than any contact
    times = np.linspace(0.0, longest, SAMPLES + 1)
    found = []
    for number, part in enumerate(parts):

        def gap(t: Any, part: Part = part) -> Any:
            return z + v * t - 0.5 * gravity * t**2 - part.height(theta + w * t)

        below = gap(times) < 0.0
        below[0] = False
        first = int(np.argmax(below))
        if below[first]:
            assert first > 1 or number != hit, "the grid is too coarse to see how the part leaves"
            between = times[first - 1], times[first]
            found.append((brentq(gap, *between, xtol=1e-18, rtol=1e-15), number))
    assert found, "the body fell through the plane"
    return min(found)


def bounce(
    parts: Sequence[Part],
    inertia: float,
    law: tuple[float, float],
    release: tuple[float, float],
    gravity: float = 9.81,
) -> Iterator[Impact]:
    """All impacts after a release from rest at (angle, height); `inertia` is J_xx/m, `law` (ε_n, ε_t)."""
    (theta, z), v, w, x = release, 0.0, 0.0, 0.0  # x: glide
    clock, hit = 0.0, -1
    while True:
        time, hit = first_contact(parts, Motion(z, v, theta, w), gravity, hit)
        clock += time
        z, v, theta = z + v * time - 0.5 * gravity * time**2, v - gravity * time, theta + w * time
        # Turning by dθ moves the point of contact, h below the centre of mass and h′ ahead, by (−h, −h′)dθ.
        here = np.asarray(theta)
        lever = -np.array([float(parts[hit].height(here)), float(parts[hit].slope(here))])
        slip = np.array([x, v]) + w * lever
        change = (np.array([law[1], -law[0]]) - 1.0) * slip  # (9)
        impulse = np.linalg.solve(np.eye(2) + np.outer(lever, lever) / inertia, change)  # (10)
        before, rotation, fall = v**2 + x**2 + inertia * w**2, inertia * w**2, -v
        x, v, w = x + impulse[0], v + impulse[1], w + float(lever @ impulse) / inertia  # (11)
        after = v**2 + x**2 + inertia * w**2
        angle = float(np.arccos(np.cos(theta)))
        yield Impact(clock, fall, v, rotation / before, after / before, angle, hit)
