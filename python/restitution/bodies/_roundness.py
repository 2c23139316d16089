"""Nearly round bodies from the reading of a roundness gauge or the grade of a ball."""

import math
from numbers import Integral
from typing import Annotated, Literal, TypeAlias, get_args

from pydantic import Field

from restitution._internal.parameters import (
    Allowed,
    Number,
    ParameterError,
    Parameters,
    Whole,
    in_terms_of,
    shown,
    wrong,
)
from restitution.bodies._axial import Dumbbell, LoadedSphere, Spheroid, Wall
from restitution.bodies._body import Body

Form: TypeAlias = Literal["lobed", "flattened", "dumbbell", "off-centre"]

_FORMS = "{}, {}, {} or {}".format(*map(repr, get_args(Form)))
_MOST = 0.1
"""Out-of-roundness over diameter up to which a ball is called nearly round."""

_ALLOWED = {  # by grade, in m: deviation from spherical form, and arithmetic mean roughness Ra
    3: (0.08e-6, 0.010e-6),
    5: (0.13e-6, 0.014e-6),
    10: (0.25e-6, 0.020e-6),
    16: (0.4e-6, 0.025e-6),
    20: (0.5e-6, 0.032e-6),
    24: (0.6e-6, 0.040e-6),
    28: (0.7e-6, 0.050e-6),
    40: (1.0e-6, 0.060e-6),
    48: (1.2e-6, None),
    60: (1.5e-6, 0.080e-6),
    100: (2.5e-6, 0.100e-6),
    200: (5e-6, 0.150e-6),
    500: (13e-6, None),
    1000: (25e-6, None),
}
"""ISO 3290-1; of 48, 500 and 1000, which are those of ANSI/ABMA 10, the deviation alone."""
GRADES = {grade: form for grade, (form, _) in _ALLOWED.items()}
ROUGHNESS = {grade: roughness for grade, (_, roughness) in _ALLOWED.items() if roughness is not None}


class _Asked(Parameters):
    diameter: Annotated[Number, Field(gt=0, description="m")]
    out_of_roundness: Annotated[Number, Field(ge=0, description="m")]
    form: Annotated[Form, Allowed(_FORMS)]
    lobes: Annotated[Whole, Field(ge=2, le=1000)]
    density: Annotated[Number, Field(gt=0, description="kg/m³")]
    wall: Wall


def from_roundness(
    diameter: float,
    out_of_roundness: float,
    *,
    form: Form = "lobed",
    lobes: int = 2,
    density: float = 2500.0,
    wall: float | None = None,
) -> Body:
    """Make a body that stands for a nearly round ball.

    The out-of-roundness t is the radial one, "deviation from spherical form" in ISO 3290: the largest
    distance between the surface and the circumscribed sphere. At a contact the normal passes the centre of
    mass at a distance, the lever arm; its mean square over all orientations determines the effect of the
    shape: t²/2 for two lobes, for a flattened ball, for a dumbbell and for a centre of mass off by t alike,
    and n²t²/8 for n lobes.

    Parameters
    ----------
    diameter : float
        Mean of the largest and the smallest diameter, in m; > 0.
    out_of_roundness : float
        t in m; from 0 to a tenth of the diameter. Callipers measure diameters: of a ball with two lobes they
        differ by 2 t, of one with an odd number of lobes not at all.
    form : {"lobed", "flattened", "dumbbell", "off-centre"}
        Kind of deviation from a sphere. "lobed": a prolate `Spheroid`; for more than two lobes that with the
        same mean square of the lever arm, n t/2 for t. "flattened": an oblate `Spheroid`. "dumbbell": the
        paper's body, with a ridge-free surface but for its waist. "off-centre": a round ball whose centre of
        mass is t off its centre, by a load at its surface, as by a bubble on the other side.
    lobes : int
        Number of lobes of form "lobed", >= 2.
    density : float
        Mean density of the matter in kg/m³, > 0.
    wall : float, optional
        Thickness of the wall of a hollow ball, in m; at most half the smallest diameter. A shell has up to
        5/3 times the moment of inertia of a full ball of the same mass, and the shape that much less effect.

    Returns
    -------
    Spheroid, Dumbbell or LoadedSphere

    Raises
    ------
    ValueError
        If a value is out of range; the message names it.

    Examples
    --------
    >>> import restitution as rs
    >>> rs.from_roundness(6e-3, 2.5e-6).elongation.__round__(6)
    1.000834
    """
    asked = _Asked(
        diameter=diameter,
        out_of_roundness=out_of_roundness,
        form=form,
        lobes=lobes,
        density=density,
        wall=wall,
    )
    if asked.lobes != 2 and asked.form != "lobed":
        raise ParameterError(wrong("lobes", lobes, f"left out: form = {form!r} has none"))
    t = asked.out_of_roundness * (asked.lobes / 2.0)
    if t > _MOST * asked.diameter:
        most = 2.0 * _MOST * asked.diameter / asked.lobes
        allowed = f"in [0, {most:g}], nearly round for diameter = {shown(diameter)} (m)"
        raise ParameterError(wrong("out_of_roundness", out_of_roundness, allowed))
    hollow = {} if wall is None else {"wall": wall}
    with in_terms_of(diameter=diameter, out_of_roundness=out_of_roundness, density=density, **hollow):
        return _body(asked, t)


def _body(asked: _Asked, t: float) -> Body:
    long, short = 0.5 * (asked.diameter + t), 0.5 * (asked.diameter - t)
    density, wall = asked.density, asked.wall
    match asked.form:
        case "lobed":
            return Spheroid(equatorial=short, polar=long, density=density, wall=wall)
        case "flattened":
            return Spheroid(equatorial=long, polar=short, density=density, wall=wall)
        case "dumbbell":
            return Dumbbell(radius=short, separation=2.0 * t, density=density, wall=wall)
        case "off-centre":
            radius = 0.5 * asked.diameter
            volume = 4.0 / 3.0 * math.pi * radius**3
            if wall is not None:
                volume -= 4.0 / 3.0 * math.pi * max(0.0, radius - wall) ** 3
            mass = volume * density
            share = t / radius  # a load m' at the surface moves the centre of mass by R m'/m
            return LoadedSphere(
                radius=radius, density=density * (1.0 - share), load=mass * share, offset=radius, wall=wall
            )


def ball_grade(grade: int) -> float:
    """Return the largest out-of-roundness of a ball of a grade, in m.

    The number of a grade is the deviation from spherical form in millionths of an inch, rounded: ISO 3290-1
    for grades 3 to 200, ANSI/ABMA 10 for 48, 500 and 1000.

    Parameters
    ----------
    grade : int
        3, 5, 10, 16, 20, 24, 28, 40, 48, 60, 100, 200, 500 or 1000.

    Raises
    ------
    ValueError
        If the grade does not exist.

    Examples
    --------
    >>> import restitution as rs
    >>> rs.ball_grade(100)
    2.5e-06
    """
    if not isinstance(grade, Integral) or grade not in GRADES:
        raise ParameterError(wrong("grade", grade, f"one of {', '.join(map(str, GRADES))}"))
    return GRADES[grade]


def ball_roughness(grade: int) -> float:
    """Return the largest arithmetic mean roughness Ra of a ball of a grade, in m, by ISO 3290-1.

    Parameters
    ----------
    grade : int
        3, 5, 10, 16, 20, 24, 28, 40, 60, 100 or 200.

    Raises
    ------
    ValueError
        If the grade does not exist there.

    Examples
    --------
    >>> import restitution as rs
    >>> rs.ball_roughness(100)
    1e-07
    """
    if not isinstance(grade, Integral) or grade not in ROUGHNESS:
        raise ParameterError(wrong("grade", grade, f"one of {', '.join(map(str, ROUGHNESS))}"))
    return ROUGHNESS[grade]
