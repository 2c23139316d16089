"""A point of a study worked out again from its recorded impacts, group by group."""

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from reference.studies import TINY
from restitution.study import sweep

GROUPS, BLOCK, BLOCKS = 4, 16, 2
VELOCITIES, EDGES = np.linspace(0.0, 1.1, 6), np.linspace(-1.0, 3.0, 9)
RUN: dict[str, Any] = {"particles": BLOCK, "impacts": 20, "seed": 7, "release_height": 0.05}
BODY, LAW = rs.Dumbbell(radius=3e-3, separation=2e-3), rs.TangentialRestitution(normal=0.9)


def point(folder: Path, **tables: Any) -> xr.Dataset:
    """Two blocks of four batches of four particles, of one body under one law."""
    more = {"most_particles": BLOCK * BLOCKS, "until": {"mean": 1e-9}}
    given = TINY | {
        "sweep": {"body.separation": [2e-3]},
        "law": LAW,
        "run": RUN,
        "effort": {"batches": GROUPS} | (more if "statistics" not in tables else {}),
    }
    given |= tables
    if given["statistics"] is None:
        del given["statistics"]
    return sweep(given, folder / "s.zarr", threads=1).isel(separation=0)


def group_of(particle: int) -> int:
    return particle % BLOCK * GROUPS // BLOCK


def left_out(of: Callable[[np.ndarray], Any], particles: int) -> list[Any]:
    """What `of` gives for the particles without each of the groups."""
    group = np.array([group_of(particle) for particle in range(particles)])
    return [of(group != g) for g in range(GROUPS)]


def jackknife(parts: list[np.ndarray]) -> np.ndarray:
    values = np.array(parts)
    return np.asarray(
        np.sqrt((GROUPS - 1) / GROUPS * sum((value - values.mean(axis=0)) ** 2 for value in values))
    )


def test_standard_errors_leave_out_each_group_of_both_blocks(tmp_path: Path) -> None:
    """Group g has batch g of every block; what is rounded in the sums is below 1e-7."""
    found = point(tmp_path)
    assert int(found.particles) == BLOCK * BLOCKS
    assert int(found.pulling_impacts) == 0
    data = rs.simulate(BODY, LAW, **(RUN | {"particles": BLOCK * BLOCKS}))
    v, e = data.impact_velocity.values, data.restitution.values

    def measured(chosen: np.ndarray) -> dict[str, list[Any]]:
        rows: dict[str, list[Any]] = {
            name: [] for name in ("density", "mean_restitution", "std_restitution", "second_moment")
        }
        for low, high in pairwise(VELOCITIES):
            here = e[chosen][(v[chosen] >= low) & (v[chosen] < high)]
            counts = [((here >= a) & (here < b)).sum() for a, b in pairwise(EDGES)]
            with np.errstate(invalid="ignore", divide="ignore"):
                rows["density"].append(np.array(counts) / np.float64(here.size) / 0.5)
            rows["mean_restitution"].append(here.mean() if here.size else np.nan)
            rows["std_restitution"].append(here.std() if here.size else np.nan)
            rows["second_moment"].append((here**2).mean() if here.size else np.nan)
        return rows

    whole, parts = measured(np.ones(BLOCK * BLOCKS, bool)), left_out(measured, BLOCK * BLOCKS)
    for name, values in whole.items():
        np.testing.assert_allclose(found[name].values, np.array(values), rtol=1e-6, err_msg=name)
        errors = jackknife([np.array(part[name]) for part in parts])
        np.testing.assert_allclose(found[f"{name}_error"].values, errors, rtol=1e-4, atol=1e-7, err_msg=name)
        about = found[name].attrs["long_name"]
        assert found[f"{name}_error"].attrs["long_name"] == f"standard error of {about}"
    reasons = data.stop_reason.attrs["flag_meanings"]
    assert found.stop_reason.attrs["flag_meanings"] == reasons
    assert found.stop_reason.values.tolist() == found.stop_reason.attrs["flag_values"] == list(range(6))


@pytest.mark.filterwarnings("ignore::restitution.PullWarning", "ignore::restitution.EnergyWarning")
def test_impacts_that_pull_are_counted_over_all_blocks(tmp_path: Path) -> None:
    """Those of the recorded impacts in which the body leaves more slowly than without any impulse."""
    law = rs.TangentialRestitution(normal=0.3, tangential=-0.5)
    found = point(tmp_path, law=law).pulling_impacts
    data = rs.simulate(BODY, law, **(RUN | {"particles": BLOCK * BLOCKS}))
    impulse = data.impact_velocity * (1.0 + data.restitution)
    assert int(found) == int((impulse < 0.0).sum()) == data.attrs["pulling_impacts"] > 0
    assert found.attrs == {"long_name": "impacts in which the law let the plane pull"}


def moments(found: xr.Dataset) -> xr.Dataset:
    """The share of impacts with negative ε by velocity, with a unit, and a whole number."""
    negative = found.restitution_count.where(found.restitution < 0.0, 0).sum("restitution") / found.number
    negative.attrs = {"units": "1"}
    return xr.Dataset({"negative": negative, "number_of_bins": 8})


def test_a_measure_of_statistics_has_the_errors_of_its_groups(tmp_path: Path) -> None:
    function = {"function": moments, "of": "statistics"}
    statistics = TINY["statistics"]
    found = point(tmp_path, measure=function, statistics=statistics)
    data = rs.simulate(BODY, LAW, **RUN)
    v, e = data.impact_velocity.values, data.restitution.values

    def share(chosen: np.ndarray) -> np.ndarray:
        inside = [e[chosen][(v[chosen] >= low) & (v[chosen] < high)] for low, high in pairwise(VELOCITIES)]
        return np.array([(here < 0.0).mean() if here.size else np.nan for here in inside])

    np.testing.assert_allclose(found.negative, share(np.ones(BLOCK, bool)), rtol=1e-12)
    np.testing.assert_allclose(found.negative_error, jackknife(left_out(share, BLOCK)), rtol=1e-9, atol=1e-15)
    assert found.negative_error.attrs == {"long_name": "standard error of negative", "units": "1"}
    assert int(found.number_of_bins) == 8
    assert "number_of_bins_error" not in found


def early(data: xr.Dataset) -> xr.Dataset:
    """Times of the first three impacts, mean and mean square, and one number for all."""
    times = data["time"].values[:, :3]
    table = np.stack([times.mean(axis=0), (times**2).mean(axis=0)])
    return xr.Dataset(
        {
            "early": (("power", "impact"), table, {"long_name": "early times", "units": "s"}),
            "last": ((), float(data["time"].max("impact").mean())),
        },
        {"power": [1, 2]},
    )


def test_a_measure_of_recorded_impacts_is_the_mean_of_its_batches(tmp_path: Path) -> None:
    found = point(tmp_path, measure={"function": early, "of": "simulate"}, statistics=None)
    data = rs.simulate(BODY, LAW, **RUN)
    batches = [early(data.isel(particle=slice(4 * b, 4 * b + 4))) for b in range(GROUPS)]
    assert found.power.values.tolist() == [1, 2]
    for name in ("early", "last"):
        values = np.array([batch[name].values for batch in batches])
        np.testing.assert_allclose(found[name], values.mean(axis=0), rtol=1e-13)
        np.testing.assert_allclose(found[f"{name}_error"], values.std(axis=0, ddof=1) / 2.0, rtol=1e-12)
    assert found.early.dims == found.early_error.dims == ("power", "impact")
    assert found.early.attrs == {"long_name": "early times", "units": "s"}
    assert found.early_error.attrs == {"long_name": "standard error of early times", "units": "s"}
    assert found.last_error.attrs == {"long_name": "standard error of last"}


@pytest.mark.parametrize("orientation", ["uniform-angle", "isotropic"])
def test_the_first_impact_is_that_of_the_run(orientation: Any, tmp_path: Path) -> None:
    """Its height, gravity and law of orientation count where ε_n depends on the speed."""
    law = rs.Frictionless(normal=rs.Plastic(yield_speed=0.05))
    run = RUN | {"gravity": 3.7, "orientation": orientation}
    found = point(tmp_path, law=law, run=run, first_impact={}, statistics=None)
    exact = rs.analytic.first_impact(BODY, law, orientation=orientation, release_height=0.05, gravity=3.7)
    assert float(found.first_impact_mean) == exact.mean()
    assert float(found.first_impact_std) == exact.std()
    assert found.first_impact_mean.attrs == {"long_name": "mean restitution of the first impact"}
    about = {"long_name": "standard deviation of the restitution of the first impact"}
    assert found.first_impact_std.attrs == about
