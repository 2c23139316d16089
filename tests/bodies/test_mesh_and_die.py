"""Dice beside the closed forms of the Platonic solids; meshes beside polyhedra, spheres and tori."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest
from scipy.spatial import ConvexHull

import restitution as rs
from restitution import _core
from restitution.bodies import directions

Array = npt.NDArray[np.float64]

GOLDEN = (1 + 5**0.5) / 2
CORNERS = np.array([(0, 0, 0), (3, 0, 0), (0, 2, 0), (0, 0, 1)], dtype=float)
FACES = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])


@pytest.mark.parametrize(
    ("faces", "volume", "moment", "corners", "edges"),
    [
        (4, 2**0.5 / 12, 1 / 20, 4, 6),
        (6, 1.0, 1 / 6, 8, 12),
        (8, 2**0.5 / 3, 1 / 10, 6, 12),
        (12, (15 + 7 * 5**0.5) / 4, (39 * GOLDEN + 28) / 150, 20, 30),
        (20, 5 * (3 + 5**0.5) / 12, GOLDEN**2 / 10, 12, 30),
    ],
)
def test_dice_are_the_platonic_solids(
    faces: int, volume: float, moment: float, corners: int, edges: int
) -> None:
    edge = 7e-3
    die = rs.Die(faces, edge, density=1200.0)
    assert die.mass == pytest.approx(1200.0 * volume * edge**3, rel=1e-14)
    expected = die.mass * moment * edge**2
    assert die.inertia_tensor == pytest.approx(expected * np.eye(3), rel=1e-14, abs=1e-15 * expected)
    assert die.centre_of_mass == pytest.approx(0.0, abs=1e-15 * edge)
    apart = np.linalg.norm(die.vertices[:, None] - die.vertices, axis=-1)
    assert die.vertices.shape == (corners, 3)
    assert np.isclose(apart, edge, rtol=1e-14).sum() == 2 * edges
    assert apart[apart > 0].min() > edge * (1 - 1e-14)


def test_a_cubic_die_bounces_as_a_box() -> None:
    run: dict[str, Any] = {"particles": 20, "impacts": 2, "seed": 3, "spin": (10.0, 50.0, 0.0)}
    law = rs.Coulomb(normal=0.8, friction=0.3)
    die, box = (rs.simulate(body, law, **run) for body in (rs.Die(6, 5e-3), rs.Box(5e-3, 5e-3, 5e-3)))
    np.testing.assert_allclose(die.restitution, box.restitution, rtol=1e-9)
    np.testing.assert_array_equal(die.contact, box.contact)


@pytest.mark.parametrize("faces", [5, 0, True, 6.0, "6", None])
def test_other_dice_are_refused(faces: Any) -> None:
    with pytest.raises(ValueError, match=r"^faces = .*: must be 4, 6, 8, 12 or 20"):
        rs.Die(faces, 1e-2)


def ball(radius: float, n: int) -> tuple[Array, npt.NDArray[np.int64]]:
    """A triangulated sphere: an octahedron, each triangle cut into four n times."""
    vertices = np.concatenate([np.eye(3), -np.eye(3)])
    triangles = np.array(
        [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
    )
    for _ in range(n):
        a, b, c = (vertices[triangles[:, k]] for k in range(3))
        ab, bc, ca = (0.5 * (x + y) for x, y in ((a, b), (b, c), (c, a)))
        corners = np.concatenate(
            [np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
        corners /= np.linalg.norm(corners, axis=-1, keepdims=True)
        vertices, triangles = np.unique(corners.reshape(-1, 3).round(15), axis=0, return_inverse=True)
        triangles = triangles.reshape(-1, 3)
    return radius * vertices, triangles


def torus(big: float, small: float, n: int) -> tuple[Array, npt.NDArray[np.int64]]:
    u, v = np.meshgrid(*(2 * np.pi * np.arange(n) / n,) * 2, indexing="ij")
    r = big + small * np.cos(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), small * np.sin(v)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    a, b, c, d = ((i + k) % n * n + (j + m) % n for k, m in ((0, 0), (1, 0), (1, 1), (0, 1)))
    return points, np.concatenate([np.stack(t, -1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])


def test_a_convex_mesh_is_the_polyhedron() -> None:
    mesh = rs.Mesh(vertices=1e-3 * CORNERS, triangles=FACES)
    hull = rs.ConvexPolyhedron(1e-3 * CORNERS)
    assert mesh.mass == pytest.approx(hull.mass, rel=1e-15)
    np.testing.assert_allclose(mesh.inertia_tensor, hull.inertia_tensor, rtol=1e-13)
    run: dict[str, Any] = {"particles": 20, "impacts": 2, "seed": 3}
    one, other = (rs.simulate(body, rs.Frictionless(normal=0.8), **run) for body in (mesh, hull))
    np.testing.assert_allclose(one.restitution, other.restitution, rtol=1e-9)
    np.testing.assert_array_equal(one.contact, other.contact)


def test_the_triangles_of_a_polyhedron_depend_on_its_points_only() -> None:
    """A grid with points within faces and edges, each twice, has the triangles of a cube, however turned."""
    grid = np.stack(np.meshgrid(*(np.arange(3.0),) * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    points = 1.7e-3 * np.concatenate([grid, grid])
    triangles = [(0, 2, 8), (0, 2, 20), (0, 6, 8), (0, 6, 24), (0, 18, 20), (0, 18, 24)]
    triangles += [(2, 8, 26), (2, 20, 26), (6, 8, 26), (6, 24, 26), (18, 20, 26), (18, 24, 26)]
    for turned in (
        points,
        points[:, [1, 2, 0]],
        -points,
        points @ np.array([[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]),
    ):
        assert [tuple(corners) for corners in _core.hull(turned.tolist())] == triangles
    assert rs.ConvexPolyhedron(points).mass == pytest.approx(2500 * (2 * 1.7e-3) ** 3, rel=1e-14)


def test_hollow_and_holed_solids_have_their_own_mass() -> None:
    """A spherical shell and a torus, to the square of the size of the triangles; the hull alone touches."""
    (outside, faces), (inside, within) = ball(2e-3, 4), ball(1e-3, 4)
    shell = rs.Mesh(
        vertices=np.concatenate([outside, inside]),
        triangles=np.concatenate([faces, within[:, ::-1] + len(outside)]),
    )
    r, s = 2e-3, 1e-3
    assert shell.mass == pytest.approx(2500 * 4 / 3 * np.pi * (r**3 - s**3), rel=1e-2)
    assert (shell.hull < len(outside)).all()
    moment = 0.4 * shell.mass * (r**5 - s**5) / (r**3 - s**3)
    assert shell.principal_moments == pytest.approx([moment] * 3, rel=1e-2)
    big, small = 3e-3, 1e-3
    for n, rtol in ((30, 3e-2), (120, 2e-3)):
        points, triangles = torus(big, small, n)
        ring = rs.Mesh(vertices=points, triangles=triangles)
        assert ring.mass == pytest.approx(2500 * 2 * np.pi**2 * big * small**2, rel=rtol)
        axial = ring.mass * (big**2 + 0.75 * small**2)
        across = ring.mass * (0.5 * big**2 + 0.625 * small**2)
        assert np.diag(ring.inertia_tensor) == pytest.approx([across, across, axial], rel=rtol)
    assert 0 < len(ring.hull) < len(points)


def written(folder: Path, suffix: str) -> Path:
    """An irregular tetrahedron, with the triangles' own vertices in STL."""
    path = folder / f"stone{suffix}"
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join("vertex {:g} {:g} {:g}\n".format(*CORNERS[i]) for i in face)
        + "endloop\nendfacet\n"
        for face in FACES
    )
    rows = ["{:g} {:g} {:g}".format(*corner) for corner in CORNERS]
    texts = {
        ".stl": f"solid stone\n{facets}endsolid stone\n",
        ".obj": "\n".join([*(f"v {row}" for row in rows), *(f"f {a} {b} {c}" for a, b, c in FACES + 1), ""]),
        ".ply": "\n".join(
            [
                *("ply", "format ascii 1.0", "element vertex 4"),
                *(f"property float {axis}" for axis in "xyz"),
                *("element face 4", "property list uchar int vertex_indices", "end_header"),
                *rows,
                *(f"3 {a} {b} {c}" for a, b, c in FACES),
                "",
            ]
        ),
    }
    path.write_text(texts[suffix])
    return path


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".ply"])
def test_a_mesh_from_a_file(tmp_path: Path, suffix: str) -> None:
    pytest.importorskip("trimesh")
    mesh = rs.Mesh.from_file(written(tmp_path, suffix), scale=1e-3, density=3000.0)
    assert mesh.mass == pytest.approx(3000.0 * 1e-9, rel=1e-14)
    assert mesh.centre_of_mass == pytest.approx([0.75e-3, 0.5e-3, 0.25e-3], rel=1e-14)
    hull = rs.ConvexPolyhedron(1e-3 * CORNERS, density=3000.0)
    np.testing.assert_allclose(mesh.inertia_tensor, hull.inertia_tensor, rtol=1e-13)
    assert len(mesh.vertices) == 4


def test_files_that_hold_no_closed_mesh_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("trimesh")
    path = written(tmp_path, ".stl")
    text = path.read_text()
    open_ = tmp_path / "open.stl"
    open_.write_text(text.replace("vertex 0 0 1", "vertex 0 0 1.5", 1))
    with pytest.raises(
        ValueError, match=rf"{open_}: triangles = .*: must be .* not closed at 4 edges, of which the first"
    ):
        rs.Mesh.from_file(open_, scale=1e-3)
    inverted = tmp_path / "inverted.stl"
    lines = text.splitlines()
    places = [k for k, line in enumerate(lines) if "vertex" in line]
    for one, other in zip(places[::3], places[1::3], strict=False):
        lines[one], lines[other] = lines[other], lines[one]
    inverted.write_text("\n".join(lines))
    with pytest.raises(ValueError, match=rf"{inverted}: triangles = .* trimesh\.repair\.fix_inversion"):
        rs.Mesh.from_file(inverted, scale=1e-3)
    broken = tmp_path / "broken.ply"
    broken.write_text("ply\nformat ascii 1.0\n")
    with pytest.raises(ValueError, match=f"{broken}: "):
        rs.Mesh.from_file(broken)
    with pytest.raises(ValueError, match=r"path = .*: must be the name of a mesh, \.stl, \.obj, \.ply"):
        rs.Mesh.from_file(tmp_path / "stone.step")
    with pytest.raises(FileNotFoundError):
        rs.Mesh.from_file(tmp_path / "none.stl")
    with pytest.raises(ValueError, match="scale = -1"):
        rs.Mesh.from_file(path, scale=-1.0)
    monkeypatch.setitem(sys.modules, "trimesh", None)
    with pytest.raises(ValueError, match=r"pip install 'restitution\[mesh\]'"):
        rs.Mesh.from_file(path)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (
            {"triangles": FACES[:3]},
            r"not closed at 3 edges, .* vertices 1 .* and 2 .* one triangle",
        ),
        (
            {"triangles": [*FACES[:3], (1, 3, 2)]},
            r"not oriented at 3 edges.* the triangles 0 and 3",
        ),
        ({"triangles": FACES[:, ::-1]}, "must be counter-clockwise"),
        (
            {"triangles": FACES + 1},
            r"triangles = .*: must be triples of numbers of the vertices, from 0 to 3",
        ),
        ({"triangles": FACES - 1}, "triangles"),
        ({"triangles": FACES + 0.5}, "triangles"),
        ({"triangles": FACES[:, :2]}, "triangles"),
        ({"triangles": []}, "triangles"),
        ({"vertices": CORNERS[:3]}, "vertices"),
        ({"vertices": CORNERS * [1, 1, np.nan]}, "vertices"),
        ({"vertices": CORNERS * [1, 1, 0]}, "triangles"),
    ],
)
def test_surfaces_that_enclose_nothing_are_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        rs.Mesh(**({"vertices": 1e-3 * CORNERS, "triangles": FACES} | given))


@pytest.mark.slow
def test_a_mesh_of_a_hundred_thousand_vertices() -> None:
    """One on an ellipsoid: mass and inertia within its resolution, and the first impacts of the ellipsoid."""
    axes = (3e-3, 2e-3, 1.5e-3)
    points = directions(100_000) * axes
    triangles = ConvexHull(points).simplices
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    inwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a) < 0.0
    triangles[inwards] = triangles[inwards][:, ::-1]
    mesh, ellipsoid = rs.Mesh(vertices=points, triangles=triangles), rs.Ellipsoid(semi_axes=axes)
    assert len(mesh.hull) == len(points)
    assert mesh.mass == pytest.approx(ellipsoid.mass, rel=1e-4)
    np.testing.assert_allclose(mesh.principal_moments, ellipsoid.principal_moments, rtol=2e-4)
    law = rs.Frictionless(normal=0.9)
    one, other = (rs.simulate(body, law, particles=200, impacts=1) for body in (mesh, ellipsoid))
    np.testing.assert_allclose(one.restitution, other.restitution, atol=0.03)
