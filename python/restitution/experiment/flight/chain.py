"""Series of impacts as chains of flights: speeds before and after each, and what errors do to them."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import check_each
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.drop.recorded import check_successive, variables
from restitution.experiment.flight.contact import ContactTime, delays
from restitution.experiment.flight.drag import Drag, fall, speeds
from restitution.experiment.flight.setting import Once, setting_of
from restitution.experiment.flight.times import check_series

COMMON = 5
"""Measured once: g, the height of the drop, the terminal velocity, the contact time; and the clock."""
_LONGEST_CONTACT = 4.0
"""Intervals must be longer than this many times of contact at 1 m/s."""
_LONGEST = 50.0
"""Of a flight with drag, in V/g: its body starts with V times the exponential function of this."""
USUAL_BETWEEN = 3e-3
"""Half of all plates and hands differ by less in ε: the scale of a half-Cauchy prior (Gelman, 2006)."""


@dataclass(frozen=True)
class Chain:
    """The speeds of n impacts, and their derivatives by the n + 5 numbers that were measured.

    These are the n times, g, the height of the drop, the terminal velocity, the contact time at 1 m/s and the
    rate of the clock, by which all true intervals are longer than it shows. Their errors are independent.
    """

    before: Array  # speed towards the plane in m/s, shape (n,); NaN where the times do not determine it
    after: Array  # and away from it
    before_by: Array  # derivatives, shape (n, n + 5); 0 where the speed is NaN
    after_by: Array
    variances: Array  # of the n + 5 numbers


@dataclass(frozen=True)
class Measured:
    """Measured values of one series of n impacts, and the variances of these numbers and of the clock."""

    times: Array  # in s, shape (n,); NaN is an impact that took place and was not measured
    gravity: float  # in m/s²
    drop: float | None  # height of the drop in m, where it counts
    terminal: float | None  # terminal velocity in m/s, where it counts
    variances: Array  # in the order of `Chain`, shape (n + 5,); 0 where there is not a number
    contact: float = 0.0  # time of contact at 1 m/s, in s

    def timed(self, error: float) -> "Measured":
        """Return the chain with one standard error, in s, for all times."""
        n = self.times.size
        return replace(self, variances=np.append(np.full(n, error**2), self.variances[n:]))

    def moved(self, shift: Array) -> "Measured":
        """Return the chain with other numbers, which differ by `shift`, shape (n + 5,)."""
        n = self.times.size
        return replace(
            self,
            times=(self.times + shift[:n]) * (1.0 + shift[n + 4]),
            gravity=self.gravity + float(shift[n]),
            drop=None if self.drop is None else self.drop + float(shift[n + 1]),
            terminal=None if self.terminal is None else self.terminal + float(shift[n + 2]),
            contact=self.contact + float(shift[n + 3]),
        )


def series_of(data: Any, *needed: str) -> dict[str, xr.Dataset]:
    """Take a Dataset of `flight.restitution`, or several, by what errors call them.

    Raises
    ------
    ParameterError
        If one of them is none, lacks a variable that is needed or has it in other units, of other dimensions
        or of no real numbers, or an error that is negative, or there is none.
    """
    several = [data]
    if isinstance(data, Iterable) and not isinstance(data, xr.Dataset):
        try:
            several = list(data)
        except Exception:  # the object may raise anything
            several = []
    if not several or not all(isinstance(one, xr.Dataset) for one in several):
        raise ParameterError(wrong("data", data, "a Dataset of flight.restitution, or several"))
    named = {"data": data} if isinstance(data, xr.Dataset) else {}
    named = named or {f"data[{k}]": one for k, one in enumerate(several)}
    pairs = ("impact", "other_impact")
    dimensions = {each: pairs if each.endswith("_covariance") else pairs[:1] for each in needed}
    for name, one in named.items():
        for each, values in zip(needed, variables(name, one, "flight.restitution", dimensions), strict=True):
            check_each(f"{name}.{each}", values, ~np.isinf(values), "finite, or NaN for what is not known")
            if each.endswith("_error"):
                check_each(f"{name}.{each}", values, ~(values < 0.0), "a standard error >= 0, or NaN")
    return named


def measured(
    times: Array,
    uncertainty: Array,
    once: Once,
    drag: Drag | None,
    contact: ContactTime | None,
    name: str = "times",
) -> Measured:
    """Put together what was measured, with the standard errors of g, of the height and of the clock.

    Raises
    ------
    ParameterError
        Naming the times, if drag would have let no body fly as long as between two of them.
    """
    if drag is not None:
        most = _LONGEST * drag.terminal_velocity / once.gravity
        longest = float(np.nanmax(np.diff(times), initial=0.0))
        if longest > most:
            speed = f"a terminal velocity V of {drag.terminal_velocity:g} m/s"
            text = f": a flight of {longest:g} s; must be at most {_LONGEST:g} V/g = {most:g} s with {speed}"
            raise ParameterError(Problem(name, text))
    contact = ContactTime(at_1_m_s=0.0) if contact is None else contact
    if np.nanmin(np.diff(times), initial=np.inf) <= _LONGEST_CONTACT * contact.at_1_m_s:
        text = f" = {contact.at_1_m_s:g} s at 1 m/s: must be short beside the intervals between the impacts"
        raise ParameterError(Problem("contact_time", text))
    errors = [
        once.gravity_error,
        0.0 if once.drop_height is None else once.drop_height_uncertainty,
        0.0 if drag is None else drag.uncertainty,
        contact.uncertainty,
        once.clock_uncertainty,
    ]
    return Measured(
        times,
        once.gravity,
        once.drop_height,
        None if drag is None else drag.terminal_velocity,
        np.concatenate([np.nan_to_num(uncertainty), errors]) ** 2,
        contact.at_1_m_s,
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
    times, errors = (data[each].to_numpy().astype(np.float64) for each in ("time", "uncertainty"))
    times, errors = check_series(times, errors, f"{name}.time", f"{name}.uncertainty")
    once, drag, contact = setting_of(name, data)
    if int(data["impact"][0]) > 0:
        once = once.model_copy(update={"drop_height": None})
    return measured(times, errors, once, drag, contact, f"{name}.time")


def chain(given: Measured) -> Chain:
    """Follow the flights between impacts."""
    n = given.times.size
    before, after = np.full(n, np.nan), np.full(n, np.nan)
    before_by, after_by = np.zeros((n, n + COMMON)), np.zeros((n, n + COMMON))
    intervals = np.diff(given.times)
    landing = None if given.drop is None else fall(given.drop, given.gravity, given.terminal)
    first = None if landing is None else landing.speed
    delay = np.zeros_like(intervals)
    for _ in range(2):  # the speeds are those of the flights alone
        flight = speeds(intervals - given.contact * delay, given.gravity, given.terminal)
        delay = delays(flight.up, flight.down, first)
    flight = speeds(intervals - given.contact * delay, given.gravity, given.terminal)
    after[:-1], before[1:] = flight.up, flight.down
    place = np.arange(n - 1)
    for matrix, rows, by in ((after_by, place, flight.up_by), (before_by, place + 1, flight.down_by)):
        matrix[rows, place + 1] = by[0]
        matrix[rows, place] = -by[0]
        matrix[rows, n] = by[1]
        matrix[rows, n + 2] = by[2]
        matrix[rows, n + 3] = -by[0] * delay
        matrix[rows, n + 4] = by[0] * intervals
    if landing is not None:
        before[0] = landing.speed
        before_by[0, n : n + 3] = landing.by
    before_by[np.isnan(before)] = 0.0
    after_by[np.isnan(after)] = 0.0
    return Chain(before, after, before_by, after_by, given.variances)


def joined(experiments: list[Measured], shift: Array | None) -> Chain:
    """Put series one after the other, their numbers moved by `shift`.

    The times are each series' own, and so is the height of the drop; g, drag, contact time and clock are
    common.
    """
    common = [
        (one.gravity, one.terminal, one.contact, *one.variances[[-COMMON, -3, -2, -1]]) for one in experiments
    ]
    if len(set(common)) != 1:
        text = ": series with different g, drag, contact time or clock; must have the same"
        raise ParameterError(Problem("data", text))
    sizes = [one.times.size for one in experiments]
    total = sum(sizes)
    columns = total + len(experiments) + COMMON - 1
    before, after = np.empty(total), np.empty(total)
    before_by, after_by = np.zeros((total, columns)), np.zeros((total, columns))
    variances = np.zeros(columns)
    row = 0
    for number, (one, size) in enumerate(zip(experiments, sizes, strict=True)):
        rows = slice(row, row + size)
        drop = total + COMMON - 1 + number
        places = [*range(row, row + size), total, drop, total + 1, total + 2, total + 3]
        part = chain(one if shift is None else one.moved(shift[places]))
        before[rows], after[rows] = part.before, part.after
        before_by[rows, places] = part.before_by
        after_by[rows, places] = part.after_by
        variances[places] = part.variances
        row += size
    return Chain(before, after, before_by, after_by, variances)
