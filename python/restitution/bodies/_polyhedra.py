"""Convex polyhedra."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Unpack

from pydantic import Field

from restitution import _core
from restitution._internal.parameters import Allowed
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
    columns: ClassVar[tuple[str, ...]] = ("x", "y", "z")

    points: Annotated[Any, Allowed(_POINTS), rows(_POINTS, 3, 4), Field(description="m")]
    density: Density = 2500.0

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
