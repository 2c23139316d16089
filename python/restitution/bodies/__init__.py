"""Bodies: what falls. All are bodies of revolution, of which the flight between impacts has a closed form."""

from restitution.bodies._body import Body
from restitution.bodies._dumbbell import Dumbbell
from restitution.bodies._loaded_sphere import LoadedSphere
from restitution.bodies._spherocylinder import Spherocylinder
from restitution.bodies._spheroid import Spheroid

__all__ = ["BODIES", "Body", "Dumbbell", "LoadedSphere", "Spherocylinder", "Spheroid"]

BODIES = "a Dumbbell, LoadedSphere, Spherocylinder or Spheroid"
