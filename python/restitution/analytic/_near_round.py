"""A nearly round dumbbell through all of its impacts, without a search for contacts."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import whole
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.analytic._orientation import Floats
from restitution.bodies import Body, Dumbbell
from restitution.drop.bins import centres, increasing_edges
from restitution.drop.release import RandomHeight
from restitution.drop.run import Run
from restitution.laws import Frictionless, Law, TangentialRestitution

_ROUND = 0.2
"""Largest L/R."""
_SLOW = 0.6
"""Least impact velocity, in √(gR)."""


def near_round(
    body: Body,
    law: Law,
    *,
    velocity_bins: npt.ArrayLike,
    release_height: float = 0.06,
    gravity: float = 9.81,
    angles: int = 4000,
) -> xr.Dataset:
    """Return the moments of ε by impact velocity for a nearly round dumbbell released from rest, by a map.

    The impulse (Eqs. 6–11) is exact, at the angle that the axis has at the end of the flight, and the flight
    takes (v' + v'')/g, with v' and v'' the speeds after an impact and before the next. The two ends of a body
    are not at the same height: v''² = v'² - gL(|cos θ''| - |cos θ'|), in which θ'' is that of a flight
    2v'/g. So nothing is searched for; what is left out is the next order in L of the time of the contact. The
    error of σ is 2 % rms up to L/R = 0.1, mostly because of the number of `angles`, and 3 % at 0.2, that of
    one bin up to 12 %; docs/near-round.md.

    Parameters
    ----------
    body : Dumbbell
        With equal spheres and L/R <= 0.2.
    law : TangentialRestitution or Frictionless
        With a number for ε_n.
    velocity_bins : array_like, shape (nv + 1,)
        Edges of bins of impact velocity in m/s, increasing.
    release_height : float
        Height of the centre of mass at release, in m.
    gravity : float
        In m/s².
    angles : int
        Angles of the axis at release, spread evenly over [0, π); at most 10⁶.

    Returns
    -------
    xarray.Dataset
        By ``velocity``: ``mean_restitution``, ``std_restitution``, ``second_moment`` (<ε²>) and ``number`` of
        impacts. NaN where there are none, and in bins that begin below 0.6 √(gR), where flights are so short
        that the map fails.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> found = rs.analytic.near_round(rs.Dumbbell(radius=3e-3, separation=1.5e-4),
    ...                                rs.TangentialRestitution(normal=0.9),
    ...                                velocity_bins=np.linspace(0.0, 1.1, 12))
    >>> round(float(found["std_restitution"].sel(velocity=0.35, method="nearest")), 3)
    0.006
    """
    edges = increasing_edges(velocity_bins, "velocity_bins")
    if not isinstance(body, Dumbbell) or not body.is_equal:
        raise ParameterError(wrong("body", body, "a Dumbbell with equal spheres"))
    if body.elongation > _ROUND:
        allowed = f"at most {_ROUND} of the radius; longer bodies need `restitution.statistics`"
        raise ParameterError(wrong("separation", body.separation, allowed))
    if not isinstance(law, TangentialRestitution | Frictionless) or not isinstance(law.normal, float):
        raise ParameterError(
            wrong("law", law, "TangentialRestitution or Frictionless, with a number for normal")
        )
    angles = whole("angles", angles, 1, 10**6)
    if isinstance(release_height, RandomHeight):
        raise ParameterError(wrong("release_height", release_height, "a number, the same for all"))
    run = Run(body=body, law=law, release_height=release_height, gravity=gravity)
    gravity, height = run.gravity, run.release_height
    slowest = _SLOW * float(np.sqrt(gravity * body.radii[0]))
    if law.normal == 1.0:
        raise ParameterError(Problem("normal", " = 1.0: must be < 1; the impacts would never end"))
    if not (slowest > 0.0 and np.isfinite(slowest) and np.isfinite(2 * gravity * height)):
        raise ParameterError(wrong("gravity", gravity, "such that speeds neither overflow nor underflow"))
    velocity, epsilon = _impacts(run, min(slowest, edges[-1]), angles)
    return _by_velocity(velocity, epsilon, edges, slowest)


def _impacts(run: Run, slowest: float, angles: int) -> tuple[Floats, Floats]:
    """Follow bodies that differ in their angle only; give v and ε of all impacts faster than `slowest`.

    Masses are those of the body over its own. The axis leans by θ towards x; the lower end touches at (x, z)
    from the centre of mass, where a spin dθ/dt = ω moves the surface by (zω, -xω).
    """
    body, law = run.body, run.standard_law
    assert isinstance(body, Dumbbell)
    assert isinstance(law.normal, float)
    radius, half = body.radii[0], 0.5 * body.separation
    inertia = body.transverse_inertia / body.mass
    g, drop = run.gravity, run.release_height - radius
    theta = (np.arange(angles) + 0.5) * np.pi / angles
    spin, sideways = np.zeros(angles), np.zeros(angles)
    speed = np.sqrt(2 * g * (drop - half * np.abs(np.cos(theta))))
    velocities, coefficients = [], []
    for _ in range(_most(run, slowest)):
        lower = half * np.abs(np.cos(theta))
        x, z = -half * np.sin(theta) * np.sign(np.cos(theta)), -radius - lower
        normal, tangential = -speed - x * spin, sideways + z * spin
        # Velocity of the contact gains K P; Frictionless has P_x = 0, the other law u_x' = ε_t u_x.
        along, up = np.zeros(angles), -(1 + law.normal) * normal / (1 + x * x / inertia)
        if isinstance(law, TangentialRestitution):
            wanted = (law.tangential - 1) * tangential
            kxx, kxz, kzz = 1 + z * z / inertia, -x * z / inertia, 1 + x * x / inertia
            up = (-(1 + law.normal) * normal - kxz / kxx * wanted) / (kzz - kxz * kxz / kxx)
            along = (wanted - kxz * up) / kxx
        spin = spin + (z * along - x * up) / inertia
        sideways = sideways + along
        rising = up - speed
        counted = speed >= slowest
        velocities.append(speed[counted])
        coefficients.append(rising[counted] / speed[counted])
        going = (rising > 0) & (speed >= 0.2 * slowest)
        theta, spin, sideways, rising, lower = (
            part[going] for part in (theta, spin, sideways, rising, lower)
        )
        angles = theta.size
        if not angles:
            break
        turned = theta + spin * 2 * rising / g
        higher = half * np.abs(np.cos(turned)) - lower
        speed = np.sqrt(np.maximum(rising**2 - 2 * g * higher, 0.0))
        theta = theta + spin * (rising + speed) / g
    return np.concatenate(velocities), np.concatenate(coefficients)


def _most(run: Run, slowest: float) -> int:
    """Return a number of impacts after which all bodies are slower: three times that without spin."""
    assert isinstance(run.standard_law.normal, float)
    fastest = np.sqrt(2 * run.gravity * run.release_height)
    return 10 + int(3 * max(0.0, np.log(fastest / slowest)) / -np.log(max(run.standard_law.normal, 1e-3)))


def _by_velocity(velocity: Floats, epsilon: Floats, edges: Floats, slowest: float) -> xr.Dataset:
    bins = edges.size - 1
    place = np.searchsorted(edges, velocity, side="right") - 1
    inside = (place >= 0) & (place < bins)
    number, first, second = (
        np.bincount(place[inside], weight[inside], bins) for weight in (epsilon**0, epsilon, epsilon**2)
    )
    good = (number > 0) & (edges[:-1] >= slowest)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean, square = np.where(good, first / number, np.nan), np.where(good, second / number, np.nan)
        spread = np.bincount(place[inside], (epsilon - mean[np.clip(place, 0, bins - 1)])[inside] ** 2, bins)
        std = np.sqrt(spread / number)
    about = {
        "mean_restitution": (mean, "mean of restitution"),
        "std_restitution": (std, "standard deviation of restitution"),
        "second_moment": (square, "mean of restitution squared"),
        "number": (number.astype(np.int64), "impacts of the map"),
    }
    axis = {"units": "m s-1", "long_name": "impact velocity"}
    return xr.Dataset(
        {name: ("velocity", values, {"long_name": text}) for name, (values, text) in about.items()},
        {"velocity": ("velocity", centres(edges), axis)},
    )
