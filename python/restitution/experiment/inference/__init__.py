"""What measured times say of a ball: the posterior of its law and of its shape."""

from restitution.experiment.inference._posterior import posterior

__all__ = ["posterior"]
