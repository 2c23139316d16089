"""The distribution of ε at given impact velocity, learned from a run."""

from restitution.distribution._fluctuating import FluctuatingRestitution

__all__ = ["FluctuatingRestitution"]
