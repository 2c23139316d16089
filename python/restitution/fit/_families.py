"""The usual candidates for the density of ε, by maximum likelihood with SciPy's routines."""

import numpy as np
from numpy.typing import ArrayLike
from scipy import stats

from restitution.fit._result import Fit, finite_samples, fitted


def gaussian(samples: ArrayLike) -> Fit:
    """Fit the normal distribution: ``mean``, ``deviation``. Raises as `asymmetric_laplace` does."""
    x = finite_samples(samples)
    mean, deviation = stats.norm.fit(x)
    return fitted("Gaussian", x, stats.norm(mean, deviation), mean=mean, deviation=deviation)


def laplace(samples: ArrayLike) -> Fit:
    """Fit the symmetric Laplace density: ``location``, ``scale``. Raises as `asymmetric_laplace` does."""
    x = finite_samples(samples)
    location, scale = stats.laplace.fit(x)
    return fitted("symmetric Laplace", x, stats.laplace(location, scale), location=location, scale=scale)


def logistic(samples: ArrayLike) -> Fit:
    """Fit the logistic distribution: ``location``, ``scale``. Raises as `asymmetric_laplace` does."""
    x = finite_samples(samples)
    location, scale = stats.logistic.fit(x)
    return fitted("logistic", x, stats.logistic(location, scale), location=location, scale=scale)


def student_t(samples: ArrayLike) -> Fit:
    """Fit Student's t: ``degrees``, ``location``, ``scale``. Raises as `asymmetric_laplace` does.

    SciPy's search would start at one degree of freedom, from where it can end early; here it starts at five,
    the median and the spread of the middle half.
    """
    x = finite_samples(samples)
    low, median, high = np.quantile(x, [0.25, 0.5, 0.75])
    width = (high - low) / 1.349 or float(np.std(x))  # a Gaussian's quartiles are 1.349 deviations apart
    degrees, location, scale = stats.t.fit(x, 5.0, loc=median, scale=width)
    return fitted(
        "Student t", x, stats.t(degrees, location, scale), degrees=degrees, location=location, scale=scale
    )
