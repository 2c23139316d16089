"""Bouncing-ball experiments: from times of impacts to ε(v), its errors, and the laws that fit it."""

from typing import TYPE_CHECKING, Any

from restitution.experiment.flight._fit import compare, fit
from restitution.experiment.flight._law_fit import LawFit
from restitution.experiment.flight._read import read
from restitution.experiment.flight._restitution import clock, restitution
from restitution.experiment.flight.contact import ContactTime
from restitution.experiment.flight.drag import Drag

if TYPE_CHECKING:
    from restitution.experiment.flight._figure import figure

__all__ = ["ContactTime", "Drag", "LawFit", "clock", "compare", "figure", "fit", "read", "restitution"]


def __getattr__(name: str) -> Any:
    """Import Matplotlib when something is drawn."""
    if name != "figure":
        raise AttributeError(f"module 'restitution.experiment.flight' has no attribute {name!r}")
    from restitution.experiment.flight._figure import figure

    return figure
