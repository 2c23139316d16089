"""The symmetric top in free flight, exactly.

With inertia J_xx across and J_zz along the axis e, the angular momentum is Λ = J_xx ω + (J_zz - J_xx)(ω·e)
e, and de/dt = ω × e = (Λ/J_xx) × e because the second term is parallel to e. Λ is conserved, so e turns
about the fixed direction of Λ at the constant rate |Λ|/J_xx; so does ω, which is a fixed combination of Λ
and e. (Eq. 3 is the case ω ⟂ e, where Λ/J_xx = ω.)

Lengths in m, times in s, and everything per unit mass: the motion does not depend on the mass.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from reference.arithmetic import Real, Vector, add, cross, dot, mp, rotated, scaled, vector


@dataclass(frozen=True)
class Body:
    """A dumbbell: radius R, half the distance of the centres L/2, and J_xx/m, J_zz/m."""

    radius: Real
    arm: Real
    transverse: Real
    axial: Real

    @classmethod
    def dumbbell(cls, radius: float, separation: float) -> "Body":
        """Inertia by numerical quadrature over the slices of the upper half (A2, A3, A5, A6)."""
        r, arm = mp.mpf(radius), mp.mpf(separation) / 2
        # Where the spheres are apart (L > 2R), the slices between them are empty.
        bottom, top = max(mp.mpf(0), arm - r), arm + r

        def over_slices(weight: Callable[[Real, Real], Real]) -> Real:
            return mp.quadgl(lambda z: weight(r**2 - (z - arm) ** 2, z), [bottom, top])  # ϱ²(z) (A2)

        mass = over_slices(lambda rho2, z: rho2)  # (A3), without the common factor 2πρ
        axial = over_slices(lambda rho2, z: rho2**2 / 2)  # (A5)
        transverse = over_slices(lambda rho2, z: rho2**2 / 4 + z**2 * rho2)  # (A6)
        return cls(r, arm, transverse / mass, axial / mass)

    def inertia(self, axis: Vector) -> tuple[Any, Any]:
        """J/m and its inverse in the laboratory frame, Â diag(J_xx, J_xx, J_zz) Â⁻¹ (end of the Appendix)."""
        helper = vector((1, 0, 0) if abs(axis[2]) > abs(axis[0]) else (0, 0, 1))
        first = cross(axis, helper)
        first = scaled(1 / mp.sqrt(dot(first, first)), first)
        frame = mp.matrix([first, cross(axis, first), axis]).T  # columns: the principal axes
        j, k = self.transverse, self.axial
        return frame * mp.diag([j, j, k]) * frame.T, frame * mp.diag([1 / j, 1 / j, 1 / k]) * frame.T


@dataclass(frozen=True)
class State:
    """Where the body is and how it moves: height of the centre of mass, v_G, unit vector of the axis, ω."""

    time: Real
    height: Real
    velocity: Vector
    axis: Vector
    spin: Vector

    @classmethod
    def released(
        cls, angle: float, height: float, velocity: Any = (0, 0, 0), spin: Any = (0, 0, 0)
    ) -> "State":
        """The axis leans by `angle` from the vertical towards +x."""
        cosine, sine = mp.cos_sin(mp.mpf(angle))
        return cls(mp.mpf(0), mp.mpf(height), vector(velocity), (sine, mp.mpf(0), cosine), vector(spin))

    def precession(self, body: Body) -> Vector:
        """Λ/J_xx, the angular velocity at which the axis turns in free flight."""
        along = (body.axial / body.transverse - 1) * dot(self.spin, self.axis)
        return add(self.spin, self.axis, along)

    def after(self, time: Real, body: Body, gravity: Real) -> "State":
        """The state after a flight of `time`: Eq. 5, and the exact rotation about Λ (Eq. 3)."""
        turn = self.precession(body)
        return State(
            self.time + time,
            self.height + self.velocity[2] * time - gravity / 2 * time**2,
            add(self.velocity, vector((0, 0, -gravity)), time),
            rotated(self.axis, turn, time),
            rotated(self.spin, turn, time),
        )

    def rotational_energy(self, body: Body) -> Real:
        """½ ω·Jω/m."""
        along = dot(self.spin, self.axis)
        across = dot(self.spin, self.spin) - along**2
        return (body.transverse * across + body.axial * along**2) / 2

    def kinetic_energy(self, body: Body) -> Real:
        """Translation and rotation, per unit mass."""
        return dot(self.velocity, self.velocity) / 2 + self.rotational_energy(body)
