"""Text of objects and numbers: in `help`, printed, in a notebook, and with their errors."""

import inspect
import re
from collections.abc import Iterable
from html import escape
from math import floor, isfinite, isnan, log10
from typing import get_type_hints

from pydantic import BaseModel

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


class Text(str):
    """A text that a notebook and the interpreter show as it reads, without quotes."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


def signature(cls: type[BaseModel], by_place: tuple[str, ...]) -> inspect.Signature:
    """Return the fields of a class as its arguments, optional ones last, by keyword but for `by_place`."""
    keyword, positional = inspect.Parameter.KEYWORD_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD
    parameters, hints = [], get_type_hints(cls)
    for name, field in cls.model_fields.items():
        kind = hints[name]
        text = kind.__name__ if isinstance(kind, type) else re.sub(r"\w+\.", "", str(kind))
        text = re.sub(r"^Optional\[(.*)\]$", r"\1 | None", text)
        default = inspect.Parameter.empty if field.is_required() else field.default
        place = positional if name in by_place else keyword
        parameters.append(inspect.Parameter(name, place, default=default, annotation=Text(text)))
    empty = inspect.Parameter.empty
    return inspect.Signature(sorted(parameters, key=lambda one: (one.kind, one.default is not empty)))


def entries(doc: str) -> dict[str, str]:
    """Return the parameters that a docstring describes, by name, without the indentation of all of them."""
    found = re.findall(r"^((\w+) : .*(?:\n    .*)*)", inspect.cleandoc(doc), re.MULTILINE)
    return {name: text for text, name in found}


def table(title: str, rows: Iterable[tuple[str, object]]) -> str:
    """Write an HTML table of names and values, for `_repr_html_`."""
    lines = "".join(
        f'<tr><th style="text-align:left;font-weight:normal">{escape(name)}</th>'
        f'<td style="text-align:right">{escape(str(value))}</td></tr>'
        for name, value in rows
    )
    caption = f'<caption style="text-align:left;font-weight:bold">{escape(title)}</caption>'
    return f"<table>{caption}<tbody>{lines}</tbody></table>"


def short(value: object) -> str:
    """Write a parameter as `repr` does, with the middle of a long table left out."""
    if isinstance(value, tuple) and isinstance(value[0], tuple) and len(repr(value)) > 72:
        return f"({repr(value[0])[:72]}, ... {len(value)} of them)"
    if isinstance(value, tuple) and len(value) > 8:
        return f"({', '.join(map(repr, value[:3]))}, ..., {value[-1]!r})"
    return str(value) if isinstance(value, BaseModel) else repr(value)


def value(number: object, unit: str | None = None) -> str:
    """Write a number, or a pair, in six digits with its unit."""
    parts = number if isinstance(number, tuple) else (number,)
    text = ", ".join(f"{part:.6g}" if isinstance(part, float | int) else str(part) for part in parts[:8])
    text = f"{text}, … ({len(parts)} numbers)" if len(parts) > 8 else text
    return f"{text} {unit}" if unit else text


def digits(number: float) -> str:
    """Write a number in two digits, and without a power of ten: 290, 2.9 or 0.029."""
    return f"{float(f'{number:.2g}'):g}"


def with_error(value: float, error: float | None) -> str:
    """Write `value` ± `error` to two digits of the error, or without error to four digits.

    An error of 0, as of a share of which no example was met, is left out.
    """
    if not isfinite(value):
        return "no data" if isnan(value) else str(value)
    if error is None or not isfinite(error) or error <= 0:
        whole = value == round(value) and abs(value) < 1e9
        return f"{value:,.0f}".replace(",", "\u202f") if whole else _superscript(f"{value:.4g}")
    digits = 1 - floor(log10(error))
    if digits > (9 if abs(value) >= 0.1 else 6):
        power = floor(log10(max(abs(value), error)))
        value, error, digits = value / 10.0**power, error / 10.0**power, digits + power
        return _superscript(f"({value:.{digits}f} ± {error:.{digits}f})e{power}")
    return f"{round(value, digits):.{max(digits, 0)}f} ± {round(error, digits):.{max(digits, 0)}f}"


def _superscript(text: str) -> str:
    mantissa, mark, exponent = text.partition("e")
    power = str(int(exponent)).translate(_RAISED) if mark else ""
    return f"{'' if mantissa == '1' else f'{mantissa} × '}10{power}" if mark else mantissa
