"""Counts that are not whole, samples that hardly spread."""

from collections.abc import Callable

import numpy as np
import pytest

from restitution import fit
from restitution._parameters import ParameterError

FAMILIES: list[Callable[..., fit.Fit]] = [
    fit.laplace,
    fit.gaussian,
    fit.logistic,
    fit.student_t,
    fit.asymmetric_laplace,
    fit.asymmetric_power,
    lambda samples: fit.cusp_mixture(samples, 0.0),
]


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
