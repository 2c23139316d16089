"""The report on a redrawn paper: every claim with its numbers, every figure, misprint, parameter and run."""

from collections import Counter
from collections.abc import Sequence
from typing import Any, get_args

from restitution._internal.text import with_error
from restitution.figures import report as html
from restitution.figures.report import Section
from restitution.papers.claims import SIGNIFICANT, Claim, Measurement, R, S, Verdict
from restitution.papers.figures import SavedFigure
from restitution.papers.paper import Misprint, Paper
from restitution.papers.runs import Runs, is_counted
from restitution.papers.settings import Settings

_CLASSES: dict[str, str] = {
    "holds": "holds",
    "holds in part": "part",
    "fails": "fails",
    "misprint": "fails",
    "caveat": "part",
}
"""Verdicts and kinds of misprints, in the colours of their weight."""
_COLUMNS, _CHARACTERS = 5, 50
"""Size of a table head, above which conditions go down instead of across."""


def report(
    paper: Paper[R, S],
    runs: R,
    figures: Sequence[SavedFigure],
    claims: Sequence[Claim],
    *,
    explorer: str = "",
) -> str:
    """Write the redrawn and judged paper as one self-contained page of HTML.

    Each figure is linked to the explorer, whose address is as seen from the report, where there is one.
    """
    source = f"restitution {runs.version}"
    sections = [
        Section("claims", "The claims, checked", [_summary(claims)]),
        Section("figures", "The figures, redrawn", [_figure(figure, explorer) for figure in figures]),
        Section("numbers", "The numbers behind each verdict", _details(claims, paper.errors)),
        *([Section("misprints", "Misprints", _misprints(paper.misprints))] if paper.misprints else []),
        *paper.sections(runs, paper.settings),
        Section("parameters", "Parameters", _parameters(paper.settings)),
        Section("runs", "Simulations", _simulations(runs, paper)),
        Section("reproduce", "How to reproduce this report", _reproduce(paper, runs, source)),
        Section("cite", "How to cite", [_citation(paper.reference, runs)]),
    ]
    return html.page(paper.title, _heading(paper, claims, runs, source), sections, source, contents=True)


def number(value: float, error: float | None = None) -> str:
    """Write a number with its standard error as HTML."""
    return html.prose(with_error(float(value), None if error is None else float(error)))


def _heading(paper: Paper[R, S], claims: Sequence[Claim], runs: R, source: str) -> str:
    numbers = Counter(claim.finding.verdict for claim in claims)
    counts = "\n".join(_count(verdict, numbers[verdict]) for verdict in get_args(Verdict))
    about = (
        f"{paper.about(runs)} Each of the {len(claims)} quantitative claims is compared with "
        "the number measured here, with its standard error and a verdict by a stated rule. Made by "
        f"{source}, seed {runs.seed}."
    )
    return "\n".join(
        (
            f"<h1>{html.text(paper.title)}</h1>",
            html.paragraph(f"{paper.reference}.", "lead"),
            html.paragraph(about),
            f'<ul class="counts">\n{counts}\n</ul>',
        )
    )


def _count(verdict: Verdict, number: int) -> str:
    """Count the claims with this verdict, in a list item that links to the first of them."""
    words = verdict if number == 1 else verdict.replace("holds", "hold").replace("fails", "fail")
    counted = f"<b>{number}</b> {html.text(words)}"
    linked = f'<a href="#{_CLASSES[verdict]}">{counted}</a>' if number else counted
    return f'<li class="{_CLASSES[verdict]}">{linked}</li>'


def _badge(kind: str) -> str:
    """Name a verdict, or a kind of misprint, in its colour."""
    return f'<span class="badge {_CLASSES[kind]}">{html.text(kind)}</span>'


def _summary(claims: Sequence[Claim]) -> str:
    """List every claim in a line, with its verdict."""
    first = {claim.finding.verdict: claim.key for claim in reversed(claims)}
    anchors = {key: f' id="{_CLASSES[verdict]}"' for verdict, key in first.items()}
    rows = "\n".join(
        f"<tr{anchors.get(claim.key, '')}>"
        f'<td><q>{html.prose(claim.quote)}</q> <span class="small">{html.prose(claim.where)}</span></td>'
        f"<td>{html.prose(claim.finding.why)}</td>"
        f'<td><a href="#{html.text(claim.key)}" title="the numbers">{_badge(claim.finding.verdict)}</a></td>'
        "</tr>"
        for claim in claims
    )
    return (
        '<table class="summary"><caption>Each verdict links to its numbers.</caption><thead><tr>'
        '<th scope="col">The claim</th><th scope="col">What we find</th>'
        f'<th scope="col">Verdict</th></tr></thead><tbody>\n{rows}\n</tbody></table>'
    )


def _figure(saved: SavedFigure, explorer: str) -> str:
    """Show a figure with its caption, and where it can be made and looked into impact by impact."""
    figure, live = saved.of, ""
    if explorer and figure.stop is not None:
        words = f"Watch it fill up, and replay any impact, at stop {figure.stop} of the explorer's tour."
        live = f'\n<a class="live" href="{html.text(explorer)}#stop={figure.stop}">{html.text(words)}</a>'
    return (
        f'<figure id="{html.text(figure.name)}">\n<h3>{html.prose(figure.title)}</h3>\n'
        f"{html.image(saved.png, f'{figure.pictured}. {figure.shows}')}\n<figcaption>\n"
        f"{html.paragraph('What to see: ' + figure.shows, 'see')}\n"
        f"{html.paragraph(saved.text)}\n<details><summary>Parameters and run</summary>\n"
        f"{html.paragraph(saved.parameters)}</details>{live}</figcaption>\n</figure>"
    )


def _details(claims: Sequence[Claim], errors: str) -> list[str]:
    """Show every claim with its numbers and the rule of its verdict."""
    how = html.paragraph(
        f"Numbers are given ± one standard error. {errors} A difference is significant from {SIGNIFICANT:g} "
        "standard errors; about one report in a hundred then contains a spurious finding."
    )
    cards = (
        f'<article id="{html.text(claim.key)}">\n'
        f"<h3><q>{html.prose(claim.quote)}</q> {_badge(claim.finding.verdict)}</h3>\n"
        f"{html.paragraph(claim.where, 'small')}\n{html.paragraph(claim.finding.why, 'why')}\n"
        f"{measured(claim.finding.measured)}\n"
        f"{html.paragraph('Rule: ' + claim.finding.rule, 'rule')}\n</article>"
        for claim in claims
    )
    return [how, *cards]


def measured(measurements: Sequence[Measurement]) -> str:
    """Make one table of the numbers without condition and one for each set of conditions, with captions.

    Quantities measured under the same conditions (at the same speeds, say) share a table, conditions across
    and quantities down, or the other way round where there are many conditions.
    """
    single = [m for m in measurements if not m.at]
    by_name: dict[str, dict[str, str]] = {}
    for m in measurements:
        if m.at:
            by_name.setdefault(_name(m), {})[m.at] = number(m.value, m.error)
    shared: dict[tuple[str, ...], list[str]] = {}
    for name, row in by_name.items():
        shared.setdefault(tuple(row), []).append(name)
    tables = [_matrix(conditions, names, by_name) for conditions, names in shared.items()]
    if single:
        rows = [(html.prose(_name(m)), number(m.value, m.error)) for m in single]
        tables.append(html.table(("", ""), rows, caption=_title([m.name for m in single]), numbers=(1,)))
    return "\n".join(tables)


def _name(m: Measurement) -> str:
    return f"{m.name} ({m.unit})" if m.unit else m.name


def _title(names: Sequence[str]) -> str:
    """Name the first quantity of a table, and the number of the others."""
    return names[0] if len(names) == 1 else f"{names[0]}, and {len(names) - 1} more"


def _matrix(conditions: tuple[str, ...], names: list[str], by_name: dict[str, dict[str, str]]) -> str:
    first, last = conditions[0], conditions[-1]
    where = first if len(conditions) == 1 else f"{first} to {last}"
    caption = f"{_title(names)}: {where}"
    if len(conditions) <= _COLUMNS and sum(map(len, conditions)) <= _CHARACTERS:
        headers = ("quantity", *map(html.prose, conditions))
        rows = [(html.prose(name), *(by_name[name][at] for at in conditions)) for name in names]
    else:
        headers = ("at", *map(html.prose, names))
        rows = [(html.prose(at), *(by_name[name][at] for name in names)) for at in conditions]
    return html.table(headers, rows, caption=caption, numbers=range(1, len(headers)))


def _misprints(found: Sequence[Misprint]) -> list[str]:
    """Show every formula that is not right as printed, with proof and numbers."""
    how = html.paragraph(
        "Formulas of the paper that are wrong as printed (misprint), or hold in a smaller range than it "
        "seems (caveat). Each is checked on one number: by the printed formula, by the corrected one, and "
        "by independent means."
    )
    return [how, *map(_misprint, found)]


def _misprint(one: Misprint) -> str:
    numbers = html.table(
        ("", "as printed", "corrected", "independent"),
        [(html.prose(one.quantity), *(html.prose(f"{round(value, 12) + 0.0:.6g}") for value in one.check()))],
        caption=f"Eq. {one.equation}: one number three ways",
        numbers=(1, 2, 3),
    )
    formulas = "".join(
        f'<dt>{label}</dt><dd class="formula">{html.prose(formula)}</dd>'
        for label, formula in (("printed", one.printed), ("right", one.corrected))
    )
    return (
        f"<article>\n<h3>Eq. {html.text(one.equation)} {_badge(one.kind)}</h3>\n"
        f'<dl class="pair">{formulas}</dl>\n{html.paragraph(one.proof)}\n{numbers}\n</article>'
    )


def _parameters(settings: Settings) -> list[str]:
    """Tabulate every setting and whose it is."""
    rows = [
        (html.prose(text), html.prose(_plain(value)), html.text("" if unit == "1" else unit), source)
        for _, value, unit, source, text in settings.rows()
    ]
    return [
        html.paragraph("What the paper states is marked “paper”; where it is silent the choice is ours."),
        html.table(("parameter", "value", "unit", "source"), rows, caption="Parameters of the figures"),
    ]


def _plain(value: Any) -> str:
    """Write a setting's value."""
    if isinstance(value, tuple):
        return ", ".join(map(_plain, value))
    if isinstance(value, int):
        return html.grouped(value)
    return f"{value:g}" if isinstance(value, float) else str(value)


def _simulations(runs: R, paper: Paper[R, S]) -> list[str]:
    """Tabulate every run, the recorded ones first: parameters, size, and seed."""
    columns, rows = paper.columns, []
    for name, data in sorted(runs.all().items(), key=lambda run: is_counted(run[1])):
        parameters = [str(parameter(data.attrs)) for parameter in columns.values()]
        sizes = [size(data) for size in paper.sizes.values()]
        rows.append([html.prose(c) for c in (name, *parameters, *sizes, str(data.attrs["seed"]))])
    headers = ("run", *columns, *paper.sizes, "seed")
    numeric = [k for k in range(1, len(headers) - 1) if rows[0][k][0].isdigit()]
    caption = f"Simulations: {', '.join(paper.sizes)}, and seed"
    return [html.paragraph(paper.ends), html.table(headers, rows, caption=caption, numbers=numeric)]


def _reproduce(paper: Paper[R, S], runs: R, source: str) -> list[str]:
    """Return the command that makes this report."""
    line = f"{paper.command} --{paper.size} {runs.asked} --seed {runs.seed}"
    return [
        f'<pre tabindex="0"><code>{html.text(line)}</code></pre>',
        html.paragraph(
            f"with {source}. The same version and seed give the same numbers on any number of threads. "
            "Beside this file are each figure as PNG and PDF, its caption, and the data drawn as netCDF."
        ),
    ]


def _citation(reference: str, runs: Runs) -> str:
    """List the works to cite."""
    software = (
        "The restitution developers, “restitution: the coefficient of restitution as a distribution, not a "
        f"number”, version {runs.version}"
    )
    return f"<ul>\n<li>{html.prose(reference)}</li>\n<li>{html.text(software)}</li>\n</ul>"
