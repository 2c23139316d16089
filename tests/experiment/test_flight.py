"""Coefficients of restitution from times of flight: their values, and every error that goes into them."""

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.bouncing import flight_in_air, impact_times
from restitution.experiment.flight.chain import chain, measured, measured_of
from restitution.experiment.flight.setting import Once

CONSTANT = 0.9


def one_series(impacts: int = 8) -> np.ndarray:
    return impact_times(lambda _: CONSTANT, 2.0, impacts)


def test_a_sphere_in_vacuum_gives_back_its_speeds_and_its_coefficient() -> None:
    data = rs.flight.restitution(one_series())
    speeds = 2.0 * CONSTANT ** np.arange(8)
    assert np.isnan(data.impact_velocity[0])
    assert data.impact_velocity.values[1:] == pytest.approx(speeds[1:], rel=1e-12)
    assert data.restitution.values[1:-1] == pytest.approx(CONSTANT, rel=1e-12)
    assert np.isnan(data.restitution[[0, -1]]).all()


def test_a_known_drop_gives_the_first_impact_too() -> None:
    height = 2.0**2 / (2.0 * 9.81)
    data = rs.flight.restitution(one_series(), drop_height=height)
    assert float(data.impact_velocity[0]) == pytest.approx(2.0, rel=1e-12)
    assert float(data.restitution[0]) == pytest.approx(CONSTANT, rel=1e-12)


@pytest.mark.parametrize("drag", [None, rs.flight.Drag(terminal_velocity=6.0, uncertainty=0.2)])
def test_the_covariance_is_that_of_many_repetitions(drag: rs.flight.Drag | None) -> None:
    """Every measured number is drawn 500 times: standard errors agree to 5/√(2·500) = 16 %."""
    rng = np.random.default_rng(3)
    true, sigma, repetitions = one_series(6), 2e-5, 500
    setting: dict[str, Any] = {"gravity_uncertainty": 0.02, "drop_height_uncertainty": 1e-3}
    data = rs.flight.restitution(true, sigma, drop_height=0.2, drag=drag, **setting)
    drawn = []
    for _ in range(repetitions):
        terminal = 6.0 + 0.2 * rng.standard_normal()
        drawn.append(
            rs.flight.restitution(
                true + sigma * rng.standard_normal(true.size),
                gravity=9.81 + 0.02 * rng.standard_normal(),
                drop_height=0.2 + 1e-3 * rng.standard_normal(),
                drag=None if drag is None else rs.flight.Drag(terminal_velocity=terminal),
            )
        )
    speeds = np.array([one.impact_velocity.values for one in drawn])
    ratios = np.array([one.restitution.values for one in drawn])[:, :-1]
    within = 5.0 / math.sqrt(2.0 * len(drawn))
    assert data.impact_velocity_error.values == pytest.approx(speeds.std(0), rel=within)
    assert data.restitution_error.values[:-1] == pytest.approx(ratios.std(0), rel=within)
    # Correlations have errors of (1 - ρ²)/√n.
    sampled = np.corrcoef(ratios.T)
    errors = data.restitution_error.values[:-1]
    told = data.restitution_covariance.values[:-1, :-1] / np.outer(errors, errors)
    assert np.abs(told - sampled).max() < 5.0 / math.sqrt(len(drawn))
    crossed = np.array([[np.cov(speeds[:, i], ratios[:, j])[0, 1] for j in range(5)] for i in range(6)])
    scale = np.outer(data.impact_velocity_error.values, errors)
    assert (
        np.abs(data.cross_covariance.values[:, :-1] - crossed).max()
        < 5.0 / math.sqrt(len(drawn)) * scale.max()
    )


def test_neighbours_share_a_flight() -> None:
    """The covariance of equal flights, by hand."""
    s, flight = 1e-4, 0.4
    data = rs.flight.restitution(np.arange(5) * flight, s)
    # With Δt all equal, dε_i = (t_{i+1} - 2 t_i + t_{i-1})/Δt: (1, -2, 1) has variance 6, neighbours -4,
    # next 1.
    expected = np.array([[6.0, -4.0, 1.0], [-4.0, 6.0, -4.0], [1.0, -4.0, 6.0]]) * (s / flight) ** 2
    assert data.restitution_covariance.values[1:-1, 1:-1] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("speed", [0.3, 3.0, 12.0])
def test_drag_is_that_of_an_integrated_flight(speed: float) -> None:
    terminal = 8.0
    interval, landing = flight_in_air(speed, terminal)
    data = rs.flight.restitution(
        [0.0, interval, 1.5 * interval], drag=rs.flight.Drag(terminal_velocity=terminal)
    )
    assert float(data.impact_velocity[1]) == pytest.approx(landing, rel=1e-9)
    after, _ = flight_in_air(speed, terminal)
    assert after == interval
    # The ball left the impact before with `speed`.
    drop = rs.flight.restitution(
        [0.0, interval], drag=rs.flight.Drag(terminal_velocity=terminal), drop_height=1.0
    )
    assert float(drop.restitution[0] * drop.impact_velocity[0]) == pytest.approx(speed, rel=1e-9)


def test_a_drop_in_air_is_an_integrated_fall() -> None:
    """The second half of a flight is a fall from rest, from where the first half led."""
    terminal, speed = 5.0, 4.0
    _, landing = flight_in_air(speed, terminal)
    top = terminal**2 / (2.0 * 9.81) * math.log(1.0 + (speed / terminal) ** 2)
    data = rs.flight.restitution([0.0, 0.5], drop_height=top, drag=rs.flight.Drag(terminal_velocity=terminal))
    assert float(data.impact_velocity[0]) == pytest.approx(landing, rel=1e-9)


def test_a_strong_wind_of_no_matter_leaves_the_vacuum() -> None:
    without = rs.flight.restitution(one_series(), 1e-5)
    with_drag = rs.flight.restitution(one_series(), 1e-5, drag=rs.flight.Drag(terminal_velocity=1e7))
    for name in ("impact_velocity", "restitution", "restitution_error"):
        assert with_drag[name].values[1:-1] == pytest.approx(without[name].values[1:-1], rel=1e-9)


def test_drag_of_a_sphere() -> None:
    """Weight and drag balance at the terminal velocity; C_d that is off by 10 % moves it by 5 %."""
    drag = rs.flight.Drag.of_sphere(diameter=0.04, mass=2.7e-3, coefficient=0.5, coefficient_uncertainty=0.05)
    area = math.pi * 0.02**2
    assert 0.5 * 1.2 * 0.5 * area * drag.terminal_velocity**2 == pytest.approx(2.7e-3 * 9.81, rel=1e-12)
    assert drag.uncertainty == pytest.approx(0.05 * drag.terminal_velocity, rel=1e-12)
    usual = rs.flight.Drag.of_sphere(diameter=0.04, mass=2.7e-3)  # C_d = 0.45 ± 0.05, of smooth spheres
    assert usual.terminal_velocity == pytest.approx(drag.terminal_velocity / math.sqrt(0.9), rel=1e-12)
    assert usual.uncertainty == pytest.approx(0.5 * 0.05 / 0.45 * usual.terminal_velocity, rel=1e-12)


def test_missed_impacts_leave_gaps_and_doubled_ones_do_not_count() -> None:
    true = one_series(8)
    heard = xr.Dataset(
        {
            "time": ("impact", np.insert(true, 3, true[2] + 0.01)),
            "uncertainty": ("impact", np.full(9, 1e-5)),
            "flag": ("impact", np.array([0, 0, 0, 3, 0, 2, 1, 0, 0])),
        }
    )
    without = rs.flight.restitution(heard)
    assert np.flatnonzero(np.isnan(without.restitution)).tolist() == [0, 3, 4, 5, 6, 7]
    data = rs.flight.restitution(heard, doubtful=True)
    assert data.sizes["impact"] == 8
    assert np.flatnonzero(np.isnan(data.restitution)).tolist() == [0, 3, 4, 5, 7]
    assert data.restitution.values[[1, 2, 6]] == pytest.approx(CONSTANT, rel=1e-12)
    assert np.isfinite(data.restitution_covariance.values[1, [1, 2, 6]]).all()


@pytest.mark.parametrize(
    ("times", "keywords", "message"),
    [
        ([0.0, 0.4, 0.4], {}, "times[2] = 0.4: must be later than times[1] = 0.4"),
        ([0.0, 0.4, math.inf], {}, "times[2] = inf: must be at most 1e+30 s either way, or NaN"),
        ([0.0], {}, "times: 1 impacts; must be at least two"),
        ([0.0, math.nan], {}, "times: 1 of 2 are numbers; at least two must be"),
        ("abc", {}, "times = 'abc': must be a 1-D array of times in s"),
        (
            [0.0, 1.0],
            {"uncertainty": [1e-4]},
            "uncertainty: an array of shape (1,); must be one number, or one for",
        ),
        ([0.0, 1.0], {"uncertainty": -1.0}, "uncertainty[0] = -1.0: must be a number in [0, 1e+30] (s)"),
        ([0.0, 1.0], {"gravity": 0.0}, "gravity = 0.0: must be a real number in [1e-30, 1e+30] (m/s²)"),
        (
            [0.0, 1.0],
            {"drop_height": -0.1},
            "drop_height = -0.1: must be a real number in [1e-30, 1e+30] (m)",
        ),
        ([0.0, 1.0], {"drag": 3.0}, "drag = 3.0: must be a Drag, or None"),
    ],
)
def test_errors_name_what_is_wrong(times: object, keywords: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError) as error:  # noqa: PT011  # the text is compared
        rs.flight.restitution(times, **keywords)  # type: ignore[arg-type]
    assert str(error.value).startswith(message)


def test_several_series_are_not_taken_for_one() -> None:
    heard = xr.Dataset(
        {
            "time": ("impact", [0.0, 1.0, 2.0]),
            "uncertainty": ("impact", [1e-4] * 3),
            "series": ("impact", [0, 0, 1]),
        }
    )
    with pytest.raises(ValueError, match="a Dataset of series 0, 1; take one"):
        rs.flight.restitution(heard)
    assert rs.flight.restitution(heard.where(heard.series == 0, drop=True)).sizes["impact"] == 2


DRAG = rs.flight.Drag(terminal_velocity=6.0, uncertainty=0.2)


@pytest.mark.parametrize(
    ("drop", "drag"), [(None, None), ((0.2, 1e-3), DRAG), ((0.2, 1e-3), None), (None, DRAG)]
)
def test_a_dataset_says_what_was_measured(
    drop: tuple[float, float] | None, drag: rs.flight.Drag | None
) -> None:
    times = one_series(5)
    times[2] = np.nan
    height, error = drop if drop else (None, 0.0)
    data = rs.flight.restitution(
        times,
        2e-5,
        gravity=9.8,
        gravity_uncertainty=0.02,
        clock_uncertainty=3e-4,
        drop_height=height,
        drop_height_uncertainty=error,
        drag=drag,
    )
    found = measured_of(data)
    np.testing.assert_array_equal(found.times, times)
    assert (found.gravity, found.drop) == (9.8, height)
    assert found.terminal == (drag.terminal_velocity if drag else None)
    of_times = [0.0 if np.isnan(time) else 2e-5**2 for time in times]
    common = [0.02**2, error**2, drag.uncertainty**2 if drag else 0.0, 0.0, 3e-4**2]
    np.testing.assert_allclose(found.variances, [*of_times, *common], rtol=1e-14)


@pytest.mark.parametrize("drag", [None, DRAG])
def test_derivatives_of_a_chain_are_its_differences(drag: rs.flight.Drag | None) -> None:
    """By each time, g, drop, terminal velocity, contact time and clock; 0 where there is no speed."""
    times = one_series(6)
    times[3] = np.nan
    given = measured(times, np.full(6, 1e-5), Once(drop_height=0.2), drag, None)
    found = chain(given)
    assert np.isnan(found.before).tolist() == [False, False, False, True, True, False]
    assert np.isnan(found.after).tolist() == [False, False, True, True, False, True]
    for number in range(times.size + 5):
        step = np.zeros(times.size + 5)
        step[number] = 1e-5
        up, down = chain(given.moved(step)), chain(given.moved(-step))
        for by, one, other in (
            (found.before_by, up.before, down.before),
            (found.after_by, up.after, down.after),
        ):
            expected = np.nan_to_num((one - other) / 2e-5)
            np.testing.assert_allclose(by[:, number], expected, rtol=1e-6, atol=1e-7)


def bounced(coefficient: float, contact: float, impacts: int, speed: float = 1.4) -> np.ndarray:
    """Times of sounds of a ball that rests on the plate for `contact` v^(-1/5) at each impact."""
    times = [0.0]
    for _ in range(impacts - 1):
        times.append(times[-1] + contact * speed**-0.2 + 2.0 * coefficient * speed / 9.81)
        speed *= coefficient
    return np.array(times)


def test_the_time_of_contact_is_no_flight() -> None:
    """0.8 ms of a table-tennis ball: neglected, ε comes out .0004 high at 1 m/s; given, it is right."""
    times = bounced(0.9, 8e-4, 22)
    neglected = rs.flight.restitution(times, 1e-6).restitution.values[1:-1]
    assert 3e-4 < neglected[2] - 0.9 < 7e-4
    assert neglected[-1] - 0.9 > 1.2e-3
    known = rs.flight.restitution(times, 1e-6, contact_time=8e-4, drop_height=1.4**2 / 2.0 / 9.81)
    assert known.restitution.values[:-1] == pytest.approx(0.9, abs=5e-6)
    assert known.attrs["contact_time"] == 8e-4


def test_a_contact_in_air_lasts_as_long_as_the_speed_of_the_landing_says() -> None:
    """0.5 ms and a terminal velocity of 8.8 m/s, to 1 µs: no power law, and ε to its error."""
    times, speed = [0.0], 2.0
    for _ in range(16):
        contact = 5e-4 * speed**-0.2
        flight, speed = flight_in_air(0.9 * speed, 8.8)
        times.append(times[-1] + contact + flight)
    drag = rs.flight.Drag(terminal_velocity=8.8)
    known = rs.flight.restitution(times, 1e-9, contact_time=5e-4, drag=drag)
    assert known.restitution.values[2:-1] == pytest.approx(0.9, abs=2e-8)
    unknown = rs.flight.ContactTime(at_1_m_s=0.0, uncertainty=5e-4)
    data = rs.flight.restitution(times, 1e-7, contact_time=unknown, drag=drag)
    constant, power = (rs.flight.fit(data, law) for law in ("constant", "power law"))
    assert constant.aic - power.aic < 6.0
    assert abs(constant.parameters["restitution"] - 0.9) < 2.0 * constant.errors["restitution"]


def test_a_contact_that_is_known_to_an_error_makes_no_law_of_speed() -> None:
    """It moves all ε together: with its error a constant fits, which without one is refuted."""
    times = bounced(0.9, 2e-4, 20) + np.random.default_rng(1).normal(0.0, 1e-6, 20)
    for contact, refuted in ((None, True), (rs.flight.ContactTime(at_1_m_s=0.0, uncertainty=2e-4), False)):
        data = rs.flight.restitution(times, 1e-6, contact_time=contact)
        constant, power = (rs.flight.fit(data, law) for law in ("constant", "power law"))
        assert (constant.p_value < 1e-6) == refuted
        assert (constant.aic - power.aic > 6.0) == refuted
        if not refuted:
            error = constant.errors["restitution"]
            assert abs(constant.parameters["restitution"] - 0.9) < 4.0 * error < 1e-5


def test_contact_times_are_those_of_hertz_and_reissner() -> None:
    """20 mm of steel on glass: .09 ms (Hertz, as in Johnson's Contact Mechanics); table tennis: .75 ms."""
    steel = {"young_modulus": 2.1e11, "poisson_ratio": 0.3}
    glass = {"young_modulus": 7e10, "poisson_ratio": 0.22}
    found = rs.flight.ContactTime.of_spheres(diameter=0.02, mass=0.0327, ball=steel, plate=glass)
    modulus = 1.0 / (0.91 / 2.1e11 + (1.0 - 0.22**2) / 7e10)
    assert found.at_1_m_s == pytest.approx(2.87 * (0.0327**2 / (0.01 * modulus**2)) ** 0.2, rel=1e-12)
    assert 7e-5 < found.at_1_m_s < 1e-4
    assert found.uncertainty == pytest.approx(0.1 * found.at_1_m_s)
    for known in ({"mass": 2.7e-3}, {"wall": 4e-4}, {"mass": 2.7e-3, "wall": 4e-4}):
        hollow = rs.flight.ContactTime.possible(diameter=0.04, **known)
        assert hollow.at_1_m_s == 0.0
        assert 6e-4 < hollow.uncertainty < 9e-4
    assert rs.flight.ContactTime.possible(diameter=6e-3).uncertainty > 2.0 * 2.3e-5


@pytest.mark.parametrize("given", [-1.0, "short", np.inf])
def test_a_contact_time_is_a_time(given: object) -> None:
    with pytest.raises(
        ValueError, match=r"^contact_time = .*: must be a ContactTime, or a number of seconds"
    ):
        rs.flight.restitution([0.0, 0.4, 0.78], 1e-4, contact_time=given)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"^contact_time = 0\.2 s at 1 m/s: must be short beside"):
        rs.flight.restitution([0.0, 0.4, 0.78], 1e-4, contact_time=0.2)
