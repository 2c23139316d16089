"""Calls of what other calls return, of fits and of figures; as in `calls`."""

from collections.abc import Callable
from functools import wraps
from typing import Any

import numpy as np

import restitution as rs
from reference.calls import WINDOW, Call, folder, good, of, some
from restitution import analytic, figures, fit

POINT = {"x": 0.9, "q": 0.5, "order": 2, "confidence": 0.9, "moments": "mv", "size": 3, "random_state": 1}
"""Of every distribution, by name of the argument."""


def _wave(x: Any) -> Any:
    return np.cos(x)


def _own(kind: type, name: str) -> Callable[..., Any]:
    """Give the method that an object has itself; that of an abstract class does nothing."""

    @wraps(getattr(kind, name))
    def method(self: Any, **given: Any) -> Any:
        return getattr(self, name)(**given)

    return method


def _methods(home: str, kind: type, thing: str, names: dict[str, str], **more: Any) -> dict[str, Call]:
    """Methods that take what is in POINT, and the same besides."""
    return {
        f"{home}.{name}": (
            _own(kind, name),
            of(thing, **({word: POINT[word] for word in words.split()} | more)),
        )
        for name, words in names.items()
    }


_FROZEN = dict.fromkeys(("cdf", "sf", "logcdf", "logsf", "pdf", "logpdf"), "x")
_FROZEN |= dict.fromkeys(("ppf", "isf"), "q") | dict.fromkeys(("mean", "median", "var", "std"), "")
_FROZEN |= {"entropy": "", "support": "", "interval": "confidence", "moment": "order", "stats": "moments"}
_FROZEN |= {"rvs": "size random_state"}
_ERRORS = {"cdf_error": "x", "pdf_error": "x", "ppf_error": "q", "mean_error": "", "std_error": ""}
_ERRORS |= dict.fromkeys(("var_error", "skewness_error", "kurtosis_error"), "")
_LEARNED = _FROZEN | dict.fromkeys(("skewness", "kurtosis", "resolved"), "")

FIRST, LEARNED = analytic.FirstImpact, rs.FluctuatingRestitution
CALLS: dict[str, Call] = {
    **_methods("analytic.FirstImpact", FIRST, "first", _FROZEN),
    "analytic.FirstImpact.expect": (_own(FIRST, "expect"), of("first", func=_wave)),
    "analytic.FirstImpact.at": (_own(FIRST, "at"), of("first", normal=[(0.0, 0.0, 1.0), (0.6, 0.0, 0.8)])),
    "analytic.FirstImpact.cos_theta": (_own(FIRST, "cos_theta"), of("first", restitution=0.8)),
    "analytic.FirstImpact.restitution": (_own(FIRST, "restitution"), of("first", cos_theta=0.5)),
    **_methods("FluctuatingRestitution", LEARNED, "dist", _LEARNED, v=0.8),
    **_methods("FluctuatingRestitution", LEARNED, "given", _ERRORS, v=0.5, given=0.1),
    "FluctuatingRestitution": (LEARNED, lambda: {"data": good()["dist"].data}),
    "FluctuatingRestitution.expect": (LEARNED.expect, of("dist", func=_wave, v=0.8)),
    "FluctuatingRestitution.clamped": (LEARNED.clamped, of("dist")),
    "FluctuatingRestitution.figure": (LEARNED.figure, of("dist")),
    "FluctuatingRestitution.summary": (LEARNED.summary, of("dist")),
    "FluctuatingRestitution.distance": (LEARNED.distance, lambda: of("dist")() | some("data")()),
    "FluctuatingRestitution.memory": (LEARNED.memory, lambda: of("given")() | some("data", lags=2)()),
    "FluctuatingRestitution.from_statistics": (
        LEARNED.from_statistics,
        lambda: {"statistics": good()["learned"]},
    ),
    "FluctuatingRestitution.learn": (
        LEARNED.learn,
        some("body", "law", particles=400, impacts=60, velocities=[0.3, 0.45, 0.6]),
    ),
    "FluctuatingRestitution.load": (LEARNED.load, lambda: {"path": folder() / "dist.nc"}),
    "FluctuatingRestitution.save": (LEARNED.save, of("dist", path="dist.nc", replace=True)),
    "FluctuatingRestitution.to_c": (LEARNED.to_c, of("dist", path="dist.h", name="dist", replace=True)),
    "FluctuatingRestitution.to_fortran": (
        LEARNED.to_fortran,
        of("dist", path="dist.f90", name="dist", replace=True),
    ),
    "fit.Counts": (fit.Counts, lambda: {"edges": [0.0, 1.0, 2.0], "count": [1, 2], "below": 1, "above": 2}),
    "fit.Counts.at": (fit.Counts.at, lambda: {"statistics": good()["found"], "velocity": 0.65}),
    "fit.Counts.cumulative": (fit.Counts.cumulative, of("counts")),
    "fit.Counts.quantile": (fit.Counts.quantile, of("counts", q=0.5)),
    "fit.Counts.loglikelihood": (
        fit.Counts.loglikelihood,
        lambda: of("counts")() | {"distribution": good()["fit"].distribution},
    ),
    "fit.Counts.logshare": (
        fit.Counts.logshare,
        lambda: of("counts")() | {"distribution": good()["fit"].distribution},
    ),
    "fit.Fit.pdf": (fit.Fit.pdf, of("fit", x=0.9)),
    "fit.Fit.logpdf": (fit.Fit.logpdf, of("fit", x=0.9)),
    "fit.Fit.cdf": (fit.Fit.cdf, of("fit", x=0.9)),
    "fit.Fit.to_latex": (fit.Fit.to_latex, of("fit", errors={"scale": 0.1})),
    "fit.Bootstrap.to_latex": (fit.Bootstrap.to_latex, of("bootstrap")),
    "fit.Fit.rvs": (fit.Fit.rvs, of("fit", size=3, seed=1)),
    "fit.Bootstrap.interval": (fit.Bootstrap.interval, of("bootstrap", name="scale", confidence=0.9)),
    "fit.Bootstrap.draws": (fit.Bootstrap.draws, of("bootstrap", name="scale")),
    "fit.Bootstrap.band": (fit.Bootstrap.band, of("bootstrap", x=[0.8, 0.9], confidence=0.9)),
    "fit.Slopes.fails_below": (fit.Slopes.fails_below, of("slopes", distance=0.03, high=1.0)),
    "fit.Slopes.power_law": (fit.Slopes.power_law, of("slopes", side="above")),
    **{
        f"fit.{name}": (
            getattr(fit, name),
            lambda more=more: {"samples": good()["data"], "velocity": WINDOW} | more,  # type: ignore[misc]
        )
        for name, more in {
            "gaussian": {},
            "laplace": {},
            "logistic": {},
            "student_t": {},
            "asymmetric_laplace": {},
            "asymmetric_power": {},
            "cusp_mixture": {"location": 0.9},
        }.items()
    },
    **{
        f"fit.{name}": (
            getattr(fit, name),
            lambda: {
                "family": fit.laplace,
                "samples": good()["data"],
                "velocity": WINDOW,
                "resamples": 2,
            },
        )
        for name in ("bootstrap", "goodness")
    },
    "fit.compare": (
        fit.compare,
        lambda: {
            "first": good()["fit"],
            "second": good()["fit"],
            "samples": good()["data"],
            "velocity": WINDOW,
        },
    ),
    "fit.slopes": (fit.slopes, some("data", velocity_bins=[0.3, 0.5, 0.7], resamples=2)),
    "fit.dependence": (fit.dependence, some("data", velocity_bins=[0.3, 0.5, 0.7], lags=2)),
}


def _drawn(function: Callable[..., Any], /, *names: str, **others: Any) -> Call:
    """Call a function that draws into a panel, which is made anew each time."""

    def given() -> dict[str, Any]:
        figure, [[axes]] = figures.panels(3.0, 2.0)
        return {"axes": axes, "figure": figure, **others} if "figure" in names else {"axes": axes, **others}

    return function, given


def _bar() -> dict[str, Any]:
    figure, [[axes]] = figures.panels(3.0, 2.0)
    edges = np.arange(3.0)
    return {
        "figure": figure,
        "axes": axes,
        "mesh": figures.population(axes, edges, edges, np.ones((2, 2), dtype=int)),
    }


EDGES = np.arange(3.0)
CALLS |= {
    "figures.map": (figures.map, some("found")),
    "figures.densities": (figures.densities, some("found", velocities=[0.55, 0.75])),
    "figures.scatter": (figures.scatter, some("found")),
    "figures.moments": (figures.moments, some("found")),
    "figures.fraction": (figures.fraction, some("found")),
    "figures.resting": (figures.resting, lambda: {"found": rs.resting(good()["die"], good()["dropped"])}),
    "figures.trajectory": (figures.trajectory, some("data", particle=1, impacts=5)),
    "figures.body": (figures.body, some("body", angle=0.5)),
    "figures.impact": (figures.impact, some("data", particle=1, impact=2)),
    "figures.animate": (figures.animate, some("data", particle=1, impacts=(1, 2))),
    "figures.Film.centre": (figures.Film.centre, of("film", frame=3)),
    "figures.Film.picture": (figures.Film.picture, of("film", frame=3)),
    "figures.Film.save": (figures.Film.save, of("film", name="film.gif")),
    "figures.panels": (figures.panels, lambda: {"width": 3.0, "height": 2.0}),
    "figures.save": (figures.save, some("figure", name="figure.png")),
    "figures.letter": _drawn(figures.letter, text="(a)"),
    "figures.line": _drawn(figures.line, x=EDGES, y=EDGES, error=EDGES),
    "figures.histogram": _drawn(figures.histogram, edges=EDGES, density=EDGES[:2], error=EDGES[:2]),
    "figures.plain_log": _drawn(figures.plain_log, ticks=[1.0, 10.0]),
    "figures.population": _drawn(
        figures.population, x_edges=EDGES, y_edges=EDGES, count=np.ones((2, 2), dtype=int)
    ),
    "figures.population_bar": (figures.population_bar, _bar),
    "figures.styled": (figures.styled, lambda: {"function": _wave}),
}
