"""A distribution as source text that needs nothing else: a C99 and C++ header, a Fortran module.

The texts are in ``templates/``. There ``@about`` stands for the comment on the origin, ``@arrays`` for the
tables, and lines between ``@if WORD`` and ``@end`` are for what has a condition (given), refuses what was not
seen (checked), or has speeds without impacts between others (gaps).
"""

import re
from collections.abc import Iterable, Iterator
from importlib.resources import files

import xarray as xr

from restitution.distribution import _store
from restitution.distribution._table import Floats, Ints
from restitution.distribution._text import about, checked_name, gaps

_PER_LINE, _PER_STATEMENT = 4, 400  # numbers


def header(data: xr.Dataset, name: str) -> str:
    """Write the header; see `FluctuatingRestitution.to_c`."""
    words = {"GUARD": f"{checked_name(name).upper()}_H", "NODES": str(data["velocity"].size)}
    words |= {"GAPS": str(len(gaps(data))), "NAME": name}
    arrays = (_in_c(f"{name}_{key}", values) for key, values in _arrays(data).items())
    return _filled("sampler.h", data, (f" * {line}" for line in about(data)), arrays, words)


def module(data: xr.Dataset, name: str) -> str:
    """Write the module; see `FluctuatingRestitution.to_fortran`."""
    words = {"NAME": checked_name(name)}
    arrays = (line for key, values in _arrays(data).items() for line in _in_fortran(f"{name}_{key}", values))
    return _filled("sampler.f90", data, (f"!> {line}" for line in about(data)), arrays, words)


def _filled(
    file: str, data: xr.Dataset, comment: Iterable[str], arrays: Iterable[str], words: dict[str, str]
) -> str:
    """Fill a template in."""
    checked = data.attrs["beyond"] != "clamp"
    there = {"given": "given" in data.attrs, "checked": checked, "gaps": checked and len(gaps(data)) > 0}
    lines, kept = [], [True]
    for line in files("restitution.distribution").joinpath("templates", file).read_text("ascii").splitlines():
        mark, _, word = line.partition(" ")
        if mark == "@if":
            kept.append(kept[-1] and there[word])
        elif mark == "@end":
            kept.pop()
        elif line in ("@about", "@arrays"):
            lines += [one.rstrip() for one in (comment if line == "@about" else arrays)]
        elif kept[-1]:
            lines.append(re.sub("|".join(words), lambda found: words[found.group()], line))
    return "\n".join(lines) + "\n"


def _arrays(data: xr.Dataset) -> dict[str, Floats | Ints]:
    """Return the tables that the samplers read, by their names in the sources."""
    table, checked = _store.table(data), data.attrs["beyond"] != "clamp"
    found: dict[str, Floats | Ints] = {"start": table.start, "velocity": table.speeds, "edge": table.edges}
    found["probability_below"] = table.cumulative
    if "given" in data.attrs:
        table = _store.table(data, "given_")
        found |= {"given_start": table.start, "given_first": table.first, "given": table.conditions}
        found |= {"given_edge": table.edges, "given_probability_below": table.cumulative}
        found |= {key: data[key].to_numpy() for key in ("given_lowest", "given_highest") if checked}
    if checked and len(gaps(data)):
        found |= zip(("gap_lowest", "gap_highest"), gaps(data).T, strict=True)
    return found


def _in_c(name: str, values: Floats | Ints) -> str:
    kind = "int" if values.dtype.kind == "i" else "double"
    rows = (", ".join(map(repr, row.tolist())) for row in _chunks(values, _PER_LINE))
    return f"static const {kind} {name}[{values.size}] = {{\n    " + ",\n    ".join(rows) + "\n};"


def _in_fortran(name: str, values: Floats | Ints) -> Iterator[str]:
    """Declare an array and fill it, in statements short enough for the standard's limit of their length."""
    kind = "integer" if values.dtype.kind == "i" else "real(dp)"
    yield f"  {kind}, save :: {name}({values.size})"
    first = 1
    for part in _chunks(values, _PER_STATEMENT):
        rows = (", ".join(map(_number, row.tolist())) for row in _chunks(part, _PER_LINE))
        yield f"  data {name}({first}:{first + part.size - 1}) / &"
        yield "    " + ", &\n    ".join(rows) + " /"
        first += part.size


def _number(value: float) -> str:
    return str(value) if isinstance(value, int) else f"{value:.16e}".replace("e", "d")


def _chunks(values: Floats | Ints, size: int) -> Iterator[Floats | Ints]:
    """Cut an array into pieces of at most `size`."""
    return (values[start : start + size] for start in range(0, values.size, size))
