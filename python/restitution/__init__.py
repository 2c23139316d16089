"""The coefficient of restitution as a distribution, not a number."""

from restitution.bodies import Dumbbell
from restitution.laws import TangentialRestitution

__all__ = ["Dumbbell", "TangentialRestitution"]
