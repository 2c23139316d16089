"""A claim's measurements as tables: what shares its conditions stands side by side."""

from collections.abc import Sequence

from restitution.figures import report as html
from restitution.papers.glielmo2014._claims import Measurement, with_error

COLUMNS, CHARACTERS = 5, 50
"""Size of a table head, above which conditions go down instead of across."""


def measured(measurements: Sequence[Measurement]) -> str:
    """Make one table of the numbers without condition and one for each set of conditions, with captions.

    Quantities measured under the same conditions (at the same speeds, say) share a table, conditions across
    and quantities down, or the other way round where there are many conditions.
    """
    single = [m for m in measurements if not m.at]
    by_name: dict[str, dict[str, str]] = {}
    for m in measurements:
        if m.at:
            by_name.setdefault(_name(m), {})[m.at] = _number(m)
    shared: dict[tuple[str, ...], list[str]] = {}
    for name, row in by_name.items():
        shared.setdefault(tuple(row), []).append(name)
    tables = [_matrix(conditions, names, by_name) for conditions, names in shared.items()]
    if single:
        rows = [(html.prose(_name(m)), _number(m)) for m in single]
        tables.append(html.table(("", ""), rows, caption=_title([m.name for m in single]), numbers=(1,)))
    return "\n".join(tables)


def _name(m: Measurement) -> str:
    return f"{m.name} ({m.unit})" if m.unit else m.name


def _title(names: Sequence[str]) -> str:
    """Name what a table holds, or how much of it."""
    return names[0] if len(names) == 1 else f"{names[0]}, and {len(names) - 1} more"


def _number(m: Measurement) -> str:
    return html.prose(with_error(m.value, m.error))


def _matrix(conditions: tuple[str, ...], names: list[str], by_name: dict[str, dict[str, str]]) -> str:
    first, last = conditions[0], conditions[-1]
    where = first if len(conditions) == 1 else f"{first} to {last}"
    caption = f"{_title(names)}: {where}"
    if len(conditions) <= COLUMNS and sum(map(len, conditions)) <= CHARACTERS:
        headers = ("quantity", *map(html.prose, conditions))
        rows = [(html.prose(name), *(by_name[name][at] for at in conditions)) for name in names]
    else:
        headers = ("at", *map(html.prose, names))
        rows = [(html.prose(at), *(by_name[name][at] for name in names)) for at in conditions]
    return html.table(headers, rows, caption=caption, numbers=range(1, len(headers)))
