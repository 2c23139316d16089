"""Closed forms: the coefficient of restitution at the first impact from rest (Eqs. 13–22)."""

from restitution.analytic._first_impact import first_impact
from restitution.analytic._frozen import FirstImpact
from restitution.analytic._threshold import negative_threshold

__all__ = ["FirstImpact", "first_impact", "negative_threshold"]
