"""The distribution of ε at the first impact from rest of two equal balls on an axis.

ε as a function of the angle, and its inverse, without cancellation: dumbbells and spherocylinders touch with
the lower one of two balls of radius R, their centres L apart. With c = |cos θ|, the loss λ = ε_n - ε and
J = J_xx/m,

    paper's law (Eq. 17)   λ = w sin²θ / (1 + b c),           w = (1 + ε_n) L²/D,  b = 4LR/D,
                           D = 4J + 4R² + L²,
    without friction       λ = w (1 + q) sin²θ/(1 + q sin²θ),  w = (1 + ε_n) q/(1 + q),  q = L²/(4J).

Either falls strictly from w to 0 as c rises from 0 to 1, for all parameters: for Eq. 17 dλ/dc =
-w (bc² + 2c + b)/(1 + bc)² with 0 < b < 1, because D > 4R² + L² >= 4LR. So ε rises strictly with c, from ε_n
- w (axis horizontal) to ε_n (axis vertical), and has one inverse.

The inverse takes c and sin θ from different formulas, each exact at its own end. With t = λ/w, for Eq. 17:
c² + btc = 1 - t has the root c = 2(1 - t)/(bt + √(b²t² + 4(1 - t))), and sin²θ = t(1 + bc). Without friction:
sin²θ = t/(1 + q(1 - t)) and c² = (1 - t)(1 + q)/(1 + q(1 - t)).

ε_t does not occur: from rest without spin the contact point moves along the normal, v_c^t = 0.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import quad

from restitution.analytic._frozen import FirstImpact, Values, cosine_of, floats, scalar
from restitution.analytic._orientation import ORIENTATIONS, Floats, Orientation, OrientationName
from restitution.analytic._panels import gauss
from restitution.bodies import Dumbbell, Spherocylinder
from restitution.laws import Frictionless, Law, TangentialRestitution


@dataclass(frozen=True)
class ImpactFromRest(ABC):
    """ε as a function of the angle for a body that falls without spin."""

    normal: float  # ε_n
    greatest_loss: float  # w, the loss ε_n - ε of an impact with horizontal axis

    def restitution(self, cosine: Floats, sine: Floats) -> Floats:
        """Return ε at given c and sin θ."""
        return self.normal - self.greatest_loss * self.relative_loss(cosine, sine)

    def share(self, restitution: Floats) -> tuple[Floats, Floats]:
        """Return t = (ε_n - ε)/w, and 1 - t, at ε inside the support."""
        # ε_n - w is a rounded number.
        part = np.clip((self.normal - restitution) / self.greatest_loss, 0.0, 1.0)
        return part, 1.0 - part

    @abstractmethod
    def nodes(self, order: int) -> int:
        """Return the number of Gauss nodes that integrate ε to this power over its quantile function.

        That function is analytic inside the ellipse with foci 0 and 1 and some ρ, where |ε| < G times the
        greatest |ε| of the support. So n nodes leave less than (64/15) G^order ρ^(-2n)/(1 - ρ^-2), in units
        of that greatest |ε| to the power ``order`` (L. N. Trefethen, SIAM Rev. 50, 67 (2008), Theorem 4.5);
        the numbers below make it less than 4e-19.
        """

    @abstractmethod
    def relative_loss(self, cosine: Floats, sine: Floats) -> Floats:
        """Return (ε_n - ε)/w, in [0, 1]; keeps its digits where ε is one ulp from ε_n."""

    @abstractmethod
    def angle(self, restitution: Floats) -> tuple[Floats, Floats]:
        """Return (c, sin θ) at given ε inside the support."""

    @abstractmethod
    def relative_slope(self, cosine: Floats) -> Floats:
        """Return (dε/dc)/w."""


@dataclass(frozen=True)
class TangentialImpact(ImpactFromRest):
    """The paper's law, Eq. 17 and its inverse h⁻¹ of Eqs. 20–22."""

    asymmetry: float  # b, in (0, 1): how much the loss departs from w sin²θ

    def nodes(self, order: int) -> int:
        """ρ = 4, G = 10.8: the pole is at ρ > 6, at q = -1/b or -1 ± i (2/π) arcosh(1/b), b < 0.624."""
        return 16 + order

    def relative_loss(self, cosine: Floats, sine: Floats) -> Floats:
        return sine * sine / (1.0 + self.asymmetry * cosine)

    def angle(self, restitution: Floats) -> tuple[Floats, Floats]:
        part, rest = self.share(restitution)
        linear = self.asymmetry * part
        cosine = 2.0 * rest / (linear + np.sqrt(linear * linear + 4.0 * rest))
        return cosine, np.sqrt(part * (1.0 + self.asymmetry * cosine))

    def relative_slope(self, cosine: Floats) -> Floats:
        b = self.asymmetry
        return (b * cosine * cosine + 2.0 * cosine + b) / (1.0 + b * cosine) ** 2


@dataclass(frozen=True)
class FrictionlessImpact(ImpactFromRest):
    """The law without friction."""

    leverage: float  # q = L²/(4J), in (0, 3)

    def nodes(self, order: int) -> int:
        """ρ = 2, G = 11.5: the nearest pole is that of a long spherocylinder at c = √(4/3)."""
        return 32 + 2 * order

    def relative_loss(self, cosine: Floats, sine: Floats) -> Floats:
        q = self.leverage
        return (1.0 + q) * sine * sine / (1.0 + q * sine * sine)

    def angle(self, restitution: Floats) -> tuple[Floats, Floats]:
        part, rest = self.share(restitution)
        scale = 1.0 + self.leverage * rest
        return np.sqrt(rest * (1.0 + self.leverage) / scale), np.sqrt(part / scale)

    def relative_slope(self, cosine: Floats) -> Floats:
        q = self.leverage
        return 2.0 * (1.0 + q) * cosine / (1.0 + q * (1.0 - cosine * cosine)) ** 2


def impact_from_rest(body: Dumbbell | Spherocylinder, law: Law) -> ImpactFromRest:
    """Take the numbers from the body's shape; its size and density do not matter."""
    length = body.elongation
    # Radius 1, so that bodies of the same shape get the same bits.
    shape = type(body)(radius=1.0, separation=length, density=1.0)
    inertia, gain = shape.transverse_inertia / shape.mass, 1.0 + law.constant
    if isinstance(law, Frictionless):
        leverage = length / (4.0 * inertia) * length
        return FrictionlessImpact(law.constant, gain * (leverage / (1.0 + leverage)), leverage)
    denominator = 4.0 * (1.0 + inertia) + length * length
    loss = gain * (length / denominator * length)
    return TangentialImpact(law.constant, loss, 4.0 * length / denominator)


@dataclass(frozen=True)
class TwoBallsFirstImpact(FirstImpact):
    """Distribution of ε at the first impact from rest, all in closed form; make it with `first_impact`.

    Density, distribution function and quantiles are closed forms; moments are Gauss sums over the quantile
    function, exact to rounding.

    The density is infinite (but integrable) at the upper end ε_n of the support for "uniform-angle", and
    without friction at the lower end, too. Where L/R is so small that the support is only a few ulp of ε_n
    wide, `std`, `var`, `stats` and `entropy` keep all digits; an ε that is given or returned is a rounded
    number.
    """

    body: Dumbbell | Spherocylinder  # of equal spheres, separation > 0
    law: TangentialRestitution | Frictionless  # with a number for ``normal``
    orientation: OrientationName = "uniform-angle"

    @cached_property
    def _impact(self) -> ImpactFromRest:
        return impact_from_rest(self.body, self.law)

    @property
    def _orientation(self) -> Orientation:
        return ORIENTATIONS[self.orientation]

    def support(self) -> tuple[float, float]:
        """Return the least and greatest ε: axis horizontal and axis vertical (ε_n)."""
        return self._impact.normal - self._impact.greatest_loss, self._impact.normal

    def restitution(self, cos_theta: ArrayLike) -> Values:
        """Return ε at the angle θ between axis and plane normal (Eq. 17); nan unless -1 <= cos θ <= 1.

        The contact is with the lower sphere, hence the same value at cos θ and -cos θ.
        """
        cosine = np.abs(cosine_of(cos_theta))
        return scalar(self._impact.restitution(cosine, np.sqrt((1.0 - cosine) * (1.0 + cosine))))

    def cos_theta(self, restitution: ArrayLike) -> Values:
        """Return |cos θ| in [0, 1] that gives ε, the inverse of `restitution`; nan outside the support."""
        value = floats(restitution, "restitution")
        cosine, _ = self._angle(value)
        return scalar(np.where(self._outside(value), np.nan, cosine))

    def logpdf(self, x: ArrayLike) -> Values:
        with np.errstate(divide="ignore"):
            return scalar(np.log(self._relative_density(floats(x))) - np.log(self._impact.greatest_loss))

    def _density(self, x: Floats) -> Floats:
        """Eq. 21 without its misprints."""
        with np.errstate(over="ignore"):
            return self._relative_density(x) / self._impact.greatest_loss

    def _probability(self, x: Floats, *, above: bool) -> Floats:
        law = self._orientation
        return (law.above if above else law.below)(*self._angle(x))

    def _quantile(self, q: Floats, *, above: bool) -> Floats:
        shares = (1.0 - q, q) if above else (q, 1.0 - q)
        return self._impact.restitution(*self._orientation.quantile(*shares))

    def mean(self) -> float:
        return self._impact.normal - self._impact.greatest_loss * self._mean_loss

    def std(self) -> float:
        return self._impact.greatest_loss * float(np.sqrt(self._central_loss(2)))

    def entropy(self) -> float:
        def integrand(u: float) -> float:  # q = u³ tames the logarithm, steep at q = b where b is small
            cosine, _ = self._orientation.quantile(np.asarray(u**3), np.asarray(1.0 - u**3))
            return float(3.0 * u * u * np.log(self._impact.relative_slope(cosine)))

        slope, _ = quad(integrand, 0.0, 1.0, epsabs=1e-12, epsrel=0.0, limit=100)
        return float(self._orientation.entropy + slope + np.log(self._impact.greatest_loss))

    def _expected(
        self, func: Callable[[float], float], low: float, high: float, options: dict[str, Any]
    ) -> tuple[float, float]:
        below, up_to = float(self.cdf(low)), float(self.cdf(high))
        total, _ = quad(lambda q: func(float(self.ppf(q))), below, up_to, **options)
        return float(total), up_to - below

    def _mean_of(self, polynomial: Callable[[Floats], Floats], order: int) -> float:
        q, weights = gauss(self._impact.nodes(order))
        return float(weights @ polynomial(self.ppf(q)))

    def _standardised(self, order: int) -> float:
        return float((-1) ** order * self._central_loss(order) / self._central_loss(2) ** (order / 2))

    def _outside(self, restitution: Floats) -> NDArray[np.bool_]:
        low, high = self.support()
        return (restitution < low) | (restitution > high)

    def _angle(self, restitution: Floats) -> tuple[Floats, Floats]:
        """Return (c, sin θ) at ε, of the nearer end outside the support; exact at both ends."""
        low, high = self.support()
        cosine, sine = self._impact.angle(np.clip(restitution, low, high))
        lowest = (restitution <= low) & (restitution < high)  # the rounded ε_n - w may differ from ε at c = 0
        return np.where(lowest, 0.0, cosine), np.where(lowest, 1.0, sine)

    def _relative_density(self, x: Floats) -> Floats:
        """Eq. 20, times w."""
        cosine, sine = self._angle(x)
        with np.errstate(divide="ignore"):
            density = self._orientation.density(cosine, sine) / self._impact.relative_slope(cosine)
        return np.where(self._outside(x), 0.0, density)

    @cached_property
    def _mean_loss(self) -> float:
        """Mean of (ε_n - ε)/w."""
        q, weights = gauss(self._impact.nodes(1))
        return float(weights @ self._impact.relative_loss(*self._orientation.quantile(q, 1.0 - q)))

    def _central_loss(self, order: int) -> float:
        """Return the central moment of (ε_n - ε)/w."""
        q, weights = gauss(self._impact.nodes(order))
        loss = self._impact.relative_loss(*self._orientation.quantile(q, 1.0 - q))
        return float(weights @ (loss - self._mean_loss) ** order)
