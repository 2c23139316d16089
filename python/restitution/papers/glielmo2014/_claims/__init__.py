"""The paper's quantitative claims, each judged from the simulations."""

from restitution.papers.claims import Claims
from restitution.papers.glielmo2014._claims import (
    _energy,
    _experiments,
    _negative,
    _reservoir,
    _scatter,
    _shape,
    _unsaid,
)
from restitution.papers.glielmo2014._claims._energy import gains_by_elongation

__all__ = ["CLAIMS", "gains_by_elongation"]

CLAIMS = Claims(
    _scatter.CLAIMS,
    _reservoir.CLAIMS,
    _shape.CLAIMS,
    _negative.CLAIMS,
    _energy.CLAIMS,
    _unsaid.CLAIMS,
    _experiments.CLAIMS,
)
"""In the order of the paper."""
