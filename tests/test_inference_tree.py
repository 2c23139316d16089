"""What `posterior` gives besides its draws, worked out again from the table and the chains."""

from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution.inference import _posterior
from restitution.inference._table import Table

LAW = rs.Coulomb(normal=0.93, friction=0.1)
SHAPES = np.geomspace(0.03, 0.3, 11)


@pytest.fixture
def found(monkeypatch: pytest.MonkeyPatch) -> tuple[xr.DataTree, Table]:
    """A posterior over ε_n, ln L/R and friction whose likelihood is a known function of them."""
    run = rs.simulate(
        rs.from_roundness(6e-3, 1.5e-4), LAW, particles=1, impacts=14, release_height=0.103, seed=2
    )
    data = rs.flight.restitution(run.time.values[0], 1e-5, drop_height=0.1)
    made: list[Table] = []

    def known(_: Any, __: Any, elongations: Any, frictions: Any, *___: Any) -> Table:
        axes = (np.linspace(0.9, 0.96, 31), np.log(elongations), np.asarray(frictions, dtype=np.float64))
        normal, shape, friction = np.meshgrid(*axes, indexing="ij")
        values = -0.5 * (((normal - 0.93) / 0.01) ** 2 + ((shape + 2.0) / 0.3) ** 2) - 2.0 * friction
        made.append(Table(axes, values))
        return made[0]

    monkeypatch.setattr(_posterior, "table", known)
    tree = rs.posterior(
        data,
        LAW,
        diameter=6e-3,
        elongation=(0.03, 0.3),
        friction=(0.1, 0.5),
        particles=100,
        draws=4000,
        seed=3,
    )
    return tree, made[0]


def test_the_grid_of_friction_is_dense_where_it_begins(found: tuple[xr.DataTree, Table]) -> None:
    axes = found[1].axes
    np.testing.assert_allclose(np.exp(axes[1]), SHAPES)
    np.testing.assert_allclose(axes[2], 0.1 + 0.4 * (np.arange(6) / 5.0) ** 2)


def test_each_draw_has_its_own_likelihood(found: tuple[xr.DataTree, Table]) -> None:
    """Chains are four groups of walkers; parameters and logarithms are in the same order."""
    tree, table = found
    drawn = tree["posterior"].to_dataset()
    assert dict(drawn.sizes) == {"chain": 4, "draw": 1000}
    points = np.stack([drawn.normal, np.log(drawn.elongation), drawn.friction], axis=-1)
    np.testing.assert_allclose(table.between()(points), tree["sample_stats"].lp, rtol=0, atol=1e-9)
    for name, mean, deviation in (("normal", 0.93, 0.01),):
        assert abs(float(drawn[name].mean()) - mean) < 0.2 * deviation
        assert float(drawn[name].std()) == pytest.approx(deviation, rel=0.1)
    # A walker goes on from its last place; the walkers of two chains do not follow one another.
    steps = np.abs(np.diff(drawn.normal.values, axis=1))
    assert np.median(steps) < 0.02
    assert np.unique(drawn.normal.values).size > 1000


def test_the_tree_says_what_it_holds(found: tuple[xr.DataTree, Table]) -> None:
    tree, table = found
    drawn = tree["posterior"].to_dataset()
    xr.testing.assert_allclose(drawn.out_of_roundness, 0.25 * 6e-3 * drawn.elongation)
    assert drawn.out_of_roundness.attrs["units"] == "m"
    numbers = tree["observed_data"].numbers
    assert numbers.shape == (1, 3)
    profile = tree["likelihood"].profile
    assert profile.dims == ("elongation",)
    assert profile.attrs["long_name"] == "ln L, less its largest"
    np.testing.assert_allclose(profile.elongation, SHAPES)
    highest = table.values.max(axis=(0, 2))
    np.testing.assert_allclose(profile, highest - highest.max())
    about = tree.attrs
    assert about["title"] == "Posterior from the times of impacts"
    assert about["source"] == f"restitution {rs.__version__}"
    assert (about["law"], about["form"], about["lobes"]) == (repr(LAW), "lobed", 2)
    assert (about["diameter"], about["particles"], about["draws"], about["seed"]) == (6e-3, 100, 4000, 3)


def test_the_limit_weighs_equal_intervals_of_elongation_equally(found: tuple[xr.DataTree, Table]) -> None:
    """Of draws whose prior is uniform in ln L/R each counts as L/R; and the sentence tells quantiles."""
    tree = found[0]
    drawn = np.sort(tree["posterior"].to_dataset().elongation.values.ravel())
    beyond = [part for part in drawn if drawn[drawn <= part].sum() >= 0.95 * drawn.sum()]
    assert tree.attrs["elongation_upper_limit"] == pytest.approx(beyond[0], rel=1e-12)
    low, middle, high = np.quantile(drawn, (0.05, 0.5, 0.95))
    assert tree.attrs["elongation_determined"] == 1  # ln L falls by 12.7 to the least L/R
    assert tree.attrs["verdict"] == (
        f"The times determine the shape: L/R = {middle:.2g}, between {low:.2g} and {high:.2g} (90 %), an "
        f"out-of-roundness of {1500.0 * middle:.2g} µm."
    )
