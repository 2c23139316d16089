"""Times without an uncertainty: their error and the scatter of ε, apart or not, in planted series."""

import numpy as np
import pytest

import restitution as rs
from restitution.experiment.flight import LawFit

SERIES = 30
FOUND, TIMES, BALL, EITHER = "together with", "fitted to the scatter", "ε itself scatters, and", "may be"


def fits(scatter: float, error: float, impacts: int = 22, normal: float = 0.92) -> list[LawFit]:
    """Fit balls whose coefficient scatters, at times that were measured with an error."""
    found = []
    for seed in range(SERIES):
        rng = np.random.default_rng([seed, impacts])
        speeds = 1.5 * np.cumprod(np.append(1.0, rng.normal(normal, scatter, impacts - 2)))
        times = np.append(0.0, np.cumsum(2.0 * speeds / 9.81)) + rng.normal(0.0, error, impacts)
        found.append(rs.flight.fit(rs.flight.restitution(times), scatter="fit"))
    return found


def share(of: list[LawFit], words: str) -> float:
    return sum(words in one.note for one in of) / len(of)


def spread_of_pulls(of: list[LawFit]) -> float:
    return float(np.std([(one.parameters["restitution"] - 0.92) / one.errors["restitution"] for one in of]))


def test_a_scatter_of_the_ball_is_not_taken_for_errors_of_times() -> None:
    """Each of two wrong claims has a level of 5 %; among 30 no more than 5 with 99 %."""
    found = fits(0.003, 1e-6)
    assert share(found, BALL) >= 0.8
    assert share(found, FOUND) <= 0.17
    assert np.mean([one.scatter for one in found]) == pytest.approx(0.003, rel=0.065)


def test_errors_of_times_are_not_taken_for_a_scatter_of_the_ball() -> None:
    found = fits(0.0, 1e-4)
    assert share(found, TIMES) >= 0.8
    assert share(found, FOUND) <= 0.17
    # A scatter that is not shown widens the error of ε: it cannot be excluded.
    assert spread_of_pulls(found) < 1.0


@pytest.mark.slow
def test_both_are_fitted_where_both_are_there() -> None:
    """A time error of 300 µs beside a scatter of .003 is found in three of four series."""
    found = fits(0.003, 3e-4)
    assert share(found, FOUND) >= 0.6
    assert np.median([one.scatter for one in found]) == pytest.approx(0.003, rel=0.2)
    # As Student's t with 5 degrees of freedom, for two spreads that are estimated themselves.
    assert 0.8 < spread_of_pulls(found) < 1.4


def test_few_coefficients_say_that_they_do_not_separate_them() -> None:
    found = fits(0.003, 1e-4, impacts=8)
    assert share(found, EITHER) >= 0.5
    assert all("without an uncertainty" in str(one) for one in found)


def test_times_with_an_uncertainty_are_not_asked() -> None:
    data = rs.flight.restitution([0.0, 0.4001, 0.7800, 1.1411, 1.4841], 1e-4)
    assert rs.flight.fit(data, scatter="fit").note == ""
