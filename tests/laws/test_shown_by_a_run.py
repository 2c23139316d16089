"""Error budgets of laws whose parameters, or whose flights, a run of impacts does not show."""

from collections.abc import Callable
from typing import Any

import pytest

import restitution as rs
from restitution._internal.parameters import ParameterError
from restitution.experiment.budget import _sources

SETTING: dict[str, Any] = {"drop": 0.3, "particles": 50, "impacts": 5}
BALL = rs.Dumbbell(radius=3e-3, separation=3e-4)


def _budget(law: rs.Frictionless) -> rs.ErrorBudget:
    return rs.error_budget(BALL, law, **SETTING)


def _roundness(law: rs.Frictionless) -> rs.RequiredRoundness:
    return rs.required_roundness(1e-3, diameter=6e-3, law=law, **SETTING)


@pytest.mark.parametrize("call", [_budget, _roundness])
@pytest.mark.parametrize(
    ("normal", "parameters"),
    [
        # The ball falls at 2.43 m/s at most, and stays elastic.
        (rs.Plastic(yield_speed=2.45), "yield_speed"),
        (rs.Plastic(yield_speed=10.0), "yield_speed"),
        # All impacts have one speed, from which no exponent follows.
        (rs.Tabulated(v=[1.0], e=[1.0]), "restitution_at_1_m_s and exponent"),
    ],
)
def test_a_law_that_does_not_show(
    monkeypatch: pytest.MonkeyPatch,
    call: Callable[[rs.Frictionless], object],
    normal: rs.Plastic | rs.Tabulated,
    parameters: str,
) -> None:
    """ε_n = 1 at every speed of the run whatever the parameters: refused before anything is simulated."""
    monkeypatch.setattr(_sources, "simulate", lambda *_, **__: pytest.fail("simulated"))
    text = f"^law = .*: must be one from whose ε_n at the speeds .* m/s the {parameters} can be fitted"
    with pytest.raises(ParameterError, match=text):
        call(rs.Frictionless(normal=normal))


@pytest.mark.parametrize("yield_speed", [1e-3, 0.1, 2.4])
def test_the_yield_speed_is_found(yield_speed: float) -> None:
    """A law that is fitted to itself has its own parameter, also where only the first impact is plastic."""
    found = _budget(rs.Frictionless(normal=rs.Plastic(yield_speed=yield_speed))).data
    assert float(found.parameter_value[0]) == pytest.approx(yield_speed, rel=1e-9)


@pytest.mark.parametrize("normal", [1e-3, 1e-6, 1e-10, 1e-60])
def test_flights_that_doubles_do_not_resolve(normal: float) -> None:
    """The fifth flight lasts ε_n⁵ of the first fall: beside the time since release nothing is left of it."""
    with pytest.raises(ParameterError, match=r"^law = .*: must be one whose flights last at least 1e-10 of"):
        _budget(rs.Frictionless(normal=normal))


def test_a_sphere_of_short_flights_has_no_error_of_shape() -> None:
    """ε_n⁵ = 3·10⁻⁹ is resolved: what differs from ε_n is rounding, 10⁻¹⁶/(3·10⁻⁹) of a flight."""
    ball = rs.Dumbbell(radius=0.02, separation=0.0)
    found = rs.error_budget(ball, rs.Frictionless(normal=0.02), **SETTING).data.sel(source="shape")
    assert float(abs(found.bias).max()) < 1e-7
    assert float(found.standard_deviation.max()) < 1e-7
