"""The usual candidates for the density of ε, by maximum likelihood; SciPy's routines for samples."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import exp
from typing import Any

import numpy as np
from scipy import stats

from restitution.fit._asymmetric import unfrozen
from restitution.fit._counts import Counts, Unfrozen, fit_counts, fitted
from restitution.fit._result import Array, Fit
from restitution.fit.source import Samples, Window, taken

_FURTHEST = 1e100
"""Of a sample from the median, in widths of the middle half: such a number can be squared."""
_POINT = 1e-9
"""A scale below this part of that width is of a search that has gone down to a single value."""


def gaussian(samples: Samples, *, velocity: Window | None = None) -> Fit:
    """Fit the normal distribution: ``mean``, ``deviation``. Samples and errors as `asymmetric_laplace`.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).normal(0.98, 0.03, 4000)
    >>> 0.028 < fit.gaussian(x).parameters["deviation"] < 0.032
    True
    """
    return _located("Gaussian", taken(samples, velocity), stats.norm, names=("mean", "deviation"))


def laplace(samples: Samples, *, velocity: Window | None = None) -> Fit:
    """Fit the symmetric Laplace density: ``location``, ``scale``; samples, errors: `asymmetric_laplace`.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).laplace(0.98, 0.03, 4000)
    >>> 0.028 < fit.laplace(x).parameters["scale"] < 0.032
    True
    """
    return _located("symmetric Laplace", taken(samples, velocity), stats.laplace, _laplace)


def _laplace(location: float, scale: float) -> Unfrozen:
    """Make the distribution; SciPy's own has a logarithm that is -inf where the density underflows."""
    return unfrozen(1.0, location, scale, scale)


def logistic(samples: Samples, *, velocity: Window | None = None) -> Fit:
    """Fit the logistic distribution: ``location``, ``scale``. Samples and errors as `asymmetric_laplace`.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = np.random.default_rng(1).logistic(0.98, 0.03, 4000)
    >>> 0.028 < fit.logistic(x).parameters["scale"] < 0.032
    True
    """
    return _located("logistic", taken(samples, velocity), stats.logistic)


def student_t(samples: Samples, *, velocity: Window | None = None) -> Fit:
    """Fit Student's t: ``degrees``, ``location``, ``scale``. Samples and errors as `asymmetric_laplace`.

    SciPy's search would start at one degree of freedom, from where it can end early; here it starts at five,
    the median and the spread of the middle half.

    Raises
    ------
    ValueError
        As `asymmetric_laplace`, and where so many samples are one and the same number that the search goes
        down to it: at k of n the likelihood grows without bound as the scale falls, for fewer degrees of
        freedom than k/(n−k).

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> x = 0.98 + 0.03 * np.random.default_rng(1).standard_t(4.0, 4000)
    >>> 3.0 < fit.student_t(x).parameters["degrees"] < 5.0
    True
    """
    x = taken(samples, velocity)
    if isinstance(x, Counts):
        return _counted("Student t", x, partial(Unfrozen, stats.t), ("degrees", "location", "scale"), 1.6)
    low, median, high = np.quantile(x, [0.25, 0.5, 0.75])
    width = (high - low) / 1.349 or float(np.std(x))  # a Gaussian's quartiles are 1.349 deviations apart
    furthest = float(np.abs(x - median).max())
    if furthest > _FURTHEST * width:
        allowed = f"must be at most {_FURTHEST:g} times the width of their middle half, {width:g}"
        raise ValueError(f"samples: up to {furthest:g} from their median; {allowed}")
    degrees, location, scale = stats.t.fit(x, 5.0, loc=median, scale=width)
    if scale < _POINT * width:
        value = x[np.abs(x - location).argmin()]
        same = f"{np.count_nonzero(x == value)} of {len(x)} are {value:g}"
        raise ValueError(f"samples: {same}; must be fewer: Student's t has no largest likelihood there")
    return fitted(
        "Student t", x, stats.t(degrees, location, scale), degrees=degrees, location=location, scale=scale
    )


def _located(
    family: str,
    x: Array | Counts,
    scipys: Any,
    density: Callable[[float, float], Unfrozen] | None = None,
    names: tuple[str, str] = ("location", "scale"),
) -> Fit:
    """Fit location and scale: to samples as SciPy does, to counts by their own likelihood."""
    density = density or partial(Unfrozen, scipys)
    if isinstance(x, Counts):
        return _counted(family, x, density, names)
    location, scale = scipys.fit(x)
    return fitted(
        family, x, density(location, scale).frozen(), **dict(zip(names, (location, scale), strict=True))
    )


def _counted(
    family: str, counts: Counts, density: Callable[..., Unfrozen], names: tuple[str, ...], *degrees: float
) -> Fit:
    """Fit location, scale and, from where a search for them begins, degrees of freedom to binned counts."""

    def make(point: Array, median: float, spread: float) -> tuple[Unfrozen, dict[str, float]]:
        location, scale = median + spread * float(point[0]), spread * exp(np.clip(point[1], -20.0, 20.0))
        values = (*(exp(np.clip(log, -3.0, 15.0)) for log in point[2:]), location, scale)
        return density(*values), dict(zip(names, values, strict=True))

    return fit_counts(family, counts, make, [0.0, 0.0, *degrees])
