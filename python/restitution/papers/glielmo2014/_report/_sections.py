"""The sections of the report, each a function from results to HTML."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from typing import TYPE_CHECKING, Any, get_args

import numpy as np
import xarray as xr

from restitution._core import STOP_REASONS
from restitution.figures import report as html
from restitution.papers.glielmo2014._claims import (
    SIGNIFICANT,
    Claim,
    Verdict,
    deviations,
    gains_by_elongation,
    with_error,
)
from restitution.papers.glielmo2014._counted import impacts_counted
from restitution.papers.glielmo2014._misprints import MISPRINTS, Misprint
from restitution.papers.glielmo2014._report._badges import badge, count, mark
from restitution.papers.glielmo2014._report._measured import measured
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

if TYPE_CHECKING:
    from restitution.papers.glielmo2014._report import Figure

TITLE = "Coefficient of restitution of aspherical particles: figures redrawn, claims checked"
PAPER = (
    "A. Glielmo, N. Gunkelmann, T. Pöschel, “Coefficient of restitution of aspherical particles”, "
    "Phys. Rev. E 90, 052204 (2014), DOI 10.1103/PhysRevE.90.052204"
)


def source(runs: Runs) -> str:
    """Name the software and its version."""
    return f"restitution {runs.main.attrs['version']}"


def heading(claims: Sequence[Claim], runs: Runs) -> str:
    """Give title, what this is, and how many claims hold."""
    numbers = Counter(claim.verdict for claim in claims)
    counts = "\n".join(count(verdict, numbers[verdict]) for verdict in get_args(Verdict))
    counted = impacts_counted(runs.counted.lattice)
    recorded = int(runs.main["impacts"].sum())
    return "\n".join(
        (
            f"<h1>{html.text(TITLE)}</h1>",
            html.paragraph(PAPER + ".", "lead"),
            html.paragraph(
                f"Figures 2 to 7 and 9 are simulated anew, with {_grouped(counted)} impacts behind Fig. 2. "
                f"Each of the {len(claims)} quantitative claims of the paper is compared with the number "
                "measured here, with its standard error and a verdict by a stated rule. Unless stated "
                f"otherwise, the numbers are of the first {_grouped(recorded)} of these impacts. Made by "
                f"{source(runs)}, seed {runs.seed}."
            ),
            f'<ul class="counts">\n{counts}\n</ul>',
        )
    )


def summary(claims: Sequence[Claim]) -> str:
    """List every claim in a line, with its verdict."""
    rows = "\n".join(
        f'<tr><td><q>{html.prose(claim.quote)}</q> <span class="small">{html.prose(claim.where)}</span></td>'
        f"<td>{html.prose(claim.why)}</td>"
        f'<td><a href="#{html.text(claim.key)}" title="the numbers">{badge(claim.verdict)}</a></td></tr>'
        for claim in claims
    )
    return (
        '<table class="summary"><caption>Claims in the order of the paper; each verdict links to its '
        'numbers.</caption><thead><tr><th scope="col">The paper</th><th scope="col">What we find</th>'
        f'<th scope="col">Verdict</th></tr></thead><tbody>\n{rows}\n</tbody></table>'
    )


def figures(found: Sequence["Figure"], explorer: str) -> str:
    """Show every figure with its caption, and where it can be made and looked into impact by impact."""
    return "\n".join(
        f'<figure id="{html.text(figure.name)}">\n<h3>{html.prose(figure.title)}</h3>\n'
        f"{html.image(figure.png, figure.shows)}\n"
        f"<figcaption>{html.prose(figure.caption)}{_live(figure, explorer)}</figcaption>\n</figure>"
        for figure in found
    )


def _live(figure: "Figure", explorer: str) -> str:
    if not explorer:
        return ""
    words = f"Watch it fill up, and replay any impact, at stop {figure.stop} of the explorer's tour."
    return f'\n<a class="live" href="{html.text(explorer)}#stop={figure.stop}">{html.text(words)}</a>'


def details(claims: Sequence[Claim]) -> str:
    """Show every claim with its numbers and the rule of its verdict."""
    how = html.paragraph(
        "Numbers are given ± one standard error. Impacts of one particle are correlated, so each particle "
        "counts as one draw in every standard error, and p-values rest on at most one impact of each "
        f"particle at a speed. A difference is significant from {SIGNIFICANT:g} standard errors; about one "
        "report in a hundred then contains a spurious finding."
    )
    cards = (
        f'<article id="{html.text(claim.key)}">\n'
        f"<h3><q>{html.prose(claim.quote)}</q> {badge(claim.verdict)}</h3>\n"
        f"{html.paragraph(claim.where, 'small')}\n{html.paragraph(claim.why, 'why')}\n"
        f"{measured(claim.measured)}\n{html.paragraph('Rule: ' + claim.rule, 'rule')}\n</article>"
        for claim in claims
    )
    return "\n".join((how, *cards))


def misprints() -> str:
    """Show every formula that is not right as printed, with proof and numbers."""
    how = html.paragraph(
        "Formulas of the paper that are wrong as printed (misprint), or hold in a smaller range than it "
        "seems (caveat). Each is checked on one number: by the printed formula, by the corrected one, and "
        "by independent means."
    )
    return "\n".join((how, *map(_misprint, MISPRINTS)))


def _misprint(one: Misprint) -> str:
    check = one.check()
    numbers = html.table(
        ("", "as printed", "corrected", "independent"),
        [(html.prose(one.quantity), *(html.prose(f"{round(value, 12) + 0.0:.6g}") for value in check))],
        caption=f"Eq. {one.equation}: one number three ways",
        numbers=(1, 2, 3),
    )
    kind = mark(one.kind, one.kind == "misprint")
    formulas = "".join(
        f'<dt>{label}</dt><dd class="formula">{html.prose(formula)}</dd>'
        for label, formula in (("printed", one.printed), ("right", one.corrected))
    )
    return "\n".join(
        (
            f"<article>\n<h3>Eq. {html.text(one.equation)} {kind}</h3>",
            f'<dl class="pair">{formulas}</dl>',
            html.paragraph(one.proof),
            numbers,
            "</article>",
        )
    )


def sensitivity(runs: Runs, settings: Settings) -> str:
    """Tabulate σ(ε) for other radii and release heights."""
    parts = [
        html.paragraph(
            "The paper states neither the radius R nor the release height. The motion depends on L/R, on "
            "the law, on the height in units of R and on the speed in units of √(gR), so at a speed in m/s "
            "both matter. Standard deviation σ(ε) at the four speeds of Fig. 4; bold: more than "
            f"{SIGNIFICANT:g} standard errors from our choice; –: not reached."
        )
    ]
    for name, by_what, by, ours in (
        ("R", "radius", runs.by_radius, settings.radius),
        ("released from", "release height", runs.by_height, settings.release_height),
    ):
        for elongation in by[ours]:
            reference = deviations(by[ours][elongation], settings)
            rows = []
            for value, pair in by.items():
                sigma = deviations(pair[elongation], settings)
                apart = np.abs(sigma.apart(reference)) > SIGNIFICANT
                cells = (
                    "–"
                    if np.isnan(s)
                    else f"<strong class='apart'>{_number(s, e)}</strong>"
                    if far
                    else _number(s, e)
                    for s, e, far in zip(sigma.value, sigma.error, apart, strict=True)
                )
                mark = " (ours)" if value == ours else ""
                rows.append((html.text(f"{name} {1e3 * value:g} mm{mark}"), *cells))
            speeds = (html.text(f"{v:g} m/s") for v in settings.speeds)
            parts.append(
                html.table(
                    ("", *speeds),
                    rows,
                    caption=f"σ(ε) at four speeds for L/R = {elongation:g}, by {by_what}",
                    numbers=range(1, 5),
                )
            )
    return "\n".join(parts)


def energy(runs: Runs) -> str:
    """Tabulate the impacts that create kinetic energy."""
    text = html.paragraph(
        "With ε_t = 1 the tangential velocity of the contact point is kept (Eq. 9). For a body that is not "
        "a sphere this is not the absence of friction: it takes a tangential impulse (Eq. 10), and that "
        "impulse can do positive work. Then the kinetic energy of the body, translation and rotation "
        "together, is larger after the impact than before. A frictionless law, with the impulse along the "
        "normal, never does this."
    )
    found = gains_by_elongation(runs)
    rows = [
        (
            html.text(f"{elongation:g}"),
            _number(one.share, one.error),
            _number(one.share_above_round_off, None),
            _number(one.largest, None),
        )
        for elongation, one in found.items()
    ]
    headers = ("L/R", "share of impacts that create energy", "the same above round-off", "largest factor")
    caption = "Impacts that create kinetic energy, by L/R"
    return f"{text}\n{html.table(headers, rows, caption=caption, numbers=(1, 2, 3))}"


def parameters(settings: Settings) -> str:
    """Tabulate every setting and whose it is."""
    rows = [
        (
            html.prose(row.text),
            html.prose(_plain(row.value)),
            html.text("" if row.unit == "1" else row.unit),
            row.source,
        )
        for row in settings.rows()
    ]
    note = html.paragraph("What the paper states is marked “paper”; where it is silent the choice is ours.")
    headers = ("parameter", "value", "unit", "source")
    return f"{note}\n{html.table(headers, rows, caption='Parameters of the figures')}"


def simulations(runs: Runs) -> str:
    """Tabulate every run: size, seed, and why trajectories ended."""
    sizes = [
        (
            data.attrs,
            int(data["impacts"].sum()),
            np.bincount(data["stop_reason"].to_numpy(), minlength=len(STOP_REASONS)),
        )
        for data in _datasets(runs)
    ] + [
        (found.attrs, impacts_counted(found), found["particles_ended"].to_numpy())
        for found in runs.counted.ensembles()
    ]
    rows = []
    for about, impacts, reasons in sizes:
        ended = ", ".join(
            f"{_grouped(int(n))} {reason.replace('_', ' ')}"
            for reason, n in zip(STOP_REASONS, reasons, strict=True)
            if n
        )
        rows.append(
            tuple(
                html.text(cell)
                for cell in (
                    about["run"],
                    f"{about['separation'] / about['radius']:g}",
                    f"{1e3 * about['radius']:g}",
                    f"{1e3 * about['release_height']:g}",
                    about["orientation"],
                    _grouped(about["particles"]),
                    _grouped(impacts),
                    ended,
                    about["seed"],
                )
            )
        )
    headers = (
        "run",
        "L/R",
        "R (mm)",
        "height (mm)",
        "release",
        "particles",
        "impacts",
        "trajectories ended",
        "seed",
    )
    note = html.paragraph(
        "A trajectory that collapses has infinitely many impacts in finite time; it ends there and nothing "
        "is regularised. Counted impacts are not recorded; the recorded run consists of the first particles "
        "of the run of the same seed."
    )
    caption = "Simulations: size, seed, and why trajectories ended"
    return f"{note}\n{html.table(headers, rows, caption=caption, numbers=(1, 2, 3, 5, 6))}"


def reproduce(runs: Runs) -> str:
    """Give the command that makes this report."""
    command = f"restitution paper --out paper --impacts {runs.counted.asked} --seed {runs.seed}"
    return f'<pre tabindex="0"><code>{html.text(command)}</code></pre>\n' + html.paragraph(
        f"with {source(runs)}. The same version and seed give the same numbers on any number of threads. "
        "Beside this file are each figure as PNG and PDF, its caption, and the data drawn as netCDF."
    )


def citation(runs: Runs) -> str:
    """Say what to cite."""
    software = (
        "The restitution developers, “restitution: the coefficient of restitution as a distribution, not a "
        f"number”, version {runs.main.attrs['version']}"
    )
    return f"<ul>\n<li>{html.prose(PAPER)}</li>\n<li>{html.text(software)}</li>\n</ul>"


def _datasets(value: Any) -> Iterator[xr.Dataset]:
    """Every Dataset in `Runs`, in the order of its fields."""
    if isinstance(value, xr.Dataset):
        yield value
    elif isinstance(value, Mapping):
        for part in value.values():
            yield from _datasets(part)
    elif isinstance(value, Runs):
        for field in fields(value):
            yield from _datasets(getattr(value, field.name))


def _number(value: float, error: float | None) -> str:
    return html.prose(with_error(float(value), None if error is None else float(error)))


def _grouped(number: int) -> str:
    """Write a whole number with thin spaces between its thousands."""
    return f"{number:,}".replace(",", "\u202f")


def _plain(value: Any) -> str:
    """Write a setting's value."""
    if isinstance(value, tuple):
        return ", ".join(map(_plain, value))
    if isinstance(value, int):
        return _grouped(value)
    return f"{value:g}" if isinstance(value, float) else str(value)
