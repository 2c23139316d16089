"""What a judged claim is."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from restitution._internal.text import with_error
from restitution.papers.glielmo2014._claims._estimate import Estimate

Verdict = Literal["holds", "holds in part", "fails"]

SIGNIFICANT = 4.0
"""Standard errors from which a difference counts: two-sided 6e−5, about 1 % for a whole report."""


@dataclass(frozen=True)
class Measurement:
    """A measured number.

    Attributes
    ----------
    name : str
    value : float
    error : float or None
        Standard error; None for a count, an extreme or a p-value.
    unit : str
    at : str
        Condition that distinguishes it from others of the same name, such as the impact velocity.
    """

    name: str
    value: float
    error: float | None = None
    unit: str = ""
    at: str = ""

    @property
    def number(self) -> str:
        """Value ± error and unit, as text."""
        return f"{with_error(self.value, self.error)} {self.unit}".rstrip()

    def __str__(self) -> str:
        return f"{self.name}{', ' if self.at else ''}{self.at} = {self.number}"


@dataclass(frozen=True)
class Claim:
    """A claim of the paper, judged.

    Attributes
    ----------
    key : str
        Short name, unique, usable as an anchor.
    quote, where : str
        What the paper says, and in which section, figure or equation.
    measured : tuple of Measurement
    verdict : {"holds", "holds in part", "fails"}
    rule : str
        How the verdict follows from the numbers.
    why : str
        A sentence on what the numbers show.
    """

    key: str
    quote: str
    where: str
    measured: tuple[Measurement, ...]
    verdict: Verdict
    rule: str
    why: str


def verdict(holds: bool, in_part: bool) -> Verdict:
    """Turn two conditions, the first of which is the stronger, into a verdict."""
    return "holds" if holds else "holds in part" if in_part else "fails"


def listed(name: str, labels: Iterable[str], estimate: Estimate) -> tuple[Measurement, ...]:
    """Turn each value of an estimate into a measurement at its label."""
    values = zip(labels, estimate.value, estimate.error, strict=True)
    return tuple(Measurement(name, float(value), float(error), at=label) for label, value, error in values)
