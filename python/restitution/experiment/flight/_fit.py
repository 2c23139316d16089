"""A law ε_n(v) fitted to measured impacts, with the whole covariance of the measurement."""

from collections.abc import Hashable, Iterable
from dataclasses import replace
from typing import Literal

import numpy as np
import numpy.typing as npt
import xarray as xr

from restitution._internal.arrays import real
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.experiment.flight._law_fit import LawFit
from restitution.experiment.flight._problem import Misfit
from restitution.experiment.flight.chain import joined, measured_of, series_of
from restitution.experiment.flight.laws import law_named
from restitution.experiment.flight.separation import separation
from restitution.experiment.flight.times import LARGEST


def fit(
    data: xr.Dataset | Iterable[xr.Dataset],
    law: str | type = "constant",
    *,
    scatter: float | Literal["fit"] = 0.0,
    groups: Iterable[Hashable] | None = None,
) -> LawFit:
    """Fit a law ε_n(v) to measured impacts.

    The residual of impact i is r_i = v'_i - ε_n(v_i) v_i, with the speeds v_i before and v'_i after it. Its
    covariance C follows from the errors of the times, of g, drop and drag, in which neighbours share an
    interval: χ² = r C⁻¹ r is what the least squares of the times themselves would give.

    Parameters
    ----------
    data : Dataset or iterable of Dataset
        One series as `restitution.flight.restitution` returns it, or several with the same g and drag.
    law : {"constant", "power law", "viscoelastic", "plastic"}, or the class Viscoelastic or Plastic
        ε_n; ε_1 (v/(1 m/s))^-q; the Padé approximant of viscoelastic spheres with its parameter β; plastic
        spheres with their yield speed.
    scatter : float or "fit"
        Standard deviation of ε about the law besides the errors of measurement, >= 0, as an imperfect shape
        makes it; or fitted with the law, by the restricted likelihood, together with one between several
        series, as of other drops or plates; errors are averaged over all scatters that are not excluded. If
        the times came without an uncertainty it is fitted, too, where the coefficients tell one from the
        other; the fit's ``note`` says what they tell.

    groups : iterable, optional
        Of each series the group to which it belongs, such as the name of a student's table: then a scatter
        between groups is fitted beside that between series of one group, where some have several.

    Returns
    -------
    LawFit
        Parameters with errors and covariance, χ², the criteria that compare laws; call it for ε_n(v).

    Raises
    ------
    ValueError
        If the law is unknown, or too few coefficients were measured, or times have no errors.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.flight.restitution([0.0, 0.4001, 0.7800, 1.1411, 1.4841], 1e-4)
    >>> print(rs.flight.fit(data, "constant"))
    constant: restitution = 0.95004 ± 0.00014; χ²/n = 0.8/2, p = 0.66
    """
    form = law_named(law)
    experiments = [measured_of(one, name) for name, one in series_of(data, "time", "uncertainty").items()]
    links = joined(experiments, None)
    known = ~np.isnan(links.before) & ~np.isnan(links.after)
    free = len(form.parameters)
    if known.sum() <= free:
        needed = f"at least {free + 1} coefficients, to fit the law {form.name!r}"
        text = f": {known.sum()} coefficients of restitution; must have {needed}"
        raise ParameterError(Problem("data", text))
    if not (isinstance(scatter, str) and scatter == "fit"):
        allowed = '"fit" or a number in [0, 1e30]'
        scatter = real("scatter", scatter, allowed, lambda width: 0.0 <= width <= LARGEST)
    number = _numbered(groups, len(experiments))
    if number is not None and scatter != "fit":
        raise ParameterError(Problem("groups", f": given with scatter = {scatter!r}; must come with 'fit'"))
    problem = Misfit(form, experiments, known, number)
    if scatter == 0.0 and not problem.errors_are_known:
        text = ": times without errors; must have an uncertainty > 0, or give scatter='fit'"
        raise ParameterError(Problem("data", text))
    note = ""
    if scatter == "fit" and not any(one.variances[: one.times.size].any() for one in experiments):
        found = separation(experiments)
        note = found.words
        if found.timing > 0.0:
            problem = Misfit(form, [one.timed(found.timing) for one in experiments], known, number)
            scatter = found.scatter
    try:
        return replace(problem.fit(scatter), note=note)
    except (np.linalg.LinAlgError, ValueError):  # of Cholesky, or of least squares that met a NaN
        text = f": the law {form.name!r} has no fit; errors must be small beside the intervals"
        raise ParameterError(Problem("data", text)) from None


def _numbered(groups: object, series: int) -> npt.NDArray[np.intp] | None:
    """Return the number of the group of each series; None where each is its own, or all are of one."""
    if groups is None:
        return None
    allowed = f"a label for each of the {series} series"
    try:
        labels = list(groups) if isinstance(groups, Iterable) else []
        places = {label: place for place, label in enumerate(dict.fromkeys(labels))}
    except Exception:  # the object may raise anything
        labels, places = [], {}
    if len(labels) != series:
        raise ParameterError(wrong("groups", groups, allowed))
    if not 1 < len(places) < series:
        return None
    return np.array([places[label] for label in labels])


def compare(*fits: LawFit) -> str:
    """Order fits of the same data by Akaike's criterion, as a table in Markdown.

    Raises
    ------
    ValueError
        If the fits are not of the same data.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.flight.restitution([0.0, 0.4001, 0.7800, 1.1411, 1.4841, 1.8098], 1e-4)
    >>> fits = [rs.flight.fit(data, law) for law in ("constant", "power law")]
    >>> print(rs.flight.compare(*fits).splitlines()[0])
    | law | parameters | χ² | n | p | ΔAIC |
    """
    for one in fits:
        if not isinstance(one, LawFit):
            raise ParameterError(wrong("fits", one, "fits that flight.fit returned"))
    if len({one.impacts for one in fits}) != 1:
        numbers = ", ".join(str(one.impacts) for one in fits) or "none"
        raise ParameterError(Problem("fits", f": of {numbers} coefficients; must be fits of the same data"))
    ordered = sorted(fits, key=lambda one: one.aic)
    best = ordered[0].aic
    lines = ["| law | parameters | χ² | n | p | ΔAIC |", "|---|---|---|---|---|---|"]
    for one in ordered:
        words = str(one).removeprefix(one.law + ": ").split(";")[0]
        chance = "" if one.scatter_error > 0.0 else f"{one.p_value:.2g}"
        quality = f"{one.chi2:.1f} | {one.degrees_of_freedom} | {chance} | {one.aic - best:.1f}"
        lines.append(f"| {one.law} | {words} | {quality} |")
    return "\n".join(lines)
