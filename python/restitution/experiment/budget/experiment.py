"""The experiment of an error budget: a round ball whose times are known, and how it is evaluated."""

import math
from dataclasses import dataclass
from functools import cached_property
from numbers import Real
from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator
from scipy.optimize import least_squares

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.parameters import (
    Number,
    ParameterError,
    Whole,
    in_terms_of,
    wrong,
)
from restitution.bodies import Body
from restitution.experiment.flight.chain import COMMON, Measured, chain
from restitution.experiment.flight.laws import LAWS, LawOfSpeed, by_parameters, law_named
from restitution.experiment.flight.setting import Gravity
from restitution.experiment.flight.times import LARGEST
from restitution.laws import (
    Coulomb,
    Frictionless,
    Law,
    Material,
    Plastic,
    TangentialRestitution,
    Viscoelastic,
    check_steady,
)

_MOST = 1000
"""Of coefficients, which have a covariance each with each: so many that no ball reaches them."""
_SHORTEST = 1e-10
"""Of flights, over the time since release: doubles resolve 1e-16 of that, and ε to 1e-6."""


class Setting(Gravity):
    """An experiment: the drop of the ball, and the uncertainty of everything measured."""

    drop: Annotated[Number, Field(gt=0, description="m")]
    impacts: Annotated[Whole, Field(ge=3, le=_MOST)]
    timing: Annotated[Number, Field(ge=0, le=LARGEST, description="s")] = 0.0
    drop_uncertainty: Annotated[Number, Field(ge=0, le=LARGEST, description="m")] = 0.0
    tilt: Annotated[Number, Field(ge=0, lt=0.5, description="rad")] = 0.0
    spin: Annotated[Number, Field(ge=0, description="rad/s")] = 0.0
    roughness: Annotated[Number, Field(ge=0, description="m")] = 0.0
    particles: Annotated[Whole, Field(ge=50)] = 1000
    seed: Annotated[Whole, Field(ge=0, lt=2**63)] = 1

    @model_validator(mode="after")
    def _known_to_a_factor(self) -> Self:
        for name in ("gravity", "drop"):
            error, value = getattr(self, f"{name}_uncertainty"), getattr(self, name)
            if error is not None and error > value:
                raise ParameterError(wrong(f"{name}_uncertainty", error, f"at most {name} = {value!r}"))
        return self


def mean_radius(body: Body) -> float:
    """Return half the mean of the diameters along and across the axis, in m."""
    up, down, across = (body.compiled.lowest(np.array([cosine])) for cosine in (1.0, -1.0, 0.0))
    return 0.25 * (up + down) + 0.5 * across


HEIGHT = 0.5 * math.e
"""Mean h_0 of heights that are exponentially distributed, over their arithmetic mean roughness Ra."""
ROUGHEST = 1e-3
"""Ra over the radius, up to which the expansion for rough balls holds."""
STICKS = 0.3
"""A coefficient of friction with which contacts of nearly round balls stick, to L/R of about 0.5."""


def frictions(law: object) -> tuple[Law, ...]:
    """Return the laws that stand for one, or for a normal coefficient whose friction is unknown.

    Friction acts on a nearly round ball between two limits: a contact that slides gives the spin m v d/J, one
    that sticks m v d/(J + m R²), with the lever arm d; for a full ball that is 2/7. Both have the same prior
    probability.
    """
    if isinstance(law, Law):
        return (law,)
    if isinstance(law, bool) or not isinstance(law, (Real, Material)):
        allowed = "a law such as Coulomb(normal=0.9, friction=0.2), or its normal coefficient alone"
        raise ParameterError(wrong("law", law, allowed))
    with in_terms_of(law=law):
        return Frictionless(normal=law), Coulomb(normal=law, friction=STICKS)


_HOLDS = 0.1
"""Coefficient of friction with which all contacts of a nearly round ball stick."""


def coupling(law: Law, body: Body) -> float | None:
    """Return q in 1/m², or None for laws for which it is not worked out here.

    A contact at the lever arm d sticks where friction is above (d/R) m R²/(J + m R²).
    """
    match law:
        case Frictionless():
            return body.mass / body.transverse_inertia
        case TangentialRestitution(tangential=1.0) | Coulomb():
            if isinstance(law, Coulomb) and law.friction < _HOLDS:
                return None
            return body.mass / (body.transverse_inertia + body.mass * mean_radius(body) ** 2)
    return None


def law_of_speed(law: Law) -> LawOfSpeed:
    """Find what an experimenter fits to balls that bounce by a law."""
    normal = law.normal
    if isinstance(normal, Viscoelastic | Plastic):
        return law_named(type(normal))
    return LAWS["power law" if isinstance(normal, Material) else "constant"]


@dataclass(frozen=True)
class Experiment:
    """A round ball, dropped: n coefficients of restitution from n + 1 impacts, without any error.

    Attributes
    ----------
    setting : Setting
    laws : tuple of Law
        Those whose average the errors are: of unknown friction two, without and with so much that contacts
        stick.
    form : LawOfSpeed
        The law of speed that is fitted.
    speed, coefficient : ndarray, shape (n,)
        Speed in m/s and ε_n of each impact.
    times : ndarray, shape (n + 1,)
        Of the impacts, in s; 0 is the first.
    """

    setting: Setting
    laws: tuple[Law, ...]
    form: LawOfSpeed
    speed: Array
    coefficient: Array
    times: Array

    @classmethod
    def of(cls, given: object, setting: Setting) -> "Experiment":
        """Follow the ball that bounces by a law, or by a normal coefficient with unknown friction."""
        laws = frictions(given)
        law = laws[0]
        check_steady(law)
        speed, coefficient = [math.sqrt(2.0 * setting.gravity * setting.drop)], []
        for _ in range(setting.impacts):
            coefficient.append(float(at(law, np.array(speed[-1]))))
            speed.append(coefficient[-1] * speed[-1])
        if not speed[-1] > 0.0:
            raise ParameterError(wrong("law", law, "one under which a ball bounces, ε_n > 0"))
        flights = 2.0 * np.array(speed[1:]) / setting.gravity
        times = np.concatenate([[0.0], np.cumsum(flights)])
        if not np.all(flights >= _SHORTEST * (speed[0] / setting.gravity + times[1:])):
            allowed = f"one whose flights last at least {_SHORTEST:g} of the time since release"
            raise ParameterError(wrong("law", law, f"{allowed}, for impacts = {setting.impacts} of them"))
        found = cls(setting, laws, law_of_speed(law), np.array(speed[:-1]), np.array(coefficient), times)
        found._check_fit()
        return found

    @property
    def law(self) -> Law:
        """The law that says what ε_n is."""
        return self.laws[0]

    @property
    def words(self) -> str:
        """The law, or what is known of it, as the attributes name it."""
        return repr(self.law) if len(self.laws) == 1 else f"normal = {self.law.normal!r}, friction unknown"

    def _check_fit(self) -> None:
        """Refuse laws whose parameters do not show, as those of plastic spheres that stay elastic."""
        size = np.linalg.norm(self._by_parameters, axis=0)
        names = " and ".join(self.form.parameters)
        if not np.all(size > 0.0) or np.linalg.matrix_rank(self._by_parameters / size) < size.size:
            low, high = self.speed.min(), self.speed.max()
            allowed = (
                f"one from whose ε_n at the speeds {low:.6g} to {high:.6g} m/s the {names} can be fitted"
            )
            raise ParameterError(wrong("law", self.law, allowed))

    def covariance(
        self,
        timing: float = 0.0,
        gravity: float = 0.0,
        drop: float = 0.0,
        contact: float = 0.0,
        clock: float = 0.0,
    ) -> Array:
        """Return the covariance of ε less the law at the measured speed, shape (n, n), by standard errors."""
        errors = np.array([*np.full(self.times.size, timing), gravity, drop, 0.0, contact, clock])
        return np.asarray((self.derivatives * errors**2) @ self.derivatives.T)

    @cached_property
    def derivatives(self) -> Array:
        """Those of ε less the law by all numbers that are measured, in the order of `Chain`."""
        none = np.zeros(self.times.size + COMMON)
        links = chain(Measured(self.times, self.setting.gravity, self.setting.drop, None, none))
        step = 1e-6 * self.speed
        by_speed = (at(self.law, self.speed + step) - at(self.law, self.speed - step)) / (2.0 * step)
        # r_i = v'_i - ε_n(v_i) v_i, over v_i.
        slope = self.coefficient + by_speed * self.speed
        return np.asarray((links.after_by[:-1] - slope[:, None] * links.before_by[:-1]) / self.speed[:, None])

    @cached_property
    def parameters(self) -> Array:
        """Parameters of the fitted law of speed that are nearest to the law, by least squares in ε."""
        start = self.form.start(self.speed, self.coefficient)
        if isinstance(self.law.normal, Plastic):
            # Where spheres stay elastic at all speeds, no slope leads a search to the yield speed.
            start = np.array([max(self.law.normal.yield_speed, self.form.least)])

        def misfit(values: Array) -> Array:
            return self.form.coefficient(self.speed, values) - self.coefficient

        found = least_squares(
            misfit,
            start,
            x_scale=np.maximum(np.abs(start), 1e-3),
            bounds=(self.form.least, np.inf),
            xtol=1e-14,
            ftol=1e-14,
            gtol=1e-14,
        )
        return np.asarray(found.x)

    @cached_property
    def _by_parameters(self) -> Array:
        """Derivatives of the fitted ε_n by the parameters, shape (n, p)."""
        return by_parameters(self.form, self.speed, self.parameters)

    def fitted(self, covariance: Array) -> tuple[Array, Array]:
        """Return the derivatives of a generalised least-squares fit by the coefficients.

        Returns
        -------
        parameters, coefficients : ndarray, shapes (p, n) and (n, n)
            Change of the parameters, and of the fitted ε_n at the speeds, by changes of the n coefficients.
        """
        slopes = self._by_parameters
        weighted = np.linalg.solve(covariance, slopes)
        estimator = np.linalg.solve(slopes.T @ weighted, weighted.T)
        return estimator, slopes @ estimator


def at(law: Law, speed: Array) -> Array:
    """Return ε_n of a law at speeds; shape of `speed`."""
    if isinstance(law.normal, Material):
        return law.normal(speed)
    return np.full_like(speed, law.normal)
