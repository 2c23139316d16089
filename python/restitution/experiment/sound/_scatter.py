"""The scatter of times of impacts about flights whose ratio changes slowly."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

Array = npt.NDArray[np.float64]
Whole = npt.NDArray[np.int64]

FEWEST = 4
"""Impacts that are needed to estimate a scatter: two ratios of flights, and one mean."""
_SEPARABLE = 12
"""Impacts that are needed to distinguish errors of the clock from changes of the ball."""


@dataclass(frozen=True)
class Scatter:
    """Scatter of the times of a series.

    Attributes
    ----------
    time : float
        Standard deviation of the times, in s, if the ball never changes; a few times that are far off count
        as if they were five standard deviations off.
    jumps, jump_errors : ndarray, shape (n,)
        By how much each time is off, and the standard error of that, in s, if all others are right.
    """

    time: float
    jumps: Array
    jump_errors: Array


@dataclass(frozen=True)
class _Ratios:
    """Logarithms of the ratios of flights, their smooth part, and what errors of times do to them."""

    z: Array
    design: Array
    by: Array

    @property
    def clock(self) -> Array:
        """Covariance of z for times with unit variance."""
        return np.asarray(self.by @ self.by.T)


def _ratios(times: Array) -> _Ratios | None:
    """Take z_i = ln((t_{i+1} - t_i)/(t_i - t_{i-1})), a polynomial in i but for errors; None if too few.

    An error of one time enters three of them, with factors that alternate; a change of the ball enters one.
    """
    flights = np.diff(times)
    with np.errstate(invalid="ignore", divide="ignore"):
        z = np.log(flights[1:] / flights[:-1])
    known = np.isfinite(z)
    n = int(known.sum())
    if n < FEWEST - 2:
        return None
    by = np.zeros((z.size, times.size))
    rows = np.flatnonzero(known)
    by[rows, rows + 2] = 1.0 / flights[rows + 1]
    by[rows, rows + 1] = -1.0 / flights[rows + 1] - 1.0 / flights[rows]
    by[rows, rows] = 1.0 / flights[rows]
    degree = min(2, (n - 1) // 4)
    return _Ratios(z[rows], np.vander(rows / max(z.size - 1, 1), degree + 1), by[rows])


def _spread_out(times: Array, places: Whole) -> Array:
    """Place the times in the series, with NaN where an impact was missed."""
    every = np.full(int(places[-1]) + 1, np.nan)
    every[places] = times
    return every


def scatter(times: Array, places: Whole) -> Scatter | None:
    """Measure the scatter of times, shape (n,), of the impacts with these places. None if too few."""
    ratios = _ratios(_spread_out(times, places))
    if ratios is None:
        return None
    clock, design, z, by = ratios.clock, ratios.design, ratios.z, ratios.by
    residual, _, _ = _whitened(z, design, clock + _small(clock))
    freedom = z.size - design.shape[1]
    # The median of the squares of normal numbers is 0.4549.
    middle = float(np.median(residual**2)) / 0.4549 * z.size / freedom
    variance = float(np.sum(np.minimum(residual**2, 25.0 * middle))) / freedom
    inverse = np.linalg.inv(clock + _small(clock))
    project = inverse - inverse @ design @ np.linalg.solve(design.T @ inverse @ design, design.T @ inverse)
    information = np.einsum("ij,ik,kj->j", by, project, by)
    useful = information > 1e-9 * max(float(information.max()), 1e-300)
    safe = np.where(useful, information, 1.0)
    jumps = np.where(useful, (by.T @ project @ z) / safe, 0.0)
    errors = np.where(useful, np.sqrt(middle / safe), np.inf)
    return Scatter(float(np.sqrt(variance)), jumps[places], errors[places])


class Parts(NamedTuple):
    """Split the scatter of times into its parts.

    Attributes
    ----------
    time : float
        Standard error of the times, in s.
    ball_changes : bool
        Whether changes of the ratio, which are the ball's, scatter the flights more than errors of the
        times do.
    """

    time: float
    ball_changes: bool


def told_apart(times: Array, places: Whole) -> Parts | None:
    """Separate errors of times from changes of the ball; None if there are too few impacts.

    Their covariances differ; the restricted likelihood gives both variances.
    """
    ratios = _ratios(_spread_out(times, places))
    if ratios is None:
        return None
    clock, design, z = ratios.clock, ratios.design, ratios.z
    residual, _, _ = _whitened(z, design, clock + _small(clock))
    alone = float(residual @ residual) / (z.size - design.shape[1])
    if z.size < _SEPARABLE - 2 or alone <= 0.0:
        return Parts(float(np.sqrt(alone)), False)
    middle = float(np.median(np.diag(clock)))
    scale = middle * alone

    def loss(logarithms: Array) -> float:
        of_times, of_ratios = np.exp(np.clip(logarithms, -30.0, 30.0))
        covariance = of_times * alone * clock + of_ratios * scale * np.eye(z.size)
        rest, one, two = _whitened(z, design, covariance + _small(covariance))
        return 0.5 * (float(rest @ rest) + one + two)

    starts = [np.array([0.0, -6.0]), np.array([-1.5, 0.0])]
    found = min(
        (minimize(loss, start, method="Nelder-Mead") for start in starts), key=lambda one: float(one.fun)
    )
    of_times, of_ratios = np.exp(np.clip(found.x, -30.0, 30.0))
    return Parts(float(np.sqrt(of_times * alone)), bool(of_ratios > of_times))


def _small(covariance: Array) -> Array:
    """Return a small diagonal that makes a covariance invertible in spite of rounding."""
    n = covariance.shape[0]
    return np.asarray(1e-9 * np.trace(covariance) / n * np.eye(n))


def _whitened(z: Array, design: Array, covariance: Array) -> tuple[Array, float, float]:
    """Return residuals with unit variance, and the logarithms of both determinants of the likelihood."""
    lower = np.linalg.cholesky(covariance)
    y, x = np.linalg.solve(lower, z), np.linalg.solve(lower, design)
    q, r = np.linalg.qr(x)
    determinant = 2.0 * float(np.sum(np.log(np.diag(lower))))
    return y - q @ (q.T @ y), determinant, 2.0 * float(np.sum(np.log(np.abs(np.diag(r)))))
