"""Rates of a dilute gas by kinetic theory, where all velocities and spins have Maxwell's distributions.

The closure knows the temperatures T_tr of translation and T_rot of rotation (in J; E_tr = 3T_tr/2, and
T_rot/2 for every axis about which contacts turn a body), takes attitudes, velocities and spins as
independent, and every contact as that of two strangers. At a place of the contact surface K = a + b, a = 2/m
and b by rotation; the normal velocity is Gaussian with the variance s² = T_tr a + T_rot b, and a particle has

ν = n/√(2π) ∮ s dA

contacts a second. With the impulse (1 + ε)v/K, and <v²> = 2s² of those that meet, a contact changes the
energies of the pair by

<ΔE_tr> = 2(1 + ε)[-T_tr a/K + (1 + ε)s²a/2K²], <ΔE_rot> = 2(1 + ε)[-T_rot b/K + (1 + ε)s²b/2K²].

At T_rot = T_tr all of this is exact for ε = 1. Elsewhere it is a closure: contacts of one encounter are not
independent.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from restitution._internal.arrays import check_each, positive, reals
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.bodies import AnyBody, Dumbbell
from restitution.gas.theory._surface import surface
from restitution.laws import Frictionless, Law, TangentialRestitution

_NODES = 16
"""Of Gauss's rules; half as many give the error."""
_RANGE = 1e12
"""The largest T_rot/T_tr that is looked for, and the inverse of the smallest."""
_FAR = 1e100
"""The largest T_rot/T_tr of a gas, and the inverse of the smallest."""
_LONG = 1e12
"""The largest time that is followed, in units of the first time between contacts."""


class Rates(NamedTuple):
    """Contacts of a particle of a gas, and changes of its energies, in a second on average.

    Examples
    --------
    >>> import restitution as rs
    >>> found = rs.gas.theory.rates(
    ...     rs.Dumbbell(radius=1e-3, separation=0.0), rs.Frictionless(normal=0.9),
    ...     translational_temperature=1e-9, rotational_temperature=1e-9)
    >>> round(found.translational / 1e-9 / found.contacts, 4)  # 3/2 of (1 - ε²)/3
    -0.095
    """

    contacts: float
    """Its contacts, in 1/s."""
    translational: float
    """Change of its translational energy, in W."""
    rotational: float
    """Change of its rotational energy, in W."""
    error: float
    """Of these three by the quadrature, relative to the largest part of each."""


class _Closure(NamedTuple):
    of: Callable[[float, float], tuple[float, float, float]]
    """Contacts and changes of both energies, of a particle at unit density, of T_tr and T_rot."""
    axes: int
    """About which contacts turn a particle; E_rot = axes T_rot/2."""


def _closure(body: AnyBody, law: Law, nodes: int = _NODES) -> _Closure:
    if isinstance(law, TangentialRestitution) and isinstance(law.normal, float):
        return _rough_spheres(body, law.normal, -law.tangential)
    if not isinstance(law, Frictionless) or not isinstance(law.normal, float):
        allowed = "Frictionless with a number for normal, or for spheres TangentialRestitution with one"
        raise ParameterError(wrong("law", law, allowed))
    area, b, axes = surface(body, nodes)
    a, gain = 2.0 / body.mass, 1.0 + law.normal
    inverse = 1.0 / (a + b)
    by_translation, by_rotation = a * inverse, b * inverse

    def of(translational: float, rotational: float) -> tuple[float, float, float]:
        variance = translational * a + rotational * b
        flux = area * np.sqrt(variance / (2.0 * math.pi))
        kick = 0.5 * gain * variance * inverse
        # A contact is one of two particles, each of which has half of the change.
        first = gain * float(flux @ (by_translation * (kick - translational)))
        second = gain * float(flux @ (by_rotation * (kick - rotational)))
        return float(flux.sum()), first, second

    return _Closure(of, axes)


def _rough_spheres(body: AnyBody, normal: float, tangential: float) -> _Closure:
    """Huthmann and Zippelius, Phys. Rev. E 56, R6275 (1997); their β is -ε_t."""
    if not isinstance(body, Dumbbell) or not body.is_equal or body.separation > 0.0:
        allowed = "with TangentialRestitution a sphere, as Dumbbell(radius=..., separation=0)"
        raise ParameterError(wrong("body", body, allowed))
    radius = body.radii[0]
    share = body.transverse_inertia / (body.mass * radius**2)
    eta = share * (1.0 + tangential) / (2.0 * (1.0 + share))
    a = 0.25 * (1.0 - normal**2) + eta * (1.0 - eta)
    b = eta**2 / share
    c = eta / share * (1.0 - eta / share)
    area = 16.0 * math.pi * radius**2

    def of(translational: float, rotational: float) -> tuple[float, float, float]:
        contacts = area * math.sqrt(translational / (math.pi * body.mass))
        first = -2.0 * contacts * (a * translational - b * rotational)
        return contacts, first, 2.0 * contacts * (b * translational - c * rotational)

    return _Closure(of, 3)


def rates(
    body: AnyBody,
    law: Law,
    *,
    translational_temperature: float,
    rotational_temperature: float,
    number_density: float = 1.0,
) -> Rates:
    """Return how often the particles of a gas touch, and how their energies change.

    Parameters
    ----------
    body : Dumbbell, Spherocylinder, Spheroid or Ellipsoid
        The particles: a dumbbell of equal balls, at most two radii apart.
    law : Frictionless or TangentialRestitution
        With a number for its normal coefficient; the second for spheres only, with the constant roughness
        β = -ε_t.
    translational_temperature, rotational_temperature : float
        T_tr and T_rot in J, > 0.
    number_density : float
        Particles per volume, in 1/m³, to which the rates are proportional.

    Returns
    -------
    Rates
        Contacts of a particle in 1/s, changes of its translational and rotational energy in W, and the
        relative error of the quadrature.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-3)
    >>> found = rs.gas.theory.rates(body, rs.Frictionless(normal=1.0), translational_temperature=1e-9,
    ...                             rotational_temperature=2e-9)
    >>> found.rotational < 0 < found.translational
    True
    """
    t, ratio, n = _gas(translational_temperature, rotational_temperature, number_density)
    fine, coarse = (_closure(body, law, nodes).of(1.0, ratio) for nodes in (_NODES, _NODES // 2))
    size = (fine[0], fine[0], fine[0] * ratio)
    error = max(abs(one - other) / of for one, other, of in zip(fine, coarse, size, strict=True))
    speed = n * math.sqrt(t)
    return Rates(speed * fine[0], speed * t * fine[1], speed * t * fine[2], error)


def steady_ratio(body: AnyBody, law: Law) -> float:
    """Return T_rot/T_tr of a gas that has cooled for long: that at which both fall at one rate.

    Parameters
    ----------
    body, law
        As of `rates`.

    Returns
    -------
    float
        The ratio. For nearly round bodies it grows without bound, (12/5)(R/L)²(1 - ε)/(1 + ε) for dumbbells:
        rotation then gives away its energy more slowly than translation loses its own.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=3e-3, separation=3e-4)
    >>> round(rs.gas.theory.steady_ratio(body, rs.Frictionless(normal=0.9)), 1)
    12.9
    """
    closure = _closure(body, law)
    if not closure.axes:
        raise ParameterError(wrong("body", body, "one that contacts turn; a smooth sphere keeps its spin"))

    def growth(logarithm: float) -> float:  # of T_rot/T_tr, d ln/dt
        ratio = math.exp(logarithm)
        _, first, second = closure.of(1.0, ratio)
        return second / (0.5 * closure.axes * ratio) - first / 1.5

    far = math.log(_RANGE)
    if not growth(-far) > 0.0 > growth(far):
        raise ParameterError(wrong("law", law, "one whose gas tends to a ratio of its temperatures"))
    return math.exp(brentq(growth, -far, far, xtol=1e-13))


def haff_time(
    body: AnyBody, law: Law, *, translational_temperature: float, number_density: float = 1.0
) -> float:
    """Return τ of Haff's law T = T₀(1 + t/τ)⁻², which holds at the `steady_ratio`.

    Parameters
    ----------
    body, law
        As of `rates`.
    translational_temperature : float
        T₀ in J, > 0.
    number_density : float
        Particles per volume, in 1/m³.

    Returns
    -------
    float
        In s; infinite where no energy is lost.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Spheroid(equatorial=1e-3, polar=2e-3), rs.Frictionless(normal=0.9)
    >>> rs.gas.theory.haff_time(body, law, translational_temperature=1e-9, number_density=1e6) > 0
    True
    """
    t = positive("translational_temperature", translational_temperature, "J")
    n = positive("number_density", number_density, "m-3")
    closure = _closure(body, law)
    slope = closure.of(1.0, steady_ratio(body, law) if closure.axes else 1.0)[1] / 1.5
    return -2.0 / slope / n / math.sqrt(t) if slope < 0.0 else math.inf


def cooling(
    body: AnyBody,
    law: Law,
    *,
    times: npt.ArrayLike,
    translational_temperature: float,
    rotational_temperature: float,
    number_density: float = 1.0,
) -> xr.Dataset:
    """Follow both temperatures of a gas that cools.

    Parameters
    ----------
    body, law
        As of `rates`.
    times : array_like, shape (nt,)
        In s, increasing from 0 or later; the gas begins at 0.
    translational_temperature, rotational_temperature : float
        T_tr and T_rot at 0, in J, > 0.
    number_density : float
        Particles per volume, in 1/m³.

    Returns
    -------
    xarray.Dataset
        Over ``time``: ``translational_temperature`` and ``rotational_temperature`` in J, and ``contacts``
        of a particle since 0; to 1e-9.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=1e-3, separation=1e-3), rs.Frictionless(normal=0.9)
    >>> data = rs.gas.theory.cooling(body, law, times=np.linspace(0.0, 10.0, 5), number_density=1e6,
    ...                              translational_temperature=1e-9, rotational_temperature=1e-9)
    >>> bool(data["translational_temperature"][-1] < data["translational_temperature"][0])
    True
    """
    t, ratio, n = _gas(translational_temperature, rotational_temperature, number_density)
    at = reals("times", times, "increasing times >= 0, in s", unit="s", dimensions=(1,))
    if not len(at):
        raise ParameterError(Problem("times", " has no elements: must have one or more"))
    check_each("times", at, (at >= 0.0) & (np.diff(at, prepend=-1.0) > 0.0), "increasing, >= 0, in s")
    closure = _closure(body, law)
    first = closure.of(1.0, ratio)[0]
    rate = n * math.sqrt(t) * first
    if not at[-1] * rate <= _LONG:
        allowed = f"at most {_LONG / rate:.3g} s, {_LONG:g} times that between two contacts at the beginning"
        raise ParameterError(wrong("times", float(at[-1]), allowed))

    def change(_: float, state: npt.NDArray[np.float64]) -> list[float]:
        # In units of the first rate of contacts: ln T_tr, T_rot/T_tr, which may begin near 0, and contacts.
        now = max(state[1], 0.0)
        speed = math.exp(0.5 * state[0]) / first
        contacts, one, other = (speed * part for part in closure.of(1.0, now))
        turning = other / (0.5 * closure.axes) if closure.axes else 0.0
        return [one / 1.5, turning - now * one / 1.5, contacts]

    start = [0.0, ratio, 0.0]
    if not at[-1] * rate > 0.0:  # a time alone that is 0, or so short that nothing has happened
        rate = 1.0
    found = solve_ivp(
        change, (0.0, at[-1] * rate + 1e-9), start, t_eval=at * rate, method="DOP853", rtol=1e-10, atol=1e-10
    )
    cooled = t * np.exp(found.y[0])
    variables = {
        "translational_temperature": (cooled, "translational temperature", "J"),
        "rotational_temperature": (cooled * found.y[1], "rotational temperature", "J"),
        "contacts": (found.y[2], "contacts of a particle", "1"),
    }
    return xr.Dataset(
        {
            name: ("time", values, {"long_name": text, "units": unit})
            for name, (values, text, unit) in variables.items()
        },
        {"time": ("time", at, {"long_name": "time", "units": "s"})},
    )


def _gas(translational: float, rotational: float, number_density: float) -> tuple[float, float, float]:
    """Check both temperatures and the density; return T_tr, T_rot/T_tr and the density."""
    t = positive("translational_temperature", translational, "J")
    r = positive("rotational_temperature", rotational, "J")
    if not t / _FAR <= r <= t * _FAR:
        text = f" = {r:g}, translational_temperature = {t:g}: must be at most a factor of {_FAR:g} apart"
        raise ParameterError(Problem("rotational_temperature", text))
    return t, r / t, positive("number_density", number_density, "m-3")
