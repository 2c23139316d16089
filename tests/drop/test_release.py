"""Particles let go with spin and velocity, over an inclined plane: drawn, given, refused, kept in files."""

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.stats
import xarray as xr
from numpy.typing import NDArray

import restitution as rs
from restitution.drop.run import Run
from restitution.drop.toml import read

Array = NDArray[np.float64]

BODY = rs.Dumbbell(radius=3e-3, separation=4e-3)


def drawn(axis: str, rate: float | tuple[float, float], particles: int = 20_000) -> tuple[Array, Array]:
    """Spins and axes at release."""
    spin = rs.RandomSpin(rate=rate, axis=axis)
    data = rs.simulate(BODY, rs.Frictionless(normal=0.9), particles=particles, impacts=1, spin=spin)
    theta, phi = data.release_angle.values, data.release_azimuth.values
    axes = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
    return data.release_spin.values, axes


def uniform(x: Array, low: float, high: float) -> None:
    """Six moments e^(2πik(x - low)/(high - low)) within five standard errors of 0: 4e-6 of false alarm."""
    phase = 2.0 * np.pi * (x - low) / (high - low)
    for k in (1, 2, 3):
        mean = np.mean([np.cos(k * phase), np.sin(k * phase)], axis=1)
        assert np.abs(mean).max() < 5.0 / np.sqrt(2.0 * x.size)


def uncorrelated(*columns: Array) -> None:
    """Every correlation within five standard errors of 0: 6e-7 of false alarm each."""
    correlation: Array = np.asarray(np.corrcoef(np.stack(columns)))
    off = correlation[~np.eye(len(columns), dtype=bool)]
    assert (np.abs(off) < 5.0 / np.sqrt(columns[0].size)).all()


def test_isotropic_spins() -> None:
    """cos of the polar angle, azimuth and rate are uniform, and independent of each other and of the axis."""
    spins, axes = drawn("isotropic", (20.0, 80.0))
    rate = np.linalg.norm(spins, axis=1)
    up, around = spins[:, 2] / rate, np.arctan2(spins[:, 1], spins[:, 0])
    uniform(rate, 20.0, 80.0)
    uniform(up, -1.0, 1.0)
    uniform(around, -np.pi, np.pi)
    uniform(np.arctan2(axes[:, 1], axes[:, 0]), -np.pi, np.pi)
    uncorrelated(rate, up, around, *axes.T)


def test_horizontal_spins() -> None:
    """They have no component along the normal, and any direction along the plane."""
    spins, axes = drawn("horizontal", 50.0)
    np.testing.assert_allclose(np.linalg.norm(spins, axis=1), 50.0, rtol=1e-15)
    assert (spins[:, 2] == 0.0).all()
    around = np.arctan2(spins[:, 1], spins[:, 0])
    uniform(around, -np.pi, np.pi)
    uncorrelated(np.cos(around), np.sin(around), *axes.T)


def test_spins_across_the_axis() -> None:
    """Perpendicular to the axis, and around it uniformly, counted from the vertical plane.

    The axis is made of two recorded angles, rounded by up to 2.2e-16 and 4.4e-16, and rounds itself.
    """
    spins, axes = drawn("across", 50.0)
    assert np.abs(np.sum(spins * axes, axis=1)).max() < 50.0 * 1.5e-15
    np.testing.assert_allclose(np.linalg.norm(spins, axis=1), 50.0, rtol=1e-15)
    level = np.cross([0.0, 0.0, 1.0], axes)
    level /= np.linalg.norm(level, axis=1, keepdims=True)
    tilted = np.cross(level, axes)
    around = np.arctan2(np.sum(spins * level, axis=1), np.sum(spins * tilted, axis=1))
    uniform(around, -np.pi, np.pi)
    uncorrelated(np.cos(around), np.sin(around), *axes.T)


def test_the_azimuth_is_drawn_unless_it_is_given() -> None:
    """θ is that of a run from rest with the same seed; φ, uniform, is independent of it."""
    law = rs.Frictionless(normal=0.9)
    moving = rs.simulate(BODY, law, particles=5000, impacts=1, release_velocity=(0.1, 0.0, 0.0))
    rest = rs.simulate(BODY, law, particles=5000, impacts=1)
    assert (moving.release_angle == rest.release_angle).all()
    assert "release_azimuth" not in rest
    phi = moving.release_azimuth.values
    assert ((phi >= 0.0) & (phi < 2.0 * np.pi)).all()
    uniform(phi, 0.0, 2.0 * np.pi)
    uncorrelated(np.cos(phi), np.sin(phi), moving.release_angle.values)
    rows = np.array([[0.3, 5.0], [1.0, -2.0], [2.0, 0.5]])
    given = rs.simulate(BODY, law, particles=3, impacts=1, orientation=rows, incline=0.1)
    np.testing.assert_array_equal(given.release_azimuth, rows[:, 1])
    np.testing.assert_allclose(given.release_angle, rows[:, 0], rtol=1e-15)


def test_the_same_bits_from_one_and_two_threads() -> None:
    run: dict[str, Any] = {
        "particles": 300,
        "impacts": 20,
        "spin": rs.RandomSpin(rate=(0, 200)),
        "incline": 0.2,
    }
    law = rs.Coulomb(normal=0.8, friction=0.2)
    one, two = (rs.simulate(BODY, law, threads=threads, **run) for threads in (1, 2))
    xr.testing.assert_identical(one, two)


def test_zeros_are_what_is_not_given() -> None:
    """No spin, no velocity, no incline: the bits of a run from rest, and nothing more in the Dataset."""
    law = rs.TangentialRestitution(normal=0.9)
    rest = rs.simulate(BODY, law, particles=50, impacts=20)
    zeros = rs.simulate(
        BODY, law, particles=50, impacts=20, spin=[0, 0, 0], release_velocity=(0, 0, 0), incline=0
    )
    xr.testing.assert_identical(rest, zeros)
    still = rs.simulate(BODY, law, particles=50, impacts=20, spin=np.zeros((50, 3)))
    xr.testing.assert_equal(rest, still)


def test_statistics_count_the_impacts_of_simulate() -> None:
    run: dict[str, Any] = {
        "particles": 100,
        "impacts": 20,
        "spin": rs.RandomSpin(rate=(0, 200)),
        "release_velocity": (0.1, 0, -0.3),
    }
    law = rs.Coulomb(normal=0.8, friction=0.2)
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(-1.0, 2.0, 31),
        "restitution_bins": np.linspace(-4.0, 4.0, 81),
    }
    counted = rs.statistics(BODY, law, **run, **bins)
    reduced = rs.reduce(rs.simulate(BODY, law, **run), **bins)
    np.testing.assert_array_equal(counted["restitution_count"], reduced["restitution_count"])
    np.testing.assert_allclose(counted["mean_restitution"], reduced["mean_restitution"], rtol=1e-6)
    both = rs.compare([BODY], [law, rs.Frictionless(normal=0.8)], **run, **bins)
    np.testing.assert_array_equal(both["restitution_count"][0, 0], counted["restitution_count"])
    np.testing.assert_array_equal(both.attrs["release_velocity"], [0.1, 0.0, -0.3])
    assert both.attrs["spin_axis"] == "isotropic"


# 400 particles from one height lie on few lines, of which the distance warns; what is tested is the release.
@pytest.mark.filterwarnings("ignore::restitution.DistanceWarning")
def test_a_distribution_is_learned_from_spinning_particles() -> None:
    """Drawn spins pass through, and one for each particle; where all is given nothing is fresh."""
    law = rs.TangentialRestitution(normal=0.9)
    run: dict[str, Any] = {"particles": 400, "impacts": 300, "heights_about": 0.03}
    spin = rs.RandomSpin(rate=(0.0, 100.0), axis="across")
    dist = rs.FluctuatingRestitution.learn(BODY, law, spin=spin, **run)
    assert dist.data.attrs["spin"] == "random"
    spins = np.random.default_rng(3).normal(0.0, 60.0, (400, 3))
    dist = rs.FluctuatingRestitution.learn(BODY, law, spin=spins, **run)
    assert dist.data.attrs["spin"] == "given"
    angles = np.linspace(0.0, 3.0, 400)
    dist = rs.FluctuatingRestitution.learn(BODY, law, spin=spins, orientation=angles, **run)
    assert dist.data.attrs["orientation"] == "given"
    run = {"particles": 400, "impacts": 300, "release_height": 0.03}
    with pytest.raises(ValueError, match=r"^orientation, spin, release_height: .*are all given"):
        rs.FluctuatingRestitution.learn(BODY, law, spin=spins, orientation=angles, **run)


def test_given_spins_make_the_distribution_of_drawn_ones() -> None:
    """20 000 spins written down beside as many that are drawn by the same law: one distribution.

    Kolmogorov-Smirnov distances between the two within 0.04 everywhere, three times what the scatter is.
    """
    law = rs.TangentialRestitution(normal=0.9)
    run: dict[str, Any] = {"particles": 4000, "impacts": 60, "velocities": (0.3, 0.7)}
    drawn_spins = rs.RandomSpin(rate=(0.0, 100.0))
    written = rs.simulate(BODY, law, particles=4000, impacts=1, spin=drawn_spins, seed=77).release_spin
    one = rs.FluctuatingRestitution.learn(BODY, law, spin=drawn_spins, **run)
    two = rs.FluctuatingRestitution.learn(BODY, law, spin=written, **run)
    levels = np.linspace(0.02, 0.98, 49)
    for v in (0.35, 0.5, 0.65):
        assert np.abs(two.cdf(one.ppf(levels, v), v) - levels).max() < 0.04


def test_thermal_spins() -> None:
    """Maxwell's distribution: Gaussian components in the body's frame, with the same mean energy in each.

    Kolmogorov-Smirnov with a false alarm of 1e-4 in each, for two bodies; <ω²> within five standard errors.
    """
    for body in (BODY, rs.Spheroid(equatorial=3e-3, polar=1e-3)):
        run = rs.simulate(
            body,
            rs.Frictionless(normal=0.9),
            particles=20_000,
            impacts=1,
            orientation="isotropic",
            spin=rs.RandomSpin(rate=50.0, axis="thermal"),
        )
        theta, phi = run.release_angle.values, run.release_azimuth.values
        axis = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1)
        tilted = np.stack([np.cos(theta) * np.cos(phi), np.cos(theta) * np.sin(phi), -np.sin(theta)], axis=1)
        level = np.cross(axis, tilted)
        spins = run.release_spin.values
        parts = [np.sum(spins * along, axis=1) for along in (axis, tilted, level)]
        inertia = np.array([body.axial_inertia, body.transverse_inertia, body.transverse_inertia])
        temperature = 50.0**2 / np.sum(1.0 / inertia)
        for part, own in zip(parts, inertia, strict=True):
            assert scipy.stats.kstest(part / np.sqrt(temperature / own), scipy.stats.norm.cdf).pvalue > 1e-4
        uncorrelated(*parts)
        square = np.sum(spins**2, axis=1)
        assert abs(square.mean() - 2500.0) < 5.0 * square.std() / np.sqrt(square.size)


RUN_FILE = """
[body]
shape = "dumbbell"
radius = 3e-3
separation = 4e-3

[law]
type = "frictionless"
normal = 0.9

[run]
particles = 3
impacts = 2
release_velocity = [0.1, 0, -0.2]
incline = 0.25
"""


@pytest.mark.parametrize(
    ("text", "spin"),
    [
        ("spin = [1, 2.5, 0]", (1.0, 2.5, 0.0)),
        ('spin = {rate = [0, 50], axis = "across"}', rs.RandomSpin(rate=(0, 50), axis="across")),
        ("[run.spin]\nrate = 7", rs.RandomSpin(rate=7)),
        ('[run.spin]\nrate = 7\naxis = "thermal"', rs.RandomSpin(rate=7, axis="thermal")),
    ],
)
def test_files(text: str, spin: Any, tmp_path: Path) -> None:
    """A TOML file and the call are the same run; a netCDF file gives everything back."""
    path = tmp_path / "run.toml"
    path.write_text(RUN_FILE + text, encoding="utf-8")
    run = read(path)
    law = rs.Frictionless(normal=0.9)
    assert run == Run(
        body=BODY, law=law, particles=3, impacts=2, release_velocity=(0.1, 0.0, -0.2), incline=0.25, spin=spin
    )
    data = rs.simulate(
        BODY,
        law,
        particles=3,
        impacts=2,
        release_velocity=run.release_velocity,
        incline=run.incline,
        spin=spin,
    )
    data.to_netcdf(tmp_path / "run.nc")
    again = xr.load_dataset(tmp_path / "run.nc")
    assert again.identical(data)
    assert again.attrs["incline"] == 0.25
    np.testing.assert_array_equal(again.attrs["release_velocity"], [0.1, 0.0, -0.2])
    assert again.release_spin.dims == ("particle", "component")
    assert list(again.component.values) == ["x", "y", "z"]


@pytest.mark.parametrize(
    "rate",
    [-1, np.nan, np.inf, "fast", None, True, (1, 2, 3), (2, 1), (True, 2), (0, np.inf), (-1, 1), 10**400],
    ids=lambda rate: str(rate)[:12],
)
def test_a_rate_is_a_number_or_an_interval(rate: Any) -> None:
    with pytest.raises(
        ValueError, match=r"^rate = .*: must be a finite number >= 0, or a pair \(low, high\)"
    ):
        rs.RandomSpin(rate=rate)


@pytest.mark.parametrize("axis", ["vertical", 3, None])
def test_a_direction_is_one_of_four(axis: Any) -> None:
    with pytest.raises(
        ValueError, match=r"^axis = .*: must be 'isotropic' or 'horizontal' or 'across' or 'thermal'$"
    ):
        rs.RandomSpin(rate=1.0, axis=axis)


@pytest.mark.parametrize(
    ("argument", "said"),
    [
        ({"spin": [[1, 2, 3], [4, np.nan, 6]]}, "spin[1, 1] = nan: must be finite (rad/s)"),
        ({"spin": [0, 0, -np.inf]}, "spin[2] = -inf: must be finite (rad/s)"),
        (
            {"orientation": [[0.1, 0.2], [0.3, np.inf]]},
            "orientation[1, 1] = inf: must be a finite angle in rad",
        ),
    ],
)
def test_the_first_bad_number_is_named(argument: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=f"^{re.escape(said)}"):
        rs.simulate(BODY, rs.Frictionless(normal=0.9), particles=2, **argument)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"orientation": [0.1, 45.0]}, r"^orientation, up to 45, is taken in radians: is that meant\?$"),
        ({"release_height": 60.0}, r"^release_height = 60 is taken in metres"),
        (
            {"body": rs.Dumbbell(radius=3.0, separation=0.3), "release_height": 9.0},
            r"^radius = 3.0 is taken in metres",
        ),
    ],
)
def test_numbers_that_look_like_degrees_or_millimetres_are_named(changed: dict[str, Any], told: str) -> None:
    given: dict[str, Any] = {"body": BODY, "law": rs.Frictionless(normal=0.9), "particles": 2, "impacts": 2}
    with pytest.warns(UserWarning, match=told):
        rs.simulate(**(given | changed))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rs.simulate(**given, orientation=[0.1, 6.28])
        rs.simulate(**given, release_height=2.5)
