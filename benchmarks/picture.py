"""Draw the tables of docs/performance.md: `python -m benchmarks.picture` makes the figure of that page."""

import re
from pathlib import Path

from matplotlib.figure import Figure

from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors

DOCS = Path(__file__).parents[1] / "docs"
ROWS = {
    "counts only, avx512, 1 thread": "counts alone",
    "statistics, avx512, 1 thread": "`statistics`",
    "simulate, 1 thread": "`simulate`, every impact kept",
    "Numba grid, our search": "Numba, counts alone",
    "Numba records, 1 thread": "Numba, every impact kept",
    "NumPy 1 ms grid + brentq": "NumPy and SciPy",
}
"""Rows of the table of speeds, of one thread each, by what they do."""


def speeds(page: str) -> dict[str, float]:
    """Return million impacts in a second."""
    found = {name: re.search(rf"^{re.escape(name)} +([\d.]+)", page, re.MULTILINE) for name in ROWS}
    return {text: float(found[name][1]) for name, text in ROWS.items()}  # type: ignore[index]


def costs(page: str) -> dict[str, tuple[float, float]]:
    """Return the time of an impact of a clump in other engines and here, in µs."""
    row = r"^\| clump of 4 \| ([\w+]+).*\| ([\d.]+) µs \| ([\d.]+) µs \|"
    return {name: (float(there), float(here)) for name, there, here in re.findall(row, page, re.MULTILINE)}


@fg.styled
def draw(page: str, *, style: Style | None = None) -> Figure:
    """Draw both as bars."""
    figure, [[left, right]] = fg.panels(fg.PAGE, 2.6, 1, 2)
    ours, others = colors()[0], colors()[1]
    for k, (name, speed) in enumerate(reversed(speeds(page).items())):
        left.barh(k, speed, color=others if name.startswith("Num") else ours)
        left.text(speed, k, f" {float(f'{speed:.2g}'):g}", va="center")
    left.set_yticks(range(len(ROWS)), [name.replace("`", "") for name in reversed(ROWS.values())])
    left.set(xscale="log", xlim=(0.02, 2000.0), xlabel="million impacts a second, one thread")
    times = costs(page)
    bars = [(name, there) for name, (there, _) in times.items()]
    bars += [("statistics, exact", min(here for _, here in times.values()))]
    for k, (name, time) in enumerate(sorted(bars, key=lambda one: -one[1])):
        right.barh(k, time, color=ours if name.startswith("statistics") else others)
        right.text(time, k, f" {float(f'{time:.2g}'):g}", va="center")
    right.set_yticks(range(len(bars)), [name for name, _ in sorted(bars, key=lambda one: -one[1])])
    right.set(xscale="log", xlim=(0.3, 2e5), xlabel="µs an impact, clump of four spheres")
    for axes in (left, right):
        axes.tick_params(axis="y", which="both", left=False, right=False)
    return figure


if __name__ == "__main__":
    text = (DOCS / "performance.md").read_text(encoding="utf-8")
    for ground in SITE:
        path = DOCS / "images" / f"performance{ground[4:]}.png"
        fg.save(draw(text, style=ground), path, title="Speed beside others")
