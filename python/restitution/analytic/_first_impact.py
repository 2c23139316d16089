"""The distribution of the coefficient of restitution at the first impact from rest, at random orientation."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import quad

from restitution._parameters import ParameterError, wrong
from restitution.analytic._impact_from_rest import ImpactFromRest
from restitution.analytic._orientation import ORIENTATIONS, Floats, Orientation, OrientationName
from restitution.bodies import Dumbbell
from restitution.laws import TangentialRestitution

Values: TypeAlias = Any  # np.float64 for a scalar argument, an array of floats otherwise
RandomState: TypeAlias = int | np.random.Generator | np.random.RandomState | None

SHORTEST, LONGEST = 1e-100, 1e100  # L/R whose powers, up to the third, are normal numbers


def first_impact(
    body: Dumbbell, law: TangentialRestitution, orientation: OrientationName = "uniform-angle"
) -> "FirstImpact":
    """Distribution of the coefficient of restitution ε at the first impact from rest (the paper's Sec. IV).

    The body is released without spin and without horizontal velocity, so ε depends on the orientation alone
    (Eq. 17), and not on height, size, density or ``law.tangential``.

    Parameters
    ----------
    body : Dumbbell
        With ``separation > 0``, also beyond ``2 * radius``; 1e-100 to 1e100 times ``radius``.
    law : TangentialRestitution
        Law of the impact.
    orientation : {"uniform-angle", "isotropic"}
        Law of the angle θ between symmetry axis and plane normal: θ uniform in [0, π) as in the paper, or the
        axis uniform on the sphere.

    Returns
    -------
    FirstImpact
        Used like a frozen distribution of `scipy.stats`.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import restitution as rs
    >>> from restitution.analytic import first_impact
    >>> body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    >>> distribution = first_impact(body, rs.TangentialRestitution(normal=0.4))
    >>> round(float(distribution.cdf(0.0)), 4)
    0.0295
    """
    return FirstImpact(body, law, orientation)


@dataclass(frozen=True)
class FirstImpact:
    """Distribution of ε at the first impact from rest; make it with `first_impact`.

    Methods have the names and manners of a frozen `scipy.stats` distribution: arguments of any shape, a NumPy
    scalar for a scalar, nan for nan and for a probability outside [0, 1]. Density, distribution function and
    quantiles are closed forms; moments are Gauss sums over the quantile function, exact to rounding.

    The density is finite at the lower end of the support and, for "uniform-angle", infinite (but integrable)
    at the upper end ε^n. Where L/R is so small that the support is only a few ulp of ε^n wide, `std`, `var`,
    `stats` and `entropy` keep all digits; an ε that is given or returned is a rounded number.

    Parameters
    ----------
    body : Dumbbell
        With ``separation > 0``.
    law : TangentialRestitution
        Law of the impact.
    orientation : {"uniform-angle", "isotropic"}
        Law of the angle between symmetry axis and plane normal.
    """

    body: Dumbbell
    law: TangentialRestitution
    orientation: OrientationName = "uniform-angle"

    def __post_init__(self) -> None:
        if not isinstance(self.body, Dumbbell):
            raise ParameterError(wrong("body", self.body, "a Dumbbell"))
        if not self.body.is_equal:
            raise ParameterError(wrong("body", self.body, "a Dumbbell of equal spheres"))
        if not isinstance(self.law, TangentialRestitution):
            raise ParameterError(wrong("law", self.law, "a TangentialRestitution"))
        if not isinstance(self.law.normal, float):
            raise ParameterError(wrong("law.normal", self.law.normal, "a number for this closed form"))
        if not (isinstance(self.orientation, str) and self.orientation in ORIENTATIONS):
            raise ParameterError(wrong("orientation", self.orientation, " or ".join(map(repr, ORIENTATIONS))))
        separation = self.body.separation
        if separation == 0.0:
            sphere = f"a sphere has no distribution, its restitution is law.normal = {self.law.normal!r}"
            raise ParameterError(wrong("body.separation", separation, f"> 0; {sphere}"))
        if not SHORTEST <= self.body.elongation <= LONGEST:
            allowed = f"{SHORTEST:g} to {LONGEST:g} times body.radius"
            raise ParameterError(wrong("body.separation", separation, allowed))

    @cached_property
    def _impact(self) -> ImpactFromRest:
        return ImpactFromRest.of(self.body, self.law)

    @property
    def _orientation(self) -> Orientation:
        return ORIENTATIONS[self.orientation]

    def support(self) -> tuple[float, float]:
        """Least and greatest ε: axis horizontal and axis vertical (ε^n)."""
        return self._impact.normal - self._impact.greatest_loss, self._impact.normal

    def restitution(self, cos_theta: ArrayLike) -> Values:
        """ε at the angle θ between symmetry axis and plane normal (Eq. 17); nan unless -1 <= cos θ <= 1.

        The contact is with the lower sphere, hence the same value at cos θ and -cos θ.
        """
        cosine = np.abs(_floats(cos_theta))
        cosine = np.where(cosine <= 1.0, cosine, np.nan)
        return _scalar(self._impact.restitution(cosine, np.sqrt((1.0 - cosine) * (1.0 + cosine))))

    def cos_theta(self, restitution: ArrayLike) -> Values:
        """|cos θ| in [0, 1] that gives ε, the inverse of `restitution`; nan outside the support."""
        value = _floats(restitution)
        cosine, _ = self._angle(value)
        return _scalar(np.where(self._outside(value), np.nan, cosine))

    def pdf(self, x: ArrayLike) -> Values:
        """Probability density at ε = x (Eq. 21 without its misprints)."""
        with np.errstate(over="ignore"):
            return _scalar(self._relative_density(x) / self._impact.greatest_loss)

    def logpdf(self, x: ArrayLike) -> Values:
        """Logarithm of `pdf`; -inf outside the support."""
        with np.errstate(divide="ignore"):
            return _scalar(np.log(self._relative_density(x)) - np.log(self._impact.greatest_loss))

    def cdf(self, x: ArrayLike) -> Values:
        """Probability that ε <= x; ``cdf(0)`` is the probability that the body goes on downwards."""
        return _scalar(self._orientation.below(*self._angle(_floats(x))))

    def sf(self, x: ArrayLike) -> Values:
        """Probability that ε > x, accurate also where it is small."""
        return _scalar(self._orientation.above(*self._angle(_floats(x))))

    def logcdf(self, x: ArrayLike) -> Values:
        """Logarithm of `cdf`."""
        with np.errstate(divide="ignore"):
            return _scalar(np.log(self.cdf(x)))

    def logsf(self, x: ArrayLike) -> Values:
        """Logarithm of `sf`."""
        with np.errstate(divide="ignore"):
            return _scalar(np.log(self.sf(x)))

    def ppf(self, q: ArrayLike) -> Values:
        """Quantile: the ε with ``cdf(ε) = q``; nan unless ``0 <= q <= 1``."""
        below = _probability(q)
        return _scalar(self._impact.restitution(*self._orientation.quantile(below, 1.0 - below)))

    def isf(self, q: ArrayLike) -> Values:
        """Upper quantile: the ε with ``sf(ε) = q``; nan unless ``0 <= q <= 1``."""
        above = _probability(q)
        return _scalar(self._impact.restitution(*self._orientation.quantile(1.0 - above, above)))

    def rvs(self, size: int | tuple[int, ...] | None = None, random_state: RandomState = None) -> Values:
        """Draw independent ε; the same ``random_state`` (seed or generator's state) gives the same ones."""
        if not isinstance(random_state, np.random.Generator | np.random.RandomState):
            random_state = np.random.default_rng(random_state)
        return self.ppf(random_state.random(size))

    def mean(self) -> float:
        """Mean of ε."""
        return self._impact.normal - self._impact.greatest_loss * self._mean_loss

    def var(self) -> float:
        """Variance of ε."""
        return self.std() ** 2

    def std(self) -> float:
        """Square root of the variance of ε."""
        return self._impact.greatest_loss * float(np.sqrt(self._central(2)))

    def stats(self, moments: str = "mv") -> tuple[float, ...]:
        """Mean "m", variance "v", skewness "s" and excess kurtosis "k", in the order of ``moments``."""
        make: dict[str, Callable[[], float]] = {
            "m": self.mean,
            "v": self.var,
            "s": lambda: -self._central(3) / self._central(2) ** 1.5,
            "k": lambda: self._central(4) / self._central(2) ** 2 - 3.0,
        }
        if not set(moments) <= set(make):
            raise ParameterError(wrong("moments", moments, "letters of 'mvsk'"))
        return tuple(make[letter]() for letter in moments)

    def moment(self, order: int) -> float:
        """Mean of ε to the power ``order`` (a whole number >= 0)."""
        if isinstance(order, bool) or not isinstance(order, int | np.integer) or order < 0:
            raise ParameterError(wrong("order", order, "a whole number >= 0"))
        q, weights = _gauss(int(order))
        return float(weights @ self.ppf(q) ** order)

    def median(self) -> float:
        """Median of ε."""
        return float(self.ppf(0.5))

    def interval(self, confidence: ArrayLike) -> tuple[Values, Values]:
        """Both ends of the range that leaves out equal probability on either side."""
        tail = 0.5 * (1.0 - _probability(confidence))
        return self.ppf(tail), self.isf(tail)

    def entropy(self) -> float:
        """Differential entropy, -∫ p ln p dε."""

        def integrand(u: float) -> float:  # q = u³ tames the logarithm, steep at q = b where b is small
            cosine, _ = self._orientation.quantile(np.asarray(u**3), np.asarray(1.0 - u**3))
            return float(3.0 * u * u * np.log(self._impact.relative_slope(cosine)))

        slope, _ = quad(integrand, 0.0, 1.0, epsabs=1e-12, epsrel=0.0, limit=100)
        return float(self._orientation.entropy + slope + np.log(self._impact.greatest_loss))

    def expect(
        self,
        func: Callable[[float], float] | None = None,
        lb: float | None = None,
        ub: float | None = None,
        conditional: bool = False,
        **options: Any,
    ) -> float:
        """Mean of ``func(ε)`` by `scipy.integrate.quad` over the quantile function, without a singularity.

        Parameters
        ----------
        func : callable, optional
            Of one number; ε itself if left out.
        lb, ub : float, optional
            Only ε in [lb, ub] count.
        conditional : bool
            Divide by the probability of [lb, ub].
        **options
            For `scipy.integrate.quad`.
        """
        low = 0.0 if lb is None else float(self.cdf(lb))
        high = 1.0 if ub is None else float(self.cdf(ub))

        def integrand(q: float) -> float:
            restitution = float(self.ppf(q))
            return restitution if func is None else func(restitution)

        value, _ = quad(integrand, low, high, **options)
        return float(value / (high - low) if conditional else value)

    def _outside(self, restitution: Floats) -> NDArray[np.bool_]:
        low, high = self.support()
        return (restitution < low) | (restitution > high)

    def _angle(self, restitution: Floats) -> tuple[Floats, Floats]:
        """(c, sin θ) at ε, of the nearer end outside the support; exact at both ends."""
        low, high = self.support()
        cosine, sine = self._impact.angle(np.clip(restitution, low, high))
        lowest = (restitution <= low) & (restitution < high)  # the rounded ε^n - w may differ from ε at c = 0
        return np.where(lowest, 0.0, cosine), np.where(lowest, 1.0, sine)

    def _relative_density(self, x: ArrayLike) -> Floats:
        """Eq. 20, times w."""
        value = _floats(x)
        cosine, sine = self._angle(value)
        density = self._orientation.density(cosine, sine) / self._impact.relative_slope(cosine)
        return np.where(self._outside(value), 0.0, density)

    @cached_property
    def _mean_loss(self) -> float:
        """Mean of (ε^n - ε)/w."""
        q, weights = _gauss(1)
        return float(weights @ self._impact.relative_loss(*self._orientation.quantile(q, 1.0 - q)))

    def _central(self, order: int) -> float:
        """Central moment of (ε^n - ε)/w."""
        q, weights = _gauss(order)
        loss = self._impact.relative_loss(*self._orientation.quantile(q, 1.0 - q))
        return float(weights @ (loss - self._mean_loss) ** order)


@lru_cache(maxsize=16)
def _gauss(order: int) -> tuple[Floats, Floats]:
    """Nodes and weights on [0, 1] that integrate ε to the power ``order`` over its quantile function.

    That function is analytic inside the ellipse with foci 0 and 1 and ρ = 4, for its pole is farther out
    (ρ > 6): at q = -1 ± i (2/π) arcosh(1/b) or q = -1/b, with b < 0.595. There |ε| < G = 8.9 times the
    greatest |ε| of the support, so n = 16 + order nodes leave less than (64/15) G^order ρ^(-2n)/(1 - ρ^-2)
    < 3e-19, in units of that greatest |ε| to the power ``order`` (L. N. Trefethen, SIAM Rev. 50, 67 (2008),
    Theorem 4.5).
    """
    nodes, weights = np.polynomial.legendre.leggauss(16 + order)
    return 0.5 * (1.0 + nodes), 0.5 * weights


def _floats(x: ArrayLike) -> Floats:
    return np.asarray(x, dtype=np.float64)


def _probability(q: ArrayLike) -> Floats:
    value = _floats(q)
    return np.where((value >= 0.0) & (value <= 1.0), value, np.nan)


def _scalar(values: Values) -> Values:
    """Make a 0-d array a NumPy scalar, as scipy does."""
    return np.asarray(values)[()]
