"""Errors of a bouncing-ball experiment: what shape, timing, g, plate, spin and air do to ε."""

from restitution.budget._error_budget import error_budget
from restitution.budget._required import required_roundness
from restitution.budget._results import ErrorBudget, RequiredRoundness

__all__ = ["ErrorBudget", "RequiredRoundness", "error_budget", "required_roundness"]
