"""Eq. 17 and its inverse: the coefficient of restitution as a function of the angle, without cancellation.

With the loss λ = ε^n - ε, Eq. 17 reads

    λ = w sin²θ / (1 + b c),   w = (1 + ε^n) L²/D,   b = 4LR/D,   D = 4J_xx/m + 4R² + L²,   c = |cos θ|.

On 0 <= c <= 1, λ falls strictly from w to 0, whatever the parameters: dλ/dc = -w (bc² + 2c + b)/(1 + bc)²,
and b > 0. So ε rises strictly with c, from ε^n - w (axis horizontal) to ε^n (axis vertical), and has one
inverse. Also b < 1, because D > 4R² + L² >= 4LR.

The inverse takes c and sin θ from different formulas, each exact at its own end: with t = λ/w,
c² + btc = 1 - t has the root c = 2(1 - t)/(bt + √(b²t² + 4(1 - t))), and sin²θ = t(1 + bc).

ε^t does not occur: from rest without spin the contact point moves along the normal, v_c^t = 0.
"""

from dataclasses import dataclass

import numpy as np

from restitution.analytic._orientation import Floats
from restitution.bodies import Dumbbell
from restitution.laws import TangentialRestitution


@dataclass(frozen=True)
class ImpactFromRest:
    """ε as a function of the angle for a dumbbell that falls without spin (Eq. 17).

    Parameters
    ----------
    normal : float
        ε^n.
    greatest_loss : float
        w, the loss ε^n - ε of an impact with horizontal axis.
    asymmetry : float
        b = 4LR/(4J_xx/m + 4R² + L²), in (0, 1): how much the loss departs from w sin²θ.
    """

    normal: float
    greatest_loss: float
    asymmetry: float

    @classmethod
    def of(cls, body: Dumbbell, law: TangentialRestitution) -> "ImpactFromRest":
        """Take the three numbers from the body's shape; its size and density do not matter."""
        length = body.elongation
        # Radius 1, so that bodies of the same shape get the same bits.
        shape = Dumbbell(radius=1.0, separation=length, density=1.0)
        denominator = 4.0 * (1.0 + shape.transverse_inertia / shape.mass) + length * length
        return cls(
            normal=law.constant,
            greatest_loss=(1.0 + law.constant) * (length / denominator * length),
            asymmetry=4.0 * length / denominator,
        )

    def restitution(self, cosine: Floats, sine: Floats) -> Floats:
        """ε at given c and sin θ (Eq. 17)."""
        return self.normal - self.greatest_loss * self.relative_loss(cosine, sine)

    def relative_loss(self, cosine: Floats, sine: Floats) -> Floats:
        """(ε^n - ε)/w, in [0, 1]; keeps its digits where ε is one ulp from ε^n."""
        return sine * sine / (1.0 + self.asymmetry * cosine)

    def angle(self, restitution: Floats) -> tuple[Floats, Floats]:
        """(c, sin θ) at given ε inside the support: h⁻¹ of Eqs. 20–22."""
        part = np.clip(
            (self.normal - restitution) / self.greatest_loss, 0.0, 1.0
        )  # ε^n - w is a rounded number
        rest, linear = 1.0 - part, self.asymmetry * part
        cosine = 2.0 * rest / (linear + np.sqrt(linear * linear + 4.0 * rest))
        return cosine, np.sqrt(part * (1.0 + self.asymmetry * cosine))

    def relative_slope(self, cosine: Floats) -> Floats:
        """(dε/dc)/w, positive."""
        b = self.asymmetry
        return (b * cosine * cosine + 2.0 * cosine + b) / (1.0 + b * cosine) ** 2
