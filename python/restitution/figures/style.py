"""One journal style for every figure: sizes, fonts, colours, and how a figure is made and saved."""

import io
from collections.abc import Callable
from functools import wraps
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

import matplotlib as mpl
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from restitution._internal.arrays import flag, real, whole
from restitution._internal.files import IMAGE, path_for, whole_file
from restitution._internal.parameters import ParameterError, wrong
from restitution.figures.check import check_kind

COLUMN = 3.4
"""Width of one column in a Physical Review journal, in inches."""
PAGE = 7.0
"""Width of both columns, in inches."""

COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#000000")
"""Line colours of Okabe and Ito, distinguishable with every kind of colour vision."""
MARKERS = ("o", "s", "^", "D", "v", "x")
"""A marker for each line colour, so that lines do not differ by colour alone."""
COLORMAP = "viridis"
"""Perceptually uniform map for populations."""

_STYLE: dict[Any, Any] = {
    # The labels are written for mathtext, which needs no LaTeX.
    "text.usetex": False,
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

_SCREEN = 100
"""Pixels of an inch on a screen; a notebook is given twice as many, for fine screens."""


class _Displayed(Figure):
    """A figure that a notebook shows, whether pyplot is loaded or not."""

    def __repr__(self) -> str:
        return super().__repr__().replace(type(self).__name__, "Figure")

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        content = io.BytesIO()
        with mpl.rc_context(_STYLE):
            self.savefig(content, format="png", dpi=2 * _SCREEN)
        width, height = (round(_SCREEN * inches) for inches in self.get_size_inches())
        return content.getvalue(), {"width": width, "height": height}


P = ParamSpec("P")
T = TypeVar("T")


def styled(function: Callable[P, T]) -> Callable[P, T]:
    """Let `function` run under the journal style; the caller's Matplotlib settings stay as they are.

    Examples
    --------
    >>> import matplotlib as mpl
    >>> from restitution import figures
    >>> @figures.styled
    ... def family():
    ...     return mpl.rcParams["font.family"]
    >>> family()
    ['STIXGeneral']
    """
    if not callable(function):
        raise ParameterError(wrong("function", function, "a function that draws"))

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

    Examples
    --------
    >>> from restitution import figures
    >>> figure, [[left, right]] = figures.panels(figures.PAGE, 2.5, columns=2, sharey=True)
    """
    size = "a size in inches, in [0.1, 100]"
    width, height = (
        real(name, value, size, lambda x: 0.1 <= x <= 100.0)
        for name, value in (("width", width), ("height", height))
    )
    rows, columns = whole("rows", rows, 1, 100), whole("columns", columns, 1, 100)
    figure = _Displayed(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    axes: list[list[Axes]] = figure.subplots(rows, columns, squeeze=False, **shared).tolist()
    return figure, axes


def letter(axes: Axes, text: str, *, left: bool = True) -> None:
    """Write the panel's letter, e.g. "(a)", into its upper corner.

    Examples
    --------
    >>> from restitution import figures
    >>> figure, [[left, right]] = figures.panels(figures.PAGE, 2.5, columns=2)
    >>> figures.letter(left, "(a)")
    >>> figures.letter(right, "(b)", left=False)
    """
    x, side = (0.03, "left") if flag("left", left) else (0.97, "right")
    check_kind("axes", axes, Axes)
    check_kind("text", text, str)
    axes.text(x, 0.96, text, transform=axes.transAxes, ha=side, va="top")


@styled
def save(figure: Figure, name: str | Path, title: str = "", caption: str = "") -> tuple[Path, ...]:
    """Save a figure for print and screen, with title and caption in the files' metadata.

    No date is written: the same figure gives the same bytes. The arrangement of the panels is made once, for
    all files, and stays.

    Parameters
    ----------
    figure : Figure
        What is saved.
    name : str or Path
        Ending in .png, .pdf or .svg: that one file. Else both ``name.png`` (300 dpi) and ``name.pdf``. Files
        of these names are replaced, each whole or not at all.
    title, caption : str, optional
        Go into the metadata.

    Returns
    -------
    tuple of Path
        The files that were written.

    Examples
    --------
    >>> import tempfile
    >>> from restitution import figures
    >>> figure, [[axes]] = figures.panels(figures.COLUMN, 2.5)
    >>> [path.name for path in figures.save(figure, tempfile.mkdtemp() + "/empty", title="Nothing")]
    ['empty.png', 'empty.pdf']
    """
    path = path_for("name", name, IMAGE)
    check_kind("figure", figure, Figure)
    check_kind("title", title, str)
    check_kind("caption", caption, str)
    single = path.suffix.lower() in _METADATA
    paths = (path,) if single else tuple(path.with_name(path.name + suffix) for suffix in (".png", ".pdf"))
    for one in paths:
        suffix = one.suffix.lower()
        about, dated = _METADATA[suffix]
        metadata = {"Title": title, about: caption} | dated
        dpi = 300 if suffix == ".png" else 600
        with whole_file(one, replace=True) as draft:
            figure.savefig(draft, format=suffix[1:], dpi=dpi, metadata=metadata)
        figure.set_layout_engine("none")
    return paths


_METADATA: dict[str, tuple[str, dict[str, Any]]] = {
    ".png": ("Description", {}),
    ".pdf": ("Subject", {"CreationDate": None}),
    ".svg": ("Description", {"Date": None}),
}
"""By ending: where the caption goes, and what would be a date."""
