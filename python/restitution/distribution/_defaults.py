"""Defaults of an ensemble: its release, and how long its particles are followed."""

import math

import numpy as np
import xarray as xr

from restitution.distribution._table import Floats
from restitution.drop.run import Run
from restitution.drop.simulate import simulate_run
from restitution.laws import Law, Material

RANGE = (0.04, 0.4)
"""Learned speeds where none are asked for, over the largest possible one at the first impact."""

_LEVELS_PER_LOSS, _FEWEST, _PARTICLES_EACH = 1000.0, 24, 4
_PILOTS, _STILL_FAST = 64, 0.01
_LEAST_IMPACTS, _MOST_IMPACTS = 256, 4096


def speeds(run: Run) -> Floats:
    """Return the least and the greatest speed to learn, in m/s."""
    return np.array(RANGE) * run.fall_speed(run.heights[0] - run.body.lowest_position)


def _pilot(run: Run, impacts: int, threads: int | None) -> xr.Dataset:
    """Follow a few particles."""
    few = run.of(np.arange(min(run.particles, _PILOTS)))
    return simulate_run(few.model_copy(update={"impacts": impacts}), threads=threads)


def _kept(run: Run, drop: float, threads: int | None) -> float:
    """Return the share of its speed that a body keeps in the first impact: ε_n, where the law has one.

    Of a law of one's own it is √(E′/E), with E′/E averaged over the first impacts of a few particles.
    """
    if not isinstance(run.law, Law):
        return math.sqrt(float(_pilot(run, 1, threads)["energy_ratio"].mean()))
    normal = run.law.normal
    return float(normal(run.fall_speed(drop))) if isinstance(normal, Material) else normal


def heights(run: Run, threads: int | None) -> tuple[float, ...]:
    """Spread the heights of release about the one that was asked for, over one loss of energy to either side.

    From a single height the first impacts have few separate speeds, and p(ε | v) as fine a structure. The
    heights above the highest position on the plane are (ε_n)^(2x) times the one asked for, with x triangular
    in [-1, 1]: dense in the middle and none at both ends, so that impacts of one number fade into those of
    the next; `_kept` says what stands for ε_n where the law has none. With 1000 of them for each loss,
    neighbours differ by 0.1 % in v.
    """
    base = run.body.compiled.farthest()
    drop = run.release_height - base
    kept = min(max(0.05, _kept(run, drop, threads)), 0.999)  # 0.05 also where no particle has an impact
    wanted = round(2.0 * _LEVELS_PER_LOSS * math.log(1.0 / kept))
    number = min(max(wanted, _FEWEST), run.particles // _PARTICLES_EACH)
    if number < 2 or drop <= 0.0:
        return (run.release_height,)
    share = (np.arange(number) + 0.5) / number
    lower = share < 0.5
    x = np.where(lower, np.sqrt(2.0 * share) - 1.0, 1.0 - np.sqrt(2.0 * (1.0 - share)))
    return tuple((base + drop * kept ** (2.0 * x)).tolist())


def minimum_speed(run: Run, slowest: float) -> float:
    """Return the speed in m/s below which a particle no longer reaches the slowest learned impact velocity.

    Until the next impact the centre of mass may come down from the highest to the lowest position on the
    plane. Impacts can create energy, hence never more than half of the slowest speed.
    """
    gravity = run.gravity * math.cos(run.incline)
    gained = 2.0 * gravity * (run.body.compiled.farthest() - run.body.lowest_position)
    return min(math.sqrt(max(slowest**2 - gained, 0.0)), 0.5 * slowest)


def impacts(run: Run, threads: int | None) -> int:
    """Return the least power of two of impacts after which at most 1 % of the particles are faster.

    4096 where there is none: some trajectories rattle without end.
    """
    number = _LEAST_IMPACTS
    while number < _MOST_IMPACTS:
        data = _pilot(run, number, threads)
        if float((data["stop_reason"] == 0).mean()) <= _STILL_FAST:
            break
        number *= 2
    return number
