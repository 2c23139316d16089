"""The few pieces of HTML that the report is made of; only `text` and `prose` let foreign text in."""

import re
from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from pathlib import Path

from restitution.paper._claims import Verdict

_SCALE = 0.6
"""Pixels of the page for each of a figure."""
_CLASSES: dict[Verdict, str] = {"holds": "holds", "holds in part": "part", "fails": "fails"}
_SUBSCRIPT = re.compile(r"(?<=[A-Za-zΑ-ω\]])_([A-Za-zΑ-ω]{1,5})(?![A-Za-z_])")
_MINUS = re.compile(r"(?<![\w)\-])-(?=[\d.])")
_SUPERSCRIPT = re.compile(r"\^([A-Za-z0-9]|\([^()]*\))")


def text(value: object) -> str:
    """Escape plain text."""
    return escape(str(value), quote=True)


def prose(value: str) -> str:
    """Escape text with formulas: ``x_y`` is lowered, ``x^y`` raised, ``-1`` gets a true minus sign."""
    lowered = _SUBSCRIPT.sub(r"<sub>\1</sub>", _MINUS.sub("−", text(value)))
    return _SUPERSCRIPT.sub(lambda match: f"<sup>{match[1].strip('()')}</sup>", lowered)


def badge(verdict: Verdict) -> str:
    """Name a verdict, in its colour."""
    return f'<span class="badge {_CLASSES[verdict]}">{text(verdict)}</span>'


def mark(kind: str, serious: bool) -> str:
    """Name a kind of misprint, in the colour of its weight."""
    return f'<span class="badge {"fails" if serious else "part"}">{text(kind)}</span>'


def count(verdict: Verdict, number: int) -> str:
    """Say how many claims have this verdict, as a list item."""
    return f'<li class="{_CLASSES[verdict]}"><b>{number}</b>{text(verdict)}</li>'


def section(anchor: str, title: str, *body: str) -> str:
    """Make a section that the table of contents can point to."""
    return f'<section id="{anchor}">\n<h2>{text(title)}</h2>\n' + "\n".join(body) + "\n</section>"


def paragraph(value: str, style: str = "") -> str:
    """Make a paragraph of `prose`."""
    return f"<p{_class(style)}>{prose(value)}</p>"


def table(
    headers: Sequence[str], rows: Iterable[Sequence[str]], *, caption: str = "", numbers: Sequence[int] = ()
) -> str:
    """Make a table of cells that are HTML already.

    Parameters
    ----------
    headers : sequence of str
        One cell for each column.
    rows : iterable of sequence of str
        The first cell of each row is its header.
    caption : str
        Text above the table, if any.
    numbers : sequence of int
        Columns that are set flush right.
    """

    def cells(row: Sequence[str], head: bool) -> str:
        tags = ("th scope='col'" if head else "th scope='row'" if k == 0 else "td" for k in range(len(row)))
        styles = (" class='n'" if k in numbers else "" for k in range(len(row)))
        parts = (f"<{t}{c}>{v}</{t[:2]}>" for t, c, v in zip(tags, styles, row, strict=True))
        return f"<tr>{''.join(parts)}</tr>"

    above = f"<caption>{prose(caption)}</caption>" if caption else ""
    head = f"<thead>{cells(headers, True)}</thead>" if any(headers) else ""
    body = "\n".join(cells(row, False) for row in rows)
    return f'<div class="scroll"><table>{above}{head}<tbody>\n{body}\n</tbody></table></div>'


def image(path: Path, alternative: str) -> str:
    """Embed a PNG file, small enough to be sharp on screen and paper, and at most as wide as the page."""
    content = path.read_bytes()
    if content[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"figure {str(path)!r}: not a PNG file")
    width, height = (round(_SCALE * int.from_bytes(content[k : k + 4], "big")) for k in (16, 20))
    data = b64encode(content).decode("ascii")
    size = f'width="{width}" height="{height}"'
    return f'<img src="data:image/png;base64,{data}" {size} alt="{text(alternative)}">'


def _class(style: str) -> str:
    return f' class="{style}"' if style else ""
