"""An impact with Coulomb friction, followed in the normal impulse by SciPy's general integrator."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

Floats = npt.NDArray[np.float64]

VANISHED = 1e-9
"""Slip that counts as none, relative to the contact velocity."""


class Contact(NamedTuple):
    """What the `respond` of a compiled law takes: vectors along n, u and w, masses in the body's."""

    slip: tuple[float, float, float]
    arm: tuple[float, float]
    inertia: float
    across: float

    @property
    def matrix(self) -> Floats:
        """K, which makes the change of the contact velocity of an impulse; its entry for w is given."""
        n, u = self.arm
        j = self.inertia
        return np.array([[1 + u * u / j, -n * u / j, 0], [-n * u / j, 1 + n * n / j, 0], [0, 0, self.across]])


def respond(contact: Contact, restitution: float, friction: float, hypothesis: str) -> Floats:
    """Return the impulse of the impact along n, u and w."""
    matrix = contact.matrix
    start = np.array(contact.slip)
    speed = -start[0]
    size = float(np.linalg.norm(start))
    # Contact velocity, impulse along u and w, work of the normal force.
    state = np.array([*start, 0.0, 0.0, 0.0])
    p = 0.0
    compressed: tuple[float, float] | None = None  # impulse and work at the end of the compression
    at_rest = False

    def direction(y: Floats) -> Floats:
        """DP/dp along n, u and w."""
        if at_rest:
            along = np.clip(-matrix[0, 1] / matrix[1, 1], -friction, friction)
            return np.array([1.0, along, 0.0])
        return np.array([1.0, *(-friction * y[1:3] / np.hypot(y[1], y[2]))])

    def rate(_: float, y: Floats) -> Floats:
        impulse = direction(y)
        return np.array([*(matrix @ impulse), *impulse[1:], y[0]])

    def separates(_: float, y: Floats) -> float:
        return float(y[0])

    def stops(_: float, y: Floats) -> float:
        return float(np.hypot(y[1], y[2]) - VANISHED * size)

    def over(p: float, y: Floats) -> float:
        assert compressed is not None
        if hypothesis == "newton":
            return float(y[0] - restitution * speed)
        if hypothesis == "poisson":
            return p - (1 + restitution) * compressed[0]
        return float(y[5] - (1 - restitution**2) * compressed[1])

    if np.hypot(start[1], start[2]) <= VANISHED * size:
        at_rest = True
    for _ in range(20):
        ending = separates if compressed is None else over
        events = [ending] if at_rest else [ending, stops]
        for event in events:
            vars(event).update(terminal=True, direction=0 if event is stops else 1)
        step = solve_ivp(
            rate, (p, p + 1e4 * size), state, method="DOP853", rtol=1e-11, atol=1e-13 * size, events=events
        )
        p, state = float(step.t[-1]), step.y[:, -1]
        if step.t_events and len(step.t_events[0]):
            if compressed is not None:
                break
            compressed = (p, float(state[5]))
            if restitution == 0:
                break
        else:
            at_rest = True
            state[1:3] = 0.0
    else:
        raise AssertionError("the impact does not end")
    return np.array([p, state[3], state[4]])
