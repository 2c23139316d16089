"""Distributions in closed form: the coefficient of restitution at the first impact from rest (Eqs. 13–22)."""

from restitution.analytic._first_impact import FirstImpact, first_impact

__all__ = ["FirstImpact", "first_impact"]
