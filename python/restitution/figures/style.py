"""The style of every figure, for journals, pages and slides: sizes, fonts, colours, and how one is made."""

import io
from collections.abc import Callable
from contextvars import ContextVar
from dataclasses import dataclass, replace
from functools import wraps
from pathlib import Path
from typing import Any, Literal, ParamSpec, TypeAlias, TypeVar

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Colormap, LinearSegmentedColormap
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
ON_DARK = ("#4FA8E8", "#FF8A4F", "#21C08F", "#E5A3C9", "#A9DCF7", "#FFFFFF")
"""The same hues for a dark ground, lighter."""
MARKERS = ("o", "s", "^", "D", "v", "x")
"""A marker for each line colour, so that lines do not differ by colour alone."""
COLORMAP = "viridis"
"""Perceptually uniform map for populations."""
_COLORMAP_ON_DARK = LinearSegmentedColormap.from_list(
    "viridis on dark", mpl.colormaps[COLORMAP](np.linspace(0.25, 1.0, 256))
)

VELOCITY = r"impact velocity $v_G^n$ (m/s)"
RESTITUTION = r"coefficient of restitution $\varepsilon$"
FRACTION = r"$E_\mathrm{rot}/E_\mathrm{tot}$"
DEVIATION = r"standard deviation $\sigma(\varepsilon)$"
"""Labels of axes."""

Style: TypeAlias = Literal["paper", "page", "slides", "paper-dark", "page-dark", "slides-dark"]
"""Purposes of a figure: a journal, a page on a screen, or slides; the last three on a dark ground."""
SITE: tuple[Style, ...] = ("page", "page-dark")
"""Styles of a figure of the site: that for the dark stands beside the other as ``NAME-dark.png``."""


@dataclass(frozen=True)
class _Look:
    """Size of the figures of a style over that of a journal's, their letters, lines and colours."""

    scale: float
    font: float  # points
    line: float  # width over that in a journal
    family: str
    mathematics: str
    wide: bool = False  # is a column as wide as the page?
    dark: bool = False

    @property
    def colors(self) -> tuple[str, ...]:
        return ON_DARK if self.dark else COLORS

    @property
    def settings(self) -> dict[Any, Any]:
        """All that Matplotlib is told."""
        ink, ground = ("#E8E8E8", "#14181E") if self.dark else ("#000000", "#FFFFFF")
        small = self.font - 1.0
        return {
            # The labels are written for mathtext, which needs no LaTeX.
            "text.usetex": False,
            "font.family": self.family,
            "mathtext.fontset": self.mathematics,
            "font.size": self.font,
            "axes.labelsize": self.font,
            "axes.titlesize": self.font,
            "xtick.labelsize": small,
            "ytick.labelsize": small,
            "legend.fontsize": small,
            "legend.title_fontsize": small,
            "legend.frameon": False,
            "legend.handlelength": 1.6,
            "savefig.dpi": 300,
            "axes.linewidth": 0.6 * self.line,
            "lines.linewidth": 1.0 * self.line,
            "patch.linewidth": 1.0 * self.line,
            "lines.markersize": 3.0 * self.line,
            "xtick.direction": "in",
            "ytick.direction": "in",
            "xtick.top": True,
            "ytick.right": True,
            "xtick.minor.visible": True,
            "ytick.minor.visible": True,
            **{f"{axis}tick.major.{what}": x * self.line for axis in "xy" for what, x in _MAJOR.items()},
            **{f"{axis}tick.minor.{what}": x * self.line for axis in "xy" for what, x in _MINOR.items()},
            "axes.prop_cycle": cycler(color=self.colors),
            # The ground is opaque, so that a figure is legible on a light page and on a dark one.
            **dict.fromkeys(("figure.facecolor", "axes.facecolor"), ground),
            **dict.fromkeys(
                ("text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color"), ink
            ),
            # Text stays text in the PDF, with the glyphs embedded as TrueType, as journals ask.
            "pdf.fonttype": 42,
        }


_MAJOR = {"width": 0.6, "size": 3.5}
_MINOR = {"width": 0.4, "size": 2.0}
_LIGHT = {
    "paper": _Look(1.0, 9.0, 1.0, "STIXGeneral", "stix"),
    "page": _Look(1.25, 10.5, 1.25, "DejaVu Sans", "dejavusans", wide=True),
    "slides": _Look(1.8, 18.0, 2.2, "DejaVu Sans", "dejavusans"),
}
_LOOKS = _LIGHT | {f"{name}-dark": replace(look, dark=True) for name, look in _LIGHT.items()}
_current: ContextVar[_Look] = ContextVar("style", default=_LIGHT["paper"])


def colors() -> tuple[str, ...]:
    """Return the line colours of the style that is being drawn in."""
    return _current.get().colors


def colormap() -> Colormap:
    """Return the map for populations in this style: none of it is as dark as the ground."""
    return _COLORMAP_ON_DARK if _current.get().dark else mpl.colormaps[COLORMAP]


def ink(strength: float = 1.0) -> str:
    """Return the colour of letters in the style that is being drawn in, or a grey of this strength."""
    grey = 0.91 * strength + 0.09 * (1.0 - strength) if _current.get().dark else 1.0 - strength
    return f"{grey:.3f}"


def points(width: float) -> float:
    """Return how wide a line is in the style that is being drawn in, which in a journal has this width."""
    return _current.get().line * width


_SCREEN = 100
"""Pixels of an inch on a screen; a notebook is given twice as many, for fine screens."""


class _Displayed(Figure):
    """A figure that a notebook shows, whether pyplot is loaded or not, and that stays in its style."""

    settings: dict[Any, Any]

    def __repr__(self) -> str:
        return super().__repr__().replace(type(self).__name__, "Figure")

    def savefig(self, *args: Any, **kwargs: Any) -> None:
        """Save in the style in which it was made: some ticks are made only now."""
        with mpl.rc_context(self.settings):
            super().savefig(*args, **kwargs)

    def _repr_png_(self) -> tuple[bytes, dict[str, int]]:
        content = io.BytesIO()
        self.savefig(content, format="png", dpi=2 * _SCREEN)
        width, height = (round(_SCREEN * inches) for inches in self.get_size_inches())
        return content.getvalue(), {"width": width, "height": height}


P = ParamSpec("P")
T = TypeVar("T")


def styled(function: Callable[P, T]) -> Callable[P, T]:
    """Let `function` draw in a style of the package; the caller's Matplotlib settings stay as they are.

    Where it is called with ``style="page"``, "slides", or one of these or "paper" with "-dark" behind it, it
    draws in that one, and so does all that it calls; else in that of its caller, or for a journal.

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
        name = kwargs.get("style")
        look = _current.get() if name is None else _named(name)
        before = _current.set(look)
        try:
            with mpl.rc_context(look.settings):
                return function(*args, **kwargs)
        finally:
            _current.reset(before)

    return wrapper


def _named(name: object) -> _Look:
    if not isinstance(name, str) or name not in _LOOKS:
        raise ParameterError(wrong("style", name, f"one of {', '.join(map(repr, _LOOKS))}"))
    return _LOOKS[name]


def column(height: float) -> tuple[float, float]:
    """Return the size of a figure that fills a column: that of a journal, or the only one of a page."""
    return (PAGE, 1.25 * height) if _current.get().wide else (COLUMN, height)


@styled
def panels(
    width: float, height: float, rows: int = 1, columns: int = 1, **shared: Any
) -> tuple[Figure, list[list[Axes]]]:
    """Make a figure of some panels, without any global state.

    Parameters
    ----------
    width, height : float
        Size in inches in a journal, `COLUMN` or `PAGE` wide; on pages and slides figures are larger.
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
    look = _current.get()
    figure = _Displayed(figsize=(look.scale * width, look.scale * height), layout="constrained")
    figure.settings = look.settings
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
