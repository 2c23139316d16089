"""Result of a fit, and the check of the samples that a fit is given."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from math import log, sqrt
from typing import Any
from unicodedata import normalize

import numpy as np
from numpy.typing import ArrayLike, NDArray

from restitution._internal.arrays import generator, real, reals, whole
from restitution._internal.datasets import Content
from restitution._internal.parameters import ParameterError, wrong
from restitution._internal.resources import check_size
from restitution._internal.text import table, value, with_error

Array = NDArray[np.float64]

PART = 2**20
"""Numbers of a part of a long array: Ctrl-C waits for a part, and SciPy keeps little meanwhile."""

_LARGEST = 1e100
_NARROWEST = 1e-100
_MOST_DRAWS = 10**9
_BEYOND = 5
"""Samples on one side of the cusp, as expected from the fit, that say nothing of a flank there."""


@dataclass(frozen=True, eq=False)
class Fit(Content):
    """A distribution fitted to samples by maximum likelihood.

    Attributes
    ----------
    family : str
        Name of the family, in words.
    parameters : Mapping[str, float]
        The fitted parameters in the family's own notation, fixed ones included; unit of the samples.
    free_parameters : int
        How many of them were fitted.
    samples : int
        Number n of samples.
    loglikelihood : float
        Natural logarithm of the likelihood at its maximum.
    distribution : frozen scipy.stats distribution
        The fitted distribution with all that SciPy offers on it; that of `cusp_mixture` has pdf, logpdf, cdf,
        sf, ppf and rvs.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import fit
    >>> found = fit.laplace(np.random.default_rng(1).laplace(0.98, 0.03, 1000))
    >>> found.family, found.free_parameters, found.samples
    ('symmetric Laplace', 2, 1000)
    >>> bool(0.0 < found.distribution.cdf(0.9) < 0.1)
    True
    """

    family: str
    parameters: Mapping[str, float]
    free_parameters: int
    samples: int
    loglikelihood: float
    distribution: Any = field(repr=False, compare=False)

    def __str__(self) -> str:
        numbers = ", ".join(f"{name} = {value(number)}" for name, number in self.parameters.items())
        limit = f"; {self.limit}" if self.limit else ""
        return f"{self.family}, by maximum likelihood of {self.samples} samples: {numbers}{limit}"

    @property
    def limit(self) -> str:
        """Parameters at an end of their range, where a simpler family fits as well; empty if none is."""
        found, ends = self.parameters, []
        sides = [found[name] for name in ("above", "below") if name in found]
        if "share" not in found and sides and min(sides) * self.samples < _BEYOND * sum(sides):
            ends += [f"the cusp is at the end of the samples, fewer than {_BEYOND} lie beyond it"]
        # The excess kurtosis, 6/(degrees - 4), is less than its standard error in a Gaussian sample.
        if found.get("degrees", 0.0) > 4.0 + 6.0 * sqrt(self.samples / 24.0):
            ends += [
                "the degrees of freedom are so many that the samples do not distinguish it from a Gaussian"
            ]
        if not 0.51 < found.get("exponent", 1.0) < 19.9:
            ends += ["the exponent is at the end of its range, 0.5 to 20"]
        share = found.get("share", 0.5)
        if min(share, 1.0 - share) * self.samples < 1.0:
            ends += ["the share is at the end of its range, one part is empty"]
        return "; ".join(ends)

    def to_latex(self, errors: Mapping[str, float] | None = None) -> str:
        """Write a LaTeX table of the parameters, for the package booktabs.

        Parameters
        ----------
        errors : mapping of str to float, optional
            Standard errors by the name of the parameter; `Bootstrap.to_latex` gives those of resampled
            particles.
        """
        errors = {} if errors is None else errors
        if not isinstance(errors, Mapping):
            raise ParameterError(wrong("errors", errors, "a mapping of parameters to their standard errors"))
        known = {
            name: real(f"errors[{name!r}]", x, "a number >= 0", lambda e: e >= 0)
            for name, x in errors.items()
        }
        rows = [(name, with_error(number, known.get(name))) for name, number in self.parameters.items()]
        rows += [("samples", str(self.samples)), (r"$\ln L$", f"{self.loglikelihood:.1f}")]
        lines = [rf"{name} & ${_formula(number)}$ \\" for name, number in rows]
        head = [
            r"\begin{tabular}{lr}",
            r"\toprule",
            rf"\multicolumn{{2}}{{l}}{{{self.family}}} \\",
            r"\midrule",
        ]
        return "\n".join([*head, *lines, r"\bottomrule", r"\end{tabular}"]) + "\n"

    def _repr_html_(self) -> str:
        rows = [(name, value(number)) for name, number in self.parameters.items()]
        rows += [
            ("samples", str(self.samples)),
            ("ln L", value(self.loglikelihood)),
            ("AIC", value(self.aic)),
        ]
        rows += [("limit", self.limit)] if self.limit else []
        return table(f"{self.family}, by maximum likelihood", rows)

    @property
    def aic(self) -> float:
        """Akaike's criterion, 2 k − 2 ln L; lower is better."""
        return 2 * self.free_parameters - 2 * self.loglikelihood

    @property
    def bic(self) -> float:
        """Schwarz's criterion, k ln n − 2 ln L; lower is better. It takes the samples as independent."""
        return self.free_parameters * log(self.samples) - 2 * self.loglikelihood

    def pdf(self, x: ArrayLike) -> Array:
        """Return the probability density at `x`, in 1/unit of the samples; shape of `x`."""
        return self._at(self.distribution.pdf, x)

    def logpdf(self, x: ArrayLike) -> Array:
        """Return the natural logarithm of the density at `x`; shape of `x`."""
        return self._at(self.distribution.logpdf, x)

    def cdf(self, x: ArrayLike) -> Array:
        """Return the probability of a value up to `x`; shape of `x`."""
        return self._at(self.distribution.cdf, x)

    def _at(self, function: Any, x: ArrayLike) -> Array:
        points = reals("x", x, "numbers", finite=False)
        with np.errstate(over="ignore"):  # so far off that the density is 0
            return in_parts(function, points)

    def rvs(self, size: int, seed: int | np.random.Generator = 1) -> Array:
        """Draw `size` independent values, shape (size,)."""
        number, random = whole("size", size, 0, _MOST_DRAWS), generator("seed", seed)
        if hasattr(self.distribution, "dist"):  # SciPy's own
            check_size("size", size, number, 8, "draws")
            return drawn(self.distribution, number, random)
        check_size("size", size, number, 4 * 8, "draws")  # of a mixture, from both parts
        return np.asarray(self.distribution.rvs(size=number, random_state=random))


def _formula(text: str) -> str:
    """Write what `with_error` gives as a formula of LaTeX."""
    text = re.sub("[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+", lambda power: f"^{{{normalize('NFKC', power[0])}}}", text)
    return text.replace("±", r"\pm").replace("×", r"\times").replace("\u202f", r"\,").replace("−", "-")


def finite_samples(samples: ArrayLike, location: float | None = None) -> Array:
    """Return `samples` as a flat float array.

    Raises
    ------
    ValueError
        If `samples` are not numbers, none at all, hold NaN, inf or magnitudes above 1e100, or do not spread
        at all (about `location`, where that is given), as the likelihood then has no maximum, or spread by
        less than 1e-100.
    """
    if hasattr(samples, "columns"):  # of pandas or polars, with times and angles among the numbers
        columns = ", ".join(map(str, samples.columns))
        raise ValueError(f"samples: a table of {columns}; must be one column, such as that of restitution")
    x = reals("samples", samples, "numbers, Counts or a Dataset", finite=False).ravel()
    if x.size == 0:
        raise ValueError("samples: empty; at least one value is needed")
    bad = x.size - np.count_nonzero(np.isfinite(x))
    if bad:
        raise ValueError(f"samples: {bad} of {x.size} values are NaN or infinite; all must be finite")
    largest = float(np.abs(x).max())
    if largest > _LARGEST:
        raise ValueError(
            f"samples: magnitudes up to {largest:g}; at most {_LARGEST:g} can be squared and summed"
        )
    centre = float(x[0]) if location is None else location
    if np.all(x == centre):
        raise ValueError(f"samples: all {x.size} equal {centre!r}; the likelihood of a scale has no maximum")
    spread = float(np.abs(x - centre).max())
    if spread < _NARROWEST:
        raise ValueError(f"samples: spread over {spread:g}; at least {_NARROWEST:g} can be squared")
    return x


def in_parts(function: Callable[[Array], Any], x: Array) -> Array:
    """Evaluate a function of each number by itself, part by part with the same bits; shape of `x`."""
    if x.size <= PART:
        return np.asarray(function(x))
    found, points = np.empty(x.size), x.ravel()
    for start in range(0, x.size, PART):
        found[start : start + PART] = function(points[start : start + PART])
    return found.reshape(x.shape)


def draws(draw: Callable[[int], Any], number: int) -> Array:
    """Draw in parts with a function that takes the number of draws; shape (number,)."""
    if number <= PART:
        return np.asarray(draw(number))
    found = np.empty(number)
    for start in range(0, number, PART):
        found[start : start + PART] = draw(min(PART, number - start))
    return found


def drawn(distribution: Any, number: int, random: np.random.Generator) -> Array:
    """Draw from a distribution of SciPy, which takes one number after the other."""
    return draws(lambda some: distribution.rvs(size=some, random_state=random), number)
