"""Collision laws, and materials: how the normal coefficient depends on the speed."""

from restitution import _core
from restitution._internal.described import one_of
from restitution.laws._custom import CustomLaw
from restitution.laws._laws import ChatterjeeRuina, Coulomb, Frictionless, TangentialRestitution
from restitution.laws._laws import CollisionLaw as CollisionLaw
from restitution.laws._laws import Law as Law
from restitution.laws._laws import check_steady as check_steady
from restitution.laws._materials import Material as Material
from restitution.laws._materials import Plastic, Scattered, Tabulated, Viscoelastic

__all__ = [
    "ChatterjeeRuina",
    "Coulomb",
    "CustomLaw",
    "Frictionless",
    "Plastic",
    "Scattered",
    "Tabulated",
    "TangentialRestitution",
    "Viscoelastic",
]

KINDS: tuple[type[Law], ...] = tuple(globals()[entry["name"]] for entry in _core.LAWS)
"""Every law of the core's table."""
MATERIALS: tuple[type[Material], ...] = tuple(globals()[entry["name"]] for entry in _core.MATERIALS)
"""Every material of the core's table."""
LAWS = one_of(_core.LAWS)
"""The laws, listed in words for error texts."""
