"""Other engines are compared with the exact solution; what is read off a motion is what happened."""

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

import restitution as rs
from benchmarks import bodies
from benchmarks.engines import problem, reference, rigid, settings
from benchmarks.engines.problem import Floats, Motion, Solid


def test_the_constants_are_those_of_the_body() -> None:
    body = reference.BODY
    assert (body.mass, body.transverse_inertia, body.axial_inertia) == (
        problem.MASS,
        problem.TRANSVERSE,
        problem.AXIAL,
    )
    text = (problem.REFERENCE / "README.md").read_text(encoding="utf-8")
    for number in (body.mass, body.transverse_inertia, body.axial_inertia):
        assert f"{number!r} kg" in text


def test_first_impacts_are_the_closed_form() -> None:
    """ε = -1 + (1 + ε_n)/(1 + mL² sin²θ/(4J)), v² = 2g(h - R - L|cos θ|/2); the spin is from the impulse."""
    found = problem.read("first_impacts")
    sine, cosine = np.sin(found["angle"]), np.cos(found["angle"])
    half, ratio = problem.SEPARATION / 2, problem.MASS / problem.TRANSVERSE
    epsilon = -1 + (1 + problem.NORMAL) / (1 + ratio * (half * sine) ** 2)
    speed = np.sqrt(2 * problem.GRAVITY * (problem.HEIGHT - problem.RADIUS - half * cosine))
    np.testing.assert_allclose(found["restitution"], epsilon, rtol=0, atol=1e-13)
    np.testing.assert_allclose(found["impact_velocity"], speed, rtol=1e-13)
    np.testing.assert_allclose(found["spin_after"], ratio * (1 + epsilon) * speed * half * sine, rtol=1e-12)
    # Energy: what is lost is that of the normal motion of the contact, (1 - ε_n²)v²/2 over its inverse mass.
    before, after = 0.5 * speed**2, 0.5 * (epsilon * speed) ** 2 + 0.5 * found["spin_after"] ** 2 / ratio
    lost = 0.5 * (1 - problem.NORMAL**2) * speed**2 / (1 + ratio * (half * sine) ** 2)
    np.testing.assert_allclose(before - after, lost, rtol=1e-12)


def test_the_files_are_what_the_engine_gives(tmp_path: Path) -> None:
    """Trajectories within the stated error; statistics of a fifth of the bodies, other seeds, 4.5 errors."""
    data = reference.trajectories()
    found = problem.read("trajectories")
    for name in ("time", "impact_velocity", "restitution", "angle"):
        exact = data[f"trajectory_{name}"].values.ravel()
        np.testing.assert_allclose(found[f"trajectory_{name}"], exact, rtol=1e-9)
    whole = xr.load_dataset(problem.REFERENCE / "dumbbell.nc")
    assert whole.attrs["version"] == reference.VERSION
    statistics = problem.read("statistics")
    for name in ("mean_restitution", "std_restitution"):
        np.testing.assert_allclose(statistics[name], whole[name], rtol=1e-14)
    fresh = reference.statistics(4, seed=5000)
    for name in ("mean_restitution", "std_restitution"):
        # From four batches an error is itself uncertain: theirs is that of the files, times √5.
        error = statistics[f"{name}_error"] * np.sqrt(1 + reference.BATCHES / 4)
        assert np.all(np.abs(fresh[name].values - statistics[name]) < 4.5 * error), name
    # The fastest bin holds the first impacts and no others.
    first = rs.analytic.first_impact(reference.BODY, reference.LAW)
    assert statistics["number"][-1] == reference.PARTICLES
    assert statistics["std_restitution"][-1] == pytest.approx(
        first.std(), abs=4.5 * statistics["std_restitution_error"][-1]
    )


@pytest.mark.parametrize("steps", [1, 7])
def test_impacts_are_found_in_a_motion(steps: int) -> None:
    """A ball with ε = 0.8, its impacts within one step or spread over seven, as those of springs are."""
    step, epsilon = 1e-3, 0.8
    velocity, z, v = [0.0], 0.05, 0.0
    left, kick = 0, 0.0
    for _ in range(400):
        if left == 0 and z <= 0 and v < 0:
            left, kick = steps, -(1 + epsilon) * v / steps
            z = 0.0
        v += (kick if left else 0.0) - problem.GRAVITY * step
        left = max(0, left - 1)
        z += v * step
        velocity.append(v)
    found_v, found_epsilon = problem.impacts(problem.Motion(step, np.array(velocity)[:, None]))
    assert found_v[0, 0] == pytest.approx(math.sqrt(2 * problem.GRAVITY * 0.05), abs=0.02)
    assert found_epsilon[:2, 0] == pytest.approx(epsilon, abs=0.03 * steps)


PAGE = (Path(__file__).parents[2] / "docs" / "performance.md").read_text(encoding="utf-8").splitlines()


def test_the_page_has_a_row_for_every_setting() -> None:
    for name, rows in settings.SETTINGS.items():
        listed = [line for line in PAGE if line.startswith(f"| {settings.TITLES[name]} ")]
        assert len(listed) == len(rows), name
        for body, made in rigid.BODIES.items():
            begin = f"| {body} | {settings.TITLES[name]} "
            number = sum(line.startswith(begin) for line in PAGE)
            assert number == (rigid.solid(made).kind in settings.SHAPES[name]), begin


def lowest(solid: Solid, down: Floats) -> Floats:
    """Places that touch a plane, for directions down in the axes of the body: the point or the centre."""
    sizes, places = np.array(solid.sizes), np.array(solid.places)
    if solid.kind == "sphere":
        return np.asarray(places[np.argmax(down @ places.T + sizes[:, 0], axis=1)])
    if solid.kind == "ellipsoid":  # x = A²u/|Au|
        return np.asarray(sizes[0] ** 2 * down / np.linalg.norm(sizes[0] * down, axis=1)[:, None])
    return np.asarray(sizes[0] * np.sign(down))


@pytest.mark.parametrize("name", rigid.BODIES)
def test_first_impacts_of_rigid_bodies_are_the_closed_form(name: str) -> None:
    """ε = -1 + (1 + ε_n)/(1 + m (r × n)·J⁻¹(r × n)); the mass is that of the body in its own axes."""
    body = rigid.BODIES[name]
    solid, fall = rigid.solid(body), rigid.Fall.exact(body)
    np.testing.assert_allclose(body.inertia_tensor, np.diag(solid.moments), atol=1e-12 * max(solid.moments))
    np.testing.assert_allclose(body.centre_of_mass, 0.0, atol=1e-16)
    turns = Rotation.from_quat(rigid.attitudes(), scalar_first=True)
    normal = turns.inv().apply([0.0, 0.0, 1.0])
    arm = np.cross(lowest(solid, -normal), normal)
    turning = solid.mass * np.sum(arm**2 / np.array(solid.moments), axis=1)
    np.testing.assert_allclose(fall.restitution, -1 + (1 + problem.NORMAL) / (1 + turning), atol=1e-12)
    assert np.ptp(fall.restitution) > 0.3  # the attitude matters


@pytest.mark.parametrize(("name", "left"), [("clump of 4", 0.016), ("die", 0.020)])
def test_dampers_of_the_whole_mass_cannot_be_accurate(name: str, left: float) -> None:
    """What the page states: a spring with damping ratio ζ returns exp(-πζ/√(1 - ζ²)), ζ ~ 1/√(mass)."""
    epsilon = rigid.Fall.exact(rigid.BODIES[name]).restitution
    turning = (1 + problem.NORMAL) / (1 + epsilon)  # mass over that which the spring feels
    ratio = 0.5 * problem.damping(1.0) * np.sqrt(turning)
    returned = np.exp(-np.pi * ratio / np.sqrt(1 - ratio**2))
    assert np.median(np.abs((returned - problem.NORMAL) / turning)) == pytest.approx(left, abs=5e-4)


def test_a_body_in_principal_axes_is_the_same() -> None:
    """The clump is turned and moved, not mirrored: what lies between its spheres stays, and so do moments."""
    given, turned = bodies.FOUR, rigid.BODIES["clump of 4"]
    one, two = np.array(given.spheres), np.array(rigid.solid(turned).places)
    edges, others = (np.diff(places[:, :3], axis=0) for places in (one, two))
    np.testing.assert_allclose(others @ others.T, edges @ edges.T, atol=1e-16)
    np.testing.assert_allclose(np.linalg.det(others), np.linalg.det(edges), rtol=1e-12)
    np.testing.assert_allclose(np.sort(turned.principal_moments), np.sort(given.principal_moments))


def test_balls_about_the_corners_bounce_like_the_box() -> None:
    """At every attitude their lowest point is as high over their plane as the box is over its own."""
    box = rigid.solid(rs.Box(0.01, 0.02, 0.03))
    balls, floor = problem.balls(box)
    for attitude in rigid.attitudes():
        turn = problem.rotation(attitude)
        np.testing.assert_allclose(
            turn, Rotation.from_quat(attitude, scalar_first=True).as_matrix(), atol=1e-15
        )
        bottom = np.min(balls[:, :3] @ turn[2] - balls[:, 3]) - floor
        assert bottom == pytest.approx(-np.abs(turn[2]) @ box.sizes[0], abs=1e-16)


class Late:
    """An engine of springs whose ε is too large by two hundred steps, in s, if a contact lasts ten steps."""

    NAME = "late"

    def __init__(self, fall: rigid.Fall) -> None:
        self.fall = fall

    def sprung(self, solid: Solid) -> float:
        return solid.mass

    def run(self, solid: Solid, attitudes: Floats, seconds: float, step: float, stiffness: float) -> Motion:
        lasting = np.pi * np.sqrt(solid.mass / stiffness) / step
        epsilon = self.fall.restitution + 200 * step * (1 + abs(lasting - 10))
        v = np.full(epsilon.size, -1.0)
        look = iter([v, v - problem.GRAVITY * 1e-3, epsilon * (1 + problem.GRAVITY * 2e-3)])
        return problem.record(lambda _: None, lambda: next(look), len(attitudes), 3e-3, 1e-3)


def test_the_largest_step_is_found() -> None:
    """An error of 200 steps is below 0.01 from 2e-5 s on; else the least one is given."""
    fall = rigid.Fall.exact(rigid.BODIES["die"])
    engine = Late(fall)
    error, step, stiffness = rigid.largest(engine, fall, settings.STEPS)
    assert step == 2e-5
    assert error == pytest.approx(0.004, abs=1e-6)
    mass = rigid.BODIES["die"].mass
    assert stiffness == pytest.approx(mass * (np.pi / (10 * step)) ** 2)
    error, step, _ = rigid.largest(engine, fall, settings.STEPS[:3])
    assert step == settings.STEPS[2]
    assert error == pytest.approx(0.1, abs=1e-6)
