"""The restitution of an impact from rest as a function of the angle, and its inverse, without cancellation.

Bodies that touch with the lower one of two equal balls of radius R, their centres L apart: dumbbells and
spherocylinders. With c = |cos θ|, the loss λ = ε_n - ε and J = J_xx/m,

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

from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np

from restitution.analytic._orientation import Floats
from restitution.bodies import Dumbbell, Spherocylinder
from restitution.laws import Frictionless, Law


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
