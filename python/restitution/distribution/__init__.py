"""The distribution of ε at given impact velocity, learned from a run."""

from restitution.distribution._fluctuating import FluctuatingRestitution, learn_run
from restitution.distribution._text import image_format

__all__ = ["FluctuatingRestitution", "image_format", "learn_run"]
