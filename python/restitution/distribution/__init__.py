"""The distribution of ε at given impact velocity, learned from a run."""

from restitution.distribution._check import DistanceWarning
from restitution.distribution._fluctuating import FluctuatingRestitution, image, image_format
from restitution.distribution._from_statistics import quantiles
from restitution.distribution._store import in_gaps, sealed

__all__ = [
    "DistanceWarning",
    "FluctuatingRestitution",
    "image",
    "image_format",
    "in_gaps",
    "quantiles",
    "sealed",
]
