"""A table of p(ε | v) with the methods of a scipy.stats distribution."""

import math
from collections.abc import Iterable
from functools import cached_property
from operator import index
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._parameters import ParameterError, wrong
from restitution._resources import available_memory
from restitution.distribution import _store
from restitution.distribution._learn import Given
from restitution.distribution._table import Floats, Table

Values: TypeAlias = Any  # np.float64 for scalar arguments, an array of floats otherwise
RandomState: TypeAlias = int | np.random.Generator | np.random.RandomState | None


class TabulatedDistribution:
    """What `FluctuatingRestitution` evaluates and draws."""

    def __init__(self, data: xr.Dataset) -> None:
        _store.check(data)
        self.data = data

    @property
    def velocities(self) -> tuple[float, float]:
        """Least and greatest learned speed, in m/s."""
        return float(self._table.speeds[0]), float(self._table.speeds[-1])

    @property
    def given(self) -> Given | None:
        """What `given` stands for in the methods."""
        found: Given | None = self.data.attrs.get("given")
        return found

    def pdf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Probability density at ε = x, at impact velocity v."""
        table, z = self._at(given)
        return table.value("pdf", _numbers("x", x), self._speeds(v), z)[()]

    def cdf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Probability that ε <= x."""
        table, z = self._at(given)
        return table.value("cdf", _numbers("x", x), self._speeds(v), z)[()]

    def sf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Probability that ε > x."""
        return (1.0 - np.asarray(self.cdf(x, v, given)))[()]

    def ppf(self, q: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Quantile: the ε with ``cdf(ε, v) = q``; nan unless ``0 <= q <= 1``."""
        table, z = self._at(given)
        return table.value("ppf", _numbers("q", q), self._speeds(v), z)[()]

    def median(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Median of ε."""
        return self.ppf(0.5, v, given)

    def support(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> tuple[Values, Values]:
        """Least and greatest ε."""
        return self.ppf(0.0, v, given), self.ppf(1.0, v, given)

    def mean(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Mean of ε."""
        table, z = self._at(given)
        return table.moments(self._speeds(v), z)[0][()]

    def var(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Variance of ε."""
        table, z = self._at(given)
        return table.moments(self._speeds(v), z)[1][()]

    def std(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Square root of the variance of ε."""
        return np.sqrt(self.var(v, given))

    def rvs(
        self,
        v: npt.ArrayLike,
        size: int | tuple[int, ...] | None = None,
        random_state: RandomState = None,
        given: npt.ArrayLike | None = None,
        threads: int | None = None,
    ) -> Values:
        """Draw independent ε, a hundred million in a few seconds.

        Parameters
        ----------
        v : array_like
            Impact velocity in m/s.
        size : int or tuple of int, optional
            Shape of the result, which `v` and `given` broadcast to; theirs unless told.
        random_state : int, numpy.random.Generator, numpy.random.RandomState, optional
            A seed in [0, 2⁶⁴), or what to draw one from. The same seed gives the same bits with any number of
            threads, and the same first draws whatever the size.
        given : array_like, optional
            Condition.
        threads : int, optional
            One for each core unless told.
        """
        table, z = self._at(given)
        speeds = self._speeds(v)
        own = np.broadcast_shapes(speeds.shape, z.shape)
        shape = own if size is None else _shape(size)
        if shape != own and not _reaches(own, shape):
            raise ParameterError(wrong("size", size, f"a shape that {own} broadcasts to"))
        if 8 * math.prod(shape) > available_memory():
            most = available_memory() // 8
            raise ParameterError(
                wrong("size", size, f"at most {most:.4g} draws, which this machine can hold")
            )
        return table.draw(speeds, z, shape, _seed(random_state), threads)[()]

    def pdf_error(self, x: npt.ArrayLike, v: npt.ArrayLike) -> Values:
        """Give the standard error of `pdf`, at most; nan where the distribution was made from counts alone.

        Batches of particles are the draws, not impacts. Neighbouring nodes share impacts; their errors are
        added as if they were one.
        """
        return self._error(x, v, "probability_error")

    def cdf_error(self, x: npt.ArrayLike, v: npt.ArrayLike) -> Values:
        """Give the standard error of `cdf`, at most, as `pdf_error`."""
        return self._error(x, v, "probability_below_error")

    def mean_error(self, v: npt.ArrayLike) -> Values:
        """Give the standard error of `mean`, at most, as `pdf_error`."""
        return self._moment_error(v, "mean_error")

    def std_error(self, v: npt.ArrayLike) -> Values:
        """Give the standard error of `std`, at most, as `pdf_error`."""
        return self._moment_error(v, "std_error")

    def _moment_error(self, v: npt.ArrayLike, name: str) -> Values:
        speed = self._speeds(v)
        if name not in self.data:
            return np.full(speed.shape, np.nan)[()]
        return np.interp(speed, self._table.speeds, self.data[name].to_numpy())[()]

    def _error(self, x: npt.ArrayLike, v: npt.ArrayLike, name: str) -> Values:
        value, speed = np.broadcast_arrays(_numbers("x", x), self._speeds(v))
        error = np.full(value.shape, np.nan)
        if name not in self.data:
            return error[()]
        errors, start = self.data[name].to_numpy(), self._table.start
        left, share = self._table.weights(speed)
        error[...] = 0.0
        for node, weight in ((left, 1.0 - share), (left + 1, share)):
            for i in np.unique(node):
                here = node == i
                edges = self._table.edges[start[i] : start[i + 1]]
                own = errors[start[i] : start[i + 1]]
                if name == "probability_below_error":
                    found = np.interp(value[here], edges, own)
                else:
                    density = np.concatenate([[0.0], own[:-1] / np.diff(edges), [0.0]])
                    found = density[np.searchsorted(edges, value[here], side="right")]
                error[here] += weight[here] * found
        error[np.isnan(value) | np.isnan(speed)] = np.nan
        return error[()]

    @cached_property
    def _table(self) -> Table:
        return _store.table(self.data)

    @cached_property
    def _conditional(self) -> Table:
        return _store.table(self.data, "given_")

    def _at(self, given: npt.ArrayLike | None) -> tuple[Table, Floats]:
        if given is None:
            return self._table, np.zeros(())
        if self.given is None:
            raise ParameterError(
                wrong("given", given, "None: the distribution was learned without a condition")
            )
        z = _numbers("given", given)
        beyond = (z < 0.0) | (z > 1.0)
        if np.any(beyond):
            raise ParameterError(wrong("given", float(z[beyond].flat[0]), f"in [0, 1], {self.given}"))
        return self._conditional, z

    def _speeds(self, v: npt.ArrayLike) -> Floats:
        speeds = _numbers("v", v)
        low, high = self.velocities
        allowed = f"in [{low!r}, {high!r}] m/s, the speeds that were learned; clamped() takes any"
        if self.data.attrs.get("beyond") == "clamp":
            low, high, allowed = 0.0, np.inf, "a speed, >= 0 m/s"
        beyond = (speeds < low) | (speeds > high)
        if np.any(beyond):
            raise ParameterError(wrong("v", float(speeds[beyond].flat[0]), allowed))
        return speeds


def _numbers(name: str, values: npt.ArrayLike) -> Floats:
    """Give real numbers as an array; what is masked is nan."""
    allowed = "a number or an array of numbers"
    try:
        found = np.ma.asarray(values) if isinstance(values, np.ma.MaskedArray) else np.asarray(values)
    except ValueError as error:
        raise ParameterError(wrong(name, values, allowed)) from error
    if found.dtype.kind not in "buif" and found.size:
        raise ParameterError(wrong(name, values, allowed))
    return np.asarray(np.ma.filled(found.astype(np.float64), np.nan))


def _shape(size: Any) -> tuple[int, ...]:
    try:
        shape = tuple(index(length) for length in (size if isinstance(size, Iterable) else (size,)))
    except TypeError:
        shape = (-1,)
    if isinstance(size, bool) or min(shape, default=0) < 0:
        raise ParameterError(wrong("size", size, "a whole number >= 0 or a tuple of them"))
    return shape


def _reaches(shape: tuple[int, ...], larger: tuple[int, ...]) -> bool:
    try:
        return np.broadcast_shapes(shape, larger) == larger
    except ValueError:
        return False


def _seed(random_state: RandomState) -> int:
    if isinstance(random_state, np.random.RandomState):
        return int.from_bytes(random_state.bytes(8), "little")
    if isinstance(random_state, np.random.Generator) or random_state is None:
        return int(np.random.default_rng(random_state).integers(2**64, dtype=np.uint64, endpoint=False))
    if isinstance(random_state, bool) or not isinstance(random_state, int | np.integer):
        allowed = "a seed in [0, 2**64), a numpy.random.Generator or RandomState, or None"
        raise ParameterError(wrong("random_state", random_state, allowed))
    if not 0 <= random_state < 2**64:
        raise ParameterError(wrong("random_state", random_state, "a seed in [0, 2**64)"))
    return int(random_state)
