"""The likelihood on a grid of parameters, and between its points."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.interpolate import RegularGridInterpolator

from restitution._internal.parameters import ParameterError, Problem
from restitution.experiment.inference._family import Family
from restitution.experiment.inference._likelihood import Density
from restitution.experiment.inference._series import Series

Array = npt.NDArray[np.float64]

_GRID = 81
"""Values of the parameter of ε_n."""
_NOISES = 4
"""Times each simulated drop is timed."""


@dataclass(frozen=True)
class Table:
    """Logarithm of the likelihood."""

    axes: tuple[Array, ...]  # the parameter of ε_n, ln L/R, and friction where it is inferred
    values: Array  # over these axes

    def between(self) -> RegularGridInterpolator:
        """Interpolate linearly."""
        return RegularGridInterpolator(self.axes, self.values)


def table(
    series: Sequence[Series],
    family: Family,
    elongations: Array,
    frictions: Sequence[float | None],
    particles: int,
    seed: int,
) -> Table:
    """Simulate at every L/R and friction, at three values of the parameter of ε_n.

    What the numbers of a series are, less the true parameter, hardly depends on the parameter; between the
    three it is taken to be linear in the logarithm.
    """
    middle = float(np.mean([one.observed[0] for one in series]))
    low, high = family.range
    middle = min(max(middle, low + 1e-6), high - 1e-6)
    nodes = [(x, mu) for x in elongations for mu in frictions]

    def densities(value: float, part: int) -> list[list[Density]]:
        found = []
        for number, (x, mu) in enumerate(nodes):
            body, law = family.body(float(x)), family.law_of(value, mu)
            start = seed + 1000003 * (part * len(nodes) + number)
            found.append(
                [
                    Density(one.simulated(body, law, particles, _NOISES, start + 7 * k), value, one.observed)
                    for k, one in enumerate(series)
                ]
            )
        return found

    at_middle = densities(middle, 0)
    width, narrow = _widths(series, at_middle, middle)
    others = [float(np.clip(middle + side * 2.0 * width, low + 1e-9, high)) for side in (-1.0, 1.0)]
    values = [others[0], middle, others[1]]
    sets = [densities(others[0], 1), at_middle, densities(others[1], 2)]
    # Fine where the best balls determine the parameter well, extended to where the worst do.
    steep = np.arcsinh(6.0 * width / narrow)
    grid = middle + narrow * np.sinh(steep * np.linspace(-1.0, 1.0, _GRID))
    grid = np.unique(np.clip(grid, low, high))
    logs = np.zeros((grid.size, len(nodes)))
    for place in range(len(nodes)):
        three = np.array(
            [sum(d(one.observed, grid) for d, one in zip(each[place], series, strict=True)) for each in sets]
        )
        for row, value in enumerate(grid):
            logs[row, place] = np.interp(value, values, three[:, row])
    shape = (grid.size, len(elongations), len(frictions))
    axes: tuple[Array, ...] = (grid, np.log(elongations))
    if frictions[0] is None:
        return Table(axes, logs.reshape(shape[:2]))
    return Table((*axes, np.array(frictions, dtype=np.float64)), logs.reshape(shape))


def _widths(series: Sequence[Series], densities: list[list[Density]], middle: float) -> tuple[float, float]:
    """Return the largest and the smallest scale of the parameter among balls that the series allow."""
    offsets = np.linspace(-3.0, 3.0, 25)
    best, scales = [], []
    for each in densities:
        if not all(one.enough for one in each):
            continue
        scale = min(one.scale for one in each)
        shift = float(np.mean([one.middle for one in each]))
        truths = middle - shift + scale * offsets
        total = sum(d(one.observed, truths) for d, one in zip(each, series, strict=True))
        best.append(float(np.max(total)))
        scales.append(scale + abs(shift) / 3.0)
    if not best:
        text = ": no ball of these shapes bounces as often as this under the law, with its coefficients"
        raise ParameterError(Problem("data", text))
    allowed = [scale for scale, value in zip(scales, best, strict=True) if value > max(best) - 12.0]
    return max(allowed), min(allowed)
