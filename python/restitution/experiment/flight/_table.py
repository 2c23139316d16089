"""Tables of text in files, with the place of every cell, so that an error can name it."""

import csv
import io
import re
import zipfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

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
    """Rows of cells; blank lines are left out."""

    file: str
    part: str  # the sheet, or the member of an archive; empty where a file is one table
    separator: str  # what stands between cells; empty in a spreadsheet
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
        try:
            found = list(_packed(str(path), held))
        except ParameterError:
            raise
        except ImportError as error:
            text = ": a spreadsheet, which needs python-calamine: pip install 'restitution[measure]'"
            raise ParameterError(Problem(str(path), text)) from error
        except Exception as error:  # what these libraries raise on damaged files is anything
            text = f": a damaged spreadsheet or archive ({error})"
            raise ParameterError(Problem(str(path), text)) from error
    else:
        found = [_text(str(path), "", held)]
    found = [table for table in found if table.rows]
    if not found:
        raise ParameterError(Problem(str(path), ": empty; must be a table with times of impacts"))
    return found


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
            if any(cell.strip() for cell in cells) and not comment(cells[0]):
                rows.append(Row(reader.line_num, tuple(cell.strip() for cell in cells)))
    except csv.Error as error:
        raise ParameterError(Problem(file, f", line {reader.line_num}: {error}")) from None
    return Table(file, part, separator, tuple(rows))


def comment(cell: str) -> bool:
    """Tell a line that begins with # from a track's heading, which Tracker begins with #multi."""
    return cell.lstrip().startswith("#") and not cell.lstrip().startswith("#multi")


def _separator(text: str) -> str:
    """Find what stands between the cells: a comma may also be that of a decimal."""
    lines = [line for line in text.splitlines() if not comment(line)]
    sample = "\n".join(lines[:20])
    for separator in ("\t", ";", ","):
        if separator in sample:
            return separator
    # A heading may have spaces, where a column stands alone.
    alone = all(len(line.split()) < 2 for line in lines[1:])
    return _NEVER if alone else " "


def _packed(file: str, held: bytes) -> Iterator[Table]:
    """Take the sheets of a spreadsheet, or what phyphox packs: a text file for each of its tables."""
    if held.startswith(b"PK"):
        with zipfile.ZipFile(io.BytesIO(held)) as archive:
            if sum(one.file_size for one in archive.infolist()) > MOST:
                raise ParameterError(Problem(file, f": unpacks to more than {MOST >> 20} MiB"))
            names = archive.namelist()
            if "[Content_Types].xml" not in names:
                for name in names:
                    if name.lower().endswith((".csv", ".txt")) and not name.startswith("meta/"):
                        yield _text(file, name, archive.read(name))
                return
    import pandas

    sheets = pandas.read_excel(
        io.BytesIO(held), sheet_name=None, header=None, dtype=object, na_filter=False, engine="calamine"
    )
    for name, sheet in sheets.items():
        lines = [[str(cell).strip() for cell in row] for row in sheet.itertuples(index=False)]
        rows = tuple(Row(number, tuple(cells)) for number, cells in enumerate(lines, 1) if any(cells))
        yield Table(file, f"sheet {name!r}", "", rows)
