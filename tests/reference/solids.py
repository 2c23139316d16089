"""Rigid bodies: their matter and how far they reach below their centre of mass, from their own geometry.

SI units, in the axes that the body is given in. The matter of the union of balls is that of the balls less
that of the lenses where two of them overlap; no point may be in three of them.
"""

from abc import ABC, abstractmethod
from itertools import combinations, product
from typing import NamedTuple, Self

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq
from scipy.spatial import ConvexHull
from scipy.special import beta

Array = NDArray[np.float64]


class Matter(NamedTuple):
    """Integrals of 1, x and x xᵀ over a volume."""

    volume: float
    first: Array
    second: Array

    @classmethod
    def about(cls, centre: ArrayLike, volume: float, second: Array) -> Self:
        """Take the matter about its own centre."""
        place = np.asarray(centre, dtype=np.float64)
        return cls(volume, volume * place, second + volume * np.outer(place, place))

    def plus(self, other: "Matter", sign: float = 1.0) -> "Matter":
        """Add other matter, or take it away."""
        return Matter(
            self.volume + sign * other.volume,
            self.first + sign * other.first,
            self.second + sign * other.second,
        )

    @property
    def centre(self) -> Array:
        """The centre of mass."""
        return self.first / self.volume

    @property
    def tensor(self) -> Array:
        """The tensor of inertia about the centre of mass, per unit mass."""
        spread = self.second / self.volume - np.outer(self.centre, self.centre)
        return np.asarray(np.trace(spread) * np.eye(3) - spread)


NOTHING = Matter(0.0, np.zeros(3), np.zeros((3, 3)))


class Solid(ABC):
    """A body; `inertia` (kg m²) and `centre` take the place of those of homogeneous matter."""

    reach: float
    """No point is farther than this from the centre of mass."""

    def __init__(
        self, matter: Matter, density: float, inertia: Array | None = None, centre: ArrayLike | None = None
    ) -> None:
        self.mass = density * matter.volume
        self.tensor = matter.tensor if inertia is None else inertia / self.mass
        self.centre = matter.centre if centre is None else np.asarray(centre, dtype=np.float64)

    @abstractmethod
    def depths(self, up: Array) -> Array:
        """Reach of each part below the centre of mass; `up` is the plane's normal in the body."""

    @abstractmethod
    def lowest(self, up: Array, part: int) -> Array:
        """The lowest point of a part, from the centre of mass."""


class Balls(Solid):
    """The union of balls, rows (x, y, z, r)."""

    def __init__(
        self,
        balls: ArrayLike,
        density: float = 2500.0,
        inertia: Array | None = None,
        centre: ArrayLike | None = None,
    ) -> None:
        rows = np.asarray(balls, dtype=np.float64)
        matter = NOTHING
        for row in rows:
            matter = matter.plus(ball(row))
        for one, other in combinations(rows, 2):
            matter = matter.plus(lens(one, other), -1.0)
        super().__init__(matter, density, inertia, centre)
        self.places, self.radii = rows[:, :3] - self.centre, rows[:, 3]
        self.reach = float((np.linalg.norm(self.places, axis=1) + self.radii).max())

    def depths(self, up: Array) -> Array:
        """One for each ball."""
        return np.asarray(self.radii - self.places @ up)

    def lowest(self, up: Array, part: int) -> Array:
        """The bottom of the ball."""
        return np.asarray(self.places[part] - self.radii[part] * up)


def ball(row: Array) -> Matter:
    """Return the matter of a ball."""
    volume = 4.0 / 3.0 * np.pi * row[3] ** 3
    return Matter.about(row[:3], volume, volume * row[3] ** 2 / 5.0 * np.eye(3))


def lens(one: Array, other: Array) -> Matter:
    """Return the matter in two balls at once: discs of radius ρ at t along the line through the centres."""
    along = other[:3] - one[:3]
    distance = float(np.linalg.norm(along))
    if distance >= one[3] + other[3]:
        return NOTHING
    e = along / distance
    rim = (distance**2 + one[3] ** 2 - other[3] ** 2) / (2.0 * distance)
    nodes, weights = leggauss(4)  # exact: polynomials up to the fourth degree
    volume, first, second = 0.0, np.zeros(3), np.zeros((3, 3))
    for low, high, middle, radius in (
        (distance - other[3], rim, distance, other[3]),
        (rim, one[3], 0.0, one[3]),
    ):
        for node, weight in zip(nodes, weights, strict=True):
            t = 0.5 * (low + high) + 0.5 * (high - low) * node
            rho2 = radius**2 - (t - middle) ** 2
            part, place = 0.5 * (high - low) * weight * np.pi * rho2, one[:3] + t * e
            volume += part
            first += part * place
            second += part * (np.outer(place, place) + rho2 / 4.0 * (np.eye(3) - np.outer(e, e)))
    return Matter(volume, first, second)


class Polyhedron(Solid):
    """The convex hull of vertices: tetrahedra from its middle to the triangles of its surface."""

    def __init__(
        self,
        vertices: ArrayLike,
        density: float = 2500.0,
        inertia: Array | None = None,
        centre: ArrayLike | None = None,
    ) -> None:
        rows = np.asarray(vertices, dtype=np.float64)
        middle, matter = rows.mean(axis=0), NOTHING
        for triangle in ConvexHull(rows).simplices:
            matter = matter.plus(tetrahedron(np.array([middle, *rows[triangle]])))
        super().__init__(matter, density, inertia, centre)
        self.places = rows - self.centre
        self.reach = float(np.linalg.norm(self.places, axis=1).max())

    def depths(self, up: Array) -> Array:
        """One for each vertex."""
        return np.asarray(-self.places @ up)

    def lowest(self, up: Array, part: int) -> Array:
        """The vertex."""
        return np.asarray(self.places[part])


def tetrahedron(corners: Array) -> Matter:
    """Return the matter of a tetrahedron."""
    volume = abs(float(np.linalg.det(corners[1:] - corners[0]))) / 6.0
    total = corners.sum(axis=0)
    return Matter(
        volume, volume * total / 4.0, volume / 20.0 * (corners.T @ corners + np.outer(total, total))
    )


def corners(edges: ArrayLike) -> Array:
    """Return the corners of a box, in the order of their signs read as digits."""
    half = 0.5 * np.asarray(edges, dtype=np.float64)
    return np.array(list(product((-1.0, 1.0), repeat=3))) * half


class Superquadric(Solid):
    """(|x/a|^m + |y/b|^m)^(n/m) + |z/c|^n = 1; with n = m = 2 an ellipsoid."""

    def __init__(
        self,
        axes: ArrayLike,
        exponents: tuple[float, float] = (2.0, 2.0),
        density: float = 2500.0,
        inertia: Array | None = None,
        centre: ArrayLike | None = None,
    ) -> None:
        self.axes, (self.n, self.m) = np.asarray(axes, dtype=np.float64), exponents
        squares = np.array([self._integral(i) for i in (0, 1, 2)]) * self.axes**2
        volume = self._integral(None)
        super().__init__(Matter.about(np.zeros(3), volume, np.diag(squares)), density, inertia, centre)
        self.reach = float(np.linalg.norm(self.axes) + np.linalg.norm(self.centre))

    def _integral(self, squared: int | None) -> float:
        """The integral of 1, or of the square of a coordinate over its semi-axis.

        A slice at z is a figure |x/a|^m + |y/b|^m = s^m with s = (1 - |z/c|^n)^(1/n).
        """

        def power(p: float, q: float, n: float) -> float:
            """∫ x^p (1 - x^n)^(q/n) dx from 0 to 1."""
            return float(beta((p + 1.0) / n, q / n + 1.0) / n)

        if squared is None:
            slices, height = power(0.0, 1.0, self.m), power(0.0, 2.0, self.n)
        elif squared == 2:
            slices, height = power(0.0, 1.0, self.m), power(2.0, 2.0, self.n)
        else:
            slices, height = power(2.0, 1.0, self.m), power(0.0, 4.0, self.n)
        return float(8.0 * self.axes.prod() * slices * height)

    def depths(self, up: Array) -> Array:
        """One: the surface has no parts."""
        return np.array([-self.lowest(up, 0) @ up])

    def lowest(self, up: Array, part: int) -> Array:
        """Where -up is greatest on the surface: across the axis, then along it."""
        p, q, r = np.abs(up * self.axes).tolist()
        x, y = farthest(p, q, self.m)
        across, z = farthest(p * x + q * y, r, self.n)
        point = -np.sign(up) * self.axes * np.array([across * x, across * y, z])
        return np.asarray(point - self.centre)


def farthest(p: float, q: float, n: float) -> tuple[float, float]:
    """Return where p x + q y is greatest on x^n + y^n = 1 in the first quadrant; p and q are positive.

    With x = sin^(2/n) t and y = cos^(2/n) t the derivative has the sign of what vanishes here.
    """
    power = 2.0 - 2.0 / n

    def rise(t: float) -> float:
        return float(p * np.cos(t) ** power - q * np.sin(t) ** power)

    t = float(brentq(rise, 0.0, 0.5 * np.pi, xtol=1e-18, rtol=1e-15)) if p + q > 0.0 else 0.0
    return float(np.sin(t) ** (2.0 / n)), float(np.cos(t) ** (2.0 / n))
