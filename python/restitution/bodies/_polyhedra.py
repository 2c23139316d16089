"""Convex polyhedra, dice among them."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Unpack

import numpy as np
from pydantic import BeforeValidator, Field

from restitution import _core
from restitution._internal.arrays import FloatArray
from restitution._internal.parameters import Allowed, ParameterError, wrong
from restitution.bodies._rigid import Density, FromRows, Length, Matter, OfMatter, rows

_POINTS = "four or more points (x, y, z) in m, finite, not all in one plane"


class ConvexPolyhedron(FromRows):
    """The homogeneous convex hull of points.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Its vertices (x, y, z), in m; finite, not all in one plane. Points inside of it do not matter.

    Examples
    --------
    >>> import restitution as rs
    >>> corner = rs.ConvexPolyhedron([(0, 0, 0), (6e-3, 0, 0), (0, 6e-3, 0), (0, 0, 6e-3)])
    >>> corner.centre_of_mass.round(9).tolist()
    [0.0015, 0.0015, 0.0015]
    """

    by_place: ClassVar[tuple[str, ...]] = ("points",)
    _columns: ClassVar[tuple[str, ...]] = ("x", "y", "z")

    points: Annotated[Any, Allowed(_POINTS), rows(_POINTS, 3, 4), Field(description="m")]

    if TYPE_CHECKING:  # or type checkers would take the fields for keyword arguments

        def __init__(self, points: Any, **matter: Unpack[OfMatter]) -> None: ...


class Box(Matter):
    """A homogeneous cuboid.

    Parameters
    ----------
    a, b, c : float
        Lengths of the edges along x, y and z of the body, in m; finite and > 0.

    Examples
    --------
    >>> import restitution as rs
    >>> die = rs.Box(a=1e-2, b=1e-2, c=1e-2)
    >>> bool(abs(die.principal_moments / die.mass - 1e-4 / 6).max() < 1e-18)
    True
    """

    by_place: ClassVar[tuple[str, ...]] = ("a", "b", "c")

    a: Length
    b: Length
    c: Length
    density: Density = 2500.0

    if TYPE_CHECKING:

        def __init__(self, a: float, b: float, c: float, **matter: Unpack[OfMatter]) -> None: ...

    @property
    def vertices(self) -> tuple[list[float], ...]:
        """The eight corners in m, in the order of the numbers in ``contact``, from 1."""
        return tuple(_core.faces("Box", self._arguments())[0])


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

    if TYPE_CHECKING:

        def __init__(self, faces: int, edge: float, **matter: Unpack[OfMatter]) -> None: ...

    @property
    def vertices(self) -> FloatArray:
        """The vertices about the centre in m, in the order of the numbers in ``contact``, from 1."""
        return np.array(_core.faces("Die", self._arguments())[0])
