"""Materials: the normal coefficient of restitution as a function of the normal contact speed."""

from abc import abstractmethod
from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt
from pydantic import BeforeValidator, Field, model_validator

from restitution import _core
from restitution._parameters import Allowed, Number, ParameterError, Parameters, Problem, wrong

Floats = npt.NDArray[np.float64]

PADE_ABOVE = np.polynomial.Polynomial([1.0, 1.07232, 0.574198, 0.141552])
PADE_BELOW = np.polynomial.Polynomial([1.0, 1.07232, 1.72765, 1.37842, 1.19449, 0.467273, 0.235585])
"""Numerator and denominator of a viscoelastic sphere's ε^n, in powers of v*."""


class Material(Parameters):
    """A normal coefficient of restitution ε^n that depends on the speed; call it to see it."""

    def __call__(self, speed: npt.ArrayLike) -> Floats:
        """ε^n at normal contact speeds.

        Parameters
        ----------
        speed : array_like
            In m/s, >= 0, of any shape.

        Returns
        -------
        ndarray
            ε^n, of the shape of `speed`; nan for nan.
        """
        v = np.asarray(speed, dtype=np.float64)
        if np.any(v < 0.0):
            raise ParameterError(wrong("speed", speed, ">= 0 (m/s)"))
        return self._coefficient(v)

    @abstractmethod
    def _coefficient(self, speed: Floats) -> Floats:
        """ε^n at speeds >= 0, or nan."""


class Viscoelastic(Material):
    """A viscoelastic sphere on a rigid plane (Müller and Pöschel, Phys. Rev. E 84, 021302 (2011)).

    The force at a compression ξ is (4/3)√R Y/(1 - ν²) (ξ^{3/2} + (3/2) A ξ^{1/2} dξ/dt), and the contact ends
    where it would turn to attraction. ε^n is the Padé approximant [3/6] in v* = β^{1/2} v^{1/10}, with
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

    @model_validator(mode="after")
    def _representable(self) -> "Viscoelastic":
        _core.normal_coefficient(self.model_dump(), np.empty(0))
        return self

    @property
    def beta(self) -> float:
        """β in (s/m)^{1/5}: the dissipation in the units that elasticity and inertia make."""
        stiffness = self.young_modulus / (
            np.pi * (1 - self.poisson_ratio**2) * self.density * self.radius**2.5
        )
        return float(1.5 * self.dissipation * stiffness**0.4)

    def _coefficient(self, speed: Floats) -> Floats:
        x = self.beta**0.5 * speed**0.1
        return np.asarray(PADE_ABOVE(x) / PADE_BELOW(x))


class Plastic(Material):
    """Elastic-perfectly plastic spheres (Thornton, J. Appl. Mech. 64, 383 (1997)).

    ε^n = √(6√3/5) √(1 - x²/6) (x/(x + 2√(6/5 - x²/5)))^{1/4} with x = v_y/v; 1 up to v_y, and 1.185 x^{1/4}
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

    def _coefficient(self, speed: Floats) -> Floats:
        x = self.yield_speed / np.maximum(speed, self.yield_speed)
        ratio = x / (x + 2.0 * np.sqrt(1.2 - x**2 / 5.0))
        value = np.sqrt(1.2 * np.sqrt(3.0)) * np.sqrt(1.0 - x**2 / 6.0) * ratio**0.25
        return np.where(speed <= self.yield_speed, 1.0, np.minimum(value, 1.0))


def _numbers(name: str, good: Callable[[float], bool], allowed: str) -> BeforeValidator:
    """Take a 1-D sequence of numbers, each of them good."""

    def check(value: Any) -> tuple[float, ...]:
        try:
            array = np.asarray(value)
        except ValueError:  # lists of different lengths
            array = np.empty(())
        if array.ndim != 1 or array.dtype.kind not in "iuf" or not array.size:
            raise ParameterError(wrong(name, value, "a 1-D array of at least one number"))
        numbers = tuple(map(float, array))
        for i, x in enumerate(numbers):
            if not good(x):
                raise ParameterError(wrong(f"{name}[{i}]", x, allowed))
        return numbers

    return BeforeValidator(check)


class Tabulated(Material):
    """A coefficient as it was measured: interpolated linearly between points, constant beyond their ends.

    Parameters
    ----------
    v : array_like, shape (n,)
        Speeds in m/s: finite, >= 0, increasing; n >= 1.
    e : array_like, shape (n,)
        ε^n at these speeds, each in [0, 1].

    Examples
    --------
    >>> import restitution as rs
    >>> measured = rs.Tabulated(v=[0.1, 0.5, 1.0], e=[0.97, 0.95, 0.92])
    >>> measured([0.0, 0.3, 2.0]).tolist()
    [0.97, 0.96, 0.92]
    """

    v: Annotated[
        tuple[float, ...],
        _numbers("v", lambda x: 0.0 <= x < np.inf, "a finite number >= 0 (m/s)"),
        Allowed("a 1-D array of speeds in m/s"),
    ]
    e: Annotated[
        tuple[float, ...],
        _numbers("e", lambda x: 0.0 <= x <= 1.0, "a real number in [0, 1]"),
        Allowed("a 1-D array of numbers in [0, 1]"),
    ]

    @model_validator(mode="after")
    def _a_function(self) -> "Tabulated":
        for i in range(1, len(self.v)):
            if self.v[i] <= self.v[i - 1]:
                allowed = f"greater than v[{i - 1}] = {self.v[i - 1]}"
                raise ParameterError(wrong(f"v[{i}]", self.v[i], allowed))
        if len(self.e) != len(self.v):
            given = f" = an array of {len(self.e)} numbers"
            raise ParameterError(Problem("e", f"{given}: must be one for each of the {len(self.v)} speeds"))
        return self

    def _coefficient(self, speed: Floats) -> Floats:
        return np.asarray(np.interp(speed, self.v, self.e))
