"""Contact of a body with the plane: height h of the centre of mass and lever arm a, for every angle.

The centre of mass of a body that stands on the plane is h(θ) high, its support function. The point of contact
is h below it and a = |h′| beside it. For a ball of radius ϱ at s on the axis h = ϱ - s cos θ, a = |s| sin θ;
for a spheroid h² = A² sin²θ + C² cos²θ, a = |C² - A²| sin θ cos θ/h; for what a circle of radius ϱ makes as
it turns about the axis, its centre d beside it, h = ϱ - s cos θ + d sin θ, a = |s sin θ + d cos θ|. With
ϱ = 0 that is a rim, with d < 0 the flank of an egg.
"""

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, TypeAlias

import numpy as np

from restitution.analytic._disc import Number
from restitution.bodies import Body, Egg, RoughSphere, Turned


@dataclass(frozen=True)
class Ball:
    """A ball on the axis: its radius ϱ, and its place s from the centre of mass along the axis."""

    radius: float
    place: float

    def contact(self, sine: Number, cosine: Number) -> tuple[Number, Number]:
        """Return the height h and lever arm a."""
        return self.radius - self.place * cosine, abs(self.place) * sine

    def cosines(self, height: float) -> tuple[float, ...]:
        """Cos θ at which the centre of mass is so high, if it ever is."""
        return ((self.radius - height) / self.place,) if self.place else ()


@dataclass(frozen=True)
class Band:
    """A circle turned about the axis: its radius ϱ, its centre s along the axis and d beside it.

    The lever arm s sin θ + d cos θ has one sign where the band is used, that of ``side``.
    """

    radius: float
    place: float
    offset: float
    side: float = 1.0

    def contact(self, sine: Number, cosine: Number) -> tuple[Number, Number]:
        height = self.radius - self.place * cosine + self.offset * sine
        return height, (self.place * sine + self.offset * cosine) * self.side

    def cosines(self, height: float) -> tuple[float, ...]:
        distance, middle = math.hypot(self.place, self.offset), math.atan2(self.offset, -self.place)
        share = (height - self.radius) / distance if distance else math.nan
        if not abs(share) <= 1.0:
            return ()
        return tuple(math.cos(middle + sign * math.acos(share)) for sign in (-1.0, 1.0))


@dataclass(frozen=True)
class Ellipsoid:
    """A spheroid about its centre: semi-axes A across and C along the axis. For θ in [0, π/2]."""

    equatorial: float
    polar: float

    def contact(self, sine: Number, cosine: Number) -> tuple[Number, Number]:
        across, along = self.equatorial * sine, self.polar * cosine
        height = (across * across + along * along) ** 0.5
        excess = abs((self.polar - self.equatorial) * (self.polar + self.equatorial))
        return height, excess * sine * cosine / height

    def cosines(self, height: float) -> tuple[float, ...]:
        a, c = self.equatorial, self.polar
        square = (height - a) * (height + a) / ((c - a) * (c + a)) if a != c else math.nan
        return (math.sqrt(square),) if square >= 0.0 else ()


Hull: TypeAlias = Ball | Band | Ellipsoid


class Side(NamedTuple):
    """A part of the surface, and the angles from low to high at which it touches."""

    low: float
    high: float
    hull: Hull


@dataclass(frozen=True)
class Outline:
    """All that the first impact needs of a body's shape; lengths in units of ``unit``."""

    unit: float  # the greatest height of the centre of mass above the plane, in m
    inertia: float  # J = J_xx/m
    sides: tuple[Side, ...]  # from θ = 0 to π/2 if the body looks the same upside down, else to π

    @classmethod
    def of(cls, body: Body | RoughSphere | Turned) -> "Outline":
        """Make the hull of a body; of a rough sphere that of the asperity that touches."""
        if isinstance(body, RoughSphere):
            return _rough(body)
        unit = body.compiled.farthest()
        if not isinstance(body, Body):
            inertia = float(body.inertia_tensor[0, 0]) / unit / body.mass / unit
            return cls(unit, inertia, _turned(body, unit))
        inertia = body.transverse_inertia / unit / body.mass / unit
        return cls(unit, inertia, _sides(body, unit))


def _rough(body: RoughSphere) -> Outline:
    """Place an asperity on the axis, down to where the sphere itself touches."""
    height = body.asperity_radius if body.heights is None else body.heights
    unit = body.radius + height
    ball = Ball(body.asperity_radius / unit, body.asperity_radius / unit - 1.0)
    least = max(-1.0, 1.0 - height / (unit - body.asperity_radius))
    return Outline(unit, 0.4 * (body.radius / unit) ** 2, (Side(0.0, math.acos(least), ball),))


def _turned(body: Turned, unit: float) -> tuple[Side, ...]:
    """Find which rim or arc of a solid of revolution touches, from θ = 0, its axis upright, to π."""
    circles = (np.array(body.compiled.rims) - [body.centre_of_mass[2], 0.0])[::-1] / unit
    if isinstance(body, Egg):
        flank = 0.5 * body.width / unit - circles[1, 1]
        radii = np.array([body.blunt_end / unit, flank, body.tip / unit])
        joints = np.diff(circles, axis=0) / np.diff(-radii)[:, None]  # normals where two arcs meet
    else:
        radii = np.zeros(len(circles))
        joints = np.diff(circles, axis=0)[:, ::-1] * [-1.0, 1.0]  # along the edge between two rims
    angles = np.arctan2(joints[:, 1], -joints[:, 0])
    sides = []
    for radius, (place, offset), (low, high) in zip(
        radii, circles, pairwise([0.0, *angles, math.pi]), strict=True
    ):
        rocking = math.atan2(-offset, place) % math.pi  # there the lever arm changes its sign
        cuts = [low, *([rocking] if low < rocking < high else []), high]
        for start, stop in pairwise(cuts):
            middle = 0.5 * (start + stop)
            arm = place * math.sin(middle) + offset * math.cos(middle)
            sides.append(Side(start, stop, Band(radius, place, offset, math.copysign(1.0, arm))))
    return tuple(sides)


def _sides(body: Body, unit: float) -> tuple[Side, ...]:
    one, two = body.compiled.outline
    if one[:3] == two[:3]:  # the halves of one ellipsoid
        centre, along, across = (length / unit for length in one[:3])
        if one[1] != one[2]:  # its centre is the centre of mass
            return (Side(0.0, 0.5 * math.pi, Ellipsoid(across, along)),)
        return (Side(0.0, math.pi if centre else 0.5 * math.pi, Ball(across, centre)),)
    upper, lower = Ball(one[1] / unit, one[0] / unit), Ball(two[1] / unit, two[0] / unit)
    if upper.radius == lower.radius and upper.place == -lower.place:
        return (Side(0.0, 0.5 * math.pi, lower),)
    turn = math.acos((upper.radius - lower.radius) / (upper.place - lower.place))  # both touch
    return Side(0.0, turn, lower), Side(turn, math.pi, upper)
