"""Tables of text in files, with the place of every cell, so that an error can name it."""

import csv
import io
import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from restitution._internal.files import MOST, content
from restitution._internal.parameters import ParameterError, Problem, shown

_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?$")


_NEVER = "\x1f"
"""A separator that no table has."""


@dataclass(frozen=True)
class Row:
    """The cells of a line, as text, and its number in the file, from 1."""

    number: int
    cells: tuple[str, ...]


@dataclass(frozen=True)
class Table:
    """Rows of cells; blank lines are left out.

    Attributes
    ----------
    file : str
        The file's name.
    part : str
        Name of the sheet, or of the member of an archive; empty where a file is one table.
    separator : str
        What stands between cells; empty in a spreadsheet.
    rows : tuple of Row
        In their order.
    """

    file: str
    part: str
    separator: str
    rows: tuple[Row, ...]

    def error(self, row: Row, column: int, text: str) -> ParameterError:
        """Make an error that names the place of a cell; columns count from 0 here and from 1 in the text."""
        part = f", {self.part}" if self.part else ""
        return ParameterError(Problem(self.file, f"{part}, line {row.number}, column {column + 1}: {text}"))

    def number(self, row: Row, column: int, what: str, scale: float = 1.0) -> float:
        """Read a cell as a number; an empty cell is NaN."""
        text = row.cells[column] if column < len(row.cells) else ""
        value = as_number(text)
        if value is None:
            raise self.error(row, column, f"{shown(text)}: must be a number ({what})")
        return value * scale


def as_number(text: str) -> float | None:
    """Read a number with decimal point or comma; NaN if empty, None if it is not a number."""
    text = text.strip()
    if not text:
        return float("nan")
    if _DECIMAL_COMMA.match(text):
        text = text.replace(",", ".")
    try:
        return float(text)
    except ValueError:
        return None


def tables(path: Path) -> list[Table]:
    """Read all tables of a text file, a spreadsheet or an archive of text files.

    Raises
    ------
    ValueError
        If there is none, or the library that reads such a file is not installed.
    OSError
        If the file cannot be read.
    """
    held = content(path)
    if held.startswith((b"\xd0\xcf\x11\xe0", b"PK")):
        packed = _zipped if held.startswith(b"PK") else _xls
        try:
            found = list(packed(str(path), held))
        except ParameterError:
            raise
        except Exception as error:  # what these libraries raise on damaged files is anything
            raise ParameterError(
                Problem(str(path), f": a damaged spreadsheet or archive ({error})")
            ) from error
    else:
        found = [_text(str(path), "", held)]
    if not any(table.rows for table in found):
        raise ParameterError(Problem(str(path), ": empty; must be a table with times of impacts"))
    return [table for table in found if table.rows]


def _text(file: str, part: str, content: bytes) -> Table:
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        text = content.decode("utf-16", errors="replace")
    else:
        try:
            text = content.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = content.decode("cp1252", errors="replace")
    if "\0" in text:
        raise ParameterError(Problem(file, ": not a text file; must be a table with times of impacts"))
    separator = _separator(text)
    reader = csv.reader(io.StringIO(text), delimiter=separator, skipinitialspace=separator != "\t")
    rows = []
    try:
        for cells in reader:
            if any(cell.strip() for cell in cells):
                rows.append(Row(reader.line_num, tuple(cell.strip() for cell in cells)))
    except csv.Error as error:
        raise ParameterError(Problem(file, f", line {reader.line_num}: {error}")) from None
    return Table(file, part, separator, tuple(rows))


def _separator(text: str) -> str:
    """Find what stands between the cells: a comma may also be that of a decimal."""
    sample = "\n".join(text.splitlines()[:20])
    for separator in ("\t", ";", ","):
        if separator in sample:
            return separator
    # A heading may have spaces, where a column stands alone.
    alone = all(len(line.split()) < 2 for line in text.splitlines()[1:])
    return _NEVER if alone else " "


def _xls(file: str, content: bytes) -> Iterator[Table]:
    try:
        import xlrd
    except ImportError:
        raise _missing(file, "xlrd") from None
    book = xlrd.open_workbook(file_contents=content, logfile=io.StringIO())  # it prints what it finds odd
    for sheet in book.sheets():
        values = [[sheet.cell_value(i, j) for j in range(sheet.ncols)] for i in range(sheet.nrows)]
        yield _sheet(file, sheet.name, values)


def _zipped(file: str, content: bytes) -> Iterator[Table]:
    """Take a spreadsheet of the newer kind, or what phyphox packs: a text file for each of its tables."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        names = archive.namelist()
        if sum(one.file_size for one in archive.infolist()) > MOST:
            raise ParameterError(Problem(file, f": unpacks to more than {MOST >> 20} MiB"))
        if "[Content_Types].xml" not in names:
            for name in names:
                if name.lower().endswith((".csv", ".txt")) and not name.startswith("meta/"):
                    yield _text(file, name, archive.read(name))
            return
    try:
        import openpyxl
    except ImportError:
        raise _missing(file, "openpyxl") from None
    book = openpyxl.load_workbook(io.BytesIO(content), read_only=True, data_only=True)
    for sheet in book.worksheets:
        yield _sheet(file, sheet.title, [list(row) for row in sheet.iter_rows(values_only=True)])
    book.close()


def _sheet(file: str, name: str, values: list[list[Any]]) -> Table:
    rows = []
    for number, row in enumerate(values, start=1):
        cells = tuple("" if value is None else str(value).strip() for value in row)
        if any(cells):
            rows.append(Row(number, cells))
    return Table(file, f"sheet {name!r}", "", tuple(rows))


def _missing(file: str, library: str) -> ParameterError:
    return ParameterError(
        Problem(file, f": a spreadsheet, which needs {library}: pip install 'restitution[measure]'")
    )
