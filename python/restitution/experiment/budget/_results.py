"""An error budget and a required roundness: what they say in words, as tables and figures."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from restitution._internal.arrays import real
from restitution._internal.datasets import Content
from restitution._internal.parameters import ParameterError, wrong
from restitution.bodies import GRADES
from restitution.figures.pieces import plain_log
from restitution.figures.style import Style, colors, column, ink, panels, styled


class _Look(NamedTuple):
    """Name and style of a source: number of its colour, or strength of a grey, and marker."""

    words: str
    color: int | None
    grey: float
    marker: str


_SOURCES = {
    "shape": _Look("shape", 0, 1.0, "o"),
    "roughness": _Look("roughness", None, 0.25, "p"),
    "timing": _Look("times", 1, 1.0, "s"),
    "gravity": _Look("g", 2, 1.0, "^"),
    "clock": _Look("clock", None, 0.85, "h"),
    "drop": _Look("drop height", 3, 1.0, "v"),
    "tilt": _Look("plate tilt", 4, 1.0, "D"),
    "spin": _Look("spin at release", None, 0.7, "x"),
    "drag": _Look("air drag", None, 0.45, "+"),
    "contact": _Look("time of contact", 5, 1.0, "*"),
    "total": _Look("all", None, 1.0, ""),
}


@dataclass(frozen=True, eq=False, repr=False)
class ErrorBudget(Content):
    """Errors of a bouncing-ball experiment by their source.

    Attributes
    ----------
    data : Dataset
        Over ``source`` ("shape", "roughness", "timing", "gravity", "clock", "drop", "tilt", "spin", "drag",
        "contact", "total"):
        ``mean_bias`` and ``mean_standard_deviation`` of the mean over a run; over ``source`` and ``impact``:
        ``bias`` and ``standard_deviation`` of one coefficient, ``fit_bias`` and ``fit_standard_deviation`` of
        the fitted ε_n at that speed; over ``source`` and ``parameter``: ``parameter_bias`` and
        ``parameter_standard_deviation``. Over ``impact``: ``impact_velocity`` in m/s, ``restitution``, and
        where they are known the closed forms of a nearly round ball that turns far between impacts,
        ``kick``, ``turning_bias`` and ``turning_standard_deviation``. Of all that is sampled the standard
        errors, as ``bias_error``.

    Examples
    --------
    >>> import restitution as rs
    >>> ball = rs.from_roundness(6e-3, 15e-6)
    >>> budget = rs.error_budget(ball, rs.Frictionless(normal=0.95), drop=0.1, impacts=10, timing=5e-6)
    >>> print(budget.table().splitlines()[0])
    | source | first ε | ε at 0.88 m/s | mean ε | restitution |
    """

    data: xr.Dataset

    def table(self) -> str:
        """Write bias and standard deviation of the first and last ε, the mean and the fit, in Markdown.

        Sources that were given no error are left out.
        """
        data = self.data
        head = ["source", "first ε", f"ε at {float(data.impact_velocity[-1]):.2g} m/s", "mean ε"]
        for name, unit in zip(data.parameter.values, data.parameter_unit.values, strict=True):
            words = str(name).replace("_m_s", " m/s").replace("_", " ")
            head.append(words if unit == "1" else f"{words} ({unit})")
        lines = [f"| {' | '.join(head)} |", "|---" * len(head) + "|"]
        for source in data.source.values:
            one = data.sel(source=source)
            places = (
                *(("", {"impact": place}) for place in (0, -1)),
                ("mean_", {}),
                *(("parameter_", {"parameter": place}) for place in range(data.sizes["parameter"])),
            )
            cells = [_cell(one.isel(at), prefix) for prefix, at in places]
            if set(cells) == {"0"} and source not in ("shape", "total"):
                continue
            cells.insert(0, self._named(str(source)))
            lines.append(f"| {' | '.join(cells)} |")
        return "\n".join(lines)

    def _named(self, source: str) -> str:
        neglected = source in ("drag", "contact") and not self.data.attrs[f"{source}_corrected"]
        how = ", neglected" if neglected else ""
        if source == "contact" and not self.data.attrs["contact_given"]:
            how = ", not given"
        return _SOURCES[source].words + how

    def __repr__(self) -> str:
        data = self.data
        about = f"{data.attrs['impacts']} coefficients from a drop of {data.attrs['drop']:g} m"
        return f"Error budget, bias ± standard deviation: {about}\n{self.table()}"

    @styled
    def figure(self, *, style: Style | None = None) -> Figure:
        """Draw the root mean square error √(bias² + variance) of one ε by source, against the speed.

        Values that sampling cannot distinguish from 0 are not drawn, nor are those below a thousandth of the
        largest; lines join those that are.

        Parameters
        ----------
        style : str, optional
            "paper", "page" or "slides", with "-dark" for a dark ground.
        """
        figure, [[axes]] = panels(*column(3.0))
        speed = self.data.impact_velocity.values
        total = self.data.sel(source="total")
        least = _DRAWN * float(np.hypot(total.standard_deviation, total.bias).max())
        for source, look in _SOURCES.items():
            one = self.data.sel(source=source)
            known = one.standard_deviation > 2.0 * one.standard_deviation_error
            biased = np.abs(one.bias) > 2.0 * one.bias_error
            error = np.hypot(np.where(known, one.standard_deviation, 0.0), np.where(biased, one.bias, 0.0))
            shown = error > least
            if shown.any():
                name = self._named(source)
                color = ink(look.grey) if look.color is None else colors()[look.color]
                axes.plot(speed[shown], error[shown], color=color, marker=look.marker, label=name)
        axes.set_yscale("log")
        plain_log(axes, [tick for tick in _TICKS if speed.min() <= tick <= speed.max()])
        axes.set_xlabel(r"impact velocity $v$ (m/s)")
        axes.set_ylabel(r"error of one $\varepsilon$")
        figure.legend(loc="outside upper center", ncols=3)
        return figure


def _cell(one: xr.Dataset, prefix: str) -> str:
    """Bias ± standard deviation; what sampling cannot distinguish from 0 is given as 0 or as a limit."""
    bias, deviation, bias_error, deviation_error = (
        float(one[f"{prefix}{name}"])
        for name in ("bias", "standard_deviation", "bias_error", "standard_deviation_error")
    )
    shown = "0" if abs(bias) <= 2.0 * bias_error else f"{bias:.1e}"
    if max(abs(bias), deviation) < _NOTHING:
        return "0"
    if deviation <= 2.0 * deviation_error:
        return f"{shown} ± below {deviation + 2.0 * deviation_error:.1e}"
    return f"{shown} ± {deviation:.1e}"


_TICKS = tuple(digit * 10.0**power for power in range(-3, 3) for digit in (1, 1.5, 2, 3, 4, 6, 8))
_DRAWN = 1e-3
_NOTHING = 1e-12
"""Errors that are below this are of rounding."""


@dataclass(frozen=True, eq=False, repr=False)
class RequiredRoundness(Content):
    """The roundness that a precision requires.

    Attributes
    ----------
    out_of_roundness : float
        Largest out-of-roundness in m that keeps the error below; NaN where even the roundest ball asked about
        does not, infinity where every nearly round one does.
    precision : float
        The error asked for, over ε.
    data : Dataset
        Over ``out_of_roundness`` (m): ``single``, ``mean`` and ``fit``, the root mean square error over ε of
        one coefficient, of the mean over a run and of the fitted ε_n(v).

    Examples
    --------
    >>> import restitution as rs
    >>> wanted = rs.required_roundness(1e-3, diameter=6e-3, law=rs.Frictionless(normal=0.95), drop=0.1)
    >>> 1e-7 < wanted.out_of_roundness < 1e-4
    True
    """

    out_of_roundness: float
    precision: float
    data: xr.Dataset

    def __float__(self) -> float:
        return self.out_of_roundness

    @property
    def grade(self) -> int | None:
        """The coarsest grade of ball bearings that is round enough, if any is."""
        good = [grade for grade, deviation in GRADES.items() if deviation <= self.out_of_roundness]
        return max(good) if good else None

    def allowed(self, precision: float, quantity: str = "mean") -> float:
        """Return the largest out-of-roundness in m for another precision, or another quantity.

        Raises
        ------
        ValueError
            If the precision is not above 0, or there is no such quantity.
        """
        precision = real("precision", precision, "a number > 0, an error of ε over ε", lambda x: x > 0.0)
        if not isinstance(quantity, str) or quantity not in ("single", "mean", "fit"):
            raise ParameterError(wrong("quantity", quantity, '"single", "mean" or "fit"'))
        error, deviation = self.data[quantity].values, self.data.out_of_roundness.values
        above = np.flatnonzero(error > precision)
        if not above.size:
            return float("inf")
        first = int(above[0])
        if first == 0:
            return float("nan")
        low, high = np.log(error[first - 1 : first + 1])
        share = (np.log(precision) - low) / (high - low)
        a, b = np.log(deviation[first - 1 : first + 1])
        return float(np.exp(a + share * (b - a)))

    def table(self) -> str:
        """Write the out-of-roundness, over the diameter, for several precisions, in Markdown."""
        diameter = self.data.attrs["diameter"]
        lines = ["| error of ε | one impact | mean of a run | fitted ε_n(v) |", "|---|---|---|---|"]
        for precision in (1e-4, 3e-4, 1e-3, 3e-3, 1e-2):
            cells = [_length(self.allowed(precision, name), diameter) for name in ("single", "mean", "fit")]
            lines.append(f"| {100 * precision:g} % | {' | '.join(cells)} |")
        return "\n".join(lines)

    def __repr__(self) -> str:
        diameter, quantity = self.data.attrs["diameter"], self.data.attrs["quantity"]
        allowed = _length(self.out_of_roundness, diameter)
        what = {"single": "one coefficient", "mean": "the mean over a run", "fit": "the fitted law"}[quantity]
        grade = "" if self.grade is None else f"; grade {self.grade} is round enough"
        return (
            f"Out-of-roundness for an error of {100 * self.precision:g} % in {what}: {allowed} "
            f"of {1e3 * diameter:g} mm{grade}"
        )

    @styled
    def figure(self, *, style: Style | None = None) -> Figure:
        """Draw the errors against the out-of-roundness, with the grades of ball bearings above.

        Parameters
        ----------
        style : str, optional
            "paper", "page" or "slides", with "-dark" for a dark ground.
        """
        figure, [[axes]] = panels(*column(3.0))
        deviation = self.data.out_of_roundness.values * 1e6
        names = {"single": "one impact", "mean": "mean of a run", "fit": r"fitted $\varepsilon_n(v)$"}
        for number, (name, label) in enumerate(names.items()):
            dashes = ("-", "--", ":")[number]
            axes.loglog(deviation, self.data[name], dashes, color=colors()[number], label=label)
        axes.axhline(self.precision, color=ink(0.4))
        axes.set_xlim(deviation[0], deviation[-1])
        axes.set_xlabel("out-of-roundness (µm)")
        axes.set_ylabel(r"error of $\varepsilon$ over $\varepsilon$")
        axes.legend(loc="upper left")
        above = axes.secondary_xaxis("top")
        inside = {g: 1e6 * t for g, t in GRADES.items() if deviation[0] <= 1e6 * t <= deviation[-1]}
        chosen = [g for g in (3, 10, 28, 100, 1000) if g in inside]
        above.set_xticks([inside[g] for g in chosen], [str(g) for g in chosen])
        above.minorticks_off()
        above.set_xlabel("grade of ball bearings")
        return figure


def _length(value: float, diameter: float) -> str:
    if np.isnan(value):
        return "none"
    if np.isinf(value):
        return "any"
    return f"{float(f'{1e6 * value:.2g}'):g} µm ({100.0 * value / diameter:.2g} %)"
