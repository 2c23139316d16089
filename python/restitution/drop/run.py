"""The parameters of a run: one validation for `simulate`, `statistics` and the TOML file."""

import inspect
import math
import re
import warnings
from collections.abc import Callable, Mapping
from textwrap import indent
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, TypedDict, TypeVar

import numpy as np
import numpy.typing as npt
from pydantic import ConfigDict, Field, InstanceOf, model_validator

from restitution import _core
from restitution._internal import text as _text
from restitution._internal.arrays import FloatArray, check_each
from restitution._internal.parameters import (
    Allowed,
    Number,
    ParameterError,
    Parameters,
    Problem,
    Whole,
    shown,
    wrong,
)
from restitution.bodies import ANY_BODIES, AnyBody, Body, Clump, RigidBody
from restitution.drop.release import (
    HeightOfRun,
    OrientationOfRun,
    RandomHeight,
    RandomSpin,
    SpinOfRun,
    VelocityOfRun,
)
from restitution.laws import LAWS, CollisionLaw, Law

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation


F = TypeVar("F", bound=Callable[..., Any])

_NONE = ("spin", "release_velocity")
"""Parameters for whose default, a vector of zeros, None may be given."""
_BEYOND = 1e10
"""Heights and the like, over those of the body: beyond, 16 digits do not resolve its surface."""


class Surroundings(TypedDict, total=False):
    """Keyword arguments that say how particles are released and what acts on them, with their types."""

    gravity: float
    orientation: "Literal['uniform-angle', 'isotropic'] | npt.ArrayLike | Rotation"
    spin: "npt.ArrayLike | RandomSpin | None"
    release_velocity: "npt.ArrayLike | None"
    incline: float
    seed: int


class RunArguments(Surroundings, total=False):
    """All keyword arguments of a run, with their types."""

    particles: int
    impacts: int
    release_height: "float | RandomHeight"
    minimum_speed: float


def takes_run(kind: type[Surroundings]) -> Callable[[F], F]:
    """Write the parameters of a run into the signature and the docstring of a function that passes them on.

    The function takes them as its last argument, ``**run: Unpack[kind]``. Their defaults are those of `Run`,
    and their text, which replaces the line ``%(run)s``, is that of its docstring.
    """
    types = {name: getattr(of, "__forward_arg__", of) for name, of in kind.__annotations__.items()}

    def decorate(function: F) -> F:
        signature = inspect.signature(function)
        own = dict(signature.parameters)
        del own["run"]
        first = {name: own.pop(name) for name in ("cls", "body", "law") if name in own}
        of_run, keyword = {}, inspect.Parameter.KEYWORD_ONLY
        for name, field in Run.model_fields.items():
            if name in own:
                of_run[name] = own.pop(name)
            elif name in types:
                default = None if name in _NONE else field.default
                of_run[name] = inspect.Parameter(name, keyword, default=default, annotation=types[name])
        changed = signature.replace(parameters=[*first.values(), *of_run.values(), *own.values()])
        function.__signature__ = changed  # type: ignore[attr-defined]
        if function.__doc__ and Run.__doc__:  # None under python -OO
            entries = _text.entries(Run.__doc__).items()
            text = "\n".join(entry for name, entry in entries if name in types)
            run = re.compile(r"^( *)%\(run\)s$", re.MULTILINE)
            function.__doc__ = run.sub(lambda line: indent(text, line[1]), function.__doc__)
        return function

    return decorate


class Run(Parameters):
    """The parameters of a run, checked.

    Parameters
    ----------
    body, law
        The body and the collision law.
    particles : int
        Number of particles that are dropped, each by itself; > 0.
    impacts : int
        The most impacts that a particle may have, > 0; it then ends.
    release_height : float or RandomHeight
        Distance of the centre of mass from the plane at release, in m, the same for all or drawn at random;
        no part may be below the plane.
    gravity : float
        Acceleration of gravity in m/s², > 0.
    orientation : {"uniform-angle", "isotropic"} or array of float
        The angle θ between symmetry axis and plane normal at release: uniform in [0, π) (above Eq. 18),
        isotropic, or given in rad, shape (particles,). Its azimuth φ is uniform in [0, 2π), or given beside
        θ, shape (particles, 2). Of a rigid body of any shape all rotations are alike, "isotropic", which is
        then the default, or each particle has a quaternion (w, x, y, z), shape (particles, 4), that turns the
        axes of the body to those of space.
    spin : array of float, shape (3,) or (particles, 3), or RandomSpin, optional
        Angular velocity ω at release, in rad/s: the same for all, one each, or drawn at random.
    release_velocity : array of float, shape (3,), optional
        Velocity of the centre of mass at release, in m/s. It may point up or down.
    incline : float
        Angle α by which the plane is inclined, in rad, in [0, π/2): gravity is g (sin α, 0, -cos α). Every
        vector is in the frame of the plane: z along its normal, x down the slope.
    minimum_speed : float
        A particle ends when √(2 E_kin/m) after an impact falls below this, in m/s. 0 never does.
    seed : int
        Seed of the random numbers, in [0, 2⁶⁴). The same seed gives the same bits with any number of threads.
    """

    body: Annotated[InstanceOf[AnyBody], Allowed(ANY_BODIES)]
    law: Annotated[InstanceOf[CollisionLaw], Allowed(f"{LAWS}, or a CustomLaw")]
    particles: Annotated[Whole, Field(ge=1, lt=2**40, description="number of particles")] = 1000
    impacts: Annotated[Whole, Field(ge=1, lt=2**40, description="most impacts of a particle")] = 400
    release_height: Annotated[HeightOfRun, Field(description="m")] = 0.06
    gravity: Annotated[Number, Field(gt=0, description="m/s²")] = 9.81
    orientation: OrientationOfRun = "uniform-angle"
    spin: Annotated[SpinOfRun, Field(description="rad/s")] = (0.0, 0.0, 0.0)
    release_velocity: Annotated[VelocityOfRun, Field(description="m/s")] = (0.0, 0.0, 0.0)
    incline: Annotated[Number, Field(ge=0, lt=math.pi / 2, description="rad")] = 0.0
    minimum_speed: Annotated[Number, Field(ge=0, description="m/s; 0 never stops a particle")] = 0.0
    seed: Annotated[Whole, Field(ge=0, lt=2**64)] = 1

    model_config: ClassVar[ConfigDict] = ConfigDict(validate_default=True)

    @classmethod
    def called(cls, function: str, body: AnyBody, law: CollisionLaw, arguments: Mapping[str, Any]) -> Self:
        """Take the parameters of a run from the keyword arguments of a function."""
        for name in arguments:
            if name not in RunArguments.__annotations__:
                raise TypeError(f"{function}() got an unexpected keyword argument {name!r}")
        run = cls(body=body, law=law, **arguments)
        run.warn_of_units()
        return run

    @model_validator(mode="before")
    @classmethod
    def _isotropic_in_any_shape(cls, given: Any) -> Any:
        if isinstance(given, dict) and isinstance(given.get("body"), RigidBody):
            return {"orientation": "isotropic"} | given
        return given

    @model_validator(mode="after")
    def _oriented_as_the_body_can_be(self) -> "Run":
        given, axis = self.orientations, isinstance(self.body, Body)
        quaternions = given is not None and given.ndim == 2 and given.shape[1] == 4
        if quaternions and axis:
            allowed = "angles, for a body of revolution"
            raise ParameterError(wrong("orientation", self.orientation, allowed))
        if not axis and not quaternions and (given is not None or self.orientation != "isotropic"):
            allowed = (
                "'isotropic', a Rotation or quaternions (w, x, y, z), shape (particles, 4), "
                f"for a {type(self.body).__name__}"
            )
            raise ParameterError(wrong("orientation", self.orientation, allowed))
        if not axis and isinstance(self.spin, RandomSpin) and self.spin.axis == "across":
            allowed = "'isotropic', 'horizontal' or 'thermal', for a rigid body of any shape"
            raise ParameterError(wrong("axis", "across", allowed))
        return self

    @model_validator(mode="after")
    def _one_for_each_particle(self) -> "Run":
        parts = "angles" if isinstance(self.body, Body) else "quaternions"
        for name, given, what in (("orientation", self.orientations, parts), ("spin", self.spins, "vectors")):
            if given is not None and len(given) != self.particles:
                text = f" has {len(given)} {what}: must have one for each of particles = {self.particles}"
                raise ParameterError(Problem(name, text))
        return self

    @model_validator(mode="after")
    def _nothing_below_the_plane(self) -> "Run":
        solid: Any = self.body.compiled
        least = self.heights[0]
        placed = self.orientations if self.angles is None else np.cos(self.angles)
        lowest = solid.farthest()
        if placed is not None and not _core.clears(least, lowest):
            lowest = solid.lowest(placed)
        if not _core.clears(least, lowest):
            allowed = f"at least {lowest!r} m, or a part of the body would reach below the plane"
            allowed += "; are its lengths in m?" if lowest > 1.0 else ""
            raise ParameterError(wrong("release_height", self.release_height, allowed))
        return self

    def warn_of_units(self) -> None:
        """Warn of millimetres and degrees: bodies above 1 m or in pieces, falls above 10 m, angles above 2π.

        Of what a user gave: the package itself also runs bodies of unit size.
        """
        units = []
        for name, field in type(self.body).model_fields.items():
            length = getattr(self.body, name)
            in_metres = (field.description or "").split(";")[0] == "m" and length is not None
            if in_metres and name != "heights" and np.max(length) > 1.0:  # heights are below a radius
                units.append(f"{name} = {shown(length)} is taken in metres")
        if isinstance(self.body, Clump) and (apart := self.body.apart):
            units.append(apart)
        if self.heights[1] > 10.0:
            units.append(f"release_height = {self.heights[1]:g} is taken in metres")
        if self.angles is not None and (largest := float(np.abs(self.angles).max())) > 2.0 * math.pi:
            units.append(f"orientation, up to {largest:g}, is taken in radians")
        if units:
            warnings.warn(f"{'; '.join(units)}: is that meant?", UserWarning, stacklevel=4)

    @model_validator(mode="after")
    def _within_the_digits(self) -> "Run":
        """Refuse heights, speeds and spins so large that a double has no digits left for the body."""
        least = self.body.lowest_position
        of = f"{_BEYOND:g} times the least height of the centre of mass over the plane"
        _check_within("release_height", self.heights[1], _BEYOND * least, "m", of)
        falling = self.gravity * math.cos(self.incline)
        if self.incline > math.pi / 2 - 1.0 / _BEYOND:
            allowed = (
                f"at most pi/2 - {1.0 / _BEYOND:g}: a double has no digits left for gravity towards the plane"
            )
            raise ParameterError(wrong("incline", self.incline, allowed))
        fastest = math.sqrt(_BEYOND) * math.sqrt(falling) * math.sqrt(least)
        of = f"{math.sqrt(_BEYOND):g} times √(g h), h being the least height of the centre of mass"
        _check_within("release_velocity", self.release_velocity, fastest, "m/s in magnitude", of)
        most = math.sqrt(_BEYOND) * math.sqrt(falling) / math.sqrt(self.body.compiled.farthest())
        spins = self.spin.rates[1] if isinstance(self.spin, RandomSpin) else self.spin
        of = f"{math.sqrt(_BEYOND):g} times √(g/r), r being the radius of the body about its centre of mass"
        _check_within("spin", spins, most, "rad/s in magnitude", of)
        return self

    @property
    def standard_law(self) -> Law:
        """The law, where it must be one of the package, which has a normal coefficient."""
        if not isinstance(self.law, Law):
            raise ParameterError(wrong("law", self.law, LAWS))
        return self.law

    @property
    def heights(self) -> tuple[float, float]:
        """Least and largest height at release, in m."""
        height = self.release_height
        return (height.lowest, height.highest) if isinstance(height, RandomHeight) else (height, height)

    @property
    def angles(self) -> FloatArray | None:
        """The angles θ at release where they were given, in rad, shape (particles,)."""
        given = self.orientations
        if given is None or isinstance(self.body, RigidBody):
            return None
        return given if given.ndim == 1 else given[:, 0]

    @property
    def orientations(self) -> FloatArray | None:
        """The angles or quaternions at release where they were given."""
        return None if isinstance(self.orientation, str) else self.orientation

    @property
    def spins(self) -> FloatArray | None:
        """The angular velocities where each particle has its own, in rad/s, shape (particles, 3)."""
        return self.spin if isinstance(self.spin, np.ndarray) else None

    def of(self, rows: npt.NDArray[np.int64]) -> Self:
        """Return the run of these of its particles; what is drawn for them depends on their new numbers."""
        changed: dict[str, Any] = {"particles": rows.size}
        if self.orientations is not None:
            changed["orientation"] = self.orientation[rows]
        if self.spins is not None:
            changed["spin"] = self.spins[rows]
        return self.model_copy(update=changed)

    def fall_speed(self, drop: float) -> float:
        """Return the normal velocity in m/s after the centre of mass has come nearer by `drop`, in m."""
        fall = 2.0 * self.gravity * math.cos(self.incline) * drop
        return math.sqrt(fall + self.release_velocity[2] ** 2)

    def parameters(self) -> dict[str, Any]:
        """Name every parameter as the core does, compiled where the core knows it as an object of its own."""
        found = {name: getattr(self, name) for name in type(self).model_fields}
        for name in ("release_height", "spin"):
            if isinstance(found[name], RandomHeight | RandomSpin):
                found[name] = found[name].parameters()
        return found | {"body": self.body.compiled, "law": self.law.compiled, "settled": 0.0}

    def attributes(self) -> dict[str, Any]:
        """Return every parameter under its own name, as plain values that a netCDF file can hold."""
        written: dict[str, dict[str, Any]] = {
            "body": {"body": type(self.body).__name__, **self.body.attributes()},
            "law": {"law": type(self.law).__name__, **self.law.attributes()},
            "orientation": {"orientation": self.orientation if self.orientations is None else "given"},
            "spin": {"spin": self.spin if self.spins is None else "given"},
        }
        if isinstance(self.release_height, RandomHeight):
            written["release_height"] = {"release_height": "random", "release_height_range": self.heights}
        if isinstance(self.spin, RandomSpin):
            rates, axis = self.spin.rates, self.spin.axis
            written["spin"] = {"spin": "random", "spin_rate": rates, "spin_axis": axis}
        names = type(self).model_fields
        parts = [written.get(name, {name: getattr(self, name)}) for name in names]
        return {key: value for part in parts for key, value in part.items()}


def _check_within(name: str, values: Any, most: float, unit: str, of: str) -> None:
    """Name the first number whose magnitude is too large, with its place in a vector or a table."""
    numbers = np.asarray(values)
    allowed = f"at most {most:.6g} {unit}, {of}; beyond, a double has no digits left for the body"
    check_each(name, numbers, np.abs(numbers) <= most, allowed)
