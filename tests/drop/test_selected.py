"""Datasets of which a part was selected: their own result or an error, never that of the whole."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution import flight

BODY = rs.Dumbbell(radius=3e-3, separation=3e-4)
LAW = rs.TangentialRestitution(normal=0.98)
TIMES = np.cumsum(0.9 ** np.arange(10.0))


@pytest.fixture(scope="module")
def run() -> xr.Dataset:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rs.EnergyWarning)
        return rs.simulate(BODY, LAW, particles=50, impacts=20, record="state")


@pytest.fixture
def series() -> xr.Dataset:
    return flight.restitution(TIMES, 1e-4, drop_height=0.125 * 9.81)


def test_a_fit_of_some_impacts(series: xr.Dataset) -> None:
    """Flights that shorten by 0.9 each, wherever the series is cut; the drop belongs to its first impact."""
    for part in (series, series.isel(impact=slice(3, 8)), series.isel(impact=slice(0, 6))):
        found = flight.fit(part).parameters["restitution"]
        assert found == pytest.approx(0.9, abs=1e-9), part.sizes
    with pytest.raises(ValueError, match=r"^data\.impact\[1\] = 2\.0: must be whole numbers >= 0 that rise"):
        flight.fit(series.isel(impact=[0, 2, 4, 5, 6, 7]))


def test_a_trajectory_needs_all_impacts_from_the_first(run: xr.Dataset) -> None:
    """The flight that leads to an impact begins at the one before it."""
    time = float(run.time[3, 5]) + 0.01
    whole = rs.trajectory(run.isel(impact=slice(0, 10)), 3, [time])
    assert whole.position.identical(rs.trajectory(run, 3, [time]).position)
    assert whole.position.identical(rs.trajectory(run.transpose(), 3, [time]).position)
    lacking = run.copy()
    del lacking.attrs["release_height"]
    bad: list[tuple[xr.Dataset, str]] = [
        (run.isel(impact=slice(5, None)), r"^data\.impact\[0\] = 5\.0: must be .* from 0, the first after"),
        (run.isel(impact=[0, 2, 3]), r"^data\.impact\[1\] = 2\.0: must be whole numbers >= 0 that rise"),
        (run.isel(component=[0]), r"^data\.component = .*: must be x, y, z"),
        (run.isel(particle=3), r"^data\.time has dimensions \(impact\): must be \(particle, impact\)"),
        (run.rename(component="axis_of_space"), r"^data\.position has dimensions"),
        (lacking, r"^data lacks the attribute release_height: must be a Dataset from rest"),
    ]
    for data, message in bad:
        with pytest.raises(ValueError, match=message):
            rs.trajectory(data, 3, [time])


def with_attribute(data: xr.Dataset, name: str, value: Any) -> xr.Dataset:
    return data.assign_attrs({name: value})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda run: run.isel(impact=[0, 2, 4]),
            r"^data\.impact\[1\] = 2\.0: must be whole numbers >= 0 that rise",
        ),
        (
            lambda run: run.assign(time=run.time.copy(data=(1e9 * run.time.values).astype("m8[ns]"))),
            r"^data\.time",
        ),
        (
            lambda run: with_attribute(run, "gravity", -1.0),
            r"^data\.gravity = -1\.0: must be a finite",
        ),
        (lambda run: with_attribute(run, "gravity", "9.81"), r"^data\.gravity = '9\.81': must be a finite"),
        (lambda run: with_attribute(run, "gravity", None), r"^data\.gravity = None: must be"),
        (lambda run: with_attribute(run, "gravity", 10**400), r"^data\.gravity = an integer of .*: must be"),
        (lambda run: with_attribute(run, "incline", None), r"^data\.incline = None: must be"),
    ],
)
def test_a_clock_of_no_run(run: xr.Dataset, change: Callable[[xr.Dataset], xr.Dataset], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        flight.clock(change(run))


def test_a_clock_of_a_part(run: xr.Dataset) -> None:
    """Any particles, in any order of the dimensions, and impacts from any on."""
    whole = flight.clock(run)
    turned = flight.clock(run.transpose())
    xr.testing.assert_identical(
        turned.clock_restitution.transpose("particle", "impact"), whole.clock_restitution
    )
    part = flight.clock(run.isel(impact=slice(4, None), particle=[7]))
    np.testing.assert_array_equal(part.clock_velocity[:, 1:], whole.clock_velocity[7:8, 5:])
    one = flight.clock(run.isel(particle=7))
    np.testing.assert_array_equal(one.clock_velocity, whole.clock_velocity[7])


def test_a_part_has_its_own_ledger_of_energy(run: xr.Dataset) -> None:
    """Impacts, and those that created energy, are counted among what is reduced."""
    part = run.isel(particle=[0, 3])
    found = rs.reduce(part, [0.0, 2.0], [-1.0, 3.0])
    gained = part.energy_ratio.values > 1.0 + 1e-12
    assert found.attrs["all_impacts"] == part.time.size
    assert found.attrs["energy_created_impacts"] == gained.sum()
    assert rs.reduce(run, [0.0, 2.0], [-1.0, 3.0]).attrs["all_impacts"] == run.attrs["all_impacts"]


def test_why_there_are_no_standard_errors() -> None:
    """Whatever kind of whole number asks for batches."""
    few = rs.simulate(BODY, LAW, particles=3, impacts=3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = rs.reduce(few, [0.0, 2.0], [-1.0, 3.0], batches=np.int8(100))  # type: ignore[arg-type]
        counted = rs.statistics(
            BODY,
            LAW,
            particles=3,
            impacts=3,
            velocity_bins=[0.0, 2.0],
            restitution_bins=[-1.0, 3.0],
            batches=np.int8(100),  # type: ignore[arg-type]
        )
    why = "none: 3 particles are fewer than two for each of 100 batches"
    assert found.attrs["standard_errors"] == counted.attrs["standard_errors"] == why


@pytest.mark.parametrize(
    ("name", "value"),
    [("gravity", 0.0), ("gravity", -1.0), ("gravity", None), ("gravity", "x"), ("gravity_uncertainty", -1.0)],
)
def test_a_fit_of_attributes_that_are_none(series: xr.Dataset, name: str, value: Any) -> None:
    with pytest.raises(ValueError, match=rf"^data\.{name} = .*: must be a real number in \[.*, 1e\+30\]"):
        flight.fit(series.assign_attrs({name: value}))


def test_a_fit_without_an_error_of_gravity(series: xr.Dataset) -> None:
    """It is then exact, as it is by default."""
    found = series.copy()
    del found.attrs["gravity_uncertainty"]
    assert flight.fit(found).parameters == flight.fit(series).parameters


BINS: dict[str, Any] = {
    "velocity_bins": np.linspace(0.1, 1.1, 6),
    "restitution_bins": np.linspace(0.5, 1.5, 40),
}


@pytest.fixture(scope="module")
def statistics() -> xr.Dataset:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rs.EnergyWarning)
        return rs.statistics(BODY, LAW, particles=400, impacts=100, **BINS)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            lambda s: s.drop_vars("restitution_underflow"),
            r"^statistics lacks restitution_underflow: must",
        ),
        (
            lambda s: s.isel(restitution_edge=slice(20)),
            r"^statistics\.restitution_edges has 20 edges",
        ),
        (
            lambda s: s.assign(restitution_count=s.restitution_count.astype(complex)),
            r"^statistics\.restitution_count = .*: must be whole numbers",
        ),
        (
            lambda _: rs.statistics(BODY, LAW, particles=4, impacts=5, counts_only=True, **BINS),
            r"^statistics lacks minimum, maximum: must be from .* counts_only=True leaves",
        ),
        (
            lambda _: rs.compare([BODY], [LAW], particles=4, impacts=5, **BINS),
            r"^statistics\.restitution_count has dimensions .*: must be \(velocity, restitution\); take one",
        ),
    ],
)
@pytest.mark.filterwarnings("ignore::restitution.EnergyWarning")
def test_statistics_that_no_distribution_is_made_of(
    statistics: xr.Dataset, change: Callable[[xr.Dataset], xr.Dataset], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        rs.FluctuatingRestitution.from_statistics(change(statistics))


def test_statistics_in_any_order(statistics: xr.Dataset) -> None:
    """Of their dimensions: the same distribution, and the same figure."""
    turned = statistics.transpose(*reversed(list(statistics.dims)))
    made = rs.FluctuatingRestitution.from_statistics(turned)
    assert made == rs.FluctuatingRestitution.from_statistics(statistics)


@pytest.mark.filterwarnings("ignore::restitution.EnergyWarning")
def test_figures_of_a_comparison() -> None:
    """One picture shows one of its statistics."""
    several = rs.compare([BODY], [LAW], particles=4, impacts=5, **BINS)
    for draw in (rs.figures.map, lambda found: rs.figures.densities(found, [0.5])):
        with pytest.raises(
            ValueError, match=r"^found\.restitution_count has dimensions .*; take one with sel"
        ):
            draw(several)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda s, _: rs.fit.slopes(s.drop_vars("number")),
            r"^data lacks number: must be from restitution\.statistics or reduce",
        ),
        (
            lambda _, run: rs.fit.slopes(run.isel(particle=[]), [0.1, 0.5, 1.0]),
            r"^data has 0 particles of 20 impacts: must have at least one of both",
        ),
        (
            lambda _, __: flight.restitution([0.0, 0.1, 9.0], drag=flight.Drag(terminal_velocity=1.0)),
            r"^times: a flight of 8\.9 s; must be at most 50 V/g = 5\.09\d+ s with a terminal velocity",
        ),
        (
            lambda _, __: flight.restitution([0.0, 1e-310, 1.0]),
            r"^times\[1\] = 1e-310: must be later than times\[0\] = 0\.0, by at least 1e-30 s",
        ),
    ],
)
@pytest.mark.filterwarnings("error")
def test_parts_that_say_nothing(
    statistics: xr.Dataset, run: xr.Dataset, call: Callable[[Any, Any], Any], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        call(statistics, run)
