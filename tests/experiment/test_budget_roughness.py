"""Roughness in the budget: spheres with exponential heights that fall, spin and bounce; ISO 3290."""

import math
from typing import Any

import numpy as np
import pytest

import restitution as rs
from reference.rough import Rough, hits, rebound

LAW = rs.Frictionless(normal=0.95)
BALL = rs.from_roundness(6e-3, 0.0)


def budget(law: Any = LAW, **change: Any) -> Any:
    setting = {"drop": 0.1, "impacts": 6, "particles": 50, "drag": None, "contact_time": 0.0} | change
    return rs.error_budget(BALL, law, **setting).data


@pytest.mark.parametrize(
    ("law", "tangential"), [(LAW, None), (rs.TangentialRestitution(normal=0.95, tangential=1.0), 1.0)]
)
def test_the_scatter_is_that_of_rough_spheres(law: Any, tangential: float | None) -> None:
    """Six impacts of 700 spheres; to five standard errors (kurtosis 6), and 6 % of the next order."""
    mean_height, number = 1e-3, 700
    body = Rough(20_000, 0.01, mean_height, exponential=True)
    spin, speed, found = np.zeros((number, 3)), np.ones(number), []
    for impact in range(6):
        met = hits(body, spin / speed[:, None] * [1.0, 1.0, 0.0], 60 + impact)
        epsilon, after = rebound(body, met, law.normal, tangential)
        spin = after * speed[:, None]
        spin[:, 2] = 0.0
        speed = speed * epsilon
        found.append(epsilon)
    # Ra is 2/e of the mean height.
    data = budget(law, roughness=2.0 / math.e * mean_height * 3e-3).sel(source="roughness")
    told, there = np.array(found).T, data.standard_deviation.values
    assert np.abs(told.std(axis=0) / there - 1.0) == pytest.approx(0.0, abs=5.0 * 0.042 + 0.06)
    away = told.mean(axis=0) - law.normal - data.bias.values
    assert np.all(np.abs(away) < 5.0 * there / np.sqrt(number) + 0.1 * np.abs(data.bias.values).max())
    mean = float(data.mean_standard_deviation)
    assert told.mean(axis=1).std() == pytest.approx(mean, rel=5.0 * 0.042 + 0.06)


def test_roughness_adds_up_with_the_others() -> None:
    data = budget(roughness=1e-7, timing=1e-5)
    parts = data.standard_deviation.sel(source=["shape", "roughness", "timing", "gravity", "clock"])
    total = np.sqrt((parts**2).sum("source"))
    assert data.standard_deviation.sel(source="total").values == pytest.approx(total.values)
    without = budget(timing=1e-5)
    assert float(without.standard_deviation.sel(source="roughness").max()) == 0.0
    twice = budget(roughness=2e-7)
    assert twice.bias.sel(source="roughness")[0] == pytest.approx(
        2.0 * float(data.bias.sel(source="roughness")[0])
    )


def test_spin_at_release_scatters_a_rough_ball_at_once() -> None:
    """σ₀ = (1 + ε_n)(ω/v) √(⟨d²⟩/3) at the first impact, ⟨d²⟩ = e Ra R, beside the loss."""
    data = budget(roughness=1e-8, spin=30.0)
    v = np.sqrt(2.0 * 9.81 * 0.1)
    expected = 1.95 * 30.0 / v * np.sqrt(math.e * 1e-8 * 3e-3 / 3.0)
    first = data.sel(source="roughness").isel(impact=0)
    assert np.hypot(expected, first.bias) == pytest.approx(float(first.standard_deviation))


def test_a_rough_ball_must_be_rounder_or_is_never_round_enough() -> None:
    asked: dict[str, Any] = {"diameter": 6e-3, "law": LAW, "drop": 0.1, "impacts": 10, "particles": 50}
    smooth = float(rs.required_roundness(1e-3, **asked))
    some = float(rs.required_roundness(1e-3, roughness=1e-7, **asked))
    assert 0.5 * smooth < some < smooth
    assert np.isnan(float(rs.required_roundness(1e-5, roughness=1e-7, **asked)))


def test_the_roughness_of_grades() -> None:
    """ISO 3290-1: finer grades are smoother, all to between 10 and 150 nm."""
    grades = (3, 5, 10, 16, 20, 24, 28, 40, 60, 100, 200)
    values = [rs.ball_roughness(grade) for grade in grades]
    assert values == sorted(values)
    assert (values[0], values[-2], values[-1]) == (1e-8, 1e-7, 1.5e-7)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"roughness": -1.0}, "roughness = -1.0"),
        ({"roughness": 1e-5}, "roughness = 1e-05: must be at most 0.001 of the radius"),
        (
            {"roughness": 1e-8, "law": rs.Coulomb(normal=0.9, friction=0.05)},
            "roughness = 1e-08: must be 0 but",
        ),
    ],
)
def test_what_is_refused(change: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        budget(**change)
