"""Without a simulation: the first impact from rest (Eqs. 13–22), nearly round bodies, rough spheres."""

from restitution.analytic._first_impact import first_impact
from restitution.analytic._frozen import FirstImpact
from restitution.analytic._near_round import near_round
from restitution.analytic._rough import RoughContact, rough_contact, rough_impact, rough_spin
from restitution.analytic._threshold import negative_threshold

__all__ = [
    "FirstImpact",
    "RoughContact",
    "first_impact",
    "near_round",
    "negative_threshold",
    "rough_contact",
    "rough_impact",
    "rough_spin",
]
