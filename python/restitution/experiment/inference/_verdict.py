"""Decide from the times whether the scatter of ε is of the shape, of the material, of both, or none."""

import math
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from restitution._internal.text import digits
from restitution.experiment.inference._table import Table

Array = npt.NDArray[np.float64]
Cause = Literal["shape", "material", "both", "neither", "undecided"]

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
    """Bayes factors, natural logarithms, and the cause that follows."""

    cause: Cause
    for_shape: float  # of balls with a shape, against round ones
    for_scatter: float  # of materials that scatter, against those that do not


def judge(found: Table, *, scatters: bool) -> Verdict:
    """Compare shape, material, both and neither, each with half the prior probability of being there.

    Without a shape L/R is at the low end of its prior, without scatter that of ε_n is.
    """
    if not scatters:
        shape, neither = found.log_evidence(), found.log_evidence(_ELONGATION)
        told = shape - neither > math.log(_STRONG)
        return Verdict("shape" if told else "neither", shape - neither, -math.inf)
    both, material = found.log_evidence(), found.log_evidence(_ELONGATION)
    shape, neither = found.log_evidence(_SCATTER), found.log_evidence(_ELONGATION, _SCATTER)
    for_shape = float(np.logaddexp(shape, both) - np.logaddexp(material, neither))
    for_scatter = float(np.logaddexp(material, both) - np.logaddexp(shape, neither))
    strong = math.log(_STRONG)
    cause: Cause
    match (for_shape > strong, for_scatter > strong):
        case (True, True):
            cause = "both"
        case (True, False):
            cause = "shape"
        case (False, True):
            cause = "material"
        case _:
            cause = "undecided" if max(shape, material, both) - neither > strong else "neither"
    return Verdict(cause, for_shape, for_scatter)


def disagreement(found: Table) -> str:
    """Say first what disagrees with the best ball."""
    wrong = [
        (share, words)
        for share, words in zip(found.signs, _SIGNS, strict=True)
        if share < _DISAGREES / len(_SIGNS)
    ]
    if not wrong:
        return ""
    share, words = min(wrong, key=lambda each: each[0])
    p = f"p = {share:.1g}" if share > 0.0 else f"p < {_DISAGREES / len(_SIGNS):.1g}"
    return f"{words} ({p} for the best ball of this kind); what follows holds only for such balls. "


def sentence(
    found: Table,
    verdict: Verdict,
    form: str,
    diameter: float,
    elongation: Array,
    scatter: Array | None,
    *,
    unknown: bool,
) -> str:
    """State the result, and the form that it assumes."""
    micrometres = 0.25 * diameter * 1e6
    low, middle, high = np.quantile(elongation, (0.05, 0.5, 0.95))
    most = found.limit(_ELONGATION)
    shape = (
        f"L/R = {middle:.2g}, between {low:.2g} and {high:.2g} (90 %), an out-of-roundness of "
        f"{digits(micrometres * middle)} µm, for a ball of the form {form}"
    )
    if unknown:
        rng = np.random.default_rng(1)
        sliding, sticking = (
            float(np.exp(np.median(found.at_friction(end).draws(_DRAWS, rng)[0][:, _ELONGATION])))
            for end in (0, -1)
        )
        shape += (
            f" and unknown friction (without friction L/R = {sliding:.2g}, with contacts that stick "
            f"{sticking:.2g})"
        )
    at_most = (
        f"L/R is below {most:.2g} (95 %), the out-of-roundness below {digits(micrometres * most)} µm, for a "
        f"ball of the form {form}"
    )
    undetermined = "The times do not determine the shape"
    round_as_well = f"{undetermined}: a round ball explains them as well. {at_most}."
    if scatter is None:
        told = f"The times determine the shape, if ε_n does not scatter: {shape}."
        return told if verdict.cause == "shape" else round_as_well
    below, usual, above = np.quantile(scatter, (0.05, 0.5, 0.95))
    material = f"ε_n scatters by {usual:.2g}, between {below:.2g} and {above:.2g} (90 %)"
    at_most_scatter = f"ε_n scatters by less than {found.limit(_SCATTER):.2g} (95 %)"
    match verdict.cause:
        case "shape":
            return (
                f"The times determine the shape: {shape}. If the material scatters, too, {at_most_scatter}."
            )
        case "material":
            return f"{undetermined}, and need none: the material scatters, {material}. {at_most}."
        case "both":
            return f"The times determine the shape: {shape}; and the material scatters: {material}."
        case "neither":
            return f"{round_as_well} If the material scatters, {at_most_scatter}."
    return (
        f"{undetermined}: ε scatters more than errors of the times explain, but a material that scatters "
        f"explains it as well as a shape. If it is the shape, {at_most}; if it is the material, "
        f"{at_most_scatter}. More drops of the same ball decide."
    )
