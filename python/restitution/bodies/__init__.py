"""Bodies: what falls. All are bodies of revolution, of which the flight between impacts has a closed form."""

from restitution import _core
from restitution._internal.described import one_of
from restitution.bodies._body import Body as Body
from restitution.bodies._dumbbell import Dumbbell
from restitution.bodies._loaded_sphere import LoadedSphere
from restitution.bodies._roundness import GRADES as GRADES
from restitution.bodies._roundness import Form as Form
from restitution.bodies._roundness import ball_grade, from_roundness
from restitution.bodies._spherocylinder import Spherocylinder
from restitution.bodies._spheroid import Spheroid

__all__ = [
    "Dumbbell",
    "LoadedSphere",
    "Spherocylinder",
    "Spheroid",
    "ball_grade",
    "from_roundness",
]

KINDS: tuple[type[Body], ...] = tuple(globals()[entry["name"]] for entry in _core.BODIES)
"""Every body of the core's table."""
BODIES = one_of(_core.BODIES)
