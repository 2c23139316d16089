"""Bouncing balls made up for the tests, by arithmetic that shares nothing with what reads their times."""

import math
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


def flight_in_air(
    speed: float, terminal: float, gravity: float = 9.81, height: float = 0.0
) -> tuple[float, float]:
    """Integrate a flight with quadratic drag from a height: how long it takes, and the speed at its end."""

    def motion(_: float, state: Array) -> list[float]:
        velocity = state[1]
        return [velocity, -gravity * (1.0 + velocity * abs(velocity) / terminal**2)]

    def landed(_: float, state: Array) -> float:
        return float(state[0])

    landed.terminal, landed.direction = True, -1  # type: ignore[attr-defined]
    found = solve_ivp(
        motion,
        (0.0, 3.0 * (speed + math.sqrt(2.0 * gravity * height)) / gravity),
        [height, speed],
        events=landed,
        rtol=1e-12,
        atol=1e-14,
        max_step=0.05,
    )
    assert found.t_events is not None
    assert found.y_events is not None
    return float(found.t_events[0][-1]), float(-found.y_events[0][-1][1])


def told_in_air(
    coefficient: Callable[[float], float], drop: float, terminal: float, impacts: int, gravity: float = 9.81
) -> Array:
    """Speeds that a drop and times of flight in air tell if there were none: √(2 g h), and g Δt/2 of each."""
    told, speed = [math.sqrt(2.0 * gravity * drop)], flight_in_air(0.0, terminal, gravity, drop)[1]
    for _ in range(impacts):
        time, speed = flight_in_air(coefficient(speed) * speed, terminal, gravity)
        told.append(0.5 * gravity * time)
    return np.array(told)
