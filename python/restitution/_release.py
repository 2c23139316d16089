"""How particles are let go: the axis, spin and velocity of a run, checked."""

import math
from typing import Annotated, Any, Literal, TypeAlias, get_args

import numpy as np
import numpy.typing as npt
from pydantic import BeforeValidator

from restitution._parameters import Allowed, ParameterError, Parameters, _plain_number, wrong

Orientation = Literal["uniform-angle", "isotropic"]
Axis = Literal["isotropic", "horizontal", "across"]
FloatArray: TypeAlias = npt.NDArray[np.float64]

_ORIENTATIONS = (
    "'uniform-angle', 'isotropic' or a 1-D array of angles in rad, one per particle, "
    "or a 2-D array of their pairs (θ, φ)"
)
_SPINS = "None, (ωx, ωy, ωz) in rad/s, an array of them, one per particle, or a RandomSpin"
_VELOCITIES = "None or (vx, vy, vz), finite, in m/s"
_RATES = "a finite number >= 0, or a pair (low, high) of them with low <= high (rad/s)"
_AXES = " or ".join(f"'{axis}'" for axis in get_args(Axis))

_MOST_RADIANS = 2.0**20
"""Range of the engine's sine and cosine."""


def _array(value: Any) -> FloatArray | None:
    """Give the value as real numbers, read-only; None if it is not an array of such."""
    try:
        array = np.asarray(value)
    except ValueError:  # lists of different lengths
        return None
    if array.dtype.kind not in "iuf":
        return None
    array = np.array(array, dtype=np.float64, order="C")
    array.flags.writeable = False
    return array


def _first(name: str, array: FloatArray, good: npt.NDArray[np.bool_], allowed: str) -> None:
    """Name the first element that is not good."""
    if not good.all():
        index = tuple(int(i) for i in np.argwhere(~good)[0])
        place = ", ".join(map(str, index))
        raise ParameterError(wrong(f"{name}[{place}]", float(array[index]), allowed))


def _orientation(value: Any) -> Any:
    if isinstance(value, str) and value in get_args(Orientation):
        return value
    angles = _array(value)
    if angles is None or not (angles.ndim == 1 or (angles.ndim == 2 and angles.shape[1] == 2)):
        raise ParameterError(wrong("orientation", value, _ORIENTATIONS))
    near = np.abs(angles) <= _MOST_RADIANS
    _first("orientation", angles, near, "a finite angle in rad, at most 2**20 either way")
    return angles


def _spin(value: Any) -> Any:
    if value is None:
        value = (0.0, 0.0, 0.0)
    if isinstance(value, RandomSpin):
        return value
    spins = _array(value)
    if spins is None or spins.ndim not in (1, 2) or spins.shape[-1] != 3:
        raise ParameterError(wrong("spin", value, _SPINS))
    _first("spin", spins, np.isfinite(spins), "finite (rad/s)")
    return spins if spins.ndim == 2 else tuple(spins.tolist())


def _velocity(value: Any) -> tuple[float, ...]:
    velocity = _array((0.0, 0.0, 0.0) if value is None else value)
    if velocity is None or velocity.shape != (3,) or not np.isfinite(velocity).all():
        raise ParameterError(wrong("velocity", value, _VELOCITIES))
    return tuple(velocity.tolist())


def _rate(value: Any) -> float | tuple[float, float]:
    pair = isinstance(value, list | tuple) and len(value) == 2
    parts = [_plain_number(part) for part in (value if pair else [value])]
    rates = None if any(isinstance(part, bool) for part in parts) else _array(parts)
    if rates is None or rates.ndim != 1 or not 0.0 <= rates[0] <= rates[-1] < math.inf:
        raise ParameterError(wrong("rate", value, _RATES))
    return (float(rates[0]), float(rates[1])) if pair else float(rates[0])


class RandomSpin(Parameters):
    """An angular velocity that is drawn for each particle, to be the ``spin`` of a run.

    Parameters
    ----------
    rate : float or (float, float)
        |ω| in rad/s, finite and >= 0: the same for all, or uniform between the two.
    axis : {"isotropic", "horizontal", "across"}
        The direction of ω: all alike, all along the plane alike, or all across the body's symmetry axis
        alike, so that it tumbles. Independent of the rate.

    Examples
    --------
    >>> import restitution as rs
    >>> rs.RandomSpin(rate=(0.0, 100.0), axis="across")
    RandomSpin(rate=(0.0, 100.0), axis='across')
    """

    rate: Annotated[float | tuple[float, float], Allowed(_RATES), BeforeValidator(_rate)]
    axis: Annotated[Axis, Allowed(_AXES)] = "isotropic"

    @property
    def rates(self) -> tuple[float, float]:
        """Least and largest |ω|, in rad/s."""
        return self.rate if isinstance(self.rate, tuple) else (self.rate, self.rate)

    def parameters(self) -> dict[str, Any]:
        """Name every parameter as the core does."""
        low, high = self.rates
        return {"low": low, "high": high, "axis": self.axis}


OrientationOfRun = Annotated[Any, BeforeValidator(_orientation)]
SpinOfRun = Annotated[Any, BeforeValidator(_spin)]
VelocityOfRun = Annotated[Any, BeforeValidator(_velocity)]
