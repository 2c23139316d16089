"""Mass, centre and inertia of every shape by integrals over its slices, and limits that must coincide."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import restitution as rs
from restitution.bodies import Body

NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
"""Exact for the polynomials of degree ≤ 4 that the integrands are."""

Slice = tuple[float, float, Callable[[float], float], float]
"""From z to z, the squared radius at z, the density there."""


class Properties(NamedTuple):
    """Of a body of revolution, the centre of mass from the origin of its slices."""

    mass: float
    centre: float
    transverse: float
    axial: float


def integrated(slices: Sequence[Slice], load: tuple[float, float] = (0.0, 0.0)) -> Properties:
    """Add up discs of squared radius r²: dm = ρπr²dz, dJ_zz = r²/2 dm, dJ_xx = (r²/4 + (z − centre)²) dm."""
    points, masses, squares = [load[1]], [load[0]], [0.0]
    for low, high, square, density in slices:
        z = 0.5 * (low + high) + 0.5 * (high - low) * NODES
        r2 = np.array([square(float(x)) for x in z])
        points += z.tolist()
        masses += (density * np.pi * r2 * WEIGHTS * 0.5 * (high - low)).tolist()
        squares += r2.tolist()
    z, m, r2 = np.array(points), np.array(masses), np.array(squares)
    mass = float(m.sum())
    centre = float(m @ z) / mass
    return Properties(mass, centre, float(m @ (r2 / 4 + (z - centre) ** 2)), float(m @ r2) / 2)


def sphere(centre: float, radius: float) -> Callable[[float], float]:
    """Squared radius of the slices of a sphere."""
    return lambda z: radius**2 - (z - centre) ** 2


def check(body: Body, expected: Properties, origin: float = 0.0, rtol: float = 1e-13) -> None:
    """A dozen roundings, and a few more where a small difference of the centres counts."""
    size = np.sqrt(expected.transverse / expected.mass)
    assert body.mass == pytest.approx(expected.mass, rel=rtol)
    assert body.transverse_inertia == pytest.approx(expected.transverse, rel=rtol)
    assert body.axial_inertia == pytest.approx(expected.axial, rel=rtol)
    centre = body.compiled.centre_of_mass + origin
    assert centre == pytest.approx(expected.centre, rel=rtol, abs=rtol * size)


def dumbbell_slices(body: rs.Dumbbell) -> list[Slice]:
    """Sphere 1 around 0, sphere 2 around −L; overlapping ones end where their outlines cross."""
    (one, two), (dense, other), length = body.radii, body.densities, body.separation
    if length <= abs(one - two):
        centre, radius, density = (0.0, one, dense) if one > two else (-length, two, other)
        return [(centre - radius, centre + radius, sphere(centre, radius), density)]
    cut = -(length**2 + one**2 - two**2) / (2 * length)  # where one² − z² = two² − (z + L)²
    low, high = (cut, cut) if length < one + two else (-one, two - length)
    return [
        (low, one, sphere(0.0, one), dense),
        (-length - two, high, sphere(-length, two), other),
    ]


ratio = st.floats(0.05, 20.0)


@given(two=ratio, density=ratio, distance=st.floats(0.0, 1.5), size=st.floats(1e-6, 1e3))
def test_unequal_dumbbell(two: float, density: float, distance: float, size: float) -> None:
    """From one sphere within the other over overlapping to separate ones."""
    body = rs.Dumbbell(
        radius=(size, size * two),
        separation=distance * size * (1 + two),
        density=(2500.0, 2500.0 * density),
    )
    # A cap that is just cut off is a difference of large numbers, here and in the integrals.
    check(body, integrated(dumbbell_slices(body)), -0.5 * body.separation, rtol=1e-11)


@given(elongation=st.floats(1e-6, 3.0))
def test_equal_spheres_by_the_formulas_of_unequal_ones(elongation: float) -> None:
    """(A3), (A5) and (A8) are what the two sides add up to; nearly equal spheres are close to equal ones."""
    body = rs.Dumbbell(radius=2.0, separation=2.0 * elongation, density=3.0)
    check(body, integrated(dumbbell_slices(body)), -elongation)
    nearly = rs.Dumbbell(radius=(2.0, 2.0 * (1 + 2**-52)), separation=2.0 * elongation, density=3.0)
    assert nearly.mass == pytest.approx(body.mass, rel=1e-9)
    assert nearly.transverse_inertia == pytest.approx(body.transverse_inertia, rel=1e-9)


def test_an_equal_pair_is_the_papers_dumbbell() -> None:
    """The same bits, in the body and in every impact."""
    one = rs.Dumbbell(radius=3e-3, separation=1e-3, density=2500.0)
    pair = rs.Dumbbell(radius=(3e-3, 3e-3), separation=1e-3, density=(2500.0, 2500.0))
    assert (one.mass, one.transverse_inertia, one.axial_inertia) == (
        pair.mass,
        pair.transverse_inertia,
        pair.axial_inertia,
    )
    assert one.is_equal
    assert pair.is_equal
    law = rs.TangentialRestitution(normal=0.9, tangential=0.5)
    runs = [rs.simulate(body, law, particles=20, impacts=30) for body in (one, pair)]
    assert runs[0].equals(runs[1])


@pytest.mark.parametrize("two", [0.3, 1.0, 2.5])
@pytest.mark.parametrize("density", [0.1, 1.0, 10.0])
def test_nothing_jumps_where_the_cases_of_a_dumbbell_meet(two: float, density: float) -> None:
    """At touching, and where one sphere disappears in the other."""

    def numbers(length: float) -> list[float]:
        body = rs.Dumbbell(radius=(1.0, two), separation=length, density=(1.0, density))
        # From the centre of the larger sphere.
        larger = 0.5 * length if two <= 1 else -0.5 * length
        return [body.mass, body.transverse_inertia, body.axial_inertia, body.centre_of_mass - larger]

    meetings = [1 + two] + ([abs(1 - two)] if two != 1 else [])
    for length in meetings:
        np.testing.assert_allclose(numbers(length * (1 - 1e-12)), numbers(length * (1 + 1e-12)), atol=1e-10)


def test_equal_spheres_in_one_place_are_two_halves() -> None:
    """Of different densities: the limit of short distances, with the centre of mass off the centre."""
    body = rs.Dumbbell(radius=2.0, separation=0.0, density=(1.0, 3.0))
    check(body, integrated([(0.0, 2.0, sphere(0.0, 2.0), 1.0), (-2.0, 0.0, sphere(0.0, 2.0), 3.0)]))
    # Both hulls are round: the flights end alike.
    law = rs.TangentialRestitution(normal=0.8)
    near = rs.Dumbbell(radius=2.0, separation=1e-12, density=(1.0, 3.0))
    runs = [rs.simulate(b, law, particles=50, impacts=2, release_height=9.0) for b in (body, near)]
    np.testing.assert_allclose(runs[0].time, runs[1].time, rtol=1e-10)
    assert set(runs[0].contact.to_numpy().ravel()) == {1}


@given(load=st.floats(0.0, 1e3), offset=st.floats(0.0, 1.0))
def test_loaded_sphere(load: float, offset: float) -> None:
    """The load in units of the sphere's mass."""
    mass = 2500.0 * 4 / 3 * np.pi * 2e-3**3
    body = rs.LoadedSphere(radius=2e-3, density=2500.0, load=load * mass, offset=offset * 2e-3)
    expected = integrated([(-2e-3, 2e-3, sphere(0.0, 2e-3), 2500.0)], load=(body.load, body.offset))
    check(body, expected)
    assert 0 <= body.centre_of_mass <= body.offset


@given(elongation=st.floats(0.0, 100.0))
def test_spherocylinder(elongation: float) -> None:
    radius, half = 2e-3, 1e-3 * elongation
    body = rs.Spherocylinder(radius=radius, separation=2 * half, density=7800.0)
    slices: list[Slice] = [
        (-half, half, lambda _: radius**2, 7800.0),
        (half, half + radius, sphere(half, radius), 7800.0),
        (-half - radius, -half, sphere(-half, radius), 7800.0),
    ]
    check(body, integrated(slices))
    assert body.elongation == pytest.approx(elongation, rel=1e-15)


@given(aspect=st.floats(1e-3, 1e3))
def test_spheroid(aspect: float) -> None:
    a, c = 2e-3, 2e-3 * aspect
    body = rs.Spheroid(equatorial=a, polar=min(c, 1000 * a), density=900.0)
    check(body, integrated([(-c, c, lambda z: a**2 * (1 - z / c) * (1 + z / c), 900.0)]))


def test_shapes_that_are_spheres() -> None:
    """All have the mass and the inertia of a sphere, and bounce like one: ε is ε_n, and nothing turns."""
    shapes: list[Body] = [
        rs.Dumbbell(radius=3e-3, separation=0.0),
        rs.Dumbbell(radius=(3e-3, 1e-3), separation=1e-3),
        rs.LoadedSphere(radius=3e-3, load=0.0, offset=2e-3),
        rs.LoadedSphere(radius=3e-3, load=0.0, offset=0.0),
        rs.Spherocylinder(radius=3e-3, separation=0.0),
        rs.Spheroid(equatorial=3e-3, polar=3e-3),
    ]
    mass = 2500 * 4 / 3 * np.pi * 3e-3**3
    law = rs.TangentialRestitution(normal=0.8, tangential=0.3)
    for body in shapes:
        assert body.mass == pytest.approx(mass, rel=1e-14)
        assert body.transverse_inertia == pytest.approx(0.4 * mass * 3e-3**2, rel=1e-14)
        assert body.axial_inertia == pytest.approx(0.4 * mass * 3e-3**2, rel=1e-14)
        data = rs.simulate(body, law, particles=20, impacts=20)
        np.testing.assert_allclose(data.restitution, 0.8, rtol=1e-14)
        assert not data.rotational_fraction.any()


def test_small_changes_of_shape_are_small() -> None:
    """A light load, a short cylinder, nearly equal axes: first impacts differ from ε_n in proportion."""
    law = rs.TangentialRestitution(normal=0.8)
    shapes: dict[str, Callable[[float], Body]] = {
        "load": lambda x: rs.LoadedSphere(radius=3e-3, load=x * 2.8e-4, offset=3e-3),
        "cylinder": lambda x: rs.Spherocylinder(radius=3e-3, separation=x * 3e-3),
        "prolate": lambda x: rs.Spheroid(equatorial=3e-3, polar=(1 + x) * 3e-3),
        "oblate": lambda x: rs.Spheroid(equatorial=3e-3, polar=(1 - x) * 3e-3),
    }
    for make in shapes.values():
        losses = []
        for x in (1e-3, 1e-4):
            data = rs.simulate(make(x), law, particles=200, impacts=1)
            losses.append(float((0.8 - data.restitution).max()))
        # ε_n − ε goes with the square of the distance of the normal from the centre of mass.
        assert 0 < losses[0] < 1e-5
        assert losses[1] == pytest.approx(losses[0] / 100, rel=0.1)


def test_a_body_whose_mass_overflows_names_all_that_is_given() -> None:
    told = r"^radius = 1e-200, separation = 1e\+100, density = 2500\.0: must be such that mass and inertia"
    with pytest.raises(ValueError, match=told):
        rs.Dumbbell(radius=1e-200, separation=1e100)


def test_spheres_are_equal_in_radius_and_density() -> None:
    for radius, density, equal in (
        ((3e-3, 3e-3), (2e3, 2e3), True),
        ((3e-3, 3e-3), (2e3, 1e3), False),
        ((3e-3, 2e-3), (2e3, 2e3), False),
        (3e-3, (2e3, 2e3), True),
        (3e-3, 2e3, True),
    ):
        assert rs.Dumbbell(radius=radius, separation=1e-3, density=density).is_equal is equal


@pytest.mark.parametrize("pair", [(3e-3, 2e-3), [3e-3, 2e-3], np.array([3e-3, 2e-3])], ids=type)
def test_a_pair_in_any_form(pair: Any) -> None:
    assert rs.Dumbbell(radius=pair, separation=1e-3).radii == (3e-3, 2e-3)


@pytest.mark.parametrize(
    ("radius", "told"),
    [
        ("a", r"^radius = 'a': must be a finite number > 0 \(or one for each sphere\)$"),
        (True, r"^radius = True: must be a finite number > 0 \(or"),
        (0.0, r"^radius = 0\.0: must be a finite number > 0 \(or"),
        ((1e-3, 2e-3, 3e-3), r"^radius = \(0\.001, 0\.002, 0\.003\): must be"),
        ((3e-3, True), r"^radius\[1\] = True: must be a finite number > 0$"),
        (("a", 3e-3), r"^radius\[0\] = 'a': must be a finite number > 0$"),
        ((-1.0, np.inf), r"radius\[0\] = -1\.0: must be .*\n?.*radius\[1\] = inf: must be"),
    ],
)
def test_what_is_no_pair(radius: Any, told: str) -> None:
    """The argument, or which of the two, with its value and what is allowed."""
    with pytest.raises(ValueError, match=told):
        rs.Dumbbell(radius=radius, separation=1e-3)


def test_a_body_shows_mass_and_moments_of_inertia_in_si_units() -> None:
    """A sphere of water, at which the two moments are 2mR²/5; its parameters come first."""
    body = rs.Spheroid(equatorial=0.1, polar=0.1, density=1e3)
    mass = 1e3 * 4.0 / 3.0 * np.pi * 1e-3
    moment = f"{0.4 * mass * 1e-2:.6g} kg m²"
    assert list(body._rows()) == [
        ("equatorial", "0.1 m"),
        ("polar", "0.1 m"),
        ("density", "1000 kg/m³"),
        ("mass", f"{mass:.6g} kg"),
        ("transverse_inertia", moment),
        ("axial_inertia", moment),
    ]


def test_elongation_is_in_units_of_the_radius() -> None:
    assert rs.Dumbbell(radius=2.0, separation=3.0).elongation == 1.5
    assert rs.Spherocylinder(radius=2.0, separation=3.0).elongation == 1.5
