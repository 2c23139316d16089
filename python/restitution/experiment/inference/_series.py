"""One series of impacts, and the few numbers that stand for it."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import check_each
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution._internal.resources import check_size
from restitution.bodies import Body
from restitution.drop.recorded import check_successive
from restitution.drop.run import Run
from restitution.drop.simulate import times_of_impacts
from restitution.experiment.budget.experiment import mean_radius
from restitution.experiment.flight.contact import delays
from restitution.experiment.flight.laws import LawOfSpeed, by_parameters
from restitution.experiment.flight.times import LARGEST
from restitution.laws import Law

_FEWEST = 5
_FACTOR = 0.5
"""Standard deviation of the logarithm of the factor by which stated errors of times are off."""
_ROUNDING = 1e-6
"""Of a variance of 0, over the largest, in a covariance that was computed."""
_UNSEEN = 0.05
"""A scatter over the least standard error of a coefficient, to which it adds nothing that shows."""
_SHORTEST = 0.1
"""Flights shorter than this, over the one before, are heard as one impact with the next."""
_BYTES = 64
"""That a simulated impact takes: its time, flights, speed and coefficient, each timed twice."""


def _negative(covariance: Array) -> bool:
    """Test whether a combination of the numbers has a negative variance, beyond rounding."""
    variances = np.linalg.eigvalsh(covariance)
    return bool(variances[0] < -_ROUNDING * np.abs(variances).max())


class Drops(NamedTuple):
    """Simulated series that could have been measured."""

    statistics: Array  # shape (kept, 6), as of `Series.numbers`
    share: float  # of all simulated series, those that bounce as often and have distinct impacts


NEEDED = ("time", "uncertainty", "impact_velocity", "restitution", "restitution_covariance")
"""Variables of a Dataset of `restitution.flight.restitution` that stand for a series."""


def check_from_release(name: str, data: xr.Dataset) -> None:
    """Refuse a series that does not begin with the first impact, or whose covariance is of other impacts."""
    check_successive(name, data, start=0)
    impacts, others = data.sizes["impact"], data.sizes["other_impact"]
    if impacts != others:
        text = f" has {impacts} impacts and {others} of other_impact: must be the same impacts of both"
        raise ParameterError(Problem(name, text))


@dataclass(frozen=True)
class Series:
    """Measured numbers, and how those that stand for it follow from coefficients.

    One impact is left out, that without which χ² is the least; so it is in every simulated series, too. The
    numbers are the parameter of ε_n by generalised least squares, the logarithms of the mean squares of the
    whitened residuals in the first and in the second half, and the correlation of residuals that follow one
    another, which errors of the times have. Two more are for the predictive check: the logarithm of the
    residual that was left out, over the root mean square of the others, and the correlation of residuals
    with ln v. The covariance is that of the times and one scatter for all, rounded to half decades so that
    it hardly depends on the series.
    """

    drop: float  # height of the fall before the first impact, in m
    gravity: float  # in m/s²
    common: float  # error of g and of the clock, over the value, that all speeds have in common
    errors: Array  # standard errors of the times, shape (n,)
    delay: Array  # what the standard error of the time of contact does to each flight, in s, shape (n - 1,)
    known: npt.NDArray[np.intp]  # impacts whose coefficient is known from times alone, shape (k,)
    speed: Array  # their measured speeds, shape (k,)
    ratio: Array  # and their coefficients
    reference: float  # the parameter about which everything is linear
    form: LawOfSpeed
    slopes: Array  # dε_n by the parameter, shape (k,)
    spread: Array  # the standard deviation of each coefficient, shape (k,)
    unseen: float  # a scatter of ε_n that errors of the times hide
    estimator: Array  # of the parameter by the residuals, shape (k,)
    whiten: Array  # makes of residuals independent ones, the fitted parameter taken off, shape (k, k)

    @classmethod
    def of(
        cls, data: xr.Dataset, form: LawOfSpeed, reference: float, scatter: float, name: str = "data"
    ) -> "Series":
        """Take a Dataset of `restitution.flight.restitution`, which has what is `NEEDED`."""
        time, errors, speed, ratio = (data[each].to_numpy().astype(np.float64) for each in NEEDED[:-1])
        known = np.flatnonzero(np.isfinite(ratio))
        # A coefficient is simulated from three times: it has a flight before it and one after it.
        known = known[(known > 0) & (known < ratio.size - 1)]
        if known.size < _FEWEST:
            text = f": {known.size} coefficients from times alone; must be at least {_FEWEST}"
            raise ParameterError(Problem(name, text))
        errors = np.nan_to_num(errors)
        if not np.any(errors > 0.0):
            raise ParameterError(Problem(name, ": times without errors; must have an uncertainty > 0"))
        for each, values in (("impact_velocity", speed), ("restitution", ratio)):
            good = np.isnan(values) | ((values > 0.0) & (values <= LARGEST))
            good[known] &= ~np.isnan(values[known])
            check_each(f"{name}.{each}", values, good, f"in (0, {LARGEST:g}], and known at every coefficient")
        covariance = data["restitution_covariance"].transpose("impact", "other_impact").to_numpy()
        covariance = covariance[np.ix_(known, known)].astype(np.float64)
        measured = covariance
        covariance = covariance + 10.0 ** (np.round(4.0 * np.log10(max(scatter, 1e-12))) / 2.0) * np.eye(
            known.size
        )
        values = np.array([reference])
        slopes = by_parameters(form, speed[known], values)[:, 0]
        try:
            if not np.all(np.isfinite(measured)) or _negative(measured):
                raise np.linalg.LinAlgError
            weighted = np.linalg.solve(covariance, slopes)
            root = np.linalg.inv(np.linalg.cholesky(covariance))
        except (
            np.linalg.LinAlgError
        ):  # or one of errors so large, and so alike, that nothing is left to weigh
            allowed = "a covariance, with no negative variance, of all coefficients that are known"
            raise ParameterError(wrong(f"{name}.restitution_covariance", measured, allowed)) from None
        estimator = weighted / (slopes @ weighted)
        whiten = root @ (np.eye(known.size) - np.outer(slopes, estimator))
        first = float(speed[0])
        if not np.isfinite(first):
            # The first flight that is known, after impact k, begins with v' = g Δt/2, and all k + 1 impacts
            # before it had about the same ε_n.
            flights = np.diff(time)
            place = int(np.flatnonzero(np.isfinite(flights))[0])
            up = 0.5 * data.attrs["gravity"] * float(flights[place])
            first = up / float(form.coefficient(np.array([up]), values)[0]) ** (place + 1)
        gravity = float(data.attrs["gravity"])
        contact = float(data.attrs.get("contact_time_uncertainty", 0.0))
        drop = first**2 / (2.0 * gravity)
        half = 0.5 * gravity * np.diff(time)  # drag changes the contact times by little
        return cls(
            drop=drop,
            gravity=gravity,
            common=math.hypot(
                float(data.attrs.get("gravity_uncertainty", 0.0)) / gravity,
                float(data.attrs.get("clock_uncertainty", 0.0)),
            ),
            errors=errors,
            delay=contact * np.nan_to_num(delays(half, half)),
            known=known,
            speed=speed[known],
            ratio=ratio[known],
            reference=reference,
            form=form,
            slopes=slopes,
            spread=np.sqrt(np.diag(covariance)),
            unseen=_UNSEEN * math.sqrt(max(0.0, np.diag(measured).min())),
            estimator=estimator,
            whiten=whiten,
        )

    @cached_property
    def observed(self) -> Array:
        """The numbers of the measured series, shape (6,)."""
        return np.asarray(self.numbers(self.speed[None], self.ratio[None])[0])

    def numbers(self, speed: Array, ratio: Array) -> Array:
        """Return the numbers of series with these speeds and coefficients, (m, k) each; shape (m, 6)."""
        usual = self.form.coefficient(speed, np.array([self.reference]))
        residual = ratio - usual
        # Without impact i the residual there is what its neighbours say of it, and χ² is less by t_i².
        precision = self.whiten.T @ self.whiten
        off = residual @ precision / np.sqrt(np.diag(precision))
        rows, worst = np.arange(len(off)), np.argmax(np.abs(off), axis=1)
        residual[rows, worst] -= off[rows, worst] / np.sqrt(precision[worst, worst])
        white = residual @ self.whiten.T
        squares = white**2
        half = self.known.size // 2
        size = np.sqrt(squares.mean(axis=1) + 1e-300)
        shift = residual @ self.estimator
        scaled = (residual - shift[:, None] * self.slopes) / self.spread
        slope = self.whiten @ (np.log(self.speed) * self.slopes)
        return np.column_stack(
            [
                self.reference + shift,
                np.log(squares[:, :half].mean(axis=1) + 1e-300),
                np.log(squares[:, half:].mean(axis=1) + 1e-300),
                np.sum(scaled[:, 1:] * scaled[:, :-1], axis=1) / (np.sum(scaled**2, axis=1) + 1e-300),
                np.log(np.abs(off[rows, worst]) / size + 1e-300),
                white @ slope / (np.linalg.norm(slope) * size),
            ]
        )

    def check_release(self, body: Body, law: Law, particles: int) -> None:
        """Refuse a fall from so low that a part of the body would be in the plane, and too many particles."""
        self._run(body, law, 1, seed=1)
        rows = particles * self.errors.size
        check_size("particles * impacts", rows, rows, _BYTES, "impacts")

    def _run(self, body: Body, law: Law, particles: int, seed: int) -> Run:
        return Run(
            body=body,
            law=law,
            particles=particles,
            impacts=self.errors.size,
            release_height=mean_radius(body) + self.drop,
            gravity=self.gravity,
            seed=seed,
        )

    def simulated(self, body: Body, law: Law, particles: int, seed: int) -> Array:
        """Drop such balls and return their flights, (m, n - 1) in s, of those that bounce so often."""
        return np.diff(times_of_impacts(self._run(body, law, particles, seed)), axis=1)

    def simulated_rough(self, parameter: float, kick: float, particles: int, seed: int) -> Array:
        """Drop round balls with asperities, without spin; return their flights, (particles, n - 1) in s.

        They follow the map of docs/rough.md. A contact lies at d = s (X, Y), s² = h_0 R, X and Y Gaussian for
        exponential heights of mean h_0. With the horizontal velocity u that the spin gives to the lowest
        point, and c = 1 + ε_n,

            ε = c (1 + u·d/v)/(1 + q d²) - 1,    Δu = -q d c (v + u·d)/(1 + q d²),

        q as of `coupling`. Contacts are met in proportion to their speed of approach, which shifts the mean
        of d by s² u/v. With w = s u all of this depends on one number only, k = q s², the `kick`: friction
        changes q, and so what h_0 is that a k stands for. Contacts of different impacts are independent.
        """
        rng = np.random.default_rng(seed)
        speed = np.full(particles, np.sqrt(2.0 * self.gravity * self.drop))
        drift = np.zeros((particles, 2))
        found = np.empty((particles, self.errors.size - 1))
        for impact in range(self.errors.size - 1):
            moving = speed > 0.0  # others have come to rest, and are no series
            here = np.where(moving, speed, np.nan)
            usual = np.full(particles, np.nan)
            usual[moving] = self.form.coefficient(speed[moving], np.array([parameter]))
            arm = rng.standard_normal((particles, 2)) + drift / here[:, None]
            approach = here + np.sum(drift * arm, axis=1)
            impulse = (1.0 + usual) * approach / (1.0 + kick * np.sum(arm**2, axis=1))
            drift = drift - kick * impulse[:, None] * arm
            speed = impulse - here
            found[:, impact] = 2.0 * speed / self.gravity
        return found

    def noise(self, drops: int, seed: int) -> tuple[Array, Array]:
        """Draw errors of flights in s, and of ε_n in units of its scatter; (drops, n - 1) each.

        The errors of the times of a series are the stated ones times one factor; that of the time of contact
        is common to all.
        """
        rng = np.random.default_rng(seed)
        factor = np.exp(_FACTOR * rng.standard_normal((drops, 1)))
        errors = np.diff(factor * self.errors * rng.standard_normal((drops, self.errors.size)), axis=1)
        off = rng.standard_normal(errors.shape)
        return errors + self.delay * rng.standard_normal((drops, 1)), off

    def heard(self, flight: Array, scatter: float, noise: tuple[Array, Array]) -> Drops:
        """Time drops with these flights, each so often as there is noise for it.

        Where ε_n is higher by δ at an impact all later flights last longer by δ/ε_n, to first order in δ.
        """
        errors, off = noise
        flight = np.repeat(flight, len(errors) // len(flight), axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            if scatter > 0.0:
                # That of the first impact, which does not count, is not far from that of the second.
                usual = (flight[:, 1:] / flight[:, :-1])[:, [0, *range(flight.shape[1] - 1)]]
                flight = flight * np.cumprod(1.0 + scatter * off / usual, axis=1)
            heard = flight + errors
            kept = np.all(flight > 0.0, axis=1) & np.all(heard > 0.0, axis=1)
            kept &= np.all(flight[:, 1:] > _SHORTEST * flight[:, :-1], axis=1)
        heard = heard[kept]
        ratio = heard[:, self.known] / heard[:, self.known - 1]
        speed = 0.5 * self.gravity * heard[:, self.known - 1]
        return Drops(self.numbers(speed, ratio), len(heard) / len(flight))
