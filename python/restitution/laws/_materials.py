"""Materials: the normal coefficient of restitution as a function of the contact speed, and its scatter."""

import math
from abc import abstractmethod
from collections.abc import Callable
from functools import cached_property
from typing import Annotated, Any, ClassVar, Self

import numpy as np
import numpy.typing as npt
from pydantic import (
    BeforeValidator,
    Field,
    InstanceOf,
    PlainSerializer,
    TypeAdapter,
    ValidationError,
    model_validator,
)

from restitution import _core
from restitution._internal.arrays import check_each, real, reals
from restitution._internal.described import Described, one_of
from restitution._internal.parameters import Allowed, Number, ParameterError, Problem, wrong
from restitution._internal.resources import check_room

Floats = npt.NDArray[np.float64]


class Material(Described):
    """A normal coefficient of restitution ε_n that depends on the speed; call it to see it."""

    def __call__(self, speed: "npt.ArrayLike") -> "Floats":
        """Return ε_n at normal contact speeds.

        Parameters
        ----------
        speed : array_like
            In m/s, of any shape. Of a velocity, such as the recorded impact velocities, some of which are
            negative, the magnitude counts.

        Returns
        -------
        ndarray
            ε_n, of the shape of `speed`; nan for nan, and the limit for an infinite speed.
        """
        v = np.abs(reals("speed", speed, "real numbers (m/s), or nan", unit="m s-1", finite=False))
        found = self.compiled.at(v.ravel()).reshape(v.shape)
        return np.where(np.isnan(v), np.nan, np.where(np.isinf(v), self._limit, found))

    @property
    @abstractmethod
    def _limit(self) -> float:
        """Give the limit of ε_n at infinite speed, where formulas are quotients of infinities."""

    def formula(self, squared: Any, among: float) -> Any:
        """Return ε_n at v², complex or a disc, by the formula that holds about the real speed `among`.

        For real speeds this is what the core computes; between its kinks it continues into the complex plane,
        where the first impact from rest is integrated.
        """
        raise ParameterError(wrong("law.normal", self, "a material with a formula of the speed"))

    @property
    def kinks(self) -> tuple[float, ...]:
        """Speeds in m/s at which the formula changes."""
        return ()

    @cached_property
    def compiled(self) -> _core.Material:
        """The coefficient as the core knows it, made and checked once; every ε_n(v) is the core's."""
        return _core.material(type(self).__name__, self._arguments())

    def attributes(self) -> dict[str, Any]:
        """Return name and parameters as those of a law, after `normal`, as plain values."""
        parts = self.model_dump()
        for value in self._fields().values():
            if isinstance(value, Material):
                parts |= value.attributes()
        return {"normal": type(self).__name__} | {f"normal_{name}": value for name, value in parts.items()}


class Viscoelastic(Material):
    """A viscoelastic sphere on a rigid plane (Müller and Pöschel, Phys. Rev. E 84, 021302 (2011)).

    The force at a compression ξ is (4/3)√R Y/(1 - ν²) (ξ^{3/2} + (3/2) A ξ^{1/2} dξ/dt), and the contact ends
    where it would turn to attraction. ε_n is the Padé approximant [3/6] in v* = β^{1/2} v^{1/10}, with
    β = (3/2) A k^{2/5} and k = (4/3)√R Y/((1 - ν²)m); 1 at v = 0, and falling with the speed.

    Parameters
    ----------
    young_modulus : float
        Young's modulus Y in Pa, > 0.
    poisson_ratio : float
        Poisson's ratio ν, in (-1, 0.5].
    dissipation : float
        The dissipative constant A of the viscous stress in s, >= 0.
    density : float
        Density of the sphere in kg/m³, > 0; its mass is m = (4/3)πR³ times this.
    radius : float
        Radius R of the sphere in m, > 0.

    Examples
    --------
    >>> import restitution as rs
    >>> glass = rs.Viscoelastic(
    ...     young_modulus=6e10, poisson_ratio=0.22, dissipation=1e-7, density=2500.0, radius=3e-3
    ... )
    >>> law = rs.Frictionless(normal=glass)
    >>> glass([0.0, 0.1, 1.0]).round(3).tolist()
    [1.0, 0.979, 0.967]
    """

    young_modulus: Annotated[Number, Field(gt=0, description="Pa")]
    poisson_ratio: Annotated[Number, Field(gt=-1, le=0.5)]
    dissipation: Annotated[Number, Field(ge=0, description="s")]
    density: Annotated[Number, Field(gt=0, description="kg/m³")]
    radius: Annotated[Number, Field(gt=0, description="m")]

    def formula(self, squared: Any, among: float) -> Any:
        x = self.beta**0.5 * squared**0.05
        above, below = map(np.polynomial.Polynomial, _core.PADE)
        return above(x) / below(x)

    @property
    def _limit(self) -> float:
        # The numerator grows as v*³, the denominator as v*⁶; without dissipation v* is 0 at any speed.
        return 0.0 if self.dissipation > 0.0 else 1.0

    @property
    def beta(self) -> float:
        """β in (s/m)^{1/5}: the dissipation in the units that elasticity and inertia make."""
        beta = self.compiled.beta
        assert beta is not None
        return beta


class Plastic(Material):
    """Elastic-perfectly plastic spheres (Thornton, J. Appl. Mech. 64, 383 (1997)).

    ε_n = √(6√3/5) √(1 - x²/6) (x/(x + 2√(6/5 - x²/5)))^{1/4} with x = v_y/v; 1 up to v_y, and 1.185 x^{1/4}
    far beyond it.

    Parameters
    ----------
    yield_speed : float
        The speed v_y in m/s, > 0, below which the spheres stay elastic.

    Examples
    --------
    >>> import restitution as rs
    >>> law = rs.Coulomb(normal=rs.Plastic(yield_speed=0.01), friction=0.2)
    """

    yield_speed: Annotated[Number, Field(gt=0, description="m/s")]

    def formula(self, squared: Any, among: float) -> Any:
        if among <= self.yield_speed:
            return 1.0
        x = self.yield_speed / squared**0.5
        ratio = x / (x + 2.0 * (1.2 - 0.2 * (x * x)) ** 0.5)
        return (1.2 * 3.0**0.5) ** 0.5 * (1.0 - x * x / 6.0) ** 0.5 * ratio**0.25

    @property
    def kinks(self) -> tuple[float, ...]:
        return (self.yield_speed,)

    @property
    def _limit(self) -> float:
        return 0.0  # as (v_y/v)^{1/4}


_POINT = 120
"""Bytes of a point of a table on its way through the checks, which end the process where there is no room."""
_MANY_POINTS = 10_000


def _numbers(
    name: str, unit: str, good: Callable[[Floats], npt.NDArray[np.bool_]], allowed: str
) -> BeforeValidator:
    """Take a 1-D sequence of numbers in this unit, each of them good."""

    def check(value: Any) -> tuple[float, ...]:
        some = "a 1-D array of at least one number"
        array = reals(name, value, some, unit=unit, dimensions=(1,), finite=False)
        if not array.size:
            raise ParameterError(wrong(name, value, some))
        if array.size > _MANY_POINTS:
            check_room(name, _POINT * array.size)
        check_each(name, array, good(array), allowed)
        return tuple(array.tolist())

    return BeforeValidator(check)


class Tabulated(Material):
    """A coefficient as it was measured: interpolated linearly between points, constant beyond their ends.

    Parameters
    ----------
    v : array_like, shape (n,)
        Speeds in m/s: finite, >= 0, increasing; n >= 1.
    e : array_like, shape (n,)
        ε_n at these speeds, each in [0, 1].

    Examples
    --------
    >>> import restitution as rs
    >>> measured = rs.Tabulated(v=[0.1, 0.5, 1.0], e=[0.97, 0.95, 0.92])
    >>> measured([0.0, 0.3, 2.0]).tolist()
    [0.97, 0.96, 0.92]
    """

    v: Annotated[
        tuple[float, ...],
        _numbers("v", "m s-1", lambda x: (x >= 0.0) & (x < np.inf), "a finite number >= 0 (m/s)"),
        Allowed("a 1-D array of speeds in m/s"),
    ]
    e: Annotated[
        tuple[float, ...],
        _numbers("e", "1", lambda x: (x >= 0.0) & (x <= 1.0), "a real number in [0, 1]"),
        Allowed("a 1-D array of numbers in [0, 1]"),
    ]

    @model_validator(mode="after")
    def _is_possible(self) -> Self:
        for i in range(1, len(self.v)):
            if self.v[i] <= self.v[i - 1]:
                allowed = f"greater than v[{i - 1}] = {self.v[i - 1]}"
                raise ParameterError(wrong(f"v[{i}]", self.v[i], allowed))
        if len(self.e) != len(self.v):
            text = f": {len(self.v)} speeds and {len(self.e)} coefficients; must match"
            raise ParameterError(Problem("v, e", text))
        return self

    @classmethod
    def from_function(
        cls, function: Callable[[float], float], *, fastest: float = 100.0, tolerance: float = 1e-6
    ) -> Self:
        """Tabulate a function of the speed, as densely as linear interpolation needs.

        Every interval is halved until the function is within the tolerance of the straight line at a quarter,
        a half and three quarters of it. A jump is placed to within one part in 10⁹ of its speed.

        Parameters
        ----------
        function : callable
            ε_n, in [0, 1], of one speed in m/s. It is called now and never again: the table is what is
            compared, copied, pickled and written to files.
        fastest : float
            Speed in m/s up to which the function is tabulated; beyond it ε_n stays as it is there.
        tolerance : float
            Largest error of ε_n, in [1e-12, 0.1].

        Raises
        ------
        ValueError
            If the function gives something else than a number in [0, 1] at a speed, or needs more than
            100 000 points.

        Examples
        --------
        >>> import restitution as rs
        >>> measured = rs.Tabulated.from_function(lambda v: 0.97 * (1.0 + v / 3.0) ** -0.25)
        >>> round(float(measured(0.5)), 6), len(measured.v)
        (0.93333, 810)
        """
        return cls(**_points("function", function, fastest, tolerance))

    def _arguments(self) -> list[Any]:
        return [np.asarray(self.v, dtype=float), np.asarray(self.e, dtype=float)]

    def formula(self, squared: Any, among: float) -> Any:
        i = int(np.searchsorted(self.v, among))
        if i in (0, len(self.v)):
            return self.e[max(i - 1, 0)]
        slope = (self.e[i] - self.e[i - 1]) / (self.v[i] - self.v[i - 1])
        return self.e[i - 1] + slope * (squared**0.5 - self.v[i - 1])

    @property
    def kinks(self) -> tuple[float, ...]:
        return self.v

    @property
    def _limit(self) -> float:
        return self.e[-1]


_STEADY = [entry for entry in _core.MATERIALS if entry["name"] != "Scattered"]
NORMAL, STEADY = (
    f"a real number in [0, 1], {one_of(table)}, or a function of the speed"
    for table in (_core.MATERIALS, _STEADY)
)
_number = TypeAdapter(Annotated[Number, Field(ge=0, le=1)])


def _coefficient(allowed: str) -> BeforeValidator:
    """Take a number, a material, or a function, which is tabulated; one that scatters if that is allowed."""

    def check(value: Any) -> float | Material:
        if isinstance(value, Material) and (allowed == NORMAL or not isinstance(value, Scattered)):
            return value
        if callable(value) and not isinstance(value, type | Material):
            return Tabulated(**_points("normal", value))
        try:
            return _number.validate_python(value)
        except ValidationError:
            raise ParameterError(wrong("normal", value, allowed)) from None

    return BeforeValidator(check)


def _plain(value: float | Material) -> Any:
    return value.model_dump() if isinstance(value, Material) else value


class Scattered(Material):
    """A coefficient that scatters: of ball, dust or plate, which are not the same everywhere.

    ε_n has a normal distribution about `normal`, truncated to [0, 1], and is drawn for every impact of every
    particle, independently of all others: from the seed, the number of the particle and that of the impact.
    Called with speeds, it gives what it scatters about.

    Parameters
    ----------
    normal : float, material or callable
        The coefficient about which it scatters, as for a law.
    deviation : float
        Standard deviation in [0, 1] of the normal distribution, before it is truncated.

    Examples
    --------
    >>> import restitution as rs
    >>> dusty = rs.Scattered(normal=0.93, deviation=0.01)
    >>> ball = rs.Dumbbell(radius=3e-3, separation=0.0)
    >>> run = rs.simulate(ball, rs.Frictionless(normal=dusty), particles=1000, impacts=20)
    >>> round(float(run.restitution.std()), 3)
    0.01
    """

    by_place: ClassVar[tuple[str, ...]] = ("normal", "deviation")

    normal: Annotated[
        float | InstanceOf[Material], _coefficient(STEADY), PlainSerializer(_plain), Allowed(STEADY)
    ]
    deviation: Annotated[Number, Field(ge=0, le=1)]

    @cached_property
    def compiled(self) -> _core.Material:
        normal = self.normal.compiled if isinstance(self.normal, Material) else self.normal
        return _core.scattered(normal, self.deviation)

    @property
    def _limit(self) -> float:
        return self.normal._limit if isinstance(self.normal, Material) else self.normal


NormalCoefficient = Annotated[
    float | InstanceOf[Material], _coefficient(NORMAL), PlainSerializer(_plain), Allowed(NORMAL)
]
"""ε_n: a number, a function of the speed, or one that scatters."""

_MOST_POINTS = 100_000
_NARROWEST = 1e-9
"""Of an interval, over its speed."""


def _points(
    name: str, function: Callable[[float], float], fastest: float = 100.0, tolerance: float = 1e-6
) -> dict[str, tuple[float, ...]]:
    """Return speeds, and the function there; see `Tabulated.from_function`."""
    if not callable(function):
        raise ParameterError(wrong(name, function, "a function of the speed"))
    fastest = real(
        "fastest", fastest, "a finite number > 0 (m/s)", lambda x: 0.0 < x < math.inf, unit="m s-1"
    )
    tolerance = real("tolerance", tolerance, "a number in [1e-12, 0.1]", lambda x: 1e-12 <= x <= 0.1)

    def at(speed: float) -> float:
        try:
            value = function(speed)
            number = float(value)
        except Exception as error:
            text = f" gave {type(error).__name__}: {error} at {speed!r} m/s: must give ε_n in [0, 1]"
            raise ParameterError(Problem(name, text)) from error
        if not 0.0 <= number <= 1.0:
            text = f" gave {value!r} at {speed!r} m/s: must give ε_n in [0, 1] up to {fastest!r} m/s; "
            raise ParameterError(Problem(name, text + "Tabulated.from_function takes a lower `fastest`"))
        return number

    speeds, values = [0.0], [at(0.0)]
    last = float(fastest)
    waiting = [(last, at(last))]
    while waiting:
        low, (high, above) = speeds[-1], waiting[-1]
        below, width = values[-1], high - low
        inner = [(low + share * width, share) for share in (0.25, 0.5, 0.75)]
        seen = [at(speed) for speed, _ in inner]
        off = [abs(e - below - share * (above - below)) for e, (_, share) in zip(seen, inner, strict=True)]
        narrow = width <= _NARROWEST * low or not low < inner[0][0] < inner[2][0] < high
        if max(off) > tolerance and not narrow:
            waiting.append((inner[1][0], seen[1]))
        else:
            speeds.append(high)
            values.append(above)
            waiting.pop()
        if len(speeds) > _MOST_POINTS:
            text = f" needs more than {_MOST_POINTS:,} points for {tolerance!r}: must be smoother"
            raise ParameterError(Problem(name, text + ", or have a greater tolerance"))
    return {"v": tuple(speeds), "e": tuple(values)}
