"""The duration of a contact, which times of impacts contain beside the flight."""

import math
from typing import Annotated

import numpy as np
from pydantic import Field

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import real
from restitution._internal.parameters import Number, ParameterError, Parameters, wrong
from restitution.experiment.flight.drag import Ball
from restitution.experiment.flight.times import LARGEST, LEAST

_SOFTEST = 2e9
"""Reduced modulus in Pa of a hard plastic on a hard plate, softer than which is only rubber."""
_SHELL = (2.5e9, 0.35, 1400.0)
"""Young's modulus in Pa, Poisson's ratio and density in kg/m³ of celluloid and its like."""
_HOLLOW = 500.0
"""Mean density in kg/m³ below which a ball whose wall is not known is taken for hollow."""
_POWER = -0.2
"""Of the speed, by Hertz."""


class ContactTime(Parameters):
    """Time for which ball and plate touch, t_c = τ (v/(1 m/s))^(-1/5) as Hertz found it for elastic spheres.

    Two sounds are a contact and a flight apart.

    Parameters
    ----------
    at_1_m_s : float
        τ in s, >= 0; 0 is none.
    uncertainty : float
        Standard error of τ in s, >= 0; it is common to all impacts of a series.

    Examples
    --------
    >>> import restitution as rs
    >>> steel = {"young_modulus": 2.1e11, "poisson_ratio": 0.3}
    >>> bearing = rs.flight.ContactTime.of_spheres(diameter=6e-3, mass=8.8e-4, ball=steel, plate=steel)
    >>> f"{1e6 * bearing.at_1_m_s:.0f} µs"
    '21 µs'
    """

    at_1_m_s: Annotated[Number, Field(ge=0, le=LARGEST, description="s")]
    uncertainty: Annotated[Number, Field(ge=0, le=LARGEST, description="s")] = 0.0

    @classmethod
    def of_spheres(
        cls,
        *,
        diameter: float,
        mass: float,
        ball: dict[str, float],
        plate: dict[str, float] | None = None,
        relative_uncertainty: float = 0.1,
    ) -> "ContactTime":
        """Return t_c = 2.87 (m²/(R E*² v))^(1/5) of a full ball and a plate that do not yield.

        Parameters
        ----------
        diameter, mass : float
            In m and kg, > 0.
        ball, plate : dict
            ``young_modulus`` in Pa and ``poisson_ratio``; a plate that is left out does not give way.
        relative_uncertainty : float
            Standard error over the value, in [0, 1].

        Raises
        ------
        ValueError
            If a value is out of range.
        """
        given = Ball(diameter=diameter, mass=mass)
        given_sides = {"ball": ball} if plate is None else {"ball": ball, "plate": plate}
        for name, one in given_sides.items():
            if not isinstance(one, dict):
                raise ParameterError(wrong(name, one, "a dict with young_modulus and poisson_ratio"))
        share = real(
            "relative_uncertainty", relative_uncertainty, "a number in [0, 1]", lambda x: 0.0 <= x <= 1.0
        )
        sides = [_Elastic(**one) for one in given_sides.values()]
        softness = sum((1.0 - one.poisson_ratio**2) / one.young_modulus for one in sides)
        time = _hertz(given.mass, given.diameter, 1.0 / softness)
        return cls(at_1_m_s=time, uncertainty=share * time)

    @classmethod
    def possible(
        cls, *, diameter: float, mass: float | None = None, wall: float | None = None
    ) -> "ContactTime":
        """Return none, with what it may be where nothing is known of it as the standard error.

        That of a hard plastic, full or hollow; of metals, glass and stone it is shorter. A shell of the
        thickness h has the stiffness 4 E h²/(R √(3(1 - ν²))) (Reissner, 1946), and t_c = π √(m/k).

        Parameters
        ----------
        diameter, mass, wall : float
            In m, kg and m. Without a mass a full ball has 2500 kg/m³.
        """
        radius = 0.5 * diameter
        volume = 4.0 / 3.0 * math.pi * radius**3
        young, poisson, density = _SHELL
        if wall is None and mass is not None and mass < _HOLLOW * volume:
            wall = mass / (4.0 * math.pi * radius**2 * density)
        if wall is None:
            return cls(at_1_m_s=0.0, uncertainty=_hertz(mass or 2500.0 * volume, diameter, _SOFTEST))
        stiffness = 4.0 * young * wall**2 / (radius * math.sqrt(3.0 * (1.0 - poisson**2)))
        heavy = mass or 4.0 * math.pi * radius**2 * wall * density
        return cls(at_1_m_s=0.0, uncertainty=math.pi * math.sqrt(heavy / stiffness))


class _Elastic(Parameters):
    young_modulus: Annotated[Number, Field(ge=LEAST, le=LARGEST, description="Pa")]
    poisson_ratio: Annotated[Number, Field(gt=-1, le=0.5)]


def _hertz(mass: float, diameter: float, modulus: float) -> float:
    return float(2.87 * (mass**2 / (0.5 * diameter * modulus**2)) ** 0.2)


def delays(up: Array, down: Array, first: float | None = None) -> Array:
    """Return t_c/τ of the impact before each flight, from the speeds in m/s with which flights begin and end.

    The speed before an impact is that at the end of the flight before it. Of the first, unless that is the
    `first` that is known, and after a flight that is not known, it is the speed after it over the median ε.
    """
    ratios = down[:-1] / up[1:]
    usual = np.median(ratios[np.isfinite(ratios)]) if np.isfinite(ratios).any() else 1.0
    speed = np.append(np.nan, down[:-1])
    speed = np.where(np.isnan(speed), usual * up, speed)
    if first is not None:
        speed[0] = first
    return np.asarray(speed**_POWER)


def contact_of(given: object) -> ContactTime | None:
    """Take a contact time as it is given: in words, as a number of seconds at 1 m/s, or none."""
    if given is None or isinstance(given, ContactTime):
        return given
    allowed = "a ContactTime, or a number of seconds at 1 m/s in [0, 1e30]"
    return ContactTime(at_1_m_s=real("contact_time", given, allowed, lambda time: 0.0 <= time <= LARGEST))
