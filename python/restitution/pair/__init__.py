"""Two bodies in free flight: encounters followed contact by contact, and the rates of their gas."""

from restitution.pair._encounters import Plane, encounters
from restitution.pair._rates import rates

__all__ = ["Plane", "encounters", "rates"]
