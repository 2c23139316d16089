"""`read`: times of impacts from files of other programs, by the conventions of each."""

import math
import re
from collections.abc import Callable
from importlib.metadata import version
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import Literal, NamedTuple, get_args

import numpy as np
import xarray as xr
from scipy.signal import find_peaks

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.arrays import real, word
from restitution._internal.files import path_from
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.experiment.flight._table import Row, Table, as_number, tables
from restitution.experiment.flight.times import GOOD, MISSED, flag_attributes

Format = Literal["phyphox", "audacity", "tracker", "csv"]
_SECONDS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6}
_NAME = re.compile(r"^'?\s*(?P<name>.*?)\s*(?:[(\[/]\s*(?P<unit>[^)\]]*?)\s*[)\]]?)?$", re.DOTALL)
_TIME = {"t", "time", "times", "zeit", "event time", "time of impact", "impact time"}
_ERROR = {"uncertainty", "error", "standard error", "sigma", "dt", "u(t)"}
_FEWEST = 3
"""Frames that a flight must have."""
_PROMINENCE = 0.03
"""Share of the whole range by which the ball must rise between two impacts."""


class Impact(NamedTuple):
    """Time and error in s (NaN: not given) as they stand in a file, and the place of the time."""

    time: float
    error: float
    row: Row
    column: int


def read(
    file: str | PathLike[str],
    *,
    format: Format | None = None,
    unit: Literal["s", "ms", "us"] = "s",
    uncertainty: float | None = None,
) -> xr.Dataset:
    r"""Read times of impacts that another program measured.

    Parameters
    ----------
    file : path
        A phyphox export (csv, zip, xls or xlsx) of "Acoustic Stopwatch" or "(In)elastic collision"; labels
        that Audacity exported; a table of Tracker with t and y, of which impacts are where the parabolas of
        successive flights meet; or a table with a column "time" or "t" and perhaps one "uncertainty", or
        without headings. Cells are separated by tab, semicolon, comma or spaces; decimals have a point or a
        comma; lines that begin with # are comments.
    format : {"phyphox", "audacity", "tracker", "csv"}, optional
        Whose conventions these are; found from the content if not given.
    unit : {"s", "ms", "us"}
        Unit of times where the file does not give it.
    uncertainty : float, optional
        Standard error of the times in s, > 0, where the file does not give it; 0, not known, if not given.

    Returns
    -------
    xarray.Dataset
        Dimension ``impact``: ``time`` and ``uncertainty`` in s and ``flag``, "good" or "missed" (where a
        cell holds no number: the time is NaN), for `restitution.flight.restitution`. A region label of
        Audacity has its middle, and its length over √12 as its error.

    Raises
    ------
    ValueError
        Naming file, line and column: if a cell is not a number, a time is not later than the one before it,
        or no table holds times.
    OSError
        If the file cannot be read.

    Examples
    --------
    >>> import restitution as rs, pathlib, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp(), "times.csv")
    >>> _ = file.write_text("time (ms), uncertainty (ms)\n0, 0.1\n400, 0.1\n780, 0.1\n")
    >>> rs.flight.read(file).time.values.tolist()
    [0.0, 0.4, 0.78]
    """
    if format is not None and not (isinstance(format, str) and format in _FORMATS):
        raise ParameterError(wrong("format", format, f"{', '.join(map(repr, get_args(Format)))} or None"))
    word("unit", unit, ("s", "ms", "us"))
    if uncertainty is not None:
        allowed = "a finite number > 0 (s), or None"
        uncertainty = real(
            "uncertainty", uncertainty, allowed, lambda error: 0.0 < error < math.inf, unit="s"
        )
    path = path_from("file", file)
    found = tables(path)
    for name in _FORMATS if format is None else (format,):
        reader, _ = _FORMATS[name]
        candidates = [(impacts, table) for table in found if (impacts := reader(table, unit)) is not None]
        if candidates:
            # Among the tables of one export, that of all events is the longest.
            impacts, table = max(candidates, key=lambda candidate: len(candidate[0]))
            return _dataset(path, name, table, impacts, uncertainty)
    raise ParameterError(Problem(str(path), f": no times of impacts; {_contents(found, format)}"))


def _contents(found: list[Table], format: str | None) -> str:
    heads = "; ".join(
        (f"{table.part}: " if table.part else "")
        + ", ".join(cell or "(empty)" for cell in table.rows[0].cells[:12])
        for table in found[:6]
    )
    _, expected = _FORMATS[format or "csv"]
    return f"must have {expected}; its first line is: {heads}"


def _dataset(
    path: Path, format: str, table: Table, impacts: list[Impact], uncertainty: float | None
) -> xr.Dataset:
    earlier = -math.inf
    for time, error, row, column in impacts:
        if time <= earlier:
            text = f"{time:g} s: must be later than the impact before it, {earlier:g} s"
            raise table.error(row, column, text)
        if math.isinf(time):
            raise table.error(row, column, f"{time}: must be finite (s)")
        if error < 0.0 or math.isinf(error):
            raise table.error(row, column, f"an uncertainty of {error:g} s: must be finite and >= 0")
        earlier = earlier if math.isnan(time) else time
    times = np.array([one.time for one in impacts])
    errors = np.array([one.error for one in impacts])
    if np.count_nonzero(~np.isnan(times)) < 2:
        raise ParameterError(Problem(str(path), f": {len(times)} times of impacts; must have at least two"))
    missed = np.isnan(times)
    errors = np.where(np.isnan(errors), uncertainty or 0.0, errors)
    errors[missed] = np.nan
    flags = np.where(missed, MISSED, GOOD).astype(np.int8)
    return xr.Dataset(
        {
            "time": (("impact",), times, {"long_name": "time of the impact", "units": "s"}),
            "uncertainty": (("impact",), errors, {"long_name": "standard error of the time", "units": "s"}),
            "flag": (("impact",), flags, flag_attributes()),
        },
        attrs={
            "title": "Times of impacts",
            "source": f"{format} file {path.name}, read by restitution {version('restitution')}",
        },
    )


def _split(header: str) -> tuple[str, str]:
    """Split a column's heading into name and unit, both in lower case."""
    name, unit = _NAME.findall(header.strip().strip('"').lower())[0]
    return name, unit


def _scale(table: Table, row: Row, column: int, unit: str) -> float:
    """Return the seconds of a heading's unit, or of the one that the caller named."""
    own = _split(row.cells[column])[1]
    if not own:
        return _SECONDS[unit]
    if own not in _SECONDS:
        raise table.error(row, column, f"{row.cells[column]!r}: the unit of a time must be s, ms or us")
    return _SECONDS[own]


def _phyphox(table: Table, unit: str) -> list[Impact] | None:
    """Read the acoustic stopwatch's list of events, or a row of times: "Bounce 0 (s)", "Start (s)"."""
    heading = table.rows[0]
    names = [_split(cell)[0] for cell in heading.cells]
    if "event time" in names:
        return _column(table, 0, names.index("event time"), None, unit, ends_at_nan=True)
    wide = [
        column
        for column, name in enumerate(names)
        if re.fullmatch(r"bounce \d+|start|stop( \d+)?", name) and _split(heading.cells[column])[1]
    ]
    if len(wide) < 2 or len(table.rows) < 2:
        return None
    found: list[Impact] = []
    row = table.rows[1]
    for column in wide:
        value = table.number(row, column, "s", _scale(table, heading, column, unit))
        # An event that did not take place is written as 0.
        if math.isnan(value) or (value == 0.0 and found):
            break
        found.append(Impact(value, math.nan, row, column))
    return found


def _audacity(table: Table, unit: str) -> list[Impact] | None:
    """Read labels: start, end, text; a line that begins with a backslash holds frequencies.

    The impact is somewhere in a region: its middle, and its length over √12, stand for it.
    """
    labels = [row for row in table.rows if row.cells[0] != "\\"]
    if table.separator != "\t" or not labels:
        return None
    found: list[Impact] = []
    for row in labels:
        begin, end, *_ = [*map(as_number, row.cells[:2]), None]
        if begin is None or end is None or not end >= begin:
            if found and begin is not None and len(row.cells) > 1:
                text = f"{row.cells[1]!r}: a label must end at its start, {row.cells[0]}, or later"
                raise table.error(row, 1, text)
            return None
        length = (end - begin) * _SECONDS[unit]
        error = length / math.sqrt(12.0) if length > 0.0 else math.nan
        found.append(Impact(0.5 * (begin + end) * _SECONDS[unit], error, row, 0))
    return found


def _tracker(table: Table, unit: str) -> list[Impact] | None:
    """Read a track: its name, then t, x, y of each frame; impacts are where its parabolas meet."""
    first = 1 if table.rows[0].cells[0].startswith("#multi") else 0
    for start in range(first, min(first + 2, len(table.rows))):
        heading = table.rows[start]
        names = [_split(cell)[0] for cell in heading.cells]
        if names[0] == "t" and "y" in names:
            break
    else:
        return None
    height = names.index("y")
    scale = _scale(table, heading, 0, unit)
    rows = [row for row in table.rows[start + 1 :] if row.cells[0] and any(row.cells[height : height + 1])]
    t = np.array([table.number(row, 0, "s", scale) for row in rows])
    y = np.array([table.number(row, height, "a length") for row in rows])
    late = np.flatnonzero(~(np.diff(t) > 0.0))
    if late.size:
        row = rows[late[0] + 1]
        raise table.error(row, 0, f"{row.cells[0]}: must be later than the frame before it")
    try:
        times, errors = _impacts_of_track(t, y)
    except ValueError as error:
        raise table.error(heading, height, str(error)) from None
    return [
        Impact(float(time), float(error), rows[int(np.searchsorted(t, time))], 0)
        for time, error in zip(times, errors, strict=True)
    ]


def _plain(table: Table, unit: str) -> list[Impact] | None:
    """Read a column called time or t, or the first; beside it one called uncertainty, or the second."""
    heading = table.rows[0]
    if all(as_number(cell) is not None for cell in heading.cells):
        error = 1 if all(len(row.cells) > 1 for row in table.rows) else None
        return _column(table, -1, 0, error, unit)
    names = [_split(cell)[0] for cell in heading.cells]
    columns = [column for column, name in enumerate(names) if name in _TIME]
    if not columns:
        return None
    errors = [column for column, name in enumerate(names) if name in _ERROR]
    return _column(table, 0, columns[0], errors[0] if errors else None, unit)


def _column(
    table: Table, heading: int, column: int, error: int | None, unit: str, *, ends_at_nan: bool = False
) -> list[Impact]:
    """Read a column of times, below the row of headings if `heading` is not -1."""
    scale = _SECONDS[unit]
    error_scale = scale
    if heading >= 0:
        scale = error_scale = _scale(table, table.rows[heading], column, unit)
        if error is not None and _split(table.rows[heading].cells[error])[1]:
            error_scale = _scale(table, table.rows[heading], error, unit)
    found: list[Impact] = []
    for row in table.rows[heading + 1 :]:
        time = table.number(row, column, "s", scale)
        if math.isnan(time) and ends_at_nan:
            break
        deviation = math.nan if error is None else table.number(row, error, "s", error_scale)
        found.append(Impact(time, deviation, row, column))
    return found


def _impacts_of_track(t: Array, y: Array) -> tuple[Array, Array]:
    """Find the times of impacts, between the frames, and their standard errors.

    Each flight k is y = a_k + b_k t - c t², with one c for all. At an impact two flights meet, at
    t = (a_k - a_{k+1})/(b_{k+1} - b_k).

    Parameters
    ----------
    t, y : ndarray, shape (n,)
        Times of the frames in s, and height of the ball above any level, in any unit.

    Returns
    -------
    tuple of ndarray, shape (m,)
        Times and standard errors in s; those of neighbours are correlated, as they share a flight.

    Raises
    ------
    ValueError
        If there are not two impacts with enough frames about them.
    """
    lowest = find_peaks(-y, prominence=_PROMINENCE * np.ptp(y))[0].tolist() if y.size else []
    edges = [-1, *lowest, y.size]
    flights = [np.arange(begin + 1, end) for begin, end in pairwise(edges)]
    # A flight that has too few frames ends the series, or comes before it.
    good = [flight.size >= _FEWEST for flight in flights]
    first = good.index(True) if True in good else len(good)
    last = good.index(False, first) if False in good[first:] else len(good)
    flights = flights[first:last]
    if len(flights) < _FEWEST:
        raise ValueError(
            f"{max(len(flights) - 1, 0)} impacts with at least {_FEWEST} frames before and after; "
            "at least two are needed"
        )
    frames = np.concatenate(flights)
    origin = t[frames].mean()
    x = t - origin
    design = np.zeros((frames.size, 2 * len(flights) + 1))
    rows, numbers = np.arange(frames.size), np.repeat(np.arange(len(flights)), [one.size for one in flights])
    design[rows, 2 * numbers] = 1.0
    design[rows, 2 * numbers + 1] = x[frames]
    design[:, -1] = -(x[frames] ** 2)
    found, *_ = np.linalg.lstsq(design, y[frames], rcond=None)
    residual = y[frames] - design @ found
    freedom = frames.size - design.shape[1]
    if freedom < 1:
        raise ValueError(f"{frames.size} frames in {len(flights)} flights: too few to fit a parabola to each")
    covariance = np.linalg.pinv(design.T @ design) * float(residual @ residual) / freedom
    times, errors = [], []
    for number in range(len(flights) - 1):
        a, b, a_next, b_next = found[2 * number : 2 * number + 4]
        bend = b_next - b
        time = (a - a_next) / bend
        by = np.array([1.0, time, -1.0, -time]) / bend
        block = covariance[2 * number : 2 * number + 4, 2 * number : 2 * number + 4]
        times.append(time + origin)
        errors.append(float(np.sqrt(by @ block @ by)))
    return np.array(times), np.array(errors)


_FORMATS: dict[str, tuple[Callable[[Table, str], list[Impact] | None], str]] = {
    "phyphox": (_phyphox, "a column 'Event time (s)', or columns 'Bounce 0 (s)', 'Bounce 1 (s)', ..."),
    "audacity": (_audacity, "start and end of each label, separated by a tab"),
    "tracker": (_tracker, "columns t and y"),
    "csv": (_plain, "a column 'time' or 't'"),
}
"""The readers, and what each needs; in the order in which they are tried: each knows its own."""
