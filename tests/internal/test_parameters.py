"""Sets of parameters where people meet them: `help`, completion, print, notebooks."""

import inspect
import pydoc
import re
import textwrap
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import xarray as xr

import restitution as rs
from restitution import bodies, laws

BODY = rs.Dumbbell(radius=3e-3, separation=3e-4)

LAW = rs.TangentialRestitution(normal=0.98)

OBJECTS = [
    BODY,
    rs.LoadedSphere(radius=3e-3, load=1e-5, offset=1e-3),
    rs.Spherocylinder(radius=3e-3, separation=1e-3),
    rs.Spheroid(equatorial=2e-2, polar=3e-2),
    LAW,
    rs.Frictionless(normal=rs.Plastic(yield_speed=0.1)),
    rs.Coulomb(normal=0.9, friction=0.3),
    rs.ChatterjeeRuina(normal=0.9, tangential=0.0, friction=0.3),
    rs.RandomSpin(rate=(0.0, 3.0)),
    rs.Tabulated(v=np.linspace(0, 1, 50), e=np.linspace(1, 0.5, 50)),
]

MODULES = (rs.analytic, rs.fit, rs.flight, rs.sound, rs.figures, rs.study)

PUBLIC = [getattr(rs, name) for name in rs.__all__] + [getattr(m, n) for m in MODULES for n in m.__all__]

CALLABLE = [one for one in PUBLIC if callable(one) and not hasattr(one, "model_fields")]


@pytest.mark.parametrize("thing", CALLABLE, ids=lambda one: one.__name__)
def test_help_is_about_the_package(thing: Any) -> None:
    """No expansion of NumPy's ArrayLike, and an explanation of everything."""
    text = pydoc.plain(pydoc.render_doc(thing))
    for word in ("_SupportsArray", "PydanticUndefined", "ValidationError"):
        assert word not in text
    assert "No documentation" not in text


@pytest.mark.parametrize("thing", [rs.simulate, rs.statistics, rs.FluctuatingRestitution.learn])
def test_the_signature_fits_a_screen(thing: Any) -> None:
    """At 80 columns, less than the 24 lines of a terminal before the prose."""
    assert len(textwrap.wrap(str(inspect.signature(thing)), 80)) < 20
    assert "npt.ArrayLike" in str(inspect.signature(thing))


@pytest.mark.parametrize("one", OBJECTS, ids=lambda one: type(one).__name__)
def test_an_object_says_what_it_is(one: Any) -> None:
    """Printed it is its class with its parameters; a notebook gets a table of them; completion lists ours."""
    assert str(one) == repr(one) or isinstance(one, rs.Tabulated)
    assert str(one).startswith(f"{type(one).__name__}(")
    assert len(str(one)) < 200
    html = one._repr_html_()
    for name in type(one).model_fields:
        assert (f">{name}<" in html) == (getattr(one, name) is not None)
        assert name in dir(one)
    assert html.count("<tr>") == html.count("</tr>") > 0
    assert "validation" not in str(type(one).__init__.__doc__)  # which Jupyter shows at one?
    assert not [name for name in dir(one) if name.startswith(("model_", "_", "parse_", "json", "dict"))]
    assert len(html) < 4000


@pytest.mark.parametrize("kind", [*bodies.KINDS, *bodies.RIGID, *laws.KINDS], ids=lambda kind: kind.__name__)
def test_help_fits_two_screens(kind: Any) -> None:
    """It has parameters, properties and methods, each parameter with its text, and none of pydantic's."""
    text = pydoc.plain(pydoc.render_doc(kind))
    # From Python 3.13 on each parameter of a long signature has a line of its own.
    lines = re.sub(r"\(\n( \|      .*\n)+? \|  \)", "()", text).splitlines()
    assert len(lines) <= 100
    described = {
        name
        for line in lines
        if (found := re.match(r" \|  ([\w, ]+) : ", line))
        for name in found[1].split(", ")
    }
    assert described >= set(kind.model_fields)
    assert not any("model_fields" in line or "validat" in line for line in lines)


def test_a_large_body_is_printed_short() -> None:
    spheres = [(0.1 / k, 0.2 / k, 0.3 / k, 1e-3 / k) for k in range(1, 501)]
    assert len(repr(rs.Clump(spheres=spheres, inertia="sum"))) < 200


@pytest.mark.parametrize("one", OBJECTS, ids=lambda one: type(one).__name__)
def test_numbers_have_the_units_that_the_docstring_says(one: Any) -> None:
    """In the table of a notebook, and beside the numbers in which bodies or laws differ in `compare`."""
    for name, about in re.findall(r"^    (\w+) : .*\n((?:        .*\n)+)", type(one).__doc__ or "", re.M):
        unit = re.search(r"\bin (m|kg|kg/m³|m/s|rad/s)[;,.]", " ".join(about.split()))
        if unit and "array" not in about and getattr(one, name) is not None:
            assert re.search(rf">{name}</th>[^/]*>[^<]* {unit[1]}</td>", one._repr_html_()), name


@pytest.mark.parametrize("one", OBJECTS, ids=lambda one: type(one).__name__)
def test_an_object_stays_what_it_is(one: Any) -> None:
    name = next(iter(type(one).model_fields))
    changes: list[Callable[[], None]] = [
        lambda: setattr(one, name, 1.0),
        lambda: setattr(one, "colour", 1),
    ]
    for change in changes:
        with pytest.raises(AttributeError, match="cannot be changed; make another"):
            change()


def test_parameters_have_names() -> None:
    with pytest.raises(
        TypeError, match=r"Dumbbell: parameters are given by name, as in Dumbbell\(radius=..., separation="
    ):
        rs.Dumbbell(3e-3, 3e-4)  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"Coulomb: .* as in Coulomb\(normal=..., friction="):
        rs.Coulomb(0.9, friction=0.3)  # type: ignore[call-arg]
    assert rs.RandomHeight(0.05, 0.07) == rs.RandomHeight(lowest=0.05, highest=0.07)
    for values, named in (((0.05,), {"lowest": 0.04}), ((0.05, 0.06, 0.07), {})):
        with pytest.raises(TypeError, match=r"RandomHeight: parameters are given by name, as in"):
            rs.RandomHeight(*values, **named)
    with pytest.raises(ValueError, match="highest: missing; must be a finite number > 0 "):
        rs.RandomHeight(0.05)  # type: ignore[call-arg]
    with pytest.raises(
        ValueError, match=r"radius = array\(\[1., 2., 3.\]\): must be a finite number > 0 \(or one"
    ):
        rs.Dumbbell(radius=np.array([1.0, 2.0, 3.0]), separation=1.0)
    assert rs.Dumbbell(radius=np.array([1.0, 2.0]), separation=1.0).radii == (1.0, 2.0)


def test_distributions_and_fits_have_tables() -> None:
    found = rs.analytic.first_impact(BODY, LAW)
    assert "P(ε &lt; 0)" in found._repr_html_()
    fit = rs.fit.gaussian(np.random.default_rng(1).normal(size=100))
    assert "Gaussian, by maximum likelihood" in fit._repr_html_()
    how: dict[str, Any] = {"particles": 400, "velocities": (0.2, 0.6)}
    learned = rs.FluctuatingRestitution.learn(BODY, LAW, **how)
    assert "largest ks_distance" in learned._repr_html_()
    figure: Any = learned.figure()
    png, size = figure._repr_png_()
    assert png.startswith(b"\x89PNG")
    assert size["width"] == pytest.approx(700, abs=1)


def test_no_variable_has_the_name_of_a_method() -> None:
    """`found.mean` must be the variable or the method of xarray, and no one should have to know which."""
    data = rs.simulate(BODY, LAW, particles=400, impacts=400)
    bins: dict[str, Any] = {
        "velocity_bins": np.linspace(0.1, 1.0, 4),
        "restitution_bins": np.linspace(0.0, 2.0, 5),
    }
    learned = rs.FluctuatingRestitution.learn(BODY, LAW, particles=400, velocities=(0.2, 0.6))
    datasets = {
        "simulate": data,
        "statistics": rs.statistics(BODY, LAW, particles=20, impacts=40, **bins),
        "by impact": rs.statistics(BODY, LAW, particles=20, impacts=40, **bins | {"velocity_bins": None}),
        "reduce": rs.reduce(data, **bins),
        "compare": rs.compare([BODY], [LAW], particles=20, impacts=40, **bins),
        "learned": learned.data,
        "distance": learned.distance(data),
        "memory": learned.memory(data),
        "dependence": rs.fit.dependence(data, bins["velocity_bins"]),
    }
    taken = set(dir(xr.Dataset))
    assert {name: [str(v) for v in d.variables if v in taken] for name, d in datasets.items()} == {
        name: [] for name in datasets
    }


def test_long_tables_are_shortened_in_print() -> None:
    """A law with a tabulated function prints in one line; `repr` has all points."""
    law = rs.Frictionless(normal=rs.Tabulated(v=range(10), e=np.linspace(1, 0.1, 10)))
    assert (
        str(law) == "Frictionless(normal=Tabulated(v=(0.0, 1.0, 2.0, ..., 9.0), e=(1.0, 0.9, 0.8, ..., 0.1)))"
    )
    assert "3.0, 4.0, 5.0" in repr(law)


def test_results_of_fits_show_themselves() -> None:
    """Every result of fitting has a table for notebooks; printed it is a line of text."""
    data = rs.simulate(BODY, LAW, particles=100, impacts=100)
    how: dict[str, Any] = {"velocity": (0.3, 0.6)}
    boot = rs.fit.bootstrap(rs.fit.laplace, data, resamples=9, **how)
    judged = rs.fit.goodness(rs.fit.laplace, data, resamples=9, **how)
    x = np.random.default_rng(1).laplace(size=200)
    better = rs.fit.compare(rs.fit.laplace(x), rs.fit.gaussian(x), x)
    measured = rs.flight.fit(rs.flight.restitution([0.0, 0.4001, 0.7800, 1.1411, 1.4841], 1e-4))
    slopes = rs.fit.slopes(data, [0.3, 0.5, 0.8], location=0.98, resamples=5)
    for one in (boot, judged, better, measured, slopes):
        assert "<table" in one._repr_html_() or "xr-wrap" in one._repr_html_()
    assert all(f"{name} = " in str(boot) for name in boot.fit.parameters)
    assert "particles</th><td" in boot._repr_html_()
    assert f"p = {judged.kolmogorov_smirnov_p:.2g}" in str(judged)
    assert all(len(str(one)) < 200 for one in (boot, judged, better, measured))


def test_a_figure_is_called_so() -> None:
    """Printed, or where pictures cannot be shown."""
    found = rs.reduce(
        rs.simulate(BODY, LAW, particles=50, impacts=50),
        velocity_bins=10,
        velocity_range=(0.0, 1.1),
        restitution_bins=20,
        restitution_range=(0.0, 2.0),
    )
    assert repr(rs.figures.map(found)).startswith("<Figure size")


def test_a_fit_prints_as_text() -> None:
    """Family, number of samples and parameters, and nothing of how they are kept."""
    found = rs.fit.laplace(np.array([0.5, 1.0, 1.5, 1.25]))
    assert (
        str(found)
        == "symmetric Laplace, by maximum likelihood of 4 samples: location = 1.125, scale = 0.3125"
    )
