"""The paper PRE 90, 052204 (2014), redrawn and judged claim by claim."""

from functools import partial

import numpy as np

from restitution.figures import report as html
from restitution.figures.report import Section, grouped
from restitution.papers import redraw as machinery
from restitution.papers.claims import SIGNIFICANT
from restitution.papers.estimate import deviations
from restitution.papers.glielmo2014 import _runs
from restitution.papers.glielmo2014._claims import CLAIMS, gains_by_elongation
from restitution.papers.glielmo2014._figures import FIGURES
from restitution.papers.glielmo2014._misprints import MISPRINTS
from restitution.papers.glielmo2014._runs import Runs, simulate
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.paper import Paper
from restitution.papers.report import number
from restitution.papers.runs import impacts_of

__all__ = ["PAPER", "redraw"]


def _about(runs: Runs) -> str:
    counted, recorded = impacts_of(runs.lattice), impacts_of(runs.main)
    of = "them" if recorded == counted else f"the first {grouped(recorded)} of them"
    return (
        f"Figures 2 to 7 and 9 are simulated anew, with {grouped(counted)} impacts behind Fig. 2. Unless "
        f"stated otherwise, the numbers are of {of}."
    )


def _sections(runs: Runs, settings: Settings) -> list[Section]:
    """Return the sections of this report alone: effects of radius and height, and created energy."""
    return [
        Section("sensitivity", "What radius and release height change", _sensitivity(runs, settings)),
        Section("energy", "Not in the paper: impacts that create energy", _energy(runs)),
    ]


def _sensitivity(runs: Runs, settings: Settings) -> list[str]:
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
                cells = []
                for s, e, far in zip(sigma.value, sigma.error, apart, strict=True):
                    cell = "–" if np.isnan(s) else number(s, e)
                    cells.append(f"<strong class='apart'>{cell}</strong>" if far else cell)
                mark = " (ours)" if value == ours else ""
                rows.append((html.text(f"{name} {1e3 * value:g} mm{mark}"), *cells))
            caption = f"σ(ε) at four speeds for L/R = {elongation:g}, by {by_what}"
            headers = ("", *map(html.text, settings.labels))
            parts.append(html.table(headers, rows, caption=caption, numbers=range(1, 5)))
    return parts


def _energy(runs: Runs) -> list[str]:
    """Tabulate the impacts that create kinetic energy."""
    text = html.paragraph(
        "With ε_t = 1 the tangential velocity of the contact point is kept (Eq. 9). For a body that is not "
        "a sphere this is not the absence of friction: it takes a tangential impulse (Eq. 10), and that "
        "impulse can do positive work. Then the kinetic energy of the body, translation and rotation "
        "together, is larger after the impact than before. A frictionless law, with the impulse along the "
        "normal, never does this."
    )
    rows = []
    for elongation, one in gains_by_elongation(runs).items():
        share, above = number(one.share, one.error), number(one.share_above_round_off)
        rows.append((f"{elongation:g}", share, above, number(one.largest)))
    headers = ("L/R", "share of impacts that create energy", "the same above round-off", "largest factor")
    caption = "Impacts that create kinetic energy, by L/R"
    return [text, html.table(headers, rows, caption=caption, numbers=(1, 2, 3))]


PAPER = Paper(
    title="Coefficient of restitution of aspherical particles: figures redrawn, claims checked",
    reference="A. Glielmo, N. Gunkelmann, T. Pöschel, “Coefficient of restitution of aspherical particles”, "
    "Phys. Rev. E 90, 052204 (2014), DOI 10.1103/PhysRevE.90.052204",
    command="restitution paper --out paper",
    settings=Settings(),
    least=Settings.least_impacts,
    usual=100_000_000,  # for each of Figs. 2-5 and 7, and each curve of Fig. 6
    number=_runs.number(Settings()),
    simulate=simulate,
    about=_about,
    columns={
        "L/R": lambda run: f"{run['separation'] / run['radius']:g}",
        "R (mm)": lambda run: f"{1e3 * run['radius']:g}",
        "height (mm)": lambda run: f"{1e3 * run['release_height']:g}",
        "release": lambda run: str(run["orientation"]),
    },
    figures=FIGURES,
    claims=CLAIMS,
    misprints=MISPRINTS,
    sections=_sections,
)
redraw = partial(machinery.redraw, PAPER)
"""As `restitution.papers.redraw.redraw`, of this paper."""
