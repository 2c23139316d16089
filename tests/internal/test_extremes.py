"""Arguments at the ends of floating point, and beyond what an array can be: errors of ours, or the limit."""

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import restitution as rs
from restitution import fit, sound
from restitution.experiment.budget import error_budget

BODY = rs.Dumbbell(radius=3e-3, separation=3e-4)
PAPER = rs.TangentialRestitution(normal=0.98)
CLICKS = np.random.default_rng(1).normal(size=8000)
TINY = np.random.default_rng(2).random(50) * 1e-310
FIRST = rs.analytic.first_impact(BODY, PAPER)


@pytest.fixture(scope="module")
def learned() -> rs.FluctuatingRestitution:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rs.EnergyWarning)
        return rs.FluctuatingRestitution.learn(
            BODY, PAPER, particles=500, velocities=(0.2, 0.6), seed=1, progress=False
        )


def budget(normal: Any) -> Any:
    return error_budget(BODY, rs.Frictionless(normal=normal), drop=0.3, particles=50, impacts=5)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: fit.Counts(np.arange(4.0), np.full(3, 0.5)),
            r"^count\[0\] = 0\.5: must be a whole number in ",
        ),
        (lambda: fit.asymmetric_laplace(TINY), r"^samples: spread over .*e-31\d; at least 1e-100 can be sq"),
        (lambda: fit.asymmetric_power(TINY), r"^samples: spread over "),
        (lambda: fit.gaussian(TINY), r"^samples: spread over "),
        # A metal that stays elastic, and impacts that follow one another without a flight.
        (lambda: budget(rs.Plastic(yield_speed=10.0)), r"^law = .*: must be one from whose ε_n at the "),
        (lambda: budget(1e-7), r"^law = .*: must be one whose flights last at least 1e-10 of "),
        (lambda: sound.impacts(0.1 + 0.0 * CLICKS, 44100), r"^source: silence; every sample has the same"),
        (
            lambda: sound.impacts(1e300 * CLICKS, 44100),
            r"^source: samples up to .*e\+300 of full scale; must",
        ),
        (lambda: sound.impacts(np.zeros((8000, 0)), 44100), r"^source: no channel; must have at least one"),
        (
            lambda: rs.FluctuatingRestitution.learn(BODY, PAPER, velocities=[1e200, 1e201]),
            r"^velocities\[0\] = 1e\+200: must be in \[1e-100, 1e\+100\] m/s",
        ),
        (
            lambda: FIRST.rvs(size=(2**62, 2**62, 0)),
            r"^size = .*: must be such that its lengths that are not",
        ),
        (lambda: FIRST.expect(epsabs=-1), r"^epsabs = -1: must be a finite number >= 0"),
        (lambda: FIRST.expect(epsrel=0), r"^epsrel = 0: must be a finite number >= 1\.11e-14"),
        (lambda: FIRST.expect(limit=0), r"^limit = 0: must be a whole number in \[1, "),
    ],
)
def test_what_is_refused(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        call()


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda p: p.cdf([0.9, 1.0, 1.1], [0.3, 0.4]), r"^x, v: x of shape \(3,\), v of shape \(2,\); must "),
        (lambda p: p.ppf([[0.1], [0.2]], np.full((3, 4), 0.3)), r"^q, v: q of shape \(2, 1\), v of shape"),
        (lambda p: p.rvs(0.3, size=(2**40, 2**40)), r"^size = .*: must be at most .* draws"),
        (lambda p: p.rvs(0.3, size=(2**62, 0)), r"^size = .*: must be such that its lengths that are"),
        (lambda p: p.rvs([0.3, 0.4], size=3), r"^size = 3: must be a shape that \(2,\) broadcasts to"),
        (lambda p: p.rvs([[0.3, 0.4]], size=2), r"^size = 2: must be a shape that \(1, 2\) broadcasts to"),
    ],
)
def test_shapes_that_do_not_go_together(
    learned: rs.FluctuatingRestitution, call: Callable[[Any], Any], message: str
) -> None:
    """Named with their argument, and not in NumPy's words."""
    with pytest.raises(ValueError, match=message):
        call(learned)


def test_shapes_that_do(learned: rs.FluctuatingRestitution) -> None:
    assert learned.rvs([0.3, 0.4], size=(3, 2)).shape == (3, 2)
    assert learned.rvs([[0.3], [0.4]], size=(2, 5)).shape == (2, 5)
    assert learned.rvs(0.3, size=0).shape == (0,)
    assert learned.cdf([0.9, 1.0], [[0.3], [0.4]]).shape == (2, 2)


def test_nothing_is_known_of_nan_and_of_no_probability(learned: rs.FluctuatingRestitution) -> None:
    """As of the other methods: NaN where v is NaN, and where no ε is within the bounds."""
    found = learned.entropy([0.3, np.nan])
    assert np.isfinite(found[0])
    assert np.isnan(found[1])
    assert np.isnan(learned.entropy(np.nan))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.isnan(learned.expect(None, 0.3, lb=5, ub=6, conditional=True))
        whole = learned.expect(None, [0.3, 0.4], conditional=True)
    np.testing.assert_allclose(whole, learned.mean([0.3, 0.4]), rtol=1e-12)


def test_an_infinite_speed_has_the_limit_of_large_ones() -> None:
    """ε_n of both materials falls to 0; of a table it stays as it is at its end."""
    glass = rs.Viscoelastic(
        young_modulus=6e9, poisson_ratio=0.22, dissipation=1e-5, density=2500.0, radius=3e-3
    )
    assert 0.0 <= float(glass(np.inf)) < 1e-80
    assert 0.0 <= float(rs.Plastic(yield_speed=1.0)(np.inf)) < 1e-70
    assert float(rs.Tabulated(v=[0.1, 0.2], e=[0.9, 0.8])(np.inf)) == 0.8
    assert np.isnan(glass(np.nan))
