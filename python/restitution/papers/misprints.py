"""Misprints in a paper: formulas that disagree with its own model, each with a proof and with numbers."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, NamedTuple


class Check(NamedTuple):
    """Three numbers for one quantity; the last two agree."""

    printed: float
    right: float
    independent: float


@dataclass(frozen=True)
class Misprint:
    """A formula that is not right as printed."""

    equation: str  # the paper's label
    kind: Literal["misprint", "caveat"]  # wrong, or of smaller range than it seems
    printed: str
    corrected: str
    proof: str  # why the printed formula cannot be right
    quantity: str  # what `check` calculates
    check: Callable[[], Check]
