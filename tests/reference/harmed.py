"""One catalogue of harms that a Dataset can have on its way to a function; it grows with every find."""

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import xarray as xr

from reference.contract import CALLS, attack

Harm = tuple[str, Callable[[xr.Dataset], xr.Dataset]]


def _without(name: str) -> Callable[[xr.Dataset], xr.Dataset]:
    """Take an attribute away."""

    def harm(data: xr.Dataset) -> xr.Dataset:
        kept = {key: value for key, value in data.attrs.items() if key != name}
        return data.drop_attrs(deep=False).assign_attrs(kept)

    return harm


_KINDS = {"text": "U8", "dates": "datetime64[ns]", "durations": "timedelta64[ns]", "complex": complex}
_KINDS |= {"booleans": bool}
_VALUES: dict[str, Any] = {
    "None": None,
    "text": "x",
    "nan": float("nan"),
    "negative": -1.0,
    "zero": 0,
    "tiny": 5e-324,
    "huge": 1.7e308,
    "beyond": 10**400,
    "masked": np.ma.masked,
    "three": [1.0, 2.0, 3.0],
}
_PARTS: dict[str, Any] = {
    "none": [],
    "one": [0],
    "later ones": slice(1, None),
    "every second": slice(None, None, 2),
    "backwards": slice(None, None, -1),
    "all but the last": slice(0, -1),
}


def _of_variable(name: str) -> Iterator[Harm]:
    yield f"{name} dropped", lambda data: data.drop_vars(name)
    yield f"{name} renamed", lambda data: data.rename({name: "another"})
    yield f"{name} with a further dimension", lambda data: data.assign({name: data[name].expand_dims("way")})
    yield f"{name} in furlong", lambda data: data.assign({name: data[name].assign_attrs(units="furlong")})
    for said, kind in _KINDS.items():
        yield (
            f"{name} as {said}",
            lambda data, kind=kind: data.assign({name: data[name].astype(kind)}),  # type: ignore[misc]
        )
    for number in (np.nan, np.inf, -1.0, 0.0, 1e300):
        yield (
            f"{name} all {number}",
            lambda data, number=number: data.assign(  # type: ignore[misc]
                {name: (data[name].dims, np.full(data[name].shape, number))}
            ),
        )


def _of_dimension(name: str) -> Iterator[Harm]:
    yield f"dimension {name} renamed", lambda data: data.rename_dims({name: "another"})
    yield f"dimension {name} gone", lambda data: data.isel({name: 0})
    for said, part in _PARTS.items():
        yield f"of {name} {said}", lambda data, part=part: data.isel({name: part})  # type: ignore[misc]


def _of_attribute(name: str) -> Iterator[Harm]:
    yield f"attribute {name} gone", _without(name)
    for said, value in _VALUES.items():
        yield (
            f"attribute {name} {said}",
            lambda data, value=value: data.assign_attrs({name: value}),  # type: ignore[misc]
        )


def harms(data: xr.Dataset, attributes: tuple[str, ...]) -> Iterator[Harm]:
    """Yield all harms to a Dataset, each in words and as a function that makes a harmed one of it."""
    yield "nothing in it", lambda data: xr.Dataset()
    yield "turned over", lambda data: data.transpose()
    yield "one of several", lambda data: data.expand_dims("body")
    for name in map(str, data.variables):
        if name not in data.dims:
            yield from _of_variable(name)
    for name in map(str, data.dims):
        yield from _of_dimension(name)
    for name in attributes:
        yield from _of_attribute(name)


FITTING: dict[str, tuple[str, ...]] = {
    "trajectory": ("times", "particle = "),
    "figures.trajectory": ("particle = ",),
    "figures.impact": ("particle = ", "impact = "),
    "figures.animate": ("particle = ", "impacts = "),
    "figures.densities": ("velocities",),
    **{name: ("velocity = ", "clusters: ", "count: ") for name in CALLS if name.startswith("fit.")},
    "posterior": ("diameter = ",),
    "explore": ("spin and release_velocity = ",),
}
"""Where what is left in a Dataset is right in itself: the argument that does not fit it any more."""


@cache
def takers() -> dict[str, str]:
    """Give every public function that takes a Dataset of ours, with the argument that is one."""
    return {
        name: argument
        for name, (_, make) in CALLS.items()
        for argument, given in make().items()
        if isinstance(given, xr.Dataset)
    }


def every_harm(name: str) -> dict[str, Callable[[xr.Dataset], xr.Dataset]]:
    """Give all harms to what a function takes, of all its variables, dimensions and attributes."""
    good = CALLS[name][1]()[takers()[name]]
    return dict(harms(good, tuple(map(str, good.attrs))))


def harm(name: str, words: str) -> str | None:
    """Give a function a harmed Dataset; say what is wrong with what happens, if anything is."""
    argument = takers()[name]
    found = attack(name, argument, every_harm(name)[words](CALLS[name][1]()[argument]))
    plt.close("all")
    fits = tuple(f"does not name {argument}: {other}" for other in FITTING.get(name, ()))
    return None if found is not None and found.startswith(fits) else found
