"""A coefficient that scatters: the law of the drawn numbers, and every way in which a run is asked for."""

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy import stats

import restitution as rs
from restitution.drop.toml import read, tables_of

BALL = rs.Dumbbell(radius=3e-3, separation=0.0)
"""Of a sphere under a frictionless law ε is ε_n itself."""
YIELDING = rs.Plastic(yield_speed=0.02)
DUSTY = rs.Scattered(normal=0.9, deviation=0.1)


def drawn(normal: Any, deviation: float, seed: int, particles: int = 3000, impacts: int = 20) -> Any:
    law = rs.Frictionless(normal=rs.Scattered(normal=normal, deviation=deviation))
    return rs.simulate(BALL, law, particles=particles, impacts=impacts, release_height=0.5, seed=seed)


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize(
    ("normal", "deviation"),
    [(0.93, 0.01), (0.98, 0.03), (1.0, 0.1), (0.5, 0.4), (0.9, 1.0), (YIELDING, 0.02)],
)
def test_the_numbers_are_those_of_the_truncated_normal(normal: Any, deviation: float, seed: int) -> None:
    """By their distribution function, about ε_n at each speed; moments within 4.5 standard errors."""
    run = drawn(normal, deviation, seed)
    found, speed = run.restitution.values.ravel(), run.impact_velocity.values.ravel()
    known = np.isfinite(found)
    middle = normal(speed[known]) if isinstance(normal, rs.Plastic) else np.full(known.sum(), normal)
    below, above = -middle / deviation, (1.0 - middle) / deviation
    inside = stats.norm.cdf(above) - stats.norm.cdf(below)
    share = (stats.norm.cdf((found[known] - middle) / deviation) - stats.norm.cdf(below)) / inside
    assert stats.kstest(share, "uniform").pvalue > 1e-4
    # Mean and variance of what is left of the normal distribution, in units of its deviation.
    at_ends = stats.norm.pdf(below), stats.norm.pdf(above)
    mean = (at_ends[0] - at_ends[1]) / inside
    variance = 1.0 + (below * at_ends[0] - above * at_ends[1]) / inside - mean**2
    off = ((found[known] - middle) / deviation - mean) / np.sqrt(variance)
    n = off.size
    assert abs(off.mean()) < 4.5 / np.sqrt(n)
    fourth = np.mean(off**4)
    assert abs(np.mean(off**2) - 1.0) < 4.5 * np.sqrt((fourth - 1.0) / n)
    assert np.all((found[known] >= 0.0) & (found[known] <= 1.0))


@pytest.mark.parametrize("seed", [4, 5])
def test_impacts_and_particles_are_independent(seed: int) -> None:
    """Successive impacts, the same impact of successive particles and seeds: no correlation."""
    one, other = (stats.zscore(drawn(0.9, 0.01, s).restitution.values, axis=None) for s in (seed, seed + 1))
    pairs = ((one[:, :-1], one[:, 1:]), (one[:-1], one[1:]), (one, other), (one[:, :-2], one[:, 2:]))
    for a, b in pairs:
        for power in (1, 2):
            rho = stats.pearsonr(a.ravel() ** power, b.ravel() ** power).statistic
            assert abs(rho) < 4.5 / np.sqrt(a.size)


def test_a_particle_is_the_same_in_every_run() -> None:
    """However many there are, on any number of threads, with any other release, and up to any impact."""
    few = drawn(0.93, 0.02, 7, particles=10, impacts=5).restitution.values
    np.testing.assert_allclose(drawn(0.93, 0.02, 7).restitution.values[:10, :5], few, rtol=1e-12)
    law = rs.Coulomb(normal=rs.Scattered(normal=YIELDING, deviation=0.02), friction=0.3)
    body = rs.Dumbbell(radius=3e-3, separation=1e-3)
    runs = [
        rs.simulate(body, law, particles=500, impacts=30, spin=(0.0, 9.0, 50.0), seed=3, threads=threads)
        for threads in (1, 2, 3)
    ]
    for run in runs[1:]:
        assert run.identical(runs[0])


def test_the_mean_scatter_of_counts_is_that_of_records() -> None:
    law = rs.Frictionless(normal=rs.Scattered(normal=0.93, deviation=0.01))
    counted = rs.statistics(
        BALL,
        law,
        particles=2000,
        impacts=20,
        release_height=0.5,
        seed=7,
        velocity_bins=np.linspace(0.0, 4.0, 5),
        restitution_bins=np.linspace(0.8, 1.0, 11),
    )
    run = drawn(0.93, 0.01, 7, particles=2000)
    found = np.histogram(run.restitution.values, np.linspace(0.8, 1.0, 11))[0]
    np.testing.assert_array_equal(counted["restitution_count"].sum("velocity").values, found)


def test_a_law_that_scatters_is_written_and_read(tmp_path: Path) -> None:
    law = rs.Coulomb(normal=rs.Scattered(normal=YIELDING, deviation=0.02), friction=0.3)
    assert law.attributes() == {
        "normal": "Scattered",
        "normal_normal": "Plastic",
        "normal_normal_yield_speed": 0.02,
        "normal_deviation": 0.02,
        "friction": 0.3,
        "hypothesis": "stronge",
    }
    run = rs.simulate(BALL, law, particles=2, impacts=3)
    run.to_netcdf(tmp_path / "run.nc")
    text = (
        '[body]\nshape = "dumbbell"\nradius = 3e-3\nseparation = 0.0\n'
        '[law]\ntype = "coulomb"\nfriction = 0.3\n'
        '[law.normal]\ntype = "scattered"\ndeviation = 0.02\n'
        '[law.normal.normal]\ntype = "plastic"\nyield_speed = 0.02\n'
    )
    (tmp_path / "run.toml").write_text(text)
    again = read(tmp_path / "run.toml")
    assert again.law == law == pickle.loads(pickle.dumps(law))
    table = tables_of(again)["law"]["normal"]
    assert table["normal"] == {"type": "plastic", "yield_speed": 0.02}
    scattered: Any = rs.Scattered  # by place, too
    np.testing.assert_array_equal(scattered(YIELDING, 0.02)([0.01, 0.5]), YIELDING([0.01, 0.5]))
    assert float(scattered(0.9, 0.1)(np.inf)) == 0.9


def test_a_law_that_scatters_is_compared_swept_and_learned(tmp_path: Path) -> None:
    body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    laws = [rs.Frictionless(normal=normal) for normal in (0.95, rs.Scattered(normal=0.95, deviation=0.05))]
    window = {"velocity": np.linspace(0.2, 1.0, 3), "restitution": np.linspace(0.5, 1.2, 71)}
    table = rs.compare(
        {"round": body},
        dict(zip(["still", "dusty"], laws, strict=True)),
        particles=1000,
        impacts=30,
        velocity_bins=window["velocity"],
        restitution_bins=window["restitution"],
    )
    assert table is not None
    body = rs.Dumbbell(radius=3e-3, separation=3e-6)  # so round that the material scatters more
    learned = [rs.FluctuatingRestitution.learn(body, law, particles=20_000, impacts=60) for law in laws]
    still, dusty = (float(one.std(0.3)) for one in learned)
    assert still < 0.005
    assert dusty == pytest.approx(
        float(rs.simulate(BALL, laws[1], particles=2000).restitution.std()), rel=0.05
    )


@pytest.mark.parametrize(
    ("values", "expected"),
    [
        ((0.9, -0.1), "deviation = -0.1: must be a real number in [0, 1]"),
        ((0.9, 1.1), "deviation = 1.1: must be a real number in [0, 1]"),
        (
            (1.5, 0.1),
            "normal = 1.5: must be a real number in [0, 1], a Viscoelastic, Plastic",
        ),
        (
            (DUSTY, 0.1),
            "normal = Scattered(normal=0.9, deviation=0.1): must be a real number",
        ),
    ],
)
def test_bad_scatter_is_named(values: tuple[Any, float], expected: str) -> None:
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - looked at below
        rs.Scattered(normal=values[0], deviation=values[1])
    assert str(caught.value).startswith(expected)


def test_what_has_no_meaning_for_it_refuses_it() -> None:
    body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    law = rs.Frictionless(normal=DUSTY)
    refused = r"^law\.normal = Scattered\(normal=0\.9, deviation=0\.1\): must be a coefficient that does not"
    with pytest.raises(ValueError, match=refused):
        rs.analytic.first_impact(body, law)
    with pytest.raises(ValueError, match=refused):
        rs.error_budget(body, law, drop=0.1)
    data = rs.flight.restitution(np.cumsum(0.9 ** np.arange(12)), 1e-5)
    with pytest.raises(ValueError, match=refused):
        rs.posterior(data, law, diameter=6e-3)
    with pytest.raises(ValueError, match=r"^data\.normal = 'Scattered': must be a real number"):
        rs.explore(rs.simulate(body, law, particles=2, impacts=2))
