"""Arguments at the ends of floating point, beyond what an array can be: errors that name them, or limits."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import restitution as rs
from reference.command import SMALL, invoke
from restitution import fit, sound
from restitution._internal.parameters import ParameterError
from restitution.experiment.budget import error_budget

FAMILIES: list[Callable[..., fit.Fit]] = [
    fit.laplace,
    fit.gaussian,
    fit.logistic,
    fit.student_t,
    fit.asymmetric_laplace,
    fit.asymmetric_power,
    lambda samples: fit.cusp_mixture(samples, 0.0),
]

SPHERE = {"young_modulus": 1e9, "poisson_ratio": 0.3, "density": 1e3, "radius": 1e-3}


def test_counts_end_at_one() -> None:
    """Whole numbers may be doubles; the share below the last edge is that of all but those above it."""
    counts = fit.Counts(np.arange(4.0), np.array([1.0, 2.0, 3.0]), above=4)
    assert counts.cumulative().tolist() == pytest.approx([0.0, 0.1, 0.3, 0.6], rel=1e-15)


@pytest.mark.parametrize("family", FAMILIES)
def test_a_spread_without_a_square(family: Callable[..., fit.Fit]) -> None:
    """Squares of 1e-310 are 0; at 2**-330 the fit is that of the samples at any other scale."""
    samples = np.random.default_rng(1).random(50)
    with pytest.raises(ValueError, match=r"^samples: spread over [\d.e-]+; at least 1e-100 can be squared"):
        family(1e-310 * samples)
    small, large = (family(scale * samples).parameters for scale in (2.0**-330, 1.0))
    for name, value in large.items():
        if name == "degrees":
            continue  # those of a uniform distribution have no end
        scale = 1.0 if name in ("share", "exponent") else 2.0**-330
        assert small[name] == pytest.approx(scale * value, rel=1e-4, abs=1e-4 * scale)


@pytest.mark.parametrize(
    ("material", "limit"),
    [
        (rs.Viscoelastic(dissipation=1e-6, **SPHERE), 0.0),
        (rs.Viscoelastic(dissipation=1e-300, **SPHERE), 0.0),
        (rs.Viscoelastic(dissipation=0.0, **SPHERE), 1.0),
        (rs.Plastic(yield_speed=0.01), 0.0),
        (rs.Tabulated(v=[0.1, 0.5], e=[0.97, 0.95]), 0.95),
    ],
)
def test_an_infinite_speed_gives_the_limit(material: Any, limit: float) -> None:
    """The Padé approximant [3/6] falls as v*⁻³, but not without dissipation; a table stays as it ends."""
    found = material([-np.inf, np.nan, np.inf])
    assert found[[0, 2]].tolist() == [limit, limit]
    assert np.isnan(found[1])
    finite = material([0.0, 0.1, 1e300])
    assert np.all((finite >= 0.0) & (finite <= 1.0))


@pytest.mark.parametrize("velocities", [[1e200, 1e201], [0.1, 1e160], [1e-310, 0.5], [0.1, 0.2, 1e300]])
def test_speeds_whose_squares_overflow(velocities: list[float]) -> None:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98)
    with pytest.raises(ParameterError, match=r"^velocities\[\d\] = .*: must be in \[1e-100, 1e\+100\] m/s"):
        rs.FluctuatingRestitution.learn(body, law, particles=100, velocities=velocities)


def test_the_command_names_such_speeds(tmp_path: Path) -> None:
    run = tmp_path / "run.toml"
    run.write_text(SMALL, encoding="utf-8")
    result = invoke("distribution", run, "--out", tmp_path / "dist.nc", "--velocities", 1e200, 1e201)
    assert result.exit_code == 2
    assert "velocities[0] = 1e+200: must be in" in result.output


def test_samples_far_from_many() -> None:
    """The square of 1e99 over 1e-60 overflowed, with a warning of SciPy's."""
    near = 1e-60 * np.random.default_rng(1).normal(size=49)
    text = r"^samples: up to 1e\+99 from their median; must be at most 1e\+100 times the width .* 7\.\d+e-61$"
    with pytest.raises(ValueError, match=text):
        fit.student_t(np.append(near, 1e99))
    assert abs(fit.student_t(np.append(near, 1e20)).parameters["location"]) < 1e-60
    for far in (0.6, 1e20, 1e99):
        with pytest.raises(ValueError, match=r"^samples: 49 of 50 are 0\.5; must be fewer"):
            fit.student_t(np.append(np.full(49, 0.5), far))


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
