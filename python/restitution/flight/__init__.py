"""Bouncing-ball experiments: from times of impacts to ε(v), its errors, and the laws that fit it."""

from typing import TYPE_CHECKING, Any

from restitution.flight._clock import clock
from restitution.flight._drag import Drag
from restitution.flight._fit import compare, fit
from restitution.flight._law_fit import LawFit
from restitution.flight._read import read
from restitution.flight._restitution import restitution

if TYPE_CHECKING:
    from restitution.flight._figure import figure

__all__ = ["Drag", "LawFit", "clock", "compare", "figure", "fit", "read", "restitution"]


def __getattr__(name: str) -> Any:
    """Import Matplotlib when something is drawn."""
    if name != "figure":
        raise AttributeError(f"module 'restitution.flight' has no attribute {name!r}")
    from restitution.flight._figure import figure

    return figure
