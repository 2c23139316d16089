"""The ball's shape as the times of a series determine it, and the error budget beside what they show."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr
from scipy.special import expit
from scipy.stats import chi2

from restitution import flight
from restitution._internal.arrays import FloatArray as Array
from restitution._internal.datasets import Content
from restitution._internal.parameters import ParameterError, TooLargeError
from restitution._internal.text import digits
from restitution.bodies import Form, from_roundness
from restitution.experiment.budget import ErrorBudget, error_budget
from restitution.experiment.budget.experiment import ROUGHEST, at
from restitution.experiment.flight.laws import sphere_with
from restitution.experiment.inference import posterior
from restitution.experiment.listen._setting import Setting
from restitution.laws import Frictionless, Plastic

_PARTICLES = 300
_APART = 5e-3
"""Difference in ε by which a law may be off the best one; or twice the scatter of ε, if that is more.

A surface that makes ε scatter bends ε(v) by as much.
"""
_FACTOR = 5.0
"""By which one drop may be off the mean over all drops: the angle of release decides how a ball turns."""
_ALONE = ("shape", "roughness", "timing", "tilt", "spin")
"""Sources of which each impact, or each drop, has errors of its own."""
_CHANCE = 1e-3
"""Probability that a number is called off although it is not, if it scatters as the root of χ²/n does."""


@dataclass(frozen=True, eq=False)
class Shape(Content):
    """Posterior and error budget of one series.

    Attributes
    ----------
    law : Frictionless
        With ε_n as it fits the series best.
    draws : DataTree or None
        The posterior; None where there are too few impacts, or no law of a ball fits.
    verdict : str
        What it says of the shape, or why there is none.
    budget : ErrorBudget or None
    assumed : str
        The shape that the budget is about, or why there is none.
    disagreement : str
        What the budget and the times say differently; empty if nothing.
    """

    law: Frictionless
    draws: xr.DataTree | None
    verdict: str
    budget: ErrorBudget | None
    assumed: str
    disagreement: str = ""

    @property
    def bends(self) -> bool:
        """Tell that the surface of the ball may be why ε depends on the speed."""
        return self.draws is not None and self.draws.attrs["explained_by"] not in ("neither", "material")


def shape(drops: list[xr.Dataset], fits: tuple[flight.LawFit, ...], setting: Setting) -> Shape | None:
    """Infer a ball's shape from its drops, and budget the errors of one.

    None where no law was fitted, or the errors of the times are not known.
    """
    if not all(one.uncertainty.fillna(0.0).any() for one in drops):
        return None
    data = drops[0]
    found = _law(fits, np.concatenate([one.impact_velocity.values for one in drops]))
    if found is None:
        return None
    law, apart = found
    draws, verdict = (
        None,
        "A power law fits far better than the law of any ball; no shape is inferred from that.",
    )
    if apart <= max(_APART, 2.0 * fits[0].scatter):
        try:
            draws = posterior(
                drops if len(drops) > 1 else data,
                law.normal,
                diameter=setting.diameter,
                wall=setting.wall,
                out_of_roundness=setting.out_of_roundness,
                roughness=setting.roughness,
                particles=_PARTICLES,
            )
            verdict = str(draws.attrs["verdict"])
        except TooLargeError:
            raise
        except ParameterError as error:
            verdict = f"No shape is inferred: {error}."
    t, ra, assumed = _surface(setting.out_of_roundness, setting.roughness, draws)
    form: Form = "dumbbell" if draws is None else draws.attrs["form"]
    if t is None:
        return Shape(law, draws, verdict, None, assumed)
    diameter, wall, drag = setting.diameter, setting.wall, setting.drag
    density = 2500.0
    if setting.mass is not None:
        density = setting.mass / from_roundness(diameter, 0.0, density=1.0, wall=wall).mass
    try:
        budget = error_budget(
            from_roundness(diameter, t, density=density, form=form, wall=wall),
            law.normal,
            drop=_drop(data, law),
            roughness=min(ra, ROUGHEST * 0.5 * diameter),
            impacts=int(np.isfinite(data.restitution).sum()),
            timing=float(np.nanmedian(data.uncertainty)),
            gravity=float(data.attrs["gravity"]),
            gravity_uncertainty=float(data.attrs["gravity_uncertainty"]),
            clock_uncertainty=float(data.attrs["clock_uncertainty"]),
            drop_uncertainty=float(data.attrs.get("drop_height_uncertainty", 0.0)),
            drag=drag,
            drag_corrected=drag is not None,
            contact_time=setting.contact,
            contact_corrected=True,
        )
    except TooLargeError:
        raise
    except ParameterError as error:
        return Shape(law, draws, verdict, None, f"No budget of errors: {error}.")
    if len(drops) > 1:  # whose mean the budget of one drop is not about
        return Shape(law, draws, verdict, budget, assumed)
    measured = setting.out_of_roundness is not None
    numbers = list(compared(data, fits, budget, _material(draws), measured=measured))
    return Shape(law, draws, verdict, budget, assumed, disagreement(numbers))


def _material(draws: xr.DataTree | None) -> float:
    """Return the scatter of ε_n itself, where the times need it."""
    if draws is None or draws.attrs["explained_by"] not in ("material", "both"):
        return 0.0
    return float(draws["posterior"].to_dataset().scatter.median())


def _law(fits: tuple[flight.LawFit, ...], speed: Array) -> tuple[Frictionless, float] | None:
    """Return the best law that is physical, and the largest difference of its ε from the best of all."""
    known = speed[np.isfinite(speed)]
    for fit in fits:
        apart = float(np.abs(fit(known) - fits[0](known)).max())
        value = next(iter(fit.parameters.values()))
        if fit.law == "constant" and 0.0 < value < 1.0:
            return Frictionless(normal=value), apart
        if fit.law == "plastic":
            return Frictionless(normal=Plastic(yield_speed=value)), apart
        if fit.law == "viscoelastic" and value > 0.0:
            return Frictionless(normal=sphere_with(value)), apart
    return None


def _surface(
    measured: float | None, roughness: float | None, draws: xr.DataTree | None
) -> tuple[float | None, float, str]:
    """Choose the out-of-roundness and Ra of the budget, in m, and say which.

    The variance of ε goes as t⁴, and as Ra². That of the budget is the mean over the posterior, in which a
    sphere has the weight that its probability gives it.
    """
    if measured is not None:
        assumed = f"The out-of-roundness is {1e6 * measured:.3g} µm, as measured"
        of_surface = "" if roughness is None else f", and Ra {1e6 * roughness:.3g} µm"
        return measured, roughness or 0.0, f"{assumed}{of_surface}."
    if draws is None:
        return None, 0.0, "No budget of errors without an out-of-roundness; give it."
    share = float(expit(draws.attrs["log_bayes_factor_surface"]))
    begin = f"By the posterior the surface is not that of a sphere with a probability of {digits(share)}"
    if draws.attrs["explained_by"] == "roughness":
        ra = math.sqrt(share * float((draws["rough"].to_dataset().roughness ** 2).mean()))
        return (
            0.0,
            ra,
            f"{begin}. The budget is of Ra = {digits(1e6 * ra)} µm, which has its mean variance of ε.",
        )
    t = (share * float((draws["posterior"].to_dataset().out_of_roundness ** 4).mean())) ** 0.25
    what = f"an out-of-roundness of {digits(1e6 * t)} µm"
    return t, 0.0, f"{begin}. The budget is of {what}, which has its mean variance of ε."


def _drop(data: xr.Dataset, law: Frictionless) -> float:
    """Return the height of the drop, as measured or as it follows from the first flight."""
    if "drop_height" in data.attrs:
        return float(data.attrs["drop_height"])
    intervals = np.diff(data.time.values)
    up = 0.5 * float(data.attrs["gravity"]) * float(intervals[np.isfinite(intervals)][0])
    return (up / float(at(law, np.array(up)))) ** 2 / (2.0 * float(data.attrs["gravity"]))


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
