"""Counts that are not whole, samples that hardly spread, infinite speeds, speeds whose squares overflow."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import restitution as rs
from reference.command import SMALL, invoke
from restitution import fit
from restitution._internal.parameters import ParameterError

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


@pytest.mark.parametrize("count", [[0.5, 0.5, 0.5], [0.1, 0.1, 0.1], [1.0, 2.0, 2.5]])
def test_counts_are_whole(count: list[float]) -> None:
    """The total of fractions was cut to a whole number, so that shares went beyond 1, or divided by 0."""
    with pytest.raises(
        ParameterError, match=r"^count\[\d\] = [\d.]+: must be a whole number in \[0, 2\*\*53\]"
    ):
        fit.Counts([0.0, 1.0, 2.0, 3.0], count)  # type: ignore[arg-type]


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
