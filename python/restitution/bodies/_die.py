"""Dice: the five Platonic solids."""

from itertools import permutations, product
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from pydantic import BeforeValidator

from restitution import _core
from restitution._internal.arrays import FloatArray
from restitution._internal.parameters import Allowed, ParameterError, wrong
from restitution.bodies._polyhedra import hull_of
from restitution.bodies._rigid import Density, Length, Matter, of_lengths

_FACES = "4, 6, 8, 12 or 20"
_GOLDEN = 0.5 * (1.0 + 5.0**0.5)


def _cyclic(x: float, y: float) -> list[tuple[float, ...]]:
    """Give (0, ±x, ±y) and what follows by shifting the axes round."""
    return [
        tuple(np.roll((0.0, a, b), shift).tolist())
        for shift in range(3)
        for a, b in product((-x, x), (-y, y))
    ]


_CUBE = list(product((-1.0, 1.0), repeat=3))
_SOLIDS: dict[int, tuple[float, list[tuple[float, ...]]]] = {
    4: (8.0**0.5, [point for point in _CUBE if np.prod(point) > 0]),
    6: (2.0, _CUBE),
    8: (2.0**0.5, sorted({point for sign in (-1.0, 1.0) for point in permutations((sign, 0.0, 0.0))})),
    12: (2.0 / _GOLDEN, _CUBE + _cyclic(1.0 / _GOLDEN, _GOLDEN)),
    20: (2.0, _cyclic(1.0, _GOLDEN)),
}
"""The length of an edge, and the vertices, of each about its centre."""


def _faces(value: Any) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value not in _SOLIDS:
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
    density : float, default 2500
        Density in kg/m³; finite and > 0. Only mass and inertia depend on it, the motion does not.
    inertia : array_like, shape (3, 3), optional
        Tensor of inertia about the centre of mass in kg m², in the axes of the body, where the matter is not
        homogeneous. The mass stays that of the density.
    centre : array_like, shape (3,), optional
        Its centre of mass in m, where a tensor of inertia is given; that of homogeneous matter if left out.

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

        def __init__(
            self, faces: int, edge: float, *, density: float = 2500.0, inertia: Any = None, centre: Any = None
        ) -> None: ...

    @property
    def vertices(self) -> FloatArray:
        """The vertices about the centre in m, in the order of the numbers in ``contact``, from 1."""
        edge, points = _SOLIDS[self.faces]
        with np.errstate(over="ignore"):
            return np.asarray(self.edge / edge * np.array(points))

    def _homogeneous(self) -> _core.Rigid:
        """Make the body of homogeneous matter."""
        hull = hull_of(np.array(_SOLIDS[self.faces][1]))
        assert hull is not None
        with of_lengths(edge=self.edge):
            return _core.polyhedron(self.vertices.tolist(), hull.simplices.tolist(), self.density)
