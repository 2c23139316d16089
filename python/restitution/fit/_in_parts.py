"""Long arrays part by part, with the same bits: Ctrl-C waits for a part, and SciPy keeps little meanwhile."""

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

PART = 2**20
"""Numbers of a part."""


def values(function: Callable[[Array], Any], x: Array) -> Array:
    """Evaluate a function of each number by itself; shape of `x`."""
    if x.size <= PART:
        return np.asarray(function(x))
    found, points = np.empty(x.size), x.ravel()
    for start in range(0, x.size, PART):
        found[start : start + PART] = function(points[start : start + PART])
    return found.reshape(x.shape)


def draws(draw: Callable[[int], Any], number: int) -> Array:
    """Draw in parts with a function that takes the number of draws; shape (number,)."""
    if number <= PART:
        return np.asarray(draw(number))
    found = np.empty(number)
    for start in range(0, number, PART):
        found[start : start + PART] = draw(min(PART, number - start))
    return found


def drawn(distribution: Any, number: int, random: np.random.Generator) -> Array:
    """Draw from a distribution of SciPy, which takes one number after the other."""
    return draws(lambda some: distribution.rvs(size=some, random_state=random), number)
