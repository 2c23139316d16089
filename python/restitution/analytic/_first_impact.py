"""`first_impact`: the distribution of ε at the first impact from rest, for every body and law."""

from __future__ import annotations

from typing import Literal, get_args

import numpy as np

from restitution._internal.arrays import word
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.analytic._branched import BranchedFirstImpact
from restitution.analytic._frozen import FirstImpact, check
from restitution.analytic._hull import Outline
from restitution.analytic._normal import Fall
from restitution.analytic._orientation import ORIENTATIONS, OrientationName
from restitution.analytic._rigid_first import RigidFirstImpact
from restitution.analytic._rough_first import RoughFirstImpact
from restitution.analytic._two_balls import TwoBallsFirstImpact
from restitution.bodies import Body, Dumbbell, RigidBody, RoughSphere, Spherocylinder, Turned
from restitution.laws import Frictionless, Law, TangentialRestitution

SHORTEST, LONGEST = 1e-100, 1e100  # L/R whose powers, up to the third, are normal numbers
NARROWEST = 1e-9  # support of ε that leaves the density seven digits
LARGEST_ERROR = 0.01  # of a distribution function
Surface = Literal["any", "own"]


def first_impact(
    body: Body | RigidBody,
    law: Law,
    orientation: OrientationName | None = None,
    *,
    release_height: float | None = None,
    gravity: float | None = None,
    surface: Surface = "any",
) -> FirstImpact:
    """Distribution of the coefficient of restitution ε at the first impact from rest (the paper's Sec. IV).

    The body is released without spin and without horizontal velocity, so ε depends on the orientation alone
    (Eq. 17), and with a number for ``law.normal`` not on height, size or density. Every law has a closed form
    there, ε(θ) or for any body ε(n) with the plane normal n in its axes; docs/first-impact.md derives them.

    Parameters
    ----------
    body : Dumbbell or another body
        Not a sphere about its centre of mass. ``surface`` says what a RoughSphere stands for; of other bodies
        the distribution is that over their attitudes.
        For two equal balls under the paper's law or without friction, L/R from 1e-100 to 1e100; else such
        that ε varies by 1e-9 at least. Of a Clump, an Ellipsoid, a polyhedron, a Mesh or a Rough body the
        distribution function is computed in some seconds, and ``cdf_error`` estimates its error.
    law : TangentialRestitution or another law
        Law of the impact.
    orientation : {"uniform-angle", "isotropic"}
        Law of the angle θ between symmetry axis and plane normal: θ uniform in [0, π) as in the paper, or the
        axis uniform on the sphere. As for `simulate` the first if it is left out, but for rigid bodies
        without a given angle, such as a Clump, which take "isotropic" alone: all attitudes equally likely.
    release_height : float
        Height of the centre of mass at release, in m: more than it is high on the plane at any angle. For a
        law whose ``normal`` depends on the speed, else not to be given.
    gravity : float
        Acceleration of gravity in m/s², > 0; as `release_height`.
    surface : {"any", "own"}
        Of a RoughSphere: "any" is the distribution over all spheres with as many asperities, which are to
        have equal heights, in closed form whatever the seed; "own" that over the attitudes of this one,
        computed as for a Clump, which takes some hundred asperities at most.

    Returns
    -------
    FirstImpact
        Used like a frozen distribution of `scipy.stats`.

    Raises
    ------
    ValueError
        Naming the argument, its value and what is allowed.

    Examples
    --------
    >>> import restitution as rs
    >>> from restitution.analytic import first_impact
    >>> body = rs.Dumbbell(radius=3e-3, separation=6e-3)
    >>> distribution = first_impact(body, rs.TangentialRestitution(normal=0.4))
    >>> round(float(distribution.cdf(0.0)), 4)
    0.0295
    >>> egg = rs.Spheroid(equatorial=2e-2, polar=3e-2)
    >>> steel = rs.Coulomb(normal=rs.Plastic(yield_speed=0.02), friction=0.2)
    >>> round(first_impact(egg, steel, release_height=0.1, gravity=9.81).mean(), 3)
    0.322
    >>> brick = rs.Box(a=1e-2, b=2e-2, c=3e-2)
    >>> round(first_impact(brick, rs.TangentialRestitution(normal=0.7)).mean(), 3)
    0.24
    """
    check(body, law)
    orientation = _oriented(body, orientation)
    fall = _fall(body, law, release_height, gravity)
    word("surface", surface, get_args(Surface))
    if isinstance(body, RoughSphere) and surface == "any":
        return _wide_enough(RoughFirstImpact(body, law, "isotropic", fall))
    if isinstance(body, Turned):
        _about_its_axis(body)
        return _wide_enough(BranchedFirstImpact(body, law, orientation, fall))
    if isinstance(body, RigidBody):
        return _exact_enough(RigidFirstImpact(body, law, orientation, fall))
    _not_a_sphere(body, law)
    equal = isinstance(body, Spherocylinder) or (isinstance(body, Dumbbell) and body.is_equal)
    if equal and isinstance(law, TangentialRestitution | Frictionless) and isinstance(law.normal, float):
        assert isinstance(body, Dumbbell | Spherocylinder)
        if not SHORTEST <= body.elongation <= LONGEST:
            allowed = f"{SHORTEST:g} to {LONGEST:g} times body.radius"
            raise ParameterError(wrong("body.separation", body.separation, allowed))
        return TwoBallsFirstImpact(body, law, orientation)
    return _wide_enough(BranchedFirstImpact(body, law, orientation, fall))


def _about_its_axis(body: Turned) -> None:
    """Refuse solids of revolution whose matter is not that of one."""
    tensor, size = body.inertia_tensor, body.compiled.farthest()
    beside = max(abs(tensor[0, 0] - tensor[1, 1]), *np.abs(tensor[[0, 0, 1], [1, 2, 2]]))
    if beside > 1e-9 * tensor[0, 0] or np.abs(body.centre_of_mass[:2]).max() > 1e-9 * size:
        allowed = "with an inertia and a centre of mass of a body of revolution"
        raise ParameterError(wrong("body", body, allowed))


def _oriented(body: Body | RigidBody, orientation: OrientationName | None) -> OrientationName:
    """Choose the orientation as `simulate` does, unless one is given."""
    if orientation is None:
        return "uniform-angle" if isinstance(body, Body) else "isotropic"
    word("orientation", orientation, ORIENTATIONS)
    if orientation != "isotropic" and not isinstance(body, Body | RoughSphere):
        raise ParameterError(wrong("orientation", orientation, "'isotropic', for a rigid body of any shape"))
    return orientation


def _wide_enough(distribution: BranchedFirstImpact | RigidFirstImpact) -> FirstImpact:
    body = distribution.body
    low, high = distribution.support()
    if high - low < NARROWEST:
        allowed = f"a body for which restitution varies by {NARROWEST:g} at least; here by {high - low:.1e}"
        raise ParameterError(wrong("body", body, allowed))
    return distribution


def _exact_enough(distribution: RigidFirstImpact) -> FirstImpact:
    _wide_enough(distribution)
    if distribution.cdf_error > LARGEST_ERROR:
        text = (
            f": its distribution function would be off by up to {distribution.cdf_error:.1e}; must be a body "
        )
        allowed = f"for which that is at most {LARGEST_ERROR:g}, of fewer or larger asperities or vertices"
        raise ParameterError(Problem("body", text + allowed))
    return distribution


def _fall(body: Body | RigidBody, law: Law, release_height: float | None, gravity: float | None) -> Fall:
    given = {"release_height": release_height, "gravity": gravity}
    if isinstance(law.normal, float):
        for name, value in given.items():
            if value is not None:
                raise ParameterError(
                    wrong(name, value, f"left out: law.normal = {law.normal!r} at any speed")
                )
        return Fall(release_height=2.0 * _highest(body), gravity=1.0)  # any: nothing depends on it
    for name, value in given.items():
        if value is None:
            text = f": missing; law.normal = {type(law.normal).__name__} depends on the speed"
            raise ParameterError(Problem(name, text))
    fall = Fall(**given)
    highest = _highest(body)
    if not fall.release_height > highest * (1.0 + 1e-9):
        allowed = f"more than {highest!r} m, or the body may touch the plane at release"
        raise ParameterError(wrong("release_height", release_height, allowed))
    return fall


def _highest(body: Body | RigidBody) -> float:
    """Return the greatest height of the centre of mass of a body that touches the plane, in m."""
    return Outline.of(body).unit if isinstance(body, RoughSphere) else body.compiled.farthest()


def _not_a_sphere(body: Body, law: Law) -> None:
    one, two = body.compiled.outline
    if one[:3] == two[:3] and one[0] == 0.0 and one[1] == one[2]:
        sphere = f"a sphere has no distribution, its restitution is law.normal = {law.normal!r}"
        raise ParameterError(wrong("body", body, f"no sphere about its centre of mass; {sphere}"))
