"""Compare what `posterior` gives besides its draws with the table and the chains."""

import sys
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution._internal.text import digits
from restitution.experiment.inference import _posterior
from restitution.experiment.inference._table import Table
from restitution.experiment.inference._verdict import agreeing, disagreement, judge

LAW = rs.Coulomb(normal=0.93, friction=0.1)
SHAPES = np.geomspace(0.03, 0.3, 9)


def inferred(monkeypatch: pytest.MonkeyPatch, of_shape: Callable[[Any], Any]) -> tuple[xr.DataTree, Table]:
    """A posterior over ε_n, ln L/R and friction whose likelihood is a known function of them."""
    run = rs.simulate(
        rs.from_roundness(6e-3, 1.5e-4), LAW, particles=1, impacts=14, release_height=0.103, seed=2
    )
    data = rs.flight.restitution(run.time.values[0], 1e-5, drop_height=0.1)
    made: list[Table] = []

    def known(_: Any, __: Any, ___: Any, elongations: Any, ____: Any, frictions: Any, *rest: Any) -> Table:
        axes = (np.linspace(0.9, 0.96, 31), np.log(elongations), np.asarray(frictions, dtype=np.float64))
        normal, shape, friction = np.meshgrid(*axes, indexing="ij")
        values = -0.5 * ((normal - 0.93) / 0.01) ** 2 + of_shape(shape) - 2.0 * friction
        made.append(Table(axes, values))
        return made[0]

    monkeypatch.setattr(_posterior, "table", known)
    tree = rs.posterior(
        data,
        LAW,
        diameter=6e-3,
        elongation=(0.03, 0.3),
        scatter=None,
        roughness=0.0,
        friction=(0.1, 0.5),
        particles=100,
        draws=4000,
        seed=3,
    )
    return tree, made[0]


@pytest.fixture
def found(monkeypatch: pytest.MonkeyPatch) -> tuple[xr.DataTree, Table]:
    """One whose times determine the shape."""
    return inferred(monkeypatch, lambda shape: -0.5 * ((shape + 2.0) / 0.3) ** 2)


def test_the_grid_of_friction_is_dense_where_it_begins(found: tuple[xr.DataTree, Table]) -> None:
    axes = found[1].axes
    np.testing.assert_allclose(np.exp(axes[1]), SHAPES)
    np.testing.assert_allclose(axes[2], 0.1 + 0.4 * (np.arange(6) / 5.0) ** 2)


def test_each_draw_has_its_own_likelihood(found: tuple[xr.DataTree, Table]) -> None:
    """Parameters and logarithms are in the same order; draws are independent."""
    tree, table = found
    drawn = tree["posterior"].to_dataset()
    assert dict(drawn.sizes) == {"chain": 4, "draw": 1000}
    points = np.stack([drawn.normal, np.log(drawn.elongation), drawn.friction], axis=-1)
    np.testing.assert_allclose(table.between()(points), tree["sample_stats"].lp, rtol=0, atol=1e-9)
    for name, mean, deviation in (("normal", 0.93, 0.01),):
        assert abs(float(drawn[name].mean()) - mean) < 0.2 * deviation
        assert float(drawn[name].std()) == pytest.approx(deviation, rel=0.1)
    assert np.unique(drawn.normal.values).size == 4000


def test_the_tree_says_what_it_holds(found: tuple[xr.DataTree, Table]) -> None:
    tree, table = found
    drawn = tree["posterior"].to_dataset()
    xr.testing.assert_allclose(drawn.out_of_roundness, 0.25 * 6e-3 * drawn.elongation)
    assert drawn.out_of_roundness.attrs["units"] == "m"
    numbers = tree["observed_data"].numbers
    assert numbers.shape == (1, 6)
    profile = tree["likelihood"].profile
    assert profile.dims == ("elongation",)
    assert profile.attrs["long_name"] == "ln L, less its largest"
    np.testing.assert_allclose(profile.elongation, SHAPES)
    highest = table.values.max(axis=(0, 2))
    np.testing.assert_allclose(profile, highest - highest.max())
    about = tree.attrs
    assert about["title"] == "Posterior from the times of impacts"
    assert about["source"] == f"restitution {rs.__version__}"
    assert (about["law"], about["form"], about["lobes"]) == (repr(LAW), "dumbbell", 2)
    assert (about["diameter"], about["particles"], about["draws"], about["seed"]) == (6e-3, 100, 4000, 3)


def test_the_limit_weighs_equal_intervals_of_elongation_equally(found: tuple[xr.DataTree, Table]) -> None:
    """The likelihood, integrated over the rest, is the density in L/R; and the sentence tells quantiles."""
    tree, table = found
    drawn = tree["posterior"].to_dataset().elongation.values.ravel()
    fine = [np.linspace(axis[0], axis[-1], 201) for axis in table.axes]
    mesh = np.stack(np.meshgrid(fine[0], table.axes[1], fine[2], indexing="ij"), axis=-1)
    density = np.exp(table.between()(mesh)).sum(axis=(0, 2))
    steps = 0.5 * (density[1:] + density[:-1]) * np.diff(SHAPES)
    limit = tree.attrs["elongation_upper_limit"]
    at = int(np.searchsorted(SHAPES, limit))
    assert steps[: at - 1].sum() <= 0.95 * steps.sum() <= steps[:at].sum()
    low, middle, high = np.quantile(drawn, (0.05, 0.5, 0.95))
    assert tree.attrs["elongation_determined"] == 1  # ln L falls by 12.7 to the least L/R
    assert tree.attrs["verdict"] == (
        f"The times determine the shape, if ε_n does not scatter: L/R = {middle:.2g}, between {low:.2g} and "
        f"{high:.2g} (90 %), an out-of-roundness of {digits(1500.0 * middle)} µm, for a ball of "
        "the form 'dumbbell'."
    )


def test_a_round_ball_explains_the_times_as_well_if_the_least_elongation_does(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Ask so for any likelihood of the next one; the sentence tells the limit, also as out-of-roundness."""
    second = np.log(SHAPES[1])
    tree, table = inferred(monkeypatch, lambda shape: np.where(np.isclose(shape, second), -9.0, 0.0))
    assert np.ptp(table.values.max(axis=(0, 2))) == pytest.approx(9.0)
    assert tree.attrs["elongation_determined"] == 0
    limit = tree.attrs["elongation_upper_limit"]
    assert tree.attrs["verdict"] == (
        f"The times do not determine the shape: a round ball explains them as well. L/R is below "
        f"{limit:.2g} (95 %), the out-of-roundness below {digits(1500.0 * limit)} µm, for a ball of the form "
        "'dumbbell'."
    )


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"friction": (0.5, 0.1)},
            r"^friction = \(0\.5, 0\.1\): must be a pair \(low, high\) with 0 <= low < high",
        ),
        ({"friction": (0.1, 0.1)}, r"^friction = \(0\.1, 0\.1\): must be a pair"),
        (
            {"elongation": (0.1, np.inf)},
            r"^elongation = \(0\.1, inf\): must be a pair \(low, high\) with 1e-09",
        ),
        ({"elongation": [[0.1, 0.2]]}, r"^elongation = \[\[0\.1, 0\.2\]\]: must be a pair"),
        ({"elongation": (0.1, 0.2, 0.3)}, r"^elongation = \(0\.1, 0\.2, 0\.3\): must be a pair"),
        ({"elongation": (1e-8, 0.1)}, r"^elongation = \(1e-08, 0\.1\): must be high < 1e\+06 low"),
        ({"elongation": (1e-8, 1e-2)}, r"^elongation = \(1e-08, 0\.01\): must be high < 1e\+06 low"),
        (
            {"elongation": (1e-3, 3.0)},
            r"^elongation = \(0\.001, 3\.0\), diameter = 0\.006: gives out_of_roundness",
        ),
        (
            {"diameter": 1e3},
            r"^diameter = 1000\.0, elongation = \(0\.001, 0\.3\): gives release_height = 500\.1",
        ),
    ],
)
def test_errors_name_the_prior_and_its_value(change: dict[str, Any], said: str) -> None:
    data = rs.flight.restitution(np.cumsum(0.28 * 0.93 ** np.arange(12)), 1e-5, drop_height=0.1)
    with pytest.raises(ValueError, match=said):
        rs.posterior(data, LAW, **({"diameter": 6e-3} | change))


def test_errors_name_the_series_of_several() -> None:
    data = [
        rs.flight.restitution(np.cumsum(0.28 * 0.93 ** np.arange(n)), 1e-5, drop_height=0.1) for n in (12, 5)
    ]
    bad = data[0].assign_attrs(gravity=-1.0)
    for given, name in ((bad, "data"), ([data[0], bad], r"data\[1\]"), (iter([data[0], bad]), r"data\[1\]")):
        with pytest.raises(ValueError, match=rf"^{name}\.gravity = -1\.0: must be a real number in"):
            rs.posterior(given, LAW, diameter=6e-3)
    for given, name in ((data[1], "data"), (data, r"data\[1\]")):
        with pytest.raises(ValueError, match=f"^{name}: 3 coefficients from times alone; must be at least 5"):
            rs.posterior(given, LAW, diameter=6e-3)


def test_draws_reach_both_ends_of_the_table(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draws come up to the ends if all shapes are as likely, and none is beyond."""
    drawn = inferred(monkeypatch, np.zeros_like)[0]["posterior"].to_dataset().elongation.values
    assert SHAPES[0] <= drawn.min() < SHAPES[0] * 1.01
    assert SHAPES[-1] * 0.99 < drawn.max() <= SHAPES[-1]


def test_what_to_install_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "arviz_base", None)
    said = r"^a posterior needs ArviZ's arviz-base: pip install 'restitution\[measure\]'$"
    with pytest.raises(ImportError, match=said):
        rs.posterior(xr.Dataset(), LAW, diameter=6e-3)


def peak(height: float, noise: float) -> Table:
    """A likelihood with a peak of this height over its low end, along ln L/R or ln of a height."""
    line = np.linspace(-7.0, -1.0, 61)
    values = height * np.exp(-0.5 * ((line + 3.0) / 0.5) ** 2) + np.zeros((9, 1))
    return Table((np.linspace(0.9, 0.96, 9), line), values, best=height, noise=noise)


def test_no_verdict_rests_on_the_noise_of_the_likelihood() -> None:
    """Asperities are better than a shape by e⁵: strong evidence, unless ln of it is known to 2.8 only."""
    shape = peak(20.0, 0.0)
    assert judge(shape, peak(25.0, 0.0), shape, scatters=False).cause == "roughness"
    unsure = judge(shape, peak(25.0, 8.0), shape, scatters=False)
    assert (unsure.cause, unsure.surface) == ("surface", "surface")
    assert unsure.error == pytest.approx(8.0**0.5)
    assert judge(shape, peak(40.0, 8.0), shape, scatters=False).cause == "roughness"


def test_a_kind_of_ball_that_gives_the_times_is_no_disagreement() -> None:
    """The likeliest balls, rough ones, do not scatter so; a shape, hardly less likely, does."""
    wrong = (1e-4, 0.5, 0.5, 0.5)
    shape, rough = peak(20.0, 0.0), replace(peak(21.0, 0.0), signs=wrong)
    assert disagreement(agreeing(shape, rough)) == ""
    assert disagreement(rough).startswith("No ball of this kind gives the observed scatter")
    assert agreeing(peak(10.0, 0.0), rough) is rough


@pytest.mark.parametrize(
    ("normal", "power"),
    [
        (0.9, 0.0),
        (
            rs.Viscoelastic(young_modulus=1e7, poisson_ratio=0.3, dissipation=1e-4, density=1e3, radius=3e-3),
            -0.2,
        ),
        (rs.Plastic(yield_speed=0.5), 1.0),
    ],
)
def test_errors_of_g_and_of_the_clock_are_one_factor_of_all_speeds(
    monkeypatch: pytest.MonkeyPatch, normal: Any, power: float
) -> None:
    """ε_n is a function of v/v_y and of β v^(1/5), and a ratio of times knows no speed."""

    def known(_: Any, __: Any, ___: Any, elongations: Any, *rest: Any) -> Table:
        axes = (np.linspace(0.93, 0.9301, 3), np.log(elongations))
        return Table(axes, np.zeros((3, elongations.size)))

    monkeypatch.setattr(_posterior, "table", known)
    times = np.append(0.0, np.cumsum(0.28 * 0.93 ** np.arange(14)))
    data = rs.flight.restitution(times, 1e-5, gravity_uncertainty=0.03 * 9.81, clock_uncertainty=0.04)
    law = rs.Frictionless(normal=normal)
    tree = rs.posterior(
        data, law, diameter=6e-3, elongation=(0.03, 0.3), scatter=None, roughness=0.0, draws=4000
    )
    name = next(iter(tree["posterior"].data_vars))
    spread = float(np.log(tree["posterior"].to_dataset()[name]).std())
    assert spread == pytest.approx(abs(power) * 0.05, rel=0.05, abs=1e-4)


def test_a_factor_of_g_acts_on_the_shape_as_one_of_the_diameter() -> None:
    """Times of a fall scale as √(R/g): an error of 0.003 of g is one of 0.003 of the diameter to L/R."""
    rng = np.random.default_rng(4)
    times = np.append(0.0, np.cumsum(0.28 * np.cumprod(0.93 + 0.005 * rng.standard_normal(14))))
    trees = [
        rs.posterior(
            rs.flight.restitution(times, 2e-5, gravity=scale * 9.81),
            LAW,
            diameter=scale * 6e-3,
            elongation=(0.02, 0.2),
            scatter=None,
            particles=100,
            draws=400,
        )["posterior"].to_dataset()
        for scale in (1.0, 4.0)
    ]
    for name in ("normal", "elongation"):
        np.testing.assert_allclose(trees[0][name], trees[1][name], rtol=1e-9)
