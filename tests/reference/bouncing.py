"""Bouncing balls made up for the tests, by arithmetic that shares nothing with what reads their times."""

from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from scipy.integrate import solve_ivp

Array = npt.NDArray[np.float64]


def impact_times(
    coefficient: Callable[[float], float], speed: float, impacts: int, gravity: float = 9.81
) -> Array:
    """Times of impacts of a sphere in vacuum, from the first, to which it comes with `speed`."""
    times = [0.0]
    for _ in range(impacts - 1):
        speed *= coefficient(speed)
        times.append(times[-1] + 2.0 * speed / gravity)
    return np.array(times)


def flight_in_air(speed: float, terminal: float, gravity: float = 9.81) -> tuple[float, float]:
    """Integrate a flight with quadratic drag: how long it takes, and the speed at its end."""

    def motion(_: float, state: Array) -> list[float]:
        velocity = state[1]
        return [velocity, -gravity * (1.0 + velocity * abs(velocity) / terminal**2)]

    def landed(_: float, state: Array) -> float:
        return float(state[0])

    landed.terminal, landed.direction = True, -1  # type: ignore[attr-defined]
    found = solve_ivp(
        motion,
        (0.0, 3.0 * speed / gravity),
        [0.0, speed],
        events=landed,
        rtol=1e-12,
        atol=1e-14,
        max_step=0.05,
    )
    assert found.t_events is not None
    assert found.y_events is not None
    return float(found.t_events[0][-1]), float(-found.y_events[0][-1][1])
