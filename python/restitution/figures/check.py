"""Checks of what the pieces of figures are given: panels, and arrays that fit together."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from restitution._internal.arrays import FARTHEST, FloatArray, check_each, reals
from restitution._internal.parameters import ParameterError, Problem, wrong

_KINDS = {Axes: "a panel, matplotlib.axes.Axes", Figure: "a matplotlib.figure.Figure", str: "text"}


def check_kind(name: str, value: Any, kind: type[Any]) -> None:
    """Refuse what is no panel, no figure, or no text."""
    if not isinstance(value, kind):
        raise ParameterError(wrong(name, value, _KINDS[kind]))


def column(name: str, value: Any, length: int | None = None, like: str = "") -> FloatArray:
    """Take a 1-D array of real numbers of a length that another one sets.

    NaN and infinities may be among them.
    """
    allowed = "a 1-D array of real numbers"
    found = reals(name, value, allowed, unit=None, dimensions=(1,), finite=False)
    if length is not None and found.size != length:
        text = f": {name} has {found.size} numbers, and must have {length} beside {like}"
        raise ParameterError(Problem(f"{like}, {name}", text))
    check_drawable(name, found)
    return found


def check_drawable(name: str, numbers: FloatArray) -> None:
    """Refuse finite numbers whose sums, or margins of a panel, would be infinite."""
    good = ~np.isfinite(numbers) | (np.abs(numbers) <= FARTHEST)
    check_each(name, numbers, good, f"at most {FARTHEST:g} either way, or not finite")
