"""Laws: what an impact does. And materials: how its normal coefficient depends on the speed."""

from restitution.laws._chatterjee_ruina import ChatterjeeRuina
from restitution.laws._coulomb import Coulomb
from restitution.laws._frictionless import Frictionless
from restitution.laws._law import Law
from restitution.laws._materials import Plastic, Tabulated, Viscoelastic
from restitution.laws._tangential_restitution import TangentialRestitution

__all__ = [
    "LAWS",
    "ChatterjeeRuina",
    "Coulomb",
    "Frictionless",
    "Law",
    "Plastic",
    "Tabulated",
    "TangentialRestitution",
    "Viscoelastic",
]

LAWS = "a TangentialRestitution, Frictionless, Coulomb or ChatterjeeRuina"
"""What may stand for a law, in words."""
