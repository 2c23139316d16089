"""A gas of spheres that draw their ε, by direct simulation Monte Carlo, and four rules to draw it.

Smooth hard spheres of mass 1 in a uniform gas without forces. Two of them meet along the unit vector k,
with u their relative velocity and v = -u·k > 0; positions do not appear. Four rules say what follows:

* "plane": u' = u + (1 + ε)v k with ε from p(ε | v) of one body that bounces on a plane, as the paper has it,
* "pair": the same with ε of the centres in encounters of two bodies, T_rot = T_tr = T_0,
* "scaled": the same, where v is measured in thermal speeds of the gas at that time,
* "kernel": u' and the change of E_rot from one encounter, at the T_rot/T_tr that the gas has.

Time is counted in 1/ν0, ν0 = 4√π nσ²√θ0 being the initial frequency of collisions of a particle, and θ =
<v²>/3 in m²/s².
"""

import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

import restitution as rs

Floats = npt.NDArray[np.float64]


class Outcome(NamedTuple):
    """Result of collisions."""

    change: Floats
    """Of the relative velocity, shape (..., 3)."""
    turning: Floats | float
    """Energy over mass that rotation gains, of both particles."""


Rule = Callable[[Floats, Floats, float, float, np.random.Generator], Outcome]
"""Outcome of collisions from u, k, θ of translation and of rotation, and random numbers."""

STEP = 0.02
"""Mean number of collisions of a particle in a step."""
FASTEST = 10.0
"""No pair is faster than this times √θ along k: seven standard deviations in a Gaussian gas."""
AXES = 2
"""About which contacts turn a dumbbell."""


class Gas(NamedTuple):
    """Course of a gas, once in a collision of each particle."""

    time: Floats
    collisions: Floats
    """Of a particle."""
    theta: Floats
    rotation: Floats
    """T_rot/m."""
    a2: Floats
    """Second Sonine coefficient."""


def cool(rule: Rule, theta: float, collisions: float, seed: int, particles: int = 10_000) -> Gas:
    """Cool one gas from T_rot = T_tr, until a particle has had so many collisions."""
    rng = np.random.default_rng(seed)
    u = rng.normal(size=(particles, 3))
    u -= u.mean(axis=0)
    u *= np.sqrt(theta / np.mean(u**2))
    time, met, now, turning, step = 0.0, 0.0, theta, theta, 0
    found: list[tuple[float, ...]] = []
    # The rate of a pair is proportional to |u·k|, whose mean is 2√(θ/π) in a Gaussian gas.
    candidates = 0.5 * particles * STEP * FASTEST * np.sqrt(np.pi) / 2
    while not found or found[-1][1] < collisions:
        if step % round(1 / STEP) == 0:
            square = np.sum(u**2, axis=1)
            now = float(np.mean(square)) / 3.0  # of which sums of changes lose the digits as it falls
            a2 = 0.6 * np.mean(square**2) / np.mean(square) ** 2 - 1.0
            found.append((time, met, now, turning, a2))
        one, two = rng.choice(particles, (2, int(candidates + rng.random())), replace=False)
        k = rng.normal(size=(one.size, 3))
        k /= np.linalg.norm(k, axis=1)[:, np.newaxis]
        relative = u[one] - u[two]
        v = -np.sum(relative * k, axis=1)
        hit = FASTEST * np.sqrt(now) * rng.random(v.size) < np.abs(v)
        one, two, relative = one[hit], two[hit], relative[hit]
        k = k[hit] * np.sign(v[hit])[:, np.newaxis]
        outcome = rule(relative, k, now, turning, rng)
        before = now
        now += float(np.sum((relative + outcome.change) ** 2) - np.sum(relative**2)) / (6.0 * particles)
        turning += 2.0 * float(np.sum(outcome.turning)) / (AXES * particles)
        u[one] += 0.5 * outcome.change
        u[two] -= 0.5 * outcome.change
        time += STEP * 0.5 * np.sqrt(theta) * (before**-0.5 + now**-0.5)
        met += 2.0 * one.size / particles
        step += 1
    return Gas(*np.array(found).T)


def along(epsilon: Callable[[Floats, float, np.random.Generator], Floats | float]) -> Rule:
    """Make the rule of smooth spheres from ε of v and θ."""

    def rule(u: Floats, k: Floats, theta: float, _: float, rng: np.random.Generator) -> Outcome:
        v = -np.sum(u * k, axis=1)
        return Outcome(((1.0 + epsilon(v, theta, rng)) * v)[:, np.newaxis] * k, 0.0)

    return rule


RATIOS = np.geomspace(0.4, 100.0, 24)
"""T_rot/T_tr of the encounters; one between two of them is drawn from either."""

Restitution = Callable[[Floats, np.random.Generator], Floats]
"""ε of pairs at speeds v in m/s, drawn."""


def dropped(
    body: rs.Dumbbell, law: rs.Frictionless, pair: Restitution, particles: int, drop: float
) -> dict[str, Rule]:
    """Make the rules of v in m/s; learn p(ε | v) of a body on a plane, dropped from `drop` in m."""
    # Spread, so that no first impact stands out.
    heights = body.radii[0] + drop * np.geomspace(0.8, 1.0, min(particles // 2, 100))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rs.DistanceWarning)  # it has bands
        plane = rs.FluctuatingRestitution.learn(
            body, law, particles=particles, impacts=300, release_height=heights, velocities=(0.05, 4.0)
        ).clamped()
    return {
        "plane": along(lambda v, _, rng: plane.rvs(v, random_state=rng, threads=1)),
        "pair": along(lambda v, _, rng: pair(v, rng)),
    }


def met(body: rs.Dumbbell, law: rs.Frictionless, encounters: int, theta: float) -> Restitution:
    """Learn to draw ε, of the centres along their line, from encounters at T_rot = T_tr = T_0."""
    data = rs.PairKernel.learn(
        body, body, law, temperature_ratios=[1.0], **warm(body, encounters, theta)
    ).data
    data = data.sortby("centre_speed")
    speeds, epsilon = data["centre_speed"].to_numpy(), data["restitution_centres"].to_numpy()

    def draw(v: Floats, rng: np.random.Generator) -> Floats:
        """Take one of the fifty encounters that had nearly the same speed."""
        place = np.searchsorted(speeds, v) + rng.integers(-25, 25, v.shape)
        return np.asarray(epsilon[place.clip(0, speeds.size - 1)])

    return draw


def warm(body: rs.Dumbbell, encounters: int, theta: float) -> dict[str, Any]:
    """Give the temperature of the encounters to learn from, and their number."""
    return {"translational_temperature": body.mass * theta, "encounters": encounters}


def scaled(
    body: rs.Dumbbell, law: rs.Frictionless, pair: Restitution, encounters: int, first: float
) -> dict[str, Rule]:
    """Make the rules that know the temperatures of the gas, `first` being θ of `pair`."""
    kernel = rs.PairKernel.learn(body, body, law, temperature_ratios=RATIOS, **warm(body, encounters, first))

    def whole(u: Floats, k: Floats, theta: float, rotation: float, rng: np.random.Generator) -> Outcome:
        place = np.interp(np.log(rotation / theta), np.log(RATIOS), np.arange(len(RATIOS)))
        ratio = RATIOS[np.floor(place + rng.random(len(u))).astype(int).clip(max=len(RATIOS) - 1)]
        unit = np.sqrt(theta / first)
        after = kernel.rvs(u / unit, k, ratio, random_state=rng)
        return Outcome(after.velocity * unit - u, after.rotational_change.sum(axis=1) * unit**2 / body.mass)

    return {
        "scaled": along(lambda v, theta, rng: pair(v * np.sqrt(first / theta), rng)),
        "kernel": whole,
    }
