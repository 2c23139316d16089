"""ε(v) as it was measured, with the laws that were fitted."""

from collections.abc import Iterable

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from restitution._internal.arrays import check_each
from restitution._internal.parameters import ParameterError, wrong
from restitution.experiment.flight._law_fit import LawFit
from restitution.experiment.flight.chain import series_of
from restitution.figures.check import check_drawable
from restitution.figures.pieces import line
from restitution.figures.style import COLORS, Style, colors, column, panels, styled

_POINTS = 200


@styled
def figure(data: xr.Dataset | Iterable[xr.Dataset], *fits: LawFit, style: Style | None = None) -> Figure:
    """Draw ε against v with error bars, and each law with its band of one standard error.

    Parameters
    ----------
    data : Dataset or iterable of Dataset
        As `restitution.flight.restitution` returns it.
    *fits : LawFit
        Laws fitted to them. A fitted scatter widens the band by a lighter one.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Returns
    -------
    matplotlib.figure.Figure
        To be saved with its ``savefig``.

    Raises
    ------
    ValueError
        If no coefficient was measured.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.flight.restitution([0.0, 0.4001, 0.7800, 1.1411, 1.4841], 1e-4)
    >>> figure = rs.flight.figure(data, rs.flight.fit(data, "constant"))
    """
    needed = ("restitution", "restitution_error", "impact_velocity", "impact_velocity_error")
    named = series_of(data, *needed)
    for name, one in named.items():
        for each in needed:
            check_drawable(f"{name}.{each}", one[each].to_numpy().astype(np.float64))
        speed = one.impact_velocity.to_numpy().astype(np.float64)
        good = ~np.isfinite(one.restitution.to_numpy()) | (speed > 0.0)
        check_each(f"{name}.impact_velocity", speed, good, "a speed > 0 at every coefficient")
    known = [one.isel(impact=np.flatnonzero(np.isfinite(one.restitution.values))) for one in named.values()]
    speeds = np.concatenate([one.impact_velocity.values for one in known])
    if not speeds.size:
        allowed = "a Dataset of flight.restitution with at least one coefficient"
        raise ParameterError(wrong("data", data, allowed))
    for fit in fits:
        if not isinstance(fit, LawFit):
            raise ParameterError(wrong("fits", fit, "fits, as flight.fit returns them"))
    figure, [[axes]] = panels(*column(2.6))
    # Where shape makes hundreds of points scatter far, the curves must stay in sight.
    for number, one in enumerate(known):
        axes.errorbar(
            one.impact_velocity.values,
            one.restitution.values,
            xerr=one.impact_velocity_error.values,
            yerr=one.restitution_error.values,
            linestyle="none",
            marker="o",
            markersize=2.5,
            elinewidth=0.6,
            color=colors()[-1 - number % 2],
            label="measured" if number == 0 else None,
            zorder=3,
        )
    along = np.linspace(speeds.min(), speeds.max(), _POINTS)
    for number, law in enumerate(fits):
        color = colors()[number % len(COLORS)]
        dashes = ("-", "--", "-.", ":")[number % 4]
        line(axes, along, law(along), law.error(along), color=color, linestyle=dashes, label=law.law)
        if law.scatter > 0.0:
            middle = law(along)
            axes.fill_between(
                along, middle - law.scatter, middle + law.scatter, color=color, alpha=0.1, linewidth=0
            )
    axes.set_xlabel(r"impact velocity $v$ (m/s)")
    axes.set_ylabel(r"coefficient of restitution $\varepsilon$")
    axes.legend()
    return figure
