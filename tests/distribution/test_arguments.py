"""Arguments of a distribution's methods that do not fit each other, or NumPy, or the integral."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import restitution as rs
from restitution._internal.parameters import ParameterError

BODY, LAW = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
FIRST: list[rs.analytic.FirstImpact] = [
    rs.analytic.first_impact(rs.Dumbbell(radius=3e-3, separation=6e-3), rs.TangentialRestitution(normal=0.4)),
    rs.analytic.first_impact(rs.Spheroid(equatorial=3e-3, polar=4e-3), rs.Coulomb(normal=0.9, friction=0.2)),
]
BROADCAST = "must broadcast to one shape$"


@pytest.fixture(scope="module")
def learned() -> rs.FluctuatingRestitution:
    return rs.FluctuatingRestitution.learn(
        BODY, LAW, particles=3000, velocities=(0.5, 0.8), given="rotational_fraction"
    )


@pytest.mark.parametrize(
    ("method", "name"),
    [
        *((method, "x") for method in ("pdf", "logpdf", "cdf", "logcdf", "sf", "logsf")),
        *(("ppf", "q"), ("isf", "q"), ("interval", "confidence")),
    ],
)
def test_shapes_that_do_not_broadcast(learned: rs.FluctuatingRestitution, method: str, name: str) -> None:
    """The arguments are named with their shapes; what has no dimension fits all."""
    call = getattr(learned, method)
    with pytest.raises(
        ParameterError, match=rf"^{name}, v: {name} of shape \(3,\), v of shape \(2,\); {BROADCAST}"
    ):
        call([0.1, 0.2, 0.3], [0.6, 0.7])
    shapes = rf"{name} of shape \(4,\), v of shape \(2,\), given of shape \(2,\)"
    with pytest.raises(ParameterError, match=rf"^{name}, v, given: {shapes}; {BROADCAST}"):
        call([0.1] * 4, [0.6, 0.7], [0.01, 0.02])
    with pytest.raises(
        ParameterError, match=rf"^v, given: v of shape \(2,\), given of shape \(3,\); {BROADCAST}"
    ):
        call(0.5, [0.6, 0.7], [0.01, 0.02, 0.03])


@pytest.mark.parametrize(
    "call",
    [
        *(
            lambda dist, *at, name=name: getattr(dist, name)(*at)
            for name in ("median", "support", "mean", "var", "std", "stats", "entropy")
        ),
        lambda dist, *at: dist.moment(2, *at),
        lambda dist, *at: dist.expect(None, *at),
        lambda dist, v, z: dist.rvs(v, given=z),
    ],
)
def test_speeds_and_conditions_that_do_not_broadcast(
    learned: rs.FluctuatingRestitution, call: Callable[..., Any]
) -> None:
    with pytest.raises(
        ParameterError, match=rf"^v, given: v of shape \(2,\), given of shape \(3,\); {BROADCAST}"
    ):
        call(learned, [0.6, 0.7], [0.01, 0.02, 0.03])


def test_the_entropy_of_nan_is_nan(learned: rs.FluctuatingRestitution) -> None:
    """As all other methods have it; the other elements are what they are alone."""
    found = learned.entropy([0.7, np.nan])
    assert found[0] == learned.entropy(0.7)
    assert math.isnan(found[1])
    assert math.isnan(learned.entropy(np.nan))
    assert math.isnan(learned.entropy(0.7, np.nan))


def _draws(learned: rs.FluctuatingRestitution) -> list[Callable[..., Any]]:
    return [lambda **size: learned.rvs(0.7, **size), *(one.rvs for one in FIRST)]


@pytest.mark.parametrize("size", [(2**40, 2**40), (2**31, 2**32, 3), 2**62])
def test_more_draws_than_memory(learned: rs.FluctuatingRestitution, size: Any) -> None:
    """However large the shape: also where NumPy has no arrays of so many elements."""
    for draw in _draws(learned):
        with pytest.raises(ParameterError, match=r"^size = .*: must be at most .* draws, which this process"):
            draw(size=size)


def test_no_draws_of_a_large_shape(learned: rs.FluctuatingRestitution) -> None:
    for draw in _draws(learned):
        assert draw(size=(10**12, 0)).shape == (10**12, 0)


def test_a_size_that_speeds_do_not_broadcast_to(learned: rs.FluctuatingRestitution) -> None:
    speeds = [0.6, 0.7, 0.75]
    for size in [(2,), (3, 2), (0,), ()]:
        with pytest.raises(ParameterError, match=r"^size = .*: must be a shape that \(3,\) broadcasts to"):
            learned.rvs(speeds, size=size)
    assert learned.rvs(speeds, size=(2, 3)).shape == (2, 3)
    assert learned.rvs([0.6], size=0).shape == (0,)


def test_no_restitution_between_bounds(learned: rs.FluctuatingRestitution) -> None:
    """A mean over nothing is NaN, silently, as for the first impact; no value of the function is needed."""
    nothing: dict[str, Any] = {"lb": 5.0, "ub": 6.0}
    for given in (nothing, {"lb": np.inf}, {"ub": -np.inf}, {"lb": 0.98, "ub": 0.98}):
        assert math.isnan(learned.expect(None, 0.7, conditional=True, **given))
        assert learned.expect(None, 0.7, **given) == 0.0
    found = learned.expect(None, [0.6, np.nan], conditional=True, **nothing)
    assert np.isnan(found).all()
    assert learned.expect(lambda x: math.sqrt(4.0 - x), 0.7, **nothing) == 0.0
    for first in FIRST:
        assert math.isnan(first.expect(conditional=True, **nothing))


def test_bounds_that_go_down(learned: rs.FluctuatingRestitution) -> None:
    """No ε is at least 2 and at most 1; exchanged they would give a mean that nobody asked for."""
    with pytest.raises(ParameterError, match=r"^lb = 2.0: must be at most ub = 1.0"):
        learned.expect(None, 0.7, lb=2.0, ub=1.0)
    for first in FIRST:
        with pytest.raises(ParameterError, match=r"^lb = 2.0: must be at most ub = -1.0"):
            first.expect(lb=2.0, ub=-1.0)


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"epsabs": -1}, r"epsabs = -1: must be a finite number >= 0"),
        ({"epsrel": np.nan}, r"epsrel = nan: must be a finite number >= 1.11e-14"),
        ({"epsabs": 0, "epsrel": 0}, r"epsrel = 0: must be a finite number >= 1.11e-14"),
        ({"limit": 0}, r"limit = 0: must be a whole number in \[1, 1000000\]"),
    ],
)
def test_options_of_the_integral(options: dict[str, Any], text: str) -> None:
    """What SciPy would answer in its own words."""
    for first in FIRST:
        with pytest.raises(ParameterError, match=f"^{text}"):
            first.expect(**options)


@pytest.mark.parametrize("name", ["full_output", "weight", "points", "args", "foo"])
def test_options_that_are_not_for_restitution(name: str) -> None:
    """Options of SciPy's that are for the variable that is integrated over, which is not ε."""
    options: dict[str, Any] = {name: 1}
    for first in FIRST:
        with pytest.raises(TypeError, match=name):
            first.expect(**options)


def test_options_are_handed_on() -> None:
    for first in FIRST:
        for options in ({"epsabs": 0.0, "epsrel": 1e-12}, {"epsabs": 1e-12, "epsrel": 2e-14, "limit": 200}):
            assert first.expect(None, **options) == pytest.approx(first.mean(), rel=1e-10)  # type: ignore[arg-type]


def test_a_wrong_height_of_several_is_named_with_its_place() -> None:
    body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    with pytest.raises(ValueError, match=r"^release_height\[1\] = 0\.001: must be at least 0\.00\d* m"):
        rs.FluctuatingRestitution.learn(body, rs.Frictionless(normal=0.9), release_height=[0.06, 1e-3])
