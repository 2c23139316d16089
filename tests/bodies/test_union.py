"""The matter of overlapping balls, beside closed forms and slices that share nothing with the package."""

import signal
import sys
import time
import warnings
from collections.abc import Callable
from itertools import combinations, pairwise
from typing import Any

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy.spatial.transform import Rotation

import restitution as rs

NODES, WEIGHTS = leggauss(40)


def filling(number: int, radius: float, seed: int = 0, within: float = 5e-3) -> Any:
    """Rows (x, y, z, r) of balls with centres uniform in a ball, as in clumps that fill a shape."""
    rng = np.random.default_rng(seed)
    places = rng.normal(size=(number, 3))
    places *= within * rng.random((number, 1)) ** (1 / 3) / np.linalg.norm(places, axis=1, keepdims=True)
    return np.column_stack([places, np.full(number, radius)])


def slice_of(balls: Any, z: float) -> Any:
    """Integrals of 1, x, y, x², y², xy over a union of discs, by Green's theorem along its free arcs."""
    found = np.zeros(6)
    discs = [(x, y, np.sqrt(r * r - (z - h) ** 2)) for x, y, h, r in balls if abs(z - h) < r]
    for i, (x, y, r) in enumerate(discs):
        cuts, covering = [-np.pi, np.pi], []
        for j, (u, v, s) in enumerate(discs):
            if i == j:
                continue
            distance = np.hypot(u - x, v - y)
            if distance + r <= s and (distance + r < s or j < i):
                break
            if distance >= r + s or distance + s <= r:
                continue
            middle = np.arctan2(v - y, u - x)
            half = np.arccos((distance**2 + r * r - s * s) / (2 * distance * r))
            covering.append((middle, half))
            cuts += [(middle + sign * half + np.pi) % (2 * np.pi) - np.pi for sign in (-1, 1)]
        else:
            cuts.sort()
            for a, b in pairwise(cuts):
                middle = 0.5 * (a + b)
                if any(np.cos(middle - at) > np.cos(half) for at, half in covering):
                    continue
                t = middle + 0.5 * (b - a) * NODES
                px, py, dy = x + r * np.cos(t), y + r * np.sin(t), r * np.cos(t)
                fields = (px, px**2 / 2, px * py, px**3 / 3, px * py**2, px**2 * py / 2)
                found += [0.5 * (b - a) * np.sum(WEIGHTS * field * dy) for field in fields]
    return found


def matter(balls: Any) -> tuple[float, Any, Any]:
    """Volume, centre, and tensor of inertia over the density: slices between heights where they change."""
    heights = {h + sign * r for _, _, h, r in balls for sign in (-1, 1)}
    for one, other in combinations(balls, 2):
        apart = other[:3] - one[:3]
        distance = np.linalg.norm(apart)
        if abs(one[3] - other[3]) < distance < one[3] + other[3]:
            along = (distance**2 + one[3] ** 2 - other[3] ** 2) / (2 * distance)
            level = np.sqrt(one[3] ** 2 - along**2) * np.hypot(*apart[:2]) / distance
            heights |= {one[2] + along * apart[2] / distance + sign * level for sign in (-1, 1)}
    for one, two, three in combinations(balls, 3):
        rows = 2 * np.array([two[:3] - one[:3], three[:3] - one[:3]])
        known = [b[:3] @ b[:3] - b[3] ** 2 - (one[:3] @ one[:3] - one[3] ** 2) for b in (two, three)]
        place = np.linalg.lstsq(rows, np.array(known) - rows @ one[:3], rcond=None)[0]
        rest = one[3] ** 2 - place @ place
        if rest > 0:
            across = np.cross(*rows)
            across *= np.sqrt(rest) / np.linalg.norm(across)
            heights |= {one[2] + place[2] + sign * across[2] for sign in (-1, 1)}
    levels = sorted(heights)
    sums = np.zeros(10)
    for low, high in pairwise(levels):
        for s, weight in zip(*leggauss(24), strict=True):  # the roots at the ends go with z ~ sin(pi s / 2)
            z = 0.5 * (low + high) + 0.5 * (high - low) * np.sin(0.5 * np.pi * s)
            measure = weight * 0.5 * (high - low) * 0.5 * np.pi * np.cos(0.5 * np.pi * s)
            one, x, y, xx, yy, xy = slice_of(balls, z)
            sums += measure * np.array([one, x, y, z * one, xx, yy, z * z * one, xy, z * x, z * y])
    volume, centre = sums[0], sums[1:4] / sums[0]
    xx, yy, zz, xy, xz, yz = sums[4:]
    spread = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) - volume * np.outer(centre, centre)
    return volume, centre, np.trace(spread) * np.eye(3) - spread


@pytest.mark.parametrize(("number", "radius", "seed"), [(8, 3e-3, 1), (10, 2e-3, 2), (9, 4e-3, 3)])
def test_balls_that_fill_a_shape(number: int, radius: float, seed: int) -> None:
    """Slices converge to some 1e-12 of the volume."""
    balls = filling(number, radius, seed)
    balls[:, 3] *= np.random.default_rng(seed).uniform(0.5, 1.0, number)
    volume, centre, tensor = matter(balls)
    body = rs.Clump(spheres=balls, density=1.0)
    assert body.mass == pytest.approx(volume, rel=1e-10)
    np.testing.assert_allclose(body.centre_of_mass, centre, rtol=0, atol=1e-10 * 5e-3)
    np.testing.assert_allclose(body.inertia_tensor, tensor, rtol=0, atol=1e-10 * np.abs(tensor).max())


def test_balls_within_others_add_nothing() -> None:
    """998 in the union of two, most of them in neither: the body is the dumbbell of the two."""
    R, L = 3e-3, 3e-3
    dumbbell = rs.Dumbbell(radius=R, separation=L)
    rng = np.random.default_rng(4)
    places = rng.uniform(-R, R, (4000, 3))
    places[:, 2] *= 0.2
    ends = np.array([[0, 0, L / 2], [0, 0, -L / 2]])
    waist = np.sqrt(R**2 - L**2 / 4)
    # As far as the nearest point of the surface of the union: on either ball, or the ring where they meet.
    to_ball = R - np.linalg.norm(places[:, None] - ends, axis=2)
    ring = np.hypot(np.hypot(places[:, 0], places[:, 1]) - waist, places[:, 2])
    room = np.minimum(to_ball.max(axis=1), ring)
    good = room > 1e-4
    inner = np.column_stack([places[good], room[good]])[:998]
    assert len(inner) == 998
    assert np.mean((inner[:, 3:] > to_ball[good][:998] + 1e-6).all(axis=1)) == 0.0
    body = rs.Clump(spheres=np.vstack([np.column_stack([ends, [R, R]]), inner]))
    assert body.mass == pytest.approx(dumbbell.mass, rel=1e-13)
    np.testing.assert_allclose(
        np.diag(body.inertia_tensor),
        [dumbbell.transverse_inertia, dumbbell.transverse_inertia, dumbbell.axial_inertia],
        rtol=1e-13,
    )


def test_a_thousand_balls_that_fill_a_shape() -> None:
    """Seen from another side the matter is the same, though every sphere is cut along other circles."""
    balls = filling(1000, 2e-3)
    turn = Rotation.from_rotvec((0.3, -1.1, 0.7)).as_matrix()
    body = rs.Clump(spheres=balls)
    other = rs.Clump(spheres=np.column_stack([balls[:, :3] @ turn.T, balls[:, 3]]))
    assert other.mass == pytest.approx(body.mass, rel=1e-12)
    np.testing.assert_allclose(other.centre_of_mass, turn @ body.centre_of_mass, rtol=0, atol=1e-14)
    np.testing.assert_allclose(other.principal_moments, body.principal_moments, rtol=1e-12)


def test_lattices_where_edges_meet_in_points() -> None:
    """Of 5 x 5 x 5 balls many circles meet in each point; a ball around all of them hides them."""
    grid = np.stack(np.meshgrid(*3 * [np.arange(-2.0, 3.0)]), axis=-1).reshape(-1, 3)
    balls = 1e-3 * np.column_stack([grid, np.full(125, np.sqrt(0.75))])  # which meet in the corners of cells
    body = rs.Clump(spheres=balls, density=1.0)
    turn = Rotation.from_rotvec((0.3, -1.1, 0.7)).as_matrix()
    other = rs.Clump(spheres=np.column_stack([balls[:, :3] @ turn.T, balls[:, 3]]), density=1.0)
    assert other.mass == pytest.approx(body.mass, rel=1e-12)
    np.testing.assert_allclose(body.principal_moments, body.principal_moments.mean(), rtol=1e-12)
    hidden = rs.Clump(spheres=[*balls, (0.0, 0.0, 0.0, 5e-3)], density=1.0)
    assert hidden.mass == pytest.approx(4 / 3 * np.pi * 5e-3**3, rel=1e-13)


@pytest.mark.parametrize(
    "make",
    [
        lambda spheres: rs.Clump(spheres=spheres).mass,
        lambda _: rs.RoughSphere(radius=3e-3, asperities=20_000_000, asperity_radius=1e-6).mass,
    ],
    ids=["clump", "rough"],
)
def test_ctrl_c_ends_what_takes_long(make: Callable[[Any], float]) -> None:
    """The first would take minutes, the other ten seconds and a gigabyte."""
    if sys.platform == "win32":
        pytest.skip("Windows has no timer that sends a signal")

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    spheres = filling(30_000, 2e-3)
    before = signal.signal(signal.SIGALRM, stop)
    began = time.process_time()
    try:
        signal.setitimer(signal.ITIMER_REAL, 1.0)
        with pytest.raises(KeyboardInterrupt):
            make(spheres)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
    assert time.process_time() - began < 5.0


def test_a_clump_in_pieces_is_asked_about() -> None:
    law = rs.Frictionless(normal=0.9)
    how: dict[str, Any] = {"particles": 2, "impacts": 2}
    pieces = rs.Clump(spheres=[(0, 0, 0, 1e-3), (6e-3, 6e-3, 6e-3, 1e-3)])
    with pytest.warns(
        UserWarning, match=r"spheres\[1\] is 0\.004 m \(4 radii\) away from others along x: is"
    ):
        rs.simulate(pieces, law, **how)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        rs.simulate(rs.Clump(spheres=[(0, 0, 0, 1e-3), (3.9e-3, 0, 0, 1e-3)]), law, **how)
