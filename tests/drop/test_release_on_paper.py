"""Spinning, moving and sliding bodies with a solution on paper, and what symmetry and energy demand."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import restitution as rs
from restitution.laws import Law

Array = NDArray[np.float64]

BODY = rs.Dumbbell(radius=3e-3, separation=4e-3)
SPHERE = rs.Dumbbell(radius=0.02, separation=0.0)
GRAVITY = 9.81


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
            release_velocity=velocity,
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
        release_velocity=velocity,
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
            rs.simulate(BODY, law, particles=particles, impacts=4, orientation=o, spin=w, release_velocity=v)
            for o, w, v in (
                (rows, spins, velocity),
                (rows + np.array([0.0, turn]), spins @ about.T, about @ velocity),
            )
        )
        for number in range(4):
            for name in ("time", "impact_velocity", "rotational_fraction", "energy_ratio", "angle"):
                a, b = (run[name].isel(impact=number).values for run in (one, other))
                np.testing.assert_allclose(a, b, rtol=1e-12 * 10.0**number, atol=1e-13 * 10.0**number)
