"""The reference for other engines is the exact solution; what is read off a motion is what happened."""

import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from benchmarks.engines import problem, reference


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


def test_the_page_has_a_row_for_every_setting() -> None:
    from benchmarks.engines import settings

    page = (Path(__file__).parents[2] / "docs" / "performance.md").read_text(encoding="utf-8")
    for name, rows in settings.SETTINGS.items():
        listed = [line for line in page.splitlines() if line.startswith(f"| {settings.TITLES[name]} ")]
        assert len(listed) == len(rows), name
