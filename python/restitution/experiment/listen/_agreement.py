"""The error budget beside the errors that the times themselves show, number by number."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.stats import chi2

from restitution import flight
from restitution._internal.arrays import FloatArray as Array
from restitution._internal.text import digits
from restitution.experiment.budget import ErrorBudget

_FACTOR = 5.0
"""By which one drop may be off the mean over all drops: the angle of release decides how a ball turns."""
_ALONE = ("shape", "roughness", "timing", "tilt", "spin")
"""Sources of which each impact, or each drop, has errors of its own."""
_CHANCE = 1e-3
"""Probability that a number is called off although it is not, if it scatters as the root of χ²/n does."""


class Compared(NamedTuple):
    """A standard deviation by the error budget, and as it was observed.

    Errors that all impacts have in common, as of g, drag or the time of contact, may be taken up by a law.
    """

    name: str
    budget: float  # with these errors
    least: float  # and without
    observed: float
    degrees: float  # of freedom of the observed one

    @property
    def disagree(self) -> bool:
        """Tell that they differ by more than chance and the angle of release explain."""
        least, most = np.sqrt(chi2.ppf([0.5 * _CHANCE, 1.0 - 0.5 * _CHANCE], self.degrees) / self.degrees)
        low, high = min(least, 1.0 / _FACTOR), max(most, _FACTOR)
        return not low * self.least <= self.observed <= high * self.budget


def compared(
    data: xr.Dataset, fits: tuple[flight.LawFit, ...], budget: ErrorBudget, material: float, *, measured: bool
) -> Iterator[Compared]:
    """Compare the scatter of ε about the best law, and the errors of the law that the budget is about.

    Parameters
    ----------
    data : Dataset
        Of `restitution.flight.restitution`.
    fits : tuple of LawFit
        The best first, a constant among them.
    budget : ErrorBudget
    material : float
        Scatter of ε_n itself, which no budget has.
    measured : bool
        Whether the out-of-roundness was. One that is inferred, with its error, contradicts no times that
        scatter less.
    """
    known = np.isfinite(data.restitution.values)
    speed, ratio = data.impact_velocity.values[known], data.restitution.values[known]
    table, total = budget.data, budget.data.sel(source="total")
    order = np.argsort(table.impact_velocity.values)
    alone = table.sel(source=list(_ALONE) if measured else [])
    expected, least = (
        np.hypot(np.interp(speed, table.impact_velocity.values[order], one[order]), material)
        for one in (total.standard_deviation.values, _root(alone.standard_deviation))
    )
    # Errors of times make neighbours depend on one another: half as many are independent.
    degrees = 0.5 * fits[0].degrees_of_freedom
    residual = (ratio - fits[0](speed)) / expected
    usual = float(np.median(expected))
    observed = usual * float(np.sqrt(np.sum(residual**2) / fits[0].degrees_of_freedom))
    yield Compared("the scatter of one ε", usual, float(np.median(least)), observed, degrees)
    if material > 0.0:  # a fit that knows it has larger errors than any source of the budget
        return
    deviations = np.hypot(total.parameter_bias, total.parameter_standard_deviation).values
    least = np.hypot(_root(alone.parameter_bias), _root(alone.parameter_standard_deviation))
    for fit in fits:
        if fit.law == table.attrs["fitted_law"]:
            for (name, stated), error, low in zip(fit.errors.items(), deviations, least, strict=True):
                words = {"restitution": "mean ε"}.get(name, name.replace("_", " "))
                yield Compared(f"the error of the {words}", float(error), float(low), stated, degrees)


def _root(errors: xr.DataArray) -> Array:
    """Return the root of the sum of squares over sources."""
    return np.asarray(np.sqrt((errors**2).sum("source")))


def disagreement(numbers: list[Compared]) -> str:
    """State what disagrees, with both numbers; empty if nothing does."""
    wrong = [one for one in numbers if one.disagree]
    if not wrong:
        return ""
    said = " and ".join(
        f"{one.name} is {digits(one.budget if one.observed > one.budget else one.least)} by the budget, "
        f"{digits(one.observed)} by the times"
        for one in wrong
    )
    why = "Beyond the budget, the material, the plate, a spin at release or another law may scatter ε."
    if wrong[0].observed < wrong[0].budget:
        why = (
            "The ball is rounder than was measured, or hardly turned between impacts, or the "
            "errors of the times are less than stated."
        )
    return f"The error budget and the times disagree: {said}. {why}"
