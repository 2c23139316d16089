"""Files with the spheres of a clump, as codes and tools of the discrete-element method write them."""

import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

from restitution._internal.files import content
from restitution._internal.parameters import ParameterError, Problem, shown, wrong

Format = Literal["rows", "csv", "lammps", "liggghts"]
Spheres = list[tuple[float, ...]]

_ROW = "x y z r, with spaces or commas between them and perhaps a type after them; r > 0"
_COLUMNS = ("x", "y", "z", "r")


class _Line(NamedTuple):
    """A line without its comment, and its number in the file."""

    number: int
    words: tuple[str, ...]


class _File(NamedTuple):
    name: str
    lines: list[_Line]

    def wrong(self, line: _Line, allowed: str) -> ParameterError:
        found = shown(" ".join(line.words))
        return ParameterError(Problem(self.name, f", line {line.number}: {found}: must be ", allowed))

    def lacks(self, what: str) -> ParameterError:
        return ParameterError(Problem(self.name, f": {what}"))

    def words(self, line: _Line, counts: tuple[int, ...], allowed: str) -> tuple[str, ...]:
        if len(line.words) not in counts:
            raise self.wrong(line, allowed)
        return line.words

    def numbers(self, line: _Line, words: tuple[str, ...], allowed: str) -> tuple[float, ...]:
        try:
            found = tuple(map(float, words))
        except ValueError:
            raise self.wrong(line, allowed) from None
        if not all(map(math.isfinite, found)):
            raise self.wrong(line, f"{allowed}; finite")
        return found

    def sphere(self, line: _Line, words: tuple[str, ...], allowed: str) -> tuple[float, ...]:
        found = self.numbers(line, words, allowed)
        if found[3] <= 0.0:
            raise self.wrong(line, allowed)
        return found


def rows_in(path: Path, columns: tuple[str, ...]) -> Spheres:
    """Read rows with these columns, and nothing else, from a file."""
    row = " ".join(columns)
    file = _file(path, f"rows {row}")
    allowed = f"{row}, with spaces or commas between them"
    return [file.numbers(line, file.words(line, (len(columns),), allowed), allowed) for line in file.lines]


def read(path: Path, format: Any) -> Spheres:
    """Read the rows (x, y, z, r) of a file; a ParameterError names the line that is none, and why."""
    if format is not None and not (isinstance(format, str) and format in get_args(Format)):
        raise ParameterError(wrong("format", format, f"None, {', '.join(map(repr, get_args(Format)))}"))
    file = _file(path, "the spheres of a clump, x y z r")
    reader = {"rows": _rows, "csv": _csv, "lammps": _lammps, "liggghts": _liggghts}[format or _guess(file)]
    spheres = reader(file)
    if not spheres:
        raise file.lacks("no spheres; must have one or more, x y z r")
    return spheres


def _file(path: Path, needed: str) -> _File:
    name, held = str(path), content(path)
    try:
        text = held.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = "\0"
    if "\0" in text:
        raise ParameterError(Problem(name, f": not a text file; must have {needed}"))
    file = _File(name, list(_lines(text)))
    if not file.lines:
        raise file.lacks(f"empty; must have {needed}")
    return file


def _lines(text: str) -> Iterator[_Line]:
    """Yield the lines that hold something, and what ``&`` continues as one."""
    before: tuple[str, ...] = ()
    for number, line in enumerate(text.splitlines(), start=1):
        words = before + tuple(filter(None, re.split(r"[,;\s]+", line.partition("#")[0])))
        goes_on = bool(words) and words[-1].endswith("&")
        before = (*words[:-1], *filter(None, [words[-1][:-1]])) if goes_on else ()
        if words and not goes_on:
            yield _Line(number, words)
    if before:
        yield _Line(number, before)


def _guess(file: _File) -> Format:
    if any("particletemplate/multisphere" in line.words for line in file.lines):
        return "liggghts"
    if {"x", "y", "z"} <= {word.strip("\"'").lower() for word in file.lines[0].words}:
        return "csv"
    return "lammps" if any(line.words[0] == "Coords" for line in file.lines) else "rows"


def _rows(file: _File) -> Spheres:
    """One sphere a line: LIGGGHTS, which ignores what stands behind the four numbers, CLUMP, MercuryDPM."""
    return [file.sphere(line, file.words(line, (4, 5), _ROW)[:4], _ROW) for line in file.lines]


def _liggghts(file: _File) -> Spheres:
    """Read what stands behind ``spheres`` in a particletemplate/multisphere of an input script."""
    line = next((line for line in file.lines if "particletemplate/multisphere" in line.words), file.lines[0])
    row = "a particletemplate/multisphere with nspheres and spheres x y z r, one behind the other"
    if "nspheres" not in line.words or "spheres" not in line.words[:-1]:
        raise file.wrong(line, row)
    count, place = line.words.index("nspheres") + 1, line.words.index("spheres") + 1
    number = int(line.words[count]) if line.words[count].isdecimal() else 0
    words = line.words[place : place + 4 * number]
    if number < 1 or len(words) < 4 * number:
        raise file.wrong(line, row)
    return [file.sphere(line, words[4 * k : 4 * k + 4], row) for k in range(number)]


def _csv(file: _File) -> Spheres:
    """Columns by their names: DEM-Engine."""
    head, *rows = file.lines
    names = [word.strip("\"'").lower() for word in head.words]
    if any(names.count(column) != 1 for column in _COLUMNS):
        raise file.wrong(head, "a header with the columns x, y, z and r, each once")
    places = [names.index(column) for column in _COLUMNS]
    allowed = f"{len(names)} values, as many as the header has names; x, y, z finite, r > 0"
    spheres = []
    for line in rows:
        words = file.words(line, (len(names),), allowed)
        spheres.append(file.sphere(line, tuple(words[place] for place in places), allowed))
    return spheres


def _lammps(file: _File) -> Spheres:
    """Read sections Coords and Diameters, each with a line for each atom, which begins with its ID."""
    header: list[_Line] = []
    sections: dict[str, list[_Line]] = {}
    rows = header
    for line in file.lines:
        if line.words[0][0].isalpha() and line.number > 1:  # of which the first is a title
            rows = sections.setdefault(" ".join(line.words), [])
        else:
            rows.append(line)
    counts = [line for line in header if line.words[1:] == ("atoms",) and line.words[0].isdecimal()]
    if len(counts) != 1:
        raise file.lacks("no line 'N atoms' in the header of this LAMMPS molecule")
    atoms = int(counts[0].words[0])
    for name in ("Coords", "Diameters"):
        if name not in sections:
            raise file.lacks(f"no section {name} in this LAMMPS molecule; must have Coords and Diameters")
    centres = _by_atom(file, sections["Coords"], "Coords", atoms, "ID x y z")
    sizes = _by_atom(file, sections["Diameters"], "Diameters", atoms, "ID diameter")
    spheres = []
    for atom in range(1, atoms + 1):
        line, (diameter,) = sizes[atom]
        if diameter <= 0.0:
            raise file.wrong(line, "ID diameter; the diameter > 0")
        spheres.append((*centres[atom][1], 0.5 * diameter))
    return spheres


def _by_atom(
    file: _File, lines: list[_Line], section: str, atoms: int, row: str
) -> dict[int, tuple[_Line, tuple[float, ...]]]:
    found: dict[int, tuple[_Line, tuple[float, ...]]] = {}
    for line in lines:
        identity, *values = line.words
        if len(values) != len(row.split()) - 1:
            raise file.wrong(line, row)
        if not identity.isdecimal() or not 1 <= int(identity) <= atoms or int(identity) in found:
            raise file.wrong(line, f"{row}, each ID from 1 to {atoms} once")
        found[int(identity)] = line, file.numbers(line, tuple(values), row)
    if len(found) != atoms:
        raise file.lacks(
            f"{len(found)} lines in the section {section}; must be one for each of {atoms} atoms"
        )
    return found
