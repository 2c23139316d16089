"""Times of impacts that are given: what is taken, what is refused, and the clock of a run."""

import math
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution import flight
from restitution.experiment.flight.times import check_series


def heard(**more: Any) -> xr.Dataset:
    """Give times of three impacts as a microphone does."""
    return xr.Dataset(
        {"time": ("impact", [0.0, 1.0, 1.9]), "uncertainty": ("impact", [1e-4] * 3)}
        | {name: ("impact", values) for name, values in more.items()}
    )


def units(data: xr.Dataset, name: str) -> xr.Dataset:
    data[name].attrs["units"] = "ms"
    return data


WRONG: list[tuple[Any, Any, str]] = [
    (heard(), 1e-4, r"^uncertainty = 0\.0001: must be left out: the Dataset has its own"),
    (xr.Dataset(), None, r"^times: a Dataset without time and uncertainty; it has nothing"),
    (
        heard().drop_vars("uncertainty").assign(speed=1.0),
        None,
        r"^times: a Dataset without uncertainty; it has time, speed",
    ),
    (
        xr.Dataset({"time": (("a", "b"), np.ones((2, 2))), "uncertainty": (("a", "b"), np.ones((2, 2)))}),
        None,
        r"^times: a Dataset whose time has dimensions \('a', 'b'\); must be one series of impacts",
    ),
    (
        heard().assign(uncertainty=(("impact", "way"), np.ones((3, 2)))),
        None,
        r"^times\.uncertainty has dimensions \(impact, way\): must be those of time, \(impact\)",
    ),
    (
        heard(flag=[0.0, 4.0, 7.0]),
        None,
        r"^times\.flag\[1\] = 4\.0: must be 0 to 3: good, doubtful, missed, doub",
    ),
    (heard(flag=["a", "b", "c"]), None, r"^times\.flag = .*: must be 0 to 3: good, doubtful"),
    (heard().assign(time=("impact", ["a", "b", "c"])), None, r"^times\.time = .*: must be numbers, in s"),
    (
        heard().assign(uncertainty=("impact", ["a", "b", "c"])),
        None,
        r"^times\.uncertainty = .*: must be numbers, in s",
    ),
    (units(heard(), "time"), None, r"^times.*time.*ms"),
    (units(heard(), "uncertainty"), None, r"^times.*uncertainty.*ms"),
    (xr.DataArray([0.0, 1.0], attrs={"units": "ms"}), None, r"^times.*ms"),
    ([0.0, 1.0], xr.DataArray([0.1, 0.1], attrs={"units": "ms"}), r"^uncertainty.*ms"),
    ([0.0, 1.0], "a", r"^uncertainty = 'a': must be numbers, in s"),
    ([[0.0, 1.0]], None, r"^times.*: must be a 1-D array of times in s"),
    (
        [0.0, 1.0, 2.0],
        [0.1, -0.1, -0.2],
        r"^uncertainty\[1\] = -0\.1: must be a number in \[0, 1e\+30\] \(s\)",
    ),
    ([0.0, 1.0], [0.1, math.nan], r"^uncertainty\[1\] = nan: must be a number in"),
    ([0.0, 2e30], None, r"^times\[1\] = 2e\+30: must be at most 1e\+30 s either way"),
]


@pytest.mark.parametrize(("times", "uncertainty", "message"), WRONG)
def test_wrong_times_are_named(times: Any, uncertainty: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        flight.restitution(times, uncertainty)


def test_times_that_are_just_right() -> None:
    """The largest numbers, flags that are not known, and errors of impacts that were missed."""
    data = flight.restitution([-1e30, 1e30], [1e30, 0.0])
    assert data["time"].to_numpy().tolist() == [-1e30, 1e30]
    assert np.isnan(flight.restitution(heard(flag=[np.nan, 0.0, 1.0]))["restitution"]).all()
    data = flight.restitution(heard(flag=[np.nan, 0.0, 1.0]), doubtful=True)
    assert float(data["restitution"][1]) == pytest.approx(0.9, rel=1e-12)
    missed = flight.restitution([0.0, 1.0, math.nan, 2.5], [1e-4, 1e-4, math.nan, 1e-4])
    assert np.isnan(missed["uncertainty"][2])
    np.testing.assert_array_equal(flight.restitution([0.0, 1.0, 1.9])["uncertainty"], 0.0)
    dropped = flight.restitution([0.0, 1.0], drop_height=1.0)
    assert dropped.attrs["drop_height_uncertainty"] == 0.0
    assert dropped["impact_velocity"].attrs["long_name"].startswith("normal velocity of the centre of mass")


def test_covariances_are_known_where_both_numbers_are() -> None:
    """NaN in every row and column of what the times do not tell, 0 nowhere."""
    times = [0.0, 0.5, 0.96, math.nan, 1.8, 2.2, 2.5]
    data = flight.restitution(times, 1e-4)
    v, e = (np.isfinite(data[name].to_numpy()) for name in ("impact_velocity", "restitution"))
    for name, rows, columns in (
        ("impact_velocity_covariance", v, v),
        ("restitution_covariance", e, e),
        ("cross_covariance", v, e),
    ):
        found = data[name].to_numpy()
        np.testing.assert_array_equal(np.isfinite(found), np.outer(rows, columns))
    variance = data["restitution_covariance"].to_numpy()[1, 1]
    ratio = (0.96 - 0.5) / 0.5
    # Of Δt_1/Δt_0, with the time between them in both.
    assert variance == pytest.approx(1e-8 * (1 + (1 + ratio) ** 2 + ratio**2) / 0.25, rel=1e-9)


@pytest.mark.parametrize("incline", [None, 0.3])
def test_the_clock_of_a_run_flight_by_flight(incline: float | None) -> None:
    """g Δt/2 with the normal part of g, and ratios of neighbours; none after a flight of no time."""
    times = np.array([[0.1, 0.5, 0.86, 0.86, 1.3], [0.2, 0.7, 1.1, np.nan, np.nan]])
    dims = ("particle", "impact")
    run = xr.Dataset(
        {
            "time": (dims, times, {"units": "s"}),
            "rebound_velocity": (dims, np.ones((2, 5)), {"units": "m s-1"}),
        },
        coords={"impact": np.arange(5)},
        attrs={"gravity": 9.8} | ({} if incline is None else {"incline": incline}),
    )
    found = flight.clock(run)
    g = 9.8 * math.cos(incline or 0.0)
    for p in range(2):
        for n in range(5):
            before = times[p, n] - times[p, n - 1] if n else math.nan
            after = times[p, n + 1] - times[p, n] if n < 4 else math.nan
            one = found.isel(particle=p, impact=n)
            assert float(one.clock_velocity) == pytest.approx(0.5 * g * before, rel=1e-12, nan_ok=True)
            ratio = after / before if before > 0 else math.nan
            assert float(one.clock_restitution) == pytest.approx(ratio, rel=1e-12, nan_ok=True)
    about = {name: found[name].attrs for name in ("clock_velocity", "clock_restitution")}
    assert about == {
        "clock_velocity": {
            "long_name": "impact velocity from the time of flight",
            "units": "m s-1",
            "symbol": "g Δt/2",
        },
        "clock_restitution": {
            "long_name": "coefficient of restitution from the times of flight",
            "units": "1",
        },
    }
    assert found.drop_vars(["clock_velocity", "clock_restitution"]).identical(run)


def test_a_clock_names_what_is_no_run() -> None:
    run = rs.simulate(
        rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9), particles=2, impacts=4
    )
    nothing: Any = 3
    with pytest.raises(ValueError, match=r"^data = 3: must be a Dataset from restitution.simulate"):
        flight.clock(nothing)
    without = run.copy()
    del without.attrs["gravity"]
    for wrong, said in (
        (without, "data lacks the attribute gravity"),
        (run.drop_vars("time"), "data lacks time"),
        (run.drop_vars("rebound_velocity"), "data lacks rebound_velocity"),
        (run.rename(impact="n"), r"data\.time has dimensions \(particle, n\)"),
    ):
        with pytest.raises(ValueError, match=f"^{said}"):
            flight.clock(wrong)
    other = run.copy()
    other["time"] = run["time"].copy()
    other["time"].attrs["units"] = "ms"
    with pytest.raises(ValueError, match=r"^data.*time.*ms"):
        flight.clock(other)


def test_a_series_is_no_longer_than_its_covariance_can_be() -> None:
    """Of 100 000 impacts it has 80 GB, which NumPy asked for; of 20 000 no Ctrl-C was heard for 16 s."""
    times = np.cumsum(0.3 * 0.9997 ** np.arange(3001))
    assert check_series(times[:3000], np.zeros(3000), "times", "uncertainty")[0].size == 3000
    many = "3001 impacts; must be at most 3000, all of which are correlated"
    with pytest.raises(ValueError, match=f"^times: {many}"):
        flight.restitution(times)
    given = xr.Dataset({"time": ("impact", times), "uncertainty": ("impact", np.full(3001, 1e-6))})
    with pytest.raises(ValueError, match=f"^times: {many}"):
        flight.restitution(given)
    with pytest.raises(ValueError, match=f"^times: {100_000} impacts"):
        flight.restitution(np.arange(1e5))
