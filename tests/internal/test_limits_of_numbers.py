"""Arguments at the ends of floating point, beyond what an array can be: errors that name them, or limits."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import restitution as rs
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
