"""Where a rough sphere touches: the angle a between the contact, seen from the centre, and the lowest point.

A sphere of radius R carries N asperities, balls of radius ρ whose tops stand h_i above it, their centres at
R_c = R + h_i - ρ from its own, uniform in direction. In an impact from rest the one that reaches lowest
touches, at R_c cos a + ρ below the centre. docs/rough.md derives the formulas; its numbers stand beside them.
"""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field
from scipy.special import betainc

from restitution._internal.arrays import positive, real, whole
from restitution._internal.parameters import Number, ParameterError, Parameters, Problem, wrong

_MOST = 10**12
"""Asperities; with 10¹⁵ or so 1 - h/2R_c to their number has no digits left."""


class RoughContact(Parameters):
    """Where a rough sphere touches the plane; make it with `rough_contact`.

    Attributes
    ----------
    mean_square : float
        ⟨sin² a⟩ of the contact, 0 where the sphere itself touches.
    sphere : float
        Probability that the sphere itself touches, and no asperity.

    Examples
    --------
    >>> from restitution.analytic import RoughContact
    >>> RoughContact(mean_square=4e-4, sphere=0.0)
    RoughContact(mean_square=0.0004, sphere=0.0)
    """

    mean_square: Annotated[Number, Field(ge=0, le=1)]
    sphere: Annotated[Number, Field(ge=0, le=1)]


def rough_contact(
    *,
    radius: float,
    asperities: int,
    asperity_radius: float,
    height: float | None = None,
    mean_height: float | None = None,
) -> RoughContact:
    """Return where a sphere with asperities touches, averaged over its orientation and over such spheres.

    Parameters
    ----------
    radius : float
        Of the sphere, in m, > 0.
    asperities : int
        Their number N, from 1 to 10¹².
    asperity_radius : float
        ρ in m, > 0 and at most `radius`.
    height : float
        Height of the top of every asperity above the sphere, in m: from 0 to 2 ρ.
    mean_height : float
        Instead: mean of heights that are exponentially distributed, in m, > 0; to leading order in it over
        the radius, of which it may be a hundredth at most.

    Returns
    -------
    RoughContact
        ``mean_square`` and ``sphere``.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> from restitution.analytic import rough_contact
    >>> ball = {"radius": 3e-3, "asperities": 10**4, "asperity_radius": 3e-5}
    >>> f"{rough_contact(height=3e-5, **ball).mean_square:.4e}"
    '3.9988e-04'
    >>> f"{rough_contact(mean_height=3e-5, **ball).mean_square:.4e}"
    '2.0000e-02'
    """
    size = positive("radius", radius, "m")
    number = whole("asperities", asperities, 1, _MOST)
    rho = real(
        "asperity_radius",
        asperity_radius,
        f"in (0, {size!r}] m: no more than the sphere's radius",
        lambda x: 0.0 < x <= size,
        unit="m",
    )
    if height is None and mean_height is None:
        raise ParameterError(Problem("height", ": missing; give height or mean_height"))
    if height is not None and mean_height is not None:
        raise ParameterError(wrong("mean_height", mean_height, "left out: height is given"))
    if mean_height is not None:
        allowed = f"in (0, {0.01 * size:g}] m: no more than a hundredth of the radius"
        mean = real("mean_height", mean_height, allowed, lambda x: 0.0 < x <= 0.01 * size, unit="m")
        sphere = math.exp(-0.5 * number * mean / size)  # (4)
        return RoughContact(mean_square=2.0 * mean / size * (1.0 - sphere), sphere=sphere)  # (5)
    top = real("height", height, f"in [0, {2.0 * rho!r}] m", lambda x: 0.0 <= x <= 2.0 * rho, unit="m")
    if not size + top > rho:
        raise ParameterError(wrong("asperity_radius", asperity_radius, "less than radius + height"))
    return _equal(number, top / (size + top - rho))


def _equal(number: int, relative: float) -> RoughContact:
    """Return the contact of N asperities of equal height h = ``relative`` R_c."""
    n, least = float(number), min(0.5 * relative, 1.0)  # of 1 - cos²(a/2), where the sphere touches too
    sphere = math.exp(n * math.log1p(-least)) if least < 1.0 else 0.0  # (3)
    mean_square = 4.0 * n / ((n + 1.0) * (n + 2.0)) * float(betainc(2.0, n + 1.0, least))  # (2)
    return RoughContact(mean_square=mean_square, sphere=sphere)
