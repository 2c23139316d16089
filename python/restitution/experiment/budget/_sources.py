"""Sources of error and their effect on the coefficients of a series: a bias and a covariance."""

import math
from dataclasses import dataclass

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
    """Errors of the coefficients of a series of n."""

    bias: Array  # mean of the measured ε less ε_n at the measured speed, shape (n,)
    covariance: Array  # of the measured ε about that mean, shape (n, n)
    errors: Array | None = None  # of simulated drops, shape (particles, n)
    without: Array | None = None  # of the drops whose mean and covariance were taken off, the same shape

    def carried(self, by: Array) -> dict[str, Array]:
        """Carry the errors on to m quantities that change by `by`, shape (m, n), with those of ε.

        Returns
        -------
        dict of ndarray, shape (m,)
            Bias and standard deviation of each, and their standard errors by sampling.
        """
        bias = by @ self.bias
        variance = np.einsum("ij,jk,ik->i", by, self.covariance, by)
        deviation = np.sqrt(np.maximum(variance, 0.0))
        found = {"bias": bias, "standard_deviation": deviation}
        if self.errors is None:
            zero = np.zeros_like(bias)
            return found | {"bias_error": zero, "standard_deviation_error": zero}
        values = self.errors @ by.T
        squares = (values - values.mean(axis=0)) ** 2
        if self.without is not None:
            # The same balls at the same angles: in the difference much of the sampling error is gone.
            before = self.without @ by.T
            squares = squares - (before - before.mean(axis=0)) ** 2
            values = values - before
        root = np.sqrt(len(values))
        error = squares.std(axis=0) / root
        known = np.minimum(error / (2.0 * np.maximum(deviation, 1e-300)), np.sqrt(error))
        return found | {"bias_error": values.std(axis=0) / root, "standard_deviation_error": known}


def unbiased(covariance: Array) -> Source:
    """Return a source whose errors have the mean 0."""
    return Source(np.zeros(len(covariance)), covariance)


def nothing(n: int) -> Source:
    """Return a source without error."""
    return unbiased(np.zeros((n, n)))


def timing(experiment: Experiment) -> Source:
    """Take independent errors of the times; the bias of a quotient is of second order in them."""
    error = experiment.setting.timing
    flights = np.diff(experiment.times)
    before, after = flights[:-1], flights[1:]
    bias = np.zeros(experiment.speed.size)
    # ⟨b/a⟩ - b/a = (b/a) var(a)/a² - cov(a, b)/a², with var = 2 s² and cov = -s² of neighbours.
    bias[1:] = (2.0 * after / before + 1.0) * (error / before) ** 2
    return Source(bias, experiment.covariance(timing=error))


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
    by = experiment.derivatives[:, -2]
    bias = np.zeros_like(by) if corrected else -by * time.at_1_m_s
    return Source(bias, np.outer(by, by) * time.uncertainty**2)


def _with_drag(experiment: Experiment, terminal: float) -> Array:
    """Return ε from times of flight without drag correction, minus the law at the inferred speed."""
    g = experiment.setting.gravity
    speed = fall(experiment.setting.drop, g, terminal).speed
    told = [math.sqrt(2.0 * g * experiment.setting.drop)]
    for _ in range(experiment.setting.impacts):
        duration, speed = launched(float(at(experiment.law, np.array(speed))) * speed, g, terminal)
        told.append(0.5 * g * duration)
    heard = np.array(told)
    return np.asarray(heard[1:] / heard[:-1] - at(experiment.law, heard[:-1]))


def shape(experiment: Experiment, body: Body) -> Source:
    """Take the shape alone: released at rest at random angles over a level plane, timed without error."""
    return _source(simulated(experiment, body))


def added(
    experiment: Experiment, body: Body, alone: Source, *, spin: float = 0.0, tilt: float = 0.0
) -> Source:
    """Find what a spin at release in rad/s, or a plate inclined by an angle, adds to the shape alone."""
    if spin == tilt == 0.0:
        return nothing(experiment.speed.size)
    both, one = simulated(experiment, body, spin=spin, tilt=tilt), alone.errors
    assert one is not None
    kept = ~np.isnan(both[:, 0]) & ~np.isnan(one[:, 0])
    there, here = _source(both[kept]), _source(one[kept])
    return Source(there.bias - here.bias, there.covariance - here.covariance, there.errors, here.errors)


def _source(errors: Array) -> Source:
    known = errors[~np.isnan(errors[:, 0])]
    return Source(known.mean(axis=0), np.atleast_2d(np.cov(known, rowvar=False)), errors)


@reported_elsewhere()
def simulated(experiment: Experiment, body: Body, *, spin: float = 0.0, tilt: float = 0.0) -> Array:
    """Return errors of ε of many drops by times alone, shape (m, n); NaN for those that are left out.

    Every law of the experiment has as many drops, m/laws, at the same angles.

    Raises
    ------
    ValueError
        If too few particles bounce as often as asked.
    """
    return np.vstack([_simulated(experiment, law, body, spin, tilt) for law in experiment.laws])


def _simulated(experiment: Experiment, law: Law, body: Body, spin: float, tilt: float) -> Array:
    setting = experiment.setting
    n = setting.impacts
    with in_terms_of(drop=setting.drop, gravity=setting.gravity, spin=setting.spin):
        run = simulate(
            body,
            law,
            particles=setting.particles,
            impacts=n + 1,
            # Heights of fall are measured along the vertical, distances from the plane along its normal.
            release_height=mean_radius(body) + setting.drop * math.cos(tilt),
            gravity=setting.gravity,
            spin=RandomSpin(rate=spin) if spin else None,
            incline=tilt,
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
