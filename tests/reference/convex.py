"""Areas and mean radii of convex bodies, by their formulas."""

from typing import Any

import numpy as np

import restitution as rs


def area_and_mean_radius(body: Any) -> tuple[float, float]:
    """Of a sphere, a box, a spherocylinder, a cylinder or a prolate spheroid."""
    match body:
        case rs.Dumbbell():
            return 4 * np.pi * body.radii[0] ** 2, body.radii[0]
        case rs.Box():
            a, b, c = body.a, body.b, body.c
            return 2 * (a * b + b * c + c * a), (a + b + c) / 4
        case rs.Spherocylinder():
            length, radius = body.separation, body.radius
            return 4 * np.pi * radius**2 + 2 * np.pi * radius * length, radius + length / 4
        case rs.Cylinder():
            length, radius = body.height, body.radius
            return 2 * np.pi * radius * (radius + length), (length + np.pi * radius) / 4
    a, c = body.equatorial, body.polar
    e = np.sqrt(1 - (a / c) ** 2)
    area = 2 * np.pi * a**2 * (1 + c / (a * e) * np.arcsin(e))
    return area, 0.5 * c + 0.5 * a * a / (c * e) * np.arctanh(e)
