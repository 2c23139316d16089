"""An impact with Coulomb friction, followed in the normal impulse by SciPy's general integrator."""

import math
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, newton

Floats = npt.NDArray[np.float64]
Rate = Callable[[float, Floats], list[float]]
Event = Callable[[float, Floats], float]

VANISHED = 1e-14
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
    return follow(contact.matrix, np.array(contact.slip), restitution, friction, hypothesis)


def at_rest(matrix: Floats, friction: float) -> list[float]:
    """Return dP_t/dp where the slip is 0: what holds the contact, or what goes with the slip that starts.

    Slip starts along d if its rate κ - μ K_t d is along d; one such direction is there if none can hold it.
    """
    push, block = matrix[1:, 0], matrix[1:, 1:]
    hold = -np.linalg.solve(block, push)
    if np.hypot(*hold) <= friction:
        return [float(x) for x in hold]

    def along(angle: float) -> Floats:
        return np.array([np.cos(angle), np.sin(angle)])

    def aside(angle: float) -> float:
        d = along(angle)
        rate = push - friction * block @ d
        return float(d[0] * rate[1] - d[1] * rate[0])

    angles = np.linspace(0.0, 2.0 * np.pi, 361) + 0.1234
    values = [aside(angle) for angle in angles]
    zeros = [
        along(brentq(aside, angles[i], angles[i + 1], xtol=1e-15))
        for i in range(360)
        if values[i] * values[i + 1] < 0.0
    ]
    (starting,) = (d for d in zeros if d @ (push - friction * block @ d) > 0.0)
    return [float(-friction * x) for x in starting]


def integrated(rate: Rate, start: Floats, events: Sequence[Event], smallest: float) -> tuple[Event, Floats]:
    """Integrate until the first of the events: which it is, and the state there.

    SciPy finds it between two steps by interpolation, with some digits less than the steps have. The last
    step is taken again, to where the event is 0 by the secant method.
    """

    def path(begin: float, end: float, state: Floats, watched: Sequence[Event] = ()) -> Any:
        span = (begin, end)
        return solve_ivp(rate, span, state, "DOP853", rtol=1e-13, atol=smallest, events=watched or None)

    found = path(0.0, 1e6, start, events)
    (happened,) = (e for e, times in zip(events, found.t_events, strict=True) if len(times))
    (begin, end), state = found.t[-2:], found.y[:, -2]

    def there(end: float) -> Floats:
        return np.asarray(path(begin, end, state).y[:, -1])

    near = end - 1e-3 * (end - begin)
    exact = newton(lambda t: happened(t, there(t)), end, x1=near, tol=1e-15 * end, rtol=1e-15)
    return happened, there(exact)


def follow(matrix: Floats, velocity: Floats, restitution: float, friction: float, hypothesis: str) -> Floats:
    """Return the impulse of a contact with the matrix K and the velocity v_c, both with the normal first.

    While the contact slips, the variable is θ with dp = |s| dθ, in which a slip that stops does so at ∞, with
    steps of ordinary length.
    A contact may be compressed again before it has separated. The restitution then ends where the work that
    was taken at most has come back to its part (Stronge's), at (1 + ε_n) times the impulse at the end of the
    last compression (Poisson's), or at the first p with its velocity (Newton's).
    """
    speed, size = -velocity[0], float(np.linalg.norm(velocity))
    # Contact velocity, impulse, work of the normal force.
    state = np.array([*velocity, 0.0, 0.0, 0.0, 0.0])
    pressed = taken = 0.0  # impulse at the end of the last compression, and most work taken so far
    compressing = True
    held = at_rest(matrix, friction) if np.hypot(*velocity[1:]) <= VANISHED * size else None

    rows = matrix.tolist()

    def rate(_: float, y: Floats) -> list[float]:
        u, x, z = y[:3].tolist()
        n, a, b = (math.hypot(x, z), -friction * x, -friction * z) if held is None else (1.0, *held)
        return [*(row[0] * n + row[1] * a + row[2] * b for row in rows), n, a, b, u * n]

    def separates(_: float, y: Floats) -> float:
        return float(y[0])

    def approaches(_: float, y: Floats) -> float:
        return float(-y[0])

    def stops(_: float, y: Floats) -> float:
        return float(VANISHED * size - np.hypot(y[1], y[2]))

    def over(_: float, y: Floats) -> float:
        if hypothesis == "newton":
            return float(y[0] - restitution * speed)
        if hypothesis == "poisson":
            return float(y[3] - (1 + restitution) * pressed)
        return float(y[6] + (1 - restitution**2) * taken)

    for event in (separates, approaches, stops, over):
        vars(event).update(terminal=True, direction=1)
    for _ in range(20):
        events = [separates] if compressing else [over, approaches]
        if held is None:
            events.append(stops)
        happened, state = integrated(rate, state, events, 1e-17 * size)
        if happened is over:
            break
        if happened is stops:
            state[1:3] = 0.0
            held = at_rest(matrix, friction)
            continue
        state[0] = 0.0
        if compressing:
            pressed, taken = float(state[3]), max(taken, -float(state[6]))
            if over(0.0, state) >= 0.0:
                break
        compressing = not compressing
    else:
        raise AssertionError("the impact does not end")
    return np.asarray(state[3:6])
