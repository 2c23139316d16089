"""Particles let go with spin and velocity, over an inclined plane: what is drawn, and spheres on paper."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray

import restitution as rs
from restitution._run import Run
from restitution._toml import read
from restitution.laws import Law

Array = NDArray[np.float64]

BODY = rs.Dumbbell(radius=3e-3, separation=4e-3)
SPHERE = rs.Dumbbell(radius=0.02, separation=0.0)
GRAVITY = 9.81


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
    moving = rs.simulate(BODY, law, particles=5000, impacts=1, velocity=(0.1, 0.0, 0.0))
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


def impulse(law: Law, slip: Array, fall: float) -> Array:
    """Tangential impulse per mass on a sphere, K = 7/2: sticks, or slips throughout (Walton; Brach)."""
    speed = float(np.linalg.norm(slip))
    if isinstance(law, rs.TangentialRestitution):
        size = (1.0 - law.tangential) * 2.0 / 7.0 * speed
    elif isinstance(law, rs.Coulomb):
        size = min(law.friction * (1.0 + law.constant) * fall, 2.0 / 7.0 * speed)
    elif isinstance(law, rs.ChatterjeeRuina):
        size = min(law.friction * (1.0 + law.constant) * fall, (1.0 + law.tangential) * 2.0 / 7.0 * speed)
    else:
        size = 0.0
    along: Array = -size / speed * slip
    return along


@pytest.mark.parametrize("friction", [0.05, 0.3, 10.0])
@pytest.mark.parametrize("kind", ["tangential", "frictionless", "stronge", "poisson", "newton", "chatterjee"])
def test_oblique_impact_of_a_sphere(kind: str, friction: float) -> None:
    """A spinning sphere that comes in at a slant: the textbook's rebound, spin and loss of energy.

    The contact search is good to some roundings of the height over the radius; 1e-12 is a hundred times that.
    """
    law: Law = {
        "tangential": rs.TangentialRestitution(normal=0.8, tangential=0.4),
        "frictionless": rs.Frictionless(normal=0.8),
        "stronge": rs.Coulomb(normal=0.8, friction=friction),
        "poisson": rs.Coulomb(normal=0.8, friction=friction, hypothesis="poisson"),
        "newton": rs.Coulomb(normal=0.8, friction=friction, hypothesis="newton"),
        "chatterjee": rs.ChatterjeeRuina(normal=0.8, tangential=0.5, friction=friction),
    }[kind]
    radius, height = SPHERE.radii[0], 0.1
    random = np.random.default_rng(5)
    for _ in range(20):
        velocity = random.normal(size=3)
        spin = random.normal(scale=60.0, size=3)
        data = rs.simulate(
            SPHERE,
            law,
            particles=1,
            impacts=2,
            release_height=height,
            velocity=velocity,
            spin=spin,
        ).isel(particle=0)
        fall = np.sqrt(velocity[2] ** 2 + 2.0 * GRAVITY * (height - radius))
        arm = np.array([0.0, 0.0, -radius])
        slip = (velocity + np.cross(spin, arm)) * [1.0, 1.0, 0.0]
        kick = impulse(law, slip, float(fall))
        after = velocity * [1.0, 1.0, 0.0] + kick
        turning = spin + np.cross(arm, kick) / (0.4 * radius**2)

        def energies(flat: Array, omega: Array, normal: float) -> Array:
            return 0.5 * np.array([flat @ flat + normal**2, 0.4 * radius**2 * (omega @ omega)])

        before, left = energies(velocity[:2], spin, fall), energies(after, turning, 0.8 * fall)
        np.testing.assert_allclose(data.impact_velocity, [fall, 0.8 * fall], rtol=1e-12)
        np.testing.assert_allclose(data.restitution, 0.8, rtol=1e-12)
        times = [(velocity[2] + fall) / GRAVITY, (velocity[2] + fall + 1.6 * fall) / GRAVITY]
        np.testing.assert_allclose(data.time, times, rtol=1e-12)
        shares = [before[1] / before.sum(), left[1] / left.sum()]
        np.testing.assert_allclose(data.rotational_fraction, shares, rtol=1e-12)
        np.testing.assert_allclose(data.energy_ratio[0], left.sum() / before.sum(), rtol=1e-12)


def test_a_sphere_down_an_incline() -> None:
    """Without friction it slides: geometric flights under g cos α, and g sin α × time along the plane.

    With friction too weak to stop the slip the velocity along the plane grows by 2v(tan α - μ) from impact to
    impact, v being the normal velocity, and the spin by 5μv/R: the slip only ever grows if tan α > 7μ/2.
    """
    incline, friction, height = 0.5, 0.07, 0.2
    radius = SPHERE.radii[0]
    run: dict[str, Any] = {"particles": 1, "impacts": 30, "release_height": height, "incline": incline}
    steep, number = np.tan(incline), np.arange(30)
    weight = GRAVITY * np.cos(incline)
    fall = np.sqrt(2.0 * weight * (height - radius))

    found = rs.simulate(SPHERE, rs.Frictionless(normal=0.8), **run).isel(particle=0)
    fallen = fall * 0.8**number
    times = (fall + np.concatenate([[0.0], np.cumsum(2.0 * fallen[1:])])) / weight
    along = GRAVITY * np.sin(incline) * times
    np.testing.assert_allclose(found.impact_velocity, fallen, rtol=1e-11)
    np.testing.assert_allclose(found.time, times, rtol=1e-11)
    ratio = (along**2 + 0.64 * fallen**2) / (along**2 + fallen**2)
    np.testing.assert_allclose(found.energy_ratio, ratio, rtol=1e-11)

    found = rs.simulate(SPHERE, rs.Coulomb(normal=1.0, friction=friction), **run).isel(particle=0)
    assert steep > 7.0 * friction  # it slips at the first impact already
    along = fall * (steep + 2.0 * number * (steep - friction))
    rotation = 0.4 * (5.0 * friction * fall * number) ** 2
    share = rotation / (rotation + along**2 + fall**2)
    np.testing.assert_allclose(found.impact_velocity, fall, rtol=1e-11)
    np.testing.assert_allclose(found.rotational_fraction, share, rtol=1e-10, atol=1e-15)
    # Far down, energy per impact grows as the square of the number of impacts, whatever the first one was.
    energy = 0.5 * (rotation + along**2 + fall**2)
    after = np.roll(rotation, -1) + (along - 2.0 * friction * fall) ** 2 + fall**2
    np.testing.assert_allclose(found.energy_ratio[:-1], (0.5 * after / energy)[:-1], rtol=1e-10)


def test_energy_over_a_frictionless_elastic_plane() -> None:
    """With spin and velocity E_rot + v²/2 + gz never changes, nor does the velocity along the plane."""
    velocity = np.array([0.4, -0.3, 0.2])
    data = rs.simulate(
        BODY,
        rs.Frictionless(normal=1.0),
        particles=300,
        impacts=40,
        velocity=velocity,
        spin=rs.RandomSpin(rate=(0.0, 400.0)),
    )
    height = 3e-3 + 2e-3 * np.abs(np.cos(data.angle))
    translation = 0.5 * (data.impact_velocity**2 + velocity[0] ** 2 + velocity[1] ** 2)
    share = data.rotational_fraction
    energy = translation / (1.0 - share) + GRAVITY * height
    axes = np.stack([np.sin(data.release_angle), 0 * data.release_angle, np.cos(data.release_angle)])
    axes[0], axes[1] = axes[0] * np.cos(data.release_azimuth), axes[0] * np.sin(data.release_azimuth)
    spin = data.release_spin.values.T
    along = np.sum(spin * axes, axis=0)
    mass, across, axial = BODY.mass, BODY.transverse_inertia, BODY.axial_inertia
    rotation = 0.5 * (across * (np.sum(spin**2, axis=0) - along**2) + axial * along**2) / mass
    start = rotation + 0.5 * velocity @ velocity + GRAVITY * 0.06
    # 40 impacts of a dozen roundings each, magnified by 1/(1 - share) < 30.
    np.testing.assert_allclose(energy, np.broadcast_to(start[:, None], energy.shape), rtol=2e-12)
    np.testing.assert_allclose(data.energy_ratio, 1.0, rtol=1e-12)


def test_every_azimuth_is_alike() -> None:
    """Axis, spin and velocity turned together about the normal: the same impacts, to rounding.

    Rounding grows from impact to impact, by up to a digit; and it is seen in E_rot/E_tot times 10.
    """
    random = np.random.default_rng(3)
    particles, turn = 40, 1.234
    rows = np.stack([random.uniform(0.0, np.pi, particles), random.uniform(0, 2 * np.pi, particles)], axis=1)
    spins = random.normal(scale=100.0, size=(particles, 3))
    velocity = np.array([0.3, 0.1, -0.2])
    c, s = np.cos(turn), np.sin(turn)
    about = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    for law in (rs.Coulomb(normal=0.8, friction=0.2), rs.TangentialRestitution(normal=0.8, tangential=0.3)):
        one, other = (
            rs.simulate(BODY, law, particles=particles, impacts=4, orientation=o, spin=w, velocity=v)
            for o, w, v in (
                (rows, spins, velocity),
                (rows + np.array([0.0, turn]), spins @ about.T, about @ velocity),
            )
        )
        for number in range(4):
            for name in ("time", "impact_velocity", "rotational_fraction", "energy_ratio", "angle"):
                a, b = (run[name].isel(impact=number).values for run in (one, other))
                np.testing.assert_allclose(a, b, rtol=1e-12 * 10.0**number, atol=1e-13 * 10.0**number)


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
    zeros = rs.simulate(BODY, law, particles=50, impacts=20, spin=[0, 0, 0], velocity=(0, 0, 0), incline=0)
    xr.testing.assert_identical(rest, zeros)
    still = rs.simulate(BODY, law, particles=50, impacts=20, spin=np.zeros((50, 3)))
    xr.testing.assert_equal(rest, still)


def test_statistics_count_the_impacts_of_simulate() -> None:
    run: dict[str, Any] = {
        "particles": 100,
        "impacts": 20,
        "spin": rs.RandomSpin(rate=(0, 200)),
        "velocity": (0.1, 0, -0.3),
    }
    law = rs.Coulomb(normal=0.8, friction=0.2)
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(-1.0, 2.0, 31),
        "restitution_bins": np.linspace(-4.0, 4.0, 81),
    }
    counted = rs.statistics(BODY, law, **run, **bins)
    reduced = rs.reduce(rs.simulate(BODY, law, **run), **bins)
    np.testing.assert_array_equal(counted["count"], reduced["count"])
    np.testing.assert_allclose(counted["mean"], reduced["mean"], rtol=1e-6)
    both = rs.compare([BODY], [law, rs.Frictionless(normal=0.8)], **run, **bins)
    np.testing.assert_array_equal(both["count"][0, 0], counted["count"])
    np.testing.assert_array_equal(both.attrs["velocity"], [0.1, 0.0, -0.3])
    assert both.attrs["spin_axis"] == "isotropic"


def test_a_distribution_is_learned_from_spinning_particles() -> None:
    """Drawn spins pass through; one for each particle is refused, for blocks draw anew."""
    law = rs.TangentialRestitution(normal=0.9)
    run: dict[str, Any] = {"particles": 400, "impacts": 300, "release_height": 0.03}
    spin = rs.RandomSpin(rate=(0.0, 100.0), axis="across")
    dist = rs.FluctuatingRestitution.learn(BODY, law, spin=spin, **run)
    assert dist.data.attrs["spin"] == "random"
    with pytest.raises(ValueError, match=r"^spin = an array of shape \(400, 3\): must be None"):
        rs.FluctuatingRestitution.learn(BODY, law, spin=np.ones((400, 3)), **run)


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
velocity = [0.1, 0, -0.2]
incline = 0.25
"""


@pytest.mark.parametrize(
    ("text", "spin"),
    [
        ("spin = [1, 2.5, 0]", (1.0, 2.5, 0.0)),
        ('spin = {rate = [0, 50], axis = "across"}', rs.RandomSpin(rate=(0, 50), axis="across")),
        ("[run.spin]\nrate = 7", rs.RandomSpin(rate=7)),
    ],
)
def test_files(text: str, spin: Any, tmp_path: Path) -> None:
    """A TOML file and the call are the same run; a netCDF file gives everything back."""
    path = tmp_path / "run.toml"
    path.write_text(RUN_FILE + text, encoding="utf-8")
    run = read(path)
    law = rs.Frictionless(normal=0.9)
    assert run == Run(
        body=BODY, law=law, particles=3, impacts=2, velocity=(0.1, 0.0, -0.2), incline=0.25, spin=spin
    )
    data = rs.simulate(
        BODY,
        law,
        particles=3,
        impacts=2,
        velocity=run.velocity,
        incline=run.incline,
        spin=spin,
    )
    data.to_netcdf(tmp_path / "run.nc")
    again = xr.load_dataset(tmp_path / "run.nc")
    assert again.identical(data)
    assert again.attrs["incline"] == 0.25
    np.testing.assert_array_equal(again.attrs["velocity"], [0.1, 0.0, -0.2])
    assert again.release_spin.dims == ("particle", "component")
    assert list(again.component.values) == ["x", "y", "z"]
