"""The error budget of `listen` beside the errors of planted times: what disagrees is said first."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import restitution as rs
from restitution._internal.parameters import ParameterError, Problem
from restitution.experiment.listen import Setting, analyse, write
from restitution.experiment.listen._shape import compared

DIAMETER, DROP = 6e-3, 0.1


@pytest.fixture(autouse=True)
def without_a_posterior(monkeypatch: pytest.MonkeyPatch) -> None:
    """The out-of-roundness is measured; what the times say of it takes seconds."""

    def posterior(*_: Any, **__: Any) -> None:
        raise ParameterError(Problem("data", ": not asked"))

    monkeypatch.setattr("restitution.experiment.listen._shape.posterior", posterior)


def table(folder: Path, out_of_roundness: float, timing: float, seed: int) -> Path:
    """Drop a dumbbell of ε_n = 0.93, and write down when it hits, with errors."""
    run = rs.simulate(
        rs.from_roundness(DIAMETER, out_of_roundness, form="dumbbell"),
        rs.Frictionless(normal=0.93),
        particles=1,
        impacts=16,
        release_height=DROP + DIAMETER / 2.0,
        seed=seed,
    )
    times = run.time.values[0] + np.random.default_rng(seed).normal(0.0, timing, 16)
    path = folder / f"{seed}.csv"
    path.write_text("time (s)\n" + "".join(f"{time:.9f}\n" for time in times), encoding="utf-8")
    return path


def setting(measured: float, timing: float) -> Setting:
    return Setting(diameter=DIAMETER, drop=DROP, time_uncertainty=timing, out_of_roundness=measured)


@pytest.mark.parametrize(("out_of_roundness", "timing"), [(1e-6, 2e-5), (1.5e-5, 2e-5), (1.5e-5, 1e-6)])
def test_nothing_is_said_where_budget_and_times_agree(
    tmp_path: Path, out_of_roundness: float, timing: float
) -> None:
    """Errors of times alone, of both, and of the shape alone."""
    file = table(tmp_path, out_of_roundness, timing, 1)
    found = analyse(file, setting(out_of_roundness, timing)).series[0]
    assert found.shape is not None
    assert found.shape.budget is not None
    assert found.shape.disagreement == ""


def numbers(said: str, name: str) -> list[float]:
    match = re.search(rf"{name} is (\S+) by the budget, (\S+) by the times", said)
    assert match is not None, said
    return [float(number) for number in match.groups()]


def test_a_budget_of_a_ball_that_is_rounder_is_contradicted(tmp_path: Path) -> None:
    """The measured out-of-roundness is thirty times the true one; the page says it below the answer."""
    out = tmp_path / "page.html"
    analysis = write(table(tmp_path, 5e-6, 1e-5, 1), out, setting(1.5e-4, 1e-5))
    first, [series] = analysis.warnings[0], analysis.series
    assert first.startswith("The error budget and the times disagree: the scatter of one ε is 0.0")
    assert "The ball is rounder than was measured" in first
    by_budget, by_times = numbers(first, "the scatter of one ε")
    residual = (series.data.restitution - series.fits[0](series.data.impact_velocity)).values
    assert by_times == pytest.approx(np.nanstd(residual), rel=1.0)
    assert by_budget > 5.0 * by_times
    by_budget, by_times = numbers(first, "the error of the mean ε")
    constant = next(fit for fit in series.fits if fit.law == "constant")
    assert by_times == pytest.approx(constant.errors["restitution"], rel=0.06)
    assert by_budget > 5.0 * by_times
    assert series.shape is not None
    assert series.shape.budget is not None
    inferred = compared(series.data, series.fits, series.shape.budget, 0.0, measured=False)
    assert not any(one.disagree for one in inferred)  # with its error it contradicts nothing
    page = out.read_text(encoding="utf-8")
    assert page.index("the mean coefficient of restitution") < page.index("budget and the times disagree")


def test_times_that_scatter_beyond_the_budget_contradict_it(tmp_path: Path) -> None:
    """The ball is out of round by a hundred times what was measured."""
    analysis = analyse(table(tmp_path, 1e-4, 1e-6, 2), setting(1e-6, 1e-6))
    by_budget, by_times = numbers(analysis.warnings[0], "the scatter of one ε")
    assert by_times > 5.0 * by_budget
    assert "Beyond the budget, the material, the plate, a spin" in analysis.warnings[0]
