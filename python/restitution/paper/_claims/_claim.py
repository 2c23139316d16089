"""What a judged claim is."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import floor, isfinite, isnan, log10
from typing import Literal

from restitution.paper._claims._estimate import Estimate

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
        Condition that tells it from others of the same name, such as the impact velocity.
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


def with_error(value: float, error: float | None) -> str:
    """Write `value` ± `error` to two digits of the error, or without error to four digits.

    An error of 0, as of a share of which no example was met, is left out.
    """
    if not isfinite(value):
        return "no data" if isnan(value) else str(value)
    if error is None or not isfinite(error) or error <= 0:
        whole = value == round(value) and abs(value) < 1e9
        return f"{value:,.0f}".replace(",", "\u202f") if whole else _superscript(f"{value:.4g}")
    digits = 1 - floor(log10(error))
    if digits > 6:
        power = floor(log10(max(abs(value), error)))
        value, error, digits = value / 10.0**power, error / 10.0**power, digits + power
        return _superscript(f"({value:.{digits}f} ± {error:.{digits}f})e{power}")
    return f"{round(value, digits):.{max(digits, 0)}f} ± {round(error, digits):.{max(digits, 0)}f}"


def _superscript(text: str) -> str:
    mantissa, mark, exponent = text.partition("e")
    power = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")) if mark else ""
    return f"{'' if mantissa == '1' else f'{mantissa} × '}10{power}" if mark else mantissa
