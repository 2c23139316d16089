"""Onsets heard in recordings whose times are known, beside these times."""

from functools import cache

import numpy as np
import numpy.typing as npt
import xarray as xr
from scipy import stats

import restitution as rs
from benchmarks.listening import off_and_stated
from reference.clicks import RATE, Recording, bouncing

Array = npt.NDArray[np.float64]


@cache
def heard(kind: str, seed: int, noise: float) -> tuple[Recording, xr.Dataset]:
    """Record a ball, and listen to it."""
    truth = bouncing(kind, seed=seed, noise=noise)
    return truth, rs.sound.impacts(truth.samples, RATE)


def errors(kind: str, seed: int, noise: float) -> tuple[Array, Array]:
    """By how much good times are off, less what all have in common, and what they are said to be off by."""
    truth, found = heard(kind, seed, noise)
    return off_and_stated(found, truth.times)


def spreads_over_stated(recordings: list[tuple[str, int]], noise: float) -> tuple[Array, Array]:
    """Spread of errors over what they are said to be in each recording, of their bulk and as a whole."""
    pulls = [np.divide(*errors(*one, noise)) for one in recordings]
    bulk = [1.4826 * np.median(np.abs(pull)) for pull in pulls]
    return np.array(bulk), np.array([np.std(pull) for pull in pulls])


def slopes(seeds: list[int]) -> tuple[Array, Array, Array]:
    """Fit power laws to balls of a constant law.

    Returns their exponents over their errors, as normal numbers, by how much these ratios differ from those
    of the exact times, and the fitted scatter.
    """
    ratios: list[float] = []
    exact: list[float] = []
    scatters = []
    for kind in ("ping", "knock"):
        for seed in seeds:
            truth, found = heard(kind, seed, -45.0)
            data = rs.flight.restitution(found)
            for times, values in ((data, ratios), (rs.flight.restitution(truth.times), exact)):
                law = rs.flight.fit(times, "power law", scatter="fit")
                values.append(law.parameters["exponent"] / law.errors["exponent"])
            scatters.append(rs.flight.fit(data, "constant", scatter="fit").scatter)
    normal = stats.norm.ppf(stats.t.cdf(ratios, 23 - 2))
    return np.asarray(normal), np.array(ratios) - exact, np.array(scatters)


def two_balls(kind: str, seed: int, noise: float) -> tuple[Recording, Recording, Array]:
    """Record two balls at once, the second fainter, dropped from higher, and less elastic."""
    one = bouncing(kind, seed=seed, noise=noise)
    other = bouncing(kind, seed=seed + 50, noise=noise, normal=0.88, speed=1.9, impacts=18)
    samples = np.zeros(max(one.samples.size, other.samples.size))
    samples[: one.samples.size] += one.samples
    samples[: other.samples.size] += 0.8 * other.samples
    return one, other, samples


def second_ball_is_heard(kind: str, seed: int) -> bool:
    """Tell whether two balls are reported as two, and all good times are those of one of them."""
    one, other, samples = two_balls(kind, seed, -45.0)
    found = rs.sound.impacts(samples, RATE)
    times = found.time.values[found.flag.values == 0]
    apart = [np.abs(times[:, None] - ball.times).min(axis=1) < 5e-3 for ball in (one, other)]
    return bool(found.attrs["other_ball_impacts"] >= 5 and max(same.mean() for same in apart) == 1.0)
