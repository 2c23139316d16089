"""The report on the paper: every misprint, every number, and the way to the explorer."""

import re
from dataclasses import replace
from html import unescape
from pathlib import Path

import pytest

from restitution._internal.text import with_error
from restitution.figures.report import grouped
from restitution.papers.estimate import deviations
from restitution.papers.glielmo2014 import PAPER
from restitution.papers.glielmo2014._runs import Runs, simulate
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.report import report
from restitution.papers.runs import Runner, impacts_of

SMALL = Settings(
    impacts_per_particle=60,
    mean_impacts=50,
    bead_impacts_per_particle=60,
    sensitivity_impacts_per_particle=60,
    secondary_particles=30,
    first_particles=30,
)


@pytest.fixture(scope="module")
def runs() -> Runs:
    return simulate(SMALL, 1000, Runner(5))


@pytest.fixture(scope="module")
def text(runs: Runs) -> str:
    """All words of the report, without figures and verdicts."""
    page = report(replace(PAPER, settings=SMALL), runs, [], [])
    return " ".join(unescape(re.sub("<[^>]*>", "", page.split("</style>")[1])).split())


def test_every_figure_leads_to_the_stop_that_shows_it() -> None:
    """The stops of the tour name the figures of the paper that they are about."""
    tour = (Path(__file__).parents[2] / "web/src/tour.ts").read_text(encoding="utf-8")
    titles = re.findall(r'^    title: "(.*)",$', tour, re.MULTILINE)
    for figure in PAPER.figures:
        number = re.match(r"Fig\. (\d)", figure.title)
        assert number is not None
        assert figure.stop is not None
        title = titles[figure.stop - 1]
        assert re.match(rf"Figs?\..*\b{number[1]}\b.*:", title), (figure.title, title)


def test_every_misprint_is_there_with_its_three_numbers(text: str) -> None:
    for one in PAPER.misprints:
        assert f"Eq. {one.equation}" in text
        assert all(f"{abs(round(value, 12)):.6g}" in text for value in one.check())


def test_numbers_come_from_the_runs(text: str, runs: Runs) -> None:
    """σ(ε) for each radius, every seed, all parameters, and the command that would make the report again."""
    for pair in runs.by_radius.values():
        sigma = deviations(pair[SMALL.elongation], SMALL)
        assert with_error(sigma.value[-1], sigma.error[-1]) in text
    for name, run in runs.all().items():
        assert name in text
        assert str(run.attrs["seed"]) in text
    for row in SMALL.rows():
        assert row.unit in text
    assert "restitution paper --out paper --impacts 1000 --seed 5" in text
    assert f"with {grouped(impacts_of(runs.lattice))} impacts behind Fig. 2" in text
    assert "main, counted" in text
    assert str(runs.main.attrs["version"]) in text
