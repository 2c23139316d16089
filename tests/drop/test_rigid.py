"""Bodies of any shape: beside bodies of revolution, which another loop follows, and by what is conserved."""

from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

import restitution as rs
from restitution.bodies import RigidBody
from restitution.drop.run import Run

R = 3e-3
LAWS = {
    "frictionless": rs.Frictionless(normal=0.9),
    "paper": rs.TangentialRestitution(normal=0.9, tangential=0.5),
    "stronge": rs.Coulomb(normal=0.8, friction=0.3),
    "poisson": rs.Coulomb(normal=0.8, friction=0.3, hypothesis="poisson"),
    "ruina": rs.ChatterjeeRuina(normal=0.8, tangential=0.2, friction=0.3),
}
SAFE = [name for name in LAWS if name != "paper"]
PAIRS: dict[str, tuple[Any, RigidBody]] = {
    "dumbbell": (
        rs.Dumbbell(radius=R, separation=R),
        rs.Clump(spheres=[(0, 0, R / 2, R), (0, 0, -R / 2, R)]),
    ),
    "club": (
        rs.Dumbbell(radius=(R, 2e-3), separation=4.5e-3, density=2000.0),
        rs.Clump(spheres=[(0, 0, 2.25e-3, R), (0, 0, -2.25e-3, 2e-3)], density=2000.0),
    ),
    "spheroid": (
        rs.Spheroid(equatorial=R, polar=4.5e-3),
        rs.Ellipsoid(semi_axes=(R, R, 4.5e-3)),
    ),
    "lens": (
        rs.Spheroid(equatorial=R, polar=1e-3),
        rs.Ellipsoid(semi_axes=(R, R, 1e-3)),
    ),
}
RIGID: dict[str, RigidBody] = {
    "tetrapod": rs.Clump(
        spheres=R * np.array([(1, 1, 1, 1), (1, -1, -1, 1), (-1, 1, -1, 1.2), (-1, -1, 1, 0.8)])
    ),
    "pebble": rs.Ellipsoid(semi_axes=(R, 2e-3, 1e-3)),
    "die": rs.Box(a=R, b=R, c=R),
    "shard": rs.ConvexPolyhedron(R * np.array([(0, 0, 0), (2, 0, 0), (0, 1, 0), (0.3, 0.2, 1), (1, 1, 0.5)])),
}


def attitudes(particles: int, seed: int = 7) -> tuple[Any, Any]:
    """Random attitudes, and the angles (θ, φ) of what they make of the z axis."""
    q = np.random.default_rng(seed).normal(size=(particles, 4))
    w, x, y, z = (q / np.linalg.norm(q, axis=1)[:, None]).T
    axis = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
    return q, np.stack([np.arccos(axis[2]), np.arctan2(axis[1], axis[0])], axis=1)


@pytest.mark.parametrize("shape", PAIRS)
@pytest.mark.parametrize("law", LAWS)
@pytest.mark.filterwarnings("ignore::restitution.EnergyWarning")
def test_a_body_of_revolution_bounces_alike_in_both_loops(shape: str, law: str) -> None:
    """The first impacts agree to the last digits; what is rounded then grows, as in any chaotic motion."""
    revolved, rigid = PAIRS[shape]
    assert rigid.mass == pytest.approx(revolved.mass, rel=1e-14)
    moments = np.sort(rigid.principal_moments)
    across, along = revolved.transverse_inertia, revolved.axial_inertia
    np.testing.assert_allclose(moments, np.sort([across, across, along]), rtol=3e-14)
    particles = 150
    q, angles = attitudes(particles)
    run: dict[str, Any] = {
        "spin": np.random.default_rng(3).normal(scale=30.0, size=(particles, 3)),
        "release_velocity": (0.1, -0.2, 0.3),
        "incline": 0.1,
        "particles": particles,
        "impacts": 3,
        "record": "state",
    }
    one = rs.simulate(revolved, LAWS[law], orientation=angles, **run)
    other = rs.simulate(rigid, LAWS[law], orientation=q, **run)
    names = ("time", "restitution", "energy_ratio", "velocity_after", "angular_velocity_after", "position")
    for name in names:
        size = float(np.abs(one[name]).max())
        apart = np.moveaxis(np.abs((one[name] - other[name]).to_numpy()), 1, 0)
        off = apart.reshape(3, -1).max(axis=1) / size
        assert (off < (2e-13, 1e-10, 1e-7)).all(), (name, off)
    if "contact" in other and isinstance(rigid, rs.Clump):
        np.testing.assert_array_equal(one.contact[:, :2], other.contact[:, :2])
        assert other.contact.dtype == np.int32


def test_both_loops_have_the_same_statistics() -> None:
    """Long after the digits have parted the mean of E_rot/E_tot is the same, within its standard error."""
    revolved, rigid = PAIRS["dumbbell"]
    for seed in (1, 2):
        run: dict[str, Any] = {"particles": 600, "impacts": 40, "orientation": "isotropic", "seed": seed}
        spun: dict[str, Any] = {"spin": rs.RandomSpin(rate=100.0, axis="thermal")}
        one, other = (rs.simulate(body, LAWS["stronge"], **run, **spun) for body in (revolved, rigid))
        for impacts in (slice(0, 10), slice(20, 40)):
            means = [data.rotational_fraction.isel(impact=impacts).mean("impact") for data in (one, other)]
            error = np.hypot(*(float(mean.std()) / np.sqrt(mean.size) for mean in means))
            assert abs(float(means[0].mean() - means[1].mean())) < 4 * error


@pytest.mark.parametrize("law", SAFE)
@pytest.mark.parametrize("shape", RIGID)
def test_energy_never_grows_and_nothing_passes_the_plane(shape: str, law: str) -> None:
    """Between impacts energy and angular momentum are kept; under these laws no impact creates energy."""
    body = RIGID[shape]
    spin = rs.RandomSpin(rate=(0.0, 300.0))
    data = rs.simulate(body, LAWS[law], particles=60, impacts=60, spin=spin, seed=4, record="state")
    assert (data.energy_ratio.fillna(1.0) <= 1.0 + 1e-12).all()
    moments, axes = np.array(data.principal_moments), np.array(data.principal_axes)

    def energy(velocity: Any, omega: Any, attitude: Any) -> Any:
        turning = turned_back(multiplied(attitude, axes), omega)
        return 0.5 * (data.mass * (velocity**2).sum(-1) + (moments * turning**2).sum(-1))

    happened = np.isfinite(data.time.to_numpy())
    both = happened[:, 1:]
    attitude = data.attitude.to_numpy()
    after = energy(data.velocity_after.to_numpy(), data.angular_velocity_after.to_numpy(), attitude)
    before = energy(data.velocity_before.to_numpy(), data.angular_velocity_before.to_numpy(), attitude)
    height = data.position.to_numpy()[..., 2]
    total_after, total_before = (e + data.mass * data.gravity * height for e in (after, before))
    gone = np.abs(total_before[:, 1:] - total_after[:, :-1])[both] / total_after.ravel()[0]
    assert gone.max() < 1e-13
    principal = multiplied(attitude, axes)
    momentum = [
        turned(principal, moments * turned_back(principal, data[name].to_numpy()))
        for name in ("angular_velocity_after", "angular_velocity_before")
    ]
    apart = np.linalg.norm(momentum[1][:, 1:] - momentum[0][:, :-1], axis=-1)[both]
    assert (apart < 1e-12 * np.nanmax(np.abs(momentum[0]))).all()
    if isinstance(body, rs.Clump | rs.Box):
        corners = body.spheres if isinstance(body, rs.Clump) else [(*v, 0.0) for v in body.vertices]
        balls = np.array(corners)
        arms = balls[:, :3] - body.centre_of_mass
        places = np.stack([turned(attitude, arm)[..., 2] for arm in arms], axis=-1)
        gaps = height[..., None] + places - balls[:, 3]
        size = np.linalg.norm(arms, axis=1).max() + balls[:, 3].max()
        assert np.nanmin(gaps) > -1e-12 * size
        part = np.maximum(data.contact.to_numpy() - 1, 0)
        touching = np.take_along_axis(gaps, part[..., None], axis=-1)[..., 0]
        assert np.abs(touching[happened]).max() < 1e-14 * size


def multiplied(a: Any, b: Any) -> Any:
    """The product of quaternions."""
    (a0, a1, a2, a3), (b0, b1, b2, b3) = np.moveaxis(a, -1, 0), np.moveaxis(b, -1, 0)
    parts = (
        a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3,
        a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2,
        a0 * b2 + a2 * b0 + a3 * b1 - a1 * b3,
        a0 * b3 + a3 * b0 + a1 * b2 - a2 * b1,
    )
    return np.stack(parts, axis=-1)


def turned(q: Any, v: Any) -> Any:
    """A vector of the body in space."""
    twice = 2.0 * np.cross(q[..., 1:], v)
    return v + q[..., :1] * twice + np.cross(q[..., 1:], twice)


def turned_back(q: Any, v: Any) -> Any:
    """A vector of space in the body."""
    return turned(q * np.array([1.0, -1.0, -1.0, -1.0]), v)


def test_a_run_does_not_depend_on_threads_or_parts() -> None:
    """The same bits; attitudes are drawn by number, uniform among all rotations."""
    run: dict[str, Any] = {
        "particles": 300,
        "impacts": 10,
        "seed": 8,
        "spin": rs.RandomSpin(rate=50.0, axis="thermal"),
    }
    one = rs.simulate(RIGID["tetrapod"], LAWS["stronge"], threads=1, **run)
    assert one.identical(rs.simulate(RIGID["tetrapod"], LAWS["stronge"], threads=2, **run))
    assert not {"angle", "release_angle"} & set(one)
    many = rs.simulate(RIGID["die"], LAWS["stronge"], particles=20_000, impacts=1, seed=9)
    _, x, y, z = many.release_attitude.to_numpy().T
    for cosine in (1 - 2 * (x * x + y * y), 1 - 2 * (y * y + z * z), 1 - 2 * (x * x + z * z)):
        assert abs(cosine.mean()) < 5 / np.sqrt(3 * cosine.size)
        assert abs((cosine**2).mean() - 1 / 3) < 5 * np.sqrt(4 / 45 / cosine.size)


@pytest.mark.parametrize(
    ("kind", "given", "message"),
    [
        (rs.Clump, {"spheres": []}, "spheres"),
        (rs.Clump, {"spheres": [(0, 0, 0, 0.0)]}, r"spheres\[0, 3\] = 0.0"),
        (rs.Clump, {"spheres": [(0, 0, np.nan, 1e-3)]}, "spheres"),
        (rs.Clump, {"spheres": [(0, 0, 1e-3)]}, "spheres"),
        (rs.Clump, {"spheres": [(0, 0, 0, 1e-3)], "inertia": "all"}, "inertia = 'all'"),
        (rs.Clump, {"spheres": [(0, 0, 0, 1e-3)], "inertia": np.diag([1e-9, 1e-9, 3e-9])}, "inertia"),
        (rs.Clump, {"spheres": [(0, 0, 0, 1e-3)], "centre": (0, 0, 0)}, "centre"),
        (rs.Ellipsoid, {"semi_axes": (1e-3, 1e-3)}, "semi_axes"),
        (rs.Ellipsoid, {"semi_axes": (1e-3, 1e-3, 0.0)}, "semi_axes"),
        (rs.Ellipsoid, {"semi_axes": (1e-3, 1e-3, 2.0)}, "semi_axes"),
        (rs.ConvexPolyhedron, {"points": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)]}, "points"),
        (rs.ConvexPolyhedron, {"points": [(0, 0, 0)] * 4}, "points"),
        (rs.ConvexPolyhedron, {"points": [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, np.inf)]}, "points"),
        (rs.Box, {"a": 1.0, "b": -1.0, "c": 1.0}, "b = -1.0"),
    ],
)
def test_bodies_that_cannot_be_are_refused_by_name(kind: Any, given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        kind(**given)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"orientation": "uniform-angle"}, "orientation = 'uniform-angle'"),
        ({"orientation": [0.1, 0.2]}, "orientation"),
        ({"orientation": [(1.0, 0.0, 0.0, 0.0)]}, "orientation has 1 quaternions"),
        ({"orientation": [(0.0, 0.0, 0.0, 0.0)] * 2}, "orientation"),
        ({"spin": rs.RandomSpin(rate=1.0, axis="across")}, "axis = 'across'"),
        ({"release_height": 1e-4}, "release_height"),
    ],
)
def test_runs_that_cannot_be_are_refused_by_name(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Run(body=RIGID["die"], law=LAWS["paper"], particles=2, **given)
    with pytest.raises(ValueError, match="angles, for a body of revolution"):
        Run(body=PAIRS["club"][0], law=LAWS["paper"], particles=1, orientation=[(1.0, 0.0, 0.0, 0.0)])


def test_moments_of_bodies_that_are_known() -> None:
    """The union of balls beside the closed forms of a lens and of separate balls; a box; a given tensor."""
    balls = np.array([(0, 0, 0, 1.0), (0.3, 1.0, -0.5, 0.8), (-0.4, 0.2, 3.0, 0.7)])
    far = rs.Clump(spheres=balls * (5.0, 5.0, 5.0, 1.0), density=1.0)
    summed = rs.Clump(spheres=balls * (5.0, 5.0, 5.0, 1.0), density=1.0, inertia="sum")
    off = np.abs(far.inertia_tensor - summed.inertia_tensor).max()
    assert off < 1e-14 * far.inertia_tensor.max()
    (_, _, _, r), (*d, s) = balls[0], balls[1]
    distance = float(np.linalg.norm(d))
    two = rs.Clump(spheres=balls[:2], density=1.0)
    depth = r + s - distance
    lens = np.pi * depth**2 * (distance**2 + 2 * distance * (r + s) - 3 * (r - s) ** 2) / (12 * distance)
    assert two.mass == pytest.approx(4 / 3 * np.pi * (r**3 + s**3) - lens, rel=1e-14)
    a, b, c = 1.0, 2.0, 3.0
    box = rs.Box(a=a, b=b, c=c, density=1.0)
    expected = a * b * c / 12 * np.array([b * b + c * c, c * c + a * a, a * a + b * b])
    np.testing.assert_allclose(np.diag(box.inertia_tensor), expected, rtol=1e-15)
    tensor = np.array([(3.0, 0.4, -0.2), (0.4, 2.0, 0.1), (-0.2, 0.1, 2.5)])
    given = rs.Clump(spheres=balls, inertia=tensor, centre=(0.1, 0.2, 0.3))
    np.testing.assert_array_equal(given.inertia_tensor, tensor)
    np.testing.assert_array_equal(given.centre_of_mass, (0.1, 0.2, 0.3))
    np.testing.assert_allclose(np.sort(given.principal_moments), np.linalg.eigvalsh(tensor), rtol=1e-14)


def test_rotations_of_scipy_are_attitudes() -> None:
    """The order (x, y, z, w) of SciPy, given as numbers, is asked back where it shows."""
    box = rs.Box(a=1e-2, b=2e-2, c=3e-2)
    turned = Rotation.from_euler("xyz", [[0.1, 0.2, 0.3], [1.0, 0.0, 2.0]])
    law = rs.Frictionless(normal=0.9)
    how: dict[str, Any] = {"particles": 2, "impacts": 3, "record": "state"}
    data = rs.simulate(box, law, orientation=turned, **how)
    same = rs.simulate(box, law, orientation=np.roll(turned.as_quat(), 1, axis=1), **how)
    xr.testing.assert_identical(data.drop_attrs(), same.drop_attrs())
    with pytest.raises(ValueError, match=r"half a turn about z, or else no turn in the order of SciPy"):
        rs.simulate(box, law, particles=1, impacts=1, orientation=[(0.0, 0.0, 0.0, 1.0)])
    with pytest.raises(ValueError, match=r"orientation = .*for a Cylinder"):
        rs.simulate(rs.Cylinder(radius=1.0, height=1.0), law, particles=1, orientation=[0.0])
    with pytest.raises(ValueError, match="data is of Box: must be of a body with an axis"):
        rs.figures.impact(data)


@pytest.mark.parametrize(
    "body",
    [
        rs.Ellipsoid(semi_axes=(1e-5, 1e-5, 1e-2)),
        rs.Box(a=1e-2, b=1e-5, c=1e-5),
        rs.Clump(spheres=[(0.0, 0.0, 0.0, 1e-6), (3e-3, 0.0, 0.0, 1e-6)]),
    ],
    ids=["ellipsoid", "box", "clump"],
)
@pytest.mark.filterwarnings("ignore:.*away from others")
def test_rounding_creates_no_energy(body: Any) -> None:
    """Of needles: the spin about the long axis has a rounding error, which is no work."""
    data = rs.simulate(body, rs.Frictionless(normal=1.0), particles=50, impacts=50)
    assert data.attrs["energy_created_impacts"] == 0
    assert float(abs(data.energy_ratio - 1.0).max()) < 1e-15
