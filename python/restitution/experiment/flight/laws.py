"""Laws ε_n(v) that a fit may try: their parameters, and how ε_n follows from them."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.parameters import ParameterError, wrong
from restitution.laws import Plastic, Viscoelastic


@dataclass(frozen=True)
class LawOfSpeed:
    """ε_n as a function of the normal impact speed."""

    name: str  # as `fit` takes it
    parameters: tuple[str, ...]
    units: tuple[str, ...]  # of the parameters
    coefficient: Callable[[Array, Array], Array]  # ε_n at speeds in m/s, shape (n,), for parameters, (p,)
    least: float  # what a parameter is at least
    start: Callable[[Array, Array], Array]  # parameters near those that fit ε_n measured at speeds

    def __reduce__(self) -> tuple[Any, tuple[str]]:
        """Pickle by name, because functions cannot be pickled."""
        return law_named, (self.name,)


def _scan(coefficient: Callable[[Array, Array], Array], grid: Array) -> Callable[[Array, Array], Array]:
    """Start where the sum of squares is least on a grid of the one parameter."""

    def start(speed: Array, ratio: Array) -> Array:
        misfit = [np.sum((ratio - coefficient(speed, np.array([value]))) ** 2) for value in grid]
        return np.array([grid[int(np.argmin(misfit))]])

    return start


def _constant(speed: Array, parameters: Array) -> Array:
    return np.full_like(speed, parameters[0])


def _power(speed: Array, parameters: Array) -> Array:
    return np.asarray(parameters[0] * speed ** -parameters[1])


def _power_start(speed: Array, ratio: Array) -> Array:
    positive = ratio > 0.0
    if np.ptp(speed[positive]) == 0.0:
        return np.array([np.median(ratio), 0.0])
    slope, offset = np.polyfit(np.log(speed[positive]), np.log(ratio[positive]), 1)
    return np.array([np.exp(offset), -slope])


def _viscoelastic(speed: Array, parameters: Array) -> Array:
    return sphere_with(max(float(parameters[0]), 0.0))(speed)


def sphere_with(beta: float) -> Viscoelastic:
    """Return a sphere with this β in (s/m)^(1/5): ε_n depends on nothing else."""
    # With these constants β is (3/2) A (docs/laws.md).
    return Viscoelastic(
        young_modulus=math.pi, poisson_ratio=0.0, dissipation=beta / 1.5, density=1.0, radius=1.0
    )


def _plastic(speed: Array, parameters: Array) -> Array:
    return Plastic(yield_speed=max(float(parameters[0]), _SLOWEST))(speed)


_SLOWEST = 1e-9
"""A search for the yield speed may step below zero; nothing is as slow as this, in m/s."""

LAWS = {
    law.name: law
    for law in (
        LawOfSpeed(
            "constant",
            ("restitution",),
            ("1",),
            _constant,
            -math.inf,
            lambda _, ratio: np.array([np.median(ratio)]),
        ),
        LawOfSpeed(
            "power law", ("restitution_at_1_m_s", "exponent"), ("1", "1"), _power, -math.inf, _power_start
        ),
        LawOfSpeed(
            "viscoelastic",
            ("beta",),
            ("(s/m)^(1/5)",),
            _viscoelastic,
            0.0,
            _scan(_viscoelastic, np.geomspace(1e-5, 1e2, 141)),
        ),
        LawOfSpeed(
            "plastic",
            ("yield_speed",),
            ("m/s",),
            _plastic,
            _SLOWEST,
            _scan(_plastic, np.geomspace(1e-7, 1e2, 181)),
        ),
    )
}


def law_named(law: object) -> LawOfSpeed:
    """Find a law by its name, or the class of a material."""
    if law is Viscoelastic:
        return LAWS["viscoelastic"]
    if law is Plastic:
        return LAWS["plastic"]
    if isinstance(law, str) and law in LAWS:
        return LAWS[law]
    names = ", ".join(repr(name) for name in LAWS)
    raise ParameterError(wrong("law", law, f"{names}, or the class Viscoelastic or Plastic"))


_STEP = 1e-6
"""Relative step of the derivatives of a law; its square and the rounding over it are both below 1e-9."""


def by_speed(form: LawOfSpeed, speed: Array, values: Array) -> Array:
    """Return dε_n/dv."""
    step = _STEP * speed
    return (form.coefficient(speed + step, values) - form.coefficient(speed - step, values)) / (2.0 * step)


def by_parameters(form: LawOfSpeed, speed: Array, values: Array) -> Array:
    """Return dε_n/dθ, with the parameters along the last axis."""
    slopes = []
    for place, value in enumerate(values):
        step = _STEP * max(abs(value), _STEP)
        shift = np.zeros_like(values)
        shift[place] = step
        slopes.append(
            (form.coefficient(speed, values + shift) - form.coefficient(speed, values - shift)) / (2.0 * step)
        )
    return np.stack(slopes, axis=-1)
