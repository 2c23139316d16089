"""One series of impacts, and the few numbers that stand for it."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._arrays import reals
from restitution._energy import reported_elsewhere
from restitution._parameters import ParameterError, Problem
from restitution._recorded import first_impact_of
from restitution._simulate import simulate
from restitution._units import check_variables
from restitution.bodies import Body
from restitution.budget._experiment import mean_radius
from restitution.flight._laws import LawOfSpeed, by_parameters
from restitution.laws._law import Law

Array = npt.NDArray[np.float64]

_FEWEST = 5
_SHORTEST = 0.1
"""Flights shorter than this, over the one before, are heard as one impact with the next."""


class Drops(NamedTuple):
    """Simulated series that could have been measured.

    Attributes
    ----------
    statistics : ndarray, shape (kept, 3)
    share : float
        Of all simulated series, those that bounce as often and have distinct impacts.
    """

    statistics: Array
    share: float


@dataclass(frozen=True)
class Series:
    """What was measured, and how the numbers that stand for it follow from coefficients.

    The three numbers are the parameter of ε_n by generalised least squares, and the logarithms of the mean
    squares of the whitened residuals in the first and in the second half. The covariance is that of the times
    and one scatter for all, rounded to half decades so that it hardly depends on the series.

    Attributes
    ----------
    drop : float
        Height of the fall before the first impact, in m.
    gravity : float
    errors : ndarray, shape (n,)
        Standard errors of the times.
    known : ndarray of int, shape (k,)
        Impacts whose coefficient is known from times alone.
    speed : ndarray, shape (k,)
        Their measured speeds.
    reference : float
        The parameter about which everything is linear.
    form : LawOfSpeed
    estimator : ndarray, shape (k,)
    whiten : ndarray, shape (k, k)
        Makes of residuals those that are independent, the fitted parameter taken off.
    observed : ndarray, shape (3,)
    """

    drop: float
    gravity: float
    errors: Array
    known: npt.NDArray[np.intp]
    reference: float
    form: LawOfSpeed
    estimator: Array
    whiten: Array
    observed: Array

    @classmethod
    def of(cls, data: xr.Dataset, form: LawOfSpeed, reference: float, scatter: float) -> "Series":
        """Take a Dataset of `restitution.flight.restitution`."""
        names = ("restitution", "impact_velocity", "uncertainty", "restitution_covariance")
        lacking = [name for name in (*names, "time") if name not in data]
        if lacking:
            text = f" lacks {', '.join(lacking)}: must be a Dataset of flight.restitution"
            raise ParameterError(Problem("data", text))
        check_variables("data", data, *names, "time")
        if first_impact_of("data", data) != 0:
            text = ": begins with a later impact; must begin with the first one after the release"
            raise ParameterError(Problem("data", text))
        ratio, speed, errors, covariances = (
            reals(f"data.{name}", data[name].to_numpy(), "numbers, NaN where unknown", finite=False)
            for name in names
        )
        known = np.flatnonzero(np.isfinite(ratio))
        # Of a part of a series the last coefficient has a flight that is not there.
        known = known[(known > 0) & (known < ratio.size - 1)]
        if known.size < _FEWEST:
            text = f": {known.size} coefficients from times alone; must be at least {_FEWEST}"
            raise ParameterError(Problem("data", text))
        errors = np.nan_to_num(errors)
        if not np.any(errors > 0.0):
            raise ParameterError(Problem("data", ": times without errors; must have an uncertainty > 0"))
        covariance = covariances[np.ix_(known, known)]
        covariance = covariance + 10.0 ** (np.round(4.0 * np.log10(max(scatter, 1e-12))) / 2.0) * np.eye(
            known.size
        )
        values = np.array([reference])
        slopes = by_parameters(form, speed[known], values)[:, 0]
        weighted = np.linalg.solve(covariance, slopes)
        estimator = weighted / (slopes @ weighted)
        root = np.linalg.inv(np.linalg.cholesky(covariance))
        whiten = root @ (np.eye(known.size) - np.outer(slopes, estimator))
        first = data.impact_velocity.values[0]
        if not np.isfinite(first):
            # The first flight begins with v' = g Δt/2, and the ball fell with v'/ε_n.
            up = 0.5 * data.attrs["gravity"] * float(data.time[1] - data.time[0])
            if not np.isfinite(up):
                raise ParameterError(
                    Problem("data", ": the first two times must be known, or the drop height")
                )
            first = up / float(form.coefficient(np.array([up]), values)[0])
        gravity = float(data.attrs["gravity"])
        drop = first**2 / (2.0 * gravity)
        one = cls(drop, gravity, errors, known, reference, form, estimator, whiten, np.zeros(3))
        observed = one.numbers(speed[None, known], ratio[None, known])[0]
        return cls(drop, gravity, errors, known, reference, form, estimator, whiten, observed)

    def numbers(self, speed: Array, ratio: Array) -> Array:
        """Give the three numbers of series with these speeds and coefficients, shape (m, k)."""
        residual = ratio - self.form.coefficient(speed, np.array([self.reference]))
        squares = (residual @ self.whiten.T) ** 2
        half = self.known.size // 2
        return np.column_stack(
            [
                self.reference + residual @ self.estimator,
                np.log(squares[:, :half].mean(axis=1) + 1e-300),
                np.log(squares[:, half:].mean(axis=1) + 1e-300),
            ]
        )

    def release_height(self, body: Body) -> float:
        """Give the height from which the body falls as far as the ball did, in m."""
        return mean_radius(body) + self.drop

    @reported_elsewhere()
    def simulated(self, body: Body, law: Law, particles: int, noises: int, seed: int) -> Drops:
        """Drop such balls, and time each of them with errors, several times over."""
        run = simulate(
            body,
            law,
            particles=particles,
            impacts=self.errors.size,
            release_height=self.release_height(body),
            gravity=self.gravity,
            seed=seed,
        )
        flight = np.diff(run.time.values, axis=1)
        kept = np.all(flight > 0.0, axis=1) & np.all(flight[:, 1:] > _SHORTEST * flight[:, :-1], axis=1)
        times = np.repeat(run.time.values[kept], noises, axis=0)
        rng = np.random.default_rng(seed)
        heard = np.diff(times + self.errors * rng.standard_normal(times.shape), axis=1)
        whole = np.all(heard > 0.0, axis=1)
        heard = heard[whole]
        ratio = heard[:, self.known] / heard[:, self.known - 1]
        speed = 0.5 * self.gravity * heard[:, self.known - 1]
        return Drops(self.numbers(speed, ratio), len(heard) / (particles * noises))
