"""Description of a paper, from which it is redrawn and judged."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic

from restitution.figures.report import Section
from restitution.papers.claims import Claims, R, S
from restitution.papers.figures import PaperFigure
from restitution.papers.misprints import Misprint
from restitution.papers.runs import Runner


@dataclass(frozen=True)
class Paper(Generic[R, S]):
    """A paper that is redrawn and judged."""

    title: str  # of the report
    reference: str  # with DOI
    command: str  # that makes the report, without number of impacts and seed
    settings: S
    least: int  # impacts to ask for at least
    number: int  # of runs that `simulate` makes
    simulate: Callable[[S, int, Runner], R]  # from the settings, and the number of impacts asked for
    about: Callable[[R], str]  # what was simulated, in a sentence or two
    columns: Mapping[str, Callable[[Mapping[str, Any]], str]]  # of the table of runs, from their attributes
    figures: Sequence[PaperFigure[R, S]]
    claims: Claims[R, S]
    misprints: Sequence[Misprint] = ()
    sections: Callable[[R, S], Sequence[Section]] = lambda runs, settings: ()  # that no other paper has
