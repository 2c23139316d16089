"""What the exported sources have in common: the comment at the top, and names."""

import re
from collections.abc import Iterator
from pathlib import Path

import xarray as xr

from restitution._internal.parameters import ParameterError, wrong
from restitution.distribution._table import Floats, Ints

_LEFT_OUT = ("title", "Conventions", "source", "beyond", "version", "references")
_IMAGES = (".png", ".pdf", ".svg")


def checked_name(name: str) -> str:
    """Refuse what is not an identifier in C, C++ and Fortran."""
    if not isinstance(name, str) or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]{0,23}", name):
        allowed = "a letter and then at most 23 letters, digits and underscores"
        raise ParameterError(wrong("name", name, allowed))
    return name


def about(data: xr.Dataset) -> Iterator[str]:
    """Yield the lines on the origin and the range of the numbers."""
    attrs = data.attrs
    yield f"Coefficient of restitution at random, p(eps | v): {_ascii(attrs['source'])}."
    yield ""
    for name, value in attrs.items():
        if name not in _LEFT_OUT:
            yield f"  {_ascii(name)} = {_ascii(value)}"
    yield ""
    low, high = float(data["velocity"][0]), float(data["velocity"][-1])
    clamps = attrs["beyond"] == "clamp"
    beyond = "are taken as the nearest of these" if clamps else "give NaN"
    yield f"v is the normal impact velocity in m/s, from {low!r} to {high!r}; others {beyond}."
    yield "u1 and u2 are independent uniform random numbers in [0, 1) of yours."
    if "given" in attrs:
        yield f"z in [0, 1] is the condition: {_ascii(data['given'].attrs['long_name'])}."
        yield f"What no impact at that speed had {'is' if clamps else 'gives NaN, not'} taken as the nearest."
    if "ks_distance" in data:
        worst = float(data["ks_distance"].max())
        yield f"Kolmogorov-Smirnov distance to impacts that were not learned from: at most {worst:.4f}."


def image_format(path: Path) -> str:
    """Give the format of a figure by the end of its name."""
    if path.suffix.lower() not in _IMAGES:
        raise ParameterError(wrong("figure", path.name, f"a name that ends in {', '.join(_IMAGES)}"))
    return path.suffix[1:].lower()


def _ascii(value: object) -> str:
    """Write a value as one line that neither ends nor begins a comment in any language."""
    text = " ".join(str(value.tolist() if hasattr(value, "tolist") else value).split())
    text = text.encode("ascii", "replace").decode("ascii")
    text = "".join(letter if letter.isprintable() else "?" for letter in text)
    for mark in ("*/", "/*", "??"):  # the last begins a trigraph
        while mark in text:
            text = text.replace(mark, " ".join(mark))
    return text if len(text) <= 90 else f"{text[:87]}..."


def chunks(values: Floats | Ints, size: int) -> Iterator[Floats | Ints]:
    """Cut an array into pieces of at most `size`."""
    for start in range(0, values.size, size):
        yield values[start : start + size]
