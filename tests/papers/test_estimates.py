"""Estimates from correlated impacts: standard errors, independent draws, energies, numbers as text."""

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution._internal.text import with_error
from restitution.papers import estimate
from restitution.papers.glielmo2014._claims import _energy
from restitution.papers.trend import trend

GRAVITY = 9.81


def test_errors_are_those_of_correlated_impacts() -> None:
    """Means, deviations and correlations of 400 made-up runs scatter as their standard errors say.

    Each of 40 particles has a level of its own in its 25 impacts. The ratio of both scatters has itself a
    standard error of 1/√800; 0.15 is four of them. As if impacts were independent, the error of the mean
    would be 3.6 times too small.
    """
    random = np.random.default_rng(12)
    cell = np.zeros((40, 25), np.intp)
    values: dict[str, list[tuple[float, float]]] = {"mean": [], "deviation": [], "correlation": []}
    for _ in range(400):
        impacts = estimate.in_cells(cell, 1)
        x, y = (random.normal(size=(40, 1)) + random.normal(size=cell.shape) for _ in range(2))
        for name, found in (
            ("mean", impacts.means(impacts.of(x))),
            ("deviation", impacts.deviations(impacts.of(x))),
            ("correlation", impacts.correlations(impacts.of(x), impacts.of(y))),
        ):
            values[name].append((float(found.value[0]), float(found.error[0])))
    for pairs in values.values():
        value, error = np.array(pairs).T
        assert value.std() / np.sqrt(np.mean(error**2)) == pytest.approx(1, abs=0.15)


def test_trend_knows_that_bins_of_one_run_are_correlated() -> None:
    """Bins that differ by exactly 1 for every particle: the step has no error, however particles differ."""
    level = np.random.default_rng(13).normal(size=(50, 1))
    impacts = estimate.in_cells(np.tile([0, 1], (50, 1)), 2)
    found = impacts.means(impacts.of(level + np.array([0.0, 1.0])))
    assert found.error[0] > 0.1
    assert found.steps()[0] > 1e6
    assert trend(found).verdict == "holds"


def test_independent_draws() -> None:
    """At most one impact of a particle in a cell, and every impact with the same chance.

    One particle has four impacts, four have one: over many seeds each of the eight is drawn equally often (χ²
    with 7 degrees of freedom below 29.9, false alarm 1e−4).
    """
    cell = np.full((5, 4), -1)
    cell[0], cell[1:, 0] = 0, 0
    impacts = estimate.in_cells(cell, 1)
    count = np.zeros((5, 4))
    for seed in range(2000):
        drawn = impacts.one_per_particle(seed)
        assert np.unique(drawn.where[0]).size == drawn.cell.size
        count[drawn.where] += 1
    hits = count[cell == 0]
    assert np.sum((hits - hits.mean()) ** 2 / hits.mean()) < 29.9


def test_jackknife_of_a_mean_is_its_standard_error() -> None:
    """With one particle a group, the jackknife of the mean is s/√n exactly."""
    x = np.random.default_rng(14).normal(size=20)
    value, error = estimate.jackknife(lambda a: float(a.mean()), x, np.arange(20), groups=20)
    assert value == pytest.approx(x.mean())
    assert error == pytest.approx(x.std(ddof=1) / np.sqrt(20))


def test_energies_follow_the_fall() -> None:
    """Two impacts and a flight that ends 1 mm lower: E₂ = 0.9 E₁ + g · 1 mm, with E₁ = v²/2."""
    v, w, drop = 1.0, 0.8, 1e-3
    flight = (w + np.sqrt(w**2 + 2 * GRAVITY * drop)) / GRAVITY
    data = xr.Dataset(
        {
            name: (("particle", "impact"), np.array([pair]))
            for name, pair in {
                "impact_velocity": (v, 0.7),
                "rebound_velocity": (w, 0.6),
                "time": (0.1, 0.1 + flight),
                "energy_ratio": (0.9, 0.9),
            }.items()
        }
    )
    assert _energy.energies(data, GRAVITY)[0] == pytest.approx([0.5, 0.45 + GRAVITY * drop])


@pytest.mark.parametrize("separation", [0.0, 3e-4])
def test_energies_of_a_simulated_run(separation: float) -> None:
    """What rotation and fall leave of E_tot is horizontal motion: never negative, none for a sphere."""
    body = rs.Dumbbell(radius=3e-3, separation=separation)
    data = rs.simulate(body, rs.TangentialRestitution(normal=0.98), particles=20, impacts=60, seed=1)
    total = _energy.energies(data, GRAVITY)
    v, fraction = (data[name].to_numpy() for name in ("impact_velocity", "rotational_fraction"))
    horizontal = 1 - fraction - v**2 / (2 * total)
    assert horizontal.min() > -1e-12
    assert horizontal.max() < 1e-12 if separation == 0 else horizontal.max() > 0.01


@pytest.mark.parametrize(
    ("value", "error", "text"),
    [
        (0.03274, 0.00123, "0.0327 ± 0.0012"),
        (12.34, 5.6, "12.3 ± 5.6"),
        (1234.0, 120.0, "1230 ± 120"),
        (2.7e-8, 3e-10, "(2.700 ± 0.030) × 10⁻⁸"),
        (0.1234567, None, "0.1235"),
        (1e-12, None, "10⁻¹²"),
        (1659968.0, None, "1\u202f659\u202f968"),
        (0.0, 0.0, "0"),
        (np.nan, np.nan, "no data"),
    ],
)
def test_numbers_are_written_to_two_digits_of_their_error(
    value: float, error: float | None, text: str
) -> None:
    assert with_error(value, error) == text
