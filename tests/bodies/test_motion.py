"""Every shape falls and bounces: against a dense search for contacts, by the energy, and as data."""

from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import restitution as rs
from reference import plane_motion
from restitution.bodies import Body
from restitution.drop.toml import read

SHAPES: dict[str, Body] = {
    "unequal dumbbell": rs.Dumbbell(radius=(3e-3, 2e-3), separation=4e-3, density=(2500.0, 7800.0)),
    "slightly unequal": rs.Dumbbell(radius=(3e-3, 2.999e-3), separation=3e-4, density=2500.0),
    "two densities": rs.Dumbbell(radius=3e-3, separation=2e-3, density=(900.0, 7800.0)),
    "club": rs.Dumbbell(radius=(2e-3, 9e-3), separation=2e-2, density=(7800.0, 100.0)),
    "engulfed sphere": rs.Dumbbell(radius=(3e-3, 9e-3), separation=3e-3),
    "loaded sphere": rs.LoadedSphere(radius=3e-3, load=1e-4, offset=2e-3),
    "heavy load": rs.LoadedSphere(radius=3e-3, load=5e-3, offset=3e-3),
    "spherocylinder": rs.Spherocylinder(radius=3e-3, separation=6e-3),
    "egg": rs.Spheroid(equatorial=3e-3, polar=4e-3),
    "lentil": rs.Spheroid(equatorial=3e-3, polar=1e-3),
    "needle": rs.Spheroid(equatorial=1e-3, polar=3e-2),
    "coin": rs.Spheroid(equatorial=1e-2, polar=2e-4),
}
each_shape = pytest.mark.parametrize("body", SHAPES.values(), ids=SHAPES)
LAW = rs.TangentialRestitution(normal=0.8, tangential=0.4)


def outline(body: Body) -> list[plane_motion.Part]:
    """The parts of the outline, from the parameters and the centre of mass."""
    match body:
        case rs.Dumbbell():
            half, centre = 0.5 * body.separation, body.centre_of_mass
            offsets = (half - centre, -half - centre)
            return [plane_motion.ball(s, r) for s, r in zip(offsets, body.radii, strict=True)]
        case rs.Spherocylinder():
            return [plane_motion.ball(s * 0.5 * body.separation, body.radius) for s in (1, -1)]
        case rs.LoadedSphere():
            return [plane_motion.ball(-body.centre_of_mass, body.radius)]
        case rs.Spheroid():
            return [plane_motion.spheroid(body.equatorial, body.polar)]
    raise AssertionError(body)


def support(body: Body, angle: Any) -> Any:
    """Height of the centre of mass of a body that stands on the plane."""
    return np.max([part.height(np.asarray(angle)) for part in outline(body)], axis=0)


def name_of(body: Body, part: int, angle: float) -> int:
    """The number by which a contact is known."""
    if isinstance(body, rs.Spheroid):
        return 1 if np.cos(angle) < 0 else 2
    return part + 1


@each_shape
def test_against_a_dense_search(body: Body) -> None:
    """Sampled at 20 000 times a flight and refined there: the first impacts, one number after the other."""
    angles = np.array([0.15, 0.7, 1.2, 1.9, 2.4, 3.0])
    height = 0.06
    data = rs.simulate(body, LAW, particles=6, impacts=5, orientation=angles, release_height=height)
    inertia = body.transverse_inertia / body.mass
    for particle, angle in enumerate(angles):
        impacts = plane_motion.bounce(
            outline(body), inertia, (LAW.constant, LAW.tangential), (float(angle), height)
        )
        for number, impact in enumerate(islice(impacts, 5)):
            found = data.isel(particle=particle, impact=number)
            # Neighbouring trajectories part; sharp ends and edges magnify most.
            rtol = 1e-11 * 10.0**number
            for name in ("time", "impact_velocity", "rebound_velocity", "energy_ratio"):
                expected = getattr(impact, name)
                assert float(found[name]) == pytest.approx(expected, rel=rtol, abs=1e-3 * rtol), name
            assert float(found.angle) == pytest.approx(impact.angle, abs=rtol * 10)
            assert float(found.rotational_fraction) == pytest.approx(impact.rotational_fraction, abs=rtol)
            assert int(found.contact) == name_of(body, impact.part, impact.angle)


@each_shape
def test_falls_and_rises_agree_with_the_heights(body: Body) -> None:
    """Between impacts v² changes by 2g times the difference of heights; the time is that of the parabola."""
    data = rs.simulate(body, LAW, particles=200, impacts=30, orientation="isotropic")
    height = support(body, data.angle.to_numpy())
    start, end = height[:, :-1], height[:, 1:]
    rise = data.rebound_velocity.to_numpy()[:, :-1]
    fall = data.impact_velocity.to_numpy()[:, 1:]
    duration = np.diff(data.time.to_numpy(), axis=1)
    there = np.isfinite(fall)
    scale = (rise**2 + 2 * 9.81 * (start + end))[there]
    error = (fall**2 - rise**2 - 2 * 9.81 * (start - end))[there]
    # Angles are reported to 2⁻⁵², and needles turn them into height thirtyfold.
    np.testing.assert_array_less(np.abs(error), 1e-12 * scale)
    np.testing.assert_allclose(duration[there], ((rise + fall) / 9.81)[there], rtol=0, atol=1e-12)
    assert (np.diff(data.time.to_numpy(), axis=1)[there] >= 0).all()
    first = data.isel(impact=0)
    drop = 0.06 - support(body, first.angle.to_numpy())
    np.testing.assert_allclose(first.impact_velocity, np.sqrt(2 * 9.81 * drop), rtol=1e-12)
    np.testing.assert_array_equal(first.angle, first.release_angle)


@each_shape
def test_the_energy_obeys_the_law(body: Body) -> None:
    """A contact velocity that is reversed keeps its energy; so does the first one from rest, whatever ε_t."""
    law = rs.TangentialRestitution(normal=1.0, tangential=-1.0)
    data = rs.simulate(body, law, particles=50, impacts=20)
    np.testing.assert_allclose(data.energy_ratio, 1.0, rtol=1e-11)
    # From rest the first contact does not slip, so that the tangential impulse does no work.
    law = rs.TangentialRestitution(normal=1.0, tangential=0.3)
    first = rs.simulate(body, law, particles=50, impacts=1)
    np.testing.assert_allclose(first.energy_ratio, 1.0, rtol=1e-11)


@each_shape
def test_the_lower_part_touches(body: Body) -> None:
    """`contact` names the sphere that is lowest, or the half of a spheroid that is below."""
    data = rs.simulate(body, LAW, particles=200, impacts=20)
    angle, contact = data.angle.to_numpy(), data.contact.to_numpy()
    there = contact > 0
    match body:
        case rs.LoadedSphere():
            assert set(contact[there]) == {1}
        case rs.Spheroid():
            np.testing.assert_array_equal(contact[there], np.where(np.cos(angle) < 0, 1, 2)[there])
        case _:
            heights = np.array([part.height(angle) for part in outline(body)])
            touching = np.take_along_axis(heights, np.maximum(contact - 1, 0)[None], axis=0)[0]
            assert (touching[there] >= heights.max(axis=0)[there] - 1e-15).all()


@settings(max_examples=40)
@given(
    aspect=st.floats(0.05, 20.0),
    angle=st.floats(0.01, 3.13),
    normal=st.floats(0.2, 1.0),
    drop=st.floats(1e-3, 0.1),
)
def test_random_spheroids(aspect: float, angle: float, normal: float, drop: float) -> None:
    """The first two impacts by the dense search."""
    body = rs.Spheroid(equatorial=3e-3, polar=3e-3 * aspect)
    law = rs.TangentialRestitution(normal=normal, tangential=1.0)
    height = float(support(body, angle)) + drop
    data = rs.simulate(
        body, law, particles=1, impacts=2, orientation=np.array([angle]), release_height=height
    )
    inertia = body.transverse_inertia / body.mass
    impacts = plane_motion.bounce(outline(body), inertia, (normal, 1.0), (angle, height))
    for number, impact in enumerate(islice(impacts, 2)):
        found = data.isel(particle=0, impact=number)
        assert float(found.time) == pytest.approx(impact.time, rel=1e-10)
        assert float(found.rebound_velocity) == pytest.approx(impact.rebound_velocity, rel=1e-8, abs=1e-9)


@each_shape
def test_counted_impacts_are_the_recorded_ones(body: Body) -> None:
    """`statistics` and `simulate` follow the same particles."""
    edges: Any = {"velocity_bins": np.linspace(0, 2, 11), "restitution_bins": np.linspace(-4, 4, 21)}
    counted = rs.statistics(body, LAW, particles=100, impacts=20, **edges)
    recorded = rs.reduce(rs.simulate(body, LAW, particles=100, impacts=20), **edges)
    np.testing.assert_array_equal(counted["restitution_count"], recorded["restitution_count"])


@each_shape
def test_the_schedule_does_not_matter(body: Body) -> None:
    """The same bits from one thread and from many."""
    one, many = (rs.simulate(body, LAW, particles=300, impacts=10, threads=n) for n in (1, 3))
    assert one.equals(many)


@each_shape
def test_the_parameters_go_into_the_file(body: Body, tmp_path: Path) -> None:
    """The attributes name the shape and all its parameters, also after a file was written and read."""
    rs.simulate(body, LAW, particles=2, impacts=2).to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as data:
        assert data.attrs["body"] == type(body).__name__
        for name, value in body.attributes().items():
            np.testing.assert_array_equal(data.attrs[name], value)


KINDS = {
    rs.Dumbbell: "dumbbell",
    rs.LoadedSphere: "loaded-sphere",
    rs.Spherocylinder: "spherocylinder",
    rs.Spheroid: "spheroid",
}


@each_shape
def test_a_run_from_a_file(body: Body, tmp_path: Path) -> None:
    """The file's keys are the parameters' names; pairs are arrays."""
    values = body.attributes().items()
    lines = [f"{name} = {list(v) if isinstance(v, tuple) else v}" for name, v in values]
    path = tmp_path / "run.toml"
    lines = ["[body]", f'shape = "{KINDS[type(body)]}"', *lines]
    lines += ["[law]", 'type = "tangential-restitution"', "normal = 0.8", "tangential = 0.4"]
    lines += ["[run]", "particles = 5", "impacts = 4"]
    path.write_text("\n".join(lines), encoding="utf-8")
    run = read(path)
    assert run.body == body
    assert rs.simulate(run.body, run.law, particles=5, impacts=4).equals(
        rs.simulate(body, LAW, particles=5, impacts=4)
    )


@each_shape
def test_nothing_may_start_below_the_plane(body: Body) -> None:
    """Given angles may start as low as they stand; random ones as low as the worst of them."""

    def refused(height: float, orientation: Any) -> str:
        with pytest.raises(ValueError, match=r"^release_height = .*: must be at least") as caught:
            rs.simulate(body, LAW, particles=4, impacts=1, release_height=height, orientation=orientation)
        return str(caught.value)

    angles = np.array([0.1, 1.0, 2.0, 3.1])
    given_angles = float(np.max(support(body, angles)))
    anyhow = float(np.max(support(body, np.linspace(0, np.pi, 100_001))))
    cases: list[tuple[float, Any]] = [
        (given_angles, angles),
        (anyhow, "uniform-angle"),
        (anyhow, "isotropic"),
    ]
    for lowest, orientation in cases:
        text = refused(lowest * (1 - 1e-8), orientation)
        said = float(text.split("at least ")[1].split(" m,")[0])
        assert said == pytest.approx(lowest, rel=1e-8)
        for height in (said, lowest * (1 + 1e-8)):
            data = rs.simulate(
                body, LAW, particles=4, impacts=1, release_height=height, orientation=orientation
            )
            assert (data.time >= 0).sum() == data.impacts.sum()


MAKERS: list[tuple[str, Callable[[], Body], str]] = [
    ("radius", lambda: rs.Dumbbell(radius=(1.0, -2.0), separation=1.0), "radius[1] = -2.0: must be a finite"),
    ("nan", lambda: rs.Dumbbell(radius=1.0, separation=1.0, density=(float("nan"), 0)), "density[0] = nan"),
    ("three", lambda: rs.Dumbbell(radius=(1, 2, 3), separation=1.0), "radius = (1, 2, 3): must be a finite"),
    (
        "offset",
        lambda: rs.LoadedSphere(radius=1.0, load=1.0, offset=1.5),
        "offset = 1.5, radius = 1.0: must be at most the",
    ),
    (
        "load",
        lambda: rs.LoadedSphere(radius=1.0, load=-1.0, offset=0.5),
        "load = -1.0: must be a finite number",
    ),
    (
        "long",
        lambda: rs.Spheroid(equatorial=1.0, polar=1001.0),
        "polar = 1001.0, equatorial = 1.0: must be between 1/1000",
    ),
    ("flat", lambda: rs.Spheroid(equatorial=1.0, polar=0.0), "polar = 0.0: must be a finite number > 0"),
    (
        "tiny",
        lambda: rs.Spheroid(equatorial=1e-100, polar=1e-100),
        "equatorial = 1e-100, polar = 1e-100, dens",
    ),
    (
        "huge",
        lambda: rs.Spherocylinder(radius=1e80, separation=1.0),
        "radius = 1e+80, separation = 1.0, densi",
    ),
    (
        "unlike",
        lambda: rs.Dumbbell(radius=(1e-60, 1e65), separation=1.0),
        "radius = (1e-60, 1e+65), separati",
    ),
    ("missing", lambda: rs.Spheroid(equatorial=1.0), "polar: missing; must be a finite number > 0 (m)"),  # type: ignore[call-arg]
]


@pytest.mark.parametrize(("make", "text"), [case[1:] for case in MAKERS], ids=[case[0] for case in MAKERS])
def test_impossible_bodies(make: Callable[[], Body], text: str) -> None:
    """The error names the argument, which of a pair, the value and what is allowed."""
    with pytest.raises(ValueError) as caught:  # noqa: PT011 - the message is looked at
        make()
    assert str(caught.value).startswith(text)
