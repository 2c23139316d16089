"""Sources of error and their effect on the coefficients of a series: a bias and a covariance."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.parameters import ParameterError, Problem, in_terms_of
from restitution.bodies import Body
from restitution.drop.energy import reported_elsewhere
from restitution.drop.release import RandomSpin
from restitution.drop.simulate import simulate
from restitution.experiment.budget.experiment import Experiment, at, mean_radius
from restitution.experiment.flight.contact import ContactTime
from restitution.experiment.flight.drag import Drag, fall, launched
from restitution.laws import Law

_LEAST_KEPT = 0.9
"""Share of the particles that must bounce as often as asked."""
_SHORTEST = 0.1
"""Flights shorter than this, over that of a round ball, are heard as one impact with the next."""


@dataclass(frozen=True)
class Source:
    """Errors of the coefficients of a series of n.

    Attributes
    ----------
    bias : ndarray, shape (n,)
        Mean of the measured ε less ε_n at the measured speed.
    covariance : ndarray, shape (n, n)
        Of the measured ε about that mean.
    errors, without : ndarray, shapes (particles, n), or None
        Of simulated drops, and of those whose mean and covariance were taken off.
    """

    bias: Array
    covariance: Array
    errors: Array | None = None
    without: Array | None = None

    def carried(self, by: Array) -> "Carried":
        """Carry the errors on to m quantities that change by `by`, shape (m, n), with those of ε."""
        bias = by @ self.bias
        variance = np.einsum("ij,jk,ik->i", by, self.covariance, by)
        zero = np.zeros_like(bias)
        if self.errors is None:
            return Carried(bias, np.sqrt(np.maximum(variance, 0.0)), zero, zero)
        values = self.errors @ by.T
        squares = (values - values.mean(axis=0)) ** 2
        if self.without is not None:
            # The same balls at the same angles: in the difference much of the sampling error is gone.
            before = self.without @ by.T
            squares = squares - (before - before.mean(axis=0)) ** 2
            values = values - before
        root = np.sqrt(len(values))
        error = squares.std(axis=0) / root
        deviation = np.sqrt(np.maximum(variance, 0.0))
        known = np.minimum(error / (2.0 * np.maximum(deviation, 1e-300)), np.sqrt(error))
        return Carried(bias, deviation, values.std(axis=0) / root, known)


class Carried(NamedTuple):
    """Bias and standard deviation of m quantities, and their standard errors by sampling; shape (m,)."""

    bias: Array
    deviation: Array
    bias_error: Array
    deviation_error: Array


def nothing(n: int) -> Source:
    """Return a source without error."""
    return Source(np.zeros(n), np.zeros((n, n)))


def timing(experiment: Experiment) -> Source:
    """Take independent errors of the times; the bias of a quotient is of second order in them."""
    error = experiment.setting.timing
    n = experiment.speed.size
    covariance = experiment.covariance(timing=error)
    before, after = np.diff(experiment.times)[:-1], np.diff(experiment.times)[1:]
    bias = np.zeros(n)
    # ⟨b/a⟩ - b/a = (b/a) var(a)/a² - cov(a, b)/a², with var = 2 s² and cov = -s² of neighbours.
    bias[1:] = (2.0 * after / before + 1.0) * (error / before) ** 2
    return Source(bias, covariance)


def gravity(experiment: Experiment) -> Source:
    """Take an error of g: ε is a quotient of times, but for the first, whose speed is that of the drop."""
    covariance = experiment.covariance(gravity=experiment.setting.gravity_error)
    return Source(np.zeros(experiment.speed.size), covariance)


def clock(experiment: Experiment) -> Source:
    """Take an error of the clock, which acts as one of g that does not change the speed of the drop."""
    covariance = experiment.covariance(clock=experiment.setting.clock_uncertainty)
    return Source(np.zeros(experiment.speed.size), covariance)


def drop(experiment: Experiment) -> Source:
    """Take an error of the height of the drop, from which the first speed follows."""
    covariance = experiment.covariance(drop=experiment.setting.drop_uncertainty)
    return Source(np.zeros(experiment.speed.size), covariance)


def drag(experiment: Experiment, force: Drag, corrected: bool) -> Source:
    """Take air drag: neglected, its effect is a bias; corrected for, the error of that remains."""
    effect = _with_drag(experiment, force.terminal_velocity)
    step = 1e-4 * force.terminal_velocity
    slope = (
        _with_drag(experiment, force.terminal_velocity + step)
        - _with_drag(experiment, force.terminal_velocity - step)
    ) / (2.0 * step)
    bias = np.zeros_like(effect) if corrected else effect
    return Source(bias, np.outer(slope, slope) * force.uncertainty**2)


def contact(experiment: Experiment, time: ContactTime, corrected: bool) -> Source:
    """Take the time of contact: neglected, its effect is a bias; otherwise the error of it remains."""
    by = experiment.derivatives(experiment.measured(0.0, 0.0, 0.0, 0.0, 0.0))[:, -2]
    bias = np.zeros_like(by) if corrected else -by * time.at_1_m_s
    return Source(bias, np.outer(by, by) * time.uncertainty**2)


def _with_drag(experiment: Experiment, terminal: float) -> Array:
    """Return ε from times of flight without drag correction, minus the law at the inferred speed."""
    g = experiment.setting.gravity
    speed = fall(experiment.setting.drop, g, terminal).speed
    told = [math.sqrt(2.0 * g * experiment.setting.drop)]
    for _ in range(experiment.setting.impacts):
        flight = launched(float(at(experiment.law, np.array(speed))) * speed, g, terminal)
        told.append(0.5 * g * flight.duration)
        speed = flight.landing
    heard = np.array(told)
    return np.asarray(heard[1:] / heard[:-1] - at(experiment.law, heard[:-1]))


def shape(experiment: Experiment, body: Body) -> Source:
    """Take the shape alone: released at rest at random angles over a level plane, timed without error."""
    return _source(simulated(experiment, body, spin=False, tilt=False))


def spin(experiment: Experiment, body: Body, shape_alone: Source) -> Source:
    """Find what spin at release adds to the shape."""
    return _beyond(_source(simulated(experiment, body, spin=True, tilt=False)), shape_alone)


def tilt(experiment: Experiment, body: Body, shape_alone: Source) -> Source:
    """Find what an inclined plate adds to the shape."""
    return _beyond(_source(simulated(experiment, body, spin=False, tilt=True)), shape_alone)


def _beyond(both: Source, one: Source) -> Source:
    assert both.errors is not None
    assert one.errors is not None
    kept = ~np.isnan(both.errors[:, 0]) & ~np.isnan(one.errors[:, 0])
    there, here = _source(both.errors[kept]), _source(one.errors[kept])
    return Source(
        there.bias - here.bias, there.covariance - here.covariance, both.errors[kept], one.errors[kept]
    )


def _source(errors: Array) -> Source:
    known = errors[~np.isnan(errors[:, 0])]
    return Source(known.mean(axis=0), np.atleast_2d(np.cov(known, rowvar=False)), errors)


@reported_elsewhere()
def simulated(experiment: Experiment, body: Body, *, spin: bool, tilt: bool) -> Array:
    """Return errors of ε of many drops by times alone, shape (m, n); NaN for those that are left out.

    Every law of the experiment has as many drops, m/laws, at the same angles.

    Raises
    ------
    ValueError
        If too few particles bounce as often as asked.
    """
    return np.vstack([_simulated(experiment, law, body, spin=spin, tilt=tilt) for law in experiment.laws])


def _simulated(experiment: Experiment, law: Law, body: Body, *, spin: bool, tilt: bool) -> Array:
    setting = experiment.setting
    angle = setting.tilt if tilt else 0.0
    n = setting.impacts
    with in_terms_of(drop=setting.drop, gravity=setting.gravity, spin=setting.spin):
        run = simulate(
            body,
            law,
            particles=setting.particles,
            impacts=n + 1,
            # Heights of fall are measured along the vertical, distances from the plane along its normal.
            release_height=mean_radius(body) + setting.drop * math.cos(angle),
            gravity=setting.gravity,
            spin=RandomSpin(rate=setting.spin) if spin else None,
            incline=angle,
            seed=setting.seed,
        )
    g = setting.gravity
    heard = np.empty((setting.particles, n + 1))
    heard[:, 0] = math.sqrt(2.0 * g * setting.drop)
    heard[:, 1:] = 0.5 * g * run.time.diff("impact").values
    kept = np.all(heard[:, 1:] > _SHORTEST * (experiment.coefficient * experiment.speed), axis=1)
    if kept.mean() < _LEAST_KEPT:
        counts = 100.0 * kept.mean()
        text = (
            f" = {n}, drop = {setting.drop:g}: only {counts:.0f} % of such balls bounce so often with "
            "resolved flights; must be fewer, or the body rounder"
        )
        raise ParameterError(Problem("impacts", text))
    heard[~kept] = np.nan
    told = at(experiment.law, heard[:, :-1])
    return np.asarray(heard[:, 1:] / heard[:, :-1] - told)
