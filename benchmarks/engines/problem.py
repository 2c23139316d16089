"""The problem as an engine is given it, and what is read off its motion."""

import csv
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from time import process_time
from typing import Literal

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

RADIUS = SEPARATION = 0.01
NORMAL, HEIGHT, GRAVITY = 0.9, 0.06, 9.81
MASS, TRANSVERSE, AXIAL = 0.017671458676442584, 1.3032700773876405e-06, 7.510369937488098e-07
"""Of two overlapping spheres of 2500 kg/m³, in kg and kg m²."""
SPACING = 0.2
"""Between bodies, in m, which must not meet."""
REFERENCE = Path(__file__).parent / "reference"
Kind = Literal["sphere", "ellipsoid", "box"]


@dataclass(frozen=True)
class Solid:
    """A rigid body in its principal axes, about its centre of mass: spheres, an ellipsoid or a box.

    `sizes` has the radius of each sphere, the semi-axes or the half edges, in m, and `places` the centres;
    `mass` is in kg, `moments` of inertia in kg m².
    """

    mass: float
    moments: tuple[float, float, float]
    kind: Kind
    sizes: tuple[tuple[float, ...], ...]
    places: tuple[tuple[float, float, float], ...] = ((0.0, 0.0, 0.0),)


DUMBBELL = Solid(
    MASS,
    (TRANSVERSE, TRANSVERSE, AXIAL),
    "sphere",
    ((RADIUS,), (RADIUS,)),
    ((0.0, 0.0, -SEPARATION / 2), (0.0, 0.0, SEPARATION / 2)),
)


def leaning(angles: Floats) -> Floats:
    """Give attitudes, quaternions (w, x, y, z), with the third axis at `angles` to the vertical."""
    zero = np.zeros_like(angles)
    return np.stack([np.cos(angles / 2), zero, np.sin(angles / 2), zero], axis=1)


def rotation(attitude: Floats) -> Floats:
    """Give the matrix that turns the axes of the body into those of space."""
    w, vector = attitude[0], attitude[1:]
    cross = np.cross(vector, np.eye(3)).T
    return np.asarray(np.eye(3) + 2 * (w * cross + cross @ cross))


def balls(solid: Solid) -> tuple[Floats, float]:
    """Give balls (x, y, z, radius) that bounce like spheres or a box, and the height of the plane under them.

    Of a box they are about its corners, over a plane that is lower by their radius: without friction the
    same, because what touches is straight below the corner.
    """
    sizes = np.array(solid.sizes)
    if solid.kind == "sphere":
        return np.hstack([solid.places, sizes]), 0.0
    corners = np.array(list(product((-1.0, 1.0), repeat=3))) * sizes[0]
    radius = float(sizes.min())
    return np.hstack([corners, np.full((8, 1), radius)]), -radius


@dataclass(frozen=True)
class Motion:
    """Vertical velocity of the centres of mass, in m/s, shape (times, bodies), at equal steps in s.

    `cost` is the processor time of the steps, in s.
    """

    step: float
    velocity: Floats
    cost: float = 0.0


def record(
    advance: Callable[[int], object],
    look: Callable[[], Sequence[float] | Floats],
    bodies: int,
    seconds: float,
    step: float,
) -> Motion:
    """Record a motion from rest: `advance` by a step, `look` at the velocities."""
    number = round(seconds / step)
    velocity = np.zeros((number + 1, bodies))
    cost = 0.0
    for k in range(number):
        start = process_time()
        advance(k)
        cost += process_time() - start
        velocity[k + 1] = look()
    return Motion(step, velocity, cost)


def damping(stiffness: float, mass: float = 1.0) -> float:
    """Give the damping in kg/s (for a mass of 1: in 1/s) with which a spring returns ε_n head-on."""
    decay = -np.log(NORMAL)
    return float(2 * np.sqrt(mass * stiffness) * decay / np.hypot(np.pi, decay))


def impacts(motion: Motion) -> tuple[Floats, Floats]:
    """Find v and ε of every impact; shape (impacts, bodies), NaN where there is none.

    Between impacts a velocity falls by g a step. Neighbouring steps in which it does not are an impact, from
    the velocity at its begin, less one step of gravity, to that at its end.
    """
    kicked = np.diff(motion.velocity, axis=0) + GRAVITY * motion.step > 2e-3
    found: list[list[tuple[float, float]]] = []
    for body in range(motion.velocity.shape[1]):
        at = np.flatnonzero(kicked[:, body])
        starts = at[np.diff(at, prepend=-2) > 1]
        ends = at[np.diff(at, append=at[-1] + 2 if at.size else 0) > 1]
        v = motion.velocity[:, body]
        before = -(v[starts] - GRAVITY * motion.step)
        after = v[ends + 1]
        found.append([(b, a / b) for b, a in zip(before, after, strict=True) if b > 1e-3])
    most = max((len(row) for row in found), default=0)
    table = np.full((2, max(most, 1), len(found)), np.nan)
    for body, row in enumerate(found):
        for i, pair in enumerate(row):
            table[:, i, body] = pair
    return table[0], table[1]


def read(name: str) -> dict[str, Floats]:
    """Read a file of the reference as columns."""
    with (REFERENCE / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        names, *rows = csv.reader(file)
    return dict(zip(names, np.array(rows, dtype=float).T, strict=True))


def of_first_impacts(motion: Motion, exact: Floats) -> tuple[float, float]:
    """Give the median error of ε at the first impact, and the share of the bodies where it is above 0.02.

    A flat body touches with its other end soon after; what an engine takes for one impact may be both.
    """
    off = np.nan_to_num(np.abs(impacts(motion)[1][0] - exact), nan=np.inf)
    return float(np.median(off)), float(np.mean(~(off < 0.02)))


def of_spread(motion: Motion, window: tuple[float, float] = (0.3, 0.4)) -> tuple[float, float, float, int]:
    """Give σ in a window of v over the reference's, its error, mean ε less the reference's, how many.

    The error is over bodies, left out in groups, for the impacts of one are not independent.
    """
    v, epsilon = impacts(motion)
    inside = (v >= window[0]) & (v < window[1])
    reference = read("statistics")
    row = int(np.argmin(np.abs(reference["velocity"] - np.mean(window))))
    groups = np.arange(v.shape[1]) % 16
    every = epsilon[inside]
    parts = [epsilon[:, groups != g][inside[:, groups != g]].std() for g in range(16)]
    error = np.sqrt(15 / 16 * np.sum((np.array(parts) - np.mean(parts)) ** 2))
    sigma = reference["std_restitution"][row]
    shift = every.mean() - reference["mean_restitution"][row]
    return every.std() / sigma, error / sigma, float(shift), int(every.size)
