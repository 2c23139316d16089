"""Hollow bodies by integrals over their walls, and moments of inertia that are given."""

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.integrate import dblquad, quad

import restitution as rs
from restitution.bodies import KINDS, Body
from restitution.drop.run import Run
from restitution.drop.toml import read, table_of

LAW = rs.Frictionless(normal=0.9)
DENSITY = 1400.0

Moments = tuple[float, float, float]


def of_slices(square: Callable[[float], float], ends: list[float]) -> Moments:
    """Volume, ∫z² and ∫ϱ² dV of a solid with this squared radius at z, smooth between the ends."""

    def integral(f: Callable[[float], float]) -> float:
        parts = pairwise(ends)
        return float(sum(quad(f, low, high, epsabs=0.0, epsrel=1e-12)[0] for low, high in parts))

    return (
        integral(lambda z: np.pi * square(z)),
        integral(lambda z: np.pi * square(z) * z**2),
        integral(lambda z: 0.5 * np.pi * square(z) ** 2),
    )


def check(body: Body, outer: Moments, inner: Moments, rtol: float = 1e-11) -> None:
    """Compare with the difference of two solids that are symmetric about z = 0."""
    volume, along, across = (one - other for one, other in zip(outer, inner, strict=True))
    assert body.mass == pytest.approx(DENSITY * volume, rel=rtol)
    assert body.axial_inertia == pytest.approx(DENSITY * across, rel=rtol)
    assert body.transverse_inertia == pytest.approx(DENSITY * (along + 0.5 * across), rel=rtol)


def balls(radius: float, separation: float) -> Moments:
    """Two balls, their union where they overlap."""
    half = 0.5 * separation
    first = max(0.0, half - radius)
    volume, along, across = of_slices(lambda z: radius**2 - (z - half) ** 2, [first, half, half + radius])
    return 2.0 * volume, 2.0 * along, 2.0 * across


@pytest.mark.parametrize("separation", [0.0, 0.3, 1.7, 1.95, 3.0])
@pytest.mark.parametrize("wall", [1e-3, 0.1, 0.6])
def test_a_hollow_dumbbell_is_its_balls_less_smaller_ones(separation: float, wall: float) -> None:
    """From overlapping cavities over one hull with two cavities to two shells."""
    body = rs.Dumbbell(radius=2.0, separation=2.0 * separation, density=DENSITY, wall=2.0 * wall)
    check(body, balls(2.0, 2.0 * separation), balls(2.0 - 2.0 * wall, 2.0 * separation))


@pytest.mark.parametrize("two", [0.3, 0.9])
@pytest.mark.parametrize("separation", [0.4, 1.0, 2.5])
def test_a_hollow_dumbbell_of_unequal_balls(two: float, separation: float) -> None:
    """Its centre of mass is that of the wall; a ball thinner than the wall is full."""
    wall = 0.35

    def solid(one: float, two: float) -> tuple[float, float, float, float]:
        # Volume, ∫z, ∫z² and ∫ϱ² dV from the centre of ball 1, ball 2 being at z = -separation.
        def square(z: float) -> float:
            return max(0.0, one**2 - z**2, (two**2 - (z + separation) ** 2) if two > 0.0 else 0.0)

        meets = -(separation**2 + one**2 - two**2) / (2.0 * separation)
        ends = sorted({-one, one, -separation - two, -separation + two, meets})
        ends = [z for z in ends if min(-one, -separation - two) <= z <= one]
        volume, along, across = of_slices(square, ends)
        moment = sum(
            quad(lambda z: np.pi * square(z) * z, low, high, epsabs=1e-13)[0] for low, high in pairwise(ends)
        )
        return volume, float(moment), along, across

    outer, inner = solid(1.0, two), solid(1.0 - wall, two - wall)
    volume, moment, along, across = (a - b for a, b in zip(outer, inner, strict=True))
    centre = moment / volume
    body = rs.Dumbbell(radius=(1.0, two), separation=separation, density=DENSITY, wall=wall)
    assert body.mass == pytest.approx(DENSITY * volume, rel=1e-10)
    assert body.centre_of_mass - 0.5 * separation == pytest.approx(centre, rel=1e-10)
    assert body.axial_inertia == pytest.approx(DENSITY * across, rel=1e-10)
    transverse = along + 0.5 * across - volume * centre**2
    assert body.transverse_inertia == pytest.approx(DENSITY * transverse, rel=1e-10)


@pytest.mark.parametrize("separation", [0.0, 0.5, 4.0])
@pytest.mark.parametrize("wall", [1e-3, 0.1, 0.6])
def test_a_hollow_spherocylinder_is_itself_less_a_thinner_one(separation: float, wall: float) -> None:
    def capsule(radius: float) -> Moments:
        half = 0.5 * separation
        ends = [0.0, half, half + radius]
        parts = of_slices(lambda z: radius**2 - max(0.0, z - half) ** 2, ends)
        volume, along, across = (2.0 * part for part in parts)
        return volume, along, across

    body = rs.Spherocylinder(radius=1.0, separation=separation, density=DENSITY, wall=wall)
    check(body, capsule(1.0), capsule(1.0 - wall))


def test_a_loaded_shell() -> None:
    """The load and a shell with J = 8πϱ(R⁵ - r⁵)/15, by the parallel axis theorem."""
    radius, wall, load, offset = 0.02, 4e-4, 1e-3, 0.015
    body = rs.LoadedSphere(radius=radius, density=DENSITY, load=load, offset=offset, wall=wall)
    inside = radius - wall
    shell = 4.0 / 3.0 * np.pi * DENSITY * (radius**3 - inside**3)
    inertia = 8.0 / 15.0 * np.pi * DENSITY * (radius**5 - inside**5)
    assert body.mass == pytest.approx(shell + load, rel=1e-13)
    assert body.centre_of_mass == pytest.approx(load * offset / (shell + load), rel=1e-13)
    assert body.axial_inertia == pytest.approx(inertia, rel=1e-12)
    assert body.transverse_inertia == pytest.approx(
        inertia + shell * load / (shell + load) * offset**2, rel=1e-12
    )


@pytest.mark.parametrize("axes", [(1.0, 1.02), (1.0, 0.97), (1.0, 3.0), (2.0, 0.5)])
@pytest.mark.parametrize("share", [0.02, 0.3, 0.9])
def test_a_hollow_spheroid_by_the_depth_below_its_surface(axes: tuple[float, float], share: float) -> None:
    """∫dt∫dδ over the wall: the point at the depth δ below that of parameter t, and the area element there.

    Normals end where they meet the longer axis, at which points have two nearest ones on the surface.
    """
    a, c = axes
    wall = share * min(a, c)

    def point(t: float, depth: float) -> tuple[float, float, float]:
        n = np.hypot(np.sin(t) / a, np.cos(t) / c)
        across = np.sin(t) * (a - depth / (a * n))
        along = np.cos(t) * (c - depth / (c * n))
        line = np.hypot(a * np.cos(t), c * np.sin(t))
        curvature = a * c / line**3
        return across, along, 2.0 * np.pi * across * line * (1.0 - curvature * depth)

    def deepest(t: float) -> float:
        return min(wall, min(a, c) ** 2 * float(np.hypot(np.sin(t) / a, np.cos(t) / c)))

    def integral(f: Callable[[float, float], float]) -> float:
        def integrand(depth: float, t: float) -> float:
            across, along, area = point(t, depth)
            return f(across, along) * area

        # Where normals begin to end before the wall does.
        short = min(a, c)
        square = (wall / short**2) ** 2
        cosine = np.clip((square - 1.0 / a**2) / (1.0 / c**2 - 1.0 / a**2), 0.0, 1.0) if a != c else 0.0
        ends = [0.0, float(np.arccos(np.sqrt(cosine))), 0.5 * np.pi]
        parts = pairwise(ends)
        found = (
            dblquad(integrand, low, high, 0.0, deepest, epsabs=0.0, epsrel=1e-10)[0]
            for low, high in parts
            if high > low
        )
        return 2.0 * float(sum(found))

    body = rs.Spheroid(equatorial=a, polar=c, density=DENSITY, wall=wall)
    volume, along, across = (integral(f) for f in (lambda *_: 1.0, lambda _, z: z**2, lambda r, _: r**2))
    check(body, (volume, along, across), (0.0, 0.0, 0.0), rtol=1e-8)


@pytest.mark.parametrize("ratio", [0.1, 0.9, 1.1, 10.0])
@pytest.mark.parametrize("share", [0.01, 0.5])
def test_the_wall_of_a_spheroid_weighs_what_steiner_says(ratio: float, share: float) -> None:
    """V(w) = S w - M w² + 4π w³/3, S being the surface and M the integral of its mean curvature.

    M is the integral of the support function over all directions; w is below the least radius of curvature.
    """
    a, c = 1.0, ratio
    wall = share * min(a**2 / c, c**2 / a)
    mean = quad(lambda x: np.sqrt(a**2 + (c**2 - a**2) * x**2), 0.0, 1.0, epsabs=0.0, epsrel=1e-12)[0]
    if a > c:
        e = np.sqrt(1.0 - c**2 / a**2)
        surface = 2.0 * np.pi * a**2 * (1.0 + (1.0 - e**2) / e * np.arctanh(e))
    else:
        e = np.sqrt(1.0 - a**2 / c**2)
        surface = 2.0 * np.pi * a**2 * (1.0 + c / (a * e) * np.arcsin(e))
    body = rs.Spheroid(equatorial=a, polar=c, density=DENSITY, wall=wall)
    volume = surface * wall - 4.0 * np.pi * mean * wall**2 + 4.0 / 3.0 * np.pi * wall**3
    assert body.mass == pytest.approx(DENSITY * volume, rel=1e-9)


def hollow(kind: Any, wall: float | None, **others: Any) -> Body:
    """A round body of R = 20 mm, and nearly so where it has no shape otherwise."""
    shapes: dict[Any, dict[str, float]] = {
        rs.Dumbbell: {"radius": 0.02, "separation": 0.0},
        rs.LoadedSphere: {"radius": 0.02, "load": 0.0, "offset": 0.0},
        rs.Spherocylinder: {"radius": 0.02, "separation": 0.0},
        rs.Spheroid: {"equatorial": 0.02, "polar": 0.02},
    }
    body: Body = kind(**shapes[kind] | others, density=DENSITY, wall=wall)
    return body


@pytest.mark.parametrize("kind", KINDS)
def test_a_thin_shell_has_two_thirds(kind: type[Body]) -> None:
    """J/(mR²) is 2(1 - s⁵)/(5(1 - s³)) with s = 1 - w/R, 2/3 for a thin wall and 2/5 for none inside."""
    for share in (1e-6, 1e-4, 0.02, 0.5):
        body, s = hollow(kind, share * 0.02), 1.0 - share
        exact = 0.4 * (1.0 + s + s**2 + s**3 + s**4) / (1.0 + s + s**2)
        for moment in (body.transverse_inertia, body.axial_inertia):
            assert moment / (body.mass * 0.02**2) == pytest.approx(exact, rel=1e-14 + 1e-15 / share)
    thin = hollow(kind, 2e-8)
    assert thin.axial_inertia / (thin.mass * 0.02**2) == pytest.approx(2.0 / 3.0, rel=2e-6)
    table_tennis = hollow(kind, 4e-4)
    assert table_tennis.mass == pytest.approx(2.76e-3, rel=1e-2)


@pytest.mark.parametrize("kind", KINDS)
def test_a_wall_as_thick_as_the_body_leaves_it_full(kind: Any) -> None:
    """The same bits of the body and of every impact."""
    full = kind.example(density=DENSITY)
    thickest: dict[Any, float] = {
        rs.Spheroid: min(getattr(full, name, np.inf) for name in ("equatorial", "polar"))
    }
    filled = kind.example(density=DENSITY, wall=thickest.get(kind, getattr(full, "radius", None)))
    assert (filled.mass, filled.transverse_inertia, filled.axial_inertia) == (
        full.mass,
        full.transverse_inertia,
        full.axial_inertia,
    )
    runs = [rs.simulate(body, LAW, particles=20, impacts=10) for body in (full, filled)]
    assert runs[0].drop_attrs().equals(runs[1].drop_attrs())


@pytest.mark.parametrize("kind", KINDS)
def test_only_mass_and_inertia_are_those_of_the_wall(kind: type[Body]) -> None:
    """At the first impact from rest ε = ε_n - (1 + ε_n) k/(1 + k), k = m d²/J, d the lever arm."""
    full = kind.example()
    angle = 0.7
    for body in (full, kind.example(wall=3e-4), kind.example(inertia=(1.3e-9, 1.1e-9))):
        run = rs.simulate(body, LAW, particles=1, impacts=1, orientation=[angle], release_height=0.1)
        step = 1e-6
        up, down = (body.compiled.lowest(np.cos([angle + s])) for s in (step, -step))
        k = body.mass * ((up - down) / (2.0 * step)) ** 2 / body.transverse_inertia
        expected = 0.9 - 1.9 * k / (1.0 + k)
        assert float(run.restitution[0, 0]) == pytest.approx(expected, rel=1e-7)


def test_given_moments_take_the_place_of_those_of_the_matter() -> None:
    full = rs.Dumbbell(radius=3e-3, separation=3e-4)
    own = (full.transverse_inertia, full.axial_inertia)
    given = rs.Dumbbell(radius=3e-3, separation=3e-4, inertia=own)
    assert (given.transverse_inertia, given.axial_inertia, given.mass) == (*own, full.mass)
    one = rs.Dumbbell(radius=3e-3, separation=3e-4, inertia=own[0])
    assert one.axial_inertia == one.transverse_inertia == own[0]
    runs = [
        rs.simulate(body, LAW, particles=5, impacts=3, spin=(3.0, 2.0, 1.0), release_height=0.05)
        for body in (full, given)
    ]
    np.testing.assert_allclose(runs[0].restitution, runs[1].restitution, rtol=1e-11)


SIZE = {"radius": 3e-3, "separation": 3e-4}


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"wall": 0.0}, r"^wall = 0.0: must be a finite number > 0 \(m\), or None$"),
        ({"wall": -1e-4}, r"^wall = -0.0001"),
        ({"wall": np.nan}, r"^wall = nan"),
        ({"wall": "thin"}, r"^wall = 'thin'"),
        ({"wall": 4e-3}, r"^wall = 0.004, radius = 0.003: must be at most the larger radius \(m\)$"),
        ({"wall": 1e-9}, r"^wall = 1e-09.*: must be at least 1e-6 of the longest radius"),
        ({"inertia": (1e-9, 0.0)}, r"^inertia\[1\] = 0.0: must be a finite number > 0"),
        ({"inertia": (1e-9, 2.1e-9)}, r"^inertia = \(1e-09, 2.1e-09\).*must be about the axis at most twice"),
        ({"inertia": (1.0, 1.0)}, r"^inertia = \(1.0, 1.0\).*: must be so small that the matter"),
        ({"inertia": (1e-9, 1e-9, 1e-9)}, r"^inertia = .*: must be \(transverse, axial\), each > 0 in kg m²"),
        ({"inertia": "large"}, r"^inertia = 'large'"),
        (
            {"inertia": (1e-9, 1e-9), "wall": 1e-4},
            r"^inertia = \(1e-09, 1e-09\), wall = 0.0001: must be left out where there is a wall$",
        ),
        (
            {"radius": (3e-3, 2e-3), "density": (1e3, 2e3), "wall": 1e-4},
            r"^wall = 0.0001.*: must be left out where both radius and density differ",
        ),
    ],
)
def test_what_no_body_has_is_refused(given: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        rs.Dumbbell(**SIZE | given)


def test_walls_are_refused_in_terms_of_each_body() -> None:
    for kind in KINDS:
        with pytest.raises(ValueError, match=r"^wall = 1.0"):
            kind.example(wall=1.0)
        with pytest.raises(ValueError, match=r"^inertia = \(1e-09, 1e-09\), wall = 0.0001"):
            kind.example(wall=1e-4, inertia=(1e-9, 1e-9))


@pytest.mark.parametrize("given", [{"wall": 3e-4}, {"inertia": (1.3e-9, 1.1e-9)}, {}])
def test_files_and_datasets_hold_what_is_given(given: dict[str, Any], tmp_path: Path) -> None:
    """As a parameter file, in the attributes of a run, and in the body that is drawn from it."""
    body = rs.Dumbbell(**SIZE, **given)
    lines = [f"{name} = {list(v) if isinstance(v, tuple) else v}" for name, v in given.items()]
    path = tmp_path / "run.toml"
    head = ["[body]", 'shape = "dumbbell"', "radius = 3e-3", "separation = 3e-4", *lines]
    path.write_text("\n".join([*head, "[law]", 'type = "frictionless"', "normal = 0.9"]), encoding="utf-8")
    assert read(path).body == body
    written = {name: list(v) if isinstance(v, tuple) else v for name, v in given.items()}
    assert table_of(body) == {"shape": "dumbbell", **SIZE, "density": 2500.0, **written}
    rs.simulate(body, LAW, particles=2, impacts=2, record="state").to_netcdf(tmp_path / "run.nc")
    with xr.open_dataset(tmp_path / "run.nc") as data:
        for name in ("wall", "inertia"):
            np.testing.assert_array_equal(data.attrs.get(name, ()), given.get(name, ()))
        rs.figures.impact(data, particle=0, impact=1)
    for name in ("wall", "inertia"):
        assert (f"{name}=" in repr(body)) == (name in given)
        assert (f">{name}<" in body._repr_html_()) == (name in given)


def test_every_way_to_count_takes_a_hollow_body() -> None:
    """The bins, the comparison and the learned distribution are those of its impacts."""
    full, shell = (rs.Dumbbell(**SIZE, wall=wall) for wall in (None, 1e-4))
    bins: dict[str, Any] = {"velocity_bins": [0.4, 0.8], "restitution_bins": [-2.0, 0.0, 0.9, 3.0]}
    run: dict[str, Any] = {"particles": 400, "impacts": 5}
    counted = rs.statistics(shell, LAW, **bins, **run)
    recorded = rs.simulate(shell, LAW, **run)
    assert counted.attrs["wall"] == 1e-4
    assert int(counted.restitution_count.sum()) == int(rs.reduce(recorded, **bins).restitution_count.sum())
    compared = rs.compare({"full": full, "shell": shell}, [LAW], **bins, **run)
    np.testing.assert_array_equal(compared.wall, [np.nan, 1e-4])
    assert compared.wall.attrs["units"] == "m"
    np.testing.assert_array_equal(compared.restitution_count.isel(law=0, body=1), counted.restitution_count)
    learned = rs.FluctuatingRestitution.learn(shell, LAW, particles=2000, velocities=(0.3, 0.9))
    assert learned.data.attrs["wall"] == 1e-4


def test_the_explorer_refuses_what_it_does_not_show() -> None:
    from restitution.explorer import link

    for given in ({"wall": 1e-4}, {"inertia": (1.3e-9, 1.1e-9)}):
        name = next(iter(given))
        with pytest.raises(
            ValueError, match=rf"^body.{name} = .*: the explorer shows this only if it is left"
        ):
            link(Run(body=rs.Dumbbell(**SIZE, **given), law=LAW))
