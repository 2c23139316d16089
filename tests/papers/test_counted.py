"""What the figures count is what would have been recorded, with standard errors of all that is counted."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution.papers.glielmo2014 import _data as data
from restitution.papers.glielmo2014._counted import impacts_counted
from restitution.papers.glielmo2014._runs import Runs, simulate_all
from restitution.papers.glielmo2014._settings import Settings

SMALL = replace(
    Settings(),
    least_impacts=100_000,
    recorded_impacts=60_000,
    secondary_particles=60,
    first_particles=1,
    energy_elongations=(),
    radii=(),
    heights=(),
)


@pytest.fixture(scope="module")
def runs() -> Runs:
    return simulate_all(SMALL, 100_000, seed=5, progress=False)


@pytest.fixture(scope="module")
def every(runs: Runs) -> xr.Dataset:
    """Record of all the impacts that are counted for Figs. 2-5 and 7."""
    about = runs.counted.lattice.attrs
    body = rs.Dumbbell(radius=about["radius"], separation=about["separation"])
    size = {name: about[name] for name in ("particles", "impacts", "seed")}
    return rs.simulate(body, SMALL.law, **size)


def test_map_is_the_histogram_of_all_impacts(runs: Runs, every: xr.Dataset) -> None:
    """Fig. 2's lattice holds the counts that NumPy's own histogram finds; each site the paper's mesh wide."""
    drawn = data.restitution_map(runs, SMALL)
    v, e = (every[name].to_numpy().ravel() for name in ("impact_velocity", "restitution"))
    edges = drawn["velocity_edges"].to_numpy(), drawn["restitution_edges"].to_numpy()
    # NumPy closes its last bin; nothing lies on it here.
    expected, _, _ = np.histogram2d(v[np.isfinite(v)], e[np.isfinite(v)], bins=list(edges))
    np.testing.assert_array_equal(drawn["restitution_count"], expected)
    np.testing.assert_allclose(np.diff(edges[0]), 0.002, rtol=1e-9)
    np.testing.assert_allclose(np.diff(edges[1]), 0.01, rtol=1e-9)
    np.testing.assert_allclose(edges[0] / 0.002, np.round(edges[0] / 0.002), rtol=1e-12)


def test_what_is_recorded_comes_first_in_what_is_counted(runs: Runs, every: xr.Dataset) -> None:
    """One ensemble: its first particles are recorded up to the limit, to the bit, and all are counted.

    Trajectories end by themselves, on average late enough for as many impacts as were asked for.
    """
    assert every.sizes["particle"] > runs.main.sizes["particle"]
    assert 60_000 <= int(runs.main["impacts"].sum()) < 100_000 <= int(every["impacts"].sum())
    for name, values in runs.main.data_vars.items():
        xr.testing.assert_equal(every[name][: runs.main.sizes["particle"]], values)
    for found in (runs.counted.lattice, runs.counted.slow, runs.counted.windows):
        assert impacts_counted(found) == int(every["impacts"].sum())
    for x, found in runs.counted.beads.items():
        assert found.attrs["seed"] == runs.beads[x].attrs["seed"]
        assert impacts_counted(found) >= 100_000


def test_histograms_are_those_of_all_impacts(runs: Runs, every: xr.Dataset) -> None:
    """Figs. 4 and 5, put together from one lattice, are NumPy's histograms of the impacts in each window."""
    drawn = data.restitution_histograms(runs, SMALL), data.fraction_histograms(runs, SMALL)
    v = every["impact_velocity"].to_numpy()
    for shown, name in zip(drawn, ("restitution", "rotational_fraction"), strict=True):
        for k, (low, high) in enumerate(SMALL.speed_windows):
            values = every[name].to_numpy()[(v >= low) & (v < high)]
            part = shown.isel(speed=k)
            expected, _ = np.histogram(values, part["edges"])
            np.testing.assert_array_equal(part["impacts"], expected)
            assert (int(part["number"]), int(part["outside"])) == (values.size, values.size - expected.sum())


def test_standard_errors_when_all_is_recorded(runs: Runs, every: xr.Dataset) -> None:
    """Then the variance of a share is Σ(c − np)²/(Σn)², c of the n impacts of a particle being in the bin."""
    drawn = data.fraction_histograms(replace(runs, main=every), SMALL)
    v, fraction = (every[name].to_numpy() for name in ("impact_velocity", "rotational_fraction"))
    for k, (low, high) in enumerate(SMALL.speed_windows):
        part = drawn.isel(speed=k)
        width = part["edges"].diff("edge").to_numpy()
        chosen = [f[(x >= low) & (x < high)] for x, f in zip(v, fraction, strict=True)]
        n = np.array([values.size for values in chosen])
        c = np.array([np.histogram(values, part["edges"])[0] for values in chosen])
        p = c.sum(axis=0) / n.sum()
        error = np.sqrt(np.sum((c - np.outer(n, p)) ** 2, axis=0)) / n.sum() / width
        np.testing.assert_allclose(part["density_error"], error, rtol=1e-9)


def test_standard_errors_when_a_part_is_recorded(runs: Runs, every: xr.Dataset) -> None:
    """Then they agree with those for which all that is counted is recorded, in the median over the bins.

    From 60 particles, errors scatter by some 10 %. Those of the recorded part alone would be too large by
    √(100/60) = 1.3 in Figs. 4 and 5 and by √(250/60) = 2 in Fig. 6.
    """
    about = runs.counted.beads[0.01].attrs
    size = {name: about[name] for name in ("particles", "impacts")}
    beads = {
        x: rs.simulate(SMALL.body(x), SMALL.law, seed=data.attrs["seed"], **size)
        for x, data in runs.beads.items()
    }
    whole = replace(runs, main=every, beads=beads)
    for reduce, error in (
        (data.restitution_histograms, "density_error"),
        (data.fraction_histograms, "density_error"),
        (data.bead_deviation, "deviation_error"),
    ):
        part, full = (reduce(given, SMALL)[error] for given in (runs, whole))
        assert 0.8 < float((part / full.where(full > 0)).median()) < 1.2
