"""Parts of runs, of series and of comparisons: what follows from them is that of the whole, or is refused."""

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


@pytest.mark.parametrize(
    ("name", "value"),
    [("gravity", 0.0), ("gravity", None), ("gravity", "x"), ("gravity_uncertainty", -1.0)],
)
def test_a_fit_of_attributes_that_are_none(name: str, value: Any) -> None:
    with pytest.raises(ValueError, match=rf"^data\.{name} = .*: must be a real number in \[.*, 1e\+30\]"):
        flight.fit(MEASURED.assign_attrs({name: value}))


def test_a_fit_without_an_error_of_gravity() -> None:
    """It is then exact, as it is by default."""
    found = MEASURED.copy()
    del found.attrs["gravity_uncertainty"]
    assert flight.fit(found).parameters == flight.fit(MEASURED).parameters


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


@pytest.mark.parametrize("value", [-1, "9.81", None, 10**400, np.ma.masked])
def test_a_clock_needs_gravity(value: Any) -> None:
    with pytest.raises(ValueError, match=r"^data.gravity = .*: must be a finite number > 0"):
        flight.clock(RUN.assign_attrs(gravity=value))


def test_one_of_a_comparison() -> None:
    """Say how to take one body and one law where needed; lines of one law are named by their bodies."""
    bodies = {name: rs.Dumbbell(radius=3e-3, separation=L) for name, L in (("a", 3e-4), ("b", 3e-3))}
    bins: dict[str, Any] = {"velocity_bins": SPEEDS, "restitution_bins": RATIOS}
    found = rs.compare(bodies, [LAW], particles=300, impacts=20, **bins)
    text = r"has dimensions \(body, law, velocity.*\): must be .*; take one with sel\(body=..., law=...\)"
    for call in (
        rs.FluctuatingRestitution.from_statistics,
        figures.map,
        figures.moments,
        lambda data: figures.densities(data, 0.75),
    ):
        with pytest.raises(ValueError, match=text):
            call(found)
        call(found.sel(body="a").isel(law=0))
    (axes,) = figures.scatter(found.isel(law=0)).axes
    assert axes.get_legend_handles_labels()[1] == ["a", "b"]


def test_counts_only_has_no_moments() -> None:
    found = rs.statistics(
        BODY,
        LAW,
        particles=100,
        impacts=20,
        velocity_bins=SPEEDS,
        restitution_bins=RATIOS,
        counts_only=True,
    )
    with pytest.raises(
        ValueError, match=r"^statistics lacks minimum, maximum: .* counts_only=True leaves the"
    ):
        rs.FluctuatingRestitution.from_statistics(found)


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


def test_extremes_are_in_the_outermost_bins() -> None:
    """A largest restitution beyond the bins that hold any would be a density where there is none."""
    found = rs.reduce(rs.simulate(BODY, LAW, particles=300, impacts=20), SPEEDS, RATIOS)
    for name in ("minimum", "maximum"):
        with pytest.raises(ValueError, match=rf"^statistics.{name}\[0\] = 99.0: must be in \["):
            rs.FluctuatingRestitution.from_statistics(found.assign({name: 0.0 * found[name] + 99.0}))


def test_nothing_recorded() -> None:
    for nothing in (RUN.isel(particle=[]), RUN.isel(impact=[])):
        for call in (lambda data: fit.slopes(data, SPEEDS), figures.trajectory):
            with pytest.raises(
                ValueError, match=r"^data has \d+ particles of \d+ impacts: must have at least"
            ):
                call(nothing)


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


@pytest.mark.parametrize(
    ("data", "changed", "said"),
    [
        (MEASURED, {"elongation": (5e-324, 1e-2)}, r"elongation = .*: must be a pair"),
        (MEASURED, {"diameter": 1e6}, r"diameter = 1000000.0, elongation = .*: gives release_height = "),
        (MEASURED.drop_vars("impact_velocity"), {}, "data lacks impact_velocity: must be a Dataset from"),
        (MEASURED.assign(time=-MEASURED.time), {}, r"data.time\[1\]"),
        (
            MEASURED.assign(restitution_covariance=-MEASURED.restitution_covariance),
            {},
            "data.restitution_cov",
        ),
        (MEASURED.assign(impact_velocity=1e300 * MEASURED.impact_velocity), {}, "data.impact_velocity"),
        (MEASURED.assign_attrs(gravity=0), {}, "data.gravity = 0: must be a real number in"),
        (MEASURED.assign_attrs(drop_height_uncertainty=-1), {}, "data.drop_height_uncertainty = -1: must be"),
    ],
)
def test_what_a_posterior_refuses(data: xr.Dataset, changed: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=f"(?s)^{said}"):
        _posterior(data, **changed)


def test_what_cannot_be_drawn_is_refused() -> None:
    """Sums and margins of such numbers overflow; a bound lies far beyond anything measured."""
    _, [[axes]] = figures.panels(3.0, 2.0)
    with pytest.raises(ValueError, match=r"^count = .*: must be whole numbers in \[0, 2\*\*53\]"):
        figures.population(axes, [0, 1, 2], [0, 1, 2], np.array([[1, 2**63], [0, 3]]))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"^edges\[1\] = 1e\+308: must be at most 1e\+100"):
        figures.histogram(axes, np.array([0.0, 1e308, 1.7e308]), np.ones(2), np.ones(2))
    with pytest.raises(ValueError, match=r"^error\[0\] = 1e\+308: must be at most 1e\+100"):
        figures.line(axes, np.arange(2.0), np.ones(2), np.array([1e308, 1.0]))
    figures.line(axes, np.arange(2.0), np.array([1.0, np.inf]), np.array([1.0, np.inf]))
    with pytest.raises(ValueError, match=r"^times\[1\] = 1e-310: must be later than times\[0\] = 0.0, by at"):
        flight.restitution([0.0, 1e-310, 1.0])


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


def test_axes_without_their_names() -> None:
    """z for x is a fall along the plane."""
    turned = RUN.isel(component=[2, 1, 0])
    for given in (turned, turned.drop_vars("component")):
        with pytest.raises(ValueError, match=r"^data\.component = .*: must be x, y, z"):
            rs.trajectory(given, 3, 0.1)


def test_a_drawing_of_times_that_fall() -> None:
    """Heights between them would be drawn of flights that end before they begin."""
    with pytest.raises(ValueError, match=r"^data\.time\[\d+\] = .*: must be a finite time >= 0, not before"):
        figures.trajectory(RUN.assign(time=RUN.time[:, ::-1].variable))


def test_a_drawing_of_coefficients_needs_their_speeds() -> None:
    fitted = flight.fit(MEASURED)
    for value in (-1.0, 0.0, np.nan):
        with pytest.raises(
            ValueError, match=r"^data\.impact_velocity\[\d\] = .*: must be a speed > 0 at every"
        ):
            flight.figure(MEASURED.assign(impact_velocity=0.0 * MEASURED.impact_velocity + value), fitted)
    for name in ("impact_velocity", "impact_velocity_error", "restitution_error"):
        with pytest.raises(ValueError, match=rf"^data\.{name}\[\d\] = 1e\+308: must be at most 1e\+100"):
            flight.figure(MEASURED.assign({name: 0.0 * MEASURED[name].fillna(0.0) + 1e308}), fitted)


def test_a_posterior_of_what_no_ball_does() -> None:
    """A coefficient of nothing after which balls fly on, and errors that leave nothing to weigh."""
    for name, value, said in (
        ("restitution", 5e-324, r"^data: no ball of these shapes bounces as often"),
        ("restitution_covariance", 1e308, r"^data\.restitution_covariance = .*: must be a covariance"),
        ("restitution_covariance", 1e30, r"^data\.restitution_covariance = .*: must be a covariance"),
    ):
        with pytest.raises(ValueError, match=said):
            _posterior(MEASURED.assign({name: 0.0 * MEASURED[name].fillna(0.0) + value}))


def test_a_distribution_of_part_of_an_edge() -> None:
    found = rs.reduce(rs.simulate(BODY, LAW, particles=300, impacts=20), SPEEDS, RATIOS)
    learned = rs.FluctuatingRestitution.from_statistics(found).data
    for value in (1e300, 0.5, -1.0):
        with pytest.raises(ValueError, match=r"^data\.edges\[0\] = .*: must be whole numbers of edges"):
            rs.FluctuatingRestitution(learned.assign(edges=0.0 * learned.edges + value))
    with pytest.raises(ValueError, match=r"^statistics lacks the attribute source: must be from"):
        rs.FluctuatingRestitution.from_statistics(found.drop_attrs())
