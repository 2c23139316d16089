"""Description of a paper, from which it is redrawn and judged, and of its misprints."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Generic, Literal, NamedTuple

import xarray as xr

from restitution.figures.report import Section
from restitution.papers.claims import Claims, R, S
from restitution.papers.figures import PaperFigure
from restitution.papers.runs import DROPPED, Runner


class Check(NamedTuple):
    """Three numbers for one quantity; the last two agree."""

    printed: float
    right: float
    independent: float


@dataclass(frozen=True)
class Misprint:
    """A formula that disagrees with the paper's own model, with a proof and with numbers."""

    equation: str  # the paper's label
    kind: Literal["misprint", "caveat"]  # wrong, or of smaller range than it seems
    printed: str
    corrected: str
    proof: str  # why the printed formula cannot be right
    quantity: str  # what `check` calculates
    check: Callable[[], Check]


@dataclass(frozen=True)
class Paper(Generic[R, S]):
    """A paper that is redrawn and judged."""

    title: str  # of the report
    reference: str  # with DOI
    command: str  # that makes the report, without number of impacts and seed
    settings: S
    least: int  # of what `size` counts, to ask for at least
    usual: int  # of these where nobody says
    number: int  # of runs that `simulate` makes
    simulate: Callable[[S, int, Runner], R]  # from the settings, and the number asked for
    about: Callable[[R], str]  # what was simulated, in a sentence or two
    columns: Mapping[str, Callable[[Mapping[str, Any]], str]]  # of the table of runs, from their attributes
    figures: Sequence[PaperFigure[R, S]]
    claims: Claims[R, S]
    misprints: Sequence[Misprint] = ()
    sections: Callable[[R, S], Sequence[Section]] = lambda runs, settings: ()  # that no other paper has
    size: str = "impacts"  # what the number counts that one asks for
    sizes: Mapping[str, Callable[[xr.Dataset], str]] = field(default_factory=lambda: DROPPED)  # of a run
    errors: str = (
        "Impacts of one particle are correlated, so each particle counts as one draw in every standard "
        "error, and p-values rest on at most one impact of each particle at a speed."
    )
    ends: str = (
        "A trajectory that collapses has infinitely many impacts in finite time; it ends there and nothing "
        "is regularised. Counted impacts are not recorded; the recorded run consists of the first particles "
        "of the run of the same seed."
    )
