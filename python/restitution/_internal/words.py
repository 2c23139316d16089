"""Numbers with their errors, as a paper writes them."""

from math import floor, isfinite, isnan, log10


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
    power = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")) if mark else ""
    return f"{'' if mantissa == '1' else f'{mantissa} × '}10{power}" if mark else mantissa
