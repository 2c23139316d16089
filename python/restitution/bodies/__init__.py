"""Bodies: what falls. That of bodies of revolution has a closed form; other rigid bodies have any shape."""

from restitution import _core
from restitution._internal.described import one_of
from restitution.bodies._axial import Dumbbell, LoadedSphere, Spherocylinder, Spheroid
from restitution.bodies._axial import Wall as Wall
from restitution.bodies._body import AnyBody as AnyBody
from restitution.bodies._body import Body as Body
from restitution.bodies._body import of_attributes as of_attributes
from restitution.bodies._clump import Clump
from restitution.bodies._ellipsoid import Ellipsoid, Superellipsoid
from restitution.bodies._ellipsoid import farthest as farthest
from restitution.bodies._ellipsoid import outermost as outermost
from restitution.bodies._mesh import Mesh
from restitution.bodies._polyhedra import Box, ConvexPolyhedron, Die
from restitution.bodies._revolution import Cylinder, Egg, Revolution, Ring, TruncatedCone
from restitution.bodies._revolution import Turned as Turned
from restitution.bodies._rigid import RigidBody as RigidBody
from restitution.bodies._rigid import directions as directions
from restitution.bodies._rough import Rough, RoughSphere
from restitution.bodies._roundness import GRADES as GRADES
from restitution.bodies._roundness import ROUGHNESS as ROUGHNESS
from restitution.bodies._roundness import Form as Form
from restitution.bodies._roundness import ball_grade, ball_roughness, from_roundness

__all__ = [
    "Box",
    "Clump",
    "ConvexPolyhedron",
    "Cylinder",
    "Die",
    "Dumbbell",
    "Egg",
    "Ellipsoid",
    "LoadedSphere",
    "Mesh",
    "Revolution",
    "Ring",
    "Rough",
    "RoughSphere",
    "Spherocylinder",
    "Spheroid",
    "Superellipsoid",
    "TruncatedCone",
    "ball_grade",
    "ball_roughness",
    "from_roundness",
]

_ENTRIES = [[one for one in _core.BODIES if one["rigid"] is rigid] for rigid in (False, True)]
KINDS: tuple[type[Body], ...] = tuple(globals()[entry["name"]] for entry in _ENTRIES[0])
"""Every body of the core's table whose hull has a closed form, all of revolution."""
RIGID: tuple[type[RigidBody], ...] = (*(globals()[entry["name"]] for entry in _ENTRIES[1]), Rough)
"""Every other body, and what makes another one rough."""
BODIES = one_of(_ENTRIES[0])
ANY_BODIES = one_of([*_core.BODIES, {"name": Rough.__name__}])
