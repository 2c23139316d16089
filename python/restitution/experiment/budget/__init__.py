"""Errors of a bouncing-ball experiment: what shape, timing, g, plate, spin and air do to ε."""

from restitution.experiment.budget._error_budget import error_budget
from restitution.experiment.budget._required import required_roundness
from restitution.experiment.budget._results import ErrorBudget, RequiredRoundness

__all__ = ["ErrorBudget", "RequiredRoundness", "error_budget", "required_roundness"]
