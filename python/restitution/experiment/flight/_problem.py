"""Least squares and likelihood of a law ε_n(v), with the covariance of the measurement."""

from functools import lru_cache
from types import MappingProxyType
from typing import Literal

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve, solve_triangular
from scipy.optimize import least_squares, minimize

from restitution._internal.parameters import ParameterError, Problem
from restitution.experiment.flight._law_fit import LawFit
from restitution.experiment.flight.chain import COMMON, Chain, Measured, chain
from restitution.experiment.flight.laws import LawOfSpeed, by_parameters, by_speed

Array = npt.NDArray[np.float64]

_REFUTED = 16.0
"""χ² for each coefficient from which a law is not fitted further."""
_MOST_EXPANSIONS = 10
"""Three are enough where errors are small beside intervals."""


def joined(experiments: list[Measured], shift: Array | None) -> Chain:
    """Put series one after the other, their numbers moved by `shift`.

    The times are each series' own, and so is the height of the drop; g, drag and contact time are common.
    """
    if (
        len(
            {
                (one.gravity, one.terminal, one.contact, *one.variances[[-COMMON, -2, -1]])
                for one in experiments
            }
        )
        != 1
    ):
        raise ParameterError(
            Problem("data", ": series with different g, drag or contact time; must have the same")
        )
    sizes = [one.times.size for one in experiments]
    total = sum(sizes)
    columns = total + len(experiments) + COMMON - 1
    before, after = np.empty(total), np.empty(total)
    before_by, after_by = np.zeros((total, columns)), np.zeros((total, columns))
    variances = np.zeros(columns)
    row = 0
    for number, (one, size) in enumerate(zip(experiments, sizes, strict=True)):
        rows = slice(row, row + size)
        places = [*range(row, row + size), total, total + COMMON - 1 + number, total + 1, total + 2]
        part = chain(one if shift is None else one.moved(shift[places]))
        before[rows], after[rows] = part.before, part.after
        before_by[rows, places] = part.before_by
        after_by[rows, places] = part.after_by
        variances[places] = part.variances
        row += size
    return Chain(before, after, before_by, after_by, variances)


def _spread(logarithm: float) -> float:
    """Return a scatter limited to 1e-10 to 150, from none that matters to more than any series has."""
    return float(np.exp(np.clip(logarithm, -23.0, 5.0)))


_IMPOSSIBLE = 1e300


class Misfit:
    """Residuals of the impacts that are known, and their covariance, for one law.

    Residuals are expanded about numbers that differ by `shift` from those measured; after a fit, `improve`
    takes for these the most probable true ones. Where that converges, χ² is that of the times themselves.
    """

    def __init__(self, form: LawOfSpeed, experiments: list[Measured], known: npt.NDArray[np.bool_]) -> None:
        self.form, self.experiments, self.known = form, experiments, known
        self.expand(None)

    def expand(self, shift: Array | None) -> None:
        links, known = joined(self.experiments, shift), self.known
        self.before, self.after = links.before[known], links.after[known]
        self.before_by, self.after_by = links.before_by[known], links.after_by[known]
        self.variances = links.variances
        self.shift = np.zeros_like(links.variances) if shift is None else shift
        # Likelihood and information ask for both at each point of a search.
        self._jacobian = lru_cache(1)(self._jacobian_at)
        self._covariance = lru_cache(1)(self._covariance_at)

    @property
    def errors_are_known(self) -> bool:
        return bool(np.all((self.after_by**2 @ self.variances) > 0.0))

    def jacobian(self, values: Array) -> Array:
        """Differentiate the residuals by the numbers measured."""
        return self._jacobian(tuple(values))

    def _jacobian_at(self, point: tuple[float, ...]) -> Array:
        values = np.array(point)
        slope = (
            self.form.coefficient(self.before, values)
            + by_speed(self.form, self.before, values) * self.before
        )
        return np.asarray(self.after_by - slope[:, None] * self.before_by)

    def residual(self, values: Array) -> Array:
        there = self.after - self.form.coefficient(self.before, values) * self.before
        return np.asarray(there - self.jacobian(values) @ self.shift)

    def covariance(self, values: Array, scatter: float) -> Array:
        """Return the covariance of the residuals, shape (n, n)."""
        return self._covariance(tuple(values), scatter)

    def _covariance_at(self, values: tuple[float, ...], scatter: float) -> Array:
        by = self._jacobian(values)
        return np.asarray((by * self.variances) @ by.T + np.diag((scatter * self.before) ** 2))

    def improve(self, values: Array, scatter: float) -> bool:
        """Expand about the most probable true values; return whether they changed much."""
        by = self.jacobian(values)
        pull = np.linalg.solve(self.covariance(values, scatter), self.residual(values))
        shift = -self.variances * (by.T @ pull)
        moved = np.abs(shift - self.shift) > 1e-3 * np.sqrt(self.variances)
        self.expand(shift)
        return bool(np.any(moved))

    def whitened(self, values: Array, scatter: float) -> Array:
        lower = np.linalg.cholesky(self.covariance(values, scatter))
        return np.asarray(solve_triangular(lower, self.residual(values), lower=True))

    def loglikelihood(self, values: Array, scatter: float) -> float:
        """Of the times; where they alone err, the determinant belongs to the times that are eliminated."""
        misfit = float(np.sum(self.whitened(values, scatter) ** 2))
        if scatter == 0.0:
            return -0.5 * misfit
        _, logarithm = np.linalg.slogdet(self.covariance(values, scatter))
        return -0.5 * (misfit + float(logarithm))

    def information(self, values: Array, scatter: float) -> Array:
        """Return the information on the parameters, the inverse of their covariance."""
        factor = cho_factor(self.covariance(values, scatter), lower=True)
        slopes = self.before[:, None] * by_parameters(self.form, self.before, values)
        return np.asarray(slopes.T @ cho_solve(factor, slopes))

    def least_squares(self, start: Array, scatter: float) -> Array:
        scale = np.maximum(np.abs(start), 1e-3)

        def misfit(values: Array) -> Array:
            return self.whitened(values, scatter)

        bounds = (self.form.least, np.inf)
        found = least_squares(misfit, start, x_scale=scale, bounds=bounds, xtol=1e-12, ftol=1e-12)
        return np.asarray(found.x)

    def fit(self, scatter: float | Literal["fit"]) -> LawFit:
        values = self.form.start(self.before, self.after / self.before)
        spread, spread_error = 0.0 if scatter == "fit" else float(scatter), 0.0
        for _ in range(_MOST_EXPANSIONS):
            if scatter == "fit":
                values, spread = self._with_scatter(values)
                spread_error = self._scatter_error(values, spread)
            else:
                values = self.least_squares(values, spread)
            # A law that is far from the data would move the times out of their order; it is refuted anyway.
            misfit = float(np.sum(self.whitened(values, spread) ** 2))
            if misfit > _REFUTED * self.before.size or not self.improve(values, spread):
                break
        information = self.information(values, spread)
        # Where no data depend on a parameter, as on a yield speed above all speeds, its error is infinite.
        told = np.linalg.matrix_rank(information) == len(information)
        covariance = np.asarray(np.linalg.inv(information) if told else np.full(information.shape, np.inf))
        residual = self.residual(values)
        names = self.form.parameters
        return LawFit(
            law=self.form.name,
            parameters=MappingProxyType(dict(zip(names, values.tolist(), strict=True))),
            errors=MappingProxyType(dict(zip(names, np.sqrt(np.diag(covariance)).tolist(), strict=True))),
            units=MappingProxyType(dict(zip(names, self.form.units, strict=True))),
            covariance=covariance,
            scatter=spread,
            scatter_error=spread_error,
            impacts=residual.size,
            chi2=float(np.sum(self.whitened(values, spread) ** 2)),
            degrees_of_freedom=residual.size - len(names),
            loglikelihood=self.loglikelihood(values, spread),
            _form=self.form,
        )

    def _with_scatter(self, start: Array) -> tuple[Array, float]:
        """Maximise the restricted likelihood over the parameters and the logarithm of the scatter.

        Residuals about a fitted law are smaller than those about the true one: without the determinant of
        the information on the parameters the scatter, and all errors with it, would come out too small.
        """
        rough = np.std((self.after / self.before) - self.form.coefficient(self.before, start))
        first = np.append(start, np.log(max(float(rough), 1e-8)))
        scale = np.append(np.maximum(np.abs(start), 1e-3), 1.0)

        def loss(point: Array) -> float:
            values = point * scale
            if np.any(values[:-1] < self.form.least):
                return _IMPOSSIBLE
            try:
                scatter = _spread(values[-1])
                _, determinant = np.linalg.slogdet(self.information(values[:-1], scatter))
                value = 0.5 * float(determinant) - self.loglikelihood(values[:-1], scatter)
            except (np.linalg.LinAlgError, ValueError):
                return _IMPOSSIBLE
            return value if np.isfinite(value) else _IMPOSSIBLE

        found = minimize(
            loss,
            first / scale,
            method="Nelder-Mead",
            options={"xatol": 1e-7, "fatol": 1e-9, "maxiter": 4000, "maxfev": 4000},
        )
        values = found.x * scale
        return values[:-1], _spread(values[-1])

    def _scatter_error(self, values: Array, scatter: float) -> float:
        """Return the standard error of the scatter, from its information (1/2) tr (C⁻¹ dC/dσ)²."""
        weighted = cho_solve(
            cho_factor(self.covariance(values, scatter), lower=True), np.diag(2.0 * scatter * self.before**2)
        )
        return float(1.0 / np.sqrt(0.5 * np.trace(weighted @ weighted)))
