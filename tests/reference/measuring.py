"""Calls about experiments, studies, recordings and pages; as in `calls`."""

from functools import cache, partial
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np

import restitution as rs
from reference.calls import Call, folder, good, of, some
from restitution import explorer, flight, sound, study
from restitution.drop.run import Run
from restitution.experiment import budget, inference, listen
from restitution.experiment.listen import Setting
from restitution.figures import laws
from restitution.papers import glielmo2014, gunkelmann2014

ENOUGH = "the attack has come far enough"


def _leave(*_: Any, **__: Any) -> None:
    raise ValueError(f"arguments: {ENOUGH}")


def _redraw(_paper: Any, **given: Any) -> Any:
    """Call up to where the work would begin, which takes minutes."""
    with patch("restitution.papers.runs.Runner.record", _leave):
        return _paper.redraw(**given)


def _laws(**given: Any) -> Any:
    """Likewise."""
    with patch("restitution.figures.laws._measure.compare", _leave):
        return laws.write(**given)


@cache
def recording() -> Path:
    import soundfile

    path = folder() / "ball.wav"
    soundfile.write(path, samples(), 8000)
    return path


def samples() -> Any:
    """Make the sound of a ball with ε = 0.9 that is heard eight times."""
    rate, times = 8000, np.cumsum(0.3 * 0.9 ** np.arange(8))
    found = np.random.default_rng(1).normal(0.0, 1e-4, int(rate * (times[-1] + 0.3)))
    for k, time in enumerate(times):
        at, n = int(time * rate), np.arange(400)
        found[at : at + 400] += 0.9 ** (k + 1) * np.exp(-n / 40) * np.sin(1.9 * n)
    return 0.9 * found


@cache
def heard() -> listen.Analysis:
    return analysed()


def analysed() -> listen.Analysis:
    """Analyse the recording with few shapes and scatters in the posterior, which takes long."""
    rough: dict[str, Any] = dict.fromkeys(("_SHAPES", "_SCATTERS"), 2)
    with patch.multiple("restitution.experiment.inference._posterior", **rough):
        return listen.analyse(recording(), Setting(diameter=0.02))


def study_tables() -> dict[str, Any]:
    return {
        "body": good()["body"],
        "law": good()["law"],
        "run": {"particles": 4, "impacts": 4},
        "statistics": {
            "velocity_bins": {"from": 0.0, "to": 1.1, "bins": 3},
            "restitution_bins": {"from": -1.0, "to": 3.0, "bins": 4},
        },
        "sweep": {"law.normal": [0.9]},
    }


@cache
def store() -> Path:
    """Run a study of one point, from which something can be learned, unless a process of ours has done so."""
    path = folder() / "done.zarr"
    if path.exists():
        return path
    bins = {
        "velocity_bins": {"from": 0.5, "to": 0.9, "bins": 3},
        "restitution_bins": {"from": -1, "to": 3, "bins": 90},
    }
    tables = study_tables() | {"run": {"particles": 3000, "impacts": 12}, "statistics": bins}
    rs.sweep(tables, path, threads=1)
    return path


def _budgeted() -> dict[str, Any]:
    return {"body": rs.Dumbbell(radius=0.02, separation=0.0), "law": good()["law"], "drop": 0.3} | {
        "particles": 50,
        "impacts": 5,
    }


@cache
def results() -> dict[str, Any]:
    law = rs.Frictionless(normal=0.95)
    return {
        "budget": budget.error_budget(**_budgeted()),
        "required": budget.required_roundness(
            1e-3, diameter=6e-3, law=law, drop=0.1, impacts=5, particles=50
        ),
    }


def _result(thing: str, /, **others: Any) -> Any:
    return lambda: {"self": results()[thing]} | others


def _ball() -> dict[str, Any]:
    law = rs.Frictionless(normal=0.93)
    ball = rs.from_roundness(6e-3, 6e-5)
    run = rs.simulate(ball, law, particles=1, impacts=14, release_height=0.103, threads=1)
    data = flight.restitution(run.time.values[0], 1e-5, drop_height=0.1)
    small = {"particles": 100, "draws": 100, "elongation": (1e-2, 3e-2)}
    return {"data": data, "law": law, "diameter": 6e-3, **small}


CALLS: dict[str, Call] = {
    "flight.Drag": (flight.Drag, lambda: {"terminal_velocity": 9.0, "uncertainty": 0.1}),
    "flight.Drag.of_sphere": (flight.Drag.of_sphere, lambda: {"diameter": 0.04, "mass": 2.7e-3}),
    "flight.restitution": (flight.restitution, some("times", uncertainty=1e-4)),
    "flight.fit": (flight.fit, lambda: {"data": good()["measured"], "law": "constant"}),
    "flight.compare": (lambda fits: flight.compare(fits), lambda: {"fits": good()["law_fit"]}),
    "flight.clock": (flight.clock, some("data")),
    "flight.figure": (
        lambda data, fits, style: flight.figure(data, fits, style=style),
        lambda: {"data": good()["measured"], "fits": good()["law_fit"], "style": "page"},
    ),
    "flight.read": (flight.read, lambda: {"file": folder() / "times.csv"}),
    "flight.LawFit.error": (flight.LawFit.error, of("law_fit", speed=0.5)),
    "sound.impacts": (
        sound.impacts,
        lambda: {"source": samples(), "rate": 8000.0},
    ),
    "error_budget": (budget.error_budget, _budgeted),
    "ErrorBudget.table": (budget.ErrorBudget.table, _result("budget")),
    "ErrorBudget.figure": (budget.ErrorBudget.figure, _result("budget")),
    "required_roundness": (
        budget.required_roundness,
        lambda: {
            "precision": 1e-3,
            "diameter": 6e-3,
            "law": rs.Frictionless(normal=0.95),
            "drop": 0.1,
            "impacts": 5,
            "particles": 50,
            "roughness": 1e-8,
        },
    ),
    "RequiredRoundness.allowed": (
        budget.RequiredRoundness.allowed,
        _result("required", precision=1e-3, quantity="mean"),
    ),
    "RequiredRoundness.table": (budget.RequiredRoundness.table, _result("required")),
    "RequiredRoundness.figure": (budget.RequiredRoundness.figure, _result("required")),
    "posterior": (inference.posterior, _ball),
    "explore": (explorer.explore, some("data")),
    "explorer.link": (explorer.link, lambda: {"run": Run(body=good()["body"], law=good()["law"])}),
    "explorer.page": (explorer.page, dict),
    "explorer.serve": (explorer.serve, lambda: {"port": 0, "browse": False, "tell": _leave}),
    "listen.analyse": (listen.analyse, lambda: {"file": recording(), "setting": Setting(diameter=0.02)}),
    "listen.write": (
        listen.write,
        lambda: (
            {"file": recording(), "out": Path("page.html"), "setting": Setting(diameter=0.02)}
            | {"replace": True}
        ),
    ),
    "listen.Analysis.csv": (listen.Analysis.csv, lambda: {"self": heard()}),
    "listen.Analysis.dataset": (listen.Analysis.dataset, lambda: {"self": heard()}),
    "listen.Series.sentence": (
        listen.Series.sentence,
        lambda: {"self": heard().series[0], "setting": Setting(diameter=0.02)},
    ),
    "laws.write": (_laws, lambda: {"out": Path("laws"), "impacts": 20_000, "seed": 1}),
    "glielmo2014.redraw": (
        partial(_redraw, glielmo2014),
        lambda: {"out": Path("paper"), "impacts": 400_000, "seed": 1, "progress": False},
    ),
    "gunkelmann2014.redraw": (
        partial(_redraw, gunkelmann2014),
        lambda: {"out": Path("rough"), "impacts": 400_000, "seed": 1, "progress": False},
    ),
    "study.study_of": (study.study_of, lambda: {"source": study_tables()}),
    "study.Study.run": (study.Study.run, lambda: {"self": study.study_of(study_tables()), "point": 0}),
    "study.estimate": (study.estimate, lambda: {"study": study.study_of(study_tables()), "threads": 1}),
    "study.status": (study.status, lambda: {"out": store()}),
    "study.open_store": (study.open_store, lambda: {"path": store()}),
    "study.learned": (
        lambda out, normal: study.learned(out, normal=normal),
        lambda: {"out": store(), "normal": 0.9},
    ),
    "study.merge": (study.merge, lambda: {"out": store(), "parts": []}),
    "sweep": (rs.sweep, lambda: {"study": study_tables(), "out": Path("study.zarr")}),
}
