"""The places of the times in the tables of phyphox, Audacity and Tracker, and in plain tables."""

import math
import re
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from restitution.experiment.flight._read._table import Row, Table, as_number
from restitution.experiment.flight._read._video import impacts_of_track

_SECONDS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6}
_NAME = re.compile(r"^'?\s*(?P<name>.*?)\s*(?:[(\[/]\s*(?P<unit>[^)\]]*?)\s*[)\]]?)?$", re.DOTALL)
_TIME = {"t", "time", "times", "zeit", "event time", "time of impact", "impact time"}
_ERROR = {"uncertainty", "error", "standard error", "sigma", "dt", "u(t)"}


class Impact(NamedTuple):
    """Time and error in s (NaN: not given) as they stand in a file, and the place of the time."""

    time: float
    error: float
    row: Row
    column: int


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


def phyphox(table: Table, unit: str) -> list[Impact] | None:
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


def audacity(table: Table, unit: str) -> list[Impact] | None:
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


def tracker(table: Table, unit: str) -> list[Impact] | None:
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
        times, errors = impacts_of_track(t, y)
    except ValueError as error:
        raise table.error(heading, height, str(error)) from None
    return [
        Impact(float(time), float(error), rows[int(np.searchsorted(t, time))], 0)
        for time, error in zip(times, errors, strict=True)
    ]


def plain(table: Table, unit: str) -> list[Impact] | None:
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


FORMATS: dict[str, Callable[[Table, str], list[Impact] | None]] = {
    "phyphox": phyphox,
    "audacity": audacity,
    "tracker": tracker,
    "csv": plain,
}
"""In the order in which they are tried: each knows its own."""
UNITS = ("s", "ms", "us")
