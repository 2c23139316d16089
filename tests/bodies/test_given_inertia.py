"""Bodies whose matter is not homogeneous: a tensor of inertia and a centre of mass that are given."""

from typing import Any

import numpy as np
import pytest

import restitution as rs

R = 1e-2
LAW = rs.Coulomb(normal=0.8, friction=0.3)
CENTRE = (1e-3, 2e-3, -1.5e-3)
MESH: dict[str, Any] = {
    "vertices": [(0, 0, 0), (R, 0, 0), (0, R, 0), (0, 0, R)],
    "triangles": [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)],
}
KINDS: dict[str, tuple[Any, dict[str, Any]]] = {
    "box": (rs.Box, {"a": R, "b": 2 * R, "c": 3 * R}),
    "polyhedron": (rs.ConvexPolyhedron, {"points": MESH["vertices"]}),
    "die": (rs.Die, {"faces": 8, "edge": R}),
    "mesh": (rs.Mesh, MESH),
    "cylinder": (rs.Cylinder, {"radius": R, "height": 2 * R}),
    "ring": (rs.Ring, {"outer": R, "inner": 0.5 * R, "height": R}),
    "cone": (rs.Revolution, {"profile": [(0.0, 0.0), (2 * R, R)]}),
    "egg": (rs.Egg, {"length": 3 * R, "width": 2 * R, "blunt_end": 0.9 * R, "tip": 0.5 * R}),
    "ellipsoid": (rs.Ellipsoid, {"semi_axes": (3 * R, 2 * R, R)}),
    "superellipsoid": (rs.Superellipsoid, {"semi_axes": (3 * R, 2 * R, R), "exponents": (4, 3)}),
}


def runs(*bodies: Any, **more: Any) -> list[Any]:
    run: dict[str, Any] = {"particles": 150, "impacts": 2, "release_height": 0.1, "spin": (10.0, -5.0, 20.0)}
    return [rs.simulate(body, LAW, **run | more) for body in bodies]


@pytest.mark.parametrize("kind", KINDS)
def test_its_own_inertia_changes_nothing(kind: str) -> None:
    make, given = KINDS[kind]
    body = make(**given)
    same = make(**given, inertia=body.inertia_tensor, centre=body.centre_of_mass)
    assert same.mass == body.mass
    np.testing.assert_allclose(same.principal_moments, body.principal_moments, rtol=1e-13)
    one, other = runs(body, same)
    assert float(np.abs(one.restitution - other.restitution).median()) < 1e-12
    np.testing.assert_allclose(one.restitution[:, 0], other.restitution[:, 0], atol=1e-11)


@pytest.mark.parametrize("kind", KINDS)
def test_another_centre_of_mass_moves_the_surface_only(kind: str) -> None:
    """h(u) about another centre is less by what that lies farther along u."""
    make, given = KINDS[kind]
    body = make(**given)
    tensor = body.inertia_tensor + 0.2 * body.inertia_tensor[0, 0] * np.array(
        [[0.0, 0.1, 0.2], [0.1, 0.0, -0.1], [0.2, -0.1, 0.0]]
    )
    centre = body.centre_of_mass + 0.3 * np.array(CENTRE)
    other = make(**given, inertia=tensor, centre=centre)
    np.testing.assert_allclose(other.centre_of_mass, centre, atol=1e-17)
    np.testing.assert_allclose(other.inertia_tensor, tensor, rtol=1e-12, atol=1e-12 * tensor[0, 0])
    normals = np.random.default_rng(1).normal(size=(500, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    moved = body.compiled.supports(normals) - normals @ (centre - body.centre_of_mass)
    np.testing.assert_allclose(other.compiled.supports(normals), moved, atol=1e-15 * R * 20)
    assert other.compiled.farthest() >= moved.max()


@pytest.mark.parametrize("kind", ["cylinder", "ellipsoid", "superellipsoid", "egg"])
def test_a_surface_off_its_centre_bounces_like_its_points(kind: str) -> None:
    """Beside the convex hull of points of the surface, of the same inertia: ε of the first impact."""
    make, given = KINDS[kind]
    body = make(**given)
    tensor, centre = 1.3 * body.inertia_tensor, body.centre_of_mass + CENTRE
    normals = np.random.default_rng(2).normal(size=(3000, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]

    def h(v: Any) -> Any:
        size = np.linalg.norm(v, axis=1)
        return size * body.compiled.supports(v / size[:, None])

    step = 1e-6
    about = [(h(normals + step * e) - h(normals - step * e)) / (2 * step) for e in np.eye(3)]
    points = np.stack(about, axis=1) + body.centre_of_mass  # ∇h is the place that touches
    hull = rs.ConvexPolyhedron(points)
    hull = rs.ConvexPolyhedron(points, density=2500.0 * body.mass / hull.mass, inertia=tensor, centre=centre)
    moved = make(**given, inertia=tensor, centre=centre)
    assert hull.mass == pytest.approx(moved.mass, rel=1e-12)
    one, other = runs(moved, hull, spin=(0.0, 0.0, 0.0), impacts=1)
    apart = np.abs(one.restitution - other.restitution)
    assert float(apart.median()) < 0.02  # normals are 2 degrees apart


def test_a_ball_that_is_loaded_off_its_centre() -> None:
    """Beside `LoadedSphere`, a body of revolution that another loop follows."""
    loaded = rs.LoadedSphere(radius=R, load=5e-3, offset=6e-3)
    place = loaded.offset * loaded.load / loaded.mass
    ball = rs.Ellipsoid(semi_axes=(R, R, R))
    density = 2500.0 * loaded.mass / ball.mass
    tensor = np.diag([loaded.transverse_inertia, loaded.transverse_inertia, loaded.axial_inertia])
    rigid = rs.Ellipsoid(semi_axes=(R, R, R), density=density, inertia=tensor, centre=(0.0, 0.0, place))
    q = np.random.default_rng(5).normal(size=(150, 4))
    w, x, y, z = (q / np.linalg.norm(q, axis=1)[:, None]).T
    axis = 2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)
    angles = np.stack([np.arccos(axis[2]), np.arctan2(axis[1], axis[0])], axis=1)
    (one,) = runs(loaded, orientation=angles)
    (other,) = runs(rigid, orientation=q)
    np.testing.assert_allclose(one.restitution[:, 0], other.restitution[:, 0], atol=1e-11)
    assert float(np.abs(one.restitution - other.restitution).median()) < 1e-12


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_no_inertia_is_named(kind: str) -> None:
    make, given = KINDS[kind]
    small = np.eye(3) * 1e-7
    for wrong, message in (
        ({"inertia": np.eye(2)}, r"inertia = .*symmetric matrix, shape \(3, 3\)"),
        ({"inertia": np.diag([1e-7, 1e-7, 3e-7])}, "inertia = .*no larger than the sum of the other two"),
        ({"inertia": small, "centre": (0.0, 0.0)}, r"centre = .*\(x, y, z\)"),
        ({"inertia": small, "centre": (0.0, 0.0, np.nan)}, r"centre.*finite"),
        ({"inertia": small, "centre": (0.0, 0.1, 0.0)}, "centre = .*within the body"),
        ({"centre": CENTRE}, "centre = .*left out, or given with the tensor"),
    ):
        with pytest.raises(ValueError, match=message):
            make(**given, **wrong)
