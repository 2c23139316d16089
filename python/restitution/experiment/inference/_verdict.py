"""Decide from the times whether the scatter of ε is of the shape, of the material, of both, or none."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Literal, NamedTuple

import numpy as np

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.text import digits
from restitution.experiment.budget.experiment import HEIGHT
from restitution.experiment.inference._family import Family
from restitution.experiment.inference._table import Table

Surface = Literal["shape", "roughness", "surface"]
Cause = Surface | Literal["material", "both", "neither", "undecided"]

_STRONG = 20.0
"""Bayes factor from which an explanation is needed: strong evidence (Kass and Raftery, 1995)."""
_ELONGATION, _SCATTER = 1, 2
_DRAWS = 1000
"""Of a median with one friction."""


_DISAGREES = 0.01
"""Probability of what was observed, below which not even the best ball is one that gives it."""
_SIGNS = (
    "No ball of this kind gives the observed scatter of ε, early and late",
    "The scatter of ε grows less towards low speeds than that of any such ball",
    "One coefficient is farther off than any scatter of the others explains; it is left out",
    "ε follows another law of the speed, or drag or the time of contact is neglected: residuals have a trend",
)


class Verdict(NamedTuple):
    """The cause, and Bayes factors, natural logarithms, of its parts against their absence."""

    cause: Cause
    surface: Surface  # the part of the surface in it
    for_shape: float
    for_scatter: float  # of the material
    for_roughness: float
    for_surface: float
    error: float  # of these, of the finite number of simulated drops


def judge(found: Table, rough: Table | None, smooth: Table, *, scatters: bool) -> Verdict:
    """Compare a surface that is not that of a sphere, a material that scatters, both and neither.

    Surface and material have half the prior probability each of being there; shape and asperities share that
    of the surface. Without them L/R is at the low end of its prior in the table `smooth`, and without scatter
    that of ε_n is.

    The logarithm x of a factor has an error s, as of other simulated drops. Its odds averaged over the error
    are those of x/√(1 + πs²/8), to a few per cent (MacKay, Neural Comput. 4, 720 (1992)), and these are to be
    strong.
    """
    error = math.sqrt(found.noise + (smooth if rough is None else rough).noise)
    strong = math.log(_STRONG) * math.sqrt(1.0 + math.pi / 8.0 * error**2)

    def total(one: Table, *ends: int) -> tuple[float, float]:
        """Return ln of the evidence without and with a material that scatters."""
        if not scatters:
            return one.log_evidence(*ends), -math.inf
        return one.log_evidence(*ends, _SCATTER), one.log_evidence(*ends)

    none = total(smooth, _ELONGATION)
    shape = total(found)
    asperities = (-math.inf, -math.inf) if rough is None else total(rough)
    half = 0.0 if rough is None else math.log(0.5)
    surface = tuple(half + float(np.logaddexp(a, b)) for a, b in zip(shape, asperities, strict=True))

    def against(one: tuple[float, float], other: tuple[float, float]) -> float:
        """Compare a half of what surfaces there are with the rest: the other half, and none."""
        rest = np.logaddexp(np.logaddexp(*none), half + np.logaddexp(*other)) - math.log(1.5 if half else 1.0)
        return float(np.logaddexp(*one) - rest)

    for_surface = float(np.logaddexp(surface[0], surface[1]) - np.logaddexp(*none))
    for_shape, for_roughness = against(shape, asperities), against(asperities, shape)
    for_scatter = float(np.logaddexp(none[1], surface[1]) - np.logaddexp(none[0], surface[0]))
    which: Surface = "surface" if rough is not None else "shape"
    apart = float(np.logaddexp(*shape) - np.logaddexp(*asperities))
    if abs(apart) > strong:
        which = "shape" if apart > 0.0 else "roughness"
    cause: Cause
    match (for_surface > strong, for_scatter > strong):
        case (True, True):
            cause = "both"
        case (True, False):
            cause = which
        case (False, True):
            cause = "material"
        case _:
            most = max(*shape, *asperities, none[1])
            cause = "undecided" if most - none[0] > strong else "neither"
    return Verdict(cause, which, for_shape, for_scatter, for_roughness, for_surface, error)


def agreeing(found: Table, rough: Table | None) -> Table:
    """Return the likelihood of the kind of ball, with a shape or with asperities, that the times agree with.

    If either gives the times, they disagree with no ball; but one that is far less probable is none.
    """
    kinds = [one for one in (found, rough) if one is not None]
    best = max(one.best for one in kinds)
    return max((one for one in kinds if best - one.best < math.log(_STRONG)), key=lambda one: min(one.signs))


def disagreement(found: Table) -> str:
    """Say first what disagrees with the best ball."""
    least = _DISAGREES / len(_SIGNS)
    share, words = min(zip(found.signs, _SIGNS, strict=True), key=lambda each: each[0])
    if share >= least:
        return ""
    p = f"p = {share:.1g}" if share > 0.0 else f"p < {least:.1g}"
    return f"{words} ({p} for the best ball of this kind); what follows holds only for such balls. "


def answer(
    verdict: Verdict, shaped: Mapping[str, Array], roughness: Array | None, most: float, disagrees: str
) -> str:
    """State the result in one line, with intervals of 90 %.

    Given are draws of balls with a shape by name, those of Ra in m, the limit of the out-of-roundness, and
    what disagrees.
    """
    if disagrees:
        return disagrees.split(" (p ")[0]

    def between(values: Array, unit: float = 1e-6) -> str:
        low, high = np.quantile(values, (0.05, 0.95)) / unit
        return f"{digits(low)} to {digits(high)}"

    shape = f"out of round by {between(shaped['out_of_roundness'])} µm"
    asperities = "" if roughness is None else f"rough with Ra = {between(roughness)} µm"
    surfaces = {"shape": shape, "roughness": asperities, "surface": f"{shape}, or {asperities}"}
    either = surfaces[verdict.surface]
    steady = "scatter" not in shaped
    material = "" if steady else f"ε_n scatters by {between(shaped['scatter'], 1.0)}"
    match verdict.cause:
        case "both":
            return f"The ball is {either}, and its {material} (90 %)"
        case "material":
            return f"The material: {material} (90 %)"
        case "neither":
            return f"A sphere explains the times; out of round by less than {digits(1e6 * most)} µm (95 %)"
        case "undecided":
            return "Surface or material: the times do not tell which makes ε scatter"
    return f"The ball is {either} (90 %)" + (", if ε_n does not scatter" if steady else "")


def sentence(
    found: Table,
    rough: Table | None,
    verdict: Verdict,
    family: Family,
    shaped: Mapping[str, Array],
    *,
    unknown: bool,
) -> str:
    """State the result, and the form that it assumes, from draws of balls with a shape by name."""
    form, micrometres = family.words, 0.25 * family.diameter * 1e6
    low, middle, high = np.quantile(shaped["elongation"], (0.05, 0.5, 0.95))
    most = found.limit(_ELONGATION)
    shape = (
        f"L/R = {middle:.2g}, between {low:.2g} and {high:.2g} (90 %), an out-of-roundness of "
        f"{digits(micrometres * middle)} µm, for a ball of the form {form}"
    )
    at_most = f"L/R is below {most:.2g} (95 %), the out-of-roundness below {digits(micrometres * most)} µm"
    if unknown:
        sliding, sticking = _with_each_friction(found)
        shape += (
            f" and unknown friction (without friction L/R = {sliding:.2g}, with contacts that stick "
            f"{sticking:.2g})"
        )
    asperities, either = "", shape
    if rough is not None:
        drawn = np.exp(rough.draws(_DRAWS, np.random.default_rng(1))[0][:, _ELONGATION])
        low, middle, high = 1e6 * np.quantile(drawn, (0.05, 0.5, 0.95)) / HEIGHT
        asperities = f"asperities with Ra = {middle:.2g} µm, between {low:.2g} and {high:.2g} (90 %)"
        if unknown:
            sliding, sticking = (1e6 * one / HEIGHT for one in _with_each_friction(rough))
            asperities += f" (without friction {sliding:.2g}, with contacts that stick {sticking:.2g})"
        most = 1e6 * rough.limit(_ELONGATION) / HEIGHT
        at_most += f", and Ra below {most:.2g} µm"
        either = f"either {shape}; or a round ball with {asperities}"
    at_most += f", for a ball of the form {form}"
    told = {
        "shape": f"The times determine the shape: {shape}",
        "roughness": f"The times determine the roughness of a round ball: {asperities}",
        "surface": f"The surface is not that of a sphere: {either}",
    }[verdict.surface]
    open_still = (
        " The times do not tell which; a measured out-of-roundness or Ra does."
        if verdict.surface == "surface"
        else ""
    )
    undetermined = "The times do not determine the shape"
    round_as_well = f"{undetermined}: a round ball explains them as well. {at_most}."
    if "scatter" not in shaped:
        assumed = told.replace(":", ", if ε_n does not scatter:", 1)
        return f"{assumed}.{open_still}" if verdict.cause == verdict.surface else round_as_well
    below, usual, above = np.quantile(shaped["scatter"], (0.05, 0.5, 0.95))
    material = f"ε_n scatters by {usual:.2g}, between {below:.2g} and {above:.2g} (90 %)"
    at_most_scatter = f"ε_n scatters by less than {found.limit(_SCATTER):.2g} (95 %)"
    match verdict.cause:
        case "shape" | "roughness" | "surface":
            return f"{told}.{open_still} If the material scatters, too, {at_most_scatter}."
        case "material":
            return f"{undetermined}, and need none: the material scatters, {material}. {at_most}."
        case "both":
            return f"{told}; and the material scatters: {material}.{open_still}"
        case "neither":
            return f"{round_as_well} If the material scatters, {at_most_scatter}."
    return (
        f"{undetermined}: ε scatters more than errors of the times explain, but a material that scatters "
        f"explains it as well as a surface. If it is the surface, {at_most}; if it is the material, "
        f"{at_most_scatter}. More drops of the same ball decide."
    )


def _with_each_friction(found: Table) -> list[float]:
    """Return the median of what the second axis is the logarithm of, without friction and sticking."""
    rng = np.random.default_rng(1)
    ends = (replace(found, axes=found.axes[:-1], values=found.values[..., end]) for end in (0, -1))
    return [float(np.exp(np.median(end.draws(_DRAWS, rng)[0][:, _ELONGATION]))) for end in ends]
