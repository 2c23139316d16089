"""`impacts`: when a bouncing ball hit, from a recording."""

from __future__ import annotations

from collections.abc import Iterator
from importlib.metadata import version
from os import PathLike
from pathlib import Path

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import FloatArray as Array
from restitution._internal.parameters import ParameterError, Problem, TooLargeError
from restitution.experiment.flight.times import DOUBLED, DOUBTFUL, GOOD, MISSED, flag_attributes
from restitution.experiment.sound._choice import Choice, choose
from restitution.experiment.sound._envelope import Envelope, bands, envelope, rounding
from restitution.experiment.sound._series import LONGEST_FLIGHT, Track, best_series, followed, strongest
from restitution.experiment.sound.load import clipped_share, load

CANDIDATE = 4.0
"""A rise of a band's level is a candidate from so many times the spread of its rises."""
_WORTH = 3.0
"""And is worth what it has beyond so many."""
_SATURATED = 6.0
"""In the choice of the band each impact counts up to this: it is their number that matters."""
_PIECE = 20.0
"""Cost of each series, so that a band that tears one into pieces is not preferred."""
_LEAST_SPREAD = 0.8
"""In dB. A quiet recording is not more certain than that."""
FIRST_SCORE, FURTHER_SCORE = 7.0, 15.0
"""Scores that the first series and further ones must have."""
_MEAN = 2.4
"""And the mean for each impact: the best chain through noise that swells reaches 2.1."""
_SHORT_FLIGHT, _SHORTER = 0.25, 0.7
"""Longest flights in s down to which series are searched for, each search with this part of the one before:
one impact of each of several drops may follow one another like those of one, with longer flights."""
_CLIPPED_THROUGHOUT = 0.5
"""Share of loud samples at the limit that explains why nothing is heard."""
_FURTHER_MEMBERS = 4
"""Impacts that a further series must have."""
_SAME_BALL = 0.02
"""Part by which the ratio of two flights may differ from that of most where another ball is heard."""
_OTHER_MEMBERS = 5
"""Impacts that another ball must have had between those of the first."""


def impacts(source: str | PathLike[str] | npt.ArrayLike, rate: float | None = None) -> xr.Dataset:
    """Find the impacts of a bouncing ball in a recording.

    The band of frequencies is chosen in which most impacts follow one another like those of a bouncing ball:
    each flight is shorter than the one before by about the same ratio. Echoes and second bursts do not do
    that. The onset of each is picked by several rules in several bands; the rule is taken that agrees best
    with those in other bands and that noise disturbs least.

    Parameters
    ----------
    source : path or array_like, shape (n,) or (n, channels)
        A sound file of any kind that libsndfile reads (WAV, FLAC, OGG, MP3, AIFF) and any depth, one of a
        telephone (M4A, AAC, MP4, 3GP, AMR, WMA) where ffmpeg is installed, or samples. Of several channels,
        the one is taken in which impacts stand out most.
    rate : float, optional
        Samples per second of an array, at least 2000. A file has its own.

    Returns
    -------
    xarray.Dataset
        Dimension ``impact``, in the order of time: ``time`` and its standard error ``uncertainty`` in s;
        ``flag``: "good", "doubtful" (found, but its time is off, or it is hardly heard), "missed" (there
        must have been one; time NaN), "doubled" (a second sound as loud as the impact before it, which
        belongs to no series); ``series``, counted from 0; ``level``, in dB over the noise. All times have
        one small delay in common. The attributes give the band and the rule of each series, the share
        of clipped samples, and how many sounds between the impacts are those of another ball.

    Raises
    ------
    ValueError
        If it is not a sound, silent, or no three impacts of a series can be heard; the message says what was
        heard.
    OSError
        If the file cannot be read.
    MemoryError
        If it is too long for the memory that this process can have.

    Notes
    -----
    docs/listening.md has the choice of the rule and the precision on synthetic recordings and on a real one.
    The standard error has two parts: the noise at that impact, and what the sound's own changes do to the
    rule, as its differences from rules in other bands show. What all bands have in common is not in it.

    Examples
    --------
    Clicks at 0.2 s and after flights of 400, 360, 324 and 291.6 ms, in noise:

    >>> import numpy as np
    >>> import restitution as rs
    >>> rng = np.random.default_rng(1)
    >>> samples = 1e-3 * rng.standard_normal(2 * 44100)
    >>> for time in 0.2 + np.cumsum([0.0, 0.4, 0.36, 0.324, 0.2916]):
    ...     samples[round(time * 44100) :][:200] += rng.standard_normal(200) * np.exp(-np.arange(200) / 40)
    >>> heard = rs.sound.impacts(samples, 44100)
    >>> np.diff(heard.time.values).round(3).tolist()
    [0.4, 0.36, 0.324, 0.292]
    """
    name = Path(source).name if isinstance(source, str | PathLike) else "source"
    try:
        return _heard_in(*load(source, rate), name)
    except TooLargeError:
        raise
    except MemoryError as error:  # of NumPy, which does not say what for, or of SciPy, which says nothing
        raise MemoryError(f"{name}: takes more memory than this process can have") from error


def _heard_in(samples: Array, own: float, name: str) -> xr.Dataset:
    # Most impacts are heard in this channel and band.
    _, channel, tracks, loudest, every = max(_tried(samples, own), key=lambda tried: tried[0])
    if not tracks:
        share = clipped_share(samples)
        if share > _CLIPPED_THROUGHOUT:
            text = f": clipped throughout ({100 * share:.0f} % of the loud samples); record with less gain"
            raise ParameterError(Problem(name, text))
        raise ParameterError(Problem(name, f": {_what_was_heard(loudest)}"))
    tracks = [followed(track, every) for track in tracks]
    heard = [(track, _picked(samples[:, channel], own, track)) for track in tracks]
    heard.sort(key=lambda one: float(one[1].times[0]))
    found = _dataset(heard, own, channel, clipped_share(samples), name)
    others = _of_another_ball(tracks)
    if others:
        found["flag"] = ("impact", _of_one_ball(found), found.flag.attrs)
    return found.assign_attrs(other_ball_impacts=others)


def _tried(samples: Array, rate: float) -> Iterator[tuple[float, int, list[Track], Envelope, list[Envelope]]]:
    """Search every channel and band; yield what is found there, after what it is worth."""
    for channel in range(samples.shape[1]):
        if not np.ptp(samples[:, channel]) > 0.0:
            continue
        least = rounding(samples[:, channel])
        heard = [envelope(samples[:, channel], rate, band, least) for band in bands(rate)]
        for one in heard:
            times, rises = one.candidates(CANDIDATE)
            candidates = strongest(times, _rewards(one, rises))
            longest = LONGEST_FLIGHT
            while longest > _SHORT_FLIGHT:
                tracks = _series_in(one, *candidates, longest)
                worth = sum(track.worth for track in tracks) - _PIECE * max(len(tracks) - 1, 0)
                yield worth, channel, tracks, one, heard
                flights = [float(np.diff(track.times).max()) for track in tracks]
                longest = _SHORTER * min(longest, max(flights, default=longest))


def _rewards(one: Envelope, rises: Array) -> Array:
    """Return what candidates are worth, by how much louder they are than before."""
    return np.asarray(rises / max(one.spread, _LEAST_SPREAD) - _WORTH)


def _series_in(one: Envelope, times: Array, rewards: Array, longest: float) -> list[Track]:
    """Take series with flights up to a longest out of the candidates of a band, until none is left."""
    tracks: list[Track] = []
    while True:
        members, score = best_series(times, rewards, one.width / 3.0, longest)
        least = max(FURTHER_SCORE if tracks else FIRST_SCORE, _MEAN * members.size)
        if score < least or (tracks and members.size < _FURTHER_MEMBERS):
            return tracks
        worth = float(np.minimum(rewards[members], _SATURATED).sum())
        tracks.append(Track(times[members], worth, one))
        # What lies within a series is its own: echoes, second bursts, noise.
        left = (times < times[members[0]] - one.width) | (times > times[members[-1]] + one.width)
        times, rewards = times[left], rewards[left]


def _of_another_ball(tracks: list[Track]) -> int:
    """Count the sounds between those of the tracks that follow one another like impacts of another ball.

    Second bursts and echoes do so, too, but at one delay after each impact.
    """
    own, one = np.sort(np.concatenate([track.times for track in tracks])), tracks[0].envelope
    times, rises = one.candidates(CANDIDATE)
    left = np.abs(times[:, None] - own).min(axis=1, initial=np.inf) > 2.0 * one.width
    left &= np.any([(each.times[0] < times) & (times < each.times[-1]) for each in tracks], axis=0)
    times, rewards = strongest(times[left], _rewards(one, rises[left]))
    members, score = best_series(times, rewards, one.width / 3.0)
    if score < max(FURTHER_SCORE, _MEAN * members.size):
        return 0
    heard = times[members]
    delays = heard - own[np.maximum(np.searchsorted(own, heard) - 1, 0)]
    alone = heard.size >= _OTHER_MEMBERS and np.std(delays) > 2.0 * one.width
    return heard.size if alone else 0


def _of_one_ball(found: xr.Dataset) -> npt.NDArray[np.int8]:
    """Flag as doubtful what went over to the other ball: its flights have another ratio than most."""
    flags = np.array(found.flag.values, dtype=np.int8)
    for number in np.unique(found.series.values):
        places = np.flatnonzero((found.series.values == number) & (flags <= DOUBTFUL))
        ratios = np.diff(np.log(np.diff(found.time.values[places])))
        same = np.abs(ratios - np.median(ratios)) < _SAME_BALL
        # A ratio is that of three impacts. One that has it with those before, and not with those after, may
        # be the other ball's.
        kept = np.convolve(same, np.ones(3)) > 1.0
        kept[0], kept[-1] = same[0], same[-1]
        flags[places[~kept]] = DOUBTFUL
    return flags


def _what_was_heard(one: Envelope) -> str:
    times, rises = one.candidates(CANDIDATE)
    if times.size == 0:
        return "no impact is heard over the noise; at least three are needed"
    loud = times[np.argsort(rises)[::-1][:5]]
    places = ", ".join(f"{time:.2f} s" for time in np.sort(loud))
    if times.size == 1:
        return f"one impact is heard, at {places}; at least three are needed"
    only = f"only {times.size} sounds (the loudest at {places})"
    return f"no series of impacts is heard, {only}; at least three are needed"


def _picked(samples: Array, rate: float, track: Track) -> Choice:
    """Pick the onsets near where the level rises."""
    width = track.envelope.width
    gaps = np.diff(track.times)
    before = np.minimum(1.5 * width + 2e-3, 0.4 * np.append(gaps[0], gaps))
    after = np.minimum(width + 1.5e-3, 0.4 * np.append(gaps, gaps[-1]))
    return choose(samples, rate, track.times, before, after)


def _dataset(
    heard: list[tuple[Track, Choice]], rate: float, channel: int, clipped: float, name: str
) -> xr.Dataset:
    tables = [_rows(track, choice) for track, choice in heard]
    time, uncertainty, flag, level = np.concatenate(tables, axis=1)
    series = np.repeat(np.arange(len(tables)), [one.shape[1] for one in tables])
    of_time = {"long_name": "time of the impact from the beginning of the recording", "units": "s"}
    of_error = {"long_name": "standard error of the time", "units": "s"}
    return xr.Dataset(
        {
            "time": ("impact", time, of_time),
            "uncertainty": ("impact", uncertainty, of_error),
            "flag": ("impact", flag.astype(np.int8), flag_attributes()),
            "series": ("impact", series, {"long_name": "number of the series"}),
            "level": ("impact", level, {"long_name": "level over the noise", "units": "dB"}),
        },
        attrs={
            "title": "Impacts heard in a recording",
            "source": f"{name}, listened to by restitution {version('restitution')}",
            "rate": rate,
            "channel": channel,
            "band": "; ".join("{:g} to {:g} Hz".format(*track.envelope.band) for track, _ in heard),
            "rule": "; ".join(choice.rule for _, choice in heard),
            "clipped_share": clipped,
        },
    )


def _rows(track: Track, choice: Choice) -> Array:
    """Lay out times, errors, flags and levels of a series, with what was missed and doubled in it."""
    times, errors, late = choice.times, choice.errors, track.doubled
    # Where no onset is found near the rise of the level, the rise stands for it, with the delay of the
    # others.
    delay = times - track.times
    astray = np.abs(delay - np.median(delay)) > 1.5 * track.envelope.width
    times = np.where(astray, track.times + np.median(delay), times)
    errors = np.where(astray, np.maximum(track.envelope.width, errors), errors)
    flags = np.where(choice.doubtful | track.faint | astray, DOUBTFUL, GOOD)
    # One that was not heard is, for the order, in the middle of its flight.
    between = 0.5 * (times[track.missed] + times[track.missed + 1])
    rows = (
        (times, errors, flags, track.levels_at(track.times), times),
        (np.nan, np.nan, MISSED, np.nan, between),
        (late, track.envelope.width, DOUBLED, track.levels_at(late), late),
    )
    table = np.concatenate([np.broadcast_arrays(*row) for row in rows], axis=1)
    return table[:4, np.argsort(table[4], kind="stable")]
