"""Bodies: what falls. All are bodies of revolution, of which the flight between impacts has a closed form."""

from restitution._internal.parameters import listed
from restitution.bodies._body import Body
from restitution.bodies._dumbbell import Dumbbell
from restitution.bodies._loaded_sphere import LoadedSphere
from restitution.bodies._roundness import GRADES, Form, ball_grade, from_roundness
from restitution.bodies._spherocylinder import Spherocylinder
from restitution.bodies._spheroid import Spheroid

__all__ = [
    "BODIES",
    "GRADES",
    "KINDS",
    "Body",
    "Dumbbell",
    "Form",
    "LoadedSphere",
    "Spherocylinder",
    "Spheroid",
    "ball_grade",
    "from_roundness",
]

KINDS = (Dumbbell, LoadedSphere, Spherocylinder, Spheroid)
"""Every body."""
BODIES = f"a {listed(KINDS)}"
