"""The motion between impacts in closed form: where a particle is at any time, from its recorded states."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution import _core
from restitution._internal.arrays import FloatArray, check_each, reals, whole
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.drop.dataset import labelled
from restitution.drop.recorded import (
    RECORDS,
    attribute,
    check_frame,
    check_successive,
    pull,
    released_from,
    variables,
)

_STATES = ("position", "velocity_after", "angular_velocity_after")
_NEEDED = {"time": RECORDS, **dict.fromkeys(_STATES, (*RECORDS, "component"))}
_WITH_AXIS = {"axis": (*RECORDS, "component"), "release_angle": ("particle",)}
_WITHOUT = {"attitude": (*RECORDS, "quaternion"), "release_attitude": ("particle", "quaternion")}
_RELEASED = {"release_azimuth": ("particle",), "release_spin": ("particle", "component")}
"""Of each particle, or not there where it is 0."""
_ABOUT = {
    "position": ("position of the centre of mass; the release is over the origin, z = 0 the plane", "m"),
    "velocity": ("velocity of the centre of mass", "m s-1"),
    "axis": ("unit vector of the symmetry axis, from sphere 2 to sphere 1", "1"),
    "attitude": ("rotation from the axes of the body to those of space, a quaternion", "1"),
    "angular_velocity": ("angular velocity", "rad s-1"),
}


def with_positions(data: xr.Dataset) -> xr.Dataset:
    """Make positions of the recorded heights and velocities: in flight gravity alone acts (5)."""
    time, after = data["time"].to_numpy(), data["velocity_after"].to_numpy()
    position = np.empty(after.shape)
    position[..., 2] = data["height"].to_numpy()
    duration = np.diff(time, axis=1, prepend=0.0)
    pulled = _gravity(data.attrs["gravity"], data.attrs["incline"])
    for i in range(2):
        start = np.empty(time.shape)
        start[:, :1], start[:, 1:] = data.attrs["release_velocity"][i], after[:, :-1, i]
        np.cumsum(duration * (start + 0.5 * pulled[i] * duration), axis=1, out=position[..., i])
    about, unit = _ABOUT["position"]
    attrs = {"long_name": f"{about}; at the impact", "units": unit}
    return data.drop_vars("height").assign(position=(("particle", "impact", "component"), position, attrs))


def trajectory(data: xr.Dataset, particle: int, times: npt.ArrayLike) -> xr.Dataset:
    """Return the exact motion of a particle at any times, from its release to its last recorded impact.

    Between impacts the centre of mass moves on a parabola, and a free body of revolution turns about its
    angular momentum **Λ** at the constant rate Λ/J', its moment of inertia across the axis being J'; any
    other turns as Euler's equations say, by elliptic functions. At the time of an impact it is the motion
    after it.

    Parameters
    ----------
    data : xarray.Dataset
        Impacts from `restitution.simulate` with ``record="state"``.
    particle : int
        Its number, as in the coordinate ``particle``.
    times : float or array_like, shape (n,)
        Times since release in s, in any order, from 0 to that of the last impact.

    Returns
    -------
    xarray.Dataset
        Over ``time`` and ``component`` (x, y, z, in the frame of the plane): ``position`` of the centre of
        mass in m, relative to the point of the plane under the release, ``velocity`` in m/s, ``axis``, the
        unit vector of the symmetry axis, and ``angular_velocity`` in rad/s; over ``time`` the number of
        ``impacts`` up to then. Of a body that has no ``angle``, ``attitude`` over ``quaternion`` instead.

    Raises
    ------
    ValueError
        If there are no states, or such as are no numbers or not of all impacts from the first on, no such
        particle, or times before the release or after the last impact.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.Coulomb(normal=0.9, friction=0.2)
    >>> data = rs.simulate(body, law, particles=5, impacts=20, spin=(0.0, 30.0, 10.0), record="state")
    >>> path = rs.trajectory(data, 3, [0.0, 0.1, 0.2])
    >>> path.position.shape, path.impacts.values.tolist()
    ((3, 3), [0, 0, 1])
    """
    _check(data)
    turns = _top(data) if "attitude" in data else _symmetric(data)
    pulled = np.array(_gravity(*pull("data", data)))
    heights = np.broadcast_to(released_from("data", data), data.sizes["particle"])
    one = _particle(data.assign(release_height=("particle", heights)), particle)
    asked = reals("times", times, "times in s, one or several", unit="s", dimensions=(0, 1), finite=False)
    when = np.atleast_1d(asked)
    happened = times_of(one["time"].to_numpy())
    last = float(happened[-1]) if happened.size else 0.0
    allowed = f"in [0, {last!r}] s, from the release to the last recorded impact of particle {particle}"
    check_each("times", when, (when >= 0.0) & (when <= last), allowed)

    flight = np.searchsorted(happened, when, side="right")
    with np.errstate(over="ignore", invalid="ignore"):
        begin = {name: values[flight] for name, values in _begin(one, happened.size).items()}
        elapsed = (when - begin["time"])[:, None]
        position, velocity = begin["position"], begin["velocity"]
        found = {
            "position": position + elapsed * (velocity + 0.5 * elapsed * pulled),
            "velocity": velocity + elapsed * pulled,
            **turns(begin, elapsed),
        }
    if not all(np.isfinite(values).all() for values in found.values()):
        text = ": the motion at these times is not finite; must be the states and settings of a run"
        raise ParameterError(Problem("data", text))
    about: dict[str, Any] = {
        name: (("time", "quaternion" if name == "attitude" else "component"), values, *_ABOUT[name])
        for name, values in found.items()
    }
    about["impacts"] = ("time", flight, "number of impacts up to then", None)
    coordinates = {
        "time": ("time", when, {"long_name": "time since release", "units": "s"}),
        **{name: data[name] for name in ("component", "quaternion") if name in data.coords},
    }
    return xr.Dataset(labelled(about), coordinates, data.attrs | {"particle": int(particle)})


def _particle(data: xr.Dataset, particle: int) -> xr.Dataset:
    numbers = data["particle"].to_numpy()
    allowed = f"one of {numbers[0]} to {numbers[-1]}" if numbers.size else "one that `data` has"
    try:
        at = np.flatnonzero(numbers == whole("particle", particle, 0))
    except ParameterError:
        at = np.empty(0, dtype=np.int64)
    if at.size != 1:
        raise ParameterError(wrong("particle", particle, allowed))
    return data.isel(particle=int(at[0]))


_Turns = Callable[[dict[str, FloatArray], FloatArray], dict[str, FloatArray]]
"""The rotation after some times, from its beginnings."""


def _check(data: xr.Dataset) -> None:
    """Refuse states that are no numbers, or not those of all impacts from the release on."""
    there = getattr(data, "variables", ())
    given = {name: needed for name, needed in _RELEASED.items() if name in there}
    own = _WITHOUT if "attitude" in there else _WITH_AXIS
    variables("data", data, 'restitution.simulate(..., record="state")', _NEEDED | own | given)
    check_successive("data", data, start=0)
    check_frame("data", data)
    allowed = "three finite numbers"
    velocity = data.attrs.get("release_velocity")
    if reals("data.release_velocity", velocity, allowed).shape != (3,):
        raise ParameterError(wrong("data.release_velocity", velocity, allowed))


def _symmetric(data: xr.Dataset) -> _Turns:
    across = attribute("data", data, "transverse_inertia", "a finite number > 0", lambda j: 0.0 < j < np.inf)
    most = 2.0 * across * (1.0 + 1e-9)  # of any body, with rounding
    allowed = f"a finite number in (0, 2 transverse_inertia = {2.0 * across:g}]"
    slender = 1.0 - attribute("data", data, "axial_inertia", allowed, lambda j: 0.0 < j <= most) / across

    def turns(begin: dict[str, FloatArray], elapsed: FloatArray) -> dict[str, FloatArray]:
        axis, spin = begin["axis"], begin["angular_velocity"]
        along = np.sum(spin * axis, axis=1, keepdims=True)
        precession = spin - slender * along * axis  # Λ/J'
        turned = _turned(axis, precession * elapsed)
        return {"axis": turned, "angular_velocity": precession + slender * along * turned}

    return turns


def _top(data: xr.Dataset) -> _Turns:
    moments, axes = (
        reals(f"data.{name}", data.attrs.get(name), f"{count} finite numbers", dimensions=(1,)).tolist()
        for name, count in (("principal_moments", 3), ("principal_axes", 4))
    )

    def turns(begin: dict[str, FloatArray], elapsed: FloatArray) -> dict[str, FloatArray]:
        attitude, spin = begin["attitude"], begin["angular_velocity"]
        angle = np.linalg.norm(spin, axis=1) * elapsed[:, 0]
        if not (angle <= _core.MOST_RADIANS).all():
            text = (
                f": turns by {np.nanmax(angle, initial=0.0):g} rad in a flight; must be the states of a run"
            )
            raise ParameterError(Problem("data", text))
        try:
            turned, later = _core.turned(moments, axes, attitude, spin, elapsed[:, 0].copy())
        except ValueError:
            text = f" = {moments}: must be the moments of inertia of a body"
            raise ParameterError(Problem("data.principal_moments", text)) from None
        return {"attitude": turned, "angular_velocity": later}

    return turns


def times_of(time: FloatArray) -> FloatArray:
    """Return the times of a particle's impacts: NaN comes only after the last one."""
    happened = time[: np.count_nonzero(~np.isnan(time))]
    allowed = "a finite time >= 0, not before the impact before it"
    check_each("data.time", happened, np.isfinite(happened), allowed)
    check_each("data.time", happened, np.diff(happened, prepend=0.0) >= 0.0, allowed)
    return happened


def _gravity(gravity: float, incline: float) -> tuple[float, float, float]:
    """Return the acceleration of free flight in the frame of the plane."""
    return gravity * float(np.sin(incline)), 0.0, -gravity * float(np.cos(incline))


def _begin(one: xr.Dataset, impacts: int) -> dict[str, FloatArray]:
    """Return the states from which the flights begin: the release, then the state after each impact."""
    released = {
        "time": 0.0,
        "position": [0.0, 0.0, float(one["release_height"])],
        "velocity": one.attrs["release_velocity"],
        "angular_velocity": one["release_spin"].to_numpy() if "release_spin" in one else np.zeros(3),
    }
    if "attitude" in one:
        released["attitude"] = one["release_attitude"].to_numpy()
    else:
        angle = float(one["release_angle"])
        azimuth = float(one["release_azimuth"]) if "release_azimuth" in one else 0.0
        level = np.sin(angle)
        released["axis"] = [level * np.cos(azimuth), level * np.sin(azimuth), np.cos(angle)]
    after = {"velocity": "velocity_after", "angular_velocity": "angular_velocity_after"}
    states = one.transpose("impact", ...)
    return {
        name: np.concatenate([[value], states[after.get(name, name)].to_numpy()[:impacts]])
        for name, value in released.items()
    }


def _turned(vectors: FloatArray, rotations: FloatArray) -> FloatArray:
    """Turn vectors about rotation vectors, by their lengths in rad."""
    angle = np.linalg.norm(rotations, axis=1, keepdims=True)
    about = rotations / np.where(angle > 0.0, angle, 1.0)
    along = about * np.sum(about * vectors, axis=1, keepdims=True)
    turned: FloatArray = along + np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(about, vectors)
    return turned
