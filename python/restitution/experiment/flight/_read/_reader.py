"""`read`: times of impacts from a file, as a Dataset."""

import math
from importlib.metadata import version
from os import PathLike
from pathlib import Path
from typing import Literal, get_args

import numpy as np
import xarray as xr

from restitution._internal.arrays import real, word
from restitution._internal.files import path_from
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.experiment.flight._read._conventions import FORMATS, UNITS, Impact
from restitution.experiment.flight._read._table import Table, tables
from restitution.experiment.flight.times import GOOD, MISSED, flag_attributes

Format = Literal["phyphox", "audacity", "tracker", "csv"]


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
    if format is not None and not (isinstance(format, str) and format in FORMATS):
        raise ParameterError(wrong("format", format, f"{', '.join(map(repr, get_args(Format)))} or None"))
    word("unit", unit, UNITS)
    if uncertainty is not None:
        allowed = "a finite number > 0 (s), or None"
        uncertainty = real(
            "uncertainty", uncertainty, allowed, lambda error: 0.0 < error < math.inf, unit="s"
        )
    path = path_from("file", file)
    found = tables(path)
    readers = FORMATS if format is None else {format: FORMATS[format]}
    for name, reader in readers.items():
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
    expected = {
        "phyphox": "a column 'Event time (s)', or columns 'Bounce 0 (s)', 'Bounce 1 (s)', ...",
        "audacity": "start and end of each label, separated by a tab",
        "tracker": "columns t and y",
    }.get(format or "", "a column 'time' or 't'")
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
