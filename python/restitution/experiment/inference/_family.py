"""The balls and laws that an inference compares: nearly round bodies, and a law with one parameter in ε_n."""

from dataclasses import dataclass

import numpy as np

from restitution._internal.parameters import ParameterError, Problem
from restitution.bodies import Body, Form, from_roundness
from restitution.experiment.budget.experiment import STICKS, coupling, law_of_speed
from restitution.experiment.flight.laws import LawOfSpeed
from restitution.laws import Coulomb, Frictionless, Law, Plastic, Tabulated, Viscoelastic, check_steady


@dataclass(frozen=True)
class Family:
    """Bodies by L/R, and laws by the parameter of ε_n and by friction."""

    law: Law  # its kind is kept, and so is every parameter that is not inferred
    diameter: float  # in m
    form: Form  # as in `restitution.from_roundness`
    lobes: int
    wall: float | None = None  # in m

    @property
    def of_speed(self) -> LawOfSpeed:
        """ε_n(v), with one parameter; a `Scattered` law is refused, whose scatter is inferred."""
        check_steady(self.law)
        if isinstance(self.law.normal, Tabulated):
            raise ParameterError(Problem("law", ": a Tabulated ε_n has no parameter; take another material"))
        return law_of_speed(self.law)

    @property
    def parameter(self) -> str:
        """Name of the parameter of ε_n."""
        return "normal" if self.of_speed.name == "constant" else self.of_speed.parameters[0]

    @property
    def power(self) -> float:
        """The power of a speed that the parameter of ε_n goes as, where ε_n at all speeds is the same."""
        return {"normal": 0.0, "beta": -0.2, "yield_speed": 1.0}[self.parameter]

    @property
    def range(self) -> tuple[float, float]:
        """Between what the parameter is."""
        return (0.0, 1.0) if self.parameter == "normal" else (0.0, np.inf)

    def inside(self, value: float) -> float:
        """Return the parameter that is nearest to a value."""
        low, high = self.range
        return min(max(value, low + 1e-6), high - 1e-6)

    def body(self, elongation: float) -> Body:
        """Return the ball of an L/R, with L = 2t."""
        t = 0.25 * elongation * self.diameter
        return from_roundness(self.diameter, t, form=self.form, lobes=self.lobes, wall=self.wall)

    @property
    def words(self) -> str:
        """The form, as a sentence names it, and the wall if it is hollow."""
        return f"'{self.form}'" + ("" if self.wall is None else f" with a wall of {1e3 * self.wall:.3g} mm")

    def law_of(self, parameter: float, friction: float | None) -> Law:
        """Return the law of a parameter of ε_n and, where it is inferred, of its friction."""
        changed: dict[str, object] = {"normal": self._normal(parameter)}
        if friction is not None:
            changed["friction"] = friction
        return type(self.law)(
            **{name: getattr(self.law, name) for name in type(self.law).model_fields} | changed
        )

    def _normal(self, parameter: float) -> float | Viscoelastic | Plastic:
        normal = self.law.normal
        if isinstance(normal, Plastic):
            return Plastic(yield_speed=parameter)
        if isinstance(normal, Viscoelastic):
            # β goes as the dissipation A, all else the same.
            given = {name: getattr(normal, name) for name in type(normal).model_fields}
            return Viscoelastic(**given | {"dissipation": given["dissipation"] * parameter / normal.beta})
        return parameter

    def coupling(self, friction: float | None) -> float | None:
        """Return q of a round ball, as of `coupling`; its small asperities stick with any friction."""
        law = self.law_of(self.inside(0.5), friction)
        if isinstance(law, Coulomb):
            rough = law.friction > 0.0
            law = Coulomb(normal=law.normal, friction=STICKS) if rough else Frictionless(normal=law.normal)
        return coupling(law, self.body(0.0))
