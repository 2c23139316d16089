"""A dilute gas of bodies of any shape: what kinetic theory says of it (`restitution.gas.theory`)."""

from restitution.gas import theory as theory

__all__ = ["theory"]
