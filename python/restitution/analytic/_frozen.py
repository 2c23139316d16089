"""The methods of every distribution of ε at the first impact from rest."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, fields
from typing import Any, TypeAlias, overload

import numpy as np
from numpy.typing import ArrayLike

from restitution._internal.arrays import flag, function, generator, real, reals, shape, whole
from restitution._internal.datasets import check_state
from restitution._internal.parameters import ParameterError, wrong
from restitution._internal.resources import check_size
from restitution._internal.text import table, value
from restitution.analytic._orientation import Floats, OrientationName
from restitution.bodies import ANY_BODIES, AnyBody, Body, RigidBody, RoughSphere
from restitution.laws import LAWS, Law, check_steady

Values: TypeAlias = Any  # np.float64 for a scalar argument, an array of floats otherwise
RandomState: TypeAlias = int | np.random.Generator | np.random.RandomState | None

_MOST_INTERVALS = 10**6
_DIGITS = 50 * float(np.finfo(np.float64).eps)
"""Of a smaller relative error quad says that it cannot be had, unless the absolute one allows more."""


@dataclass(frozen=True)
class FirstImpact(ABC):
    """Distribution of ε at the first impact from rest; make it with `first_impact`.

    The methods follow the conventions of frozen `scipy.stats` distributions: arguments of any shape, a NumPy
    scalar for a scalar, nan for nan and for a probability outside [0, 1].

    Parameters
    ----------
    body, law, orientation
        As in `first_impact`.

    Examples
    --------
    >>> import restitution as rs
    >>> first = rs.analytic.first_impact(
    ...     rs.Dumbbell(radius=3e-3, separation=6e-3), rs.TangentialRestitution(normal=0.4))
    >>> bool(first.cdf(first.mean()) > 0.1)
    True
    >>> first.rvs(size=3, random_state=1).shape
    (3,)
    """

    body: Body | RigidBody
    law: Law
    orientation: OrientationName

    def __setstate__(self, state: dict[str, Any]) -> None:
        check_state(type(self), {one.name for one in fields(self)}, state)
        self.__dict__.update(state)

    def _repr_html_(self) -> str:
        low, high = self.support()
        return table(
            "Restitution at the first impact from rest",
            (
                ("body", repr(self.body)),
                ("law", repr(self.law)),
                ("orientation", self.orientation),
                ("support", value((low, high))),
                ("mean", value(self.mean())),
                ("std", value(self.std())),
                ("P(ε < 0)", value(self.probability_negative)),
            ),
        )

    @abstractmethod
    def support(self) -> tuple[float, float]:
        """Return the least and greatest ε."""

    @abstractmethod
    def restitution(self, cos_theta: ArrayLike) -> Values:
        """Return ε at the angle θ between symmetry axis and plane normal; nan unless -1 <= cos θ <= 1."""

    @abstractmethod
    def cos_theta(self, restitution: ArrayLike) -> Values:
        """Return the greatest |cos θ| that gives ε; nan outside the support."""

    @property
    def cdf_error(self) -> float:
        """Estimated error of `cdf`: 0 where ε is a function of the angle θ, which is solved to rounding.

        For other rigid bodies a generous estimate, not a bound.
        """
        return 0.0

    def at(self, normal: ArrayLike) -> Values:
        """Return ε where the normal of the plane, away from it, has a direction in the axes of the body.

        Parameters
        ----------
        normal : array_like, shape (..., 3)
            Vectors of any length > 0. The axis of a body of revolution is z.
        """
        allowed = "vectors of a length > 0, shape (..., 3)"
        vectors = reals("normal", normal, allowed, unit="1")
        if vectors.ndim == 0 or vectors.shape[-1] != 3 or not np.all(np.any(vectors != 0.0, axis=-1)):
            raise ParameterError(wrong("normal", normal, allowed))
        flat = vectors.reshape(-1, 3)
        flat = flat / np.abs(flat).max(axis=1, keepdims=True)
        flat = flat / np.linalg.norm(flat, axis=1, keepdims=True)
        return scalar(self._at(flat).reshape(vectors.shape[:-1]))

    def _at(self, normal: Floats) -> Floats:
        """Return ε for unit vectors, shape (directions, 3)."""
        return np.asarray(self.restitution(np.clip(normal[:, 2], -1.0, 1.0)))

    @property
    def probability_above_normal(self) -> float:
        """P(ε > ε_n), ε_n at the speed of the impact.

        0 but for Chatterjee and Ruina's law with e_t > e: under all others rotation only lowers ε.
        """
        return 0.0

    @property
    def probability_negative(self) -> float:
        """P(ε < 0): the centre of mass goes on downwards."""
        return float(self.cdf(0.0))

    def pdf(self, x: ArrayLike) -> Values:
        """Return the probability density at ε = x."""
        return scalar(self._density(floats(x)))

    def cdf(self, x: ArrayLike) -> Values:
        """Return the probability that ε <= x; ``cdf(0)`` is that of a body that goes on downwards."""
        return scalar(self._probability(floats(x), above=False))

    def sf(self, x: ArrayLike) -> Values:
        """Return the probability that ε > x, accurate also where it is small."""
        return scalar(self._probability(floats(x), above=True))

    def ppf(self, q: ArrayLike) -> Values:
        """Return the quantile: the ε with ``cdf(ε) = q``; nan unless ``0 <= q <= 1``."""
        return scalar(self._quantile(probability(q), above=False))

    def isf(self, q: ArrayLike) -> Values:
        """Return the upper quantile: the ε with ``sf(ε) = q``; nan unless ``0 <= q <= 1``."""
        return scalar(self._quantile(probability(q), above=True))

    @abstractmethod
    def _density(self, x: Floats) -> Floats: ...

    @abstractmethod
    def _probability(self, x: Floats, *, above: bool) -> Floats: ...

    @abstractmethod
    def _quantile(self, q: Floats, *, above: bool) -> Floats: ...

    def mean(self) -> float:
        """Return the mean of ε."""
        return self._raw(1)

    def std(self) -> float:
        """Return the square root of the variance of ε."""
        return float(np.sqrt(self._central(2)))

    def expect(
        self,
        func: Callable[[float], float] | None = None,
        lb: float | None = None,
        ub: float | None = None,
        conditional: bool = False,
        *,
        epsabs: float = 1.49e-8,
        epsrel: float = 1.49e-8,
        limit: int = 50,
    ) -> float:
        """Return the mean of ``func(ε)``, by default of ε, by `scipy.integrate.quad` without a singularity.

        Parameters
        ----------
        func : callable, optional
            Of one number.
        lb, ub : float, optional
            Only ε in [lb, ub] count; lb <= ub.
        conditional : bool
            Divide by the probability of [lb, ub]; nan where that is 0.
        epsabs, epsrel : float
            Absolute and relative error to which `scipy.integrate.quad` integrates, one of which is enough;
            >= 0 and above rounding.
        limit : int
            Most intervals that it takes.
        """
        low, high = self.support()
        low = low if lb is None else real("lb", lb, "a number or None", lambda x: x == x)
        high = high if ub is None else real("ub", ub, "a number or None", lambda x: x == x)
        if lb is not None and ub is not None and low > high:
            raise ParameterError(wrong("lb", lb, f"at most ub = {high!r}"))
        divide = flag("conditional", conditional)

        def error(name: str, given: float, least: float) -> float:
            return real(name, given, f"a finite number >= {least:.3g}", lambda x: least <= x < math.inf)

        options = {
            "epsabs": error("epsabs", epsabs, 0.0),
            "epsrel": error("epsrel", epsrel, _DIGITS),
            "limit": whole("limit", limit, 1, _MOST_INTERVALS),
        }
        func = (lambda x: x) if func is None else function("func", func)
        total, share = self._expected(func, low, high, options)
        if not divide:
            return total
        return total / share if share else math.nan

    @abstractmethod
    def _expected(
        self, func: Callable[[float], float], low: float, high: float, options: dict[str, Any]
    ) -> tuple[float, float]:
        """Return the integral of ``func(ε)`` over the ε in [low, high], and the probability of these."""

    @abstractmethod
    def entropy(self) -> float:
        """Return the differential entropy, -∫ p ln p dε."""

    @abstractmethod
    def _mean_of(self, polynomial: Callable[[Floats], Floats], order: int) -> float:
        """Return the mean of a function of ε that is a polynomial of this order."""

    def _raw(self, order: int) -> float:
        """Return the mean of ε to a power."""
        return self._mean_of(lambda value: value**order, order)

    def _central(self, order: int) -> float:
        """Return the mean of ε - mean to a power."""
        mean = self.mean()
        return self._mean_of(lambda value: (value - mean) ** order, order)

    def _standardised(self, order: int) -> float:
        """Return the mean of (ε - mean)/std to a power."""
        return float(self._central(order) / self._central(2) ** (order / 2))

    def logpdf(self, x: ArrayLike) -> Values:
        """Return the logarithm of `pdf`; -inf outside the support."""
        with np.errstate(divide="ignore"):
            return scalar(np.log(self.pdf(x)))

    def logcdf(self, x: ArrayLike) -> Values:
        """Return the logarithm of `cdf`."""
        with np.errstate(divide="ignore"):
            return scalar(np.log(self.cdf(x)))

    def logsf(self, x: ArrayLike) -> Values:
        """Return the logarithm of `sf`."""
        with np.errstate(divide="ignore"):
            return scalar(np.log(self.sf(x)))

    @overload
    def rvs(self, size: None = None, random_state: RandomState = None) -> float: ...

    @overload
    def rvs(self, size: int | tuple[int, ...], random_state: RandomState = None) -> Floats: ...

    def rvs(
        self, size: int | tuple[int, ...] | None = None, random_state: RandomState = None
    ) -> float | Floats:
        """Draw independent ε; the same ``random_state`` (seed or generator's state) gives the same ones."""
        lengths = None if size is None else shape("size", size)
        if lengths is not None:
            check_size("size", size, math.prod(lengths), 3 * 8, "draws")
        random = np.random.default_rng() if random_state is None else random_state
        if not isinstance(random, np.random.RandomState):
            random = generator("random_state", random)
        drawn: float | Floats = self._drawn(np.asarray(random.random(lengths)))
        return drawn

    def _drawn(self, uniform: Floats) -> Values:
        """Return the ε at uniform random numbers from [0, 1)."""
        return self.ppf(uniform)

    def var(self) -> float:
        """Return the variance of ε."""
        return self.std() ** 2

    def stats(self, moments: str = "mv") -> tuple[float, ...]:
        """Return the mean "m", variance "v", skewness "s" and kurtosis "k", in the order of ``moments``.

        The kurtosis is Pearson's, 3 for a Gaussian, as everywhere in this package; SciPy's is less by 3.
        """
        make: dict[str, Callable[[], float]] = {
            "m": self.mean,
            "v": self.var,
            "s": lambda: self._standardised(3),
            "k": lambda: self._standardised(4),
        }
        if not isinstance(moments, str) or not set(moments) <= set(make):
            raise ParameterError(wrong("moments", moments, "letters of 'mvsk'"))
        return tuple(make[letter]() for letter in moments)

    def moment(self, order: int) -> float:
        """Return the mean of ε to the power ``order`` (a whole number >= 0)."""
        return self._raw(whole("order", order, 0, 1000))

    def median(self) -> float:
        """Return the median of ε."""
        return float(self.ppf(0.5))

    def interval(self, confidence: ArrayLike) -> tuple[Values, Values]:
        """Return both ends of the range that leaves out equal probability on either side."""
        tail = 0.5 * (1.0 - probability(confidence, "confidence"))
        return self.ppf(tail), self.isf(tail)


def check(body: Body | RigidBody, law: Law) -> None:
    """Refuse what is not a body or not a law, random heights of asperities, and a law that scatters."""
    if not isinstance(body, AnyBody):
        raise ParameterError(wrong("body", body, ANY_BODIES))
    if isinstance(body, RoughSphere) and (isinstance(body.heights, tuple) or body.heights == 0.0):
        raise ParameterError(wrong("body.heights", body.heights, "a number > 0 in m, the same for all"))
    if not isinstance(law, Law):
        raise ParameterError(wrong("law", law, LAWS))
    check_steady(law)


def floats(x: ArrayLike, name: str = "x", unit: str | None = "1") -> Floats:
    """Take numbers of any shape."""
    return reals(name, x, "a number or an array of numbers", unit=unit, finite=False)


def cosine_of(cos_theta: ArrayLike) -> Floats:
    """Take cos θ, to which NumPy's cosine hands on the unit of the angle; nan outside [-1, 1]."""
    value = floats(cos_theta, "cos_theta", None)
    return np.where(np.abs(value) <= 1.0, value, np.nan)


def probability(q: ArrayLike, name: str = "q") -> Floats:
    """Take probabilities of any shape; nan outside [0, 1]."""
    value = floats(q, name)
    return np.where((value >= 0.0) & (value <= 1.0), value, np.nan)


def scalar(values: Values) -> Values:
    """Make a 0-d array a NumPy scalar, as scipy does."""
    return np.asarray(values)[()]
