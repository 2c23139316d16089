"""The distribution of ε at the first impact from rest of two equal balls on an axis."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import quad

from restitution.analytic._frozen import FirstImpact, Values, cosine_of, floats, scalar
from restitution.analytic._impact_from_rest import ImpactFromRest, impact_from_rest
from restitution.analytic._orientation import ORIENTATIONS, Floats, Orientation, OrientationName
from restitution.analytic._panels import gauss
from restitution.bodies import Dumbbell, Spherocylinder
from restitution.laws import Frictionless, TangentialRestitution


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
