"""Where bodies come to rest: wells and passes in closed form, and what a ball of energy can still reach."""

from typing import Any

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

import restitution as rs
from restitution.bodies import RigidBody
from restitution.drop.resting import _Polyhedron, _Sampled, _shape

A, B, C = 1e-2, 1.4e-2, 2e-2
PLASTIC = rs.Coulomb(normal=0.2, friction=0.3)


def run(body: RigidBody, particles: int = 200, **others: Any) -> Any:
    spin = rs.RandomSpin(rate=(0.0, 60.0))
    given: dict[str, Any] = {"law": PLASTIC, "particles": particles, "impacts": 400, "spin": spin, "seed": 2}
    given |= others
    law = given.pop("law")
    return rs.simulate(body, law, record="state", **given)


def test_the_wells_of_a_cuboid() -> None:
    """It rests on six faces; the lowest pass out of each is over an edge to the largest face."""
    body = rs.Box(a=A, b=B, c=C)
    found = rs.resting(body, run(body))
    np.testing.assert_allclose(found.height, np.repeat([C, B, A], 2) / 2, rtol=1e-14)
    # Of the largest face to the middle one, of the others to the largest.
    over = np.hypot([C, B, B], [A, A, A]) / 2
    np.testing.assert_allclose(found.barrier, np.repeat(over, 2), rtol=1e-14)
    axes = np.argmax(np.abs(found.normal.to_numpy()), axis=1)
    assert axes.tolist() == [2, 2, 1, 1, 0, 0]
    assert float(found.least.sum()) == pytest.approx(1.0 - found.attrs["undecided"], abs=1e-15)
    np.testing.assert_allclose(found.most - found.least, found.attrs["undecided"], atol=1e-15)
    assert (found.resting.to_numpy() >= -1).all()


@pytest.mark.parametrize(
    ("body", "heights", "barriers"),
    [
        (rs.Cylinder(radius=3e-3, height=1e-3), [3e-3, 0.5e-3, 0.5e-3], [np.hypot(3e-3, 0.5e-3)] * 3),
        (rs.Ring(outer=3e-3, inner=2e-3, height=4e-3), [3e-3, 2e-3, 2e-3], [np.hypot(3e-3, 2e-3)] * 3),
        # A cone stands on its base or lies on its side, from which it can only tip over the rim.
        (
            rs.Revolution(profile=[(0, 2e-3), (8e-3, 0)]),
            [2e-3, 6e-3 * 2 / np.sqrt(68)],
            [np.hypot(2e-3, 2e-3)] * 2,
        ),
        (rs.Die(4, 1e-2), [1e-2 / np.sqrt(24)] * 4, [1e-2 / np.sqrt(8)] * 4),
        (rs.Die(8, 1e-2), [1e-2 / np.sqrt(6)] * 8, [5e-3] * 8),
    ],
)
def test_wells_and_passes_in_closed_form(body: RigidBody, heights: Any, barriers: Any) -> None:
    """The centre of mass is as high as the face's distance, and over a pass as the edge's or the rim's."""
    shape = _shape(body).landscape
    wells = shape.wells()
    order = np.argsort(-shape.heights[wells], kind="stable")
    np.testing.assert_allclose(shape.heights[wells][order], heights, rtol=1e-13)
    np.testing.assert_allclose(shape.levels()[wells][order], barriers, rtol=1e-13)


def test_an_oblique_prism_rests_only_on_faces_below_its_centre() -> None:
    """It falls over from its small faces, beyond which the centre of mass lies: they are no wells."""
    base = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * 1e-2
    points = [(x, y, 0.0) for x, y in base] + [(x + 3e-2, y, 2e-2) for x, y in base]
    shape = _Polyhedron(np.array(points) - np.mean(points, axis=0))
    landscape = shape.landscape
    assert len(landscape.heights) == 6
    assert sorted(np.abs(landscape.normals[landscape.wells()]).argmax(axis=1).tolist()) == [1, 1, 2, 2]


def test_the_well_of_a_direction_is_that_of_the_region_below_its_height() -> None:
    """Beside regions of a dense grid of directions, by brute force on the support function."""
    rng = np.random.default_rng(6)
    number = np.arange(20000) + 0.5
    polar, azimuth = np.arccos(1 - number / 10000), np.pi * (1 + 5**0.5) * number
    grid = np.stack([np.cos(azimuth) * np.sin(polar), np.sin(azimuth) * np.sin(polar), np.cos(polar)], axis=1)
    spacing = 2.2 * np.sqrt(4 * np.pi / number.size)
    tree = cKDTree(grid)
    pairs = tree.query_pairs(spacing, output_type="ndarray")
    decided = 0
    for _ in range(3):
        points = rng.normal(size=(12, 3))
        shape = _Polyhedron(points - points.mean(axis=0) * 0.9)
        heights = (grid @ shape.points.T).max(axis=1)
        wells = shape.landscape.wells()
        at_wells = tree.query(shape.landscape.normals[wells])[1]
        for u in rng.normal(size=(25, 3)):
            down = u / np.linalg.norm(u)
            level = float((shape.points @ down).max())
            well = shape.landscape.well_of(shape.below(down), level)
            # What is below a height, and then a little more, by what a step of the grid can change it.
            inside = (heights < level + 2 * spacing)[pairs].all(axis=1)
            links = coo_matrix((np.ones(inside.sum()), pairs[inside].T), shape=(number.size,) * 2)
            region = connected_components(links, directed=False)[1]
            same = region[at_wells] == region[tree.query(down)[1]]
            if well >= 0:
                assert well in wells[same]
            if same.sum() == 1:
                assert well == wells[same][0]
            decided += well >= 0
    assert decided > 2


def test_what_is_decided_does_not_depend_on_later_impacts() -> None:
    """A particle that is decided after few impacts has the same face after many; few remain undecided."""
    body = rs.Die(6, 1e-2)
    data = run(body, particles=200, law=rs.Frictionless(normal=0.9), impacts=800)
    found = rs.resting(body, data)
    assert found.attrs["undecided"] < 0.1
    after = found.decided_after.to_numpy()
    for cut in (100, 200):
        early = rs.resting(body, data.isel(impact=slice(0, cut)))
        known = early.resting.to_numpy() >= 0
        assert known.any()
        np.testing.assert_array_equal(known, (after > 0) & (after <= cut))
        np.testing.assert_array_equal(early.resting[known], found.resting[known])
    most = found.least + found.attrs["undecided"]
    for share, error in ((found.least, found.least_error), (most, found.most_error)):
        np.testing.assert_allclose(error, np.sqrt(share * (1.0 - share) / 200))  # of 200 draws
    # Six equal faces, to four standard errors.
    assert np.abs(found.least / found.least.sum() - 1 / 6).max() < 4 * np.sqrt(5 / 36 / 200)


def test_dropped_flat_it_stays_on_that_face() -> None:
    body = rs.Cylinder(radius=3e-3, height=1e-3)
    upside_down = np.array(
        [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0]]
    )
    law = rs.Frictionless(normal=0.3)
    data = run(
        body, law=law, particles=3, orientation=upside_down, spin=None, release_height=0.01, impacts=60
    )
    found = rs.resting(body, data)
    faces = found.resting.to_numpy()
    assert found.normal.to_numpy()[faces[:2], 2].tolist() == pytest.approx([-1.0, 1.0])


CORNERS = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)]) * A / np.sqrt(8)
BRICK = np.array(np.meshgrid([-A, A], [-B, B], [-C, C])).reshape(3, 8).T / 2
GRIDS = [
    # Spheres at the corners of a tetrahedron or a cuboid: as of those, and their radius more.
    (rs.Clump(spheres=[(*p, 1e-3) for p in CORNERS]), A / np.sqrt(24) + 1e-3, A / np.sqrt(8) + 1e-3, 4),
    (rs.Clump(spheres=[(*p, 1e-3) for p in BRICK]), A / 2 + 1e-3, np.hypot(A, B) / 2 + 1e-3, 6),
    # It lies on an end of the shortest axis, and rolls to the other over the middle one.
    (rs.Ellipsoid(semi_axes=(2e-3, 1.2e-3, 1.7e-3)), 1.2e-3, 1.7e-3, 2),
    # Round about an axis: one well all around, which nothing leaves.
    (rs.Ellipsoid(semi_axes=(2e-3, 1.2e-3, 1.2e-3)), 1.2e-3, np.inf, 1),
    (rs.Clump(spheres=[(0, 0, 0, 1e-3), (2e-3, 0, 0, 1e-3)]), 1e-3, np.inf, 1),
    # One that rights itself: its centre of mass is 1 mm below that of its only sphere.
    (
        rs.Clump(spheres=[(0, 0, 0, 5e-3)], centre=(0, 0, -1e-3), inertia=np.diag([1e-8] * 3)),
        4e-3,
        np.inf,
        1,
    ),
]


@pytest.mark.parametrize(("body", "lowest", "barrier", "number"), GRIDS)
def test_wells_on_a_grid_in_closed_form(body: RigidBody, lowest: float, barrier: float, number: int) -> None:
    """Wells to rounding; passes are never too high, and too low by twice the resolution at most."""
    shape = _shape(body)
    assert isinstance(shape, _Sampled)
    wells = shape.landscape.wells()
    assert len(wells) == number
    at = wells[np.argmin(shape.landscape.heights[wells])]
    assert shape.landscape.heights[at] == pytest.approx(lowest, rel=1e-8)
    level = shape.landscape.levels()[at]
    assert level == barrier or barrier - 2 * shape.miss <= level <= barrier
    # The grid leaves no gap that is wider than what the passes are lowered by.
    directions = np.random.default_rng(1).normal(size=(50_000, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    assert np.max(shape.tree.query(directions)[0]) < np.sqrt(4 * np.pi / shape.tree.n)


@pytest.mark.filterwarnings("ignore:spheres.* away from others")
@pytest.mark.parametrize("body", [GRIDS[0][0], GRIDS[2][0]])
def test_clumps_and_ellipsoids_stay_where_they_are_decided(body: RigidBody) -> None:
    """The side that is down when one is decided is down at the end; equal sides are equally often."""
    data = run(body, particles=300, law=rs.Frictionless(normal=0.8), impacts=600)
    found = rs.resting(body, data)
    assert 0 < found.attrs["resolution"] < 0.05 * float(found.height.min())
    early = rs.resting(body, data.isel(impact=slice(0, 80)))
    known = early.resting.to_numpy() >= 0
    assert known.mean() > 0.1
    np.testing.assert_array_equal(early.resting[known], found.resting[known])
    w, *v = np.moveaxis(data.attitude.to_numpy(), -1, 0)
    last = data.impacts.to_numpy() - 1
    decided = found.resting.to_numpy() >= 0
    each = np.flatnonzero(decided)
    w, v = w[each, last[each]][:, None], np.stack(v, axis=-1)[each, last[each]]
    normal = found.normal.to_numpy()[found.resting.to_numpy()[each]]
    turned = normal + 2 * np.cross(v, w * normal + np.cross(v, normal))
    assert (turned[:, 2] < 0).all()
    share, sides = 1 / len(found.face), decided.sum()
    error = np.sqrt(share * (1 - share) / sides)
    assert np.abs(found.least * 300 / sides - share).max() < 4 * error


@pytest.mark.parametrize(
    "body",
    [
        rs.Box(A, B, C),
        rs.Cylinder(A, B),
        rs.Cylinder(A, B, inertia=rs.Cylinder(A, B).inertia_tensor, centre=(1e-3, 0, 0)),
        rs.Superellipsoid(semi_axes=(A, B, C), exponents=(4, 4)),
        GRIDS[0][0],
    ],
)
@pytest.mark.filterwarnings("ignore:spheres.* away from others")
@pytest.mark.parametrize("law", [PLASTIC, rs.Frictionless(normal=0.7)])
def test_until_settled_the_same_are_decided(body: RigidBody, law: Any) -> None:
    """A run that ends where nothing can change has the same impacts up to there, and the same faces."""
    heights: dict[str, Any] = {"release_height": 0.1, "particles": 30}
    whole, short = run(body, law=law, **heights), run(body, law=law, until="settled", **heights)
    settled = short.stop_reason.to_numpy() == 5
    assert settled.any()
    assert (short.impacts <= whole.impacts).all()
    last = short.sizes["impact"]
    kept = np.isfinite(short.time.to_numpy())
    np.testing.assert_array_equal(short.time.to_numpy()[kept], whole.time.to_numpy()[:, :last][kept])
    found, expected = rs.resting(body, short), rs.resting(body, whole)
    np.testing.assert_array_equal(found.resting, expected.resting)
    assert (found.resting.to_numpy()[settled] >= 0).all()
    assert short.attrs["settling_height"] <= float(found.barrier.min())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"until": "tired"}, "until = 'tired': must be 'settled', or left out"),
        ({"incline": 0.1}, "incline = 0.1: must be 0, a level plane"),
        ({"law": rs.TangentialRestitution(normal=0.9)}, "law = .*must be one that cannot create energy"),
        ({"body": rs.Dumbbell(radius=A, separation=A)}, "body = .*must be a rigid body that is not rough"),
        ({"body": GRIDS[-1][0]}, "body = .*must be one that can come to rest in two ways or more"),
    ],
)
def test_what_cannot_settle_is_named(change: dict[str, Any], message: str) -> None:
    given: dict[str, Any] = {"body": rs.Box(A, B, C), "until": "settled"} | change
    with pytest.raises(ValueError, match=message):
        run(**given)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (
            {"body": rs.RoughSphere(radius=3e-3, asperities=9, asperity_radius=3e-6)},
            "must be a rigid body that is not rough",
        ),
        ({"body": rs.Box(1e-2, 1e-2, 1.1e-2)}, "data: of a Box of .* kg; must be of the body"),
        ({"incline": 0.1}, "data.incline = 0.1: must be 0"),
        ({"law": rs.TangentialRestitution(normal=0.9, tangential=1.0)}, "create energy"),
        ({"drop": "attitude"}, "data lacks attitude"),
    ],
)
def test_runs_of_which_it_cannot_be_said(change: dict[str, Any], message: str) -> None:
    body = rs.Box(1e-2, 1e-2, 1e-2)
    others = {name: change[name] for name in ("incline", "law") if name in change}
    data = run(body, particles=30, **others)
    if "drop" in change:
        data = data.drop_vars(change["drop"])
    with pytest.raises(ValueError, match=message):
        rs.resting(change.get("body", body), data)
