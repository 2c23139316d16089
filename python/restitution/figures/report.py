"""Reports as one page of HTML that needs nothing else; only `text` and `prose` let foreign text in."""

import re
import tempfile
from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

import xarray as xr
from matplotlib.figure import Figure

from restitution._internal.datasets import put
from restitution.figures.style import save, styled

_SCALE = 0.6
"""Pixels of the page for each of a figure."""
_SUBSCRIPT = re.compile(r"(?<=[A-Za-zΑ-ω\]])_([A-Za-zΑ-ω]{1,5})(?![A-Za-z_])")
_MINUS = re.compile(r"(?<![\w)\-])-(?=[\d.])")
_SUPERSCRIPT = re.compile(r"\^([A-Za-z0-9]|\([^()]*\))")
_DOI = re.compile(r"\bDOI (10\.\d{4,9}/[\w./-]*\w)")
_THOUSANDS = re.compile(r"(?<=\d) (?=\d{3}(?!\d))")
_BEFORE_UNIT = re.compile(r"(?<=\d) (?=(?:%|°|m/s²?|mm|µm|m|kg|rad|ms|µs|s|standard errors)(?![\w/]))")
_AROUND_SIGN = re.compile(r" ?([±=<>≤≥≈×]|&lt;|&gt;) (?=[\d.(−-])")
_AFTER_NAME = re.compile(r"\b(Figs?\.|Eqs?\.|Secs?\.) (?=\(?[A-Z\d])")
_OPEN_MINUS = re.compile(r"(?<=[\[(])−(?=[(|])")


class Section(NamedTuple):
    """A section of a page: the anchor that links point to, its title, and its pieces of HTML."""

    anchor: str
    title: str
    pieces: Sequence[str]


def page(title: str, header: str, sections: Sequence[Section], footer: str, *, contents: bool = False) -> str:
    """Make the whole page, with a table of contents where it is asked for; `header` is HTML already."""
    body = "\n".join(map(_section, sections))
    for one in sections:  # what a text names in quotation marks is a link to it
        named = rf"(?:Eqs?\.[^“”<>]{{,20}} of )?“{re.escape(text(one.title))}”"
        body = re.sub(named, rf'<a href="#{one.anchor}">\g<0></a>', body)
    entries = "\n".join(f'<li><a href="#{one.anchor}">{text(one.title)}</a></li>' for one in sections)
    listed = f'<nav aria-label="Contents">\n<ol>\n{entries}\n</ol>\n</nav>\n' if contents else ""
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{text(title)}</title>
<style>
{files("restitution.figures").joinpath("report.css").read_text(encoding="utf-8")}</style>
</head>
<body>
<header id="top">
{header}
</header>
{listed}<main>
{body}
</main>
<footer>
<p>{text(footer)}</p>
</footer>
</body>
</html>
"""


def _section(one: Section) -> str:
    top = '<p class="top"><a href="#top">Back to the top</a></p>'
    head = f'<section id="{one.anchor}">\n<h2>{text(one.title)}</h2>'
    return "\n".join((head, *one.pieces, top, "</section>"))


def text(value: object) -> str:
    """Escape plain text."""
    return escape(str(value), quote=True)


def prose(value: str) -> str:
    """Escape text with formulas: ``x_y`` is lowered, ``x^y`` raised, ``-1`` gets a true minus sign.

    Lines do not break within a number, before its unit or after a sign, and a DOI becomes a link.
    """
    whole = _together(_MINUS.sub("−", text(value)))
    lowered = _SUBSCRIPT.sub(r"<sub>\1</sub>", whole)
    raised = _SUPERSCRIPT.sub(lambda match: f"<sup>{match[1].strip('()')}</sup>", lowered)
    return _DOI.sub(r'<a href="https://doi.org/\1">doi:\1</a>', raised)


def _together(value: str) -> str:
    """Join by no-break spaces what a line break would tear apart."""
    value = _BEFORE_UNIT.sub("\u00a0", _THOUSANDS.sub("\u202f", value))
    value = _AROUND_SIGN.sub(
        lambda match: ("\u00a0" if match[0][0] == " " else "") + match[1] + "\u00a0", value
    )
    value = value.replace(" − ", "\u00a0−\u00a0")
    return _OPEN_MINUS.sub("−\u2060", _AFTER_NAME.sub("\\1\u00a0", value))


def paragraph(value: str, style: str = "") -> str:
    """Make a paragraph of `prose`."""
    mark = f' class="{style}"' if style else ""
    return f"<p{mark}>{prose(value)}</p>"


def table(
    headers: Sequence[str], rows: Iterable[Sequence[str]], *, caption: str, numbers: Sequence[int] = ()
) -> str:
    """Make a table of cells that are HTML already; on a phone it is folded, with the caption to open it.

    The first cell of each row is its header; the columns in `numbers` are set flush right.
    """

    def cells(row: Sequence[str], head: bool) -> str:
        tags = ("th scope='col'" if head else "th scope='row'" if k == 0 else "td" for k in range(len(row)))
        styles = (" class='n'" if k in numbers else "" for k in range(len(row)))
        parts = (f"<{t}{c}>{v}</{t[:2]}>" for t, c, v in zip(tags, styles, row, strict=True))
        return f"<tr>{''.join(parts)}</tr>"

    about = prose(caption)
    head = f"<thead>{cells(headers, True)}</thead>" if any(headers) else ""
    body = "\n".join(cells(row, False) for row in rows)
    return (
        f'<details class="fold"><summary>{about}</summary>\n<div class="scroll"><table>'
        f"<caption>{about}</caption>{head}<tbody>\n{body}\n</tbody></table></div></details>"
    )


def image(path: Path, alternative: str) -> str:
    """Embed a PNG file, small enough to be sharp on screen and paper, and at most as wide as the page."""
    content = path.read_bytes()
    if content[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"figure {str(path)!r}: not a PNG file")
    width, height = (round(_SCALE * int.from_bytes(content[k : k + 4], "big")) for k in (16, 20))
    data = b64encode(content).decode("ascii")
    size = f'width="{width}" height="{height}"'
    return f'<img src="data:image/png;base64,{data}" {size} alt="{text(alternative)}">'


@styled
def drawing(figure: Figure, caption: str) -> str:
    """Embed a Matplotlib figure with its caption, which is also read to those who cannot see it."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "figure.png")
        figure.savefig(path, dpi=200)
        return f"<figure>{image(path, caption)}<figcaption>{text(caption)}</figcaption></figure>"


def save_with_data(figure: Figure, data: xr.Dataset, path: Path, title: str, caption: str) -> Path:
    """Save a figure as PNG and PDF, its caption as text and its data as netCDF; give the PNG.

    All have the name that `path` ends with.
    """
    png, _ = save(figure, path, title, caption)
    png.with_suffix(".txt").write_text(caption + "\n", encoding="utf-8")
    about = data.assign_attrs(title=title, caption=caption)
    for variable in about.variables.values():
        if variable.ndim > 0 and variable.dtype.kind in "fiu":
            variable.encoding["zlib"] = True
    put(about, png.with_suffix(".nc"))
    return png


def grouped(number: int) -> str:
    """Write a whole number with spaces between its thousands, which `prose` makes thin."""
    return f"{number:,}".replace(",", " ")
