"""Laws fitted to times of flight: χ²/n = 1 where the law is right, and more where it is not."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.bouncing import impact_times

EXPERIMENTS = 25
ERROR = 3e-5
EXACT: dict[str, Any] = {"gravity_uncertainty": 0.0, "clock_uncertainty": 0.0}

SOFT = rs.Viscoelastic(young_modulus=1e8, poisson_ratio=0.4, dissipation=5e-6, density=1200.0, radius=5e-3)

LAWS: dict[str, tuple[tuple[float, ...], Callable[[float], float]]] = {
    "constant": ((0.93,), lambda _: 0.93),
    "power law": ((0.9, 0.04), lambda v: 0.9 * v**-0.04),
    "viscoelastic": ((SOFT.beta,), lambda v: float(SOFT(v))),
    "plastic": ((0.05,), lambda v: float(rs.Plastic(yield_speed=0.05)(v))),
}


@pytest.fixture(scope="module", params=LAWS)
def experiments(request: pytest.FixtureRequest) -> tuple[str, list[rs.flight.LawFit]]:
    """Many experiments with a perfect sphere of one law; only the clock errs."""
    name = request.param
    rng = np.random.default_rng(11)
    true = impact_times(LAWS[name][1], 2.5, 12)
    noise = rng.normal(0.0, ERROR, (EXPERIMENTS, true.size))
    return name, [
        rs.flight.fit(rs.flight.restitution(true + errors, ERROR, **EXACT), name) for errors in noise
    ]


def test_chi_square_of_a_perfect_model_is_its_degrees_of_freedom(
    experiments: tuple[str, list[rs.flight.LawFit]],
) -> None:
    """The mean of N values of χ²/n has the standard error √(2/(n N))."""
    _, fits = experiments
    freedom = fits[0].degrees_of_freedom
    mean = np.mean([fit.chi2 / freedom for fit in fits])
    assert abs(mean - 1.0) < 4.0 * math.sqrt(2.0 / (freedom * len(fits)))


def test_parameters_scatter_about_the_truth_by_their_errors(
    experiments: tuple[str, list[rs.flight.LawFit]],
) -> None:
    """(fitted - true)/error has mean 0 ± 1/√N and standard deviation 1 ± 1/√(2N)."""
    name, fits = experiments
    for place, true in enumerate(LAWS[name][0]):
        pulls = [
            (list(fit.parameters.values())[place] - true) / list(fit.errors.values())[place] for fit in fits
        ]
        assert abs(np.mean(pulls)) < 4.0 / math.sqrt(len(fits))
        assert abs(np.std(pulls) - 1.0) < 4.0 / math.sqrt(2.0 * len(fits))


def test_bands_are_the_scatter_of_the_fitted_curves(experiments: tuple[str, list[rs.flight.LawFit]]) -> None:
    _, fits = experiments
    speeds = np.array([0.9, 1.7])
    curves = np.array([fit(speeds) for fit in fits])
    assert fits[0].error(speeds) == pytest.approx(curves.std(0), rel=4.0 / math.sqrt(2.0 * len(fits)))


def test_intervals_taken_as_independent_are_1_5_times_too_sure() -> None:
    """The variance of Δt_1 - ε Δt_0 is s²(2 + 2ε + 2ε²), not s²(2 + 2ε²): a time is shared."""
    ratio = 0.93
    true = impact_times(lambda _: ratio, 2.5, 30)
    rng = np.random.default_rng(2)
    total = []
    for _ in range(400):
        flights = np.diff(true + rng.normal(0.0, ERROR, true.size))
        residual = flights[1:] - ratio * flights[:-1]
        total.append(np.mean(residual**2 / (2.0 * ERROR**2 * (1.0 + ratio**2))))
    assert np.mean(total) == pytest.approx(1.0 + ratio / (1.0 + ratio**2), rel=0.02)
    assert 1.0 + ratio / (1.0 + ratio**2) == pytest.approx(1.5, abs=0.002)


def test_the_wrong_law_is_found_out() -> None:
    true = impact_times(LAWS["viscoelastic"][1], 2.5, 12)
    data = rs.flight.restitution(true + np.random.default_rng(1).normal(0.0, ERROR, 12), ERROR)
    fits = [rs.flight.fit(data, law) for law in ("constant", "plastic", "viscoelastic")]
    assert [fit.p_value > 1e-3 for fit in fits] == [False, False, True]
    table = rs.flight.compare(*fits).splitlines()
    assert table[2].startswith("| viscoelastic |")
    assert table[2].endswith("| 0.0 |")


def test_scatter_of_the_ball_is_told_from_errors_of_the_clock() -> None:
    """ε scatters by 0.01 as if by shape; the mean over N fits of 28 impacts has the error 0.01/√(2·28·N)."""
    rng = np.random.default_rng(5)
    number, spreads, pulls = 10, [], []
    for _ in range(number):
        times = impact_times(lambda _: 0.93 + 0.01 * rng.standard_normal(), 2.5, 30)
        data = rs.flight.restitution(times + rng.normal(0.0, ERROR, 30), ERROR)
        fit = rs.flight.fit(data, "constant", scatter="fit")
        spreads.append(fit.scatter)
        pulls.append((fit.parameters["restitution"] - 0.93) / fit.errors["restitution"])
        assert fit.scatter_error == pytest.approx(0.01 / math.sqrt(2.0 * 28.0), rel=0.5)
    # The likelihood takes one of 28 degrees of freedom for the mean: 0.01 √(27/28).
    within = 4.0 * 0.01 / math.sqrt(2 * 28 * number)
    assert np.mean(spreads) == pytest.approx(0.01 * math.sqrt(27 / 28), abs=within)
    assert abs(np.mean(pulls)) < 4.0 / math.sqrt(number)


def test_an_error_of_g_moves_the_yield_speed_alone() -> None:
    """Times scale as 1/g: a yield speed has the relative error of g, a constant coefficient none."""
    yielding = impact_times(LAWS["plastic"][1], 2.5, 12)
    fit = rs.flight.fit(rs.flight.restitution(yielding, 1e-8, gravity_uncertainty=0.0981), "plastic")
    assert fit.errors["yield_speed"] / fit.parameters["yield_speed"] == pytest.approx(0.01, rel=1e-3)
    constant = impact_times(lambda _: 0.93, 2.5, 12)
    sure, unsure = (
        rs.flight.fit(rs.flight.restitution(constant, ERROR, gravity_uncertainty=error)).errors["restitution"]
        for error in (0.0, 0.0981)
    )
    assert unsure == pytest.approx(sure, rel=1e-6)


def test_series_are_fitted_together() -> None:
    """Two series with independent errors have half the variance; an error of g is common and stays."""
    true = impact_times(lambda _: 0.93, 2.5, 12)
    data = rs.flight.restitution(true, ERROR)
    one, two = rs.flight.fit(data, "constant"), rs.flight.fit([data, data], "constant")
    assert two.errors["restitution"] == pytest.approx(one.errors["restitution"] / math.sqrt(2.0), rel=1e-9)
    yielding = rs.flight.restitution(
        impact_times(LAWS["plastic"][1], 2.5, 12), 1e-9, gravity_uncertainty=0.0981
    )
    fit = rs.flight.fit([yielding, yielding], "plastic")
    assert fit.errors["yield_speed"] / fit.parameters["yield_speed"] == pytest.approx(0.01, rel=1e-3)


def test_materials_are_laws() -> None:
    data = rs.flight.restitution(impact_times(LAWS["plastic"][1], 2.5, 12), ERROR)
    assert str(rs.flight.fit(data, rs.Plastic)) == str(rs.flight.fit(data, "plastic"))
    assert rs.flight.fit(data, rs.Viscoelastic).law == "viscoelastic"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"law": "cubic"}, "law = 'cubic': must be 'constant', 'power law', 'viscoelastic', 'plastic', or"),
        ({"scatter": -1.0}, 'scatter = -1.0: must be "fit" or a number in [0, 1e30]'),
        ({"data": 3}, "data = 3: must be a Dataset of flight.restitution, or several"),
    ],
)
def test_errors_of_a_fit(arguments: dict[str, object], message: str) -> None:
    data = rs.flight.restitution(impact_times(lambda _: 0.9, 2.0, 6), 1e-4)
    with pytest.raises(ValueError) as error:  # noqa: PT011  # the text is compared
        rs.flight.fit(**({"data": data} | arguments))  # type: ignore[arg-type]
    assert str(error.value).startswith(message)


def test_a_fit_needs_errors_and_enough_impacts() -> None:
    with pytest.raises(ValueError, match=r"data: 1 coefficients of restitution; must have at least 2"):
        rs.flight.fit(rs.flight.restitution(impact_times(lambda _: 0.9, 2.0, 3), 1e-4))


def test_the_figure_shows_points_curves_and_bands() -> None:
    true = impact_times(lambda _: 0.93, 2.5, 12)
    data = rs.flight.restitution(true, 1e-4)
    figure = rs.flight.figure(data, rs.flight.fit(data), rs.flight.fit(data, "power law", scatter=0.01))
    [axes] = figure.axes
    legend = axes.get_legend()
    assert legend is not None
    names = [text.get_text() for text in legend.get_texts()]
    assert sorted(names) == ["constant", "measured", "power law"]
    assert len(axes.collections) >= 3


def test_a_law_that_nothing_tells_has_infinite_errors() -> None:
    """Far from the data, the best yield speed is above all speeds: it is reported so, and refuted."""
    true = impact_times(lambda _: 0.93, 2.3, 20)
    data = rs.flight.restitution(true, 2e-6, drop_height=0.28, drop_height_uncertainty=1e-3)
    fit = rs.flight.fit(data, "plastic")
    assert fit.p_value < 1e-6
    assert fit.errors["yield_speed"] > 0.0


def several(coefficients: np.ndarray, scatter: float, error: float, seed: int) -> list[xr.Dataset]:
    """Drops of round balls with these mean coefficients, 12 impacts each."""
    rng = np.random.default_rng(seed)
    found = []
    for mean in coefficients:
        speeds = 1.5 * np.cumprod(mean + scatter * rng.standard_normal(11))
        times = np.concatenate([[0.0], np.cumsum(2.0 * speeds / 9.81)])
        found.append(rs.flight.restitution(times + rng.normal(0.0, error, 12), error))
    return found


def test_series_have_a_scatter_between_them() -> None:
    """Plates that differ by 0.002 around 0.92: the error of the mean is theirs, 0.002/√8, not that of one."""
    plates = 0.92 + 0.002 * np.array([-1.3, -0.9, -0.5, -0.1, 0.1, 0.5, 0.9, 1.3])
    found = rs.flight.fit(several(plates, 5e-4, 2e-5, 1), "constant", scatter="fit")
    assert found.between == pytest.approx(np.std(plates, ddof=1), rel=0.35)
    assert found.errors["restitution"] == pytest.approx(np.std(plates, ddof=1) / np.sqrt(8.0), rel=0.35)
    assert abs(found.parameters["restitution"] - 0.92) < 2e-4
    assert "between series 0.00" in str(found)
    alike = rs.flight.fit(several(np.full(8, 0.92), 5e-4, 2e-5, 2), "constant", scatter="fit")
    assert alike.between < 4e-4
    assert alike.errors["restitution"] < 0.4 * found.errors["restitution"]


@pytest.mark.slow
@pytest.mark.parametrize("between", [0.0, 0.002])
def test_the_mean_of_five_drops_is_covered(between: float) -> None:
    """Of plates that differ and of plates that do not; errors are those of few drops, and so are large."""
    rng, held = np.random.default_rng(7), 0
    for seed in range(30):
        drops = several(0.92 + between * rng.standard_normal(5), 5e-4, 2e-5, seed)
        found = rs.flight.fit(drops, "constant", scatter="fit")
        held += abs(found.parameters["restitution"] - 0.92) < 1.645 * found.errors["restitution"]
    assert held >= 24


def test_a_scatter_of_zero_is_not_certain() -> None:
    """Video with 240 frames/s: errors of the times hide a scatter of some 0.003, which the law may have."""
    [one] = several(np.array([0.92]), 0.0, 1.2e-3, 3)
    certain, averaged = (rs.flight.fit(one, "constant", scatter=each) for each in (0.0, "fit"))
    assert averaged.scatter < 1e-3 < averaged.scatter_error < 0.02
    assert averaged.errors["restitution"] > 1.5 * certain.errors["restitution"]


def test_speeds_and_heights_have_the_errors_of_g_and_of_the_clock() -> None:
    """300 laboratories anywhere on the Earth with clocks of their own: pulls of 1, of nothing that was given.

    A quotient of times has neither error; the first one has, of a drop whose height was measured.
    """
    rng = np.random.default_rng(12)
    g, rate = 9.81 * (1.0 + 3e-3 * rng.standard_normal(300)), 1.0 + 1e-4 * rng.standard_normal(300)
    pulls = []
    for one, clock in zip(g, rate, strict=True):
        speed = math.sqrt(2.0 * one * 0.3)
        flights = 2.0 * speed / one * 0.9 ** np.arange(1, 9)
        times = np.append(0.0, np.cumsum(flights)) / clock
        data = rs.flight.restitution(times, 1e-7, drop_height=0.3)
        true = speed * 0.9 ** np.arange(9)
        of_speed = (data.impact_velocity.values - true) / data.impact_velocity_error.values
        first = (float(data.restitution[0]) - 0.9) / float(data.restitution_error[0])
        pulls.append([*of_speed[:2], first])
        assert float(data.restitution_error[3]) < 1e-6
    # Known to 0.04 each; 4 of these are allowed.
    assert np.std(pulls, axis=0) == pytest.approx([1.0, 1.0, 1.0], abs=0.16)


@pytest.mark.parametrize(("g_error", "clock_error"), [(0.0, 2e-3), (0.01, 2e-3), (None, 0.0)])
def test_a_yield_speed_has_the_errors_of_g_and_of_a_wrong_clock(
    g_error: float | None, clock_error: float
) -> None:
    """It is proportional to the speeds: 60 wrong clocks, with and without a g that was measured."""
    rng, pulls = np.random.default_rng(13), []
    true = impact_times(LAWS["plastic"][1], 2.5, 12)
    for _ in range(60):
        off = (3e-3 if g_error is None else g_error / 9.81) * rng.standard_normal()
        times = true / (1.0 + off) / (1.0 + clock_error * rng.standard_normal())
        data = rs.flight.restitution(times, 1e-7, gravity_uncertainty=g_error, clock_uncertainty=clock_error)
        fit = rs.flight.fit(data, "plastic")
        pulls.append((fit.parameters["yield_speed"] - 0.05) / fit.errors["yield_speed"])
    assert np.std(pulls) == pytest.approx(1.0, abs=0.36)  # known to 0.09


def a_class(tables: int, drops: int, apart: float, seed: int) -> tuple[list[xr.Dataset], list[int]]:
    """Round balls at tables whose plates differ by this; drops of one table by 0.0005, impacts as well."""
    rng, found = np.random.default_rng([seed, 5]), []
    for _ in range(tables):
        plate = 0.93 + apart * rng.standard_normal()
        for _ in range(drops):
            mean = plate + 5e-4 * rng.standard_normal()
            steps = mean + 5e-4 * rng.standard_normal(11)
            times = np.append(0.0, np.cumsum(2.0 * 1.4 / 9.81 * np.cumprod(steps)))
            found.append(rs.flight.restitution(times + rng.normal(0.0, 2e-5, times.size), 2e-5))
    return found, [table for table in range(tables) for _ in range(drops)]


def test_a_class_has_one_number_its_error_and_what_differs_between_tables() -> None:
    """20 plates that differ by 0.002 leave 0.00045 to the mean, of whatever precision the times are."""
    drops, tables = a_class(20, 2, 2e-3, 1)
    together = rs.flight.fit(drops, scatter="fit", groups=[f"table {one}" for one in tables])
    assert together.parameters["restitution"] == pytest.approx(0.93, abs=3.0 * 4.5e-4)
    assert 3e-4 < together.errors["restitution"] < 7e-4
    assert 1.2e-3 < together.between_groups < 3e-3  # known to a sixth
    assert 2e-4 < together.between < 9e-4
    assert "between groups 0.00" in str(together)
    alone = rs.flight.fit(drops, scatter="fit")  # as if all drops were of one table
    assert alone.errors["restitution"] < 0.85 * together.errors["restitution"]
    same = rs.flight.fit(
        drops[::2], scatter="fit", groups=tables[::2]
    )  # one drop a table: no term of its own
    assert same.between_groups_error == 0.0 < 1e-3 < same.between
    with pytest.raises(ValueError, match=r"^groups = \[1, 2\]: must be a label for each of the 40 series"):
        rs.flight.fit(drops, scatter="fit", groups=[1, 2])
    with pytest.raises(ValueError, match=r"^groups: given with scatter = 0\.0; must come with 'fit'"):
        rs.flight.fit(drops, groups=tables)


@pytest.mark.slow
@pytest.mark.parametrize("apart", [0.0, 2e-3])
def test_the_mean_of_a_class_is_covered(apart: float) -> None:
    """Of 40 classes of 20 tables and two drops each; fewer than 31 in 40 have a probability of 0.005."""
    pulls, errors = [], []
    for seed in range(1, 41):
        drops, tables = a_class(20, 2, apart, seed)
        found = rs.flight.fit(drops, scatter="fit", groups=tables)
        pulls.append((found.parameters["restitution"] - 0.93) / found.errors["restitution"])
        errors.append(found.errors["restitution"])
    assert np.sum(np.abs(pulls) < 1.645) >= 31
    assert np.median(errors) < (6e-4 if apart else 2.5e-4)
