"""Recordings of bouncing balls: the impacts that are heard in them."""

from restitution.experiment.sound._impacts import impacts

__all__ = ["impacts"]
