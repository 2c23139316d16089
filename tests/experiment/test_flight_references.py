"""Fits of laws to times of impacts, compared with least squares of the true times themselves."""

import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import least_squares

import restitution as rs
from reference.bouncing import flight_in_air
from restitution import flight
from restitution.experiment.flight._problem import Misfit, Scatter
from restitution.experiment.flight.chain import joined, measured_of
from restitution.experiment.flight.laws import by_parameters, by_speed, law_named

SOFT: dict[str, Any] = {"young_modulus": 1e8, "poisson_ratio": 0.4, "density": 1200.0, "radius": 5e-3}
BETA = rs.Viscoelastic(dissipation=5e-6, **SOFT).beta


def coefficient(law: str, parameters: Any) -> Callable[[float], float]:
    if law == "constant":
        return lambda _: parameters[0]
    if law == "power law":
        return lambda v: parameters[0] * v ** -parameters[1]
    if law == "viscoelastic":  # β is proportional to the dissipation
        sphere = rs.Viscoelastic(dissipation=5e-6 * parameters[0] / BETA, **SOFT)
        return lambda v: float(sphere(v))
    return lambda v: float(rs.Plastic(yield_speed=parameters[0])(v))


TRUE = {"constant": [0.93], "power law": [0.9, 0.04], "viscoelastic": [BETA], "plastic": [0.05]}
G, G_ERROR, CLOCK_ERROR = 9.81, 0.02, 1e-3


class Series:
    """Times that were measured, with errors and the drop, and the times that follow from a law."""

    def __init__(self, law: str, impacts: int, error: float, drop: float | None, seed: int, scatter: float):
        rng = np.random.default_rng(seed)
        self.impacts, self.error, self.drop, self.drop_error = impacts, error, drop, 2e-4
        kicks = scatter * rng.normal(size=impacts - 1)
        speed = 2.4 if drop is None else math.sqrt(2 * 9.8 * drop)
        self.times = self.predicted(coefficient(law, TRUE[law]), 0.3, speed, 9.8, kicks)
        self.times += error * rng.normal(size=impacts)

    def predicted(
        self, law: Callable[[float], float], start: float, speed: float, gravity: float, kicks: Any
    ) -> np.ndarray:
        times = [start]
        for kick in kicks:
            speed *= law(speed) + kick
            times.append(times[-1] + 2 * speed / gravity)
        return np.array(times)

    def data(self) -> xr.Dataset:
        drop = {} if self.drop is None else {"drop_height": self.drop, "drop_height_uncertainty": 2e-4}
        return flight.restitution(
            self.times,
            self.error,
            gravity=G,
            gravity_uncertainty=G_ERROR,
            clock_uncertainty=CLOCK_ERROR,
            **drop,  # type: ignore[arg-type]
        )

    def coefficients(self) -> int:
        """With a known drop the first impact has a coefficient, too; the last never has."""
        return self.impacts - (1 if self.drop is not None else 2)


def by_true_times(law: str, several: list[Series], scatter: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Minimise χ² over the law, g, the rate of the clock, and start, first speed and kicks of each series.

    Give the parameters of the law, their covariance, and χ². Without a drop the first interval only tells the
    speed at the second impact, so that the first impact gets no kick and any coefficient is as good.
    """
    free = len(TRUE[law])

    def residuals(point: np.ndarray) -> np.ndarray:
        one_law, (gravity, rate) = coefficient(law, point[:free]), point[free : free + 2]
        parts = [np.array([(gravity - G) / G_ERROR, rate / CLOCK_ERROR])]
        place = free + 2
        for one in several:
            start, speed = point[place : place + 2]
            place += 2
            kicks = np.zeros(one.impacts - 1)
            if scatter:
                used = slice(0 if one.drop is not None else 1, None)
                number = kicks[used].size
                standard = point[place : place + number]
                kicks[used] = scatter * standard
                parts.append(standard)
                place += number
            times = one.predicted(one_law, start, speed, gravity, kicks)
            parts.append((one.times - times / (1.0 + rate)) / one.error)
            if one.drop is not None:
                parts.append(np.array([(speed**2 / (2 * gravity) - one.drop) / one.drop_error]))
        return np.concatenate(parts)

    first = [*TRUE[law], G, 0.0]
    for one in several:
        first += [0.3, 2.4 if one.drop is None else math.sqrt(2 * G * one.drop)]
        first += [0.0] * one.coefficients() if scatter else []
    found = least_squares(residuals, first, jac="3-point", x_scale="jac", xtol=1e-15, ftol=1e-15, gtol=1e-15)
    jacobian = np.asarray(found.jac)
    information = jacobian.T @ jacobian
    return found.x[:free], np.linalg.inv(information)[:free, :free], 2 * found.cost


@pytest.mark.parametrize("scatter", [0.0, 0.004])
@pytest.mark.parametrize("law", TRUE)
def test_a_fit_is_the_least_squares_of_all_times(law: str, scatter: float) -> None:
    """Three series: parameters, covariance and χ²; g is one for all, starts and drops are each series' own.

    The fit's covariance of the scatter leaves out products of two kicks, 0.004 beside 1.
    """
    several = [
        Series(law, 9, 2e-5, None, 1, scatter),
        Series(law, 7, 5e-5, 0.31, 2, scatter),
        Series(law, 12, 3e-5, 0.22, 3, scatter),
    ]
    values, covariance, chi2 = by_true_times(law, several, scatter)
    found = flight.fit([one.data() for one in several], law, scatter=scatter)
    errors = np.sqrt(np.diag(covariance))
    within = 0.03 if scatter else 2e-3
    np.testing.assert_array_less(np.abs(list(found.parameters.values()) - values), within * errors)
    np.testing.assert_allclose(list(found.errors.values()), errors, rtol=within)
    size = np.outer(errors, errors)
    assert np.all(np.abs(found.covariance - covariance) < 3 * within * size)
    assert found.chi2 == pytest.approx(chi2, rel=within)
    assert found.impacts == sum(one.coefficients() for one in several) == 24
    assert found.degrees_of_freedom == 24 - len(values)
    assert (found.scatter, found.scatter_error) == (scatter, 0.0)
    assert found.law == law
    assert list(found.units) == list(found.parameters) == list(found.errors)
    if scatter == 0.0:  # of the times themselves
        assert found.loglikelihood == pytest.approx(-0.5 * chi2, rel=within)


@pytest.mark.parametrize("law", ["constant", "power law", "plastic"])
def test_the_fitted_scatter_is_the_most_likely(law: str) -> None:
    """Its restricted likelihood, from the Dataset's own covariances, is largest there.

    The parameters are integrated out, which leaves the determinant of the information on them. The
    information on the scatter is half the trace of the square of C⁻¹ dC/dσ.
    """
    data = Series(law, 25, 4e-5, 0.3, 5, 0.01).data()
    found = flight.fit(data, law, scatter="fit")
    known = np.isfinite(data["restitution"].to_numpy())
    v, e = data["impact_velocity"].to_numpy()[known], data["restitution"].to_numpy()[known]
    pick = np.ix_(known, known)
    of_ratio = data["restitution_covariance"].to_numpy()[pick]
    of_speed = data["impact_velocity_covariance"].to_numpy()[pick]
    crossed = data["cross_covariance"].to_numpy()[pick]

    def loglikelihood(parameters: Any, scatter: float) -> tuple[float, np.ndarray]:
        one = coefficient(law, parameters)
        slope = np.array([(one(x * 1.0001) - one(x * 0.9999)) / (2e-4 * x) for x in v])
        by_v = np.diag(slope)
        covariance = of_ratio - by_v @ crossed - (by_v @ crossed).T + by_v @ of_speed @ by_v
        covariance += scatter**2 * np.eye(v.size)
        off = e - np.array([one(x) for x in v])
        return -0.5 * (off @ np.linalg.solve(covariance, off) + np.linalg.slogdet(covariance)[1]), covariance

    values = np.array(list(found.parameters.values()))
    top, covariance = loglikelihood(values, found.scatter)
    # Below the top by ½ one standard error away; in the parameters that move together by no more.
    for way in (-1, 1):
        aside = loglikelihood(values, found.scatter + way * found.scatter_error)[0]
        assert 0.2 < top - aside < 1.0
    inverse = np.linalg.inv(covariance)
    information = 2 * found.scatter**2 * np.trace(inverse @ inverse)
    assert found.scatter_error == pytest.approx(information**-0.5, rel=0.02)
    slopes = np.empty((v.size, values.size))
    for place, value in enumerate(values):
        beside = [values + way * 1e-5 * value * (np.arange(values.size) == place) for way in (1, -1)]
        high, low = (coefficient(law, one) for one in beside)
        slopes[:, place] = [(high(x) - low(x)) / (2e-5 * value) for x in v]

    def restricted(scatter: float) -> float:
        logarithm, covariance = loglikelihood(values, scatter)
        return logarithm - 0.5 * float(np.linalg.slogdet(slopes.T @ np.linalg.solve(covariance, slopes))[1])

    steps = np.linspace(0.8, 1.2, 81)
    best = steps[int(np.argmax([restricted(step * found.scatter) for step in steps]))]
    assert best == pytest.approx(1.0, abs=0.02)
    # Residuals of the fit are of speeds, v times these: ln det differs by 2 Σ ln v.
    assert found.loglikelihood == pytest.approx(top - np.sum(np.log(v)), abs=0.1)
    assert found.aic == pytest.approx(2 * (len(values) + 1) - 2 * found.loglikelihood, rel=1e-14)
    fixed = flight.fit(data, law, scatter=0.01)
    assert fixed.aic == pytest.approx(2 * len(values) - 2 * fixed.loglikelihood, rel=1e-14)


def test_the_scatter_of_exact_times_is_that_of_the_coefficients() -> None:
    """Of a Gaussian: the mean, and the root of the sum of squares over n - 1; errors σ/√n and σ/√(2n)."""
    times = Series("constant", 25, 0.0, None, 5, 0.01).times
    data = flight.restitution(times, gravity_uncertainty=0.0, clock_uncertainty=0.0)
    e = data["restitution"].to_numpy()[1:-1]
    found = flight.fit(data, "constant", scatter="fit")
    assert found.parameters["restitution"] == pytest.approx(e.mean(), rel=1e-6)
    assert found.scatter == pytest.approx(e.std(ddof=1), rel=1e-5)
    assert found.errors["restitution"] == pytest.approx(e.std(ddof=1) / math.sqrt(e.size), rel=1e-5)
    assert found.scatter_error == pytest.approx(e.std(ddof=1) / math.sqrt(2 * e.size), rel=1e-5)
    with pytest.raises(ValueError, match=r"^data: times without errors; .*, or give scatter='fit'"):
        flight.fit(data, "constant")


def test_what_a_fit_says() -> None:
    data = Series("plastic", 12, 2e-5, None, 4, 0.0).data()
    plastic, constant = flight.fit(data, "plastic"), flight.fit(data, "constant")
    scattered = flight.fit(data, "constant", scatter="fit")
    assert str(plastic).startswith("plastic: yield speed = 0.05")
    assert " m/s; χ²/n = " in str(plastic)
    assert f"/{plastic.degrees_of_freedom}, p = {plastic.p_value:.2g}" in str(plastic)
    assert "scatter" not in str(plastic)
    assert " ± " in str(constant)
    assert re.fullmatch(r"constant: restitution = [\d.]+ ± [\d.]+; χ².*", str(constant))  # without a unit
    assert f"; χ²/n = {scattered.chi2:.1f}/{scattered.degrees_of_freedom}" in str(scattered)
    assert f", scatter {scattered.scatter:.3f} ± " in str(scattered)
    assert " ± " in str(scattered).split("scatter ")[1]
    assert ", p = " not in str(scattered)
    assert "<td>p</td>" in plastic._repr_html_() or ">p<" in plastic._repr_html_()
    assert "scatter" not in plastic._repr_html_()
    assert "scatter" in scattered._repr_html_()
    for bad in (0.0, -1.0):
        with pytest.raises(ValueError, match=r"speed = .*: must be speeds > 0, in m/s"):
            plastic(bad)
    with pytest.raises(ValueError, match=r"speed.*m s-1"):
        plastic(xr.DataArray([1.0], attrs={"units": "mm s-1"}))
    with pytest.raises(ValueError, match="speed = 'a': must be speeds > 0, in m/s"):
        plastic.error("a")
    slope = (rs.Plastic(yield_speed=0.0501)(1.0) - rs.Plastic(yield_speed=0.0499)(1.0)) / 2e-4
    at = plastic.parameters["yield_speed"]
    slope *= (at / 0.05) ** -0.75  # ε ∝ v_y^(1/4) nearly
    assert plastic.error(1.0) == pytest.approx(abs(slope) * plastic.errors["yield_speed"], rel=0.02)


def test_a_power_law_of_equal_speeds_starts_somewhere() -> None:
    """All flights as long: the speeds are equal, ε is 1 in each and its exponent told by nothing."""
    found = flight.fit(flight.restitution(np.arange(8.0), 1e-4), "power law")
    assert found(4.905) == pytest.approx(1.0, rel=1e-6)


def test_series_of_another_g_or_drag_are_refused() -> None:
    one = Series("constant", 8, 2e-5, None, 1, 0.0)
    drag = flight.Drag(terminal_velocity=8.0)
    same: dict[str, Any] = {
        "gravity": G,
        "gravity_uncertainty": G_ERROR,
        "clock_uncertainty": CLOCK_ERROR,
    }
    for other in (
        flight.restitution(one.times, 2e-5, **(same | {"gravity": 9.8})),
        flight.restitution(one.times, 2e-5, **(same | {"gravity_uncertainty": None})),
        flight.restitution(one.times, 2e-5, **(same | {"clock_uncertainty": 0.0})),
        flight.restitution(one.times, 2e-5, **same, drag=drag),
    ):
        with pytest.raises(
            ValueError,
            match=r"^data: series with different g, drag, contact time or clock; must have the same",
        ):
            flight.fit([one.data(), other])
    changed = one.data()
    changed["time"].attrs["units"] = "ms"
    with pytest.raises(ValueError, match=r"^data"):
        flight.fit(changed)


def test_errors_of_drag_and_drop_are_those_of_the_coefficients() -> None:
    """The best mean of coefficients with the covariance C of the Dataset has the variance 1/ΣC⁻¹.

    An error of the height of a drop is each series' own: two series have half the variance.
    """
    times = [0.0]
    drag = flight.Drag(terminal_velocity=8.0, uncertainty=0.4)
    speed = 8.0 * math.sqrt(-math.expm1(-2 * 9.81 * 0.3 / 8.0**2))  # of the fall
    for _ in range(9):
        duration, speed = flight_in_air(0.9 * speed, 8.0)
        times.append(times[-1] + duration)
    for given, drop_error in ((drag, 2e-3), (drag, 0.0), (flight.Drag(terminal_velocity=8.0), 2e-3)):
        data = flight.restitution(
            times,
            2e-5,
            gravity_uncertainty=0.0,
            clock_uncertainty=0.0,
            drag=given,
            drop_height=0.3,
            drop_height_uncertainty=drop_error,
        )
        covariance = data["restitution_covariance"].to_numpy()[:-1, :-1]
        found = flight.fit(data, "constant")
        assert found.parameters["restitution"] == pytest.approx(0.9, abs=1e-9)
        variance = 1 / np.linalg.inv(covariance).sum()
        assert found.errors["restitution"] == pytest.approx(math.sqrt(variance), rel=1e-6)
    both = flight.fit([data, data], "constant")
    assert both.errors["restitution"] == pytest.approx(math.sqrt(variance / 2), rel=1e-6)


def test_variables_say_what_they_are() -> None:
    """Dimensions, units, symbols, and all numbers that were given: a fit needs the Dataset alone."""
    data = flight.restitution(
        [0.0, 0.5, 0.96],
        1e-4,
        gravity=9.8,
        gravity_uncertainty=0.01,
        drop_height=0.3,
        drop_height_uncertainty=1e-3,
        drag=flight.Drag(terminal_velocity=8.0, uncertainty=0.4),
    )
    about = {name: (one.dims, one.attrs.get("units"), one.attrs.get("symbol")) for name, one in data.items()}
    one, two = ("impact",), ("impact", "other_impact")
    assert about == {
        "time": (one, "s", None),
        "uncertainty": (one, "s", None),
        "impact_velocity": (one, "m s-1", "v"),
        "impact_velocity_error": (one, "m s-1", None),
        "restitution": (one, "1", "ε"),
        "restitution_error": (one, "1", None),
        "impact_velocity_covariance": (two, "m2 s-2", None),
        "restitution_covariance": (two, "1", None),
        "cross_covariance": (two, "m s-1", None),
    }
    assert {name: data[name].attrs["long_name"] for name in data if "long_name" in data[name].attrs} == {
        "time": "time of the impact",
        "uncertainty": "standard error of the time",
        "impact_velocity": "normal velocity of the centre of mass towards the plane, before the impact",
        "impact_velocity_error": "standard error of the impact velocity",
        "restitution": "coefficient of restitution",
        "restitution_error": "standard error of the coefficient of restitution",
        "cross_covariance": "covariance of the velocity at impact and the coefficient at other_impact",
    }
    assert data.attrs.pop("source").startswith("restitution ")
    assert data.attrs == {
        "title": "Impact velocities and coefficients of restitution from times of impacts",
        "gravity": 9.8,
        "gravity_uncertainty": 0.01,
        "clock_uncertainty": 1e-4,
        "drop_height": 0.3,
        "drop_height_uncertainty": 1e-3,
        "terminal_velocity": 8.0,
        "terminal_velocity_uncertainty": 0.4,
    }


def test_laws_are_compared_by_their_criterion() -> None:
    """Each line holds a law, its numbers, and how far its criterion is above the best one."""
    data = Series("power law", 12, 2e-5, None, 4, 0.0).data()
    constant, power, scattered = (
        flight.fit(data, "constant"),
        flight.fit(data, "power law"),
        flight.fit(data, "constant", scatter="fit"),
    )
    a, b = power.parameters.values()
    e, f = power.errors.values()
    lines = flight.compare(constant, power, scattered).splitlines()
    assert lines[:2] == ["| law | parameters | χ² | n | p | ΔAIC |", "|---|---|---|---|---|---|"]
    cells = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]
    ordered = sorted([constant, power, scattered], key=lambda one: one.aic)
    assert [row[0] for row in cells] == [one.law for one in ordered]
    for row, one in zip(cells, ordered, strict=True):
        assert row[2:4] == [f"{one.chi2:.1f}", str(one.degrees_of_freedom)]
        assert row[4] == ("" if one is scattered else f"{one.p_value:.2g}")
        assert row[5] == f"{one.aic - ordered[0].aic:.1f}"
        assert ";" not in row[1]
        assert row[1].startswith("ε at 1 m/s = " if one is power else "restitution = ")
    words = next(row[1] for row in cells if row[0] == "power law").split(", ")
    assert [float(word.split(" = ")[1].split(" ± ")[0]) for word in words] == pytest.approx(
        [a, b], abs=2 * max(e, f)
    )
    for bad, message in (
        ((), "fits: of none coefficients; must be fits of the same data"),
        ((constant, 3), "fits = 3: must be fits that flight.fit returned"),
        (
            (constant, flight.fit(Series("constant", 8, 2e-5, None, 1, 0.0).data())),
            "fits: of 10, 6 coefficients; must be fits of the same data",
        ),
    ):
        with pytest.raises(ValueError, match=re.escape(message)):
            flight.compare(*bad)


def test_slopes_of_a_law_at_all_speeds() -> None:
    """dε/dv = -qε/v of a power law, from crawling to fast, and its derivatives by ε_1 and q."""
    form, v, values = law_named("power law"), np.array([1e-4, 1e-2, 1.0, 30.0]), np.array([0.9, 0.04])
    e = 0.9 * v**-0.04
    np.testing.assert_allclose(by_speed(form, v, values), -0.04 * e / v, rtol=1e-8)
    expected = np.stack([e / 0.9, -np.log(v) * e], axis=-1)
    np.testing.assert_allclose(by_parameters(form, v, values), expected, rtol=1e-7, atol=1e-9)


@pytest.mark.parametrize("law", TRUE)
def test_the_likelihood_of_groups_is_that_of_the_whole_covariance(law: str) -> None:
    """Five series at three tables, sums over series against matrices of all coefficients."""
    drops = [Series(law, 8, 2e-5, None if seed % 2 else 0.3, seed, 0.003).data() for seed in range(5)]
    experiments = [measured_of(one) for one in drops]
    links = joined(experiments, None)
    known = ~np.isnan(links.before) & ~np.isnan(links.after)
    problem = Misfit(law_named(law), experiments, known, np.array([0, 0, 1, 1, 2]))
    values, found = np.array(TRUE[law]), []
    for scatter in (
        Scatter(0.003),
        Scatter(0.002, 0.001),
        Scatter(0.002, 0.0, 0.004),
        Scatter(3e-3, 2e-3, 1e-3),
    ):
        covariance = problem.covariance(values, scatter)
        slopes = problem.before[:, None] * by_parameters(problem.form, problem.before, values)
        inverse = np.linalg.inv(covariance)
        information = slopes.T @ inverse @ slopes
        residual = problem.residual(values)
        move = np.linalg.solve(information, slopes.T @ inverse @ residual)
        left = residual - slopes @ move
        dense = left @ inverse @ left + np.linalg.slogdet(covariance)[1] + np.linalg.slogdet(information)[1]
        prior = sum(np.log1p((width / 3e-3) ** 2) for width in scatter[1:])
        one = problem._restricted(values, scatter)
        np.testing.assert_allclose(one.move, move, rtol=1e-6, atol=1e-12)
        np.testing.assert_allclose(one.information, information, rtol=1e-7)
        found.append(one.value + 0.5 * dense + prior)
    # The determinant of the common numbers is the same at all scatters.
    np.testing.assert_allclose(found, found[0], atol=1e-5)
