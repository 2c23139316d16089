"""Errors of impacts that are heard: `python -m benchmarks.listening` prints the tables of docs/listening.md.

Balls are simulated, their impacts are turned into sound with one trouble or another, and what is heard is
compared with what was simulated. Three minutes on one core.
"""

import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

import restitution as rs
from benchmarks.recording import BASKETBALL, PLATE, RUBBER, STEEL, TABLE_TENNIS, TRAMPOLINE, Sound, recording

Array = npt.NDArray[np.float64]

SEEDS = 5


@dataclass(frozen=True)
class Condition:
    """A ball and the trouble with its recording.

    Attributes
    ----------
    name : str
        In words.
    sound : Sound
        What an impact sounds like.
    normal : float
        ε_n of the ball.
    height : float
        From which it is dropped, in m.
    impacts : int
        Number of its impacts.
    rate : float
        Samples per second.
    trouble : dict
        Further arguments of `recording`.
    """

    name: str
    sound: Sound = TABLE_TENNIS
    normal: float = 0.94
    height: float = 0.06
    impacts: int = 30
    rate: float = 44100.0
    trouble: dict[str, Any] = field(default_factory=lambda: {"echo": 0.3})


def _table_tennis(name: str, rate: float = 44100.0, **trouble: Any) -> Condition:
    return Condition(name, rate=rate, trouble={"echo": 0.3, **trouble})


CONDITIONS = (
    *(_table_tennis(f"noise {level} dB", noise=float(level)) for level in (-60, -40, -30, -20, -12, -6)),
    _table_tennis("clipped at 30 % of the peak", clipping=0.7),
    _table_tennis("reverberation of 0.6 s", reverberation=0.6),
    _table_tennis("8 bit", bits=8),
    _table_tennis("8.8 kHz", rate=8800.0),
    Condition("steel on steel", STEEL, 0.6, 0.12, 5, trouble={"noise": -45.0}),
    Condition("ball on a plate", PLATE, 0.9, 0.2, 25, trouble={"noise": -40.0, "reverberation": 0.4}),
    Condition("rubber", RUBBER, 0.85, 0.45, 21, trouble={"noise": -50.0}),
    Condition("basketball", BASKETBALL, 0.78, 0.8, 15, trouble={"noise": -50.0, "reverberation": 0.3}),
    Condition("trampoline", TRAMPOLINE, 0.984, 0.3, 80, 8000.0, {"noise": -40.0, "reverberation": 0.3}),
)


@dataclass(frozen=True)
class Heard:
    """The results of several recordings of one condition.

    Attributes
    ----------
    errors : ndarray
        Of the times that were found, less the common delay of their recording, in s.
    claimed : ndarray
        Their standard errors, in s.
    true, missed, false : int
        Impacts that there were, that were not found, and times at which there was none.
    """

    errors: Array
    claimed: Array
    true: int
    missed: int
    false: int


def measure(condition: Condition, seeds: int = SEEDS) -> Heard:
    """Make recordings with several seeds and listen to them."""
    errors, claimed = [], []
    true = missed = false = 0
    for seed in range(1, seeds + 1):
        samples, times = recorded(condition, seed)
        true += times.size
        try:
            heard = rs.sound.impacts(samples, condition.rate)
        except ValueError:  # nothing is heard
            missed += times.size
            continue
        found = heard.flag.values < 2
        off, good, number = _compared(heard.time.values[found], times)
        errors.append(off[good])
        claimed.append(heard.uncertainty.values[found][good])
        missed += times.size - number
        false += int(np.count_nonzero(~good))
    return Heard(np.concatenate([*errors, []]), np.concatenate([*claimed, []]), true, missed, false)


def recorded(condition: Condition, seed: int) -> tuple[Array, Array]:
    """Simulate a nearly round ball, and record it."""
    body = rs.Dumbbell(radius=3e-3, separation=6e-6)
    data = rs.simulate(
        body,
        rs.Frictionless(normal=condition.normal),
        particles=1,
        impacts=condition.impacts,
        release_height=condition.height,
        seed=seed,
    )
    times, speeds = data.time.values[0], data.impact_velocity.values[0]
    samples, offset = recording(
        times, speeds, condition.sound, rate=condition.rate, seed=seed, **condition.trouble
    )
    return samples, times + offset


def _compared(heard: Array, true: Array) -> tuple[Array, npt.NDArray[np.bool_], int]:
    """Give errors less their median, which of them belong to an impact, and how many impacts were found."""
    nearest = np.abs(heard[:, None] - true).argmin(axis=1)
    off = heard - true[nearest]
    off = off - np.median(off)
    # Within a third of the shortest flight beside it, or 5 ms.
    flights = np.diff(true)
    beside = np.minimum(np.append(flights, flights[-1]), np.append(flights[0], flights))[nearest]
    good = np.abs(off) < np.minimum(5e-3, beside / 3.0)
    return off, good, int(np.unique(nearest[good]).size)


def table(seeds: int = SEEDS) -> Iterator[str]:
    """Write the table, line by line."""
    head = ("recording", "impacts", "missed", "false", "median error (µs)", "90 % within (µs)")
    yield f"| {' | '.join(head)} | stated (µs) |"
    yield "|---|---|---|---|---|---|---|"
    for condition in CONDITIONS:
        yield row(condition, measure(condition, seeds))


def row(condition: Condition, heard: Heard) -> str:
    """Write one line of the table."""
    numbers = ["–"] * 3
    if heard.errors.size:
        off = np.abs(heard.errors) * 1e6
        values = (np.median(off), np.quantile(off, 0.9), 1e6 * np.median(heard.claimed))
        numbers = [_two_digits(value) for value in values]
    cells = [condition.name, str(heard.true), str(heard.missed), str(heard.false), *numbers]
    return f"| {' | '.join(cells)} |"


SCATTERING = {
    "crackle": "a burst of noise",
    "ping": "ringing",
    "knock": "ringing whose modes change",
    "slap": "a burst that is another one each time",
}
LEVELS = (-45, -30, -20)


def off_and_stated(found: xr.Dataset, true: Array) -> tuple[Array, Array]:
    """Give errors of good times, less what all have in common, and their standard errors."""
    good = found.flag.values == 0
    times, stated = found.time.values[good], found.uncertainty.values[good]
    off = times - true[np.abs(times[:, None] - true).argmin(axis=1)]
    off = off - np.median(off)
    return off - np.average(off, weights=stated**-2.0), stated


def scattering_row(kind: str, level: int, seeds: int = SEEDS) -> str:
    """Write a line for balls whose coefficient scatters by 0.003, recorded by the code of the tests."""
    sys.path.append(str(Path(__file__).parents[1] / "tests"))
    from reference.clicks import RATE, bouncing

    found = []
    for seed in range(101, 101 + seeds):
        truth = bouncing(kind, seed=seed, noise=float(level))
        found.append(off_and_stated(rs.sound.impacts(truth.samples, RATE), truth.times))
    off, stated = (np.concatenate(values) for values in zip(*found, strict=True))
    pulls = np.median([np.std(one / error) for one, error in found])
    numbers = (1e6 * np.median(np.abs(off)), 1e6 * np.median(stated), pulls)
    return f"| {SCATTERING[kind]}, {level} dB | {' | '.join(map(_two_digits, numbers))} |"


def _two_digits(number: float) -> str:
    return f"{float(f'{number:.2g}'):g}"  # 520 rather than 5.2e+02


def scattering() -> Iterator[str]:
    """Write the table of balls whose coefficient scatters, line by line."""
    yield "| click and noise | median error (µs) | stated (µs) | spread of errors over stated |"
    yield "|---|---|---|---|"
    for kind in SCATTERING:
        for level in LEVELS:
            yield scattering_row(kind, level)


if __name__ == "__main__":
    for line in chain(table(), [""], scattering()):
        print(line, flush=True)
