"""The choice among the rules for onsets, by their own scatter."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from restitution.experiment.sound._pickers import Picks
from restitution.experiment.sound._scatter import told_apart

Array = npt.NDArray[np.float64]

_WORSE = 1.3
"""Rules that scatter more than the best by this factor have no voice beside it."""
_VOICES = 6
"""Rules that are needed to compare them with one another."""
_FAR_OFF = 6.0
"""Standard errors by which a time must be off to be doubted."""


class Choice(NamedTuple):
    """The rule that is trusted.

    Attributes
    ----------
    picks : Picks
        Its times, in samples.
    error : float
        Standard error of a time, in samples.
    jumps : ndarray
        By how many samples each time is off.
    doubtful : ndarray of bool
        Which times are off by more than errors explain.
    """

    picks: Picks
    error: float
    jumps: Array
    doubtful: npt.NDArray[np.bool_]


def choose(found: list[Picks]) -> Choice:
    """Choose the rule whose times scatter least.

    A ball whose ratio of flights changes smoothly shows the scatter of each rule by itself. Where the
    ball's own changes are larger than that, they are common to all rules: then the rules are compared with
    one another.
    """
    known = [one for one in found if one.scatter is not None]
    if not known:
        return _by_consensus(found)
    known.sort(key=_scatter_of)
    best = known[0]
    parts = told_apart(_without_outliers(best), best.places)
    if parts is not None and parts.ball_changes:
        near = [one for one in known if _scatter_of(one) < _WORSE * _scatter_of(best)]
        if len(near) >= _VOICES:
            return _by_consensus(near)
    assert best.scatter is not None
    doubtful = np.abs(best.scatter.jumps) > _FAR_OFF * best.scatter.jump_errors
    error = _scatter_of(best) if parts is None else parts.time
    return Choice(best, error, best.scatter.jumps, doubtful)


def _scatter_of(picks: Picks) -> float:
    return np.inf if picks.scatter is None else picks.scatter.time


def _without_outliers(picks: Picks) -> Array:
    assert picks.scatter is not None
    off = np.abs(picks.scatter.jumps) > _FAR_OFF * picks.scatter.jump_errors
    return np.where(off, np.nan, picks.times)


def _by_consensus(found: list[Picks]) -> Choice:
    """Choose the rule that is nearest to the median of all, each less its own mean delay."""
    times = np.array([one.times for one in found])
    centre = np.median(times, axis=0)
    off = times - centre
    off -= np.median(off, axis=1, keepdims=True)
    consensus = np.median(off, axis=0)
    distance = np.array([_spread(row - consensus) for row in off])
    order = np.argsort(distance)
    # Three rules of different kinds: differences of their times give the variance of each.
    kinds: list[int] = []
    for place in order:
        if found[place].rule not in {found[kind].rule for kind in kinds}:
            kinds.append(int(place))
    first = kinds[0]
    if found[first].scatter is None:  # too few to judge a rule: they differ by what one may be wrong
        return Choice(
            found[first], float(np.median(distance)), off[first], np.zeros(times.shape[1], dtype=np.bool_)
        )
    error = float(distance[first])
    if len(kinds) > 2:
        one, two, three = (off[kind] for kind in kinds[:3])
        variance = 0.5 * (_spread(one - two) ** 2 + _spread(one - three) ** 2 - _spread(two - three) ** 2)
        error = max(float(np.sqrt(max(variance, 0.0))), error)
    jumps = off[first] - consensus
    return Choice(found[first], error, jumps, np.abs(jumps) > _FAR_OFF * max(error, 1e-9))


def _spread(values: Array) -> float:
    """Return the standard deviation, to which values that are far off count as if they were five off."""
    middle = 1.4826 * float(np.median(np.abs(values)))
    return (
        float(np.sqrt(np.mean(np.minimum(values**2, 25.0 * middle**2))))
        if middle > 0.0
        else float(np.std(values))
    )
