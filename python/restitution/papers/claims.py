"""A paper's claims: what is measured for each, and the verdict by a stated rule."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Generic, Literal, NamedTuple, TypeVar

from restitution.papers.estimate import Estimate
from restitution.papers.runs import Runs
from restitution.papers.settings import Settings

R = TypeVar("R", bound=Runs)
S = TypeVar("S", bound=Settings)
Verdict = Literal["holds", "holds in part", "fails"]

SIGNIFICANT = 4.0
"""Standard errors from which a difference counts: two-sided 6e−5, about 1 % for a whole report."""


@dataclass(frozen=True)
class Measurement:
    """A measured number, with its standard error but for a count, an extreme or a p-value."""

    name: str
    value: float
    error: float | None = None
    unit: str = ""
    at: str = ""  # what distinguishes it from others of the same name, such as the impact velocity


class Finding(NamedTuple):
    """Outcome of a claim: the numbers measured and the verdict that follows from them."""

    measured: tuple[Measurement, ...]
    verdict: Verdict
    rule: str  # how the verdict follows from the numbers
    why: str  # a sentence on what the numbers show


@dataclass(frozen=True)
class Claim:
    """A claim of a paper, judged."""

    key: str  # short, unique, an anchor of the report
    quote: str
    where: str  # the section, figure or equation
    finding: Finding


class Claims(Generic[R, S]):
    """Claims of a paper, each with the function that judges it from the runs and the settings.

    Each verdict follows from the numbers by the claim's stated rule. Impacts of one particle are correlated,
    so every standard error takes each particle as one draw, and every p-value rests on at most one impact of
    each.
    """

    def __init__(self, *parts: "Claims[R, S]") -> None:
        self._judges: dict[str, tuple[str, str, Callable[[R, S], Finding]]] = {}
        for part in parts:
            self._judges |= part._judges

    def add(
        self, key: str, quote: str, where: str
    ) -> Callable[[Callable[[R, S], Finding]], Callable[[R, S], Finding]]:
        """Add the claim that the decorated function judges."""

        def decorate(find: Callable[[R, S], Finding]) -> Callable[[R, S], Finding]:
            self._judges[key] = (quote, where, find)
            return find

        return decorate

    def judge(self, runs: R, settings: S, *keys: str) -> list[Claim]:
        """Judge the claims of these keys, or all in the order in which they were added."""
        chosen = {key: self._judges[key] for key in keys or self._judges}
        return [
            Claim(key, quote, where, find(runs, settings)) for key, (quote, where, find) in chosen.items()
        ]


def verdict(holds: bool, in_part: bool) -> Verdict:
    """Turn two conditions, the first of which is the stronger, into a verdict."""
    return "holds" if holds else "holds in part" if in_part else "fails"


def listed(
    name: str, labels: Iterable[str], values: Estimate | Sequence[float], unit: str = ""
) -> tuple[Measurement, ...]:
    """Turn each value of an estimate, or values without error, into measurements at their labels."""
    if isinstance(values, Estimate):
        each = zip(labels, values.value.tolist(), values.error.tolist(), strict=True)
        return tuple(Measurement(name, value, error, unit, at) for at, value, error in each)
    return tuple(Measurement(name, v, None, unit, at) for at, v in zip(labels, values, strict=True))
