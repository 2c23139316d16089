"""The base of every shape: mass, inertia, and the compiled body."""

from collections.abc import Iterator
from functools import cached_property

from restitution import _core
from restitution._internal import text as _text
from restitution._internal.described import Described


class Body(Described):
    """A homogeneous or loaded body of revolution, in SI units.

    Its symmetry axis makes the angle θ with the plane normal. Mass and inertia follow from its parameters.
    """

    @cached_property
    def compiled(self) -> _core.Solid:
        """The body as the core knows it, made and checked once."""
        return _core.body(type(self).__name__, self._arguments())

    def _rows(self) -> Iterator[tuple[str, str]]:
        yield from super()._rows()
        yield "mass", _text.value(self.mass, "kg")
        yield "transverse_inertia", _text.value(self.transverse_inertia, "kg m²")
        yield "axial_inertia", _text.value(self.axial_inertia, "kg m²")

    @property
    def mass(self) -> float:
        """Mass m in kg."""
        return self.compiled.mass

    @property
    def transverse_inertia(self) -> float:
        """Moment of inertia J_xx across the symmetry axis, through the centre of mass, in kg m²."""
        return self.compiled.transverse_inertia

    @property
    def axial_inertia(self) -> float:
        """Moment of inertia J_zz about the symmetry axis, in kg m²."""
        return self.compiled.axial_inertia
