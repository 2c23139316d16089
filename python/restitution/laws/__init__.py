"""Collision laws, and materials: how the normal coefficient depends on the speed."""

from restitution._internal.parameters import listed
from restitution.laws._chatterjee_ruina import ChatterjeeRuina
from restitution.laws._coulomb import Coulomb
from restitution.laws._frictionless import Frictionless
from restitution.laws._law import Law, check_steady
from restitution.laws._materials import Material, Plastic, Scattered, Tabulated, Viscoelastic
from restitution.laws._tangential_restitution import TangentialRestitution

__all__ = [
    "KINDS",
    "LAWS",
    "MATERIALS",
    "ChatterjeeRuina",
    "Coulomb",
    "Frictionless",
    "Law",
    "Material",
    "Plastic",
    "Scattered",
    "Tabulated",
    "TangentialRestitution",
    "Viscoelastic",
    "check_steady",
]

KINDS = (TangentialRestitution, Frictionless, Coulomb, ChatterjeeRuina)
"""Every law."""
MATERIALS = (Viscoelastic, Plastic, Tabulated, Scattered)
"""Every material."""
LAWS = f"a {listed(KINDS)}"
"""The laws, listed in words for error texts."""
