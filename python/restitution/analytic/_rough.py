"""A rough sphere: where it touches the plane, and p(ε | v) if it spins, an asymmetric Laplace density.

A sphere of radius R carries N asperities, balls of radius ρ whose tops stand h_i above it, their centres at
R_c = R + h_i - ρ from its own, uniform in direction. In an impact from rest the one that reaches lowest
touches, at R_c cos a + ρ below the centre, a the angle between the contact, seen from the centre, and the
lowest point. docs/rough.md derives the formulas; its numbers stand beside them.
"""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from pydantic import Field
from scipy.special import betainc
from scipy.stats import laplace_asymmetric

from restitution._internal.arrays import positive, real, whole
from restitution._internal.parameters import Number, ParameterError, Parameters, Problem, wrong
from restitution.analytic._orientation import Floats
from restitution.laws import Frictionless, Law, TangentialRestitution

_MOST = 10**12
"""Asperities; with 10¹⁵ or so 1 - h/2R_c to their number has no digits left."""
_FLATTEST = 1e-6
"""Least ratio of the widths of the two flanks that is drawn: below it one is as good as empty."""
_WIDEST = 0.5
"""Largest width in units of 1 + ε_n, where the expansion in it has long failed."""


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
    allowed = f"in (0, {size!r}] m: no more than the sphere's radius"
    rho = real("asperity_radius", asperity_radius, allowed, lambda x: 0.0 < x <= size, unit="m")
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
    relative = top / (size + top - rho)  # h/R_c
    n, least = float(number), min(0.5 * relative, 1.0)  # of 1 - cos²(a/2), where the sphere touches too
    sphere = math.exp(n * math.log1p(-least)) if least < 1.0 else 0.0  # (3)
    mean_square = 4.0 * n / ((n + 1.0) * (n + 2.0)) * float(betainc(2.0, n + 1.0, least))  # (2)
    return RoughContact(mean_square=mean_square, sphere=sphere)


class _AsymmetricLaplace(type(laplace_asymmetric)):  # type: ignore[misc]
    """`scipy.stats.laplace_asymmetric`, whose two probabilities overflow on a side that is nearly empty."""

    def _cdf(self, x: Floats, kappa: Floats) -> Any:
        below = kappa**2 / (1.0 + kappa**2)
        left = below * np.exp(np.minimum(x, 0.0) / kappa)
        return np.where(x < 0.0, left, 1.0 - (1.0 - below) * np.exp(-np.maximum(x, 0.0) * kappa))

    def _sf(self, x: Floats, kappa: Floats) -> Any:
        return self._cdf(-x, 1.0 / kappa)


_DENSITY = _AsymmetricLaplace(name="asymmetric_laplace")


def rough_impact(
    law: Law, contact: RoughContact, *, speed: float, spin: float, radius: float, inertia: float = 0.4
) -> Any:
    """Return the distribution of ε at an impact velocity, of a rough sphere whose spin is Gaussian.

    Asperities are many and small: to first order in the width of the density. It is the asymmetric Laplace
    density, with its cusp at ε_n. Its width is the scatter of the lever arm times the spin, and its asymmetry
    the difference between contacts that spin drives into the plane, which are met more often, and the loss to
    rotation that every lever arm causes: docs/rough.md.

    Parameters
    ----------
    law : Frictionless or TangentialRestitution
        With a number for ``normal``; ``tangential`` must be 1.
    contact : RoughContact
        Where the sphere touches, from `rough_contact`. The sphere itself must touch in less than one impact
        in a hundred.
    speed : float
        Impact velocity v, in m/s, > 0.
    spin : float
        Standard deviation of each of the two horizontal components of ω, in rad/s, >= 0.
    radius : float
        Of the sphere, in m, > 0.
    inertia : float
        J/(mR²), in (0, 2/3]; 0.4 for a homogeneous sphere.

    Returns
    -------
    scipy.stats frozen distribution
        As of ``scipy.stats.laplace_asymmetric``: with ``pdf``, ``cdf``, ``rvs``, ``mean``, ``std``.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import restitution as rs
    >>> from restitution.analytic import rough_contact, rough_impact
    >>> contact = rough_contact(radius=3e-3, asperities=10**4, asperity_radius=3e-5, height=3e-5)
    >>> found = rough_impact(rs.Frictionless(normal=0.9), contact, speed=0.3, spin=300.0, radius=3e-3)
    >>> f"{found.mean():.4f} {found.std():.4f}"
    '0.9049 0.1141'
    """
    normal, coupling, square, size = _checked(law, contact, radius, inertia)
    v = positive("speed", speed, "m/s")
    omega = real("spin", spin, "a finite number >= 0, in rad/s", lambda x: 0.0 <= x < math.inf, unit="rad/s")
    turned = (omega * size / v) ** 2
    shift, spread = square * (turned - coupling), square * turned  # (9), (10)
    above, below = _flanks(shift, spread)
    if not above <= _WIDEST:
        allowed = f"such that the density is narrow: here 1 + ε_n times {above:.3g}, at most {_WIDEST}"
        raise ParameterError(wrong("spin", spin, allowed))
    scale = (1.0 + normal) * math.sqrt(above * below)
    return _DENSITY(math.sqrt(below / above), loc=normal, scale=scale)


def _flanks(shift: float, spread: float) -> tuple[float, float]:
    """Return the widths a and b of the flanks above and below: a - b = ``shift``, 2ab = ``spread`` (11)."""
    longer = 0.5 * (abs(shift) + math.sqrt(shift * shift + 2.0 * spread))
    shorter = 0.5 * spread / longer
    above, below = (longer, shorter) if shift > 0.0 else (shorter, longer)
    return max(above, _FLATTEST * longer), max(below, _FLATTEST * longer)


def rough_spin(
    law: Law,
    contact: RoughContact,
    *,
    speed: float,
    release_speed: float,
    radius: float,
    inertia: float = 0.4,
) -> float:
    """Return the spin that a rough sphere dropped without any has gathered when it is as slow as ``speed``.

    Each impact changes ω by a kick of random direction, proportional to the speed; the sphere bounces with
    ε_n to leading order. Kicks of different impacts are independent while the sphere turns by more than the
    distance of asperities from one to the next.

    Parameters
    ----------
    law, contact, radius, inertia
        As in `rough_impact`; ``law.normal`` below 1.
    speed : float
        Impact velocity v, in m/s, in (0, `release_speed`].
    release_speed : float
        Velocity v_0 of the first impact, in m/s.

    Returns
    -------
    float
        Standard deviation of each horizontal component of ω, in rad/s.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import restitution as rs
    >>> from restitution.analytic import rough_contact, rough_spin
    >>> contact = rough_contact(radius=3e-3, asperities=10**6, asperity_radius=3e-6, height=3e-6)
    >>> round(rough_spin(rs.Frictionless(normal=0.9), contact, speed=0.1, release_speed=1.0, radius=3e-3), 2)
    5.11
    """
    normal, coupling, square, size = _checked(law, contact, radius, inertia)
    if normal == 1.0:
        raise ParameterError(wrong("law", law, "one with normal < 1, or the sphere never gets slower"))
    first = positive("release_speed", release_speed, "m/s")
    allowed = f"in (0, {first!r}] m/s: at most release_speed"
    v = real("speed", speed, allowed, lambda x: 0.0 < x <= first, unit="m/s")
    loss = coupling * (1.0 + normal) * square  # γ
    kept, left = 1.0 - 2.0 * loss, normal * (normal - 2.0 * loss)  # of ω² and of v², in one impact
    if not left > 0.0:
        most = 0.5 * normal / (coupling * (1.0 + normal))
        raise ParameterError(wrong("contact", contact, f"one with mean_square below {most:.3g}"))
    impacts = 2.0 * math.log(first / v) / -math.log(left)
    kicks = (first * first * kept**impacts - v * v) / (kept - left)
    return math.sqrt(max(0.5 * coupling * (1.0 + normal) * loss * kicks, 0.0)) / size  # (12)


def _checked(
    law: Law, contact: RoughContact, radius: float, inertia: float
) -> tuple[float, float, float, float]:
    """Return ε_n, the share κ of the loss, ⟨sin² a⟩ and R.

    κ is mR²/J without friction and mR²/(J + mR²) for ε_t = 1.
    """
    j = real("inertia", inertia, "in (0, 2/3]: J/(mR²)", lambda x: 0.0 < x <= 2.0 / 3.0)
    sticking = isinstance(law, TangentialRestitution) and law.tangential == 1.0
    if not (sticking or isinstance(law, Frictionless)) or not isinstance(law.normal, float):
        allowed = "Frictionless, or TangentialRestitution with tangential = 1, with a number for normal"
        raise ParameterError(wrong("law", law, allowed))
    if not isinstance(contact, RoughContact):
        raise ParameterError(wrong("contact", contact, "a RoughContact, from `rough_contact`"))
    mean_square = real("contact.mean_square", contact.mean_square, "in (0, 1]", lambda x: 0.0 < x <= 1.0)
    if not contact.sphere <= 0.01:
        allowed = "of a sphere that touches itself in less than one impact in a hundred"
        raise ParameterError(wrong("contact", contact, allowed))
    return law.normal, 1.0 / (j + 1.0) if sticking else 1.0 / j, mean_square, positive("radius", radius, "m")
