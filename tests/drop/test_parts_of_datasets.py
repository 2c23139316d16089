"""Parts of runs, of series and of comparisons: what follows from them is that of the whole, or is refused."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution import figures, fit, flight

BODY, LAW = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
RUN = rs.simulate(BODY, LAW, particles=20, impacts=12, record="state")
TIMES = np.cumsum(0.9 ** np.arange(10.0))
MEASURED = flight.restitution(TIMES, 1e-4, drop_height=1.0)
SPEEDS, RATIOS = np.linspace(0.7, 1.0, 4), np.linspace(-1.0, 3.0, 101)


def test_the_motion_of_later_impacts_is_not_that_from_the_release() -> None:
    """Without the first impacts nobody knows where the particle flew: it would be below the plane."""
    later = RUN.isel(impact=slice(5, None))
    when = float(RUN.time[3, 2:4].mean())
    alone = rs.trajectory(RUN.isel(particle=[3]), 3, when)
    assert alone.position.values[0, 2] > 0.0
    for part in (RUN.isel(impact=slice(0, 6)), RUN.transpose()):
        assert rs.trajectory(part, 3, when).position.identical(alone.position)
    lacking = RUN.copy()
    del lacking.attrs["release_height"]
    with pytest.raises(ValueError, match=r"^data lacks the attribute release_height: must be a Dataset from"):
        rs.trajectory(lacking, 3, when)
    for draw in (lambda: rs.trajectory(later, 3, when), lambda: figures.trajectory(later)):
        with pytest.raises(
            ValueError, match=r"^data.impact\[0\] = 5.0: must be whole numbers .*, from 0, the"
        ):
            draw()


def test_a_fit_to_later_impacts_needs_no_drop() -> None:
    """Constant ε = 0.9; the height of the drop says nothing of the fourth impact."""
    found = flight.fit(MEASURED.isel(impact=slice(3, 8)))
    alone = flight.fit(flight.restitution(TIMES[3:8], 1e-4))
    assert found.parameters["restitution"] == pytest.approx(0.9, abs=1e-12)
    assert str(found) == str(alone)
    with pytest.raises(ValueError, match=r"^data.impact\[1\] = 2.0: must be whole numbers >= 0 that rise"):
        flight.fit(MEASURED.isel(impact=[0, 2, 4]))
    with pytest.raises(ValueError, match=r"^times.impact\[1\] = 2.0: must be whole numbers >= 0 that rise"):
        flight.restitution(MEASURED.isel(impact=[0, 2, 4]))


def test_a_fit_without_an_error_of_gravity() -> None:
    """It is then exact, as one of an earlier version was, which knew of no error of the clock, either."""
    found = MEASURED.copy()
    del found.attrs["gravity_uncertainty"], found.attrs["clock_uncertainty"]
    exact = MEASURED.assign_attrs(gravity_uncertainty=0.0, clock_uncertainty=0.0)
    assert flight.fit(found).parameters == flight.fit(exact).parameters


def test_a_clock_of_impacts_that_follow_one_another() -> None:
    """Of later ones it is what it is in the whole run, and so it is however the run is turned."""
    whole = flight.clock(RUN).clock_velocity.values
    assert np.array_equal(flight.clock(RUN.transpose()).clock_velocity.values, whole, equal_nan=True)
    later = flight.clock(RUN.isel(impact=slice(5, None))).clock_velocity.values
    assert np.array_equal(later[:, 1:], whole[:, 6:], equal_nan=True)
    one = flight.clock(RUN.isel(particle=3)).clock_velocity.values
    assert np.array_equal(one, whole[3], equal_nan=True)
    with pytest.raises(ValueError, match=r"^data.impact\[1\] = 2.0"):
        flight.clock(RUN.isel(impact=[0, 2, 4]))


def test_how_successive_impacts_depend_on_each_other() -> None:
    """Every second one has a later one after it, and a lag that is counted would be half of what it is."""
    flown = rs.simulate(BODY, LAW, particles=300, impacts=20)
    learned = rs.FluctuatingRestitution.from_statistics(rs.reduce(flown, SPEEDS, RATIOS))
    for measure in (learned.memory, lambda data: fit.dependence(data, SPEEDS)):
        measure(flown.isel(impact=slice(5, None)))
        for given, text in (
            (flown.isel(impact=slice(None, None, 2)), r"\.impact\[1\] = 2\.0: must be whole numbers >= 0"),
            (flown.drop_vars("impact").isel(impact=slice(5, None)), " lacks the coordinate impact: must"),
        ):
            with pytest.raises(ValueError, match=rf"^data{text}"):
                measure(given)


def test_one_of_a_comparison() -> None:
    """Say how to take one body and one law where needed; lines of one law are named by their bodies."""
    bodies = {name: rs.Dumbbell(radius=3e-3, separation=L) for name, L in (("a", 3e-4), ("b", 3e-3))}
    bins: dict[str, Any] = {"velocity_bins": SPEEDS, "restitution_bins": RATIOS}
    found = rs.compare(bodies, [LAW], particles=300, impacts=20, **bins)
    text = r"has dimensions \(body, law, velocity.*\): must be .*; take one with sel\(body=..., law=...\)"
    for call in (
        rs.FluctuatingRestitution.from_statistics,
        figures.map,
        lambda data: figures.densities(data, 0.75),
    ):
        with pytest.raises(ValueError, match=text):
            call(found)
        call(found.sel(body="a").isel(law=0))
    (axes,) = figures.scatter(found.isel(law=0)).axes
    assert axes.get_legend_handles_labels()[1] == ["a", "b"]
    assert [len(axes.lines) for axes in figures.moments(found).axes] == 4 * [2]


def test_statistics_in_any_order_or_in_part() -> None:
    """Of their dimensions: the same distribution; what is left of them must fit together."""
    found = rs.reduce(rs.simulate(BODY, LAW, particles=300, impacts=20), SPEEDS, RATIOS)
    turned = found.transpose(*reversed(list(found.dims)))
    make = rs.FluctuatingRestitution.from_statistics
    assert make(turned) == make(found)
    for part, text in (
        (found.drop_vars("restitution_underflow"), r" lacks restitution_underflow: must"),
        (found.isel(restitution_edge=slice(20)), r"\.restitution_edges has 20 edges"),
        (
            found.assign(restitution_count=found.restitution_count.astype(complex)),
            r"\.restitution_count = .*: must be whole",
        ),
    ):
        with pytest.raises(ValueError, match=f"^statistics{text}"):
            make(part)


def _posterior(data: xr.Dataset, **changed: Any) -> Any:
    given: dict[str, Any] = {"diameter": 6e-3, "particles": 100, "draws": 100, "elongation": (1e-2, 3e-2)}
    return rs.posterior(data, rs.Frictionless(normal=0.9), **given | changed)


def test_a_posterior_of_the_first_impacts() -> None:
    """The last coefficient took a time that is not there any more: it is not simulated."""
    first = MEASURED.isel(impact=slice(0, 8), other_impact=slice(0, 8))
    assert "for a ball of the form 'dumbbell'" in _posterior(first).attrs["verdict"]
    with pytest.raises(ValueError, match=r"^data has 8 impacts and 10 of other_impact: must be the same"):
        _posterior(MEASURED.isel(impact=slice(0, 8)))
    with pytest.raises(ValueError, match=r"^data.impact\[0\] = 2.0"):
        _posterior(MEASURED.isel(impact=slice(2, None), other_impact=slice(2, None)))


def test_a_ball_of_one_coefficient_is_a_line() -> None:
    """A sphere has ε = ε_n at every speed: a point mass, which has no density."""
    sphere = rs.Dumbbell(radius=3e-3, separation=0.0)
    learned = rs.FluctuatingRestitution.learn(sphere, LAW, particles=400, velocities=(0.3, 0.6))
    (axes,) = figures.densities(learned, 0.4).axes
    assert np.allclose(np.asarray(axes.lines[0].get_xdata()), 0.98)


def test_impacts_without_their_numbers() -> None:
    """All of a run are as many as it says that it has; of some, and of a series, nobody knows which."""
    when = float(RUN.time[3, 2:4].mean())
    bare = RUN.drop_vars("impact")
    assert rs.trajectory(bare, 3, when).equals(rs.trajectory(RUN, 3, when))
    assert flight.clock(bare).equals(flight.clock(RUN).drop_vars("impact"))
    later, second = bare.isel(impact=slice(5, None)), bare.isel(impact=slice(None, None, 2))
    for call in (
        lambda: rs.trajectory(later, 3, when),
        lambda: figures.trajectory(later),
        lambda: flight.clock(second),
        lambda: flight.fit(MEASURED.isel(impact=slice(3, 8)).drop_vars("impact")),
    ):
        with pytest.raises(ValueError, match=r"^data lacks the coordinate impact: must have the numbers"):
            call()


def _level(data: xr.Dataset, name: str, value: float) -> xr.Dataset:
    """The same number all over."""
    return data.assign({name: 0.0 * data[name].fillna(0.0) + value})


BINS: dict[str, Any] = {"velocity_bins": SPEEDS, "restitution_bins": RATIOS}
COUNTED = rs.reduce(rs.simulate(BODY, LAW, particles=300, impacts=20), SPEEDS, RATIOS)
LEARNED = rs.FluctuatingRestitution.from_statistics(COUNTED)
FITTED = flight.fit(MEASURED)
WITHOUT_MOMENTS = rs.statistics(BODY, LAW, particles=100, impacts=20, counts_only=True, **BINS)
REFUSED: list[tuple[Callable[[Any], object], Any, str]] = [
    (figures.trajectory, RUN.isel(particle=[]), r"data has \d+ particles of \d+ impacts: must have at"),
    (figures.trajectory, RUN.assign(time=RUN.time[:, ::-1].variable), r"data\.time\[\d+\] = .*: must be"),
    *(
        (lambda data: rs.trajectory(data, 3, 0.1), turned, r"data\.component = .*: must be x, y, z")
        for turned in (RUN.isel(component=[2, 1, 0]), RUN.isel(component=[2, 1, 0]).drop_vars("component"))
    ),
    *(
        (lambda data: flight.figure(data, FITTED), _level(MEASURED, name, value), rf"data\.{name}\[\d\] = ")
        for name, value in (
            ("impact_velocity", 0.0),
            ("impact_velocity", np.nan),
            ("restitution_error", 1e308),
        )
    ),
    # A coefficient of nothing, after which balls fly on; errors that leave nothing to weigh.
    (_posterior, _level(MEASURED, "restitution", 5e-324), "data: no ball of these shapes bounces as often"),
    *(
        (_posterior, _level(MEASURED, "restitution_covariance", value), r"data\.restitution_covariance = ")
        for value in (1e30, -1.0)
    ),
    (lambda data: _posterior(data, diameter=1e6), MEASURED, "diameter = 1000000.0, elongation = .*: gives"),
    *(
        (rs.FluctuatingRestitution, _level(LEARNED.data, "edges", value), r"data\.edges\[0\] = .*: must be")
        for value in (1e300, 0.5, -1.0)
    ),
    *(
        (rs.FluctuatingRestitution.from_statistics, data, f"statistics{said}")
        for data, said in (
            (COUNTED.drop_attrs(), " lacks the attribute source: must be from"),
            (WITHOUT_MOMENTS, " lacks minimum, maximum: .* counts_only=True leaves the"),
            (_level(COUNTED, "minimum", 99.0), r".minimum\[0\] = 99.0: must be in \["),
            (_level(COUNTED, "maximum", 99.0), r".maximum\[0\] = 99.0: must be in \["),
        )
    ),
]


@pytest.mark.parametrize(("take", "given", "said"), REFUSED, ids=range(len(REFUSED)))
def test_what_is_refused(take: Callable[[Any], object], given: Any, said: str) -> None:
    """What is harmed, in our words; `test_harmed_datasets` draws from all harms of all functions."""
    with pytest.raises(ValueError, match=f"(?s)^{said}"):
        take(given)
