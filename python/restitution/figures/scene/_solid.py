"""The surface of a body of revolution, as parts that one formula describes, and its picture from the side."""

import math
from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import to_rgb

from restitution._internal.arrays import FloatArray
from restitution._internal.parameters import ParameterError, Problem, renamed
from restitution.bodies import KINDS, AnyBody, Body, of_attributes

PIXELS = 220
"""Across the picture of a body."""
TONES = np.array([to_rgb("0.5"), to_rgb("#2F86C6"), to_rgb("#F0A03C")])
"""Colours of a rod, and of the ends 1 and 2; a body of another shape has that of end 1."""
_LIGHT = np.array([-0.45, 0.7, 0.55])
"""Where the light comes from: right, up and towards the reader."""


@dataclass(frozen=True)
class Part:
    """The points q about ``place`` where q² across + (q·e)² excess + (q·e) linear = 1 and |q·e| <= half."""

    place: float  # from the centre of mass along the axis, in m
    across: float
    excess: float
    linear: float = 0.0  # of a cone
    half: float = math.inf
    end: int | None = None  # of the body, or None: that to which q·e points


def parts_of(body: Body) -> tuple[Part, ...]:
    """Return the surfaces whose union one sees: those of the arcs of the outline, and that between them."""
    one, two = body.compiled.outline
    same = one[:3] == two[:3]
    parts = []
    for end, (centre, along, across, *_) in enumerate((one,) if same else (one, two), start=1):
        if across > 0.0:
            curved = across**-2
            parts.append(Part(centre, curved, along**-2 - curved, end=None if same else end))
    (high, wide), (low, narrow) = _point(one, one[4]), _point(two, two[3])
    radius, length = 0.5 * (wide + narrow), high - low
    if length > 1e-9 * max(one[2], two[2]):
        rod = radius < 1e-9 * max(one[2], two[2])
        radius = min(one[2], two[2]) / 12.0 if rod else radius
        slope, curved = (wide - narrow) / length, radius**-2
        side = Part(
            0.5 * (high + low), curved, -curved * (1.0 + slope**2), -2.0 * slope / radius, 0.5 * length
        )
        parts.append(replace(side, end=0) if rod else side)
    return tuple(parts)


def _point(arc: list[float], angle: float) -> tuple[float, float]:
    centre, along, across, *_ = arc
    return centre + along * math.cos(angle), across * math.sin(angle)


def body_of(data: xr.Dataset) -> Body:
    """Make the body that was dropped, from the attributes of its run."""
    kinds = {kind.__name__: kind for kind in KINDS}
    kind = kinds.get(str(data.attrs.get("body")))
    try:
        if kind is None:
            raise KeyError("body")
        with renamed(lambda name: f"data.{name}"):
            return of_attributes(kind, data.attrs)
    except KeyError as error:
        missing = ", ".join(error.args)
        text = f" lacks the attributes of the body ({missing}): must be from restitution.simulate"
        raise ParameterError(Problem("data", text)) from None


def contact_point(body: Body, axis: FloatArray, end: int | None = None) -> FloatArray:
    """Return the lowest point of a body from its centre of mass, or that of one end, in the picture's frame.

    Of the ellipsoid q·Q⁻¹q = 1 it is -Qn/√(n·Qn).
    """
    up = np.array([0.0, 1.0, 0.0])
    lowest = []
    for number, (centre, along, across, *_) in enumerate(body.compiled.outline, start=1):
        if end in (None, number):
            q = (along**2 - across**2) * axis[1] * axis + across**2 * up
            lowest.append(centre * axis - q / max(math.sqrt(q[1]), 1e-300))
    return min(lowest, key=lambda point: float(point[1]))


def shade(normal: FloatArray, tone: FloatArray) -> FloatArray:
    """Return the colour of a surface of this tone in the light, by its normals of any length: (..., 3)."""
    length = np.maximum(np.linalg.norm(normal, axis=-1), 1e-300)
    light = np.clip(normal @ (_LIGHT / np.linalg.norm(_LIGHT)) / length, 0.0, 1.0)[..., None]
    bright: FloatArray = np.clip(tone * (0.5 + 0.55 * light) + 0.15 * light**12, 0.0, 1.0)
    return bright


def picture(body: Body, axis: FloatArray) -> FloatArray:
    """Return the picture of a body about its centre of mass, from -1.05 to 1.05 of its reach, as RGBA.

    `axis` is the symmetry axis in the frame of the picture: right, up, towards the reader.
    """
    size = 1.05 * body.compiled.farthest()
    places = size * (np.arange(PIXELS) + 0.5 - 0.5 * PIXELS) * 2.0 / PIXELS
    right, up = np.meshgrid(places, places)
    flat = np.stack([right, up, np.zeros_like(right)], axis=-1)
    depth = np.full(right.shape, -np.inf)
    color = np.zeros((*right.shape, 3))
    cover = np.zeros_like(right)
    towards = float(axis[2])
    for part in parts_of(body):
        q = flat - part.place * axis
        along = q @ axis
        # q + t k lies on the part where a t² + 2 b t + c = 0, k being the direction to the reader.
        a = part.across + part.excess * towards**2
        if abs(a) <= 1e-9 * part.across:  # a cylinder that points at the reader: its end is hidden by a cap
            continue
        b = part.across * q[..., 2] + (part.excess * along + 0.5 * part.linear) * towards
        c = part.across * (q**2).sum(axis=-1) + (part.excess * along + part.linear) * along - 1.0
        root = b * b - a * c
        t = (np.sqrt(np.maximum(root, 0.0)) - b) / a
        hit = q + t[..., None] * np.array([0.0, 0.0, 1.0])
        height = along + t * towards
        # The edge is as soft as a pixel is wide: the root vanishes there, and its gradient is known.
        slope = np.hypot(*np.gradient(root, places, places))
        inside = np.clip(0.5 + root / np.maximum(slope * 2.0 * size / PIXELS, 1e-300), 0.0, 1.0)
        inside = np.where(np.abs(height) <= part.half, inside, 0.0)
        normal = part.across * hit + (part.excess * height[..., None] + 0.5 * part.linear) * axis
        end = np.where(height > 0.0, 1, 2) if part.end is None else np.full(height.shape, part.end)
        seen = (hit[..., 2] > depth) & (inside > 0.0)
        color = np.where(seen[..., None], shade(normal, TONES[end]), color)
        depth = np.where(seen & (inside >= 1.0), hit[..., 2], depth)
        cover = np.maximum(cover, inside)
    return np.dstack([color, cover])


def put(axes: Axes, body: AnyBody, pixels: FloatArray, centre: FloatArray) -> None:
    """Draw the picture of a body into a panel in mm: its centre of mass at `centre`, in its frame, in m."""
    image = axes.imshow(pixels, origin="lower", interpolation="bilinear", zorder=2.0)
    x, z, size = float(centre[0]), float(centre[1]), 1.05 * body.compiled.farthest()
    image.set_extent((1e3 * (x - size), 1e3 * (x + size), 1e3 * (z - size), 1e3 * (z + size)))
