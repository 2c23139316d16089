"""Verdicts and kinds of misprints as HTML, in the colours of their weight."""

from restitution.figures.report import text
from restitution.papers.glielmo2014._claims import Verdict

_CLASSES: dict[Verdict, str] = {"holds": "holds", "holds in part": "part", "fails": "fails"}


def badge(verdict: Verdict) -> str:
    """Name a verdict, in its colour."""
    return f'<span class="badge {_CLASSES[verdict]}">{text(verdict)}</span>'


def mark(kind: str, serious: bool) -> str:
    """Name a kind of misprint, in the colour of its weight."""
    return f'<span class="badge {"fails" if serious else "part"}">{text(kind)}</span>'


def count(verdict: Verdict, number: int) -> str:
    """Say how many claims have this verdict, as a list item."""
    words = verdict if number == 1 else verdict.replace("holds", "hold").replace("fails", "fail")
    return f'<li class="{_CLASSES[verdict]}"><b>{number}</b> {text(words)}</li>'
