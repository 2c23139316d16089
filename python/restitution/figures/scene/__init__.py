"""Bodies and impacts as one sees them from the side: pictures of a body, of an impact, and films."""

from restitution.figures.scene._film import Film, animate
from restitution.figures.scene._impact import impact
from restitution.figures.scene._portrait import body

__all__ = ["Film", "animate", "body", "impact"]
