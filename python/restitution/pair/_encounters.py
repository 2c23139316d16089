"""Encounters of two bodies, or of a body with a plane, as an xarray Dataset."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution import _core
from restitution._internal.arrays import FloatArray, check_each, real, reals, whole, word
from restitution._internal.parameters import ParameterError, Parameters, Problem, wrong
from restitution._internal.process import uninterrupted
from restitution._internal.resources import check_size, checked_threads, progress_bar
from restitution.bodies import AnyBody
from restitution.drop.dataset import made_here
from restitution.laws import CollisionLaw
from restitution.pair.partners import between, read_states

Columns: TypeAlias = dict[str, npt.NDArray[Any]]
"""Variables by their names."""
Table: TypeAlias = dict[str, tuple[tuple[str, ...], npt.NDArray[Any], dict[str, Any]]]
"""The same with their dimensions and attributes."""
Record: TypeAlias = Literal["encounters", "state", "contacts"]
_STATE = {"position": 3, "velocity": 3, "angular_velocity": 3, "attitude": 4}
_ENDINGS: list[str] = _core.PAIR_ENDINGS
COLLAPSE, LASTED = _ENDINGS.index("collapse"), _ENDINGS.index("lasted")
_CHUNK = 1 << 16
"""Encounters that are held at a time where there may be many."""


class Plane(Parameters):
    """A plane at rest, z = 0, the body of infinite mass: what `encounters` takes as `other`.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    >>> data = rs.pair.encounters(
    ...     body, rs.Plane(), law, encounters=100, speed=1.0, rotational_temperature=0.0
    ... )
    >>> bool((data.contacts > 0).all())
    True
    """


Other: TypeAlias = AnyBody | Plane


@dataclass(frozen=True)
class Pairs:
    """Checked pairs: the bodies, the law that holds between them, and what the core draws them from."""

    body: AnyBody
    other: Other
    law: CollisionLaw
    drawn: dict[str, Any]

    @classmethod
    def of(
        cls,
        body: AnyBody,
        other: Other,
        law: CollisionLaw,
        *,
        encounters: int,
        seed: int,
        translational_temperature: float | tuple[float, float] | None = None,
        rotational_temperature: float | tuple[float, float] | None = None,
        speed: float | None = None,
        impact_parameter: float | None = None,
        spin: npt.ArrayLike | None = None,
    ) -> Pairs:
        """Check pairs that are drawn."""
        check_kinds(body, other, law)
        for name, value, other_name, instead in (
            ("translational_temperature", translational_temperature, "speed", speed),
            ("rotational_temperature", rotational_temperature, "spin", spin),
        ):
            if (value is None) == (instead is None):
                given = "both" if instead is not None else "neither"
                text = f": {given} given beside {other_name}; exactly one of the two must be"
                raise ParameterError(Problem(name, text))
        drawn: dict[str, Any] = {
            "first": 0,
            "encounters": whole("encounters", encounters, 1, 2**40),
            "translational_temperature": _temperatures(
                "translational_temperature", translational_temperature
            ),
            "speed": None if speed is None else real("speed", speed, "a finite number > 0 (m/s)"),
            "impact_parameter": None,
            "rotational_temperature": _temperatures("rotational_temperature", rotational_temperature)
            or (0.0, 0.0),
            "spin": None if spin is None else _spins(spin),
            "seed": whole("seed", seed, 0, 2**64 - 1),
        }
        if impact_parameter is not None:
            drawn["impact_parameter"] = real("impact_parameter", impact_parameter, "a finite number >= 0 (m)")
        return cls(body, other, law, drawn)

    def in_chunks(
        self, threads: int, *, states: bool = False, contacts: bool = False
    ) -> Iterator[tuple[Columns, Columns, float]]:
        """Follow those that are drawn, few at a time."""
        count = self.drawn["encounters"]
        for first in range(0, count, _CHUNK):
            self.drawn.update(first=first, encounters=min(_CHUNK, count - first))
            *tables, rate = self.follow(None, (states, contacts), threads)
            found, hits = ({name: values for name, (_, values, _) in table.items()} for table in tables)
            yield found, hits, rate

    def follow(
        self, given: FloatArray | None, wanted: tuple[bool, bool], threads: int, progress: Any = None
    ) -> tuple[Table, Table, float]:
        """Follow them; variables of encounters, of contacts one after the other, and the rate of attempts.

        Places and attitudes are among them if the first of `wanted` is true, contacts if the second is.
        """
        other = None if isinstance(self.other, Plane) else self.other.compiled
        law = self.law
        if not isinstance(self.other, Plane):
            law = between(law, self.other.mass / self.body.mass)
        try:
            tables, rate, interrupted = _core.encounters(
                self.body.compiled, other, law.compiled, self.drawn, given, wanted, threads, progress
            )
        except _core.ParameterError as error:
            bodies = {"body": self.body, "other": self.other}
            value = bodies.get(error.name, error.value)
            raise ParameterError(wrong(error.name, value, error.allowed)) from None
        found, hits = uninterrupted(tables, interrupted)
        return found, hits, rate


def check_kinds(body: object, other: object, law: object) -> None:
    """Refuse what is no body, no body or plane, or no law."""
    if not isinstance(body, AnyBody):
        raise ParameterError(wrong("body", body, "a body, such as Dumbbell"))
    if not isinstance(other, AnyBody | Plane):
        raise ParameterError(wrong("other", other, "a body, or Plane()"))
    if not isinstance(law, CollisionLaw):
        raise ParameterError(wrong("law", law, "a collision law, such as Frictionless"))


def _temperatures(name: str, value: Any) -> tuple[float, float] | None:
    if value is None:
        return None
    allowed = "0 or a number in [1e-100, 1e100], or one for each body (J)"
    found = reals(name, value, allowed, unit="J", dimensions=(0, 1))
    if found.size not in (1, 2) or (found.ndim == 1 and found.size == 1):
        raise ParameterError(wrong(name, value, allowed))
    check_each(name, found, (found == 0.0) | ((found >= 1e-100) & (found <= 1e100)), allowed)
    one, two = np.broadcast_to(found, 2).tolist()
    return one, two


def _spins(value: Any) -> list[list[float]]:
    allowed = "three numbers, or three for each body (rad/s)"
    found = reals("spin", value, allowed, unit="rad s-1", dimensions=(1, 2))
    if found.shape not in {(3,), (2, 3)}:
        raise ParameterError(wrong("spin", value, allowed))
    rows: list[list[float]] = np.broadcast_to(found, (2, 3)).tolist()
    return rows


def encounters(
    body: AnyBody,
    other: AnyBody | Plane,
    law: CollisionLaw,
    *,
    encounters: int = 10_000,
    translational_temperature: float | tuple[float, float] | None = None,
    rotational_temperature: float | tuple[float, float] | None = None,
    speed: float | None = None,
    impact_parameter: float | None = None,
    spin: npt.ArrayLike | None = None,
    seed: int = 0,
    threads: int | None = None,
    states: xr.Dataset | None = None,
    record: Record = "encounters",
    progress: bool = False,
) -> xr.Dataset:
    """Follow encounters of two bodies in free flight, or of a body with a plane, contact by contact.

    Pairs are drawn where they come through the sphere about the second body whose radius is the sum of the
    distances to which both reach from their centres of mass, with the flux of two Maxwellians and attitudes
    that are uniform on SO(3); or they are given as `states`. Each is followed until the bodies are farther
    apart than they reach and part. Most pairs of long bodies miss each other: their ``contacts`` are 0.

    Parameters
    ----------
    body : Dumbbell or another body
        The first body: made of balls (Dumbbell, Clump, RoughSphere and others, and these in Rough), a
        Spheroid or Ellipsoid, a Superellipsoid with exponents up to 8, a Spherocylinder, a polyhedron
        (ConvexPolyhedron, Box, Die) or a Cylinder. Of others only the convex hull is known, which is all that
        touches a plane, but not enough here.
    other : such a body, or Plane
        The second one. A plane is at rest, and there is no gravity.
    law : Law or CustomLaw
        The collision law, for the compliances of both bodies together. The coefficient of `Viscoelastic` is
        that of two spheres of the material, unless `other` is a plane: its radius is that of `body`, and that
        of `other` larger by the cube root of the ratio of the masses. Any other is taken as it is.
    encounters : int
        Number of encounters.
    translational_temperature : float or pair of float, optional
        T_tr of both bodies or of each, in J: each component of the velocity has the variance T_tr/m.
    rotational_temperature : float or pair of float, optional
        T_rot of both or of each, in J: the angular velocity about a principal axis has the variance T_rot/J.
    speed : float, optional
        The relative speed in m/s, instead of `translational_temperature`; the centre of mass rests.
    impact_parameter : float, optional
        The distance of the lines on which the centres approach, in m, instead of one that is uniform on the
        disc.
    spin : array_like, optional
        Angular velocity of both bodies or rows for each, in rad/s, instead of `rotational_temperature`.
    seed : int
        Seed; an encounter depends on the seed and its number alone.
    threads : int, optional
        Number of threads; one for each core if not given. The result does not depend on it.
    states : xarray.Dataset, optional
        Given pairs instead: ``position`` (m), ``velocity`` (m/s) and ``angular_velocity`` (rad/s) over
        (encounter, particle, component), and ``attitude``, unit quaternions (w, x, y, z), over (encounter,
        particle, quaternion), all in the axes of space. `encounters`, temperatures, `speed`,
        `impact_parameter` and `spin` are then left out.
    record : {"encounters", "state", "contacts"}
        With "state" also positions and attitudes before and after; with "contacts" these and, over
        (encounter, contact), ``time``, ``normal`` (from the second body to the first), ``point``,
        ``impulse`` on the first body, ``approach_speed`` and ``separation_speed``.
    progress : bool
        Show a progress bar on standard error.

    Returns
    -------
    xarray.Dataset
        Over encounter: ``contacts``; ``ending`` (``missed``; ``parted``; ``lasted``, of bodies without
        friction that rotation pressed together, so that contacts accumulated: they slide on each other until
        they part, followed to about 1e-9; ``collapse``, of those with friction: what comes after it is not
        known); ``duration``; ``deflection`` of the relative
        velocity; ``contact_speed`` and ``centre_speed`` at the first contact; and three definitions of ε:
        ``restitution_centres`` -(u'·k)/(u·k) (u the relative velocity of the centres, k their line at the
        first contact), ``restitution_contact`` -(v'·n)/(v·n) (of the points of the first contact along its
        normal), and ``restitution_energy`` √(E'/E) (E the kinetic energy in the frame of the centre of mass).
        Over (encounter, particle), ``..._before`` and ``..._after``: ``translational_energy``,
        ``rotational_energy``, and, with components, ``velocity`` and ``angular_velocity``. The attribute
        ``attempt_rate``, in m³/s, is the flux of pairs through the sphere at unit density: times the mean of
        ``contacts`` it is the rate of contacts of a particle. On a plane it is the flux through unit area, in
        m/s. Parameters are attributes, too.

    Raises
    ------
    ValueError
        For a wrong argument; the message names it, its value and what is allowed.

    Examples
    --------
    >>> import restitution as rs
    >>> body = rs.Dumbbell(radius=1e-3, separation=1e-3)
    >>> data = rs.pair.encounters(
    ...     body, body, rs.Frictionless(normal=0.9), encounters=1000,
    ...     translational_temperature=1e-8, rotational_temperature=1e-8, seed=1,
    ... )
    >>> float((data.contacts > 0).mean().round(1))
    0.7
    """
    word("record", record, get_args(Record))
    number = checked_threads(threads)
    rows = None
    given: dict[str, Any] = {
        "translational_temperature": translational_temperature,
        "rotational_temperature": rotational_temperature,
        "speed": speed,
        "impact_parameter": impact_parameter,
        "spin": spin,
    }
    if states is None:
        pairs = Pairs.of(body, other, law, encounters=encounters, seed=seed, **given)
    else:
        for name, value in given.items():
            if value is not None:
                raise ParameterError(Problem(name, ": given beside states, which say it already"))
        check_kinds(body, other, law)
        rows = _rows(states, plane=isinstance(other, Plane))
        drawn = {**dict.fromkeys(given), "first": 0, "encounters": len(rows)}
        drawn |= {"rotational_temperature": (0.0, 0.0), "seed": whole("seed", seed, 0, 2**64 - 1)}
        pairs = Pairs(body, other, law, drawn)
    count = pairs.drawn["encounters"]
    check_size("encounters", count, count, 2 * sum(_core.PAIR_ENCOUNTER.values()), "encounters")
    with progress_bar("encounters", count, "encounters", show=progress) as tell:
        wanted = (states is not None or record != "encounters", record == "contacts")
        found, hits, rate = pairs.follow(rows, wanted, number, tell)
    data = _dataset(found, hits if record == "contacts" else None)
    if states is None and impact_parameter is None:
        data.attrs |= {
            "attempt_rate": rate,
            "attempt_rate_units": rate_unit(plane=isinstance(other, Plane)),
        }
    kept = {name: value for name, value in pairs.drawn.items() if value is not None and name != "first"}
    plain = {name: np.ravel(value) if np.ndim(value) else value for name, value in kept.items()}
    return data.assign_attrs(described(pairs) | plain)


def rate_unit(*, plane: bool) -> str:
    """Return the unit of a rate at unit density: on unit area of a plane, of a particle elsewhere."""
    return "m s-1" if plane else "m3 s-1"


def described(pairs: Pairs) -> dict[str, Any]:
    """Return title, version, bodies and law as attributes."""
    about = made_here("Encounters of two bodies in free flight")
    for name, one in (("body", pairs.body), ("other", pairs.other), ("law", pairs.law)):
        about[name] = type(one).__name__
        values = {} if isinstance(one, Plane) else one.attributes()
        about |= {f"{name}_{key}": value for key, value in values.items() if np.size(value) <= 100}
    return about


def _rows(states: xr.Dataset, *, plane: bool) -> FloatArray:
    """Take given pairs as rows of position, velocity, ω and attitude of each body."""
    columns = read_states("states", states, _STATE, encounter=None, particle=2)
    if plane:
        still = [columns[0][:, 1], columns[1][:, 1], columns[2][:, 1], columns[3][:, 1, 1:]]
        for name, values in zip(_STATE, still, strict=True):
            check_each(f"states.{name}", values, values == 0.0, "0 of the plane, z = 0, which does not move")
    return np.ascontiguousarray(np.concatenate(columns, axis=-1).reshape(len(columns[0]), -1))


def _dataset(found: Table, hits: Table | None) -> xr.Dataset:
    """Put the variables of the contacts into rows of their encounters."""
    variables = dict(found)
    if hits is not None:
        number = found["contacts"][1]
        there = np.arange(number.max(initial=0)) < number[:, np.newaxis]
        for name, (dims, values, about) in hits.items():
            table = np.full((*there.shape, *values.shape[1:]), np.nan)
            table[there] = values
            variables[name] = (("encounter", *dims), table, about)
    coordinates: dict[str, Any] = {"component": ["x", "y", "z"]}
    if "attitude_before" in found:
        coordinates["quaternion"] = ["w", "x", "y", "z"]
    return xr.Dataset(variables, coords=coordinates)
