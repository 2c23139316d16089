"""Least squares and likelihood of a law ε_n(v), with the covariance of the measurement."""

from collections.abc import Callable
from functools import lru_cache
from itertools import product
from types import MappingProxyType
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.linalg import cho_factor, cho_solve, solve_triangular
from scipy.optimize import least_squares, minimize

from restitution._internal.arrays import FloatArray as Array
from restitution.experiment.flight._law_fit import LawFit
from restitution.experiment.flight.chain import COMMON, USUAL_BETWEEN, Measured, joined
from restitution.experiment.flight.laws import LawOfSpeed, by_parameters, by_speed
from restitution.experiment.flight.separation import DECIDED

_REFUTED = 16.0
"""χ² for each coefficient from which a law is not fitted further."""
_MOST_EXPANSIONS, _MOST_STEPS = 10, 30
"""Three are enough where errors are small beside intervals; and steps of Gauss and Newton."""


def _spread(logarithm: float) -> float:
    """Return a scatter limited to 1e-10 to 150, from none that matters to more than any series has."""
    return float(np.exp(np.clip(logarithm, -23.0, 5.0)))


_IMPOSSIBLE = 1e300
_AVERAGED = 8.0
"""Drop of the logarithm of the likelihood down to which scatters are averaged over."""
_STEPS = np.linspace(0.0, 1.0, 13)


class Scatter(NamedTuple):
    """Standard deviations of ε that no error explains: of each impact, each series and each group of them."""

    one: float
    between: float = 0.0
    groups: float = 0.0


NONE = Scatter(0.0)


class Restricted(NamedTuple):
    """A restricted likelihood, by its logarithm; the step to the best parameters; the information on them."""

    value: float
    move: Array
    information: Array


def _with_term(products: Array, width: float) -> tuple[Array, float]:
    """Return AᵀC⁻¹A and ln det C/D of each, where C is D and a term of this width along the last column.

    By the formulas of Sherman and Morrison, and of Sylvester.
    """
    last = products[:, :, -1]
    more = 1.0 + width**2 * last[:, -1]
    changed = products - width**2 * last[:, :, None] * last[:, None, :] / more[:, None, None]
    return changed, float(np.log(more).sum())


def _finite(value: Callable[[], float]) -> float:
    """Return a value, and a large one where there is none."""
    try:
        found = value()
    except (np.linalg.LinAlgError, ValueError):
        return _IMPOSSIBLE
    return found if np.isfinite(found) else _IMPOSSIBLE


class Misfit:
    """Residuals of the impacts that are known, and their covariance, for one law.

    Residuals are expanded about numbers that differ by `shift` from those measured; after a fit, `improve`
    takes for these the most probable true ones. Where that converges, χ² is that of the times themselves.
    """

    def __init__(
        self,
        form: LawOfSpeed,
        experiments: list[Measured],
        known: npt.NDArray[np.bool_],
        groups: npt.NDArray[np.intp] | None = None,
    ) -> None:
        self.form, self.experiments, self.known = form, experiments, known
        self.number = np.repeat(np.arange(len(experiments)), [one.times.size for one in experiments])[known]
        self.series = np.unique(self.number).size
        self.groups = groups
        self.expand(None)

    def expand(self, shift: Array | None) -> None:
        links, known = joined(self.experiments, shift), self.known
        self.before, self.after = links.before[known], links.after[known]
        self.before_by, self.after_by = links.before_by[known], links.after_by[known]
        self.variances = links.variances
        self.shift = np.zeros_like(links.variances) if shift is None else shift
        # Likelihood and information ask for these at each point of a search.
        self._jacobian = lru_cache(1)(self._jacobian_at)
        self._products = lru_cache(1)(self._products_at)

    @property
    def errors_are_known(self) -> bool:
        """Of the times: one of g or of the clock moves all coefficients together."""
        times = self.variances.size - (COMMON - 1) - len(self.experiments)
        return bool(np.all((self.after_by[:, :times] ** 2 @ self.variances[:times]) > 0.0))

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

    def covariance(self, values: Array, scatter: Scatter) -> Array:
        """Return the covariance of the residuals, shape (n, n)."""
        by = self.jacobian(values)
        number = self.number
        own = np.diag(np.full(number.size, scatter.one**2)) + scatter.between**2 * (number[:, None] == number)
        if self.groups is not None:
            group = self.groups[number]
            own += scatter.groups**2 * (group[:, None] == group)
        return np.asarray((by * self.variances) @ by.T + own * np.outer(self.before, self.before))

    def improve(self, values: Array, scatter: Scatter) -> bool:
        """Expand about the most probable true values; return whether they changed much."""
        by = self.jacobian(values)
        pull = np.linalg.solve(self.covariance(values, scatter), self.residual(values))
        shift = -self.variances * (by.T @ pull)
        moved = np.abs(shift - self.shift) > 1e-3 * np.sqrt(self.variances)
        self.expand(shift)
        return bool(np.any(moved))

    def whitened(self, values: Array, scatter: Scatter) -> Array:
        lower = np.linalg.cholesky(self.covariance(values, scatter))
        return np.asarray(solve_triangular(lower, self.residual(values), lower=True))

    def loglikelihood(self, values: Array, scatter: Scatter) -> float:
        """Of the times; where they alone err, the determinant belongs to the times that are eliminated."""
        misfit = float(np.sum(self.whitened(values, scatter) ** 2))
        if scatter == NONE:
            return -0.5 * misfit
        _, logarithm = np.linalg.slogdet(self.covariance(values, scatter))
        return -0.5 * (misfit + float(logarithm))

    def information(self, values: Array, scatter: Scatter) -> Array:
        """Return the information on the parameters, the inverse of their covariance."""
        factor = cho_factor(self.covariance(values, scatter), lower=True)
        slopes = self.before[:, None] * by_parameters(self.form, self.before, values)
        return np.asarray(slopes.T @ cho_solve(factor, slopes))

    def least_squares(self, start: Array, scatter: Scatter) -> Array:
        scale, bounds = np.maximum(np.abs(start), 1e-3), (self.form.least, np.inf)
        found = least_squares(
            self.whitened, start, args=(scatter,), x_scale=scale, bounds=bounds, xtol=1e-12, ftol=1e-12
        )
        return np.asarray(found.x)

    def fit(self, scatter: float | Literal["fit"]) -> LawFit:
        values = self.form.start(self.before, self.after / self.before)
        spread = NONE if scatter == "fit" else Scatter(float(scatter))
        for _ in range(_MOST_EXPANSIONS):
            if scatter == "fit":
                values, spread = self._with_scatter(values)
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
        spread_error = NONE
        if scatter == "fit":
            spread_error = Scatter(self._scatter_error(values, spread))
            if told:
                covariance, spread_error = self._averaged(values, spread, spread_error, covariance)
        residual = self.residual(values)
        names = self.form.parameters
        return LawFit(
            law=self.form.name,
            parameters=MappingProxyType(dict(zip(names, values.tolist(), strict=True))),
            errors=MappingProxyType(dict(zip(names, np.sqrt(np.diag(covariance)).tolist(), strict=True))),
            units=MappingProxyType(dict(zip(names, self.form.units, strict=True))),
            covariance=covariance,
            scatter=spread.one,
            scatter_error=spread_error.one,
            between=spread.between,
            between_error=spread_error.between,
            between_groups=spread.groups,
            between_groups_error=spread_error.groups,
            impacts=residual.size,
            chi2=float(np.sum(self.whitened(values, spread) ** 2)),
            degrees_of_freedom=residual.size - len(names),
            loglikelihood=self.loglikelihood(values, spread),
            _form=self.form,
        )

    def _with_scatter(self, start: Array) -> tuple[Array, Scatter]:
        """Maximise the restricted likelihood over the parameters and the logarithms of the scatters.

        Residuals about a fitted law are smaller than those about the true one: without the determinant of
        the information on the parameters the scatter, and all errors with it, would come out too small.
        """
        rough = np.std((self.after / self.before) - self.form.coefficient(self.before, start))
        first = float(np.log(max(float(rough), 1e-8)))
        if self.series > 1:  # of many coefficients, for which each parameter takes long

            def of_scatters(point: Array) -> float:
                return _finite(lambda: -self._restricted(start, Scatter(*map(_spread, point))).value)

            point = [first, first - 1.0] + [first - 1.0] * (self.groups is not None)
            best = minimize(of_scatters, point, method="Nelder-Mead", options={"fatol": 1e-6})
            spread, values = Scatter(*map(_spread, best.x)), start
            for _ in range(_MOST_STEPS):
                move = self._restricted(values, spread).move
                values = np.maximum(values + move, self.form.least)
                if np.all(np.abs(move) <= 1e-9 * np.abs(values)):
                    break
            return values, spread
        scale = np.append(np.maximum(np.abs(start), 1e-3), 1.0)

        def loss(point: Array) -> float:
            values = point * scale
            if np.any(values[:-1] < self.form.least):
                return _IMPOSSIBLE
            there = Scatter(_spread(values[-1]))
            return _finite(lambda: -self._restricted(values[:-1], there, step=False).value)

        found = minimize(
            loss,
            np.append(start, first) / scale,
            method="Nelder-Mead",
            options={"xatol": 1e-7, "fatol": 1e-9, "maxiter": 4000, "maxfev": 4000},
        )
        values = found.x * scale
        return values[:-1], Scatter(_spread(values[-1]))

    @property
    def _common(self) -> slice:
        """Numbers that all series share, in the order of `joined`."""
        first = self.variances.size - len(self.experiments) - (COMMON - 1)
        return slice(first, first + COMMON - 1)

    def _products_at(self, values: tuple[float, ...], one: float) -> tuple[Array, float]:
        """Return AᵀD⁻¹A of each series, and ln det D of all: D has the errors of its times, its drop and ε.

        The columns of A are residuals, their derivatives by the parameters and by the common numbers, and the
        speeds, as which a term of the series acts.
        """
        point = np.array(values)
        by = self._jacobian(values)
        slopes = self.before[:, None] * by_parameters(self.form, self.before, point)
        columns = np.column_stack([self.residual(point), slopes, by[:, self._common], self.before])
        own = self.variances.copy()
        own[self._common] = 0.0
        products, logarithm = [], 0.0
        for number in np.unique(self.number):
            rows = self.number == number
            covariance = (by[rows] * own) @ by[rows].T + np.diag((one * self.before[rows]) ** 2)
            lower = np.linalg.cholesky(covariance)
            white = solve_triangular(lower, columns[rows], lower=True)
            products.append(white.T @ white)
            logarithm += 2.0 * float(np.log(np.diag(lower)).sum())
        return np.stack(products), logarithm

    def _restricted(self, values: Array, scatter: Scatter, *, step: bool = True) -> Restricted:
        """Return the logarithm of the restricted likelihood, with the prior of what lies between series.

        With `step` it is that of the parameters that are best with this scatter, by one step from the values.
        """
        products, logarithm = self._products(tuple(values), scatter.one)
        products, more = _with_term(products, scatter.between)
        logarithm += more
        if self.groups is not None:
            group = self.groups[np.unique(self.number)]
            products = np.stack([products[group == each].sum(axis=0) for each in np.unique(group)])
            products, more = _with_term(products, scatter.groups)
            logarithm += more
        total = products.sum(axis=0)[:-1, :-1]
        free = len(values)
        common = slice(free + 1, None)
        inner = np.eye(COMMON - 1) + self.variances[self._common][:, None] * total[common, common]
        total = total - total[:, common] @ np.linalg.solve(
            inner, self.variances[self._common][:, None] * total[common]
        )
        logarithm += float(np.linalg.slogdet(inner)[1])
        information, pull = total[1 : free + 1, 1 : free + 1], total[1 : free + 1, 0]
        value = -0.5 * (float(total[0, 0]) + logarithm + float(np.linalg.slogdet(information)[1]))
        for width in (scatter.between, scatter.groups):
            value -= float(np.log1p((width / USUAL_BETWEEN) ** 2))
        if not step:
            return Restricted(value, np.zeros_like(values), information)
        move = np.asarray(np.linalg.solve(information, pull), dtype=np.float64)
        return Restricted(value + 0.5 * float(pull @ move), move, information)

    def _averaged(
        self, values: Array, best: Scatter, error: Scatter, covariance: Array
    ) -> tuple[Array, Scatter]:
        """Average over scatters that are not excluded, uniform from 0: of one impact if 0 is not excluded.

        With the one best scatter, which may be 0, the errors of the parameters would be too small.
        """

        def value(**change: float) -> float:
            return self._restricted(values, best._replace(**change)).value

        def reach(name: str) -> Array:
            """Return scatters of one kind up to where they are excluded."""
            top = max(getattr(best, name), 1e-6)
            while top < 1.0 and value(**{name: top}) > largest - _AVERAGED:
                top *= 1.5
            return np.asarray(top * _STEPS)

        largest = value()
        # Without errors of the times there is a scatter.
        excluded = not self.errors_are_known or 2.0 * (largest - value(one=0.0)) > DECIDED
        if excluded and self.series == 1:
            return covariance, error
        ones = np.array([best.one]) if excluded else reach("one")
        betweens = reach("between") if self.series > 1 else np.zeros(1)
        groups = reach("groups") if self.groups is not None else np.zeros(1)
        pairs = [Scatter(*each) for each in product(ones, betweens, groups)]
        found = [self._restricted(values, each) for each in pairs]
        weights = np.exp([each.value - largest for each in found])
        weights /= weights.sum()
        inside = [np.linalg.inv(each.information) + np.outer(each.move, each.move) for each in found]
        off = np.sqrt(weights @ (np.array(pairs) - best) ** 2)
        own = error.one if excluded else float(off[0])
        return np.einsum("k,kij->ij", weights, np.array(inside)), Scatter(own, *off[1:].tolist())

    def _scatter_error(self, values: Array, scatter: Scatter) -> float:
        """Return the standard error of the scatter, from its information (1/2) tr (C⁻¹ dC/dσ)²."""
        weighted = cho_solve(
            cho_factor(self.covariance(values, scatter), lower=True),
            np.diag(2.0 * scatter.one * self.before**2),
        )
        return float(1.0 / np.sqrt(0.5 * np.trace(weighted @ weighted)))
