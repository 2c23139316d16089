"""The likelihood on a grid of parameters, and between its points."""

import functools
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import Akima1DInterpolator, RegularGridInterpolator

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.parameters import ParameterError, Problem
from restitution.experiment.flight.chain import USUAL_BETWEEN
from restitution.experiment.inference._family import Family
from restitution.experiment.inference._likelihood import Density, averaged, scatters_between, together
from restitution.experiment.inference._series import Series

_GRID = 61
"""Values of the parameter of ε_n."""
_NO_SCATTER = 1e-6
"""A scatter of ε_n as small as this is taken to be none."""
_NOISES = 2
"""Times each simulated drop is timed."""
_FINER = 4
"""Points between those that are simulated: of many drops the likelihood is narrow."""


@dataclass(frozen=True)
class Table:
    """Logarithm of the likelihood.

    Its axes are the parameter of ε_n, ln L/R, and where they are inferred ln of the scatter and the friction.
    """

    axes: tuple[Array, ...]
    values: Array  # over these axes
    signs: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0)  # as of `Density.beyond`, were the best ball true
    best: float = 0.0  # the largest logarithm of a likelihood
    noise: float = 0.0  # the variance of that logarithm if other drops had been simulated

    def between(self) -> RegularGridInterpolator:
        """Interpolate linearly."""
        return RegularGridInterpolator(self.axes, self.values)

    def draws(self, number: int, rng: np.random.Generator) -> tuple[Array, Array]:
        """Return independent draws of exp of what is interpolated, and ln of it: shapes (n, p) and (n,).

        A cell is chosen by its volume times the largest value at its corners, which nothing inside exceeds,
        and a point in it is kept in proportion to the value there.
        """
        most = self.values
        for place in range(most.ndim):
            count = most.shape[place]
            lower, upper = (most.take(range(k, count - 1 + k), axis=place) for k in (0, 1))
            most = np.maximum(lower, upper)
        volume = functools.reduce(np.multiply.outer, (np.diff(axis) for axis in self.axes))
        shares = np.cumsum(volume * np.exp(most - most.max()))
        between = self.between()
        points, logs = np.empty((0, most.ndim)), np.empty(0)
        while len(points) < number:
            cell = np.searchsorted(shares, shares[-1] * rng.random(number), side="right")
            places = np.unravel_index(cell, most.shape)
            corner = np.column_stack([axis[at] for axis, at in zip(self.axes, places, strict=True)])
            far = np.column_stack([axis[at + 1] for axis, at in zip(self.axes, places, strict=True)])
            tried = corner + (far - corner) * rng.random(corner.shape)
            value = between(tried)
            kept = rng.random(number) < np.exp(value - most[places])
            points, logs = np.concatenate([points, tried[kept]]), np.concatenate([logs, value[kept]])
        return points[:number], logs[:number]

    def weighted(self, logarithm: Array) -> "Table":
        """Return the likelihood times a prior along the second axis, whose mean there is made 1."""
        line = self.axes[1]
        weight = np.exp(logarithm - logarithm.max())
        weight = np.log(np.maximum(weight / np.trapezoid(weight, line) * np.ptp(line), 1e-300))
        shaped = weight.reshape(-1, *(1,) * (self.values.ndim - 2))
        return replace(self, values=self.values + shaped)

    def profile(self, axis: int) -> Array:
        """Return the largest value over all other axes."""
        return np.asarray(self.values.max(axis=tuple(k for k in range(self.values.ndim) if k != axis)))

    def log_evidence(self, *ends: int) -> float:
        """Return ln of the mean likelihood for priors uniform along the axes, or at the low ends of some.

        Along the first, whose length differs from table to table, it is the integral.
        """
        values, axes = self.values, list(self.axes)
        for end in sorted(ends, reverse=True):
            values = np.asarray(values.take(0, axis=end))
            del axes[end]
        largest = float(values.max())
        mean: Any = np.exp(values - largest)
        for line in reversed(axes[1:]):
            mean = np.trapezoid(mean, line, axis=-1) / np.ptp(line)
        mean = np.trapezoid(mean, axes[0], axis=-1)
        return largest + math.log(mean)

    def limit(self, axis: int) -> float:
        """Return the upper limit, 95 %, of what an axis has the logarithm of, uniform from 0.

        It gives equal intervals equal weight, and so does not depend on where a prior in the logarithm ends.
        Below the low end all is as likely as there.
        """
        marginal: Any = np.moveaxis(np.exp(self.values - self.values.max()), axis, 0)
        for place in reversed([k for k in range(self.values.ndim) if k != axis]):
            marginal = np.trapezoid(marginal, self.axes[place], axis=-1)
        value = np.concatenate([[0.0], np.exp(self.axes[axis])])
        below = cumulative_trapezoid(np.concatenate([marginal[:1], marginal]), value, initial=0)
        return float(np.interp(0.95 * below[-1], below, value))


def table(
    series: Sequence[Series],
    family: Family,
    simulated: Callable[[Series, float, float, float | None, int], Array],
    nodes: Array,
    scatters: Sequence[float | None],
    frictions: Sequence[float | None],
    particles: int,
    seed: int,
) -> Table:
    """Simulate at every node, scatter of ε_n and friction.

    Simulated are flights of a series with the parameter of ε_n, the node, the friction and a seed.

    What the numbers of a series are, less the true parameter, hardly depends on the parameter: they are
    simulated at one value of it, that which the series have by least squares. All nodes have the same random
    numbers: what these do to the likelihood of a series would else be a peak at some node.
    """
    middle = family.inside(float(np.mean([one.observed[0] for one in series])))
    low, high = family.range
    noise = [one.noise(_NOISES * particles, seed + 7 * k) for k, one in enumerate(series)]
    unseen = max(_NO_SCATTER, min(one.unseen for one in series))
    widths = [0.0 if scatter is None or scatter <= unseen else scatter for scatter in scatters]
    distinct, places = np.unique(widths, return_inverse=True)  # some scatters are the same, none
    densities: list[list[Density]] = []
    for x, mu in product(nodes, frictions):
        flights = [simulated(one, middle, float(x), mu, seed + 7 * k) for k, one in enumerate(series)]
        for width in distinct:
            drops = zip(series, flights, noise, strict=True)
            densities.append(
                [Density(one.heard(flight, width, off), middle, one.observed) for one, flight, off in drops]
            )
    width, narrow = _widths(series, densities)
    taus, weights = np.zeros(1), np.ones(1)
    if len(series) > 1:
        # The scale of the prior of what lies between them, in units of the parameter.
        usual = USUAL_BETWEEN / float(np.mean([np.abs(one.slopes).mean() for one in series]))
        taus, weights = scatters_between(usual, narrow)
        width = max(width, usual, float(np.ptp([one.observed[0] for one in series])))
    # Fine where the best balls determine the parameter well, extended to where the worst do.
    steep = np.arcsinh(6.0 * width / narrow)
    grid = middle + narrow * np.sinh(steep * np.linspace(-1.0, 1.0, _GRID))
    grid = np.unique(np.clip(grid, low, high))
    logs = np.array([averaged(together(each, series, grid, taus), weights) for each in densities])
    best = densities[int(np.argmax(logs.max(axis=1)))]
    shares = np.array([d.beyond(one.observed) for d, one in zip(best, series, strict=True)])
    signs = np.minimum(1.0, len(shares) * shares.min(axis=0))  # the least of several
    # Of one simulated drop, timed several times, the numbers are nearly the same.
    variance = _NOISES * sum(d.variance(one.observed) for d, one in zip(best, series, strict=True))
    logs = logs.reshape(-1, distinct.size, grid.size)[:, places].reshape(-1, grid.size)
    values = logs.T.reshape(grid.size, len(nodes), len(frictions), len(scatters)).swapaxes(2, 3)
    axes: list[Array] = [grid, np.log(nodes)]
    values, axes[1] = _finer(values, axes[1], 1)
    if scatters[0] is None:
        values = values[:, :, 0]
    else:
        values, finer = _finer(values, np.log(np.array(scatters, dtype=np.float64)), 2)
        axes.append(finer)
    if frictions[0] is None:
        values = values[..., 0]
    else:
        axes.append(np.array(frictions, dtype=np.float64))
    return Table(tuple(axes), values, tuple(signs), float(values.max()), variance)


def _finer(values: Array, axis: Array, place: int) -> tuple[Array, Array]:
    """Interpolate along an axis of equal steps by Akima's rule, which is exact for parabolas."""
    if axis.size < 2:
        return values, axis
    fine = np.linspace(axis[0], axis[-1], _FINER * (axis.size - 1) + 1)
    return np.asarray(Akima1DInterpolator(axis, values, axis=place)(fine)), fine


def _widths(series: Sequence[Series], densities: list[list[Density]]) -> tuple[float, float]:
    """Return the largest and the smallest scale of the parameter among balls that the series allow.

    Each series may have a parameter of its own.
    """
    offsets = np.linspace(-3.0, 3.0, 25)
    best, scales = [], []
    for each in densities:
        if not all(one.enough for one in each):
            continue
        own = [d(one.observed, d.truths(one.observed, offsets)) for d, one in zip(each, series, strict=True)]
        best.append(float(np.sum(np.max(own, axis=1))))
        shift = float(np.mean([one.middle for one in each]))
        scales.append(min(one.scale for one in each) + abs(shift) / 3.0)
    if not best:
        text = ": no ball of these shapes bounces as often as this under the law, with its coefficients"
        raise ParameterError(Problem("data", text))
    allowed = [scale for scale, value in zip(scales, best, strict=True) if value > max(best) - 12.0]
    return max(allowed), min(allowed)
