"""Posteriors: that they cover, that they say what the data cannot tell, and that the sampler samples them."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy import stats

import restitution as rs
from benchmarks import calibration
from restitution.experiment.inference._family import Family
from restitution.experiment.inference._series import Series
from restitution.experiment.inference._table import table

ERROR = 2e-5


def heard(
    elongation: float, law: Any, seed: int, impacts: int = 15, error: float = ERROR, **known: Any
) -> xr.Dataset:
    """One drop of a 6 mm ball from 0.1 m, timed to 20 µs unless told otherwise."""
    run = rs.simulate(
        rs.from_roundness(6e-3, 0.25 * elongation * 6e-3, form="dumbbell"),
        law,
        particles=1,
        impacts=impacts,
        release_height=0.103,
        seed=seed,
    )
    times = run.time.values[0] + np.random.default_rng(seed).normal(0.0, error, impacts)
    return rs.flight.restitution(times, error, **({"drop_height": 0.1} | known))


def quick(data: Any, law: Any, **options: Any) -> xr.DataTree:
    return rs.posterior(data, law, **({"diameter": 6e-3, "particles": 100, "draws": 800} | options))


KEPT = Path(__file__).parents[2] / "docs" / "data" / "calibration.csv"


def test_ranks_of_the_truth_are_uniform() -> None:
    """The 120 experiments of docs/inference.md: 90 +- 7 % is two and a half standard errors, 2.7 %."""
    found = calibration.read(KEPT)
    assert found.rank.shape == (120, 3)
    for rank in found.rank.T:
        assert stats.kstest(rank, "uniform").pvalue > 0.01
        assert abs(calibration.covered(rank, 0.9) - 0.9) < 0.07
    page = (KEPT.parents[1] / "inference.md").read_text(encoding="utf-8")
    assert calibration.table(found).strip() in page
    assert calibration.sentence(found).strip() in page


def test_some_of_the_experiments_come_out_as_they_are_kept() -> None:
    """The first of the 120, made anew.

    The last bits of a linear algebra library make other walks of the sampler; the rank of one among 640
    correlated draws has a standard error of some 0.05, and the difference of two 0.07.
    """
    found, kept = calibration.calibrate(1), calibration.read(KEPT)
    assert found.truth == pytest.approx(kept.truth[:1], rel=1e-5)
    assert np.abs(found.rank - kept.rank[:1]).max() < 0.2
    assert calibration.written(found).count("\n") == 2


def test_a_round_ball_gives_an_upper_limit_and_an_egg_a_shape() -> None:
    """Of a material that does not scatter; with one that may, see test_shape_or_material."""
    law = rs.Frictionless(normal=0.93)
    round_ball = quick(heard(1e-3, law, 3), law, scatter=None)
    assert round_ball.attrs["elongation_determined"] == 0
    assert "do not determine the shape" in round_ball.attrs["verdict"]
    assert 1e-3 < round_ball.attrs["elongation_upper_limit"] < 0.05
    egg = quick([heard(0.15, law, seed) for seed in (3, 4, 5)], law, scatter=None)
    assert egg.attrs["elongation_determined"] == 1
    assert egg.attrs["verdict"].startswith("The times determine the shape, if ε_n does not scatter: L/R = 0.")
    assert 0.05 < float(egg["posterior"].to_dataset().elongation.median()) < 0.3


@pytest.mark.parametrize(
    ("error", "drops", "most"),
    [
        (9e-8, 1, 0.03),
        pytest.param(2e-5, 1, 0.03, marks=pytest.mark.slow),
        pytest.param(2e-5, 4, 8e-3, marks=pytest.mark.slow),
        pytest.param(9e-8, 4, 1e-3, marks=pytest.mark.slow),
    ],
)
def test_the_limit_of_a_sphere_is_what_its_times_resolve(error: float, drops: int, most: float) -> None:
    """The scatter of a shape goes as (L/R)², so that times 220 times as good resolve a fifteenth of L/R.

    A single ball may be released where it hardly turns, with a probability that goes as R/L: its limit, 95 %,
    is some 20 times what is resolved.
    """
    law = rs.Frictionless(normal=0.93)
    data = [heard(0.0, law, seed, error=error) for seed in (3, 4, 5, 6)[:drops]]
    found = quick(data, law).attrs
    assert found["explained_by"] == "neither"
    assert found["verdict"].startswith("The times do not determine the shape")
    assert found["elongation_upper_limit"] < most


def test_several_drops_tell_more_than_one() -> None:
    law = rs.Frictionless(normal=0.93)
    series = [heard(0.05, law, seed) for seed in (11, 12, 13, 14)]
    width = [
        float(np.log(one["posterior"].to_dataset().elongation).std())
        for one in (quick(series[0], law, scatter=None), quick(series, law, scatter=None))
    ]
    assert width[1] < 0.8 * width[0]


def test_draws_are_those_of_the_table() -> None:
    """Means and deviations of the draws beside sums over the table; 2000 draws, correlated, know 10 %."""
    law = rs.Frictionless(normal=0.93)
    data = heard(0.05, law, 5)
    tree = quick(data, law, draws=4000, elongation=(1e-2, 0.3), scatter=None)
    drawn = tree["posterior"].to_dataset()
    reference = rs.flight.fit(data, "constant", scatter="fit")
    family = Family(law, 6e-3, "dumbbell", 2)
    one = Series.of(data, family.of_speed, reference.parameters["restitution"], reference.scatter)
    found = table([one], family, np.geomspace(1e-2, 0.3, 16), [None], [None], 200, 1)
    fine = [np.linspace(axis[0], axis[-1], 400) for axis in found.axes]
    mesh = np.stack(np.meshgrid(*fine, indexing="ij"), axis=-1)
    weight = np.exp(found.between()(mesh) - found.values.max())
    for place, values in enumerate((drawn.normal.values, np.log(drawn.elongation.values))):
        mean = np.average(mesh[..., place], weights=weight)
        deviation = np.sqrt(np.average((mesh[..., place] - mean) ** 2, weights=weight))
        assert abs(values.mean() - mean) < 0.25 * deviation
        assert values.std() == pytest.approx(deviation, rel=0.2)


def test_the_same_seed_gives_the_same_draws() -> None:
    law = rs.Frictionless(normal=0.93)
    data, few = heard(0.05, law, 5), {"particles": 100, "elongation": (0.02, 0.2), "scatter": (1e-3, 0.01)}
    one, other = (quick(data, law, **few)["posterior"].to_dataset() for _ in range(2))
    assert one.identical(other.assign_attrs(one.attrs))


def test_friction_and_materials_are_inferred_with_the_shape(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("restitution.experiment.inference._posterior._SHAPES", 4)
    law = rs.Coulomb(normal=0.93, friction=0.1)
    tree = quick(
        heard(0.1, law, 2),
        law,
        friction=(0.0, 0.4),
        particles=100,
        elongation=(0.05, 0.2),
        scatter=(1e-3, 0.01),
    )
    drawn = tree["posterior"].to_dataset()
    assert set(drawn.data_vars) == {"normal", "elongation", "out_of_roundness", "scatter", "friction"}
    assert 1e-3 <= float(drawn.scatter.min()) < float(drawn.scatter.max()) <= 0.01
    assert 0.0 <= float(drawn.friction.min()) < float(drawn.friction.max()) <= 0.4
    metal = rs.Frictionless(normal=rs.Plastic(yield_speed=0.02))
    tree = quick(heard(2e-3, metal, 2), metal, scatter=None)
    low, high = np.quantile(tree["posterior"].to_dataset().yield_speed, [0.001, 0.999])
    assert low < 0.02 < high
    rubber = rs.Viscoelastic(
        young_modulus=1e7, poisson_ratio=0.3, dissipation=1e-4, density=1100.0, radius=3e-3
    )
    tree = quick(heard(2e-3, rs.Frictionless(normal=rubber), 2), rs.Frictionless(normal=rubber), scatter=None)
    low, high = np.quantile(tree["posterior"].to_dataset().beta, [0.001, 0.999])
    assert low < rubber.beta < high


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"diameter": 0.0}, r"^diameter = 0.0"),
        ({"law": 1}, r"^law = 1: must be a law"),
        (
            {"elongation": (0.0, 0.1)},
            r"^elongation = .*: must be a pair \(low, high\) with 1e-09 <= low < high",
        ),
        ({"elongation": 0.1}, r"^elongation = 0.1: must be a pair"),
        ({"elongation": (1e-8, 0.1)}, r"^elongation = .*: must be high < 1e\+06 low"),
        ({"elongation": (1e-3, 3.0)}, r"^elongation = \(0.001, 3.0\), .* gives out_of_roundness = "),
        ({"scatter": (0.0, 0.1)}, r"^scatter = \(0\.0, 0\.1\): must be a pair \(low, high\) with 1e-09"),
        ({"scatter": (1e-3, 2.0)}, r"^scatter = \(0\.001, 2\.0\): must be at most 1, as ε_n is"),
        ({"friction": (0.0, 0.4)}, r"^friction: given for a Frictionless; only a Coulomb law has it"),
        (
            {"data": xr.Dataset()},
            r"^data lacks time, uncertainty, .*: must be a Dataset from flight\.restitution",
        ),
        ({"law": rs.Frictionless(normal=rs.Tabulated(v=[0.1, 1.0], e=[0.9, 0.8]))}, r"^law: a Tabulated"),
    ],
)
def test_what_cannot_be_inferred_is_refused(change: dict[str, Any], message: str) -> None:
    law = rs.Frictionless(normal=0.93)
    given: dict[str, Any] = {"data": heard(0.05, law, 1), "law": law, "diameter": 6e-3} | change
    with pytest.raises(ValueError, match=message):
        rs.posterior(given.pop("data"), given.pop("law"), **given)


def test_the_first_impacts_of_a_series_are_a_series() -> None:
    """The coefficient of the last is left out: its flight ends with an impact that is not there."""
    law = rs.Frictionless(normal=0.93)
    part = heard(0.15, law, 3).isel(impact=slice(0, 12), other_impact=slice(0, 12))
    assert quick(part, law, scatter=None).attrs["elongation_determined"] == 1


def test_few_impacts_are_refused() -> None:
    law = rs.Frictionless(normal=0.93)
    with pytest.raises(ValueError, match=r"^data: 3 coefficients from times alone; must be at least 5"):
        quick(heard(0.01, law, 1, impacts=5), law)


@pytest.mark.parametrize(("diameter", "least"), [(1e6, "at least"), (1e-20, "at most")])
def test_a_ball_that_cannot_fall_so_far_is_refused(diameter: float, least: str) -> None:
    """Dropped by 0.1 m it begins below the plane, or is lost in the digits of its height."""
    law = rs.Frictionless(normal=0.93)
    text = rf"^diameter = {diameter!r}, elongation = .*: gives release_height = .*: must be {least} "
    with pytest.raises(ValueError, match=text.replace("+", r"\+")):
        quick(heard(0.01, law, 1), law, diameter=diameter)


@pytest.mark.parametrize("name", ["restitution", "impact_velocity", "uncertainty", "restitution_covariance"])
def test_what_was_measured_has_numbers(name: str) -> None:
    """A duration has the bits of a whole number, which is not what was measured."""
    law = rs.Frictionless(normal=0.93)
    data = heard(0.05, law, 1)
    data[name] = data[name].copy(data=data[name].values.astype("timedelta64[ns]"))
    with pytest.raises(ValueError, match=rf"^(data|times)\.{name}"):
        quick(data, law)


def test_without_the_packages_it_is_said_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "emcee", None)
    law = rs.Frictionless(normal=0.93)
    with pytest.raises(ImportError, match=r"pip install 'restitution\[measure\]'"):
        quick(heard(0.01, law, 1), law)
