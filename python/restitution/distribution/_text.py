"""Text common to the exported sources: the comment at the top, and names."""

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.parameters import ParameterError, wrong
from restitution.distribution._check import largest_distance
from restitution.distribution._table import Floats
from restitution.drop.energy import percent

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


def gaps(data: xr.Dataset) -> Floats:
    """Return the ends of the ranges of speed between which no impact was seen, in m/s; shape (gaps, 2)."""
    if "gap_lowest" not in data:
        return np.empty((0, 2))
    return np.stack([data[f"gap_{name}"].to_numpy() for name in ("lowest", "highest")], axis=1)


def in_gaps(data: xr.Dataset, v: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Mark the speeds near which no impact was seen."""
    speeds, ends = np.asarray(v)[..., None], gaps(data)
    return np.asarray(np.any((speeds >= ends[:, 0]) & (speeds < ends[:, 1]), axis=-1))


def image_format(path: Path) -> str:
    """Return the format of a figure by the end of its name."""
    if path.suffix.lower() not in _IMAGES:
        raise ParameterError(wrong("figure", path.name, f"a name that ends in {', '.join(_IMAGES)}"))
    return path.suffix[1:].lower()


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
