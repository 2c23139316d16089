"""The places of the times in the tables of phyphox, Audacity and Tracker, and in plain tables."""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from restitution.experiment.flight._read._table import Row, Table, as_number
from restitution.experiment.flight._read._video import impacts_of_track

_SECONDS = {"s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "μs": 1e-6}
_NAME = re.compile(r"^'?\s*(?P<name>.*?)\s*(?:[(\[/]\s*(?P<unit>[^)\]]*?)\s*[)\]]?)?$")
_TIME = {"t", "time", "times", "zeit", "event time", "time of impact", "impact time"}
_ERROR = {"uncertainty", "error", "standard error", "sigma", "dt", "u(t)"}


@dataclass
class Found:
    """Times in s as they stand in a file, with their errors (NaN: not given) and the row of each."""

    times: list[float]
    errors: list[float]
    rows: list[tuple[Row, int]]


def _split(header: str) -> tuple[str, str]:
    """Split a column's heading into name and unit, both in lower case."""
    match = _NAME.match(header.strip().strip('"'))
    if match is None:
        return header.lower(), ""
    return (match["name"] or "").lower(), (match["unit"] or "").lower()


def _scale(table: Table, row: Row, column: int, unit: str) -> float:
    """Return the seconds of a heading's unit, or of the one that the caller named."""
    own = _split(row.cells[column])[1]
    if not own:
        return _SECONDS[unit]
    if own not in _SECONDS:
        raise table.error(row, column, f"{row.cells[column]!r}: the unit of a time must be s, ms or us")
    return _SECONDS[own]


def _is_heading(row: Row) -> bool:
    """Test whether a cell is a word and not a number; a missing number is neither."""
    values = [as_number(cell) for cell in row.cells]
    return any(value is None for value in values)


def phyphox(table: Table, unit: str) -> Found | None:
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
    found = Found([], [], [])
    row = table.rows[1]
    for column in wide:
        value = table.number(row, column, "s", _scale(table, heading, column, unit))
        # An event that did not take place is written as 0.
        if math.isnan(value) or (value == 0.0 and found.times):
            break
        found.times.append(value)
        found.errors.append(math.nan)
        found.rows.append((row, column))
    return found


def audacity(table: Table, unit: str) -> Found | None:
    """Read labels: start, end, text; a line that begins with a backslash holds frequencies.

    The impact is somewhere in a region: its middle, and its length over √12, stand for it.
    """
    labels = [row for row in table.rows if row.cells[0] != "\\"]
    if table.separator != "\t" or not labels:
        return None
    found = Found([], [], [])
    for row in labels:
        ends = [as_number(cell) for cell in row.cells[:2]]
        if len(ends) < 2 or ends[0] is None or ends[1] is None or not ends[1] >= ends[0]:
            if found.times and len(ends) == 2 and ends[0] is not None:
                raise table.error(
                    row, 1, f"{row.cells[1]!r}: a label must end at its start, {row.cells[0]}, or later"
                )
            return None
        found.times.append(0.5 * (ends[0] + ends[1]) * _SECONDS[unit])
        length = (ends[1] - ends[0]) * _SECONDS[unit]
        found.errors.append(length / math.sqrt(12.0) if length > 0.0 else math.nan)
        found.rows.append((row, 0))
    return found


def tracker(table: Table, unit: str) -> Found | None:
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
    rows = [
        row
        for row in table.rows[start + 1 :]
        if height < len(row.cells) and row.cells[height] and row.cells[0]
    ]
    t = np.array([table.number(row, 0, "s", scale) for row in rows])
    y = np.array([table.number(row, height, "a length") for row in rows])
    for number in range(1, t.size):
        if not t[number] > t[number - 1]:
            raise table.error(
                rows[number], 0, f"{rows[number].cells[0]}: must be later than the frame before it"
            )
    try:
        times, errors = impacts_of_track(t, y)
    except ValueError as error:
        raise table.error(heading, height, str(error)) from None
    at = [(rows[int(np.searchsorted(t, time))], 0) for time in times]
    return Found(times.tolist(), errors.tolist(), at)


def plain(table: Table, unit: str) -> Found | None:
    """Read a column called time or t, or the first; beside it one called uncertainty, or the second."""
    heading = table.rows[0]
    if not _is_heading(heading):
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
) -> Found:
    """Read a column of times, below the row of headings if `heading` is not -1."""
    scale = _SECONDS[unit]
    error_scale = scale
    if heading >= 0:
        scale = error_scale = _scale(table, table.rows[heading], column, unit)
        if error is not None and _split(table.rows[heading].cells[error])[1]:
            error_scale = _scale(table, table.rows[heading], error, unit)
    found = Found([], [], [])
    for row in table.rows[heading + 1 :]:
        time = table.number(row, column, "s", scale)
        if math.isnan(time) and ends_at_nan:
            break
        found.times.append(time)
        found.errors.append(math.nan if error is None else table.number(row, error, "s", error_scale))
        found.rows.append((row, column))
    return found


FORMATS: dict[str, Callable[[Table, str], Found | None]] = {
    "phyphox": phyphox,
    "audacity": audacity,
    "tracker": tracker,
    "csv": plain,
}
"""In the order in which they are tried: each knows its own."""
UNITS = ("s", "ms", "us")
