"""Whole runs of bodies of any shape, impact by impact, beside a general integrator.

`reference.rigid_motion` has its own inertia, geometry, events and impulses. Rounding, and the integrator's
errors, grow from impact to impact; how much is measured with a second solution, which is off by `OFF` at
the release and after every impact. A run must stay within `ACCURACY` times that growth, relative to the
largest value of each quantity; measured: at most a tenth of it.
"""

from collections.abc import Sequence
from itertools import islice
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import restitution as rs
from reference import rigid_motion, solids
from reference.rigid_motion import ATTITUDE, SPIN, VELOCITY, Bounce, Problem, frame
from restitution.bodies import RigidBody
from restitution.laws import Law

Array = NDArray[np.float64]

R, HEIGHT, IMPACTS = 0.01, 0.08, 4
OFF, ACCURACY = 1e-9, 2e-13
TURNED = Rotation.from_rotvec([0.4, -0.9, 1.3]).as_matrix()
BALLS = R * np.array([(0.5, 0.1, -0.2, 1.0), (-0.8, 0.3, 0.1, 0.8), (0.2, -1.1, 0.6, 0.6)])
EDGES = R * np.array([1.0, 2.0, 3.0])
PLATE = R * np.array([2.0, 1.5, 0.1])
POINTS = R * np.array([(0, 0, 0), (2, 0, 0), (0, 1.5, 0), (0.3, 0.2, 1.2), (1, 1, 0.8)])
AXES = R * np.array([2.0, 1.4, 1.0])
ROUNDED = (3.0, 4.0)
TENSOR = 3e-6 * np.array([(1.0, 0.2, -0.1), (0.2, 1.4, 0.15), (-0.1, 0.15, 0.9)])  # kg m²
EQUAL = 1e-6 * TURNED @ np.diag([2.0, 2.0, 1.1]) @ TURNED.T
CENTRE = R * np.array([0.1, -0.15, 0.2])

BODIES: dict[str, tuple[RigidBody, solids.Solid]] = {
    "clump": (rs.Clump(spheres=BALLS), solids.Balls(BALLS)),
    "loaded clump": (
        rs.Clump(spheres=BALLS, inertia=TENSOR, centre=CENTRE),
        solids.Balls(BALLS, inertia=TENSOR, centre=CENTRE),
    ),
    "box": (rs.Box(*EDGES), solids.Polyhedron(solids.corners(EDGES))),
    "box with equal moments": (
        rs.Box(*EDGES, inertia=EQUAL),
        solids.Polyhedron(solids.corners(EDGES), inertia=EQUAL),
    ),
    "plate": (rs.Box(*PLATE), solids.Polyhedron(solids.corners(PLATE))),
    "shard": (rs.ConvexPolyhedron(POINTS), solids.Polyhedron(POINTS)),
    "ellipsoid": (rs.Ellipsoid(semi_axes=AXES), solids.Superquadric(AXES)),
    "superellipsoid": (
        rs.Superellipsoid(semi_axes=AXES, exponents=ROUNDED),
        solids.Superquadric(AXES, ROUNDED),
    ),
    "loaded superellipsoid": (
        rs.Superellipsoid(semi_axes=AXES, exponents=(2.5, 1.6), inertia=TENSOR, centre=CENTRE),
        solids.Superquadric(AXES, (2.5, 1.6), inertia=TENSOR, centre=CENTRE),
    ),
}
LAWS: dict[str, tuple[Law, rigid_motion.Law]] = {
    "frictionless": (rs.Frictionless(normal=0.9), rigid_motion.linear(0.9, None)),
    "paper": (
        rs.TangentialRestitution(normal=0.9, tangential=0.3),
        rigid_motion.linear(0.9, 0.3),
    ),
    "newton": (
        rs.Coulomb(normal=0.8, friction=0.3, hypothesis="newton"),
        rigid_motion.coulomb(0.8, 0.3, "newton"),
    ),
    "poisson": (
        rs.Coulomb(normal=0.8, friction=0.3, hypothesis="poisson"),
        rigid_motion.coulomb(0.8, 0.3, "poisson"),
    ),
    "stronge": (rs.Coulomb(normal=0.8, friction=0.3), rigid_motion.coulomb(0.8, 0.3, "stronge")),
}


class Release(NamedTuple):
    """Attitude and angular velocity of each particle, and the velocity of all."""

    attitude: Array
    spin: Array
    velocity: tuple[float, float, float] = (0.3, -0.2, 0.1)


def drawn(seed: int, particles: int = 2) -> Release:
    """Random attitudes and spins."""
    random = np.random.default_rng(seed)
    return Release(random.normal(size=(particles, 4)), random.normal(scale=25.0, size=(particles, 3)))


def solved(problem: Problem, release: Release, particle: int, off: float = 0.0) -> list[Bounce]:
    """Solve with the release, and the motion after each impact, changed by `off` in random directions."""
    random = np.random.default_rng(particle)
    attitude, spin, velocity = release.attitude[particle], release.spin[particle], release.velocity
    start = rigid_motion.placed(HEIGHT, attitude, np.array(velocity), spin)

    def disturbed(state: Array) -> Array:
        after = state.copy()
        for part in (VELOCITY, SPIN):
            after[part] += off * np.linalg.norm(state[part]) * random.normal(size=3)
        return after

    first = disturbed(start)
    first[ATTITUDE] += off * random.normal(size=4)
    first[rigid_motion.HEIGHT] *= 1.0 + off
    return list(islice(problem.bounce(first, disturbed), IMPACTS))


def recorded(bounces: Sequence[Bounce]) -> dict[str, Array]:
    """What `simulate` records of the impacts of a particle."""
    turned = [frame(bounce.before) for bounce in bounces]
    attitude = np.array([bounce.before[ATTITUDE] for bounce in bounces])
    return {
        "time": np.array([bounce.time for bounce in bounces]),
        "velocity_before": np.array([bounce.before[VELOCITY] for bounce in bounces]),
        "velocity_after": np.array([bounce.after[VELOCITY] for bounce in bounces]),
        "angular_velocity_before": np.array(
            [axes @ bounce.before[SPIN] for axes, bounce in zip(turned, bounces, strict=True)]
        ),
        "angular_velocity_after": np.array(
            [axes @ bounce.after[SPIN] for axes, bounce in zip(turned, bounces, strict=True)]
        ),
        "attitude": attitude / np.linalg.norm(attitude, axis=1)[:, None],
        "contact": np.array([bounce.part + 1 for bounce in bounces]),
    }


def apart(one: Any, right: dict[str, Array]) -> Array:
    """The largest difference of each impact, relative to the largest value of the quantity."""
    off = []
    for name, expected in right.items():
        if name == "contact":
            continue
        found = np.asarray(one[name])
        if name == "attitude":
            found = found * np.sign((found * expected).sum(axis=1))[:, None]
        off.append(np.abs(found - expected).reshape(IMPACTS, -1).max(axis=1) / np.abs(expected).max())
    return np.asarray(np.max(off, axis=0))


def assert_follows(
    body: RigidBody, law: Law, problem: Problem, release: Release, incline: float = 0.0
) -> list[list[Bounce]]:
    """Compare every impact of every particle; return those of the reference."""
    every = []
    data = rs.simulate(
        body,
        law,
        particles=len(release.attitude),
        impacts=IMPACTS,
        orientation=release.attitude,
        spin=release.spin,
        release_velocity=release.velocity,
        release_height=HEIGHT,
        incline=incline,
        record="state",
    )
    for particle in range(len(release.attitude)):
        mine = data.isel(particle=particle)
        bounces = solved(problem, release, particle)
        right = recorded(bounces)
        other = recorded(solved(problem, release, particle, OFF))
        growth = np.maximum.accumulate(apart(other, right)) / OFF
        error = apart(mine, right)
        assert (ACCURACY * growth < 1e-6).all(), "chaos parts the trajectories too early to compare"
        np.testing.assert_array_equal(mine.contact, right["contact"])
        assert (error <= ACCURACY * growth).all(), (particle, error, growth)
        every.append(bounces)
    return every


@pytest.mark.parametrize(
    ("shape", "which", "seed"),
    [
        ("clump", "frictionless", 1),
        ("clump", "stronge", 2),
        ("loaded clump", "newton", 3),
        ("box", "paper", 4),
        ("box", "poisson", 5),
        ("box with equal moments", "stronge", 6),
        ("shard", "newton", 12),
        ("shard", "frictionless", 13),
        ("ellipsoid", "paper", 7),
        ("ellipsoid", "newton", 8),
        ("superellipsoid", "frictionless", 9),
        ("superellipsoid", "poisson", 10),
        ("loaded superellipsoid", "stronge", 11),
    ],
)
@pytest.mark.filterwarnings("ignore::restitution.EnergyWarning")
def test_bodies_and_laws(shape: str, which: str, seed: int) -> None:
    """Random attitudes and spins, thrown sideways."""
    (body, solid), (law, rule) = BODIES[shape], LAWS[which]
    assert body.mass == pytest.approx(solid.mass, rel=1e-14)
    np.testing.assert_allclose(body.centre_of_mass, solid.centre, rtol=0, atol=1e-15 * R)
    np.testing.assert_allclose(
        body.inertia_tensor, solid.mass * solid.tensor, rtol=0, atol=1e-14 * body.inertia_tensor.max()
    )
    assert_follows(body, law, Problem(solid, rule), drawn(seed))


@pytest.mark.parametrize(("shape", "which"), [("box", "frictionless"), ("ellipsoid", "stronge")])
def test_spin_near_the_middle_axis(shape: str, which: str) -> None:
    """The axis turns over in flight, from a spin that is 1e-6 to 1e-2 off, beside an inclined plane."""
    (body, solid), (law, rule) = BODIES[shape], LAWS[which]
    release = drawn(12, 3)
    spins = [
        Rotation.from_quat(q, scalar_first=True).apply(60.0 * np.array([off, 1.0, -off]))  # of both: y
        for q, off in zip(release.attitude, (1e-6, 1e-4, 1e-2), strict=True)
    ]
    assert_follows(body, law, Problem(solid, rule, incline=0.2), release._replace(spin=np.array(spins)), 0.2)


@pytest.mark.parametrize("which", ["frictionless", "stronge"])
def test_a_box_lands_nearly_flat(which: str) -> None:
    """One corner after the other, some within a thousandth of the time of the fall."""
    (body, solid), (law, rule) = BODIES["box"], LAWS[which]
    tilts = np.array([(1e-2, -7e-3, 0.5), (2e-3, 3e-3, -1.0), (-4e-4, 9e-4, 2.0)])
    attitude = Rotation.from_euler("xyz", tilts).as_quat(scalar_first=True)
    release = Release(attitude, np.array([(0.0, 0.0, 0.0), (0.0, 0.0, 5.0), (1e-2, 0.0, 0.0)]))
    assert_follows(body, law, Problem(solid, rule), release)


@pytest.mark.parametrize("hypothesis", ["newton", "poisson", "stronge"])
@pytest.mark.filterwarnings("ignore::restitution.EnergyWarning")
def test_a_plate_that_jams(hypothesis: Any) -> None:
    """Its first impact is pressed the harder the longer it slips, dv_n/dp < 0: μ κ·d > K_nn."""
    body, solid = BODIES["plate"]
    friction = 2.5
    law, rule = (
        rs.Coulomb(normal=0.7, friction=friction, hypothesis=hypothesis),
        rigid_motion.coulomb(0.7, friction, hypothesis),
    )
    attitude = Rotation.from_euler("xyz", [(0.05, 1.1, 0.3), (0.2, 1.2, -0.2)])
    release = Release(attitude.as_quat(scalar_first=True), np.array([(0.0, 0.0, 3.0)] * 2), (1.0, 0.2, 0.0))
    for first, *_ in assert_follows(body, law, Problem(solid, rule), release):
        axes = frame(first.before)
        arm = axes @ solid.lowest(axes[2], first.part)
        slip = (first.before[VELOCITY] + np.cross(axes @ first.before[SPIN], arm))[:2]
        push = rigid_motion.response(axes @ solid.tensor @ axes.T, arm)[2]
        assert push[2] - friction * push[:2] @ slip / np.hypot(*slip) < 0.0
