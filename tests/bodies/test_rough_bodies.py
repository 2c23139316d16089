"""Rough bodies: where their asperities are, and that they bounce as clumps of the same balls do."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy import stats

import restitution as rs
from reference.command import invoke
from restitution.drop.run import Run
from restitution.drop.toml import run_of, tables_of

R, RHO = 3e-3, 3e-5
LAW = rs.TangentialRestitution(normal=0.9, tangential=1.0)
SHAPES: dict[str, Any] = {
    "dumbbell": rs.Dumbbell(radius=(R, 2e-3), separation=4e-3),
    "loaded": rs.LoadedSphere(radius=R, load=1e-4, offset=1e-3),
    "capsule": rs.Spherocylinder(radius=R, separation=2 * R),
    "clump": rs.Clump(
        spheres=R * np.array([(1, 1, 1, 1), (1, -1, -1, 1), (-1, 1, -1, 1.2), (-1, -1, 1, 0.8)])
    ),
}


def sphere(asperities: int, **others: Any) -> rs.RoughSphere:
    given: dict[str, Any] = {"radius": R, "asperities": asperities, "asperity_radius": RHO} | others
    return rs.RoughSphere(**given)


def test_asperities_are_uniform_and_do_not_depend_on_their_number() -> None:
    """The tops stand ρ above the sphere; every coordinate of a uniform direction is uniform in [-1, 1]."""
    balls = sphere(20_000).asperity_balls
    np.testing.assert_allclose(np.linalg.norm(balls[:, :3], axis=1), R, rtol=1e-14)
    np.testing.assert_allclose(balls[:, 3], RHO, rtol=1e-14)
    for coordinate in balls[:, :3].T / R:
        assert stats.kstest(coordinate, stats.uniform(-1, 2).cdf).pvalue > 1e-3
    np.testing.assert_allclose(sphere(100).asperity_balls, balls[:100], rtol=0, atol=1e-17)
    assert np.abs(sphere(100, seed=2).asperity_balls - balls[:100]).max() > R


@pytest.mark.parametrize(
    ("heights", "law"),
    [
        (("exponential", 1e-5), stats.expon(scale=1e-5)),
        (("normal", 1e-5, 1e-5), stats.truncnorm(-1.0, np.inf, loc=1e-5, scale=1e-5)),
        (("power", 2.5, 1e-6, 1e-4), stats.truncpareto(1.5, 100.0, scale=1e-6)),
        (("power", 1.0, 1e-6, 1e-4), stats.loguniform(1e-6, 1e-4)),
    ],
)
def test_heights_have_their_distribution(heights: tuple[Any, ...], law: Any) -> None:
    balls = sphere(5000, heights=heights).asperity_balls
    tops = np.linalg.norm(balls[:, :3], axis=1) + RHO - R
    assert tops.min() >= -1e-17
    assert stats.kstest(tops, law.cdf).pvalue > 1e-3


def test_heights_of_ones_own() -> None:
    heights = np.linspace(0.0, RHO, 50)
    balls = sphere(50, heights=heights).asperity_balls
    np.testing.assert_allclose(np.linalg.norm(balls[:, :3], axis=1) + RHO - R, heights, atol=1e-17)


@pytest.mark.parametrize("asperities", [3, 30])
def test_the_lowest_asperity_touches(asperities: int) -> None:
    """P(cos a < x) = ((1 + x)/2)^N for the angle a of the lowest one, over bodies at rest in any attitude."""
    cosines = []
    for seed in range(60):
        body = sphere(asperities, heights=2 * RHO, asperity_radius=RHO, seed=seed)
        run = Run(body=body, law=LAW, particles=1, impacts=1, seed=seed)
        data = rs.simulate(body, LAW, particles=1, impacts=1, seed=seed, record="state")
        part = int(data.contact[0, 0])
        if part == 1:  # the sphere itself, where no asperity is near
            continue
        w, x, y, z = data.attitude.to_numpy()[0, 0]
        up = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
        balls = body.asperity_balls
        assert (balls[:, :3] @ up).argmin() == part - 2
        cosines.append(-balls[part - 2, :3] @ up / np.linalg.norm(balls[part - 2, :3]))
        assert run.body == body
    within = (1 + (1 - 2 * RHO / (R + RHO))) / 2  # farther away than this the sphere touches
    least = within**asperities
    chances = (((1 + np.array(cosines)) / 2) ** asperities - least) / (1 - least)
    assert len(cosines) < 20 or stats.kstest(chances, "uniform").pvalue > 1e-3


@pytest.mark.parametrize("shape", SHAPES)
def test_asperities_lie_on_the_free_surface(shape: str) -> None:
    """None is inside the body, and shares of the area have their share of asperities."""
    body = SHAPES[shape]
    rough = rs.Rough(body, asperities=4000, asperity_radius=1e-6, heights=1e-6)
    assert rough.mass == body.mass
    places = rough.asperity_balls[:, :3]
    if shape == "capsule":
        along = np.clip(places[:, 2], -R, R)
        np.testing.assert_allclose(
            np.hypot(np.hypot(places[:, 0], places[:, 1]), places[:, 2] - along), R, rtol=1e-12
        )
        share = np.mean(np.abs(places[:, 2]) < R)  # barrel 2πR·2R of 4πR² + 4πR²
        assert abs(share - 0.5) < 5 * 0.5 / np.sqrt(4000)
        return
    spheres = {
        "dumbbell": np.array([(0, 0, 2e-3, R), (0, 0, -2e-3, 2e-3)]),
        "loaded": np.array([(0, 0, 0, R)]),
        "clump": np.array(getattr(body, "spheres", [])),
    }[shape]
    gaps = np.linalg.norm(places[:, None] - spheres[:, :3], axis=2) - spheres[:, 3]
    np.testing.assert_allclose(gaps.min(axis=1), 0.0, atol=1e-14)
    if shape == "dumbbell":  # caps of height h have the area 2πrh; the spheres meet at z from the middle
        (_, _, a, r), (_, _, b, s) = spheres
        cut = ((r * r - s * s) / (b - a) + a + b) / 2
        areas = r * (a + r - cut), s * (cut - b + s)
        share = np.mean(places[:, 2] > cut)
        expected = areas[0] / sum(areas)
        assert abs(share - expected) < 5 * np.sqrt(expected * (1 - expected) / 4000)


def test_a_rough_body_is_the_clump_of_its_balls() -> None:
    """With the same mass and inertia, to the last digits, over several impacts."""
    rough = sphere(5, heights=0.3 * R, asperity_radius=0.5 * R)
    spheres = np.vstack([[(0, 0, 0, R)], rough.asperity_balls])
    density = 2500.0 * rough.mass / rs.Clump(spheres=spheres).mass
    tensor = rough.inertia_tensor
    clump = rs.Clump(spheres=spheres, density=density, inertia=tensor, centre=(0, 0, 0))
    run: dict[str, Any] = {"particles": 50, "impacts": 3, "spin": (20.0, -30.0, 10.0)}
    law = rs.Frictionless(normal=0.9)
    one, other = (rs.simulate(body, law, **run) for body in (rough, clump))
    np.testing.assert_array_equal(one.contact, other.contact)
    np.testing.assert_allclose(one.time, other.time, rtol=1e-9)


def test_a_smooth_sphere_bounces_straight_back() -> None:
    """Asperities of no height change nothing."""
    data = rs.simulate(sphere(200, heights=0.0), LAW, particles=20, impacts=5)
    np.testing.assert_allclose(data.restitution, 0.9, rtol=1e-9)


def test_runs_are_alike_on_any_threads_and_through_files() -> None:
    body = rs.Rough(SHAPES["dumbbell"], asperities=300, asperity_radius=RHO, heights=("exponential", RHO))
    run: dict[str, Any] = {"particles": 200, "impacts": 4, "spin": rs.RandomSpin(rate=30.0)}
    law = rs.Frictionless(normal=0.9)
    one = rs.simulate(body, law, threads=1, **run)
    assert one.identical(rs.simulate(body, law, threads=2, **run))
    assert one.attrs["rough_body"] == "Dumbbell"
    assert one.attrs["asperity_seed"] == 1
    for made in (body, sphere(10), sphere(3, heights=[1e-6, 2e-6, 3e-6])):
        asked = Run(body=made, law=law)
        assert run_of(tables_of(asked), "file").body == made


ROUGH_DUMBBELL = rs.Rough(
    SHAPES["dumbbell"], asperities=500, asperity_radius=RHO, heights=("exponential", 1e-5)
)
BINS: dict[str, Any] = {"velocity_bins": [0.5, 0.7, 1.2], "restitution_bins": np.linspace(-1.0, 3.0, 41)}


def test_the_learned_density_is_the_closed_form(tmp_path: Path) -> None:
    """(11) and (12) of docs/rough.md, with nothing fitted: to 0.03, of six seeds the worst 0.02."""
    body, law = sphere(10_000), rs.Frictionless(normal=0.9)
    run: dict[str, Any] = {"particles": 8000, "impacts": 8, "heights_about": 0.06}
    learned = rs.FluctuatingRestitution.learn(body, law, velocities=(0.5, 0.8), **run)
    how: dict[str, Any] = {"radius": R, "asperities": 10_000, "asperity_radius": RHO, "height": RHO}
    contact = rs.analytic.rough_contact(**how)
    release = np.sqrt(2 * 9.81 * (0.06 - R))
    for v in (0.55, 0.65, 0.75):
        spin = rs.analytic.rough_spin(law, contact, speed=v, release_speed=release, radius=R)
        exact = rs.analytic.rough_impact(law, contact, speed=v, spin=spin, radius=R)
        e = exact.ppf(np.linspace(0.01, 0.99, 99))
        assert np.abs(learned.cdf(e, v) - exact.cdf(e)).max() < 0.03
    for write, path in ((learned.to_c, tmp_path / "rough.h"), (learned.to_fortran, tmp_path / "rough.f90")):
        write(path)
        assert {"asperities = 10000", "asperity_seed = 1"} <= {
            line.strip(" *!>") for line in path.read_text().splitlines()
        }


def test_rough_bodies_side_by_side() -> None:
    """What differs stands beside the names, that of the asperities' seed and of what is rough too."""
    bodies = [sphere(200), ROUGH_DUMBBELL, SHAPES["dumbbell"]]
    found = rs.compare(bodies, [LAW], particles=20, impacts=5, **BINS)
    assert list(found.body.values) == ["RoughSphere", "Rough", "Dumbbell"]
    np.testing.assert_array_equal(found.asperities, [200.0, 500.0, np.nan])
    np.testing.assert_array_equal(found.separation, [np.nan, 4e-3, 4e-3])
    assert list(found.heights.values) == ["", "exponential 1e-05", ""]
    assert list(found.rough_body.values) == ["", "Dumbbell", ""]
    assert found.asperity_radius.attrs["units"] == found.separation.attrs["units"] == "m"
    alone = rs.statistics(ROUGH_DUMBBELL, LAW, particles=20, impacts=5, **BINS)
    np.testing.assert_array_equal(found.restitution_count[1, 0], alone.restitution_count)


def test_studies_of_rough_bodies(tmp_path: Path) -> None:
    """Each point is the run alone; a closed form where there is one, else a refusal before anything runs."""
    study: dict[str, Any] = {"law": LAW, "run": {"particles": 32, "impacts": 4}, "statistics": BINS}
    cases: list[tuple[Any, str, list[float]]] = [
        (sphere(100), "body.asperities", [100, 300]),
        (ROUGH_DUMBBELL, "body.body.separation", [4e-3, 2e-3]),
        (ROUGH_DUMBBELL, "body.seed", [1, 2]),
    ]
    for body, name, values in cases:
        found = rs.sweep(study | {"body": body, "sweep": {name: values}}, out=tmp_path / f"{name}.zarr")
        alone = rs.statistics(body, LAW, particles=32, impacts=4, **BINS)
        here = found.sel({name.rpartition(".")[2]: values[0]})
        np.testing.assert_array_equal(here.restitution_count, alone.restitution_count)
    points = study | {"body": sphere(100), "sweep": {"body.asperities": [100, 300]}, "first_impact": {}}
    means = rs.sweep(points, out=tmp_path / "first.zarr").first_impact_mean
    assert list(means.values) == [rs.analytic.first_impact(sphere(n), LAW).mean() for n in (100, 300)]
    drawn = points | {"body": sphere(100, heights=("exponential", 1e-5))}
    with pytest.raises(ValueError, match=r"body\.heights = .* one number, for the closed form"):
        rs.sweep(drawn, out=tmp_path / "drawn.zarr")


@pytest.mark.parametrize("body", [sphere(200, heights=("exponential", 1e-5)), ROUGH_DUMBBELL])
def test_commands_and_rough_bodies(body: Any, tmp_path: Path) -> None:
    """Every command that reads a run takes them; the explorer says what it does not show."""
    written = tables_of(Run(body=body, law=LAW, particles=30, impacts=4))
    nested = written["body"].pop("body", None)
    text = "\n".join(
        f"[{name}]\n" + "\n".join(f"{key} = {json.dumps(value)}" for key, value in table.items())
        for name, table in (written | ({"body.body": nested} if nested else {})).items()
    )
    run, out = tmp_path / "run.toml", tmp_path / "run.nc"
    bins = "[statistics]\nvelocity_bins = [0.5, 0.7, 1.2]\nrestitution_bins = [-1, 0.9, 3]\n"
    run.write_text(f"{text}\n{bins}")
    for command in ("simulate", "statistics"):
        assert invoke(command, run, "--out", out, "--overwrite").exit_code == 0
        with xr.open_dataset(out) as data:
            assert data.attrs["asperities"] == body.asperities
            assert data.attrs["heights"] == "exponential 1e-05"
    result = invoke("explore", run, "--no-browser")
    assert result.exit_code == 2
    shown = "body.heights = " if isinstance(body, rs.RoughSphere) else f"body = {type(body).__name__}: "
    assert shown in result.stderr
    assert "the explorer shows this only if" in result.stderr


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"asperities": 0}, "asperities = 0"),
        ({"asperities": 2**31}, "asperities"),
        ({"asperities": 2**31 - 1, "radius": 1.0}, "asperities = 2147483647: must be as many as memory"),
        ({"asperity_radius": 0.0}, "asperity_radius = 0.0"),
        ({"asperity_radius": 2 * R}, "asperity_radius = 0.006"),
        ({"heights": -1e-6}, "heights"),
        ({"heights": np.nan}, "heights"),
        ({"heights": 2 * R}, "heights"),
        ({"heights": [1e-6, 1e-6]}, "heights"),
        ({"heights": [1e-6] * 9 + [-1e-6]}, "heights"),
        ({"heights": ("uniform", 1e-6)}, "heights"),
        ({"heights": ("normal", 1e-6)}, "heights"),
        ({"heights": ("exponential", -1e-6)}, "heights"),
        ({"heights": ("power", 2.0, 0.0, 1e-6)}, "heights"),
    ],
)
def test_rough_bodies_that_cannot_be_are_refused_by_name(changed: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        sphere(**{"asperities": 10, **changed})


def test_only_bodies_of_spheres_are_made_rough() -> None:
    with pytest.raises(ValueError, match=r"body = .*must be a Dumbbell, LoadedSphere"):
        rs.Rough(rs.Spheroid(equatorial=R, polar=2 * R), asperities=10, asperity_radius=RHO)


@pytest.mark.parametrize(
    "heights", [2.1 * RHO, [RHO, 2.1 * RHO], ("exponential", 2.1 * RHO), ("power", 2.0, 2.1 * RHO, 4 * RHO)]
)
def test_asperities_that_would_float_are_refused(heights: Any) -> None:
    """As `rough_contact` refuses them: an asperity whose top is higher than its diameter touches nothing."""
    with pytest.raises(ValueError, match=r"heights = .*: must be .* nor than twice asperity_radius"):
        _ = sphere(2, heights=heights).mass
    _ = sphere(2, heights=2.0 * RHO).mass
