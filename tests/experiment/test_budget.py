"""The error budget against closed forms, Monte Carlo and an integration that share no code with it."""

import math
from typing import Any

import numpy as np
import pytest
from test_measuring_pages import script

import restitution as rs
from reference.bouncing import told_in_air

ROUND = rs.from_roundness(6e-3, 0.0)
LAW = rs.Frictionless(normal=0.95)
SETTING: dict[str, Any] = {"drop": 0.1, "impacts": 12}


def deviation(data: object, source: str, name: str = "standard_deviation") -> np.ndarray:
    return data[name].sel(source=source).values  # type: ignore[index, no-any-return]


def test_errors_of_times_g_clock_and_drop_are_those_of_a_monte_carlo() -> None:
    """20 000 series, evaluated plainly: a standard deviation is known to 0.5 %, 4 of these are allowed."""
    rng = np.random.default_rng(3)
    n, error, g_error, h_error, clock_error = 12, 2e-4, 0.05, 1e-3, 4e-3
    data = rs.error_budget(
        ROUND,
        LAW,
        **SETTING,
        timing=error,
        gravity_uncertainty=g_error,
        clock_uncertainty=clock_error,
        drop_uncertainty=h_error,
    ).data
    flights = 2.0 / 9.81 * math.sqrt(2 * 9.81 * 0.1) * 0.95 ** np.arange(1, n + 1)
    times = np.concatenate([[0.0], np.cumsum(flights)])
    draws = 20_000
    rate = 1.0 + rng.normal(0.0, clock_error, (draws, 1))
    heard = np.diff((times + rng.normal(0.0, error, (draws, n + 1))) * rate)
    g, h = 9.81 + rng.normal(0.0, g_error, draws), 0.1 + rng.normal(0.0, h_error, draws)
    ratios = heard[:, 1:] / heard[:, :-1]
    assert deviation(data, "timing")[1:] == pytest.approx(ratios.std(axis=0), rel=0.02)
    # 2e-4 s is much, so that the bias shows: its sampling error is the deviation over √draws.
    bias = deviation(data, "timing", "bias")[1:]
    assert np.all(np.abs(ratios.mean(axis=0) - 0.95 - bias) < 4.0 * ratios.std(axis=0) / math.sqrt(draws))
    first = g * heard[:, 0] / 2.0 / np.sqrt(2.0 * g * h)
    sources = ("timing", "gravity", "clock", "drop")
    parts = [deviation(data, name)[0] for name in sources]
    assert math.hypot(*parts) == pytest.approx(first.std(), rel=0.02)
    mean = np.column_stack([first, ratios]).mean(axis=1)
    parts = [float(deviation(data, name, "mean_standard_deviation")) for name in sources]
    assert math.hypot(*parts) == pytest.approx(mean.std(), rel=0.02)


def test_the_fit_is_that_of_flight_fit() -> None:
    """The parameter's error of the budget beside the one that a fit of the same times tells."""
    data = rs.error_budget(
        ROUND, LAW, **SETTING, timing=1e-5, drop_uncertainty=1e-3, gravity_uncertainty=1e-3
    ).data
    flights = 2.0 / 9.81 * math.sqrt(2 * 9.81 * 0.1) * 0.95 ** np.arange(1, 13)
    times = np.concatenate([[0.0], np.cumsum(flights)])
    series = rs.flight.restitution(
        times, 1e-5, drop_height=0.1, drop_height_uncertainty=1e-3, gravity_uncertainty=1e-3
    )
    told = rs.flight.fit(series).errors["restitution"]
    sources = ("timing", "gravity", "clock", "drop")
    parts = [deviation(data, s, "parameter_standard_deviation")[0] for s in sources]
    assert math.hypot(*parts) == pytest.approx(told, rel=1e-3)


def test_drag_is_that_of_an_integration_of_the_motion() -> None:
    terminal = 9.0
    drag = rs.flight.Drag(terminal_velocity=terminal, uncertainty=0.5)
    data = rs.error_budget(ROUND, LAW, drop=0.5, impacts=6, drag=drag).data
    told = told_in_air(lambda _: 0.95, 0.5, terminal, 6)
    expected = told[1:] / told[:-1] - 0.95
    bias = deviation(data, "drag", "bias")
    assert bias == pytest.approx(expected, rel=1e-5)


def test_drag_that_is_corrected_for_leaves_its_uncertainty() -> None:
    drag = rs.flight.Drag(terminal_velocity=9.0, uncertainty=0.5)
    budgets = [
        rs.error_budget(ROUND, LAW, drop=0.5, impacts=6, drag=drag, drag_corrected=corrected)
        for corrected in (False, True)
    ]
    left, whole = (deviation(one.data, "drag") for one in budgets)
    assert left.tolist() == whole.tolist()
    assert not deviation(budgets[1].data, "drag", "bias").any()
    assert "| air drag, neglected |" in budgets[0].table()
    assert "| air drag |" in budgets[1].table()
    assert "spin" not in budgets[1].table()


def test_weak_drag_is_the_first_order_of_its_series() -> None:
    """-ε (1 + ε²) v²/(4 V²), and an error of V counts twice; what is left is of order v²/V² = 1e-3."""
    drag = rs.flight.Drag(terminal_velocity=100.0, uncertainty=2.0)
    data = rs.error_budget(ROUND, LAW, drop=0.5, impacts=6, drag=drag).data
    bias = deviation(data, "drag", "bias")[1:]
    first = -0.95 * (1 + 0.95**2) * data.impact_velocity.values[1:] ** 2 / (4.0 * 100.0**2)
    assert bias == pytest.approx(first, rel=0.01)
    assert deviation(data, "drag")[1:] == pytest.approx(-2.0 * bias * 0.02, rel=0.01)


@pytest.mark.parametrize(
    "law", [rs.Frictionless(normal=0.95), rs.TangentialRestitution(normal=0.95, tangential=1.0)]
)
def test_where_the_ball_turns_far_the_scatter_is_the_closed_form(law: rs.Frictionless) -> None:
    """K > 10: angles are independent. 4000 drops know a deviation to 2 %, the next order in t is t/R = 3 %,
    and 2 J_2(K) is up to 0.5 of ω² at the first of many kicks."""
    body = rs.from_roundness(6e-3, 8e-5)
    data = rs.error_budget(body, law, drop=0.4, impacts=8, particles=4000, drag=None).data
    assert float(data.kick.min()) > 10.0
    found, closed = deviation(data, "shape"), data.turning_standard_deviation.values
    assert found[1:] == pytest.approx(closed[1:], rel=0.17)
    bias, sampled = deviation(data, "shape", "bias"), deviation(data, "shape", "bias_error")
    assert np.all(np.abs(bias - data.turning_bias.values)[1:] < 5.0 * sampled[1:] + 0.5 * abs(bias[1]))


@pytest.mark.parametrize("deviation_of_form", [1e-6, 1e-5, 3e-5])
def test_at_every_kick_the_scatter_is_that_of_the_kicked_rotor(deviation_of_form: float) -> None:
    """A map that shares nothing with the engine; both are sampled, so 10 % for 2 · 4000 drops."""
    rotor = script("roundness").kicked(deviation_of_form, 2, 4000, 12, seed=5)
    body = rs.from_roundness(6e-3, deviation_of_form)
    data = rs.error_budget(body, LAW, drop=0.1, impacts=12, particles=4000, drag=None).data
    assert deviation(data, "shape")[1:] == pytest.approx(rotor.std(axis=0)[1:], rel=0.1)


def test_spin_of_a_turning_ball_adds_what_the_closed_form_says() -> None:
    """ω_0 turns the ball by some radians in a flight, the kicks by little: ε scatters by c (dh/dt)/v.

    At release the angle is uniform and not yet the axis: (1/6)^½ for (8/45)^½, 3 % less, at the first.
    """
    body = rs.from_roundness(6e-3, 1e-6)
    data = rs.error_budget(body, LAW, drop=0.1, impacts=5, spin=200.0, particles=4000, drag=None).data
    assert deviation(data, "spin")[1:] == pytest.approx(data.turning_standard_deviation.values[1:], rel=0.1)


def test_all_at_once_is_the_total() -> None:
    """Drops with a spin on a tilted plate, timed with errors, beside the sum of the parts."""
    ball = rs.from_roundness(6e-3, 3e-5)
    given: dict[str, Any] = {"timing": 2e-4, "tilt": 0.02, "spin": 20.0}
    data = rs.error_budget(ball, LAW, **SETTING, **given, particles=4000, drag=None, seed=8).data
    run = rs.simulate(
        ball,
        LAW,
        particles=4000,
        impacts=13,
        release_height=3e-3 + 0.1 * math.cos(0.02),
        spin=rs.RandomSpin(rate=20.0),
        incline=0.02,
        seed=99,
    )
    times = run.time.values + np.random.default_rng(1).normal(0.0, 2e-4, run.time.shape)
    flights = np.diff(times, axis=1)
    ratios = flights[:, 1:] / flights[:, :-1]
    assert deviation(data, "total")[1:] == pytest.approx(ratios.std(axis=0), rel=0.1)


def test_a_required_roundness_keeps_the_error_that_was_asked_for() -> None:
    needed = rs.required_roundness(1e-3, diameter=6e-3, law=LAW, **SETTING, quantity="single")
    body = rs.from_roundness(6e-3, float(needed))
    data = rs.error_budget(body, LAW, **SETTING, particles=4000, drag=None, seed=7).data
    square = deviation(data, "shape") ** 2 + deviation(data, "shape", "bias") ** 2
    # Interpolated between four values of a decade, each sampled with 400 drops.
    assert math.sqrt(square.mean()) / 0.95 == pytest.approx(1e-3, rel=0.3)
    assert needed.grade == 500 or needed.grade == 200
    assert needed.allowed(1e-2, "single") > float(needed)
    assert len(needed.table().splitlines()) == 7
    assert repr(needed).startswith("Out-of-roundness for an error of 0.1 % in one coefficient: ")


def test_materials_are_fitted_by_their_own_law() -> None:
    metal = rs.Plastic(yield_speed=0.05)
    budget = rs.error_budget(
        ROUND,
        rs.Frictionless(normal=metal),
        drop=0.1,
        impacts=5,
        timing=1e-6,
        gravity_uncertainty=0.0,
        clock_uncertainty=0.0,
        drag=None,
        contact_time=0.0,
    )
    assert budget.data.parameter.values.tolist() == ["yield_speed"]
    assert float(budget.data.parameter_value[0]) == pytest.approx(0.05, rel=1e-6)
    assert deviation(budget.data, "timing", "fit_standard_deviation") == pytest.approx(
        deviation(budget.data, "total", "fit_standard_deviation"), rel=1e-6
    )
    assert "yield speed (m/s)" in budget.table()
    assert budget.table() in repr(budget)
    assert len(budget.figure().axes) == 1


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"drop": 0.0}, r"^drop = 0.0: must be a finite number > 0 \(m\)"),
        ({"impacts": 2}, r"^impacts = 2: must be a whole number in \[3, 1000\]"),
        ({"impacts": 10**12}, r"^impacts = 1000000000000: must be a whole number in \[3, 1000\]"),
        ({"timing": -1.0}, r"^timing = -1.0"),
        ({"tilt": 1.0}, r"^tilt = 1.0: must be a real number in \[0, 0.5\)"),
        ({"drag": 3}, r'^drag = 3: must be a Drag, "sphere" or None'),
        ({"body": 1}, r"^body = 1: must be a Dumbbell"),
        ({"law": "hard"}, r"^law = 'hard': must be a law"),
        ({"law": rs.Frictionless(normal=0.0)}, r"^law = .*under which a ball bounces"),
        (
            {"body": rs.Dumbbell(radius=3e-3, separation=3e-3), "impacts": 30},
            r"^impacts = 30, drop = .*: only \d+ %",
        ),
    ],
)
def test_what_cannot_be_budgeted_is_refused(change: dict[str, object], message: str) -> None:
    given: dict[str, object] = {"body": ROUND, "law": LAW, "drop": 0.1, "impacts": 10} | change
    with pytest.raises(ValueError, match=message):
        rs.error_budget(given.pop("body"), given.pop("law"), **given)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"precision": 0.0}, r"^precision = 0.0"),
        ({"quantity": "all"}, r"^quantity = 'all'"),
        ({"law": "smooth"}, "^law"),
        ({"lobes": "two"}, r"^lobes = 'two'"),
        ({"lobes": 0}, r"^lobes = 0"),
    ],
)
def test_what_no_roundness_gives_is_refused(change: dict[str, object], message: str) -> None:
    given: dict[str, object] = {"precision": 1e-3, "diameter": 6e-3, "law": LAW, "drop": 0.1} | change
    with pytest.raises(ValueError, match=message):
        rs.required_roundness(given.pop("precision"), **given)  # type: ignore[arg-type]


def test_unknown_friction_is_between_none_and_sticking() -> None:
    """Half of the balls slide, half stick: mean and mean square of the errors are those of the two halves."""
    given: dict[str, Any] = {"drop": 0.1, "impacts": 12, "particles": 400, "roughness": 1e-8, "drag": None}
    ball = rs.from_roundness(6e-3, 6e-5)
    slides, sticks, unknown = (
        rs.error_budget(ball, law, **given).data
        for law in (rs.Frictionless(normal=0.93), rs.Coulomb(normal=0.93, friction=0.3), 0.93)
    )
    for source in ("shape", "roughness"):
        one, other, both = (data.sel(source=source) for data in (slides, sticks, unknown))
        np.testing.assert_allclose(both.bias, 0.5 * (one.bias + other.bias), atol=1e-12)
        squares = [each.bias**2 + each.standard_deviation**2 for each in (one, other, both)]
        np.testing.assert_allclose(squares[2], 0.5 * (squares[0] + squares[1]), rtol=5e-3)
    assert "friction unknown" in unknown.attrs["law"]
    # A full ball that sticks has 2/7 of the spin, and its scatter goes as the spin.
    ratio = float(
        sticks.standard_deviation.sel(source="shape")[-1] / slides.standard_deviation.sel(source="shape")[-1]
    )
    assert 2 / 7 * 0.75 < ratio < 2 / 7 * 1.35


@pytest.mark.parametrize(
    ("law", "needed"),
    [(rs.Frictionless(normal=0.95), 33e-6), (rs.Coulomb(normal=0.95, friction=0.2), 57e-6), (0.95, 40e-6)],
)
def test_friction_allows_balls_that_are_less_round(law: object, needed: float) -> None:
    found = rs.required_roundness(1e-3, diameter=6e-3, law=law, drop=0.1)  # type: ignore[arg-type]
    assert float(found) == pytest.approx(needed, rel=0.05)


def test_a_contact_that_is_not_given_is_not_nothing() -> None:
    """Neglected, 0.2 ms at 1 m/s is the bias of times with that delay; not given, it may be a plastic's."""
    setting: dict[str, Any] = {"drop": 0.1, "impacts": 8, "particles": 50, "drag": None}
    law, speed, times = rs.Frictionless(normal=0.9), np.sqrt(2.0 * 9.81 * 0.1), [0.0]
    for _ in range(9):
        times.append(times[-1] + 2e-4 * speed**-0.2 + 2.0 * 0.9 * speed / 9.81)
        speed *= 0.9
    heard = rs.flight.restitution(times, 1e-6, drop_height=0.1).restitution.values[:8]
    budget = rs.error_budget(ROUND, law, contact_time=2e-4, **setting)
    bias = budget.data.bias.sel(source="contact").values
    assert bias == pytest.approx(heard - 0.9, rel=0.02)
    assert "time of contact, neglected" in budget.table()
    open_still = rs.error_budget(ROUND, law, **setting)
    possible = rs.flight.ContactTime.possible(diameter=6e-3)
    there = open_still.data.standard_deviation.sel(source="contact").values
    assert there == pytest.approx(np.abs(bias) * possible.uncertainty / 2e-4, rel=0.1)
    assert "time of contact, not given" in open_still.table()
    known = rs.error_budget(ROUND, law, contact_time=2e-4, contact_corrected=True, **setting)
    assert float(np.abs(known.data.bias.sel(source="contact")).max()) == 0.0
    asked: dict[str, Any] = {"diameter": 6e-3, "law": law, "drop": 0.1, "particles": 50}
    assert np.isnan(float(rs.required_roundness(1e-4, contact_time=2e-3, **asked)))
    assert float(rs.required_roundness(1e-3, contact_time=0.0, **asked)) > 1e-5
