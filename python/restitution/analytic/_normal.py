"""The normal coefficient at the speed at which a body released from rest arrives: v² = 2g(H - h)."""

from typing import Annotated

from pydantic import Field

from restitution._internal.parameters import Number, Parameters
from restitution.analytic import _disc
from restitution.laws import Material


class Fall(Parameters):
    """From where a body falls: the height H of its centre of mass, and g; in SI units."""

    release_height: Annotated[Number, Field(gt=0, description="height of the centre of mass, m")]
    gravity: Annotated[Number, Field(gt=0, description="m/s²")]

    def squared_speed(self, height: _disc.Number) -> _disc.Number:
        """Return v² when the centre of mass has come down to a height."""
        return 2.0 * self.gravity * (self.release_height - height)

    def height(self, speed: float) -> float:
        """Return the height of the centre of mass at a speed."""
        return self.release_height - 0.5 * speed * speed / self.gravity


def kinks(normal: float | Material) -> tuple[float, ...]:
    """Return speeds in m/s at which the formula of ε_n changes."""
    return normal.kinks if isinstance(normal, Material) else ()


def coefficient(normal: float | Material, squared: _disc.Number, among: float) -> _disc.Number:
    """Return ε_n at v², complex or a disc, by the formula that holds about the speed ``among``."""
    return normal.formula(squared, among) if isinstance(normal, Material) else normal
