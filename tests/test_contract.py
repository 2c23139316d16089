"""The contract of every public function: our error, which names the argument, or a right answer, in time."""

import contextlib
import time
from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import restitution as rs
from reference.hostile import VALUES
from reference.measuring import MEASURING
from restitution import fit
from restitution.analytic import first_impact, negative_threshold
from restitution.fit import Counts

SLOW = 30.0
"""Seconds that no call of these sizes may take, on a busy machine either."""

RUN = dict.fromkeys(
    ("body", "law", "particles", "impacts", "release_height", "gravity", "orientation", "spin", "velocity")
)
RUN |= dict.fromkeys(("incline", "minimum_speed", "seed", "threads"))


@cache
def good() -> dict[str, Any]:
    """What the functions are given where they are not attacked."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    data = rs.simulate(body, law, particles=200, impacts=40)
    velocity, restitution = np.linspace(0.1, 1.2, 12), np.linspace(-1, 3, 101)
    learned = rs.reduce(rs.simulate(body, law, particles=1000, impacts=20), [0.7, 0.8, 0.9, 1.0], restitution)
    laplace = fit.laplace(data, velocity=(0.5, 0.7))
    return {
        "body": body,
        "law": law,
        "data": data,
        "found": rs.reduce(data, velocity, restitution),
        "velocity_bins": velocity,
        "restitution_bins": restitution,
        "dist": rs.FluctuatingRestitution.from_statistics(learned),
        "first": first_impact(body, law),
        "fit": laplace,
        "bootstrap": fit.bootstrap(fit.laplace, data, velocity=(0.5, 0.7), resamples=3),
        "slopes": fit.slopes(data, np.linspace(0.2, 1.0, 6), resamples=2),
    }


def small_run() -> dict[str, Any]:
    return {"body": good()["body"], "law": good()["law"], "particles": 3, "impacts": 3}


def bins() -> dict[str, Any]:
    return {name: good()[name] for name in ("velocity_bins", "restitution_bins")}


WINDOW = (0.5, 0.7)
FUNCTIONS: dict[str, tuple[Callable[..., Any], Callable[[], dict[str, Any]], tuple[str, ...]]] = {
    # name: the function, what it is given, and what is attacked besides
    "Dumbbell": (rs.Dumbbell, lambda: {"radius": 1.0, "separation": 1.0, "density": 1.0}, ()),
    "Spheroid": (rs.Spheroid, lambda: {"equatorial": 1.0, "polar": 2.0, "density": 1.0}, ()),
    "Spherocylinder": (rs.Spherocylinder, lambda: {"radius": 1.0, "separation": 2.0, "density": 1.0}, ()),
    "TangentialRestitution": (rs.TangentialRestitution, lambda: {"normal": 0.5, "tangential": 0.5}, ()),
    "Coulomb": (rs.Coulomb, lambda: {"normal": 0.5, "friction": 0.5, "hypothesis": "newton"}, ()),
    "ChatterjeeRuina": (
        rs.ChatterjeeRuina,
        lambda: {"normal": 0.5, "tangential": 0.5, "friction": 0.5},
        (),
    ),
    "Tabulated": (rs.Tabulated, lambda: {"v": [0.1, 0.2], "e": [0.9, 0.8]}, ()),
    "Plastic": (rs.Plastic, lambda: {"yield_speed": 0.1}, ()),
    "RandomSpin": (rs.RandomSpin, lambda: {"rate": 1.0, "axis": "across"}, ()),
    "simulate": (rs.simulate, small_run, (*RUN, "progress")),
    "statistics": (
        rs.statistics,
        lambda: small_run() | bins(),
        (*RUN, "fraction_bins", "counts_only", "progress"),
    ),
    "reduce": (rs.reduce, lambda: {"data": good()["data"]} | bins(), ("fraction_bins",)),
    "compare": (
        rs.compare,
        lambda: {"bodies": [good()["body"]], "laws": [good()["law"]], "particles": 2, "impacts": 2} | bins(),
        ("seed", "progress"),
    ),
    "first_impact": (
        first_impact,
        lambda: {"body": good()["body"], "law": good()["law"], "orientation": "isotropic"},
        (),
    ),
    "negative_threshold": (negative_threshold, lambda: {"body": good()["body"], "law": good()["law"]}, ()),
    "first_impact.pdf": (lambda **k: good()["first"].pdf(**k), lambda: {"x": 0.5}, ()),
    "first_impact.ppf": (lambda **k: good()["first"].ppf(**k), lambda: {"q": 0.5}, ()),
    "dist.pdf": (lambda **k: good()["dist"].pdf(**k), lambda: {"x": 0.5, "v": 0.8}, ("given",)),
    "dist.ppf": (lambda **k: good()["dist"].ppf(**k), lambda: {"q": 0.5, "v": 0.8}, ()),
    "dist.rvs": (
        lambda **k: good()["dist"].rvs(**k),
        lambda: {"v": 0.8, "random_state": 1},
        ("size", "threads"),
    ),
    "from_statistics": (
        rs.FluctuatingRestitution.from_statistics,
        lambda: {"statistics": good()["found"]},
        (),
    ),
    "Counts": (
        Counts,
        lambda: {"edges": [0.0, 1.0, 2.0], "count": [1, 2], "below": 1, "above": 2},
        (),
    ),
    **{
        f"fit.{name}": (
            getattr(fit, name),
            lambda: {"samples": good()["data"], "velocity": WINDOW},
            ("location",) if name == "asymmetric_laplace" else (),
        )
        for name in ("gaussian", "laplace", "asymmetric_laplace")
    },
    "fit.bootstrap": (
        fit.bootstrap,
        lambda: {"family": fit.laplace, "samples": good()["data"], "velocity": WINDOW, "resamples": 2},
        ("clusters", "seed"),
    ),
    "fit.goodness": (
        fit.goodness,
        lambda: {"family": fit.laplace, "samples": good()["data"], "velocity": WINDOW, "resamples": 2},
        ("clusters", "seed"),
    ),
    "fit.compare": (
        fit.compare,
        lambda: {
            "first": good()["fit"],
            "second": good()["fit"],
            "samples": good()["data"],
            "velocity": WINDOW,
        },
        ("clusters",),
    ),
    "fit.slopes": (
        fit.slopes,
        lambda: {"data": good()["data"], "velocity_bins": [0.3, 0.5, 0.7], "resamples": 2},
        ("location", "seed"),
    ),
    "fit.dependence": (
        fit.dependence,
        lambda: {"data": good()["data"], "velocity_bins": [0.3, 0.5, 0.7], "lags": 2},
        (),
    ),
    "bootstrap.interval": (
        lambda **k: good()["bootstrap"].interval(**k),
        lambda: {"name": "scale", "confidence": 0.9},
        (),
    ),
    "slopes.power_law": (
        lambda **k: good()["slopes"].power_law(**k),
        lambda: {"side": "above"},
        ("low", "high", "release_speed"),
    ),
}

FUNCTIONS |= MEASURING

ALIASES = {
    "radius": ("radius", "separation", "young_modulus"),
    "separation": ("separation", "radius"),
    "data": ("data", "velocity_bins"),
    "particles": ("particles", "orientation"),
    "samples": ("samples", "velocity", "clusters", "data", "count"),
    "velocity": ("velocity", "samples"),
    "clusters": ("clusters", "samples"),
    "location": ("location", "samples"),
    "statistics": ("statistics",),
    "edges": ("edges", "count"),
    "above": ("above", "count"),
    "below": ("below", "count"),
    "gravity": ("gravity", "velocity", "spin", "radius"),
    "minimum_speed": ("minimum_speed",),
    "v": ("v", "e"),
    "equatorial": ("equatorial", "polar"),
    "impacts": ("impacts", "particles"),
    "body": ("body", "release_height"),
    "low": ("low", "high"),
    "density": ("density", "young_modulus"),
    "dissipation": ("dissipation", "young_modulus"),
    "width": ("width", "length"),
    "times": ("times", "uncertainty"),
    "source": ("source", "study", "array"),
    "study": ("study", "tables", "sweep"),
    "out": ("out", "store"),
    "drop": ("drop", "release_height", "impacts"),
    "diameter": ("diameter", "out_of_roundness", "equatorial"),
    "lobes": ("lobes", "out_of_roundness"),
}
"""Where an argument is right in itself, another that no longer fits it may be the one that is named."""


def attack(name: str, argument: str, value: str) -> str | None:
    """Call with one hostile argument; say what is wrong with what happens, if anything is."""
    function, make, _ = FUNCTIONS[name]
    given_values = make() | {argument: VALUES[value]()}
    started = time.perf_counter()
    try:
        function(**given_values)
    except ValueError as error:
        text = str(error)
        named = any(alias in text for alias in ALIASES.get(argument, (argument,)))
        found = None if named and len(text) < 2000 else f"does not name {argument}: {text}"
    except OSError as error:  # of a file, which it names
        found = None if error.filename is not None else f"names no file: {error}"
    except Exception as error:
        found = f"{type(error).__name__}: {error}"
    else:
        found = None
    seconds = time.perf_counter() - started
    return found if seconds < SLOW else f"took {seconds:.0f} s"


def arguments(name: str) -> list[str]:
    _, make, more = FUNCTIONS[name]
    return sorted({*make(), *more})


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Some of the values are names of files that can be written."""
    with contextlib.chdir(tmp_path_factory.mktemp("hostile")):
        yield


@pytest.mark.filterwarnings("ignore::restitution.EnergyWarning")
@pytest.mark.parametrize("name", list(FUNCTIONS))
@settings(max_examples=25)
@given(st.data())
def test_a_hostile_argument(elsewhere: None, name: str, data: st.DataObject) -> None:
    """Drawn from the catalogue; `make hostile` goes through all of it."""
    argument = data.draw(st.sampled_from(arguments(name)))
    value = data.draw(st.sampled_from(list(VALUES)))
    assert attack(name, argument, value) is None


def test_a_figure_of_hostile_numbers() -> None:
    """What is drawn is checked as what is computed is."""
    from restitution import figures

    figure, [[axes]] = figures.panels(3.0, 2.0)
    with pytest.raises(ValueError, match="count"):
        figures.population(axes, np.arange(3.0), np.arange(3.0), np.zeros((2, 2), dtype=np.int64))
    assert figure.axes
