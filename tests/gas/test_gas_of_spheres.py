"""Gases of spheres that draw ε: Haff's law, the shape of the velocity distribution, recorded encounters.

Standard errors are over independent gases; seeds are fixed. Four standard errors of twelve gases, Student's t
with eleven degrees of freedom, would raise a false alarm in two of a thousand comparisons.
"""

from typing import Any

import numpy as np
import pytest
from scipy import optimize

import restitution as rs
from reference.sonine import sonine
from restitution.papers.gases import _spheres as spheres

THETA = 0.5
"""θ at the beginning, in m²/s²."""
TIMES = np.linspace(0.0, 30.0, 31)


def replicas(epsilon: Any, theta: float, collisions: float, number: int = 12) -> list[Any]:
    """Independent gases of 4000 particles."""
    rule = spheres.along(epsilon)
    return [spheres.cool(rule, theta, collisions, seed, 4000) for seed in range(number)]


def haff(time: Any, epsilon: float) -> Any:
    """θ/θ0 for constant ε: (1 + t/τ)⁻² with 1/τ = (1 - ε²)(1 + 3 a2/16) ν0/6."""
    return (1.0 + (1.0 - epsilon**2) / 6.0 * (1.0 + 3.0 / 16.0 * sonine(epsilon)) * time) ** -2


def mean_and_error(values: Any) -> tuple[float, float]:
    x = np.asarray(values)
    return float(x.mean()), float(x.std(ddof=1) / np.sqrt(x.size))


def test_haffs_law_with_its_closed_form_rate() -> None:
    """Constant ε = 0.9: the fitted exponent is 2 and the fitted rate that of van Noije and Ernst; a2 as well.

    Steps of a fiftieth of a collision shift the rate by less than 0.2 %, added to four standard errors.
    """
    gases = replicas(lambda v, theta, rng: 0.9, 1.0, 26.0)
    rate = (1.0 - 0.81) / 6.0 * (1.0 + 3.0 / 16.0 * sonine(0.9))
    fits = []
    for time, _, theta, *_ in gases:
        found, _ = optimize.curve_fit(lambda t, p, r: -p * np.log1p(r * t), time, np.log(theta), (2.0, rate))
        fits.append(found)
    exponent, error = mean_and_error([p for p, _ in fits])
    assert abs(exponent - 2.0) < 4 * error
    assert error < 0.05
    # With the exponent known, θ^(-1/2) = 1 + rate t.
    slopes = [np.polyfit(time[2:], theta[2:] ** -0.5, 1)[0] for time, _, theta, *_ in gases]
    slope, error = mean_and_error(slopes)
    assert abs(slope - rate) < 4 * error + 0.002 * rate
    assert error < 0.005 * rate
    shape, error = mean_and_error([gas.a2[3:].mean() for gas in gases])
    assert abs(shape - sonine(0.9)) < 4 * error
    assert shape < -5 * error  # the Gaussian is refuted
    assert haff(TIMES, 0.9)[-1] == pytest.approx((1 + rate * 30) ** -2)


def test_elastic_gases_keep_their_temperature_and_shape() -> None:
    gases = replicas(lambda v, theta, rng: 1.0, 2.0, 10.0, number=4)
    for time, _, theta, *_ in gases:
        np.testing.assert_allclose(theta, 2.0, rtol=1e-12)
        np.testing.assert_allclose(np.diff(time), 1.0, rtol=1e-12)  # ν is that of the Gaussian
    a2 = float(np.mean(np.concatenate([gas.a2 for gas in gases])))
    assert abs(a2) < 0.01  # 44 values that scatter by 0.73/√4000 each, not all independent


def test_only_the_mean_square_cools() -> None:
    """ε uniform on [-0.2, 1.4] at any speed: Haff's law with √<ε²>, but for 3 a2/16 in the rate, below 2 %.

    Negative ε and ε > 1 are in it; a constant <ε> = 0.6 would cool faster by half.
    """
    square = 0.36 + 1.6**2 / 12.0
    gases = replicas(lambda v, theta, rng: rng.uniform(-0.2, 1.4, v.size), 1.0, 12.0, number=6)
    slopes = [np.polyfit(time[3:], theta[3:] ** -0.5, 1)[0] for time, _, theta, *_ in gases]
    assert np.mean(slopes) == pytest.approx((1.0 - square) / 6.0, rel=0.02)
    assert (1.0 - 0.36) / (1.0 - square) > 1.49


def test_collisions_are_those_of_kinetic_theory() -> None:
    """In an elastic gas a particle has ν0 t of them."""
    gases = replicas(lambda v, theta, rng: 1.0, 1.0, 10.0, number=4)
    met = np.mean([gas.collisions[-1] / gas.time[-1] for gas in gases])
    assert met == pytest.approx(1.0, abs=4 / np.sqrt(4 * 4000 * 10 / 2))


def test_recorded_encounters_cool_as_the_grains_do() -> None:
    """Both temperatures of dumbbells L/R = 0.3 after 8 collisions, which take 0.35 of T_tr.

    4000 particles scatter by √(2/3·4000) = 1.3 % in each temperature, and 20 000 grains by half of it.
    """
    law, collisions = rs.Frictionless(normal=0.9), 8.0
    body = rs.Dumbbell(radius=3e-3, separation=0.9e-3)
    warm = body.mass * THETA
    exact = rs.gas.cool(body, law, particles=20_000, collisions=collisions, translational_temperature=warm)
    gas = spheres.cool(
        spheres.scaled(body, law, spheres.met(body, law, 6000, THETA), 6000, THETA)["kernel"],
        THETA,
        collisions,
        1,
        4000,
    )
    for found, name in ((gas.theta, "translational_temperature"), (gas.rotation, "rotational_temperature")):
        expected = np.interp(collisions, exact["collisions"], np.log(exact[name] / warm))
        assert expected < -0.08
        reached = np.interp(collisions, gas.collisions, np.log(found / THETA))
        assert reached == pytest.approx(expected, abs=4 * 0.014)
