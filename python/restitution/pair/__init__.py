"""Two bodies in free flight: encounters followed contact by contact, and rates and kernels of their gas."""

from restitution.pair._encounters import Plane as Plane
from restitution.pair._encounters import encounters
from restitution.pair._kernel import KernelDraw
from restitution.pair._kernel import PairKernel as PairKernel
from restitution.pair._rates import rates

__all__ = ["KernelDraw", "encounters", "rates"]
