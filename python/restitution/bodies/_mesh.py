"""Solids within closed surfaces of triangles, as scanners and design programs write them."""

from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field

from restitution import _core
from restitution._internal import files
from restitution._internal.arrays import FloatArray, IntArray, reals
from restitution._internal.parameters import Allowed, ParameterError, Problem, wrong
from restitution.bodies._rigid import LARGEST, SMALLEST, Density, FromFile, rows

_VERTICES = "four or more points (x, y, z) in m, finite, not all in one plane"
_TRIANGLES = "triples of numbers of the vertices, from 0"
_SUFFIXES = (".stl", ".obj", ".ply")


def _triangles(value: Any) -> tuple[tuple[int, ...], ...]:
    found = reals("triangles", value, _TRIANGLES, dimensions=(2,))
    if found.shape[0] == 0 or found.shape[1] != 3 or (found < 0).any() or (found % 1.0 != 0.0).any():
        raise ParameterError(wrong("triangles", value, _TRIANGLES))
    return tuple(map(tuple, found.astype(np.int64).tolist()))


class Mesh(FromFile):
    """A homogeneous solid within closed surfaces of triangles, convex or not.

    Only its convex hull touches the plane, so that the motion of any solid is exact; mass, centre of mass and
    inertia are its own. A surface within another one is a cavity if its triangles are oriented to it. Solids
    that overlap count twice there.

    Parameters
    ----------
    vertices : array_like, shape (n, 3)
        Points (x, y, z), in m; finite, not all in one plane.
    triangles : array_like of int, shape (m, 3)
        Numbers of three vertices, from 0, counter-clockwise as seen from outside. Every edge is that of as
        many triangles in one direction as in the other, or the surface is not closed, or not oriented.

    Examples
    --------
    >>> import restitution as rs
    >>> corners = [(0, 0, 0), (6e-3, 0, 0), (0, 6e-3, 0), (0, 0, 6e-3)]
    >>> mesh = rs.Mesh(vertices=corners, triangles=[(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    >>> mesh.centre_of_mass.round(9).tolist()
    [0.0015, 0.0015, 0.0015]
    """

    vertices: Annotated[Any, Allowed(_VERTICES), rows(_VERTICES, 3, 4), Field(description="m")]
    triangles: Annotated[Any, Allowed(_TRIANGLES), BeforeValidator(_triangles)]
    density: Density = 2500.0

    @classmethod
    def _shape(cls, place: Path, scale: float) -> dict[str, Any]:
        vertices, triangles = _read(place)
        if not SMALLEST <= scale * float(np.abs(vertices).max()) <= LARGEST:
            allowed = f"such that the mesh is {SMALLEST:g} to {LARGEST:g} m in size"
            raise ParameterError(wrong("scale", scale, allowed))
        return {"vertices": scale * vertices, "triangles": triangles}

    @cached_property
    def hull(self) -> IntArray:
        """Numbers of the vertices of the convex hull; ``contact`` numbers these, from 1."""
        return np.unique(np.array(_core.hull(self.vertices), dtype=np.int64))


def _read(path: Path) -> tuple[FloatArray, IntArray]:
    """Read vertices, each once, and triangles."""
    if path.suffix.lower() not in _SUFFIXES:
        raise ParameterError(wrong("path", str(path), f"the name of a mesh, {', '.join(_SUFFIXES)}"))
    files.check_regular(path)
    path.open("rb").close()  # an OSError that names the file, if it cannot be read
    try:
        import trimesh
    except ImportError:
        text = ": reading meshes needs trimesh: pip install 'restitution[mesh]'"
        raise ParameterError(Problem(str(path), text)) from None
    try:
        found = trimesh.load_mesh(path, process=False, skip_materials=True)
        corners = np.array(found.vertices, dtype=np.float64).reshape(-1, 3)[np.array(found.faces)]
    except MemoryError:
        raise
    except Exception as error:  # what readers raise on damaged files is anything
        raise ParameterError(Problem(str(path), f": not a mesh that can be read ({error})")) from None
    if corners.ndim != 3 or corners.shape[1:] != (3, 3) or not len(corners):
        raise ParameterError(Problem(str(path), ": no triangles; must be a mesh of them"))
    # In STL each triangle has vertices of its own; where they are the same is exact, but for the sign of 0.
    vertices, triangles = np.unique(corners.reshape(-1, 3) + 0.0, axis=0, return_inverse=True)
    return vertices, triangles.reshape(-1, 3).astype(np.int64)
