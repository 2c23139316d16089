"""Gases of grains, followed, drawn and judged: every gas, figure, table and claim in small."""

import re
from dataclasses import replace
from pathlib import Path

import pytest

import restitution as rs
from reference.command import invoke
from restitution.figures.report import prose
from restitution.papers.gases import PAPER, tables
from restitution.papers.gases._runs import Runs, beta, number, simulate
from restitution.papers.gases._settings import Settings
from restitution.papers.report import report
from restitution.papers.runs import Runner

SMALL = replace(Settings(), share=0.02)


@pytest.fixture(scope="module")
def runs() -> Runs:
    return simulate(SMALL, 100, Runner(5))


@pytest.mark.slow
def test_the_runs_are_those_that_are_told(runs: Runs) -> None:
    assert len(runs.all()) == number(Settings())
    assert len({data.attrs["seed"] for data in runs.all().values()}) == number(Settings())


@pytest.mark.slow
def test_everything_is_drawn_told_and_judged(runs: Runs, tmp_path: Path) -> None:
    """Each figure with its data and caption, each claim with its numbers, and every gas in the table."""
    figures = [figure.save(runs, SMALL, tmp_path) for figure in PAPER.figures]
    claims = PAPER.claims.judge(runs, SMALL)
    page = report(replace(PAPER, settings=SMALL), runs, figures, claims)
    text = re.sub(r"\s+", " ", re.sub("<[^>]*>", "", page.split("</style>")[1]))
    for claim in claims:
        assert claim.finding.verdict in ("holds", "holds in part", "fails")
        assert all(number.value == number.value for number in claim.finding.measured), claim.key
    for name in runs.all():
        assert f">{prose(name)}<" in page, name
    assert "restitution gas-figures --out gas --particles 100 --seed 5" in text
    assert "100 particles in each gas; seed 5" in text
    for _, heads, rows in tables(runs, SMALL):
        assert all(len(row) == len(heads) for row in rows)


def test_too_few_particles(tmp_path: Path) -> None:
    result = invoke("gas-figures", "--out", tmp_path, "--particles", 3)
    assert result.exit_code == 2
    assert "error: particles = 3: must be a whole number in [100," in result.stderr


def test_rough_spheres_with_a_given_ratio() -> None:
    """β of the theory of Huthmann and Zippelius, found again from its ratio; none for what it never has."""
    law = rs.TangentialRestitution(normal=0.9, tangential=0.2)
    found = beta(SMALL, 0.9, rs.gas.theory.steady_ratio(SMALL.dumbbell(0.0), law))
    assert found is not None
    assert found[0] == pytest.approx(-0.2, abs=1e-9)
    assert beta(SMALL, 0.9, 100.0) is None
