"""The motion between impacts in closed form: where a particle is at any time, from its recorded states."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from restitution._arrays import FloatArray, check_each, reals, whole
from restitution._parameters import ParameterError, Problem, wrong
from restitution._recorded import first_impact_of
from restitution._units import check_variables

if TYPE_CHECKING:
    import xarray as xr

_NEEDED = {
    "time": ("impact",),
    "position": ("impact", "component"),
    "axis": ("impact", "component"),
    "velocity_after": ("impact", "component"),
    "angular_velocity_after": ("impact", "component"),
    "release_angle": (),
}
"""What is needed of the recorded states, and its dimensions besides that of the particle."""
_SETTINGS = ("gravity", "incline", "release_velocity", "axial_inertia", "transverse_inertia")
_RELEASED = ("release_height", "release_azimuth", "release_spin")
"""Of each particle, or of all as attributes, or neither where it is 0."""
_ABOUT = {
    "position": ("position of the centre of mass; the release is over the origin, z = 0 the plane", "m"),
    "velocity": ("velocity of the centre of mass", "m s-1"),
    "axis": ("unit vector of the symmetry axis, from sphere 2 to sphere 1", "1"),
    "angular_velocity": ("angular velocity", "rad s-1"),
}


def with_positions(data: xr.Dataset) -> xr.Dataset:
    """Make positions of the recorded heights and velocities: in flight gravity alone acts (5)."""
    time, after = data["time"].to_numpy(), data["velocity_after"].to_numpy()
    position = np.empty(after.shape)
    position[..., 2] = data["height"].to_numpy()
    duration = np.diff(time, axis=1, prepend=0.0)
    pull = _gravity(data)
    for i in range(2):
        start = np.empty(time.shape)
        start[:, :1], start[:, 1:] = data.attrs["release_velocity"][i], after[:, :-1, i]
        np.cumsum(duration * (start + 0.5 * pull[i] * duration), axis=1, out=position[..., i])
    about, unit = _ABOUT["position"]
    attrs = {"long_name": f"{about}; at the impact", "units": unit}
    return data.drop_vars("height").assign(position=(("particle", "impact", "component"), position, attrs))


def trajectory(data: xr.Dataset, particle: int, times: npt.ArrayLike) -> xr.Dataset:
    """Give the exact motion of a particle at any times, from its release to its last recorded impact.

    Between impacts the centre of mass moves on a parabola, and a free body of revolution turns about its
    angular momentum **Λ** at the constant rate Λ/J', its moment of inertia across the axis being J'; the
    formulas are closed, no step is taken. At the time of an impact it is the motion after it.

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
        ``impacts`` up to then.

    Raises
    ------
    ValueError
        If there are no states, or such as are no numbers, no such particle, or times before the release or
        after the last impact.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.Coulomb(normal=0.9, friction=0.2)
    >>> data = rs.simulate(body, law, particles=5, impacts=20, spin=(0.0, 30.0, 10.0), record="state")
    >>> path = rs.trajectory(data, 3, [0.0, 0.1, 0.2])
    >>> path.position.shape, path.impacts.values.tolist()
    ((3, 3), [0, 0, 1])
    """
    import xarray as xr

    instead = 'from restitution.simulate(..., record="state")'
    if not isinstance(data, xr.Dataset):
        raise ParameterError(wrong("data", data, instead))
    lacking = [name for name in _NEEDED if name not in data]
    lacking = lacking or [name for name in _SETTINGS if name not in data.attrs]
    if lacking:
        raise ParameterError(Problem("data", f" lacks {', '.join(lacking)}: must be {instead}"))
    check_variables("data", data, *_NEEDED)
    for name, dimensions in _NEEDED.items():
        if set(data[name].dims) != {"particle", *dimensions}:
            text = f" has dimensions ({', '.join(map(str, data[name].dims))}): must be {instead}, whole"
            raise ParameterError(Problem(f"data.{name}", text))
    if first_impact_of("data", data) != 0 or data.sizes["component"] != 3:
        raise ParameterError(
            Problem("data", f": a part of the impacts or components: must be {instead}, whole")
        )
    if "release_height" not in data and "release_height" not in data.attrs:
        raise ParameterError(Problem("data", f" lacks release_height: must be {instead}"))
    one = _particle(data.transpose(..., "impact", "component"), particle)
    _check(one)
    asked = reals("times", times, "times in s, one or several", unit="s", dimensions=(0, 1), finite=False)
    when = np.atleast_1d(asked)
    recorded = one["time"].to_numpy()
    happened = recorded[~np.isnan(recorded)]
    last = float(happened[-1]) if happened.size else 0.0
    allowed = f"in [0, {last!r}] s, from the release to the last recorded impact of particle {particle}"
    check_each("times", when, (when >= 0.0) & (when <= last), allowed)

    flight = np.searchsorted(happened, when, side="right")
    begin = _begin(one, happened.size)
    elapsed = (when - begin["time"][flight])[:, None]
    position, velocity, axis, spin = (
        begin[name][flight] for name in ("position", "velocity", "axis", "angular_velocity")
    )
    pull = np.array(_gravity(data))
    along = np.sum(spin * axis, axis=1, keepdims=True)
    slender = 1.0 - float(data.attrs["axial_inertia"]) / float(data.attrs["transverse_inertia"])
    precession = spin - slender * along * axis  # Λ/J'
    turned = _turned(axis, precession * elapsed)
    found = {
        "position": position + elapsed * (velocity + 0.5 * elapsed * pull),
        "velocity": velocity + elapsed * pull,
        "axis": turned,
        "angular_velocity": precession + slender * along * turned,
    }
    variables: dict[str, Any] = {
        name: (("time", "component"), values, {"long_name": _ABOUT[name][0], "units": _ABOUT[name][1]})
        for name, values in found.items()
    }
    variables["impacts"] = ("time", flight, {"long_name": "number of impacts up to then"})
    coordinates = {
        "time": ("time", when, {"long_name": "time since release", "units": "s"}),
        "component": data["component"],
    }
    return xr.Dataset(variables, coordinates, data.attrs | {"particle": int(particle)})


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


def _check(one: xr.Dataset) -> None:
    """Refuse states and settings that are no numbers."""
    check_variables("data", one, *_NEEDED, *_RELEASED)
    for name in (*_NEEDED, *_RELEASED):
        if name in one:
            reals(f"data.{name}", one[name].to_numpy(), "real numbers, NaN for none", finite=False)
    for name in _SETTINGS + _RELEASED:
        if name in one.attrs and not (name in _RELEASED and name in one):
            lengths = (3,) if name == "release_velocity" else ()
            allowed = "three finite numbers" if lengths else "a finite number"
            if reals(f"data.{name}", one.attrs[name], allowed).shape != lengths:
                raise ParameterError(wrong(f"data.{name}", one.attrs[name], allowed))
    if not one.attrs["transverse_inertia"] > 0.0:
        raise ParameterError(
            wrong("data.transverse_inertia", one.attrs["transverse_inertia"], "a finite number > 0")
        )


def _gravity(data: xr.Dataset) -> tuple[float, float, float]:
    gravity, incline = float(data.attrs["gravity"]), float(data.attrs["incline"])
    return gravity * float(np.sin(incline)), 0.0, -gravity * float(np.cos(incline))


def _begin(one: xr.Dataset, impacts: int) -> dict[str, FloatArray]:
    """Give the states from which the flights begin: the release, then what each impact left."""
    angle = float(one["release_angle"])
    azimuth = float(one["release_azimuth"]) if "release_azimuth" in one else 0.0
    level = np.sin(angle)
    height = float(one["release_height"] if "release_height" in one else one.attrs["release_height"])
    released = {
        "time": 0.0,
        "position": [0.0, 0.0, height],
        "velocity": one.attrs["release_velocity"],
        "axis": [level * np.cos(azimuth), level * np.sin(azimuth), np.cos(angle)],
        "angular_velocity": one["release_spin"].to_numpy() if "release_spin" in one else np.zeros(3),
    }
    after = {"velocity": "velocity_after", "angular_velocity": "angular_velocity_after"}
    return {
        name: np.concatenate([[value], one[after.get(name, name)].to_numpy()[:impacts]])
        for name, value in released.items()
    }


def _turned(vectors: FloatArray, rotations: FloatArray) -> FloatArray:
    """Turn vectors about rotation vectors, by their lengths in rad."""
    angle = np.linalg.norm(rotations, axis=1, keepdims=True)
    about = rotations / np.where(angle > 0.0, angle, 1.0)
    along = about * np.sum(about * vectors, axis=1, keepdims=True)
    turned: FloatArray = along + np.cos(angle) * (vectors - along) + np.sin(angle) * np.cross(about, vectors)
    return turned
