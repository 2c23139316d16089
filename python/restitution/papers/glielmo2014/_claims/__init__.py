"""The paper's quantitative claims, judged against the simulations."""

from restitution._internal.text import with_error
from restitution.papers.glielmo2014._claims import (
    _dependence,
    _energy,
    _experiments,
    _first,
    _negative,
    _reservoir,
    _scatter,
    _shape,
    _unsaid,
)
from restitution.papers.glielmo2014._claims._claim import SIGNIFICANT, Claim, Measurement, Verdict
from restitution.papers.glielmo2014._claims._energy import Gains, gains_by_elongation
from restitution.papers.glielmo2014._claims._unsaid import deviations
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

__all__ = [
    "SIGNIFICANT",
    "Claim",
    "Gains",
    "Measurement",
    "Verdict",
    "deviations",
    "gains_by_elongation",
    "judge",
    "with_error",
]

_GROUPS = (_scatter, _reservoir, _shape, _dependence, _negative, _first, _energy, _unsaid, _experiments)


def judge(runs: Runs, settings: Settings) -> list[Claim]:
    """Judge every quantitative claim of the paper.

    Each verdict follows from the numbers by the claim's stated rule. Impacts of one particle are correlated,
    so every standard error takes each particle as one draw, and every p-value rests on at most one impact of
    each.

    Parameters
    ----------
    runs : Runs
        The simulations.
    settings : Settings
        What was simulated.

    Returns
    -------
    list of Claim
        In the order of the paper.
    """
    return [claim for group in _GROUPS for claim in group.judge(runs, settings)]
