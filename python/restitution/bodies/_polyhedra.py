"""Convex polyhedra."""

from itertools import pairwise, product
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, Field

from restitution import _core
from restitution._internal.arrays import FloatArray, IntArray, reals
from restitution._internal.parameters import Allowed, ParameterError, wrong
from restitution.bodies._rigid import Density, Length, Matter, of_lengths

if TYPE_CHECKING:
    from scipy.spatial import ConvexHull

_POINTS = "four or more points (x, y, z) in m, finite, not all in one plane"


def _points(value: Any) -> tuple[tuple[float, ...], ...]:
    points = reals("points", value, _POINTS, unit="m", dimensions=(2,))
    if points.shape[0] < 4 or points.shape[1] != 3:
        raise ParameterError(wrong("points", value, _POINTS))
    return tuple(map(tuple, points.tolist()))


def hull_of(points: FloatArray) -> "ConvexHull | None":
    """Find the convex hull of points of any size; None if they lie in a plane."""
    from scipy.spatial import ConvexHull, QhullError

    size = np.ptp(points, axis=0).max()
    try:
        return ConvexHull((points - points[0]) / (size or 1.0))
    except QhullError:
        return None


_COPLANAR, _COLLINEAR = 1e-12, 1e-14
"""Triangles of a hull are one face if their corners are this close to its plane, and a corner is none if it
makes a smaller area with its neighbours, relative to the size of the hull."""


def _triangles(hull: "ConvexHull") -> list[tuple[int, ...]]:
    """Cut the faces of a hull into fans from their first corners.

    How a hull was found does not change these triangles, nor the sums over them: the explorer finds it
    otherwise, `web/src/rigid.ts`.
    """
    # Of points at the same place the first counts.
    _, first, place = np.unique(hull.points, axis=0, return_index=True, return_inverse=True)
    number = first[place.reshape(-1)]
    corners = hull.points[hull.simplices]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = (normals * hull.equations[:, :3]).sum(axis=1) < 0.0
    simplices = number[np.where(inward[:, None], hull.simplices[:, ::-1], hull.simplices)].tolist()
    normals[inward] *= -1.0
    sizes = np.linalg.norm(normals, axis=1)
    planes = normals / np.maximum(sizes, np.finfo(float).tiny)[:, None]

    def flat(triangles: IntArray, seeds: IntArray) -> NDArray[np.bool_]:
        """Say which triangles are of one face with others."""
        beside = corners[triangles] - corners[seeds, None, 0]
        heights = np.abs(np.einsum("nij,nj->ni", beside, planes[seeds])).max(axis=1)
        same_side = (normals[triangles] * planes[seeds]).sum(axis=1) > -_COPLANAR
        return np.asarray((heights < _COPLANAR) & same_side)

    neighbors = hull.neighbors.astype(np.int64)
    beside = np.repeat(np.arange(len(sizes)), 3)
    joined = set(beside[flat(neighbors.reshape(-1), beside)].tolist())
    free, found = set(range(len(sizes))), []
    for seed in np.argsort(-sizes).tolist():
        if seed not in free or sizes[seed] == 0.0:
            continue
        free.discard(seed)
        face = [seed]
        for triangle in face if seed in joined else []:
            near = np.array([i for i in neighbors[triangle].tolist() if i in free], dtype=np.int64)
            some = near[flat(near, np.full(len(near), seed))].tolist()
            free.difference_update(some)
            face += some
        found += _fan(hull.points, planes[seed], [simplices[triangle] for triangle in face])
    return sorted(found)


def _fan(points: FloatArray, normal: FloatArray, face: list[list[int]]) -> list[tuple[int, ...]]:
    """Cut a face, given as any triangles of it, anew."""
    edges = {(a, b) for x, y, z in face for a, b in ((x, y), (y, z), (z, x))}
    after = {a: b for a, b in edges if (b, a) not in edges}
    if len(face) == 1 or not after:  # or a needle so thin that all of it is one face
        return [tuple(sorted(of)) for of in face]
    around = [min(after)]
    while len(around) < len(after):
        around.append(after[around[-1]])
    sides = np.diff(points[[*around, around[0]]], axis=0)
    turns = np.cross(np.roll(sides, 1, axis=0), sides) @ normal
    kept = [corner for corner, turn in zip(around, turns, strict=True) if turn > _COLLINEAR]
    if not kept:
        return []
    least = kept.index(min(kept))
    corner, *others = kept[least:] + kept[:least]
    return [tuple(sorted((corner, *edge))) for edge in pairwise(others)]


class ConvexPolyhedron(Matter):
    """The homogeneous convex hull of points.

    Parameters
    ----------
    points : array_like, shape (n, 3)
        Its vertices (x, y, z), in m; finite, not all in one plane. Points inside of it do not matter.
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
    >>> corner = rs.ConvexPolyhedron([(0, 0, 0), (6e-3, 0, 0), (0, 6e-3, 0), (0, 0, 6e-3)])
    >>> corner.centre_of_mass.round(9).tolist()
    [0.0015, 0.0015, 0.0015]
    """

    by_place: ClassVar[tuple[str, ...]] = ("points",)

    points: Annotated[Any, Allowed(_POINTS), BeforeValidator(_points), Field(description="m")]
    density: Density = 2500.0

    if TYPE_CHECKING:  # or type checkers would take the fields for keyword arguments

        def __init__(
            self, points: Any, *, density: float = 2500.0, inertia: Any = None, centre: Any = None
        ) -> None: ...

    def _homogeneous(self) -> _core.Rigid:
        """Make the body of homogeneous matter."""
        points = np.array(self.points)
        hull = hull_of(points)
        if hull is None:
            raise ParameterError(wrong("points", points, _POINTS))
        return _core.polyhedron(self.points, _triangles(hull), self.density)


class Box(Matter):
    """A homogeneous cuboid.

    Parameters
    ----------
    a, b, c : float
        Lengths of the edges along x, y and z of the body, in m; finite and > 0.
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

        def __init__(
            self,
            a: float,
            b: float,
            c: float,
            *,
            density: float = 2500.0,
            inertia: Any = None,
            centre: Any = None,
        ) -> None: ...

    @property
    def vertices(self) -> tuple[tuple[float, float, float], ...]:
        """The eight corners in m, in the order of the numbers in ``contact``, from 1."""
        x, y, z = 0.5 * self.a, 0.5 * self.b, 0.5 * self.c
        return tuple(product((-x, x), (-y, y), (-z, z)))

    def _homogeneous(self) -> _core.Rigid:
        """Make the body of homogeneous matter."""
        with of_lengths(a=self.a, b=self.b, c=self.c):
            return _core.polyhedron(self.vertices, _TRIANGLES, self.density)


_TRIANGLES = [
    [0, 1, 3], [0, 3, 2], [4, 5, 7], [4, 7, 6], [0, 1, 5], [0, 5, 4],
    [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 3, 7], [1, 7, 5],
]  # fmt: skip
"""The faces of a box, two triangles each."""
