"""Encounters by a dense search along numerically integrated rotations: nothing is shared with the package."""

from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation


class Grain:
    """Balls (x, y, z, r) in principal axes about the centre of mass, with a mass and principal moments."""

    def __init__(self, balls: Any, mass: Any, moments: Any) -> None:
        self.balls, self.mass, self.moments = np.array(balls, float), mass, np.array(moments, float)


def _flight(grain: Any, attitude: Any, spin: Any, span: Any) -> Any:
    """Attitude (x, y, z, w) and ω in the axes of the body over a time span, as an interpolant."""
    j = grain.moments

    def change(_: Any, state: Any) -> Any:
        q, w = state[:4], state[4:]
        vector, scalar = q[:3], q[3]
        turned = 0.5 * np.append(scalar * w + np.cross(vector, w), -vector @ w)
        return np.concatenate([turned, -np.cross(w, j * w) / j])

    start = np.concatenate([attitude, spin])
    return solve_ivp(change, (0, span), start, "DOP853", rtol=1e-12, atol=1e-13, dense_output=True).sol


def first_contact(grains: Any, states: Any, span: Any, samples: Any = 4000) -> Any:
    """Return time, velocities and spins (space axes) after an elastic-or-not frictionless first contact."""
    flights = [
        _flight(grain, state["attitude"], state["spin"], span)
        for grain, state in zip(grains, states, strict=True)
    ]

    def centres(k: Any, time: Any) -> Any:
        state, found = states[k], flights[k](time)
        turn = Rotation.from_quat(found[:4])
        return state["position"] + state["velocity"] * time + turn.apply(grains[k].balls[:, :3])

    def gaps(time: Any) -> Any:
        one, two = centres(0, time), centres(1, time)
        apart = np.linalg.norm(one[:, None] - two[None], axis=-1)
        return apart - grains[0].balls[:, None, 3] - grains[1].balls[None, :, 3]

    times = np.linspace(0, span, samples)
    least = np.array([gaps(time).min() for time in times])
    if not (least < 0).any():
        return None
    k = int(np.argmax(least < 0))
    time = brentq(lambda t: gaps(t).min(), times[k - 1], times[k], xtol=1e-15)
    return time, np.unravel_index(np.argmin(gaps(time)), gaps(time).shape), flights


def collide(grains: Any, states: Any, normal_restitution: Any, span: Any) -> Any:
    """Follow one frictionless contact; returns time, velocities and angular velocities in space, or None."""
    found = first_contact(grains, states, span)
    if found is None:
        return None
    time, (i, j), flights = found
    where = [state["position"] + state["velocity"] * time for state in states]
    turns = [Rotation.from_quat(flight(time)[:4]) for flight in flights]
    spins = [turn.apply(flight(time)[4:]) for turn, flight in zip(turns, flights, strict=True)]
    places = [
        where[k] + turns[k].apply(grain.balls[part, :3])
        for k, (grain, part) in enumerate(zip(grains, (i, j), strict=True))
    ]
    normal = places[0] - places[1]
    normal /= np.linalg.norm(normal)
    point = places[0] - normal * grains[0].balls[i, 3]
    arms = [point - x for x in where]
    inverse = [
        turn.as_matrix() @ np.diag(1 / grain.moments) @ turn.as_matrix().T
        for turn, grain in zip(turns, grains, strict=True)
    ]
    met = [state["velocity"] + np.cross(w, r) for state, w, r in zip(states, spins, arms, strict=True)]
    speed = normal @ (met[0] - met[1])
    mobility = sum(
        1 / grain.mass + np.cross(arm, normal) @ j @ np.cross(arm, normal)
        for grain, arm, j in zip(grains, arms, inverse, strict=True)
    )
    size = -(1 + normal_restitution) * speed / mobility
    signs = (1, -1)
    velocities = [
        s["velocity"] + sign * size * normal / g.mass
        for s, g, sign in zip(states, grains, signs, strict=True)
    ]
    later = [
        w + sign * size * j @ np.cross(arm, normal)
        for w, j, arm, sign in zip(spins, inverse, arms, signs, strict=True)
    ]
    return time, velocities, later
