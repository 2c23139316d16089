"""Impacts of a ball that was filmed: between frames, where the parabola before meets the one after."""

from itertools import pairwise

import numpy as np
from scipy.signal import find_peaks

from restitution._internal.arrays import FloatArray as Array

_FEWEST = 3
"""Frames that a flight must have."""
_PROMINENCE = 0.03
"""Share of the whole range by which the ball must rise between two impacts."""


def impacts_of_track(t: Array, y: Array) -> tuple[Array, Array]:
    """Find the times of impacts, between the frames, and their standard errors.

    Each flight k is y = a_k + b_k t - c t², with one c for all. At an impact two flights meet, at
    t = (a_k - a_{k+1})/(b_{k+1} - b_k).

    Parameters
    ----------
    t, y : ndarray, shape (n,)
        Times of the frames in s, and height of the ball above any level, in any unit.

    Returns
    -------
    tuple of ndarray, shape (m,)
        Times and standard errors in s; those of neighbours are correlated, as they share a flight.

    Raises
    ------
    ValueError
        If there are not two impacts with enough frames about them.
    """
    lowest = find_peaks(-y, prominence=_PROMINENCE * np.ptp(y))[0].tolist() if y.size else []
    edges = [-1, *lowest, y.size]
    flights = [np.arange(begin + 1, end) for begin, end in pairwise(edges)]
    # A flight that has too few frames ends the series, or comes before it.
    good = [flight.size >= _FEWEST for flight in flights]
    first = good.index(True) if True in good else len(good)
    last = good.index(False, first) if False in good[first:] else len(good)
    flights = flights[first:last]
    if len(flights) < _FEWEST:
        raise ValueError(
            f"{max(len(flights) - 1, 0)} impacts with at least {_FEWEST} frames before and after; "
            "at least two are needed"
        )
    frames = np.concatenate(flights)
    origin = t[frames].mean()
    x = t - origin
    design = np.zeros((frames.size, 2 * len(flights) + 1))
    rows, numbers = np.arange(frames.size), np.repeat(np.arange(len(flights)), [one.size for one in flights])
    design[rows, 2 * numbers] = 1.0
    design[rows, 2 * numbers + 1] = x[frames]
    design[:, -1] = -(x[frames] ** 2)
    found, *_ = np.linalg.lstsq(design, y[frames], rcond=None)
    residual = y[frames] - design @ found
    freedom = frames.size - design.shape[1]
    if freedom < 1:
        raise ValueError(f"{frames.size} frames in {len(flights)} flights: too few to fit a parabola to each")
    covariance = np.linalg.pinv(design.T @ design) * float(residual @ residual) / freedom
    times, errors = [], []
    for number in range(len(flights) - 1):
        a, b, a_next, b_next = found[2 * number : 2 * number + 4]
        bend = b_next - b
        time = (a - a_next) / bend
        by = np.array([1.0, time, -1.0, -time]) / bend
        block = covariance[2 * number : 2 * number + 4, 2 * number : 2 * number + 4]
        times.append(time + origin)
        errors.append(float(np.sqrt(by @ block @ by)))
    return np.array(times), np.array(errors)
