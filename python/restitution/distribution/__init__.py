"""The distribution of ε at given impact velocity, learned from a run."""

from typing import TYPE_CHECKING

from restitution.distribution._check import DistanceWarning
from restitution.distribution._fluctuating import FluctuatingRestitution
from restitution.distribution._from_statistics import quantiles
from restitution.distribution._store import sealed
from restitution.distribution._text import image_format, in_gaps

if TYPE_CHECKING:
    from restitution.distribution._figure import image

__all__ = [
    "DistanceWarning",
    "FluctuatingRestitution",
    "image",
    "image_format",
    "in_gaps",
    "quantiles",
    "sealed",
]


def __getattr__(name: str) -> object:
    """Import Matplotlib when a figure is asked for."""
    if name == "image":
        from restitution.distribution._figure import image

        return image
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
