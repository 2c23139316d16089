"""What a paper gives to the machinery that redraws and judges it."""

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
    """A paper that is redrawn and judged.

    Attributes
    ----------
    title, reference : str
        Of the report; and where the paper stands, with its DOI.
    command : str
        What makes the report on the command line, without number of impacts and seed.
    settings : Settings
    least : int
        Impacts to ask for at least.
    number : int
        Runs that `simulate` makes.
    simulate : callable
        Makes all runs, from the settings, the number of impacts asked for and a `Runner`.
    about : callable
        Says in a sentence or two what was simulated.
    columns : mapping
        Of the table of runs: parameters of a run, from its attributes.
    figures, misprints : sequence
    claims : Claims
    sections : callable, optional
        Gives the sections of the report that no other paper has.
    """

    title: str
    reference: str
    command: str
    settings: S
    least: int
    number: int
    simulate: Callable[[S, int, Runner], R]
    about: Callable[[R], str]
    columns: Mapping[str, Callable[[Mapping[str, Any]], str]]
    figures: Sequence[PaperFigure[R, S]]
    claims: Claims[R, S]
    misprints: Sequence[Misprint] = ()
    sections: Callable[[R, S], Sequence[Section]] = lambda runs, settings: ()
