"""One journal style for every figure: sizes, fonts, colours, and how a figure is made and saved."""

from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

COLUMN = 3.4
"""Width of one column in a Physical Review journal, in inches."""
PAGE = 7.0
"""Width of both columns, in inches."""

COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#000000")
"""Line colours of Okabe and Ito, told apart with every kind of colour vision."""
MARKERS = ("o", "s", "^", "D", "v", "x")
"""A marker for each line colour, so that nothing is told by colour alone."""
COLORMAP = "viridis"
"""Perceptually uniform map for populations."""

_STYLE: dict[Any, Any] = {
    "font.family": "STIXGeneral",
    "mathtext.fontset": "stix",
    "font.size": 9.0,
    "axes.labelsize": 9.0,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.fontsize": 8.0,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "axes.linewidth": 0.6,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.0,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.top": True,
    "ytick.right": True,
    "xtick.minor.visible": True,
    "ytick.minor.visible": True,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "axes.prop_cycle": cycler(color=COLORS),
    # Text stays text in the PDF, with the glyphs embedded as TrueType, as journals ask.
    "pdf.fonttype": 42,
}

P = ParamSpec("P")
T = TypeVar("T")


def styled(function: Callable[P, T]) -> Callable[P, T]:
    """Let `function` run under the journal style; the caller's Matplotlib settings stay as they are."""

    @wraps(function)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> T:
        with mpl.rc_context(_STYLE):
            return function(*args, **kwargs)

    return wrapper


@styled
def panels(
    width: float, height: float, rows: int = 1, columns: int = 1, **shared: Any
) -> tuple[Figure, list[list[Axes]]]:
    """Make a figure without any global state.

    Parameters
    ----------
    width, height : float
        Size in inches, `COLUMN` or `PAGE` wide.
    rows, columns : int
        Number of panels.
    **shared
        As in `matplotlib.figure.Figure.subplots`, e.g. ``sharex=True``.

    Returns
    -------
    tuple of Figure and list of rows of Axes
    """
    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    axes: list[list[Axes]] = figure.subplots(rows, columns, squeeze=False, **shared).tolist()
    return figure, axes


def letter(axes: Axes, text: str, *, left: bool = True) -> None:
    """Write the panel's letter, e.g. "(a)", into its upper corner."""
    x, side = (0.03, "left") if left else (0.97, "right")
    axes.text(x, 0.96, text, transform=axes.transAxes, ha=side, va="top")


@styled
def save(figure: Figure, stem: Path, title: str, caption: str) -> tuple[Path, Path]:
    """Save a figure as ``stem.png`` (300 dpi) and ``stem.pdf``, the caption in their metadata.

    No date is written: the same figure gives the same bytes. The arrangement of the panels is made once,
    for both, and stays.

    Returns
    -------
    tuple of Path
        The PNG and the PDF.
    """
    png, pdf = stem.with_name(stem.name + ".png"), stem.with_name(stem.name + ".pdf")
    figure.savefig(png, dpi=300, metadata={"Title": title, "Description": caption})
    figure.set_layout_engine("none")
    figure.savefig(pdf, dpi=600, metadata={"Title": title, "Subject": caption, "CreationDate": None})
    return png, pdf
