"""Calls of public functions, right as they stand: the contract's tests attack one argument at a time."""

import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

import restitution as rs
from restitution import _core, analytic, bodies, figures, fit, flight, gas, laws, pair

Call = tuple[Callable[..., Any], Callable[[], dict[str, Any]]]
"""A public function, class or method, and what it is given; of a method with ``self``."""

WINDOW = (0.5, 0.9)
TETRAHEDRON = ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))
"""The faces of that of the origin, the last vertex, and the unit vectors."""


@cache
def folder() -> Path:
    """Give a folder with one small file of each kind that is read."""
    path = Path(tempfile.mkdtemp(prefix="calls-"))
    (path / "times.csv").write_text("time (s)\n0\n0.4\n0.78\n1.141\n", encoding="ascii")
    good()["clump"].to_csv(path / "clump.csv")
    rows = [
        "v 1 0 0",
        "v 0 1 0",
        "v 0 0 1",
        "v 0 0 0",
        *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in TETRAHEDRON),
    ]
    (path / "mesh.obj").write_text("\n".join(rows) + "\n", encoding="ascii")
    (path / "profile.csv").write_text("-3e-3,0\n0,2e-3\n3e-3,0\n", encoding="ascii")
    (path / "points.csv").write_text("0,0,0\n4e-3,0,0\n0,4e-3,0\n0,0,4e-3\n", encoding="ascii")
    good()["dist"].save(path / "dist.nc")
    return path


@cache
def good() -> dict[str, Any]:
    """What functions are given where they are not attacked; small, and of one thread."""
    body, law = rs.Dumbbell(radius=3e-3, separation=3e-3), rs.TangentialRestitution(normal=0.9)
    data = rs.simulate(body, law, particles=200, impacts=40, threads=1, record="state")
    velocity, restitution = np.linspace(0.1, 1.2, 12), np.linspace(-1, 3, 101)
    die = rs.Die(faces=6, edge=1e-2)
    many = rs.simulate(body, law, particles=1000, impacts=20, threads=1)
    learned = rs.reduce(many, [0.7, 0.8, 0.9, 1.0], restitution)
    laplace = fit.laplace(data, velocity=WINDOW)
    times = np.cumsum([0.0, *(0.4 * 0.95**n for n in range(12))])
    measured = flight.restitution(times, 1e-4, drop_height=0.22)
    figure, [[axes]] = figures.panels(3.0, 2.0)
    found = rs.reduce(data, velocity, restitution)
    return {
        "body": body,
        "law": law,
        "die": die,
        "dropped": rs.simulate(die, rs.Frictionless(normal=0.5), particles=3, impacts=40, record="state"),
        "clump": rs.Clump(spheres=[(0, 0, 1e-3, 3e-3), (0, 0, -1e-3, 3e-3)]),
        "data": data,
        "found": found,
        "velocity_bins": velocity,
        "restitution_bins": restitution,
        "learned": learned,
        "dist": rs.FluctuatingRestitution.from_statistics(learned),
        "given": rs.FluctuatingRestitution.learn(
            body,
            law,
            particles=2000,
            impacts=40,
            velocities=(0.4, 0.7),
            given="rotational_fraction",
            threads=1,
        ),
        "kernel": rs.PairKernel.learn(
            body, body, SMOOTH, translational_temperature=1e-9, encounters=100, threads=1
        ),
        "first": analytic.first_impact(body, law),
        "fit": laplace,
        "counts": fit.Counts.at(found, 0.65),
        "film": figures.animate(data, impacts=2),
        "bootstrap": fit.bootstrap(fit.laplace, data, velocity=WINDOW, resamples=3),
        "slopes": fit.slopes(data, np.linspace(0.2, 1.0, 6), resamples=2),
        "times": times,
        "measured": measured,
        "law_fit": flight.fit(measured),
        "figure": figure,
        "axes": axes,
    }


def _own(compliance: Any, velocity: Any) -> Any:
    """Return an impulse; a law that holds a function of a module can be pickled."""
    return -velocity


def some(*names: str, **others: Any) -> Callable[[], dict[str, Any]]:
    """Give good values by their names, and others."""
    return lambda: {name: good()[name] for name in names} | others


def of(thing: str, /, **others: Any) -> Callable[[], dict[str, Any]]:
    """Give a good object as ``self``."""
    return lambda: {"self": good()[thing]} | others


RUN = {"particles": 3, "impacts": 3}
BALL, GLASS = rs.Dumbbell(radius=3e-3, separation=0.0), {"young_modulus": 7e10, "poisson_ratio": 0.2}
SMOOTH, WARM = (
    rs.Frictionless(normal=0.9),
    {"translational_temperature": 1e-9, "rotational_temperature": 1e-9},
)
BINS = ("velocity_bins", "restitution_bins")


def described(kind: type[Any], entry: dict[str, Any]) -> Call:
    """Make a class of the core's tables, with the usual value of each parameter that is not left out."""
    given = (about for about in entry["parameters"] if about.get("default", 0.0) is not None)
    values = {about["name"]: about["example"] for about in given}
    return kind, lambda: ({"normal": 0.5} if issubclass(kind, laws.Law) else {}) | values


TABLES = (
    ((*bodies.KINDS, *bodies.RIGID[:-1]), _core.BODIES),
    (laws.KINDS, _core.LAWS),
    (laws.MATERIALS, _core.MATERIALS),
)

CALLS: dict[str, Call] = {
    **{kind.__name__: described(kind, entry) for table in TABLES for kind, entry in zip(*table, strict=True)},
    "Dumbbell.from_length_width": (rs.Dumbbell.from_length_width, lambda: {"length": 2.0, "width": 1.0}),
    "Spheroid.from_length_width": (rs.Spheroid.from_length_width, lambda: {"length": 2.0, "width": 1.0}),
    "ball_grade": (bodies.ball_grade, lambda: {"grade": 10}),
    "ball_roughness": (bodies.ball_roughness, lambda: {"grade": 10}),
    "from_roundness": (bodies.from_roundness, lambda: {"diameter": 0.04, "out_of_roundness": 1e-4}),
    "Clump.from_file": (rs.Clump.from_file, lambda: {"path": folder() / "clump.csv", "scale": 1e-3}),
    "Clump.to_csv": (rs.Clump.to_csv, of("clump", path="clump.csv", replace=True)),
    "RoughSphere": (rs.RoughSphere, lambda: rs.RoughSphere.example(asperities=20, heights=1e-5).model_dump()),
    "Rough": (
        rs.Rough,
        lambda: {
            "body": rs.Dumbbell(radius=3e-3, separation=3e-5),
            "asperities": 20,
            "asperity_radius": 1e-5,
            "heights": 1e-5,
            "seed": 2,
        },
    ),
    "Revolution.from_file": (rs.Revolution.from_file, lambda: {"path": folder() / "profile.csv"}),
    "ConvexPolyhedron.from_file": (rs.ConvexPolyhedron.from_file, lambda: {"path": folder() / "points.csv"}),
    "Plane": (rs.Plane, lambda: {}),
    "pair.encounters": (
        pair.encounters,
        some("body", other=BALL, law=SMOOTH, encounters=5, record="contacts", threads=1, **WARM),
    ),
    "PairKernel": (rs.PairKernel, lambda: {"data": good()["kernel"].data}),
    "PairKernel.learn": (
        rs.PairKernel.learn,
        some("body", other=BALL, law=SMOOTH, encounters=30, translational_temperature=1e-9, threads=1),
    ),
    "PairKernel.rvs": (
        rs.PairKernel.rvs,
        of("kernel", velocity=[0.0, 0.0, -0.1], direction=[0.0, 0.0, 1.0], random_state=1),
    ),
    "pair.rates": (pair.rates, some("body", law=SMOOTH, encounters=20, temperature_ratios=[1.0], threads=1)),
    "flight.ContactTime": (flight.ContactTime, lambda: {"at_1_m_s": 1e-4, "uncertainty": 1e-5}),
    "flight.ContactTime.of_spheres": (
        flight.ContactTime.of_spheres,
        lambda: {"diameter": 6e-3, "mass": 1e-3, "ball": GLASS, "plate": GLASS},
    ),
    "Mesh.from_file": (rs.Mesh.from_file, lambda: {"path": folder() / "mesh.obj", "scale": 1e-3}),
    "CustomLaw": (rs.CustomLaw, lambda: {"function": _own, "name": "own"}),
    "Tabulated.from_function": (
        rs.Tabulated.from_function,
        lambda: {"function": lambda v: 1.0 / (1.0 + v), "fastest": 1.0},
    ),
    "RandomSpin": (rs.RandomSpin, lambda: {"rate": 1.0, "axis": "across"}),
    "RandomSpin.thermal": (rs.RandomSpin.thermal, lambda: {"body": good()["body"], "temperature": 1e-6}),
    "RandomHeight": (rs.RandomHeight, lambda: {"lowest": 0.05, "highest": 0.06}),
    "build_info": (rs.build_info, dict),
    "simulate": (rs.simulate, some("body", "law", **RUN)),
    "statistics": (rs.statistics, some("body", "law", *BINS, **RUN)),
    "reduce": (rs.reduce, some("data", *BINS)),
    "energy_budget": (rs.energy_budget, some("data")),
    "clusters": (rs.clusters, some("data")),
    "compare": (
        rs.compare,
        lambda: some(*BINS, particles=2, impacts=2)() | {"bodies": [good()["body"]], "laws": [good()["law"]]},
    ),
    "resting": (rs.resting, lambda: {"body": good()["die"], "data": good()["dropped"]}),
    "trajectory": (rs.trajectory, some("data", particle=3, times=[0.0, 0.1])),
    "analytic.first_impact": (analytic.first_impact, some("body", "law", orientation="isotropic")),
    "analytic.RoughContact": (analytic.RoughContact, lambda: {"mean_square": 1e-4, "sphere": 0.0}),
    "analytic.rough_contact": (
        analytic.rough_contact,
        lambda: {"radius": 3e-3, "asperities": 1000, "asperity_radius": 1e-4, "height": 1e-4},
    ),
    "analytic.rough_impact": (
        analytic.rough_impact,
        lambda: {
            "law": rs.Frictionless(normal=0.9),
            "contact": analytic.RoughContact(mean_square=1e-4, sphere=0.0),
            "speed": 0.3,
            "spin": 100.0,
            "radius": 3e-3,
        },
    ),
    "analytic.rough_spin": (
        analytic.rough_spin,
        lambda: {
            "law": rs.Frictionless(normal=0.9),
            "contact": analytic.RoughContact(mean_square=1e-4, sphere=0.0),
            "speed": 0.3,
            "release_speed": 1.0,
            "radius": 3e-3,
        },
    ),
    "analytic.negative_threshold": (analytic.negative_threshold, some("body", "law")),
    "gas.cool": (
        gas.cool,
        some("body", law=SMOOTH, particles=20, collisions=1.0, batches=2, samples=2, **WARM),
    ),
    "theory.rates": (gas.theory.rates, some("body", law=SMOOTH, **WARM)),
    "theory.steady_ratio": (gas.theory.steady_ratio, some("body", law=SMOOTH)),
    "theory.haff_time": (
        gas.theory.haff_time,
        some("body", law=SMOOTH, translational_temperature=1e-9),
    ),
    "theory.cooling": (gas.theory.cooling, some("body", law=SMOOTH, times=[0.0, 1.0], **WARM)),
    "analytic.near_round": (
        analytic.near_round,
        lambda: {
            "body": rs.Dumbbell(radius=3e-3, separation=3e-5),
            "law": good()["law"],
            "velocity_bins": [0.3, 0.5, 0.7],
            "angles": 100,
        },
    ),
}
