"""Checks of what the pieces of figures are given: panels, and arrays that fit together."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure

from restitution._internal.arrays import FARTHEST, FloatArray, check_each, reals
from restitution._internal.parameters import ParameterError, Problem, wrong


def panel(name: str, value: Any) -> Axes:
    """Check a panel."""
    if not isinstance(value, Axes):
        raise ParameterError(wrong(name, value, "a panel, matplotlib.axes.Axes"))
    return value


def figure(name: str, value: Any) -> Figure:
    """Check a figure."""
    if not isinstance(value, Figure):
        raise ParameterError(wrong(name, value, "a matplotlib.figure.Figure"))
    return value


def colours(name: str, value: Any) -> ScalarMappable:
    """Check the argument that a colour bar belongs to."""
    if not isinstance(value, ScalarMappable) or value.get_array() is None:
        raise ParameterError(wrong(name, value, "what `population` returns"))
    return value


def text(name: str, value: Any) -> str:
    """Check a text."""
    if not isinstance(value, str):
        raise ParameterError(wrong(name, value, "text"))
    return value


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
