"""A table of p(ε | v) with the methods of a scipy.stats distribution."""

from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._parameters import ParameterError, wrong
from restitution.distribution import _store
from restitution.distribution._learn import Given
from restitution.distribution._table import Floats, Table

Values: TypeAlias = Any  # np.float64 for scalar arguments, an array of floats otherwise
RandomState: TypeAlias = int | np.random.Generator | np.random.RandomState | None


class TabulatedDistribution:
    """What `FluctuatingRestitution` evaluates and draws."""

    def __init__(self, data: xr.Dataset) -> None:
        lacking = [
            name
            for name in ("velocity", "edges", "restitution_edge", "probability_below")
            if name not in data
        ]
        if lacking:
            raise ValueError(f"data lacks {', '.join(lacking)}: give the Dataset of a FluctuatingRestitution")
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
        return table.value("pdf", x, self._speeds(v), z)[()]

    def cdf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Probability that ε <= x."""
        table, z = self._at(given)
        return table.value("cdf", x, self._speeds(v), z)[()]

    def sf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Probability that ε > x."""
        return (1.0 - np.asarray(self.cdf(x, v, given)))[()]

    def ppf(self, q: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Quantile: the ε with ``cdf(ε, v) = q``; nan unless ``0 <= q <= 1``."""
        table, z = self._at(given)
        return table.value("ppf", q, self._speeds(v), z)[()]

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
        shape = own if size is None else (size,) if isinstance(size, int | np.integer) else tuple(size)
        if shape != own and not _reaches(own, shape):
            raise ParameterError(wrong("size", size, f"a shape that {own} broadcasts to"))
        return table.draw(speeds, z, shape, _seed(random_state), threads)[()]

    def pdf_error(self, x: npt.ArrayLike, v: npt.ArrayLike) -> Values:
        """Give the standard error of `pdf`, at most; nan where the distribution was made from counts alone.

        Blocks of particles are the draws, not impacts. Neighbouring nodes share impacts; their errors are
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
        value, speed = np.broadcast_arrays(np.asarray(x, dtype=np.float64), self._speeds(v))
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
        z = np.asarray(given, dtype=np.float64)
        beyond = (z < 0.0) | (z > 1.0)
        if np.any(beyond):
            raise ParameterError(wrong("given", float(z[beyond].flat[0]), f"in [0, 1], {self.given}"))
        return self._conditional, z

    def _speeds(self, v: npt.ArrayLike) -> Floats:
        speeds = np.asarray(v, dtype=np.float64)
        low, high = self.velocities
        if self.data.attrs.get("beyond") != "clamp" and speeds.size:
            for extreme in (np.fmin.reduce(speeds, axis=None), np.fmax.reduce(speeds, axis=None)):
                if extreme < low or extreme > high:
                    allowed = f"in [{low!r}, {high!r}] m/s, the speeds that were learned; clamped() takes any"
                    raise ParameterError(wrong("v", float(extreme), allowed))
        return speeds


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
