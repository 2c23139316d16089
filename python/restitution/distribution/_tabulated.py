"""A table of p(ε | v) with the methods of a scipy.stats distribution, and their standard errors."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, Literal, Self, TypeAlias, overload

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import check_each, flag, function, real, reals, shape, whole
from restitution._internal.datasets import check_state
from restitution._internal.parameters import ParameterError, Problem, plain_number, wrong
from restitution._internal.resources import check_size
from restitution.distribution import _store
from restitution.distribution._learn import Given
from restitution.distribution._table import Floats, Table

Numbers: TypeAlias = npt.NDArray[Any] | Sequence[float]
Values: TypeAlias = Any  # np.float64 for scalar arguments, an array of floats otherwise
RandomState: TypeAlias = int | np.random.Generator | np.random.RandomState | None


class TabulatedDistribution:
    """Tables that `FluctuatingRestitution` evaluates and draws from, with the standard errors of all it says.

    Batches of particles are the draws, not impacts. What is said between two nodes, or two conditions, is a
    weighted sum over neighbours that share impacts: their errors are added as if they were one, so that the
    stated error is the true one at most.
    """

    def __init__(self, data: xr.Dataset) -> None:
        _store.check(data)
        self.data = data

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self.data.identical(other.data)

    def __hash__(self) -> int:
        return hash((type(self), self.velocities, *sorted(self.data.sizes.values())))

    def __getstate__(self) -> dict[str, Any]:
        """Pickle without values that follow from the data."""
        return {"data": self.data}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Check the data: they may be of another version."""
        check_state(type(self), {"data"}, state)
        _store.check(state["data"])
        self.data = state["data"]

    @property
    def velocities(self) -> tuple[float, float]:
        """Least and greatest learned speed, in m/s."""
        return float(self._table.speeds[0]), float(self._table.speeds[-1])

    @property
    def gaps(self) -> Floats:
        """Ends of the ranges of speed between which no impact was seen, in m/s; shape (gaps, 2)."""
        return _store.gaps(self.data)

    def clamped(self) -> Self:
        """Return the same distribution, with speeds and conditions clamped to the learned range."""
        return type(self)(self.data.assign_attrs(beyond="clamp"))

    @property
    def given(self) -> Given | None:
        """Variable that the argument `given` of the methods stands for."""
        found: Given | None = self.data.attrs.get("given")
        return found

    def pdf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the probability density at ε = x, at impact velocity v."""
        return self._value("pdf", "x", x, v, given)

    def logpdf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the logarithm of `pdf`; -inf outside the support."""
        return _log(self.pdf(x, v, given))

    def cdf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the probability that ε <= x."""
        return self._value("cdf", "x", x, v, given)

    def logcdf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the logarithm of `cdf`."""
        return _log(self.cdf(x, v, given))

    def sf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the probability that ε > x."""
        return (1.0 - np.asarray(self.cdf(x, v, given)))[()]

    def logsf(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the logarithm of `sf`."""
        return _log(self.sf(x, v, given))

    def ppf(self, q: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the quantile: the ε with ``cdf(ε, v) = q``; nan unless ``0 <= q <= 1``."""
        return self._value("ppf", "q", q, v, given)

    def isf(self, q: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the upper quantile: the ε with ``sf(ε, v) = q``; nan unless ``0 <= q <= 1``."""
        return self.ppf(1.0 - numbers("q", q), v, given)

    def interval(
        self, confidence: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None
    ) -> tuple[Values, Values]:
        """Return both ends of the range that leaves out equal probability on either side."""
        level = numbers("confidence", confidence)
        tail = 0.5 * (1.0 - np.where((level >= 0.0) & (level <= 1.0), level, np.nan))
        low, high = (self._value("ppf", "confidence", q, v, given) for q in (tail, 1.0 - tail))
        return low, high

    def median(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the median of ε."""
        return self.ppf(0.5, v, given)

    def support(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> tuple[Values, Values]:
        """Return the least and greatest ε."""
        return self.ppf(0.0, v, given), self.ppf(1.0, v, given)

    @overload
    def mean(self, v: float, given: float | None = None) -> float: ...

    @overload
    def mean(self, v: Numbers, given: npt.ArrayLike | None = None) -> Floats: ...

    @overload
    def mean(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values: ...

    def mean(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the mean of ε."""
        table, speeds, z = self._at(v, given)
        return table.mean(speeds, z)[()]

    def var(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the variance of ε."""
        table, speeds, z = self._at(v, given)
        return table.central(speeds, z)[0][()]

    def std(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the square root of the variance of ε."""
        return np.sqrt(self.var(v, given))

    def skewness(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the skewness of ε, as in `restitution.statistics`."""
        return self.stats(v, given, "s")[0]

    def kurtosis(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the kurtosis of ε, not its excess: 3 for a Gaussian, 6 for symmetric flanks."""
        return self.stats(v, given, "k")[0]

    def resolved(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the least probability that can be estimated at v: that of one of the impacts seen there.

        Tails that hold less are not in the histograms; `cdf` and `sf` are 0 there, and `rvs` does not draw
        them.
        """
        table, speeds, z = self._at(v, given)
        number = self.data["impacts" if given is None else "given_impacts"].to_numpy()
        return np.asarray(sum(weight / number[i] for weight, i in table.parts(speeds, z)))[()]

    def stats(
        self, v: npt.ArrayLike, given: npt.ArrayLike | None = None, moments: str = "mv"
    ) -> tuple[Values, ...]:
        """Return the mean "m", variance "v", skewness "s" and kurtosis "k", in the order of ``moments``.

        The kurtosis is Pearson's, 3 for a Gaussian, as everywhere in this package; SciPy's is less by 3.
        """
        if not isinstance(moments, str) or not set(moments) <= set("mvsk"):
            raise ParameterError(wrong("moments", moments, "letters of 'mvsk'"))
        table, speeds, z = self._at(v, given)
        m2, m3, m4 = table.central(speeds, z)
        with np.errstate(divide="ignore", invalid="ignore"):
            found = {"m": table.mean(speeds, z), "v": m2, "s": m3 / m2**1.5, "k": m4 / m2**2}
        return tuple(found[letter][()] for letter in moments)

    def moment(self, order: int, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the mean of ε to the power ``order`` (a whole number >= 0)."""
        order = whole("order", order, 0, 1000)
        table, speeds, z = self._at(v, given)
        return table.expectation(lambda x: x**order, speeds, z, -np.inf, np.inf, order)[()]

    def expect(
        self,
        func: Callable[[float], float] | None,
        v: npt.ArrayLike,
        given: npt.ArrayLike | None = None,
        lb: float | None = None,
        ub: float | None = None,
        conditional: bool = False,
    ) -> Values:
        """Return the mean of ``func(ε)``, of ε itself if that is None.

        Gauss's rule with eight points in every bin of the histograms: exact for polynomials of order 15.

        Parameters
        ----------
        func : callable or None
            Of one number.
        v, given : array_like
            Impact velocity in m/s, and condition.
        lb, ub : float, optional
            Only ε in [lb, ub] count; lb <= ub.
        conditional : bool
            Divide by the probability of [lb, ub]; nan where that is 0.
        """
        table, speeds, z = self._at(v, given)
        low = -np.inf if lb is None else real("lb", lb, "a number or None", lambda x: x == x)
        high = np.inf if ub is None else real("ub", ub, "a number or None", lambda x: x == x)
        if low > high:
            raise ParameterError(wrong("lb", lb, f"at most ub = {high!r}"))
        of_one = (lambda x: x) if func is None else np.vectorize(function("func", func), otypes=[np.float64])
        found = table.expectation(of_one, speeds, z, low, high, 15)
        if flag("conditional", conditional):
            share = np.asarray(self.cdf(high, v, given) - self.cdf(low, v, given))
            found = np.divide(found, share, out=np.full_like(found, np.nan), where=share > 0.0)
        return found[()]

    def entropy(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the differential entropy, -∫ p ln p dε."""
        table, speeds, z = self._at(v, given)
        return np.asarray(np.vectorize(table.entropy, otypes=[np.float64])(speeds, z))[()]

    @overload
    def rvs(
        self,
        v: float,
        size: None = None,
        random_state: RandomState = None,
        given: float | None = None,
        threads: int | None = None,
    ) -> float: ...

    @overload
    def rvs(
        self,
        v: Numbers,
        size: None = None,
        random_state: RandomState = None,
        given: npt.ArrayLike | None = None,
        threads: int | None = None,
    ) -> Floats: ...

    @overload
    def rvs(
        self,
        v: npt.ArrayLike,
        size: int | tuple[int, ...] = ...,
        random_state: RandomState = None,
        given: npt.ArrayLike | None = None,
        threads: int | None = None,
    ) -> Floats: ...

    @overload
    def rvs(
        self,
        v: npt.ArrayLike,
        size: int | tuple[int, ...] | None = None,
        random_state: RandomState = None,
        given: npt.ArrayLike | None = None,
        threads: int | None = None,
    ) -> Values: ...

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
            Shape of the result, which `v` and `given` broadcast to; theirs by default.
        random_state : int, numpy.random.Generator, numpy.random.RandomState, optional
            A seed in [0, 2⁶⁴), or what to draw one from. The same seed gives the same bits with any number of
            threads, and the same first draws for any size.
        given : array_like, optional
            Condition.
        threads : int, optional
            One for each core by default.
        """
        table, speeds, z = self._at(v, given)
        own = np.broadcast_shapes(speeds.shape, z.shape)
        wanted = own if size is None else shape("size", size)
        if not _reaches(own, wanted):
            raise ParameterError(wrong("size", size, f"a shape that {own} broadcasts to"))
        longest = ("v", v) if speeds.size >= z.size else ("given", given)
        name, asked = longest if size is None else ("size", size)
        check_size(name, asked, math.prod(wanted), 8, "draws")
        return table.draw(speeds, z, wanted, _seed(random_state), threads)[()]

    def pdf_error(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `pdf`, at most.

        Raises
        ------
        ValueError
            If the distribution was made from counts, which say nothing of the particles behind them.
        """
        return self._error("probability_error", numbers("x", x), v, given)

    def cdf_error(self, x: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `cdf` and `sf`, at most, as `pdf_error`."""
        return self._error("probability_below_error", numbers("x", x), v, given)

    def ppf_error(self, q: npt.ArrayLike, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `ppf`, at most: that of `cdf` over the density there, as `pdf_error`.

        It is 0 at both ends, which are the least and the greatest ε that were seen.
        """
        x = self.ppf(q, v, given)
        below, density = self.cdf_error(x, v, given), self.pdf(x, v, given)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(below == 0.0, 0.0, below / density)[()]

    def mean_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `mean`, at most, as `pdf_error`."""
        return self._moment_error("mean_error", v, given)

    def std_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `std`, at most, as `pdf_error`."""
        return self._moment_error("std_error", v, given)

    def skewness_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `skewness`, at most, as `pdf_error`."""
        return self._moment_error("skewness_error", v, given)

    def kurtosis_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `kurtosis`, at most, as `pdf_error`."""
        return self._moment_error("kurtosis_error", v, given)

    def var_error(self, v: npt.ArrayLike, given: npt.ArrayLike | None = None) -> Values:
        """Return the standard error of `var`, at most: 2 σ times that of σ, as `pdf_error`."""
        return 2.0 * self.std(v, given) * self.std_error(v, given)

    @property
    def has_errors(self) -> bool:
        """True if standard errors are known; they are not if the distribution was made from counts."""
        return "probability_error" in self.data

    @cached_property
    def _table(self) -> Table:
        return _store.table(self.data)

    @cached_property
    def _conditional(self) -> Table:
        return _store.table(self.data, "given_")

    def _value(
        self,
        what: Literal["pdf", "cdf", "ppf"],
        name: str,
        x: npt.ArrayLike,
        v: npt.ArrayLike,
        given: npt.ArrayLike | None,
    ) -> Values:
        table, speeds, z = self._at(v, given)
        points = numbers(name, x)
        _check_shapes(**{name: points, "v": speeds, "given": z})
        return table.value(what, points, speeds, z)[()]

    def _at(self, v: npt.ArrayLike, given: npt.ArrayLike | None) -> tuple[Table, Floats, Floats]:
        """Return the table to use, with speeds and conditions inside its range or clamped to it."""
        speeds = numbers("v", v, "m s-1")
        low, high = self.velocities
        if self._clamps:
            check_each("v", speeds, ~(speeds < 0.0), "a speed, >= 0 m/s")
        else:
            allowed = f"in [{low!r}, {high!r}] m/s, the speeds that were learned; clamped() takes any"
            check_each("v", speeds, ~((speeds < low) | (speeds > high)), allowed)
            for start, end in self.gaps:
                allowed = (
                    f"outside [{start:.6g}, {end:.6g}) m/s, where no impact was seen; clamped() takes any"
                )
                check_each("v", speeds, ~((speeds >= start) & (speeds < end)), allowed)
        if given is None:
            return self._table, speeds, np.zeros(())
        if self.given is None:
            raise ParameterError(
                wrong("given", given, "None: the distribution was learned without a condition")
            )
        z = numbers("given", given)
        _check_shapes(v=speeds, given=z)
        check_each("given", z, ~((z < 0.0) | (z > 1.0)), f"in [0, 1], {self.given}")
        if not self._clamps:
            self._seen(speeds, z)
        return self._conditional, speeds, z

    def _seen(self, speeds: Floats, z: Floats) -> None:
        """Refuse a condition that no impact at such a speed had."""
        left, _ = self._table.weights(speeds)
        least, most = (self.data[name].to_numpy() for name in ("given_lowest", "given_highest"))
        low = np.minimum(least[left], least[left + 1])
        high = np.maximum(most[left], most[left + 1])
        unseen = ((z < low) | (z > high)) & ~np.isnan(speeds)
        if np.any(unseen):
            at = tuple(int(i) for i in np.argwhere(unseen)[0])
            name = f"given[{', '.join(map(str, at))}]" if z.ndim and z.shape == unseen.shape else "given"
            z, speeds, low, high = (
                np.broadcast_to(part, unseen.shape)[unseen] for part in (z, speeds, low, high)
            )
            seen = f"in [{low[0]:.6g}, {high[0]:.6g}], what was seen of {self.given} at {speeds[0]:.4g} m/s"
            raise ParameterError(wrong(name, float(z[0]), f"{seen}; clamped() takes any"))

    @property
    def _clamps(self) -> bool:
        return bool(self.data.attrs.get("beyond") == "clamp")

    def _errors(self, name: str, given: npt.ArrayLike | None) -> Floats:
        if not self.has_errors:
            raise ValueError(
                f"{name}: not known; the distribution was made from counts, which do not say "
                "what particle an impact belongs to; learn gives errors"
            )
        errors: Floats = self.data[name if given is None else f"given_{name}"].to_numpy()
        if not np.isfinite(errors).any():
            raise ValueError(
                f"{name}: not known; all impacts are those of a single particle, learn from more"
            )
        return errors

    def _moment_error(self, name: str, v: npt.ArrayLike, given: npt.ArrayLike | None) -> Values:
        errors = self._errors(name, given)
        table, speeds, z = self._at(v, given)
        return np.asarray(sum(weight * errors[i] for weight, i in table.parts(speeds, z)))[()]

    def _error(self, name: str, x: Floats, v: npt.ArrayLike, given: npt.ArrayLike | None) -> Values:
        errors = self._errors(name, given)
        table, speeds, z = self._at(v, given)
        x, speeds, z = np.broadcast_arrays(x, speeds, z)
        total = np.zeros(x.shape)
        for weight, component in table.parts(speeds, z):
            for i in np.unique(component):
                here = component == i
                edges = table[int(i)].edges
                own = errors[table.start[i] : table.start[i + 1]]
                if name == "probability_below_error":
                    found = np.interp(x[here], edges, own)
                else:
                    density = np.concatenate([[0.0], own[:-1] / np.diff(edges), [0.0]])
                    found = density[np.searchsorted(edges, x[here], side="right")]
                total[here] += weight[here] * found
        total[np.isnan(x) | np.isnan(speeds) | np.isnan(z)] = np.nan
        return total[()]


def _log(values: Values) -> Values:
    with np.errstate(divide="ignore"):
        return np.log(values)


def numbers(name: str, values: npt.ArrayLike, unit: str = "1") -> Floats:
    """Return real numbers as an array; nan is one."""
    return reals(name, values, "a number or an array of numbers", unit=unit, finite=False)


def _reaches(own: tuple[int, ...], larger: tuple[int, ...]) -> bool:
    """Test whether the first shape broadcasts to the second, which may be too large for NumPy."""
    last = larger[len(larger) - len(own) :]
    return len(own) <= len(larger) and all(a in (1, b) for a, b in zip(own, last, strict=True))


def _seed(random_state: RandomState) -> int:
    if isinstance(random_state, np.random.RandomState):
        return int.from_bytes(random_state.bytes(8), "little")
    if isinstance(random_state, np.random.Generator) or random_state is None:
        return int(np.random.default_rng(random_state).integers(2**64, dtype=np.uint64, endpoint=False))
    if not isinstance(plain_number(random_state), int) or isinstance(plain_number(random_state), bool):
        allowed = "a seed in [0, 2**64), a numpy.random.Generator or RandomState, or None"
        raise ParameterError(wrong("random_state", random_state, allowed))
    if not 0 <= random_state < 2**64:
        raise ParameterError(wrong("random_state", random_state, "a seed in [0, 2**64)"))
    return int(random_state)


def _check_shapes(**arrays: np.ndarray) -> None:
    """Refuse arrays whose shapes do not broadcast, naming them all."""
    try:
        np.broadcast_shapes(*(array.shape for array in arrays.values()))
    except ValueError:
        given = ", ".join(f"{name} of shape {array.shape}" for name, array in arrays.items() if array.ndim)
        names = ", ".join(name for name, array in arrays.items() if array.ndim)
        raise ParameterError(Problem(names, f": {given}; must broadcast to one shape")) from None
