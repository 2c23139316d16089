"""The release of particles: the height, axis, spin and velocity of a run, checked."""

import math
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, get_args

import numpy as np
from pydantic import BeforeValidator, Field, TypeAdapter, ValidationError, model_validator

from restitution import _core
from restitution._internal.arrays import FloatArray, check_each, real, reals
from restitution._internal.parameters import Allowed, Number, ParameterError, Parameters, wrong
from restitution.bodies import AnyBody, Body, RigidBody

Orientation = Literal["uniform-angle", "isotropic"]
Axis = Literal["isotropic", "horizontal", "across", "thermal"]

_ORIENTATIONS = (
    "'uniform-angle', 'isotropic' or a 1-D array of angles in rad, one per particle, "
    "or a 2-D array of their pairs (θ, φ), or of quaternions (w, x, y, z), or a SciPy Rotation"
)
_LAST = (0.0, 0.0, 0.0, 1.0)
"""No rotation in the order (x, y, z, w)."""
_SPINS = "None, (ωx, ωy, ωz) in rad/s, an array of them, one per particle, or a RandomSpin"
_HEIGHTS = "a finite number > 0 (height of the centre of mass, m), or a RandomHeight"
_VELOCITIES = "None or (vx, vy, vz), finite, in m/s"
_RATES = "a finite number >= 0, or a pair (low, high) of them with low <= high (rad/s)"
_AXES = " or ".join(f"'{axis}'" for axis in get_args(Axis))
_height_of_all = TypeAdapter(Annotated[Number, Field(gt=0)])


def _array(name: str, value: Any, allowed: str, unit: str, *dimensions: int) -> FloatArray:
    """Take an array of real numbers, finite or not, and keep a read-only copy."""
    array = np.array(reals(name, value, allowed, unit=unit, dimensions=dimensions, finite=False))
    array.flags.writeable = False
    return array


def _orientation(value: Any) -> Any:
    if isinstance(value, str) and value in get_args(Orientation):
        return value
    turned = hasattr(value, "as_quat")
    if turned:
        value = np.atleast_2d(value.as_quat(scalar_first=True))
    angles = _array("orientation", value, _ORIENTATIONS, "rad", 1, 2)
    if angles.ndim == 2 and angles.shape[1] not in (2, 4):
        raise ParameterError(wrong("orientation", value, _ORIENTATIONS))
    if angles.ndim == 2 and angles.shape[1] == 4:
        if not turned and np.array_equal(np.abs(angles), np.tile(_LAST, (len(angles), 1))):
            allowed = (
                "in the order (w, x, y, z): this is half a turn about z, or else no turn in the order of "
                "SciPy; give the Rotation that is meant"
            )
            raise ParameterError(wrong("orientation", value, allowed))
        lengths = np.linalg.norm(angles, axis=1)
        possible = (lengths > 1e-100) & (lengths < 1e100)
        check_each("orientation", lengths, possible, "the finite length > 0 of a quaternion")
        return angles
    near = np.abs(angles) <= _core.MOST_RADIANS
    check_each("orientation", angles, near, "a finite angle in rad, at most 2**20 either way")
    return angles


def _height(value: Any) -> Any:
    if isinstance(value, RandomHeight):
        return value
    try:
        return _height_of_all.validate_python(value)
    except ValidationError:
        raise ParameterError(wrong("release_height", value, _HEIGHTS)) from None


def _spin(value: Any) -> Any:
    if value is None:
        value = (0.0, 0.0, 0.0)
    if isinstance(value, RandomSpin):
        return value
    spins = _array("spin", value, _SPINS, "rad s-1", 1, 2)
    if spins.shape[-1] != 3:
        raise ParameterError(wrong("spin", value, _SPINS))
    check_each("spin", spins, np.isfinite(spins), "finite (rad/s)")
    return spins if spins.ndim == 2 else tuple(spins.tolist())


def _velocity(value: Any) -> tuple[float, ...]:
    given = (0.0, 0.0, 0.0) if value is None else value
    velocity = _array("release_velocity", given, _VELOCITIES, "m s-1", 1)
    if velocity.shape != (3,) or not np.isfinite(velocity).all():
        raise ParameterError(wrong("release_velocity", value, _VELOCITIES))
    return tuple(velocity.tolist())


def _rate(value: Any) -> float | tuple[float, float]:
    rates = _array("rate", value, _RATES, "rad s-1", 0, 1)
    if rates.shape in ((), (2,)):
        low, high = np.broadcast_to(rates, 2).tolist()
        if 0.0 <= low <= high < math.inf:
            return (low, high) if rates.shape else low
    raise ParameterError(wrong("rate", value, _RATES))


class RandomHeight(Parameters):
    """A height that is drawn for each particle, to be the ``release_height`` of a run.

    Its density is (1 + cos πs)/(highest - lowest) with s from -1 at the lowest to 1 at the highest height: a
    raised cosine, `scipy.stats.cosine`, which with its slope vanishes at both ends. Particles that fall from
    one height have few separate speeds at their first impacts; here their speeds are distributed smoothly.

    Parameters
    ----------
    lowest, highest : float
        Heights of the centre of mass over the plane in m; 0 < lowest < highest.

    Examples
    --------
    >>> import restitution as rs
    >>> body, law = rs.Dumbbell(radius=3e-3, separation=3e-4), rs.Frictionless(normal=0.9)
    >>> data = rs.simulate(body, law, release_height=rs.RandomHeight(0.05, 0.07), particles=4)
    >>> bool(((data.release_height > 0.05) & (data.release_height < 0.07)).all())
    True
    """

    by_place: ClassVar[tuple[str, ...]] = ("lowest", "highest")

    lowest: Annotated[Number, Field(gt=0, description="m")]
    highest: Annotated[Number, Field(gt=0, description="m")]

    if TYPE_CHECKING:  # or type checkers would take the fields for keyword arguments

        def __init__(self, lowest: float, highest: float) -> None: ...

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if not self.lowest < self.highest:
            allowed = f"greater than lowest = {self.lowest!r} (m)"
            raise ParameterError(wrong("highest", self.highest, allowed))
        return self

    def parameters(self) -> dict[str, Any]:
        """Name every parameter as the core does."""
        return {"lowest": self.lowest, "highest": self.highest}


class RandomSpin(Parameters):
    """An angular velocity that is drawn for each particle, to be the ``spin`` of a run.

    Parameters
    ----------
    rate : float or (float, float)
        |ω| in rad/s, finite and >= 0: the same for all, or uniform between the two. Of a thermal spin one
        number, √⟨ω²⟩.
    axis : {"isotropic", "horizontal", "across", "thermal"}
        The direction of ω: isotropic, uniform in the plane, or uniform perpendicular to the symmetry axis, if
        there is one, so that the body tumbles; independent of the rate. "thermal" is Maxwell's distribution,
        exp(-E_rot/T): the components of ω along the principal axes are Gaussian, with the same mean energy
        T/2 each.
        With the principal moments of inertia J₁, J₂, J₃, ⟨ω²⟩ = T (1/J₁ + 1/J₂ + 1/J₃).

    Examples
    --------
    >>> import restitution as rs
    >>> rs.RandomSpin(rate=(0.0, 100.0), axis="across")
    RandomSpin(rate=(0.0, 100.0), axis='across')
    """

    rate: Annotated[
        float | tuple[float, float], Allowed(_RATES), BeforeValidator(_rate), Field(description="rad/s")
    ]
    axis: Annotated[Axis, Allowed(_AXES)] = "isotropic"

    @model_validator(mode="after")
    def _one_temperature(self) -> Self:
        if self.axis == "thermal" and isinstance(self.rate, tuple):
            raise ParameterError(wrong("rate", self.rate, "one number, √⟨ω²⟩ in rad/s, of a thermal spin"))
        return self

    @classmethod
    def thermal(cls, body: AnyBody, temperature: float) -> Self:
        """Return the spin of a gas: Maxwell's distribution at a temperature kT in J.

        Parameters
        ----------
        body : Dumbbell or another body
            Whose moments of inertia count.
        temperature : float
            kT in J, >= 0: twice the mean energy of each of the three parts of the rotation.

        Examples
        --------
        >>> import restitution as rs
        >>> grain = rs.Ellipsoid(semi_axes=(1e-3, 2e-3, 3e-3))
        >>> rs.RandomSpin.thermal(grain, temperature=grain.mass * 0.4**2).axis
        'thermal'
        """
        kt = real("temperature", temperature, "a finite number >= 0, in J", lambda t: 0.0 <= t < math.inf)
        if isinstance(body, Body):
            moments = [body.transverse_inertia, body.transverse_inertia, body.axial_inertia]
        elif isinstance(body, RigidBody):
            moments = body.compiled.principal_moments
        else:
            raise ParameterError(wrong("body", body, "a body"))
        return cls(rate=math.sqrt(kt * sum(1.0 / moment for moment in moments)), axis="thermal")

    @property
    def rates(self) -> tuple[float, float]:
        """Least and largest |ω|, in rad/s."""
        return self.rate if isinstance(self.rate, tuple) else (self.rate, self.rate)

    def parameters(self) -> dict[str, Any]:
        """Name every parameter as the core does."""
        low, high = self.rates
        if self.axis == "thermal":
            return {"thermal": low}
        return {"low": low, "high": high, "axis": self.axis}


HeightOfRun = Annotated[Any, BeforeValidator(_height)]
OrientationOfRun = Annotated[Any, BeforeValidator(_orientation)]
SpinOfRun = Annotated[Any, BeforeValidator(_spin)]
VelocityOfRun = Annotated[Any, BeforeValidator(_velocity)]
