"""The contents of a panel: populations of a lattice, histograms, lines with their standard error."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import QuadMesh
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullFormatter, StrMethodFormatter

from restitution._internal.arrays import FloatArray, IntArray, check_each, reals, whole
from restitution._internal.parameters import ParameterError, Problem, wrong
from restitution.drop.bins import increasing_edges
from restitution.figures.check import check_kind, column
from restitution.figures.style import colormap, styled


@styled
def population(
    axes: Axes,
    x_edges: FloatArray,
    y_edges: FloatArray,
    count: IntArray,
    *,
    largest: int | None = None,
) -> QuadMesh:
    """Colour each lattice site by its population over the largest, logarithmically; empty sites are blank.

    Parameters
    ----------
    axes : Axes
        Panel to draw in.
    x_edges, y_edges : ndarray, shapes (nx + 1,), (ny + 1,)
        Edges of the sites.
    count : ndarray of int, shape (nx, ny)
        Population of the sites.
    largest : int, optional
        Population that gets the colour of 1; the largest in `count` unless given.

    Returns
    -------
    QuadMesh
        For `population_bar`.

    Raises
    ------
    ValueError
        If every site is empty.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import figures
    >>> figure, [[axes]] = figures.panels(figures.COLUMN, 2.5)
    >>> edges = np.linspace(0.0, 1.0, 3)
    >>> mesh = figures.population(axes, edges, edges, np.array([[1, 0], [10, 100]]))
    >>> figures.population_bar(figure, mesh, axes)
    """
    check_kind("axes", axes, Axes)
    x_edges, y_edges = increasing_edges(x_edges, "x_edges"), increasing_edges(y_edges, "y_edges")
    sites = (x_edges.size - 1, y_edges.size - 1)
    allowed = f"whole numbers in [0, 2**53], of shape {sites}"
    numbers = reals("count", count, allowed, dimensions=(2,))
    if numbers.shape != sites:
        text = f": {sites[0]} and {sites[1]} bins, and count has shape {numbers.shape}"
        raise ParameterError(Problem("x_edges, y_edges, count", text))
    if not np.all((numbers >= 0) & (numbers <= 2**53) & (numbers == np.rint(numbers))):
        raise ParameterError(wrong("count", count, allowed))
    count = numbers.astype(np.int64)
    top = int(count.max()) if largest is None else whole("largest", largest, 1, 2**53)
    if not count.any():
        raise ValueError(f"count: all {count.size} sites are empty, there is nothing to draw")
    share = np.ma.masked_equal(count.T, 0) / top
    # A scale needs two ends even if no site holds more than one.
    norm = LogNorm(1 / max(top, 10), 1)
    mesh = axes.pcolormesh(x_edges, y_edges, share, norm=norm, cmap=colormap(), rasterized=True)
    axes.set_xlim(x_edges[0], x_edges[-1])
    axes.set_ylim(y_edges[0], y_edges[-1])
    return mesh


@styled
def population_bar(figure: Figure, mesh: QuadMesh, axes: Axes) -> None:
    """Add the colour bar of a `population`.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import figures
    >>> figure, [[axes]] = figures.panels(figures.COLUMN, 2.5)
    >>> edges = np.linspace(0.0, 1.0, 3)
    >>> mesh = figures.population(axes, edges, edges, np.array([[1, 0], [10, 100]]))
    >>> figures.population_bar(figure, mesh, axes)
    >>> figure.axes[1].get_ylabel()
    'population / largest population'
    """
    check_kind("figure", figure, Figure)
    check_kind("axes", axes, Axes)
    if not isinstance(mesh, ScalarMappable) or mesh.get_array() is None:
        raise ParameterError(wrong("mesh", mesh, "what `population` returns"))
    figure.colorbar(mesh, ax=axes, pad=0.02, aspect=30).set_label("population / largest population")


@styled
def histogram(axes: Axes, edges: FloatArray, density: FloatArray, error: FloatArray, **style: Any) -> None:
    """Draw a probability density as points at the bin centres, with bars of ± one standard error.

    Empty bins are left out, as on a logarithmic axis they must be.

    Parameters
    ----------
    axes : Axes
        Panel to draw in.
    edges : ndarray, shape (n + 1,)
        Edges of the bins.
    density, error : ndarray, shape (n,)
        Density in the bins and its standard error.
    **style
        As in `matplotlib.axes.Axes.errorbar`.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import figures
    >>> epsilon = np.random.default_rng(1).laplace(0.98, 0.03, 1000)
    >>> count, edges = np.histogram(epsilon, bins=40)
    >>> scale = 1 / (count.sum() * np.diff(edges))
    >>> figure, [[axes]] = figures.panels(figures.COLUMN, 2.5)
    >>> figures.histogram(axes, edges, scale * count, scale * np.sqrt(count), label="drawn")
    """
    check_kind("axes", axes, Axes)
    density = column("density", density)
    edges = column("edges", edges, density.size + 1, "density")
    error = column("error", error, density.size, "density")
    filled = density > 0
    centres = 0.5 * (edges[:-1] + edges[1:])
    # A bar down to zero, as that of a single count, would run off a logarithmic axis.
    below = np.where(error < density, error, 0.0)
    points: dict[str, Any] = {"linestyle": "none", "capsize": 0.0, "elinewidth": 0.5} | style
    bars = np.stack([below, error])[:, filled]
    axes.errorbar(centres[filled], density[filled], yerr=bars, **points)


@styled
def line(axes: Axes, x: FloatArray, y: FloatArray, error: FloatArray | None = None, **style: Any) -> None:
    """Draw y(x), with a band of ± one standard error where `error` is given; NaN leaves a gap.

    Examples
    --------
    >>> import numpy as np
    >>> from restitution import figures
    >>> v = np.linspace(0.1, 1.0, 10)
    >>> figure, [[axes]] = figures.panels(figures.COLUMN, 2.5)
    >>> figures.line(axes, v, 0.98 - 0.02 * v, np.full(10, 0.005), label="measured")
    """
    x = column("x", x)
    y = column("y", y, x.size, "x")
    check_kind("axes", axes, Axes)
    (drawn,) = axes.plot(x, y, **style)
    if error is not None:
        error = column("error", error, x.size, "x")
        with np.errstate(invalid="ignore"):  # ∞ - ∞ leaves a gap, too
            lower, upper = y - error, y + error
        axes.fill_between(x, lower, upper, color=drawn.get_color(), alpha=0.3, linewidth=0)


def plain_log(axes: Axes, ticks: Sequence[float]) -> None:
    """Make the x axis logarithmic with plain numbers at these ticks.

    Examples
    --------
    >>> from restitution import figures
    >>> figure, [[axes]] = figures.panels(figures.COLUMN, 2.5)
    >>> figures.plain_log(axes, [0.1, 0.2, 0.5, 1])
    >>> axes.get_xscale()
    'log'
    """
    places = column("ticks", ticks)
    check_each("ticks", places, (places > 0) & np.isfinite(places), "finite and > 0")
    check_kind("axes", axes, Axes)
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(FixedLocator(places.tolist()))
    axes.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())
