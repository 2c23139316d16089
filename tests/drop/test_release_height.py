"""Heights that are drawn for each particle: their law, and everything that takes them."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.stats
import xarray as xr

import restitution as rs
from restitution.drop.run import Run
from restitution.drop.toml import read, tables_of

BODY = rs.Dumbbell(radius=3e-3, separation=3e-4)
LAW = rs.TangentialRestitution(normal=0.9)
HEIGHT = rs.RandomHeight(lowest=0.05, highest=0.07)


def test_the_law_is_a_raised_cosine() -> None:
    """Beside scipy.stats.cosine: Kolmogorov and Smirnov with 1e-4 of false alarm, for three seeds.

    Heights have nothing to do with angles: a correlation within five standard errors of 0.
    """
    law = scipy.stats.cosine(loc=0.06, scale=0.01 / math.pi)
    for seed in (1, 2, 3):
        data = rs.simulate(BODY, LAW, particles=20_000, impacts=1, release_height=HEIGHT, seed=seed)
        heights = data["release_height"].to_numpy()
        assert scipy.stats.kstest(heights, law.cdf).pvalue > 1e-4
        assert abs(np.corrcoef(heights, data["release_angle"])[0, 1]) < 5.0 / math.sqrt(20_000)


def test_a_particle_falls_from_its_own_height() -> None:
    """As in a run in which all fall from there, to the rounding of the height; angles are as ever."""
    data = rs.simulate(BODY, LAW, particles=5, impacts=30, release_height=HEIGHT)
    for particle in range(5):
        height = float(data["release_height"][particle])
        alone = rs.simulate(BODY, LAW, particles=5, impacts=3, release_height=height).isel(particle=particle)
        for name in ("time", "impact_velocity", "restitution"):
            np.testing.assert_allclose(data[name][particle, :3], alone[name], rtol=1e-12)
    assert data.attrs["release_height"] == "random"
    np.testing.assert_array_equal(data.attrs["release_height_range"], [0.05, 0.07])


def test_it_depends_on_seed_and_particle_alone() -> None:
    how: dict[str, Any] = {"impacts": 2, "release_height": HEIGHT}
    many = rs.simulate(BODY, LAW, particles=300, threads=2, **how)
    few = rs.simulate(BODY, LAW, particles=7, threads=1, **how)
    xr.testing.assert_identical(many["release_height"][:7], few["release_height"])
    other = rs.simulate(BODY, LAW, particles=7, seed=2, **how)
    assert (other["release_height"] != few["release_height"]).all()


def test_the_first_impacts_have_all_speeds() -> None:
    """Spheres from one height have one; from all heights those of falls by 47 to 67 mm, but for the ends."""
    sphere = rs.Dumbbell(radius=3e-3, separation=0.0)
    fastest, slowest = (math.sqrt(2.0 * 9.81 * (height - 3e-3)) for height in (0.07, 0.05))
    for height, most in ((0.06, 0.0), (HEIGHT, fastest - slowest)):
        data = rs.simulate(sphere, LAW, particles=2000, impacts=1, release_height=height)
        assert np.ptp(data["impact_velocity"].to_numpy()) == pytest.approx(most, abs=0.03)


def test_statistics_and_compare_take_it() -> None:
    how: dict[str, Any] = {"particles": 64, "impacts": 20, "release_height": HEIGHT, "spin": (0.0, 9.0, 0.0)}
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.0, 1.2, 25),
        "restitution_bins": np.linspace(-1.0, 3.0, 41),
    }
    counted = rs.statistics(BODY, LAW, **how, **bins)
    reduced = rs.reduce(rs.simulate(BODY, LAW, **how), **bins)
    np.testing.assert_array_equal(counted["restitution_count"], reduced["restitution_count"])
    compared = rs.compare({"body": BODY}, {"law": LAW}, **how, **bins)
    np.testing.assert_array_equal(compared["restitution_count"][0, 0], reduced["restitution_count"])


def test_a_distribution_is_learned_from_it() -> None:
    """As good as from the heights that `learn` spreads by itself, and without the comb of a single one."""
    how: dict[str, Any] = {"particles": 4000, "impacts": 60, "velocities": (0.4, 0.9), "seed": 2}
    height = rs.RandomHeight(lowest=0.045, highest=0.08)
    dist = rs.FluctuatingRestitution.learn(BODY, LAW, release_height=height, **how)
    assert float(dist.data["ks_distance"].max()) < 0.05
    assert dist.data.attrs["release_height"] == "random"
    assert "heights_about" not in dist.data.attrs


RUN_FILE = """
[body]
shape = "dumbbell"
radius = 3e-3
separation = 3e-4
[law]
type = "tangential-restitution"
normal = 0.9
[run]
particles = 5
"""


@pytest.mark.parametrize(
    "text",
    [
        "release_height = {lowest = 0.05, highest = 0.07}",
        "[run.release_height]\nlowest = 0.05\nhighest = 0.07",
    ],
)
def test_a_file_takes_it(text: str, tmp_path: Path) -> None:
    path = tmp_path / "run.toml"
    path.write_text(RUN_FILE + text, encoding="utf-8")
    run = read(path)
    assert run == Run(body=BODY, law=LAW, particles=5, release_height=HEIGHT)
    assert tables_of(run)["run"]["release_height"] == {"lowest": 0.05, "highest": 0.07}


def test_a_study_sweeps_over_its_ends(tmp_path: Path) -> None:
    found = rs.sweep(
        {
            "body": BODY,
            "law": LAW,
            "run": {"particles": 64, "impacts": 5, "release_height": {"lowest": 0.04, "highest": 0.08}},
            "sweep": {"run.release_height.lowest": [0.04, 0.07]},
            "statistics": {
                "velocity_bins": 12,
                "velocity_range": [0.0, 1.2],
                "restitution_bins": 20,
                "restitution_range": [0.0, 2.0],
            },
            "effort": {"batches": 8},
        },
        out=tmp_path / "study.zarr",
    )
    assert found.sizes["lowest"] == 2


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (
            lambda: rs.RandomHeight(lowest=0.07, highest=0.07),
            "highest = 0.07: must be greater than lowest = 0.07",
        ),
        (lambda: rs.RandomHeight(lowest=0, highest=1), "lowest = 0: must be a finite number > 0 (m)"),
        (lambda: rs.RandomHeight(lowest=0.1, highest=math.inf), "highest = inf: must be a finite number > 0"),
        (
            lambda: rs.simulate(BODY, LAW, release_height=rs.RandomHeight(lowest=1e-3, highest=0.1)),
            "release_height = RandomHeight(lowest=0.001, highest=0.1): must be at least 0.00315",
        ),
        (
            lambda: rs.simulate(BODY, LAW, release_height=[0.1, 0.2]),  # type: ignore[arg-type]
            "release_height = [0.1, 0.2]: must be a finite number > 0 (height of the centre of mass, m), or",
        ),
    ],
)
def test_bad_heights_are_named(make: Any, said: str) -> None:
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - looked at below
        make()
    assert str(caught.value).startswith(said)
