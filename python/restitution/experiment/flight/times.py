"""Times of impacts as they are given: arrays, or what `sound.impacts` and `flight.read` return."""

from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import check_each, reals
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.drop.recorded import check_successive, check_variables

FLAGS = ("good", "doubtful", "missed", "doubled")
"""Flags of an impact; the number of each is its place in this tuple."""
LEAST, LARGEST = 1e-30, 1e30
"""Products of measured numbers between them are numbers that a double holds."""
MOST = 3000
"""Impacts of a series: a product with its covariance takes half a second, in which no signal is handled."""
GOOD, DOUBTFUL, MISSED, DOUBLED = range(len(FLAGS))


def flag_attributes() -> dict[str, Any]:
    """Return the CF attributes of a variable that holds flags."""
    return {
        "long_name": "what is known of the impact",
        "flag_values": np.arange(len(FLAGS), dtype=np.int8),
        "flag_meanings": " ".join(FLAGS),
    }


def checked(
    times: npt.ArrayLike | xr.Dataset, uncertainty: npt.ArrayLike | None, *, doubtful: bool
) -> tuple[Array, Array]:
    """Return times and standard errors, shapes (n,), n >= 2; NaN for what was missed, or is in doubt.

    Raises
    ------
    ValueError
        Naming the first time that is not later than the one before it, and what else is wrong.
    """
    if isinstance(times, xr.Dataset):
        if uncertainty is not None:
            raise ParameterError(wrong("uncertainty", uncertainty, "left out: the Dataset has its own"))
        instants, errors = _of_dataset(times, doubtful=doubtful)
    else:
        instants = reals("times", times, "a 1-D array of times in s", unit="s", dimensions=(1,), finite=False)
        errors = (
            np.zeros_like(instants)
            if uncertainty is None
            else reals("uncertainty", uncertainty, "numbers, in s", unit="s", finite=False)
        )
        if errors.ndim == 0:
            errors = np.full(instants.shape, float(errors))
    return check_series(instants, errors, "times", "uncertainty")


def check_series(instants: Array, errors: Array, times: str, uncertainty: str) -> tuple[Array, Array]:
    """Return times that increase and their standard errors, of the arguments of these names.

    Raises
    ------
    ParameterError
        Naming the first time that is not later than the one before it, and what else is wrong.
    """
    if instants.size < 2:
        raise ParameterError(Problem(times, f": {instants.size} impacts; must be at least two"))
    if instants.size > MOST:
        text = f": {instants.size} impacts; must be at most {MOST}, all of which are correlated"
        raise ParameterError(Problem(times, text))
    if errors.shape != instants.shape:
        allowed = f"one number, or one for each of the {instants.size} times"
        raise ParameterError(Problem(uncertainty, f": an array of shape {errors.shape}; must be {allowed}"))
    missed = np.isnan(instants)
    known = np.flatnonzero(~missed)
    if known.size < 2:
        text = f": {known.size} of {instants.size} are numbers; at least two must be"
        raise ParameterError(Problem(times, text))
    good = missed | ((errors >= 0.0) & (errors <= LARGEST))
    check_each(uncertainty, errors, good, f"a number in [0, {LARGEST:g}] (s)")
    good = missed | (np.abs(instants) <= LARGEST)
    check_each(times, instants, good, f"at most {LARGEST:g} s either way, or NaN")
    for earlier, later in pairwise(known):
        # Ratios and squares of shorter intervals are no numbers that a double holds.
        if not instants[later] - instants[earlier] >= LEAST:
            allowed = f"later than {times}[{earlier}] = {instants[earlier]!s}"
            if instants[later] > instants[earlier]:
                allowed += f", by at least {LEAST:g} s"
            raise ParameterError(wrong(f"{times}[{later}]", float(instants[later]), allowed))
    return instants, np.where(missed, np.nan, errors)


def _of_dataset(data: xr.Dataset, *, doubtful: bool) -> tuple[Array, Array]:
    missing = [name for name in ("time", "uncertainty") if name not in data]
    if missing:
        has = ", ".join(map(str, data.data_vars)) or "nothing"
        raise ParameterError(Problem("times", f": a Dataset without {' and '.join(missing)}; it has {has}"))
    if data.time.ndim != 1:
        text = f": a Dataset whose time has dimensions {data.time.dims}; must be one series of impacts"
        raise ParameterError(Problem("times", text))
    if "series" in data and np.unique(data.series.values).size > 1:
        numbers = ", ".join(str(number) for number in np.unique(data.series.values))
        text = f": a Dataset of series {numbers}; take one, data.where(data.series == 0, drop=True)"
        raise ParameterError(Problem("times", text))
    instants, errors = _column(data, "time", "numbers, in s"), _column(data, "uncertainty", "numbers, in s")
    if data.time.dims == ("impact",) and "impact" in data.coords:  # of a recording there are no numbers
        check_successive("times", data)
    if "flag" in data:
        allowed = f"0 to {len(FLAGS) - 1}: {', '.join(FLAGS)}"
        flags = _column(data, "flag", allowed)
        check_each("times.flag", flags, np.isnan(flags) | np.isin(flags, range(len(FLAGS))), allowed)
        unknown_times = (flags == MISSED) | ((flags == DOUBTFUL) & (not doubtful))
        instants = np.where(unknown_times, np.nan, instants)
        kept = flags != DOUBLED
        instants, errors = instants[kept], errors[kept]
    return instants, errors


def _column(data: xr.Dataset, name: str, allowed: str) -> Array:
    """Take a variable that has a number for each time; dates and durations, which xarray reads, are none."""
    numbers = reals(f"times.{name}", data[name].to_numpy(), allowed, finite=False)
    if data[name].dims != data.time.dims:
        dimensions = ", ".join(map(str, data[name].dims))
        text = f" has dimensions ({dimensions}): must be those of time, ({data.time.dims[0]})"
        raise ParameterError(Problem(f"times.{name}", text))
    check_variables("times", data, name)
    return numbers
