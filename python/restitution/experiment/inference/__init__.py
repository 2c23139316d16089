"""Inference from measured times: the posterior of a ball's law and shape."""

from restitution.experiment.inference._posterior import posterior

__all__ = ["posterior"]
