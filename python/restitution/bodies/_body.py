"""The bases of every shape: mass, inertia, and the compiled body."""

from abc import abstractmethod
from collections.abc import Iterator, Mapping
from functools import cached_property
from inspect import cleandoc
from typing import Any, TypeVar

import numpy as np

from restitution import _core
from restitution._internal import text as _text
from restitution._internal.described import Described

B = TypeVar("B", bound="AnyBody")


class AnyBody(Described):
    """A body that can be dropped, in SI units. Mass and inertia follow from its parameters."""

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        super().__pydantic_init_subclass__(**options)
        if cls.__doc__:  # None under python -OO
            cls.__doc__ = _completed(cls, cleandoc(cls.__doc__))

    @cached_property
    @abstractmethod
    def compiled(self) -> _core.Solid | _core.Rigid:
        """The body as the core knows it, made and checked once."""

    @property
    @abstractmethod
    def lowest_position(self) -> float:
        """Least height of the centre of mass over the plane, about, in m."""

    @property
    def mass(self) -> float:
        """Mass m in kg."""
        return self.compiled.mass

    def attributes(self) -> dict[str, Any]:
        """Return what is given under its own name, as plain values that a netCDF file can hold."""
        return {name: value for name, value in self.model_dump().items() if value is not None}

    def __repr__(self) -> str:
        return str(self)  # a mesh can have a million triangles

    def _rows(self) -> Iterator[tuple[str, str]]:
        yield from super()._rows()
        yield "mass", _text.value(self.mass, "kg")


def _completed(kind: type[AnyBody], text: str) -> str:
    """Add the parameters of a body that only its bases describe to those in the text on it."""
    own, known = _text.entries(text), dict[str, str]()
    for base in kind.__mro__[-1:0:-1]:
        known |= _text.entries(base.__doc__ or "") if issubclass(base, AnyBody) else {}
    lacking = [entry for name, entry in known.items() if name in kind.model_fields and name not in own]
    start, mark, rest = text.partition("\n\nExamples\n")
    return "\n".join([start, *lacking]) + mark + rest


class Body(AnyBody):
    """A body of revolution, full or hollow, whose axis makes the angle θ with the plane normal.

    Parameters
    ----------
    density : float, default 2500
        Density in kg/m³; finite and > 0. Only mass and inertia depend on it, the motion does not.
    inertia : (float, float) or float, optional
        Moments of inertia across and about the axis, in kg m², instead of those of the matter, or one number
        for both; the second at most twice the first. Not together with ``wall``.
    """

    @cached_property
    def compiled(self) -> _core.Solid:
        made: _core.Solid = _core.body(type(self).__name__, self._arguments())
        return made

    @property
    def lowest_position(self) -> float:
        """Least height of the centre of mass over the plane, in m."""
        # Upright either way or level: in one of these the centre of mass comes lowest.
        return min(self.compiled.lowest(np.array([cosine])) for cosine in (-1.0, 0.0, 1.0))

    def _rows(self) -> Iterator[tuple[str, str]]:
        yield from super()._rows()
        yield "transverse_inertia", _text.value(self.transverse_inertia, "kg m²")
        yield "axial_inertia", _text.value(self.axial_inertia, "kg m²")

    @property
    def transverse_inertia(self) -> float:
        """Moment of inertia J_xx across the symmetry axis, through the centre of mass, in kg m²."""
        return self.compiled.transverse_inertia

    @property
    def axial_inertia(self) -> float:
        """Moment of inertia J_zz about the symmetry axis, in kg m²."""
        return self.compiled.axial_inertia


def of_attributes(kind: type[B], attributes: Mapping[Any, Any]) -> B:
    """Make a body again from its `attributes`; a KeyError has the names of those that are missing."""
    names = [
        name
        for name, field in kind.model_fields.items()
        if name in attributes or field.default is not None  # else it may be left out
    ]
    missing = [name for name in names if name not in attributes]
    if missing:
        raise KeyError(*missing)
    return kind(**{name: attributes[name] for name in names})
