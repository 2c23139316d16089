"""A bouncing rigid body as an initial value problem: the Newton-Euler equations and a general integrator.

Nothing here knows a closed form of the flight, a principal axis, or a bound on the gap. The attitude is a
unit quaternion (w, x, y, z) from the body's frame to the laboratory's, the angular velocity is kept in the
body's frame. An impact is nine linear equations for v', ω' and P at once, or with Coulomb's law is followed
in the normal impulse (`friction`). Double precision, SI units, per unit mass.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from reference import friction
from reference.solids import Solid

Array = NDArray[np.float64]
# the layout of a state: height of the centre of mass, v_G, quaternion, angular velocity in the body's frame
HEIGHT, VELOCITY, ATTITUDE, SPIN = 0, slice(1, 4), slice(4, 8), slice(8, 11)
TURN_PER_STEP = 0.1  # radians
SAMPLES = 4  # a step, at which the gap is looked at
Law = Callable[[Array, Array, Array, Array], tuple[Array, Array]]
"""Tensor of inertia, arm from the centre of mass to the contact, v_G and ω before; v_G' and ω'."""


class Bounce(NamedTuple):
    """One impact: its time, the part that touches, from 0, and the states before and after."""

    time: float
    part: int
    before: Array
    after: Array


def frame(state: Array) -> Array:
    """Columns: the body's axes in the laboratory."""
    return np.asarray(Rotation.from_quat(state[ATTITUDE], scalar_first=True).as_matrix())


def placed(height: float, attitude: Array, velocity: Array, spin: Array) -> Array:
    """Return a state; `velocity` and `spin` are the laboratory's."""
    state = np.concatenate([[height], velocity, attitude / np.linalg.norm(attitude), np.zeros(3)])
    state[SPIN] = frame(state).T @ spin
    return state


def skew(r: Array) -> Array:
    """[r]ω = r × ω."""
    x, y, z = r
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def linear(normal: float, tangential: float | None) -> Law:
    """Return the law of Eq. 9, or without `tangential` the frictionless one: Eqs. 9 to 11 for v', ω', P/m."""

    def law(tensor: Array, arm: Array, velocity: Array, spin: Array) -> tuple[Array, Array]:
        turned = skew(arm)
        contact = velocity - turned @ spin  # v_c (7)
        eye, nothing = np.eye(3), np.zeros((3, 3))
        last = np.block([eye, -turned, nothing])  # v_c'
        if tangential is None:
            wanted = np.array([0.0, 0.0, -normal * contact[2]])
            last[:2] = np.eye(9)[6:8]  # P_t = 0
        else:
            wanted = np.array([tangential, tangential, -normal]) * contact  # v_c' (9)
        left = np.block([[eye, nothing, -eye], [nothing, tensor, -turned], [last]])
        right = np.concatenate([velocity, tensor @ spin, wanted])
        solution = np.linalg.solve(left, right)
        return solution[:3], solution[3:6]

    return law


def response(tensor: Array, arm: Array) -> Array:
    """Return what impulses along x, y and z do to the velocity of the contact, as columns."""
    turns = np.linalg.solve(tensor, skew(arm))  # ω' - ω of unit impulses
    return np.asarray(np.eye(3) - skew(arm) @ turns)


def coulomb(normal: float, mu: float, hypothesis: str) -> Law:
    """Return Coulomb's law."""
    order = [2, 0, 1]  # the normal first

    def law(tensor: Array, arm: Array, velocity: Array, spin: Array) -> tuple[Array, Array]:
        contact = velocity - skew(arm) @ spin
        matrix = response(tensor, arm)[np.ix_(order, order)]
        impulse = np.empty(3)
        impulse[order] = friction.follow(matrix, contact[order], normal, mu, hypothesis)
        return velocity + impulse, spin + np.linalg.solve(tensor, skew(arm) @ impulse)

    return law


class Problem:
    """Body, law, gravity, and the integrator's tolerance.

    `gravity` points down, or, over a plane inclined by `incline`, also along +x.
    """

    def __init__(
        self,
        solid: Solid,
        law: Law,
        gravity: float = 9.81,
        incline: float = 0.0,
        tolerance: float = 1e-13,
    ) -> None:
        self.solid, self.law, self.tolerance = solid, law, tolerance
        self.gravity, self.along = gravity * np.cos(incline), gravity * np.sin(incline)
        self.tensor: list[list[float]] = solid.tensor.tolist()
        self.inverse: list[list[float]] = np.linalg.inv(solid.tensor).tolist()
        self.least_moment = float(np.linalg.eigvalsh(solid.tensor)[0])

    def derivative(self, time: float, state: Array) -> Array:
        """Newton: dv/dt = g. Euler: J dω/dt = Jω × ω in the body's frame. dq/dt = qω/2."""
        _, _, _, up, w, x, y, z, p, q, r = state.tolist()
        a, b, c = ((row[0] * p + row[1] * q + row[2] * r) for row in self.tensor)
        f, g, h = b * r - c * q, c * p - a * r, a * q - b * p
        spin = [row[0] * f + row[1] * g + row[2] * h for row in self.inverse]
        attitude = [
            0.5 * (-x * p - y * q - z * r),
            0.5 * (w * p + y * r - z * q),
            0.5 * (w * q + z * p - x * r),
            0.5 * (w * r + x * q - y * p),
        ]
        return np.array([up, self.along, 0.0, -self.gravity, *attitude, *spin])

    def gaps(self, state: Array) -> Array:
        """Distance of each part from the plane."""
        return np.asarray(state[HEIGHT] - self.solid.depths(upward(state)))

    def flight(self, state: Array, hit: int | None) -> tuple[float, Array, int]:
        """Duration of the flight, state at its end, and the part that touches.

        `hit` is the part that has just rebounded, None at the release. The contact is the first change of the
        sign of a gap, seen at some instants a step. The first step is short after an impact: a contact that
        rises at u, in a body whose points are accelerated by some g + rω², is up for some 2u/(g + rω²).
        """
        # |ω| stays below this in the flight: the rotational energy is conserved.
        fastest = float(np.sqrt(state[SPIN] @ self.solid.tensor @ state[SPIN] / self.least_moment))
        up, fall = state[VELOCITY][2], 2 * self.gravity * state[HEIGHT]
        longest = float(up + np.sqrt(up**2 + fall)) / self.gravity  # to z = 0, deeper than any contact
        largest = first = min(TURN_PER_STEP / fastest if fastest else np.inf, longest)
        if hit is not None:
            rise = self.contact(state, hit)[1][2]
            first = min(0.2 * rise / (self.gravity + 2.0 * self.solid.reach * fastest**2), largest)
        solver = DOP853(
            self.derivative, 0.0, state, longest, first_step=first, rtol=self.tolerance, atol=1e-18
        )
        while solver.status == "running":
            solver.max_step = min(max(solver.t, first), largest)
            height = solver.y[HEIGHT]
            solver.step()
            if min(height, solver.y[HEIGHT]) > self.solid.reach:
                continue  # clear of the plane in between, too: z is a concave parabola
            path = solver.dense_output()
            times = np.linspace(solver.t_old, solver.t, SAMPLES + 1)
            for low, high in pairwise(times):
                below = np.flatnonzero(self.gaps(path(high)) < 0.0)
                # The gap of the part that has just rebounded is 0 at the start, up to rounding.
                touching = [
                    (float(brentq(self.gap, low, high, (path, part), 1e-16 * longest, 1e-15)), int(part))
                    for part in below
                    if low > 0.0 or part != hit
                ]
                if touching:
                    time, part = min(touching)
                    return time, path(time), part
        raise ArithmeticError("the body fell through the plane")

    def gap(self, time: float, path: Callable[[float], Array], part: int) -> float:
        """Distance of a part from the plane."""
        return float(self.gaps(path(time))[part])

    def contact(self, state: Array, part: int) -> tuple[Array, Array]:
        """Lowest point of a part, from the centre of mass, and its velocity."""
        axes = frame(state)
        arm = axes @ self.solid.lowest(upward(state), part)  # r_c (6)
        return arm, state[VELOCITY] - skew(arm) @ axes @ state[SPIN]  # v_c (7)

    def collide(self, before: Array, part: int) -> Array:
        """The state after an impact of a part."""
        axes, (arm, _) = frame(before), self.contact(before, part)
        tensor = axes @ self.solid.tensor @ axes.T
        after = before.copy()
        after[VELOCITY], spin = self.law(tensor, arm, before[VELOCITY], axes @ before[SPIN])
        after[SPIN] = axes.T @ spin
        after[HEIGHT] = -arm[2]
        return after

    def bounce(
        self, state: Array, disturb: Callable[[Array], Array] = lambda state: state
    ) -> Iterator[Bounce]:
        """All impacts from `state` on, without end.

        `disturb` may change the state after each impact, to measure how errors grow.
        """
        time, part = 0.0, None
        while True:
            duration, before, part = self.flight(state, part)
            time += duration
            state = disturb(self.collide(before, part))
            yield Bounce(time, part, before, state)


def upward(state: Array) -> Array:
    """The plane's normal in the body's frame: the last row of its attitude."""
    w, x, y, z = state[ATTITUDE].tolist()
    size = w * w + x * x + y * y + z * z
    row = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z])
    return np.asarray(row / size)
