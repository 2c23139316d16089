"""A claim's measurements as tables: what shares its conditions stands side by side."""

from collections.abc import Sequence

from restitution.paper._claims import Measurement, with_error
from restitution.paper._report import _html as html

COLUMNS, CHARACTERS = 5, 50
"""Size of a table head, above which conditions go down instead of across."""


def measured(measurements: Sequence[Measurement]) -> str:
    """Make one table of the numbers without condition and one for each set of conditions.

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
        rows = [(_name(m), _number(m)) for m in single]
        tables.append(html.table(("", ""), rows, numbers=(1,)))
    return "\n".join(tables)


def _name(m: Measurement) -> str:
    return html.prose(f"{m.name} ({m.unit})" if m.unit else m.name)


def _number(m: Measurement) -> str:
    return html.prose(with_error(m.value, m.error))


def _matrix(conditions: tuple[str, ...], names: list[str], by_name: dict[str, dict[str, str]]) -> str:
    if len(conditions) <= COLUMNS and sum(map(len, conditions)) <= CHARACTERS:
        headers = ("", *map(html.prose, conditions))
        rows = [(name, *(by_name[name][at] for at in conditions)) for name in names]
    else:
        headers = ("", *names)
        rows = [(html.prose(at), *(by_name[name][at] for name in names)) for at in conditions]
    return html.table(headers, rows, numbers=range(1, len(headers)))
