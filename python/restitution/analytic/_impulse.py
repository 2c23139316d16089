"""The impulse of an impact from rest, for every law: all have a closed form there.

The point of contact, h below and a beside the centre of mass, comes down along the normal: there is no slip
before the impact. With J = J_xx/m and D = J + a² + h², the impulse matrix per unit mass has K_nn = 1 + a²/J,
K_uu = 1 + h²/J and |K_nu| = ah/J, and every law gives ε = ε_n - λ with a loss λ as if

* "free": nothing acted along the plane, λ = (1 + ε_n) a²/(J + a²);
* "stuck": the point of contact never slipped, λ = (1 + ε_n) a²/D;
* "sliding": friction were at its limit throughout, λ = (1 + ε_n)(a² - μah)/(J + a² - μah);
* "part": the tangential impulse were (1 + e_t) times that of a sticking plastic impact,
  λ = (1 + e) a²/(J + a²) - (1 + e_t) a²h²/((J + a²)D), which for e_t = e is as if stuck.

The paper's law is "stuck" for any ε_t (Eq. 17). Under Coulomb's law the contact slides from the start and for
good if ah > μ(J + h²), else it never does; v_n is linear in the impulse, so that all hypotheses agree.
Chatterjee and Ruina's law is "part" inside the friction cone, and "sliding" on it.
"""

from dataclasses import dataclass
from typing import Literal, TypeAlias

from restitution._internal.parameters import ParameterError, wrong
from restitution.analytic._disc import Number
from restitution.laws import Law

Mode: TypeAlias = Literal["free", "stuck", "sliding", "part"]


@dataclass(frozen=True)
class Impulse:
    """The impulse of an impact from rest."""

    law: Law
    inertia: float  # J, in the square of the unit of h and a

    def modes(self) -> tuple[Mode, Mode]:
        """Return the modes where `margin` is not positive, and where it is, of the law's entry."""
        modes = self.law.entry().get("from_rest")
        if modes is None:
            raise ParameterError(wrong("law", self.law, "one whose first impact from rest has a closed form"))
        within, beyond = modes
        return within, beyond

    def margin(self, normal: Number, height: Number, arm: Number) -> Number:
        """Positive where the tangential impulse would leave the friction cone; ε_n = normal."""
        within, beyond = self.modes()
        if beyond != "sliding":
            return 0.0
        inertia, couple = self.inertia, height * arm
        if within == "stuck":
            return couple - self.friction * (inertia + height * height)
        room = inertia + arm * arm - self.friction * couple
        whole = inertia + arm * arm + height * height
        return self.kept * couple * room - self.friction * inertia * (1.0 + normal) * whole

    def loss(self, mode: Mode, normal: Number, height: Number, arm: Number) -> Number:
        """Return λ = ε_n - ε, ε_n = normal."""
        square, inertia = arm * arm, self.inertia
        if mode == "stuck":  # (17)
            return (1.0 + normal) * square / (inertia + square + height * height)
        if mode == "sliding":
            dragged = square - self.friction * (height * arm)
            return (1.0 + normal) * dragged / (inertia + dragged)
        share = height * height / (inertia + square + height * height)
        return square / (inertia + square) * (1.0 + normal - self.kept * share)

    def raised(self, mode: Mode, normal: Number, height: Number, arm: Number) -> Number:
        """Positive where ε > ε_n."""
        if mode == "sliding":
            return self.friction * height - arm
        if mode == "part":
            square = height * height
            return self.kept * square - (1.0 + normal) * (self.inertia + arm * arm + square)
        return -1.0

    def threshold(self, mode: Mode, height: Number, arm: Number) -> Number:
        """Return the constant ε_n at which ε = 0 in this mode."""
        square, inertia = arm * arm, self.inertia
        if mode == "stuck":
            return square / (inertia + height * height)
        if mode == "sliding":
            return (square - self.friction * (height * arm)) / inertia
        share = height * height / (inertia + square + height * height)
        return square / inertia * (1.0 - self.kept * share)

    @property
    def friction(self) -> float:
        """μ, of the laws that have it."""
        return float(getattr(self.law, "friction"))  # noqa: B009

    @property
    def kept(self) -> float:
        """1 + e_t, the share of the impulse that sticking adds to that without friction; 0 without any."""
        return 1.0 + getattr(self.law, "tangential") if "part" in self.modes() else 0.0  # noqa: B009
