"""Sections of this paper's report alone: effects of radius and height, and created energy."""

import numpy as np

from restitution.figures import report as html
from restitution.figures.report import Section
from restitution.papers.claims import SIGNIFICANT
from restitution.papers.estimate import deviations
from restitution.papers.glielmo2014._claims import gains_by_elongation
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.report import number


def sections(runs: Runs, settings: Settings) -> list[Section]:
    """Return both sections."""
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
                cells = (
                    "–"
                    if np.isnan(s)
                    else f"<strong class='apart'>{number(s, e)}</strong>"
                    if far
                    else number(s, e)
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
    found = gains_by_elongation(runs)
    rows = [
        (
            html.text(f"{elongation:g}"),
            number(one.share, one.error),
            number(one.share_above_round_off, None),
            number(one.largest, None),
        )
        for elongation, one in found.items()
    ]
    headers = ("L/R", "share of impacts that create energy", "the same above round-off", "largest factor")
    caption = "Impacts that create kinetic energy, by L/R"
    return [text, html.table(headers, rows, caption=caption, numbers=(1, 2, 3))]
