"""Dice: the five Platonic solids."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Unpack

import numpy as np
from pydantic import BeforeValidator

from restitution import _core
from restitution._internal.arrays import FloatArray
from restitution._internal.parameters import Allowed, ParameterError, wrong
from restitution.bodies._rigid import Density, Length, Matter, OfMatter

_FACES = "4, 6, 8, 12 or 20"


def _faces(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value not in (4, 6, 8, 12, 20):
        raise ParameterError(wrong("faces", value, _FACES))
    return int(value)


class Die(Matter):
    """A homogeneous die with 4, 6, 8, 12 or 20 equal faces: a tetrahedron, cube, octahedron and so on.

    Parameters
    ----------
    faces : {4, 6, 8, 12, 20}
        Number of faces.
    edge : float
        Length of an edge in m; finite and > 0.

    Examples
    --------
    >>> import restitution as rs
    >>> die = rs.Die(faces=20, edge=1e-2)
    >>> die.vertices.shape
    (12, 3)
    """

    by_place: ClassVar[tuple[str, ...]] = ("faces", "edge")

    faces: Annotated[int, Allowed(_FACES), BeforeValidator(_faces)]
    edge: Length
    density: Density = 2500.0

    if TYPE_CHECKING:  # or type checkers would take the fields for keyword arguments

        def __init__(self, faces: int, edge: float, **matter: Unpack[OfMatter]) -> None: ...

    @property
    def vertices(self) -> FloatArray:
        """The vertices about the centre in m, in the order of the numbers in ``contact``, from 1."""
        return np.array(_core.faces("Die", self._arguments())[0])
