"""A distribution as source text that needs nothing else: a C99 and C++ header, a Fortran module.

The texts are in ``templates/``. There ``@about`` stands for the comment on the origin, ``@arrays`` for the
tables, and lines between ``@if WORD`` and ``@end`` are for what has a condition (given), refuses what was not
seen (checked), or has speeds without impacts between others (gaps).
"""

import re
from collections.abc import Iterable, Iterator, Mapping
from importlib.resources import files
from textwrap import wrap
from typing import Any

import numpy as np
import xarray as xr

from restitution._internal.parameters import ParameterError, wrong
from restitution.distribution import _store
from restitution.distribution._check import largest_distance
from restitution.distribution._store import gaps
from restitution.distribution._table import Floats, Ints
from restitution.drop.energy import percent

_PER_LINE, _PER_STATEMENT = 4, 400  # numbers
_LEFT_OUT = (
    "all_impacts",
    "energy_created_impacts",
    "title",
    "Conventions",
    "source",
    "beyond",
    "version",
    "references",
)
_INDENTED: dict[str, Any] = {"initial_indent": "  ", "subsequent_indent": "    "}
_FEW = 40


def header(data: xr.Dataset, name: str) -> str:
    """Write the header; see `FluctuatingRestitution.to_c`."""
    words = {"GUARD": f"{_checked_name(name).upper()}_H", "NODES": str(data["velocity"].size)}
    words |= {"GAPS": str(len(gaps(data))), "NAME": name}
    arrays = (_in_c(f"{name}_{key}", values) for key, values in _arrays(data).items())
    return _filled("sampler.h", data, (f" * {line}" for line in _about(data)), arrays, words)


def module(data: xr.Dataset, name: str) -> str:
    """Write the module; see `FluctuatingRestitution.to_fortran`."""
    words = {"NAME": _checked_name(name)}
    arrays = (line for key, values in _arrays(data).items() for line in _in_fortran(f"{name}_{key}", values))
    return _filled("sampler.f90", data, (f"!> {line}" for line in _about(data)), arrays, words)


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


def _checked_name(name: str) -> str:
    """Refuse what is not an identifier in C, C++ and Fortran."""
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,23}", name):
        allowed = "a letter and then at most 23 letters, digits and underscores"
        raise ParameterError(wrong("name", name, allowed))
    return name


def _about(data: xr.Dataset) -> Iterator[str]:
    """Yield the lines on the origin and the range of the numbers."""
    attrs = data.attrs
    yield f"Coefficient of restitution at random, p(eps | v): {_ascii(attrs['source'])}."
    yield ""
    for name, value in attrs.items():
        if name not in _LEFT_OUT:
            yield from wrap(f"{_ascii(name)} = {_ascii(_short(value))}", 90, **_INDENTED)
    if "release_height" in attrs:
        yield f"Particles were {released(attrs)}."
    if share := attrs.get("energy_created_share", 0.0):
        yield f"{percent(share)} of the impacts created kinetic energy: a gas of it may heat itself."
    yield ""
    low, high = float(data["velocity"][0]), float(data["velocity"][-1])
    clamps = attrs["beyond"] == "clamp"
    beyond = "are taken as the nearest of these" if clamps else "give NaN"
    yield f"v is the normal impact velocity in m/s, from {low!r} to {high!r}; others {beyond}."
    for start, end in gaps(data):
        between = "speeds there are interpolated" if clamps else "speeds there give NaN"
        yield f"No impact was seen between {start:.6g} and {end:.6g} m/s; {between}."
    yield "u1 and u2 are independent uniform random numbers in [0, 1), which the caller draws."
    if "given" in attrs:
        yield f"z in [0, 1] is the condition: {_ascii(data['given'].attrs['long_name'])}."
        unseen = "is taken as the nearest one seen" if clamps else "gives NaN"
        yield f"A z that no impact had at that speed {unseen}."
    if "ks_distance" in data:
        yield from wrap(f"At most {largest_distance(data)}.", 90)


def _ascii(value: object) -> str:
    """Write a value so that it neither ends nor begins a comment in any language."""
    text = " ".join(str(value.tolist() if hasattr(value, "tolist") else value).split())
    text = text.encode("ascii", "replace").decode("ascii")
    text = "".join(letter if letter.isprintable() else "?" for letter in text)
    for mark in ("*/", "/*", "??"):  # the last begins a trigraph
        while mark in text:
            text = text.replace(mark, " ".join(mark))
    return text


def _short(value: object) -> object:
    """Abbreviate a long list to its number of values, the least and the greatest."""
    numbers = np.asarray(value)
    if numbers.size <= _FEW or numbers.dtype.kind not in "fiu":
        return value
    return f"{numbers.size} numbers from {numbers.min():.9g} to {numbers.max():.9g}"


def released(attrs: Mapping[str, Any]) -> str:
    """Say from what heights the particles were released."""
    heights = attrs["release_height"]
    if isinstance(heights, str):  # drawn
        low, high = attrs["release_height_range"]
        return f"released from heights that were drawn from {low:.6g} to {high:.6g} m"
    several = np.atleast_1d(heights)
    if several.size == 1:
        return f"released from {several[0]:.6g} m"
    text = f"released from {several.size} heights, {several.min():.6g} to {several.max():.6g} m"
    return f"{text}, spread about {attrs['heights_about']:.6g} m" if "heights_about" in attrs else text
