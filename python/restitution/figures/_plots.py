"""Figures of one's own results in a line each: maps, densities, scatter, moments and trajectories."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from restitution._internal.arrays import FARTHEST, FloatArray, reals, whole, word
from restitution._internal.parameters import ParameterError, Problem, renamed, wrong
from restitution.drop.recorded import (
    check_filled,
    check_successive,
    counted,
    pull,
    records,
    released_from,
    variables,
)
from restitution.drop.trajectory import times_of
from restitution.figures.check import check_drawable
from restitution.figures.pieces import line, plain_log, population, population_bar
from restitution.figures.style import (
    COLORS,
    DEVIATION,
    FRACTION,
    MARKERS,
    PAGE,
    RESTITUTION,
    VELOCITY,
    Style,
    colors,
    column,
    ink,
    letter,
    panels,
    points,
    styled,
)

if TYPE_CHECKING:
    import numpy.typing as npt

    from restitution.analytic import FirstImpact
    from restitution.distribution import FluctuatingRestitution

MOST = 24
"""Lines of a figure, which differ by colour and by marker or stroke."""


@styled
def map(
    found: xr.Dataset, of: Literal["restitution", "fraction"] = "restitution", *, style: Style | None = None
) -> Figure:
    """Draw where the impacts are in the plane of velocity and restitution, as the paper's Figs. 2 and 3.

    Parameters
    ----------
    found : xarray.Dataset
        As from `restitution.statistics` or `restitution.reduce`, by velocity.
    of : {"restitution", "fraction"}
        What stands over the velocity: ε, or E_rot/E_tot.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Returns
    -------
    matplotlib.figure.Figure
        Shown by a notebook; `save` writes it.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> found = rs.statistics(
    ...     rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98), particles=100,
    ...     velocity_bins=np.linspace(0.0, 1.2, 121), restitution_bins=np.linspace(0.5, 1.5, 101))
    >>> figure = rs.figures.map(found)
    """
    word("of", of, ("restitution", "fraction"))
    found = counted("found", found, (f"{of}_count", "velocity_edges", f"{of}_edges"))
    if not found[f"{of}_count"].any():
        raise ParameterError(Problem(f"found.{of}_count", ": every bin is empty; must hold an impact"))
    figure, [[axes]] = panels(*column(2.7))
    across, up = (found[f"{name}_edges"].to_numpy() for name in ("velocity", of))
    population_bar(figure, population(axes, across, up, found[f"{of}_count"].to_numpy()), axes)
    axes.set_xlabel(VELOCITY)
    axes.set_ylabel(RESTITUTION if of == "restitution" else FRACTION)
    # A number at either corner would touch that of the other axis.
    axes.yaxis.set_major_locator(MaxNLocator(6, steps=[1, 2, 5, 10], prune="lower"))
    return figure


@styled
def densities(
    found: xr.Dataset | FluctuatingRestitution,
    velocities: npt.ArrayLike,
    *,
    exact: FirstImpact | None = None,
    style: Style | None = None,
) -> Figure:
    """Draw p(ε | v) at some speeds, on a logarithmic axis, as the paper's Fig. 4.

    Parameters
    ----------
    found : xarray.Dataset or FluctuatingRestitution
        Statistics by velocity, of which the bins that hold the speeds are drawn, or a learned distribution.
    velocities : array_like
        At most six impact velocities in m/s.
    exact : FirstImpact, optional
        Closed form of `restitution.analytic.first_impact`, drawn as a dashed line.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> found = rs.statistics(
    ...     rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98), particles=100,
    ...     velocity_bins=np.linspace(0.0, 1.2, 61), restitution_bins=np.linspace(0.5, 1.5, 101))
    >>> figure = rs.figures.densities(found, [0.2, 0.4])
    """
    from restitution.analytic import FirstImpact
    from restitution.distribution import FluctuatingRestitution

    if not isinstance(found, xr.Dataset | FluctuatingRestitution):
        raise ParameterError(
            wrong("found", found, "a Dataset of restitution.statistics, or a FluctuatingRestitution")
        )
    allowed = f"1 to {len(COLORS)} speeds in m/s"
    speeds = np.atleast_1d(reals("velocities", velocities, allowed, unit="m s-1", dimensions=(0, 1)))
    if not 1 <= speeds.size <= len(COLORS):
        raise ParameterError(wrong("velocities", velocities, allowed))
    if exact is not None and not isinstance(exact, FirstImpact):
        raise ParameterError(wrong("exact", exact, "what restitution.analytic.first_impact returns, or None"))
    figure, [[axes]] = panels(*column(2.7))
    many = np.ndim(velocities) > 0
    for k, v in enumerate(speeds):
        if isinstance(found, xr.Dataset):
            edges, density, name = _bin_density(found, f"velocities[{k}]" if many else "velocities", float(v))
        else:
            place = f"velocities[{k}]"
            with renamed(lambda _, place=place: place):  # type: ignore[misc]
                low, high = found.support(float(v))
            name = f"{v:g} m/s"
            edges = np.linspace(low, high, 401)
            if not np.all(np.diff(edges) > 0):  # one value alone, which has no density
                axes.axvline(low, color=colors()[k], label=name)
                continue
            density = np.diff(found.cdf(edges, float(v))) / np.diff(edges)
        axes.stairs(
            np.where(density > 0, density, np.nan), edges, baseline=None, color=colors()[k], label=name
        )
    if exact is not None:
        low, high = exact.support()
        within = np.linspace(low, high, 1001)[1:-1]  # densities may diverge at the ends
        axes.plot(within, exact.pdf(within), color=ink(), linestyle="--", label="closed form")
    axes.set_yscale("log")
    axes.set_xlabel(RESTITUTION)
    axes.set_ylabel(r"$p(\varepsilon\,|\,v)$")
    figure.legend(title="impact velocity", ncols=2, loc="outside upper center")
    return figure


@styled
def scatter(found: xr.Dataset | Mapping[str, xr.Dataset], *, style: Style | None = None) -> Figure:
    """Draw the standard deviation of ε over the impact velocity, as the paper's Fig. 6.

    Parameters
    ----------
    found : xarray.Dataset or mapping of str to xarray.Dataset
        Statistics by velocity: one, several with their names, those of `restitution.compare`, whose lines
        are named by body and law, or a study of `restitution.sweep`, named by its parameters. Bins of fewer
        than 100 impacts are left out, and those that reach down to v = 0, where ε diverges.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> found = rs.compare(
    ...     {name: rs.Dumbbell(radius=3e-3, separation=L) for name, L in (("short", 3e-4), ("long", 3e-3))},
    ...     [rs.Frictionless(normal=0.98)], particles=100,
    ...     velocity_bins=np.linspace(0.0, 1.2, 31), restitution_bins=np.linspace(-1.0, 3.0, 401))
    >>> figure = rs.figures.scatter(found)
    """
    figure, axes = _over_velocity(found, "deviation", DEVIATION)
    axes.set_yscale("log")
    return figure


@styled
def fraction(found: xr.Dataset | Mapping[str, xr.Dataset], *, style: Style | None = None) -> Figure:
    """Draw the mean rotational share E_rot/E_tot before an impact over the impact velocity.

    Parameters
    ----------
    found : xarray.Dataset or mapping of str to xarray.Dataset
        As for `scatter`. Bands are ± one standard error where there are standard errors.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> found = rs.statistics(
    ...     rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98), particles=100,
    ...     velocity_bins=np.linspace(0.0, 1.2, 31), restitution_bins=np.linspace(0.5, 1.5, 101))
    >>> figure = rs.figures.fraction(found)
    """
    figure, axes = _over_velocity(found, "mean_fraction", f"mean {FRACTION}")
    axes.set_ylim(bottom=0.0)
    return figure


@styled
def moments(
    found: xr.Dataset | Mapping[str, xr.Dataset] | FluctuatingRestitution,
    *,
    exact: xr.Dataset | None = None,
    style: Style | None = None,
) -> Figure:
    """Draw mean, standard deviation, skewness and kurtosis of ε over the impact velocity.

    The kurtosis of a Gaussian is 3, that of a Laplace density 6.

    Parameters
    ----------
    found : xarray.Dataset, mapping of str to xarray.Dataset, or FluctuatingRestitution
        As for `scatter`, or a learned distribution. Bands are ± one standard error where there are standard
        errors.
    exact : xarray.Dataset, optional
        Mean and standard deviation of `restitution.analytic.near_round`, drawn as dashed lines.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Examples
    --------
    >>> import numpy as np
    >>> import restitution as rs
    >>> found = rs.statistics(
    ...     rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98), particles=100,
    ...     velocity_bins=np.linspace(0.0, 1.2, 61), restitution_bins=np.linspace(0.5, 1.5, 101))
    >>> figure = rs.figures.moments(found)
    >>> len(figure.axes)
    4
    """
    from restitution.distribution import FluctuatingRestitution

    figure, rows = panels(PAGE, 4.6, 2, 2, sharex=True)
    names = {
        "mean_restitution": "mean of $\\varepsilon$",
        "deviation": DEVIATION,
        "skewness": "skewness",
        "kurtosis": "kurtosis",
    }
    places = [axes for row in rows for axes in row]
    for axes, (name, label), mark in zip(places, names.items(), "abcd", strict=True):
        if isinstance(found, FluctuatingRestitution):
            _learned_moment(axes, found, name)
        else:
            _moments(axes, found, name)
        axes.set_ylabel(label)
        letter(axes, f"({mark})", left=False)
    if exact is not None:
        speeds, mean, deviation = variables(
            "exact",
            exact,
            "restitution.analytic.near_round",
            dict.fromkeys(("velocity", "mean_restitution", "std_restitution"), ("velocity",)),
        )
        for axes, values in zip(rows[0], (mean, deviation), strict=True):
            line(axes, speeds, values, color=ink(), linestyle="--", label="nearly round")
            axes.legend(loc="lower left")
    elif named := places[0].get_legend_handles_labels()[1]:
        figure.legend(places[0].lines, named, title=_varied(found), ncols=4, loc="outside upper center")
    for axes in rows[-1]:
        axes.set_xlabel(VELOCITY)
    return figure


@styled
def resting(found: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw how many particles rest on each face, and after how many impacts that is decided.

    Parameters
    ----------
    found : xarray.Dataset
        As from `restitution.resting`. A bar goes to the share that rests on a face for certain; the pale one
        above it adds all undecided particles. Error bars are ± one standard error.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Examples
    --------
    >>> import restitution as rs
    >>> brick = rs.Box(a=1e-2, b=2e-2, c=3e-2)
    >>> data = rs.simulate(brick, rs.Frictionless(normal=0.5), particles=50, impacts=200, record="state")
    >>> figure = rs.figures.resting(rs.resting(brick, data))
    """
    names = ("height", "least", "most", "least_error", "most_error")
    dimensions: dict[str, tuple[str, ...]] = {"decided_after": ("particle",)}
    dimensions |= dict.fromkeys(names, ("face",))
    after, *faces = variables("found", found, "restitution.resting", dimensions)
    for name, values in zip(names, faces, strict=True):
        check_drawable(f"found.{name}", values)
    height, least, most, *errors = faces
    figure, [[shares, decided]] = panels(PAGE, 2.7, columns=2, width_ratios=(3, 2))
    place = np.arange(height.size)
    look: dict[str, Any] = {
        "ecolor": ink(0.8),
        "capsize": points(2.0),
        "error_kw": {"elinewidth": points(0.8)},
    }
    shares.bar(
        place, most, 0.7, yerr=errors[1], color=colors()[0], alpha=0.35, label="and all undecided", **look
    )
    shares.bar(place, least, 0.7, yerr=errors[0], color=colors()[0], label="decided", **look)
    shares.xaxis.set_major_locator(MaxNLocator(10, integer=True))
    shares.tick_params(axis="x", which="minor", bottom=False, top=False)
    shares.set_xlabel("face, from the highest centre of mass to the lowest")
    shares.set_ylabel("share of the particles")
    shares.set_ylim(top=1.25 * float(most.max(initial=0.0)))
    shares.legend(loc="upper left")
    known = np.sort(after[after > 0])
    decided.step([0, *known], np.arange(known.size + 1) / after.size, where="post", color=colors()[1])
    decided.set_ylim(0.0, 1.0)
    decided.set_xlim(left=0.0)
    decided.set_xlabel("impacts")
    decided.set_ylabel("share decided")
    for axes, text in ((shares, "(a)"), (decided, "(b)")):
        letter(axes, text, left=False)
    return figure


@styled
def trajectory(
    data: xr.Dataset, particle: int = 0, impacts: int = 20, *, style: Style | None = None
) -> Figure:
    """Draw the height of the centre of mass of a particle over time, and what its impacts did.

    Heights are exact: parabolas that the recorded velocities put together.

    Parameters
    ----------
    data : xarray.Dataset
        As from `restitution.simulate`.
    particle : int
        Which one.
    impacts : int
        How many of its impacts.
    style : str, optional
        "paper", "page" or "slides", with "-dark" for a dark ground.

    Examples
    --------
    >>> import restitution as rs
    >>> data = rs.simulate(
    ...     rs.Dumbbell(radius=3e-3, separation=3e-4), rs.TangentialRestitution(normal=0.98), particles=1)
    >>> figure = rs.figures.trajectory(data, impacts=10)
    """
    names = ("time", "impact_velocity", "rebound_velocity", "restitution", "rotational_fraction")
    recorded = records("data", data, *names)
    check_filled("data", recorded[0])
    check_successive("data", data, start=0)
    gravity, incline = pull("data", data)
    heights = released_from("data", data)
    particle = whole("particle", particle, 0, data.sizes["particle"] - 1)
    impacts = whole("impacts", impacts, 1)
    happened = times_of(recorded[0][particle, :impacts]).size
    time, fall, rise, ratio, fraction = (values[particle, :happened] for values in recorded)
    for each, values in zip(names, (time, fall, rise, ratio, fraction), strict=True):
        check_drawable(f"data.{each}", values)
    start = float(heights if heights.ndim == 0 else heights[particle])
    with np.errstate(over="ignore", invalid="ignore"):
        when, height = _heights(time, fall, rise, gravity * float(np.cos(incline)), start)
    if not np.all(np.abs(height) <= FARTHEST):
        raise ParameterError(Problem("data", ": heights are no finite numbers; must be those of a run"))
    figure, [[path], [middle], [below]] = panels(*column(4.2), 3, 1, sharex=True, height_ratios=(4, 3, 3))
    path.plot(when, 1e3 * height)
    path.set_ylabel("height (mm)")
    path.set_ylim(bottom=0.0)
    middle.plot(time, ratio, linestyle="none", marker=MARKERS[0], color=colors()[0])
    middle.set_ylabel(r"$\varepsilon$")
    below.plot(time, fraction, linestyle="none", marker=MARKERS[1], color=colors()[1])
    below.set_ylabel(FRACTION)
    below.set_xlabel("time since release (s)")
    below.set_ylim(bottom=0.0)
    return figure


def _heights(
    time: FloatArray, fall: FloatArray, rise: FloatArray, gravity: float, start: float
) -> tuple[FloatArray, FloatArray]:
    """Return times and heights of the centre of mass, forty to a flight, to the end of the last one."""
    begin = np.concatenate([[0.0], time[:-1]])
    duration = time - begin
    upward = np.concatenate([gravity * duration[:1] - fall[:1], rise[:-1]])
    share = np.linspace(0.0, 1.0, 40)
    elapsed = duration[:, None] * share
    climbed = upward[:, None] * elapsed - 0.5 * gravity * elapsed**2
    base = start + np.concatenate([[0.0], np.cumsum(climbed[:, -1])[:-1]])
    return (begin[:, None] + elapsed).ravel(), (base[:, None] + climbed).ravel()


def _over_velocity(
    found: xr.Dataset | Mapping[str, xr.Dataset], name: str, label: str
) -> tuple[Figure, Axes]:
    """Draw one of the quantities by velocity of one or several sets of statistics."""
    figure, [[axes]] = panels(*column(2.7))
    _moments(axes, found, name, marked=True)
    low, high = axes.get_xlim()
    steps = (step * 10.0**power for power in range(-9, 9) for step in (1, 2, 5))
    plain_log(axes, [v for v in steps if low <= v <= high and v > 0] or [high])
    axes.set_xlabel(VELOCITY)
    axes.set_ylabel(label)
    if axes.get_legend_handles_labels()[1]:
        axes.legend(title=_varied(found))
    return figure, axes


def _moments(
    axes: Axes, found: xr.Dataset | Mapping[str, xr.Dataset], name: str, *, marked: bool = False
) -> None:
    """Draw a moment of one or several sets of statistics, with labels where there are several."""
    lines = _lines(found)
    for k, (each, one) in enumerate(lines.items()):
        again, color = divmod(k, len(COLORS))
        look: dict[str, Any] = {"color": colors()[color]}
        if marked:
            look["marker"] = MARKERS[again % len(MARKERS)]
        else:
            look["linestyle"] = ("-", "--", ":", "-.")[again % 4]
        _moment(axes, one, name, label=each if len(lines) > 1 else None, **look)


def _learned_moment(axes: Axes, found: FluctuatingRestitution, name: str) -> None:
    """Draw a moment of a learned distribution over the speeds of its nodes, not where it saw no impacts."""
    from restitution.distribution import in_gaps

    speeds = found.data["velocity"].to_numpy()
    known = ~in_gaps(found.data, speeds)
    method = {"mean_restitution": "mean", "deviation": "std"}.get(name, name)
    each = found.clamped()
    values = np.where(known, getattr(each, method)(speeds), np.nan)
    error = np.where(known, getattr(each, f"{method}_error")(speeds), np.nan) if found.has_errors else None
    line(axes, speeds, values, error)


def _moment(axes: Axes, found: xr.Dataset, name: str, **style: Any) -> None:
    """Draw a moment of the velocity bins that have enough impacts, and none at v = 0, where ε diverges."""
    moment, error = "variance" if name == "deviation" else name, f"{name}_error"
    errors = (error,) if isinstance(found, xr.Dataset) and error in found else ()
    found = counted("found", found, (moment, *errors, "number", "velocity_edges", "velocity"))
    enough = (found["number"].to_numpy() >= 100) & (found["velocity_edges"].to_numpy()[:-1] > 0)
    for each in (moment, *errors):
        check_drawable(f"found.{each}", found[each].to_numpy())
    shown = np.where(enough, found[moment].to_numpy(), np.nan)
    if name == "deviation":
        # A logarithmic axis has no room for zero.
        shown = np.sqrt(np.where(shown > 0, shown, np.nan))
    band = np.where(enough, found[error].to_numpy(), np.nan) if errors else None
    line(axes, found["velocity"].to_numpy(), shown, band, **style)


def _lines(found: xr.Dataset | Mapping[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """Name every set of statistics."""
    if isinstance(found, xr.DataArray) or not isinstance(found, Mapping) or not found:
        raise ParameterError(wrong("found", found, "a Dataset of restitution.statistics, or several"))
    if not isinstance(found, xr.Dataset):
        for name, one in found.items():
            if not isinstance(one, xr.Dataset):
                raise ParameterError(wrong(f"found[{name!r}]", one, "a Dataset of restitution.statistics"))
        return {str(name): one for name, one in found.items()}
    axes = [axis for axis in found["number"].dims if axis != "velocity"] if "number" in found else []
    number = int(np.prod([found.sizes[axis] for axis in axes]))
    if number > MOST:
        names = ", ".join(str(axis) for axis in axes)
        text = f" has {number} points in {names}: must be at most {MOST}; take some by sel"
        raise ParameterError(Problem("found", text))
    lines = {}
    for place in product(*(range(found.sizes[axis]) for axis in axes)):
        one = found.isel(dict(zip(axes, place, strict=True)))
        values = (one[axis].values for axis in axes if found.sizes[axis] > 1)
        told = [f"{x:g}" if x.dtype.kind in "fiu" else str(x) for x in values]
        lines[", ".join(told)] = one
    return lines


def _varied(found: object) -> str:
    """Name the parameters of a study, whose values name the lines, with their units."""
    if not isinstance(found, xr.Dataset):
        return ""
    axes = [found[axis] for axis in found["number"].dims if axis != "velocity" and found.sizes[axis] > 1]
    units = {axis.name: axis.attrs.get("units", "1") for axis in axes if axis.dtype.kind in "fiu"}
    return ", ".join(f"{name}" if unit == "1" else f"{name} ({unit})" for name, unit in units.items())


def _bin_density(found: xr.Dataset, name: str, v: float) -> tuple[Any, Any, str]:
    """Return edges and density of the velocity bin that holds v, and the bin in words."""
    found = counted("found", found, ("restitution_count", "velocity_edges", "restitution_edges", "number"))
    ends = found["velocity_edges"].to_numpy()
    row = int(np.searchsorted(ends, v, side="right")) - 1
    if not 0 <= row < ends.size - 1:
        raise ParameterError(wrong(name, v, f"in [{ends[0]:g}, {ends[-1]:g}) m/s, the velocity bins"))
    here = found.isel(velocity=row)
    edges = found["restitution_edges"].to_numpy()
    with np.errstate(invalid="ignore", divide="ignore"):
        density = here["restitution_count"].to_numpy() / (int(here["number"]) * np.diff(edges))
    return edges, density, f"{ends[row]:.3g} to {ends[row + 1]:.3g} m/s"
