"""A dilute gas of bodies of any shape, followed (`cool`) and by kinetic theory (`theory`)."""

from restitution.gas import theory as theory
from restitution.gas._cool import GasWarning, cool

__all__ = ["GasWarning", "cool", "theory"]
