"""The ball's shape as the times of a series determine it, and the error budget of its ε."""

import math
from dataclasses import dataclass

import numpy as np
import xarray as xr
from scipy.special import expit

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
from restitution.experiment.listen._agreement import compared, disagreement
from restitution.experiment.listen._setting import Setting
from restitution.laws import Frictionless, Plastic

_PARTICLES = 300
_APART = 5e-3
"""Difference in ε by which a law may be off the best one; or twice the scatter of ε, if that is more.

A surface that makes ε scatter bends ε(v) by as much.
"""


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
