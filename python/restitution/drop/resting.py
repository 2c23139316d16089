"""Where a body comes to rest: its potential wells, and the passes between them."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray, IntArray, real
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.bodies import (
    Box,
    Clump,
    ConvexPolyhedron,
    Die,
    Egg,
    Ellipsoid,
    Mesh,
    RigidBody,
    Rough,
    RoughSphere,
    Turned,
    directions,
)
from restitution.drop.dataset import labelled
from restitution.drop.recorded import RECORDS, check_filled, check_frame, check_successive, pull, variables
from restitution.drop.run import Run
from restitution.laws import Law

_BODIES = "a rigid body that is not rough: a Box, Clump, Die, Egg, Ellipsoid, Mesh and so on"
_STATE = ("velocity_after", "angular_velocity_after", "position")
_DIRECTIONS = 40_000
"""In the grid on which wells and passes of a clump or an ellipsoid are looked for."""
_FLAT = 1e-9
"""Faces of a hull are one where their normals and distances differ by less, relative to the size."""


_Pass = tuple[tuple[int, int], float]
"""Two faces, and over the edge or rim between them the height of the centre of mass above the plane."""


class _Landscape(NamedTuple):
    """The height of the centre of mass, where a direction of the body points down, by its critical points."""

    normals: FloatArray
    heights: FloatArray
    passes: list[_Pass]

    def wells(self) -> IntArray:
        """Faces that a body rests on: every way out of them leads up."""
        lowest = np.full(len(self.heights), np.inf)
        for (f, g), height in self.passes:
            lowest[f], lowest[g] = min(lowest[f], height), min(lowest[g], height)
        return np.flatnonzero(lowest > self.heights * (1.0 + _FLAT))

    def levels(self) -> FloatArray:
        """Find the lowest pass from the well of each face into another one, infinite where there is none."""
        level = np.full(len(self.heights), np.inf)
        part = [{face} for face in range(len(self.heights))]
        wells = set(self.wells().tolist())
        for (f, g), height in sorted(self.passes, key=lambda one: one[1]):
            if part[f] is part[g]:
                continue
            held = [part[f] & wells, part[g] & wells]
            if all(held):
                for face in held[0] | held[1]:
                    level[face] = min(level[face], height)
            joined = part[f] | part[g]
            for face in joined:
                part[face] = joined
        return level

    def well_of(self, face: int, height: float) -> int:
        """Find the only well that can be reached from a face below a height; -1 if there are others."""
        reached, new = {face}, [face]
        while new:
            at = new.pop()
            for pair, over in self.passes:
                if at in pair and over < height and not set(pair) <= reached:
                    new.extend(set(pair) - reached)
                    reached.update(pair)
        wells = reached & set(self.wells().tolist())
        return wells.pop() if len(wells) == 1 else -1


class _Edge(NamedTuple):
    """An edge of a polyhedron with its faces: normals turn from one to the other along an arc of a circle."""

    faces: tuple[int, int]
    ends: tuple[int, int]
    axis: FloatArray
    start: FloatArray
    foot: FloatArray

    def angle(self, direction: FloatArray) -> float:
        """Give the angle from the normal of the first face, along the arc."""
        return float(np.arctan2(np.cross(self.start, direction) @ self.axis, self.start @ direction))


class _Polyhedron:
    """Of the convex hull of points about the centre of mass."""

    def __init__(self, points: FloatArray) -> None:
        from scipy.spatial import ConvexHull

        size = float(np.abs(points).max())
        hull = ConvexHull(points / size)
        planes = hull.equations * [1.0, 1.0, 1.0, -1.0]
        face = np.full(len(planes), -1)
        for i, plane in enumerate(planes):
            if face[i] < 0:
                face[(face < 0) & (np.abs(planes - plane).max(axis=1) < _FLAT)] = face.max() + 1
        first = [int(np.argmax(face == number)) for number in range(face.max() + 1)]
        normals, heights = planes[first, :3], size * planes[first, 3]
        self.points, self.edges = points, list[_Edge]()
        passes = []
        for i, near in enumerate(hull.neighbors):
            for corner, j in enumerate(near):
                if i < j and face[i] != face[j]:
                    ends = tuple(int(k) for k in np.delete(hull.simplices[i], corner))
                    edge = self._edge((int(face[i]), int(face[j])), (ends[0], ends[1]), normals)
                    self.edges.append(edge)
                    turn = edge.angle(normals[face[j]])
                    over = 0.0 < edge.angle(edge.foot) < turn
                    highest = np.linalg.norm(edge.foot) if over else max(heights[list(edge.faces)])
                    passes.append((edge.faces, float(highest)))
        self.landscape = _Landscape(normals, heights, passes)

    def _edge(self, faces: tuple[int, int], ends: tuple[int, int], normals: FloatArray) -> _Edge:
        a, b = self.points[list(ends)]
        along = (b - a) / np.linalg.norm(b - a)
        start = normals[faces[0]]
        axis = np.cross(start, normals[faces[1]])
        return _Edge(faces, ends, axis / np.linalg.norm(axis), start, a - (a @ along) * along)

    def below(self, down: FloatArray) -> int:
        """Find the face that is reached downhill from where a direction points down.

        Away from the direction of the lowest vertex the centre of mass comes lower, until one of its edges
        touches, and from there to one of the faces of the edge.
        """
        vertex = int(np.argmax(self.points @ down))
        around = np.cross(self.points[vertex], down)
        found, lowest = int(np.argmax(self.landscape.normals @ down)), np.inf
        for edge in self.edges:
            if vertex not in edge.ends:
                continue
            first, last = (self.landscape.normals[face] for face in edge.faces)
            a, b = float(around @ first), float(around @ last)
            if a * b > 0.0 or a == b:
                continue
            crossing = (b * first - a * last) / (b - a)
            crossing /= np.linalg.norm(crossing)
            height = float(self.points[vertex] @ crossing)
            if height < lowest and np.cross(self.points[vertex], crossing) @ around > 0.0:
                lowest = height
                found = edge.faces[0] if edge.angle(crossing) < edge.angle(edge.foot) else edge.faces[1]
        return found


class _Turned:
    """Of a solid of revolution: its rims, with a face between two, and at an end that is off the axis."""

    def __init__(self, rims: FloatArray) -> None:
        angles = [np.arctan2(a[0] - b[0], b[1] - a[1]) for a, b in pairwise(rims)]
        self.before = int(rims[0, 1] > 0.0)
        angles = [0.0] * self.before + angles + [np.pi] * int(rims[-1, 1] > 0.0)
        normals = np.stack([np.sin(angles), np.zeros(len(angles)), np.cos(angles)], axis=1)
        self.rims, self.tops = rims, np.arctan2(rims[:, 1], rims[:, 0])
        heights = (rims @ normals[:, [2, 0]].T).max(axis=0)
        passes = []
        for i, (rim, top) in enumerate(zip(rims, self.tops, strict=True)):
            f, g = i + self.before - 1, i + self.before
            if f >= 0 and g < len(angles):
                over = angles[f] < top < angles[g]
                passes.append(((f, g), float(np.hypot(*rim) if over else max(heights[[f, g]]))))
        self.landscape = _Landscape(normals, heights, passes)

    def below(self, down: FloatArray) -> int:
        """Find the face that is reached downhill from where a direction points down."""
        across = float(np.hypot(down[0], down[1]))
        rim = int(np.argmax(self.rims @ [down[2], across]))
        face = rim + self.before - int(np.arctan2(across, down[2]) < self.tops[rim])
        return min(max(face, 0), len(self.landscape.heights) - 1)


class _Sampled:
    """Of a body with the support function h, on a grid of directions.

    h changes by at most `arm` times the angle, so that between two points of the grid a pass can be lower
    than on it by `miss`: passes are lowered by that, and wells that are shallower are one.
    """

    def __init__(self, h: Callable[[FloatArray], FloatArray], arm: float) -> None:
        from scipy.spatial import cKDTree

        grid = directions(_DIRECTIONS)
        near = float(np.sqrt(4.0 * np.pi / _DIRECTIONS))  # no direction is farther from the grid
        self.tree, self.miss, heights = cKDTree(grid), arm * near, h(grid)
        pairs = self.tree.query_pairs(2.0 * near, output_type="ndarray")
        # Each point leads to its lowest neighbour, and so to the bottom of a basin.
        here, there = np.concatenate([pairs, pairs[:, ::-1]]).T
        order = np.lexsort((heights[there], here))
        lowest = there[order][np.unique(here[order], return_index=True)[1]]
        down = np.where(heights[lowest] < heights, lowest, np.arange(_DIRECTIONS))
        while (down != down[down]).any():
            down = down[down]
        bottom = np.arange(_DIRECTIONS)  # of the well that a basin belongs to

        def well(point: int) -> int:
            while bottom[point] != point:
                point = bottom[point]
            return point

        apart = pairs[down[pairs[:, 0]] != down[pairs[:, 1]]]
        over = heights[apart].max(axis=1) - self.miss
        lowered: dict[tuple[int, int], float] = {}
        for one in np.argsort(over, kind="stable"):
            deep, shallow = sorted(
                (well(point) for point in down[apart[one]]), key=lambda point: heights[point]
            )
            if deep != shallow and over[one] <= heights[shallow]:
                bottom[shallow] = deep
            elif deep != shallow:
                lowered.setdefault((deep, shallow), float(over[one]))
        of_grid = np.array([well(point) for point in down])
        wells, self.well = np.unique(of_grid, return_inverse=True)
        normals = np.array([_lowest(h, grid[point], near) for point in wells])
        number_of = {int(point): i for i, point in enumerate(wells)}
        passes = [
            ((number_of[well(f)], number_of[well(g)]), height)
            for (f, g), height in lowered.items()
            if well(f) != well(g)
        ]
        self.landscape = _Landscape(normals, h(normals), passes)

    def below(self, down: FloatArray) -> int:
        """Find the well in whose basin a direction lies that points down."""
        return int(self.well[self.tree.query(down)[1]])


def _lowest(h: Callable[[FloatArray], FloatArray], start: FloatArray, reach: float) -> FloatArray:
    """Find the lowest direction about another one, by looking around closer and closer."""
    offsets = np.random.default_rng(0).normal(size=(200, 3))
    while reach > 1e-9:
        around = start + reach * np.concatenate([np.zeros((1, 3)), offsets])
        around /= np.linalg.norm(around, axis=1)[:, None]
        start = around[np.argmin(h(around))]
        reach *= 0.5
    return start


def _arm(body: RigidBody) -> float:
    """Bound the distance of the place that touches from the normal through the centre of mass."""
    if isinstance(body, Clump):
        spheres = np.array(body.spheres)
        return float(np.linalg.norm(spheres[:, :3] - body.centre_of_mass, axis=1).max())
    if isinstance(body, Ellipsoid) and not body.centre_of_mass.any():
        return float(max(body.semi_axes) - min(body.semi_axes))
    return body.compiled.farthest()


def _shape(body: Any) -> _Polyhedron | _Turned | _Sampled:
    if isinstance(body, Turned) and not isinstance(body, Egg):
        x, y, z = body.centre_of_mass
        if x == y == 0.0:
            return _Turned(np.array(body.compiled.rims) - [z, 0.0])
    if isinstance(body, Box | ConvexPolyhedron | Die | Mesh):
        points = np.array(body.points if isinstance(body, ConvexPolyhedron) else body.vertices)
        return _Polyhedron(points - body.centre_of_mass)
    if isinstance(body, RigidBody) and not isinstance(body, Rough | RoughSphere):
        return _Sampled(body.compiled.supports, _arm(body))
    raise ParameterError(wrong("body", body, _BODIES))


def settling_height(run: Run) -> float:
    """Find the energy over mg, in m, below which a particle of a run cannot leave the well that it is in."""
    shape = _shape(run.body)
    levels = shape.landscape.levels()
    if not np.isfinite(levels).any():
        raise ParameterError(wrong("body", run.body, "one that can come to rest in two ways or more"))
    if run.incline != 0.0:
        raise ParameterError(wrong("incline", run.incline, "0, a level plane, if until = 'settled'"))
    creates = run.law.entry().get("creates_energy", True) if isinstance(run.law, Law) else True
    if creates is not False and (creates is True or getattr(run.law, creates[0]) == creates[1]):
        raise ParameterError(wrong("law", run.law, "one that cannot create energy, if until = 'settled'"))
    return float(levels.min())


def resting(body: RigidBody, data: xr.Dataset) -> xr.Dataset:
    """Say on which face each particle comes to rest.

    A body rests on the faces over which its centre of mass lies; between them are passes, the edges and rims
    over which it would have to tip. Where the energy of a particle after an impact is below the lowest pass
    out of the well that it is in, it comes to rest there. Under a frictionless law its horizontal motion does
    not count. One that collapses above that, or whose impacts end, is undecided: rocking and rolling are
    lasting contact, which the model does not have. Wells and passes of bodies that are round are found on a
    grid of directions: their passes are stated too low by ``resolution``, so that a particle is decided later
    but not wrongly, and wells that are shallower are one.

    Parameters
    ----------
    body : Box, Clump, Egg, Ellipsoid or another rigid body
        The body of the run, but for a rough one.
    data : xarray.Dataset
        Impacts from `restitution.simulate` with ``record="state"``, over a level plane, in which no impact
        creates energy.

    Returns
    -------
    xarray.Dataset
        Over ``face``, from 0: its outward ``normal`` in the axes of the body, of a solid of revolution that
        at y = 0, the ``height`` of the centre of mass on it, and that of the lowest pass, ``barrier``, both
        in m; ``least`` and ``most``, the share of the particles that rest on it, without and with the
        undecided ones, and their standard errors ``least_error`` and ``most_error``. Over ``particle``:
        ``resting``, the face, -1 where it is undecided, and ``decided_after``, the number of impacts after
        which it was decided, 0 where it was not.

    Raises
    ------
    ValueError
        If the data lack states, are of another body, an inclined plane or impacts that create energy, or the
        body has no faces.

    Examples
    --------
    >>> import restitution as rs
    >>> brick = rs.Box(a=1e-2, b=2e-2, c=3e-2)
    >>> data = rs.simulate(brick, rs.Frictionless(normal=0.5), particles=50, impacts=200, record="state")
    >>> found = rs.resting(brick, data)
    >>> found.height.round(4).values.tolist()
    [0.015, 0.015, 0.01, 0.01, 0.005, 0.005]
    """
    shape = _shape(body)
    needed: dict[str, tuple[str, ...]] = dict.fromkeys(_STATE, (*RECORDS, "component"))
    needed |= {"energy_ratio": RECORDS, "attitude": (*RECORDS, "quaternion")}
    velocity, spin, position, ratio, attitude = variables("data", data, "restitution.simulate", needed)
    check_frame("data", data)
    check_filled("data", ratio)
    check_successive("data", data, start=0)
    gravity, incline = pull("data", data)
    mass = real("data.mass", data.attrs.get("mass", np.nan), "that of the body")
    if data.attrs.get("body") != type(body).__name__ or mass != body.mass:
        text = f": of a {data.attrs.get('body')} of {mass:g} kg; must be of the body, {body!r}"
        raise ParameterError(Problem("data", text))
    if incline != 0.0:
        raise ParameterError(wrong("data.incline", incline, "0, a level plane"))
    if np.nanmax(ratio, initial=0.0) > 1.0 + 1e-9:
        text = " has impacts that create energy, after which nothing is decided: must be of another law"
        raise ParameterError(Problem("data.energy_ratio", text))

    moving = velocity if data.attrs.get("law") != "Frictionless" else velocity[..., 2:]
    with np.errstate(over="ignore", invalid="ignore"):  # nothing is decided by what no double holds
        turning = in_body(attitude, spin)
        rotation = (turning @ body.inertia_tensor * turning).sum(-1) / mass
        energy = position[..., 2] + 0.5 * ((moving**2).sum(-1) + rotation) / gravity
        down = in_body(attitude, np.array([0.0, 0.0, -1.0]))
    impacts = np.isfinite(energy).sum(axis=1)

    landscape = shape.landscape
    wells, level = landscape.wells(), landscape.levels()
    order = wells[np.argsort(-landscape.heights[wells], kind="stable")]
    number = {int(face): i for i, face in enumerate(order)}
    rests, after = np.full(len(impacts), -1), np.zeros(len(impacts), np.int64)
    for particle, count in enumerate(impacts):
        if count:
            last = count - 1
            well = landscape.well_of(shape.below(down[particle, last]), energy[particle, last])
            if well >= 0:
                rests[particle] = number[well]
                after[particle] = 1 + int(np.argmax(energy[particle] < level[well]))
    decided = np.bincount(rests[rests >= 0], minlength=len(order)) / len(rests)
    undecided = float(np.mean(rests < 0))

    def error(share: FloatArray) -> FloatArray:
        return np.sqrt(share * (1.0 - share) / len(rests))

    about = {
        "normal": (("face", "component"), landscape.normals[order], "outward normal, axes of the body", "1"),
        "height": ("face", landscape.heights[order], "height of the centre of mass at rest", "m"),
        "barrier": ("face", level[order], "height of the centre of mass on the lowest pass", "m"),
        "least": ("face", decided, "share of the particles that rest there", "1"),
        "most": ("face", decided + undecided, "the same with all that are undecided", "1"),
        "least_error": ("face", error(decided), "standard error of least", "1"),
        "most_error": ("face", error(decided + undecided), "standard error of most", "1"),
        "resting": ("particle", rests, "number of the face, -1: undecided", "1"),
        "decided_after": ("particle", after, "number of impacts after which it was decided", "1"),
    }
    coordinates = {name: data[name] for name in ("particle", "component") if name in data.coords}
    attributes = data.attrs | {"undecided": undecided, "resolution": getattr(shape, "miss", 0.0)}
    return xr.Dataset(labelled(about), coordinates, attributes)


def in_body(attitude: FloatArray, vector: FloatArray) -> FloatArray:
    """Turn vectors of space to the axes of the body."""
    scalar, axis = attitude[..., :1], -attitude[..., 1:]
    twice = 2.0 * np.cross(axis, vector)
    result: FloatArray = vector + scalar * twice + np.cross(axis, twice)
    return result
