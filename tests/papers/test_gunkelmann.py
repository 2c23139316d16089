"""Rough spheres, simulated and judged: every run, figure and claim in small, beside the closed forms."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from restitution.papers import shape
from restitution.papers.estimate import deviations
from restitution.papers.gunkelmann2014 import PAPER
from restitution.papers.gunkelmann2014._runs import Runs, number, simulate
from restitution.papers.gunkelmann2014._settings import Settings
from restitution.papers.report import report
from restitution.papers.runs import Runner

SMALL = replace(
    Settings(),
    asperities=5000,
    asperity_radius=5e-5,
    mean_height=1e-5,
    mean_heights=(1e-5, 2e-5),
    numbers=(1000, 3000),
    height=1e-4,
    normal=0.9,
    speeds=(0.3, 0.4, 0.55, 0.75),
    speed_tolerance=0.1,
    velocity_range=(0.25, 1.1),
    impacts_per_particle=14,
    secondary_particles=150,
    recorded_impacts=6000,
    curve_bins=6,
)
"""Fewer and higher asperities, with the scatter of some hundred of equal height; short trajectories."""
SMALL_PAPER = replace(PAPER, settings=SMALL)


@pytest.fixture(scope="module")
def runs() -> Runs:
    return simulate(SMALL, 12_000, Runner(3))


def test_the_runs_are_those_that_are_told(runs: Runs) -> None:
    done: list[int] = []
    simulate(
        replace(SMALL, recorded_impacts=200, secondary_particles=5),
        400,
        Runner(3, done=lambda: done.append(1)),
    )
    assert len(done) == number(SMALL) == len(runs.all())
    assert runs.lattice.attrs["particles"] == int(np.ceil(12_000 / 14))


def test_settings_say_whose_they_are() -> None:
    """The model's number of asperities and the dumbbell's L/R are the paper's; all else is ours."""
    sources = {row.name: row.source for row in Settings().rows()}
    assert {name for name, source in sources.items() if source == "paper"} == {"asperities", "elongation"}


def test_the_scatter_is_the_closed_form(runs: Runs) -> None:
    """σ(ε) at four speeds for random heights and for two numbers of equal ones, with nothing fitted.

    To five standard errors, and a quarter for random heights, of which this one surface has its own few
    hundred tall ones; a tenth for equal heights.
    """
    cases = [(runs.main, SMALL.contact(), 0.25)]
    cases += [(data, SMALL.contact(asperities=n), 0.1) for n, data in runs.by_number.items()]
    for data, contact, part in cases:
        found = deviations(data, SMALL)
        exact = np.array([SMALL.density(v, contact).std() for v in SMALL.speeds])
        assert np.all(np.abs(found.value - exact) < 5.0 * found.error + part * exact), data.attrs["run"]


def test_the_share_of_rotation_is_the_closed_form(runs: Runs) -> None:
    """J ω²/2 is exponential with (12); means over the window of each speed."""
    velocity, share = (runs.main[name].to_numpy() for name in ("impact_velocity", "rotational_fraction"))
    for v, (low, high) in zip(SMALL.speeds, SMALL.speed_windows, strict=True):
        inside = share[(velocity >= low) & (velocity < high)]
        exact = SMALL.mean_share(v)
        assert abs(inside.mean() - exact) < 5.0 * inside.std() / np.sqrt(inside.size) + 0.25 * exact


def test_every_figure_is_drawn(runs: Runs, tmp_path: Path) -> None:
    for figure in PAPER.figures:
        saved = figure.save(runs, SMALL, tmp_path)
        assert saved.png.stat().st_size > 10_000
        assert "Our choice" in saved.caption


def test_every_claim_is_judged(runs: Runs, monkeypatch: pytest.MonkeyPatch) -> None:
    """All numbers are finite; what the theory says for certain holds in small runs too."""
    monkeypatch.setattr(shape, "RESAMPLES", 20)
    claims = {claim.key: claim.finding for claim in PAPER.claims.judge(runs, SMALL)}
    assert len(claims) == 10
    assert all(np.isfinite(one.value) for finding in claims.values() for one in finding.measured)
    for key in ("energy-transfer", "scatter-grows", "rotation-grows", "number-of-asperities"):
        assert claims[key].verdict != "fails", key
    exponents = {one.name: one for one in claims["number-of-asperities"].measured if "d ln σ" in one.name}
    assert [round(exponents[f"d ln σ/d ln {name} in closed form"].value) for name in ("N", "⟨h⟩")] == [-1, 1]
    text = report(SMALL_PAPER, runs, [], PAPER.claims.judge(runs, SMALL, "superelastic"))
    assert "restitution rough --out rough --impacts 12000 --seed 3" in text
