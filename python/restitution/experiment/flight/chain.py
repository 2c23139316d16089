"""A series of impacts as a chain of flights: speeds before and after each, and what errors do to them."""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.parameters import ParameterError, Problem
from restitution.drop.recorded import check_successive
from restitution.experiment.flight._setting import setting_of
from restitution.experiment.flight.drag import Drag, fall, speeds
from restitution.experiment.flight.times import check_series

Array = npt.NDArray[np.float64]

COMMON = 3
"""Quantities that are measured once: g, the height of the drop, the terminal velocity."""
_LONGEST = 50.0
"""Of a flight with drag, in V/g: its body starts with V times the exponential function of this."""


@dataclass(frozen=True)
class Chain:
    """The speeds of n impacts, and their derivatives by the n + 3 numbers that were measured.

    Attributes
    ----------
    before, after : ndarray, shape (n,)
        Speed towards and away from the plane, in m/s; NaN where the times do not determine it.
    before_by, after_by : ndarray, shape (n, n + 3)
        Derivatives by the n times, g, the height of the drop and the terminal velocity; 0 where the speed
        is NaN.
    variances : ndarray, shape (n + 3,)
        Of these n + 3 numbers. Their errors are independent.
    """

    before: Array
    after: Array
    before_by: Array
    after_by: Array
    variances: Array


@dataclass(frozen=True)
class Measured:
    """Measured values of one series of n impacts, and the variances of these n + 3 numbers.

    Attributes
    ----------
    times : ndarray, shape (n,)
        In s. NaN is an impact that took place and was not measured.
    gravity : float
        In m/s².
    drop, terminal : float or None
        Height of the drop in m, and terminal velocity in m/s, where they count.
    variances : ndarray, shape (n + 3,)
        In the order of `Chain`; 0 where there is not a number.
    """

    times: Array
    gravity: float
    drop: float | None
    terminal: float | None
    variances: Array

    def timed(self, error: float) -> "Measured":
        """Return the chain with one standard error, in s, for all times."""
        n = self.times.size
        return replace(self, variances=np.append(np.full(n, error**2), self.variances[n:]))

    def moved(self, shift: Array) -> "Measured":
        """Return the chain with other numbers, which differ by `shift`, shape (n + 3,)."""
        n = self.times.size
        return replace(
            self,
            times=self.times + shift[:n],
            gravity=self.gravity + float(shift[n]),
            drop=None if self.drop is None else self.drop + float(shift[n + 1]),
            terminal=None if self.terminal is None else self.terminal + float(shift[n + 2]),
        )


def measured(
    times: Array,
    uncertainty: Array,
    gravity: tuple[float, float],
    drop: tuple[float, float] | None,
    drag: Drag | None,
    name: str = "times",
) -> Measured:
    """Put together what was measured; g and the height of the drop come with their standard errors.

    Raises
    ------
    ParameterError
        Naming the times, if drag would have let no body fly as long as between two of them.
    """
    if drag is not None:
        most = _LONGEST * drag.terminal_velocity / gravity[0]
        longest = float(np.nanmax(np.diff(times), initial=0.0))
        if longest > most:
            speed = f"a terminal velocity V of {drag.terminal_velocity:g} m/s"
            text = f": a flight of {longest:g} s; must be at most {_LONGEST:g} V/g = {most:g} s with {speed}"
            raise ParameterError(Problem(name, text))
    errors = [gravity[1], 0.0 if drop is None else drop[1], 0.0 if drag is None else drag.uncertainty]
    return Measured(
        times,
        gravity[0],
        None if drop is None else drop[0],
        None if drag is None else drag.terminal_velocity,
        np.concatenate([np.nan_to_num(uncertainty), errors]) ** 2,
    )


def measured_of(data: xr.Dataset, name: str = "data") -> Measured:
    """Read from a Dataset that `restitution` returned what was measured.

    The height of the drop counts where the first of the impacts is the first after it.

    Raises
    ------
    ParameterError
        If impacts between others are left out, or a time or an attribute is not as `restitution` has it.
    """
    check_successive(name, data)
    times, errors = check_series(
        data["time"].to_numpy().astype(np.float64),
        data["uncertainty"].to_numpy().astype(np.float64),
        f"{name}.time",
        f"{name}.uncertainty",
    )
    gravity, drop, drag = setting_of(name, data)
    falls = int(data["impact"][0]) == 0
    return measured(times, errors, gravity, drop if falls else None, drag, f"{name}.time")


def chain(given: Measured) -> Chain:
    """Follow the flights between impacts."""
    n = given.times.size
    before, after = np.full(n, np.nan), np.full(n, np.nan)
    before_by, after_by = np.zeros((n, n + COMMON)), np.zeros((n, n + COMMON))
    flight = speeds(np.diff(given.times), given.gravity, given.terminal)
    after[:-1], before[1:] = flight.up, flight.down
    first = np.arange(n - 1)
    for matrix, rows, by in ((after_by, first, flight.up_by), (before_by, first + 1, flight.down_by)):
        matrix[rows, first + 1] = by[0]
        matrix[rows, first] = -by[0]
        matrix[rows, n] = by[1]
        matrix[rows, n + 2] = by[2]
    if given.drop is not None:
        landing = fall(given.drop, given.gravity, given.terminal)
        before[0] = landing.speed
        before_by[0, n:] = landing.by
    before_by[np.isnan(before)] = 0.0
    after_by[np.isnan(after)] = 0.0
    return Chain(before, after, before_by, after_by, given.variances)
