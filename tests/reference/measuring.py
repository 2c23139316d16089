"""What `test_contract` attacks besides: experiments, figures, files and studies. The value is as there."""

import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import restitution as rs
from restitution import bodies, budget, explorer, figures, fit, flight, sound, study

Attacked = tuple[Callable[..., Any], Callable[[], dict[str, Any]], tuple[str, ...]]


@cache
def folder() -> Path:
    """Give a folder with one small file of each kind that is read."""
    path = Path(tempfile.mkdtemp())
    (path / "times.csv").write_text("time (s)\n0\n0.4\n0.78\n1.141\n", encoding="ascii")
    return path


@cache
def good() -> dict[str, Any]:
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    data = rs.simulate(body, law, particles=200, impacts=20)
    times = np.cumsum([0.0, *(0.4 * 0.95**n for n in range(12))])
    measured = flight.restitution(times, 1e-4, drop_height=0.22)
    laplace = fit.laplace(data, velocity=(0.5, 0.9))
    found = rs.reduce(data, np.linspace(0.1, 1.2, 12), np.linspace(-1, 3, 101))
    return {
        "body": body,
        "law": law,
        "data": data,
        "times": times,
        "measured": measured,
        "law_fit": flight.fit(measured),
        "fit": laplace,
        "found": found,
        "slopes": fit.slopes(data, np.linspace(0.2, 1.0, 6), resamples=2),
    }


WINDOW = (0.5, 0.9)
MEASURING: dict[str, Attacked] = {
    "LoadedSphere": (
        rs.LoadedSphere,
        lambda: {"radius": 0.01, "density": 1000.0, "load": 1e-3, "offset": 2e-3},
        (),
    ),
    "Frictionless": (rs.Frictionless, lambda: {"normal": 0.5}, ()),
    "Viscoelastic": (
        rs.Viscoelastic,
        lambda: {
            "young_modulus": 1e9,
            "poisson_ratio": 0.3,
            "dissipation": 1e-6,
            "density": 1e3,
            "radius": 1e-3,
        },
        (),
    ),
    "Spheroid.from_length_width": (
        rs.Spheroid.from_length_width,
        lambda: {"length": 2.0, "width": 1.0},
        ("density",),
    ),
    "from_roundness": (
        bodies.from_roundness,
        lambda: {"diameter": 0.04, "out_of_roundness": 1e-4},
        ("form", "lobes", "density"),
    ),
    "ball_grade": (bodies.ball_grade, lambda: {"grade": 10}, ()),
    "flight.Drag": (flight.Drag, lambda: {"terminal_velocity": 9.0, "uncertainty": 0.1}, ()),
    "flight.Drag.of_sphere": (
        flight.Drag.of_sphere,
        lambda: {"diameter": 0.04, "mass": 2.7e-3},
        ("coefficient", "coefficient_uncertainty", "air_density", "gravity"),
    ),
    "flight.restitution": (
        flight.restitution,
        lambda: {"times": good()["times"], "uncertainty": 1e-4},
        ("gravity", "gravity_uncertainty", "drop_height", "drop_height_uncertainty", "drag"),
    ),
    "flight.fit": (flight.fit, lambda: {"data": good()["measured"], "law": "constant"}, ("scatter",)),
    "flight.compare": (lambda fits: flight.compare(fits), lambda: {"fits": good()["law_fit"]}, ()),
    "flight.clock": (flight.clock, lambda: {"data": good()["data"]}, ()),
    "flight.figure": (flight.figure, lambda: {"data": good()["measured"]}, ()),
    "flight.read": (
        flight.read,
        lambda: {"file": folder() / "times.csv"},
        ("format", "unit", "uncertainty"),
    ),
    "LawFit.error": (lambda **k: good()["law_fit"].error(**k), lambda: {"speed": 0.5}, ()),
    "sound.impacts": (
        sound.impacts,
        lambda: {"source": np.sin(np.arange(3000.0) ** 1.5), "rate": 8000.0},
        (),
    ),
    "error_budget": (
        budget.error_budget,
        lambda: {"body": rs.Dumbbell(radius=0.02, separation=0.0), "law": good()["law"], "drop": 0.3},
        ("impacts", "timing", "gravity", "gravity_uncertainty", "drop_uncertainty", "tilt", "spin", "drag"),
    ),
    "fit.logistic": (fit.logistic, lambda: {"samples": good()["data"], "velocity": WINDOW}, ()),
    "fit.student_t": (fit.student_t, lambda: {"samples": good()["data"], "velocity": WINDOW}, ()),
    "fit.asymmetric_power": (
        fit.asymmetric_power,
        lambda: {"samples": good()["data"], "velocity": WINDOW},
        ("location",),
    ),
    "fit.cusp_mixture": (
        fit.cusp_mixture,
        lambda: {"samples": good()["data"], "location": 0.9, "velocity": WINDOW},
        (),
    ),
    "Fit.pdf": (lambda **k: good()["fit"].pdf(**k), lambda: {"x": 0.9}, ()),
    "Fit.cdf": (lambda **k: good()["fit"].cdf(**k), lambda: {"x": 0.9}, ()),
    "Fit.rvs": (lambda **k: good()["fit"].rvs(**k), lambda: {"size": 3, "seed": 1}, ()),
    "Slopes.fails_below": (
        lambda **k: good()["slopes"].fails_below(**k),
        lambda: {"distance": 0.03, "high": 1.0},
        (),
    ),
    "figures.map": (figures.map, lambda: {"found": good()["found"]}, ("of",)),
    "figures.densities": (
        figures.densities,
        lambda: {"found": good()["found"], "velocities": [0.55, 0.75]},
        (),
    ),
    "figures.scatter": (figures.scatter, lambda: {"found": good()["found"]}, ()),
    "figures.moments": (figures.moments, lambda: {"found": good()["found"]}, ()),
    "figures.trajectory": (figures.trajectory, lambda: {"data": good()["data"]}, ("particle", "impacts")),
    "figures.save": (
        lambda name: figures.save(figures.moments(good()["found"]), name),
        lambda: {"name": folder() / "figure.png"},
        (),
    ),
    "explorer.serve": (
        lambda port: explorer.serve(port=port, browse=False, tell=_leave),
        lambda: {"port": 0},
        (),
    ),
    "study_of": (study.study_of, lambda: {"source": _study()}, ()),
    "study.status": (study.status, lambda: {"out": folder() / "none.zarr"}, ()),
    "sweep": (rs.sweep, lambda: {"study": _study(), "out": folder() / "study.zarr"}, ("shard", "threads")),
}


def _leave(_: str) -> None:
    raise ValueError("port: this is far enough")


def _study() -> dict[str, Any]:
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
