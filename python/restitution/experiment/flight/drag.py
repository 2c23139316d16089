"""Air drag between two impacts: a force that grows as the square of the speed."""

import math
from typing import Annotated, NamedTuple

import numpy as np
from pydantic import Field

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.parameters import Number, Parameters
from restitution.experiment.flight.times import LARGEST, LEAST


class Drag(Parameters):
    """Quadratic air drag, given by the speed at which it would balance the weight.

    The drag is (ρ_air/2) C_d A v², so that a body that falls for long reaches the terminal velocity
    V = √(2 m g/(ρ_air C_d A)).

    Parameters
    ----------
    terminal_velocity : float
        V in m/s, > 0.
    uncertainty : float
        Standard error of V in m/s, >= 0; it is common to all impacts of a series.

    Examples
    --------
    >>> import restitution as rs
    >>> rs.flight.Drag.of_sphere(diameter=0.040, mass=2.7e-3).terminal_velocity.__round__(1)
    8.8
    """

    terminal_velocity: Annotated[Number, Field(ge=LEAST, le=LARGEST, description="m/s")]
    uncertainty: Annotated[Number, Field(ge=0, le=LARGEST, description="m/s")] = 0.0

    @classmethod
    def of_sphere(
        cls,
        *,
        diameter: float,
        mass: float,
        coefficient: float = 0.45,
        coefficient_uncertainty: float = 0.05,
        air_density: float = 1.2,
        gravity: float = 9.81,
    ) -> "Drag":
        """Return the drag of a sphere.

        Parameters
        ----------
        diameter, mass : float
            In m and kg, > 0.
        coefficient, coefficient_uncertainty : float
            Drag coefficient C_d and its standard error. Between Reynolds numbers of 10³ and 10⁵ a smooth
            sphere has 0.4 to 0.5; at 400, the number of 6 mm at 1 m/s, it has 0.6.
        air_density : float
            In kg/m³, > 0.
        gravity : float
            In m/s², > 0.

        Raises
        ------
        ValueError
            If a value is out of range.
        """
        given = _Sphere(
            diameter=diameter,
            mass=mass,
            coefficient=coefficient,
            coefficient_uncertainty=coefficient_uncertainty,
            air_density=air_density,
            gravity=gravity,
        )
        area = math.pi * given.diameter**2 / 4.0
        speed = math.sqrt(2.0 * given.mass * given.gravity / (given.air_density * given.coefficient * area))
        # V goes as C_d^(-1/2).
        return cls(
            terminal_velocity=speed,
            uncertainty=0.5 * speed * given.coefficient_uncertainty / given.coefficient,
        )


class Ball(Parameters):
    """Diameter and mass of a ball, of which numbers can be computed."""

    diameter: Annotated[Number, Field(ge=LEAST, le=LARGEST, description="m")]
    mass: Annotated[Number, Field(ge=LEAST, le=LARGEST, description="kg")]


class _Sphere(Ball):
    coefficient: Annotated[Number, Field(ge=LEAST, le=LARGEST)]
    coefficient_uncertainty: Annotated[Number, Field(ge=0, le=LARGEST)]
    air_density: Annotated[Number, Field(ge=LEAST, le=LARGEST, description="kg/m³")]
    gravity: Annotated[Number, Field(ge=LEAST, le=LARGEST, description="m/s²")]


class Speeds(NamedTuple):
    """Speeds at the ends of flights, and their derivatives; every array has the shape of the flights."""

    up: Array  # speed with which the flight began, in m/s
    down: Array  # and with which it ended
    up_by: tuple[Array, Array, Array]  # derivatives by the time of flight, by g and by the terminal velocity
    down_by: tuple[Array, Array, Array]


def speeds(interval: Array, gravity: float, terminal: float | None) -> Speeds:
    """Return the speeds of flights that begin and end at the same height, from how long they took.

    Without drag both are g Δt/2. With it, in units of V and V/g, a body that starts with q rises for arctan q
    and falls for arsinh q, and lands with q/√(1 + q²): the flight takes arctan q + arsinh q.
    """
    if terminal is None:
        half = 0.5 * gravity * interval
        by = (np.full_like(interval, 0.5 * gravity), 0.5 * interval, np.zeros_like(interval))
        return Speeds(half, half, by, by)
    time = gravity * interval / terminal
    q = _launch(time)
    root = np.sqrt(1.0 + q * q)
    slope = 1.0 / (1.0 / root**2 + 1.0 / root)  # dq/dtime
    landing, landing_slope = q / root, slope / root**3
    return Speeds(
        terminal * q,
        terminal * landing,
        (gravity * slope, interval * slope, q - time * slope),
        (gravity * landing_slope, interval * landing_slope, landing - time * landing_slope),
    )


def _launch(time: Array) -> Array:
    """Solve arctan q + arsinh q = time; Newton's steps rise to the root, as the left side is concave."""
    q = 0.5 * time
    for _ in range(60):
        root = np.sqrt(1.0 + q * q)
        step = (time - np.arctan(q) - np.arcsinh(q)) / (1.0 / root**2 + 1.0 / root)
        q = q + step
        if not np.any(np.abs(step) > 4e-16 * np.abs(q)):
            break
    return q


class Fall(NamedTuple):
    """The speed in m/s after a fall from rest, and its derivatives by g, height and terminal velocity."""

    speed: float
    by: tuple[float, float, float]


def fall(height: float, gravity: float, terminal: float | None) -> Fall:
    """Return the speed after a fall from rest: √(2 g h), or with drag V √(1 - exp(-2 g h/V²))."""
    if terminal is None:
        speed = math.sqrt(2.0 * gravity * height)
        return Fall(speed, (height / speed, gravity / speed, 0.0))
    depth = 2.0 * gravity * height / terminal**2
    speed = terminal * math.sqrt(-math.expm1(-depth))
    left = math.exp(-depth)
    return Fall(
        speed,
        (height * left / speed, gravity * left / speed, speed / terminal - terminal * depth * left / speed),
    )


def launched(speed: float, gravity: float, terminal: float) -> tuple[float, float]:
    """Return the duration in s of a flight that begins upwards with a speed, and the speed at its end."""
    q = speed / terminal
    duration = terminal / gravity * (math.atan(q) + math.asinh(q))
    return duration, speed / math.sqrt(1.0 + q * q)
