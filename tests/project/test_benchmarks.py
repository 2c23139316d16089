"""The benchmarks compare only what computes the same physics, and compare it in the right direction."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks import agreement, bodies, encounters, timing
from benchmarks.peers import brentq_grid, simulate, statistics
from benchmarks.spinning import JOBS
from benchmarks.timing import Times
from benchmarks.work import Array, Grid, Peer, Work

WORK = Work(impacts=40)
ENGINE = statistics.rows()[0]
PAGE = Path(__file__).parents[2] / "docs" / "performance.md"


def rounder(work: Work, angles: Array) -> Grid:
    """The engine with a body that is 10 % closer to a sphere, which leaves the mean of ε nearly alone."""
    return ENGINE.run(replace(work, separation=0.9 * work.separation), angles)


def test_the_peers_agree_with_the_engine() -> None:
    """Impact by impact to rounding, and in σ(ε); the levels of the engine count by count."""
    recording = [simulate.rows()[0], *brentq_grid.rows()]
    assert agreement.same_impacts(recording, WORK, particles=4, impacts=8) <= 1.0
    assert agreement.same_counts(statistics.rows(), WORK, particles=50) == 50 * 40
    found, distance = agreement.same_spread([ENGINE, simulate.rows()[1]], WORK, particles=200)
    assert len(found) == 2
    assert 0.0 < distance < agreement.STANDARD_ERRORS


def test_another_physics_is_found_out() -> None:
    """A peer with another body is not compared."""
    wrong = Peer("wrong", rounder)
    with pytest.raises(agreement.Disagreement, match=r"wrong: not the grid of statistics"):
        agreement.same_counts([ENGINE, wrong], WORK, particles=10)
    with pytest.raises(agreement.Disagreement, match=r"wrong: σ\(ε\) at"):
        agreement.same_spread([ENGINE, wrong], WORK, particles=1000)


def test_ratios_are_taken_within_a_round() -> None:
    """A round in which the whole machine was slow does not touch them."""
    times = Times(["fast", "yardstick"], *np.array([[[10.0, 100.0], [30.0, 300.0]], [[9.0, 90.0]] * 2]))
    assert times.ratios("yardstick", "fast").tolist() == [10.0, 10.0]
    fast = timing.table(times, "yardstick").splitlines()[2]
    assert fast.split() == ["fast", "50", "20", "9", "10", "10", "10", "10"]
    line = timing.comparison(times, "one over the other", "yardstick", "fast")
    assert line.split()[-4:] == ["10", "(10", "to", "10)"]


@pytest.mark.filterwarnings("ignore::restitution.EnergyWarning")
def test_every_row_bounces_about_as_often_as_the_yardstick() -> None:
    """Thirty particles of each. Down an incline, one in four with friction comes to roll: 182 ± 3 impacts."""
    rows = (bodies.YARDSTICK, *bodies.ROWS)
    assert len({row.name for row in bodies.EVERY}) == len(bodies.EVERY)
    for row in rows:
        number = row.run(30, threads=1, seed=1) / bodies.WORK.impacts
        assert number == 30 or (row.release and number > 25), row.name


def test_a_target_that_is_missed_is_said_to_be() -> None:
    """Some ratios are to be small, others large."""
    times, ratios = np.array([5.0, 6.0, 7.0]), np.array([1.0, 2.0, 3.0])
    small = bodies.line("row", times, ratios, 1.9, at_least=False)
    assert small.split() == ["row", "6", "2", "(1", "to", "3)", "<=", "1.9", "MISSED"]
    assert bodies.line("row", times, ratios, 1.9, at_least=True).split()[-2:] == [">=", "1.9"]


def test_the_spinning_job_has_the_engines_inertia() -> None:
    """What the Numba loops are given is the body of `restitution`."""
    for job in JOBS:
        across, axial = job.inertia
        assert across == pytest.approx(job.body.transverse_inertia / job.body.mass, rel=1e-14)
        assert axial == pytest.approx(job.body.axial_inertia / job.body.mass, rel=1e-14)


def test_the_page_has_the_rows_that_are_timed() -> None:
    """Of bodies and encounters, each with the target that it has now."""
    timed = {row.name: f"{row.target:g}" for _, rows in bodies.BLOCKS for row in rows}
    timed |= {row.name: "1" for row in encounters.rows()}
    page = PAGE.read_text(encoding="utf-8")
    line = r"^(?!Numba)(\S.*?) +[\d.e+]+ +[\d.e+]+   \([\d.e+]+ to [\d.e+]+\)   <= ([\d.]+)"
    assert dict(re.findall(line, page, re.MULTILINE)) == timed
