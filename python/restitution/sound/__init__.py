"""Recordings of bouncing balls: the impacts that are heard in them."""

from restitution.sound._impacts import impacts

__all__ = ["impacts"]
