"""Collision laws, and materials: how the normal coefficient depends on the speed."""

from restitution import _core
from restitution._internal.described import one_of
from restitution.laws._chatterjee_ruina import ChatterjeeRuina
from restitution.laws._coulomb import Coulomb
from restitution.laws._custom import CustomLaw
from restitution.laws._frictionless import Frictionless
from restitution.laws._law import CollisionLaw as CollisionLaw
from restitution.laws._law import Law as Law
from restitution.laws._law import check_steady as check_steady
from restitution.laws._materials import Material as Material
from restitution.laws._materials import Plastic, Scattered, Tabulated, Viscoelastic
from restitution.laws._tangential_restitution import TangentialRestitution

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
