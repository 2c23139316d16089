"""Disc arithmetic encloses, panels keep away from poles, and what is found on them is all there is."""

import itertools
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import restitution as rs
from restitution.analytic import first_impact
from restitution.analytic._disc import Disc, turned
from restitution.analytic._panels import nodes, panels, roots, solve

# Numbers without a full set of digits round by an absolute error, which no disc allows for.
unit = st.floats(0, 1, allow_subnormal=False)
finite = st.floats(-3, 3, allow_subnormal=False)


def disc(centre: float, radius: float) -> Disc:
    return Disc(np.array([centre]), np.array([radius]))


FORMULAS: dict[str, Any] = {
    "sum": lambda x, y: 2.0 - x + 0.5 * y - 1.0,
    "product": lambda x, y: x * y * 3.0,
    "quotient": lambda x, y: (1.0 + x) / (y + 0.1),
    "inverse": lambda x, y: 0.7 / (x * x + y / 4.0),
    "root": lambda x, y: (x * x + y * y + 1.0) ** 0.5,
    "power": lambda x, y: (x + 3.5) ** -0.3 * (y + 4.0) ** 0.05,
    "angle": lambda x, y: turned(x)[0] / (2.0 + turned(y)[1]),
}


@pytest.mark.parametrize("name", FORMULAS)
@settings(max_examples=40)
@given(
    centres=st.tuples(finite, finite),
    radii=st.tuples(unit, unit),
    points=st.lists(st.tuples(unit, unit, unit, unit), min_size=1, max_size=10),
)
def test_discs_hold_every_value(name: str, centres: Any, radii: Any, points: Any) -> None:
    """Whatever points of both discs: the value is in the disc of the values, or that is unbounded."""
    formula = FORMULAS[name]
    with np.errstate(all="ignore"):
        image = formula(disc(centres[0], radii[0]), disc(centres[1], radii[1]))
        for size, turn, other, twist in points:
            x = centres[0] + radii[0] * size * np.exp(2j * np.pi * turn)
            y = centres[1] + radii[1] * other * np.exp(2j * np.pi * twist)
            value = np.complex128(formula(x, y))
            if np.isfinite(image.bound[0]):
                distance = abs(value - image.centre[0])
                assert distance <= image.radius[0] * (1 + 1e-12) + 1e-13 * image.bound[0]


def test_the_bound_of_a_disc_is_its_farthest_point() -> None:
    """Infinite where nothing is known."""
    discs = Disc(np.array([-2.0, 1.0, 3.0, np.nan]), np.array([0.5, 2.0, np.inf, 1.0]))
    assert discs.bound.tolist() == [2.5, 3.0, np.inf, np.inf]


@pytest.mark.parametrize("gap", [1.0, 1e-2, 1e-5])
def test_panels_shrink_towards_a_pole(gap: float) -> None:
    """1/(x² + d²): no panel's disc holds the pole, and Gauss sums have all digits of 2 arctan(1/d)/d."""
    edges = panels(lambda x: 1.0 / (x * x + gap * gap), -1.0, 1.0)
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    assert np.all(np.hypot(middle, gap) > 2 * half)
    x, weights = nodes(edges, 1)
    assert weights @ (1 / (x * x + gap * gap)) == pytest.approx(2 * np.arctan(1 / gap) / gap, rel=4e-15)
    assert len(edges) < 80


def test_a_constant_needs_one_panel() -> None:
    """A formula that does not depend on the angle gives a plain number for discs, too."""
    assert panels(lambda x: -3.0, 0.0, 1.0).tolist() == [0.0, 1.0]


def test_a_singularity_on_the_interval_is_refused() -> None:
    with pytest.raises(ArithmeticError, match="no bound on the function near"):
        panels(lambda x: x**0.5 * 1.0, 0.0, 1.0)


def test_roots_and_extremes_are_all_found() -> None:
    """Of a function with many, some close together: sin(x)(x - 1)(x - 1.001)/(x² + 0.01)."""

    def function(x: Any) -> Any:
        return turned(x)[0] * (x - 1.0) * (x - 1.001) / (x * x + 0.01)

    found = roots(function, -10.0, 10.0)
    expected = sorted([*(n * np.pi for n in range(-3, 4)), 1.0, 1.001])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-10)
    turning = roots(function, -10.0, 10.0, derivative=True)
    assert all(any(low < t < high for t in turning) for low, high in itertools.pairwise(found))
    values = function(np.array([-10.0, *turning, 10.0]))
    assert np.all(np.diff(values)[:-1] * np.diff(values)[1:] < 0)  # maxima and minima take turns


@given(values=st.lists(st.floats(1e-3, 0.999), min_size=1, max_size=20))
def test_many_equations_are_solved_at_once(values: list[float]) -> None:
    wanted = np.array(values)
    low, high = np.zeros(wanted.size), np.full(wanted.size, np.pi / 2)
    found = solve(lambda x: np.cos(x) - wanted, low, high)
    np.testing.assert_allclose(found, np.arccos(wanted), rtol=0, atol=2e-15)


@pytest.mark.parametrize(
    ("function", "root"),
    [
        (lambda x: np.cos(x) - 0.3, np.arccos(0.3)),
        (lambda x: np.exp(x) - 2.0, np.log(2.0)),
        (lambda x: x**9 - 1e-3, 1e-3 ** (1 / 9)),
        (lambda x: np.tanh(20.0 * (x - 0.3)), 0.3),
    ],
)
def test_a_root_takes_a_dozen_evaluations(function: Any, root: float) -> None:
    """Where bisection alone takes fifty."""
    asked: list[float] = []

    def watched(x: Any) -> Any:
        asked.append(float(x[0]))
        return function(x)

    found = solve(watched, np.zeros(1), np.full(1, np.pi / 2))
    assert float(found[0]) == pytest.approx(root, rel=4e-15)
    assert len(asked) <= 14


@pytest.mark.parametrize(
    ("body", "law"),
    [
        (rs.Spheroid(equatorial=1.0, polar=1000.0), rs.Frictionless(normal=0.9)),
        (rs.Spheroid(equatorial=1000.0, polar=1.0), rs.TangentialRestitution(normal=0.4)),
        (rs.Spheroid(equatorial=1.0, polar=30.0), rs.ChatterjeeRuina(normal=0.2, tangential=1, friction=0.1)),
        (rs.Dumbbell(radius=(1.0, 0.3), separation=5.0), rs.Coulomb(normal=0.4, friction=0.3)),
        (rs.Spherocylinder(radius=1.0, separation=100.0), rs.Coulomb(normal=0.4, friction=1e100)),
    ],
    ids=["needle", "disc", "rod", "club", "stick"],
)
def test_branches_rise_or_fall_and_miss_nothing(body: Any, law: Any) -> None:
    """A million angles in order: ε is monotone on each branch, and the branches meet end to end."""
    curve = first_impact(body, law)._curve  # type: ignore[attr-defined]
    branches = curve.branches
    assert branches[0].low == 0.0
    assert branches[-1].high == curve.limit
    for one, two in itertools.pairwise(branches):
        assert one.high == two.low
    for branch in branches:
        # Most points near the ends, where an extreme might have been missed.
        u = np.linspace(0, 1, 1_000_000 // len(branches))
        value = branch.piece.restitution(branch.low + (branch.high - branch.low) * u * u * (3 - 2 * u))
        steps = np.diff(value) * np.sign(branch.last - branch.first)
        assert steps.min() > -1e-13  # a needle's contact is rounded a thousandfold


SHAPES = st.one_of(
    st.builds(
        lambda k: rs.Spheroid(equatorial=1.0, polar=10**k),
        st.floats(-3, 3).filter(lambda k: abs(k) > 1e-3),
    ),
    st.builds(
        lambda r, x, d: rs.Dumbbell(radius=(1.0, 10**r), separation=10**x, density=(1.0, 10**d)),
        st.floats(-1, 1),
        st.floats(-1, 2),
        st.floats(-1, 1),
    ),
    st.builds(lambda x: rs.Spherocylinder(radius=1.0, separation=10**x), st.floats(-1, 3)),
    st.builds(
        lambda m, d: rs.LoadedSphere(radius=1.0, density=1.0, load=10**m, offset=d),
        st.floats(-1, 2),
        st.floats(0.05, 1),
    ),
)
NORMALS = st.one_of(
    st.floats(0, 1),
    st.builds(lambda x: rs.Plastic(yield_speed=10**x), st.floats(-2, 1)),
    st.builds(
        lambda x: rs.Viscoelastic(
            young_modulus=1e7, poisson_ratio=0.3, dissipation=10**x, density=1e3, radius=0.01
        ),
        st.floats(-6, -2),
    ),
    st.builds(
        lambda e: rs.Tabulated(v=[0.1, 1.0, 3.0, 4.5, 6.0, 9.0], e=e), st.lists(unit, min_size=6, max_size=6)
    ),
)
FRICTION = st.floats(-2, 1).map(lambda x: 10**x)


@settings(max_examples=30)
@given(
    body=SHAPES,
    normal=NORMALS,
    friction=FRICTION,
    tangential=st.floats(-1, 1),
    kind=st.sampled_from(["paper", "free", "coulomb", "ruina"]),
    above=st.floats(0.001, 3),
    orientation=st.sampled_from(["uniform-angle", "isotropic"]),
)
def test_no_branch_is_missed_whatever_the_body_and_the_law(
    body: Any, normal: Any, friction: float, tangential: float, kind: str, above: float, orientation: Any
) -> None:
    """Angles at equal steps of probability: their share below any ε is off by a step a branch, and one.

    So is the mean, by as many steps times the range of ε.
    """
    make: dict[str, Any] = {
        "paper": lambda: rs.TangentialRestitution(normal=normal),
        "free": lambda: rs.Frictionless(normal=normal),
        "coulomb": lambda: rs.Coulomb(normal=normal, friction=friction),
        "ruina": lambda: rs.ChatterjeeRuina(normal=normal, tangential=tangential, friction=friction),
    }
    law = make[kind]()
    height = body.compiled.farthest() * (1 + above)
    fall = {} if isinstance(normal, float) else {"release_height": height, "gravity": 9.81}
    try:
        distribution: Any = first_impact(body, law, orientation, **fall)
    except ValueError as error:
        assume("varies by 1e-09 at least" not in str(error) and "a sphere has no" not in str(error))
        raise
    if not hasattr(distribution, "_curve"):
        return
    count = 2000
    share = (np.arange(count) + 0.5) / count
    sample = np.sort(distribution._curve.restitution(distribution._tilt.quantile(share)))
    below = distribution.cdf(sample)
    most = (len(distribution._curve.branches) + 1) / count
    # Where ε is nearly constant, a rounding of it is as much as a share.
    loose = distribution.cdf(sample + 1e-14) - distribution.cdf(sample - 1e-14)
    assert np.all(np.abs(below - (np.arange(count) + 0.5) / count) <= most + loose)
    assert distribution.moment(0) == pytest.approx(1, abs=1e-13)
    low, high = distribution.support()
    assert distribution.mean() == pytest.approx(float(np.mean(sample)), abs=(high - low) * most + 1e-14)
