"""Rough spheres, as in PRE 84, 041306 (2011) and PRE 89, 022205 (2014): simulated, drawn, and judged."""

from functools import partial

from restitution.figures import report as html
from restitution.figures.report import Section, grouped
from restitution.papers import redraw as machinery
from restitution.papers.gunkelmann2014._claims import CLAIMS
from restitution.papers.gunkelmann2014._figures import FIGURES
from restitution.papers.gunkelmann2014._runs import Runs, number, simulate
from restitution.papers.gunkelmann2014._settings import Settings
from restitution.papers.paper import Paper
from restitution.papers.runs import impacts_of

__all__ = ["PAPER", "redraw"]


def _about(runs: Runs) -> str:
    return (
        "A sphere that is covered with asperities bounces on a plane. The figures are those that the model "
        "calls for; the claims are what PRE 90, 052204 says of it, and the abstract of its ref. 10. Their "
        "parameters are not all published: ours are marked, and what depends on them is said. Densities and "
        f"claims rest on {grouped(impacts_of(runs.main))} recorded impacts, the map on "
        f"{grouped(impacts_of(runs.lattice))}."
    )


def _closed_form() -> Section:
    """Give what the figures and claims compare with, with the numbers of docs/rough.md, which derives it."""
    formulas = (
        ("(9)", "⟨y⟩ = M(σ̃² − κ)"),
        ("(10)", "σ₀² = M σ̃²"),
        (
            "(11)",
            "p(y) = exp(−y/a)/(a + b) where y > 0, exp(y/b)/(a + b) where y < 0; a − b = ⟨y⟩, ab = σ₀²/2",
        ),
        ("(12)", "σ_ω = √[κ(1 + ε_n)γ/2 · (v₀² r^k − v²)/(r − s)] / R, k = ln(v₀²/v²)/ln(1/s)"),
    )
    listed = "".join(
        f'<dt>{label}</dt><dd class="formula">{html.prose(formula)}</dd>' for label, formula in formulas
    )
    return Section(
        "closed-form",
        "The closed form",
        [
            html.paragraph(
                "No parameter of it is fitted. Let y = (ε − ε_n)/(1 + ε_n); M the mean square of the angle "
                "between the lowest point and the contact, 4/N for equal heights and 2⟨h⟩/R for exponential "
                "ones; κ = mR²/(J + mR²); and σ̃ = σ_ω R/v, where σ_ω is the standard deviation of a "
                "horizontal component of the spin. Then"
            ),
            f'<dl class="pair">{listed}</dl>',
            html.paragraph(
                "where γ = κ(1 + ε_n)M, r = 1 − 2γ and s = ε_n² − 2ε_n γ; the sphere is released without "
                "spin and first meets the plane at v₀. The page docs/rough.md of the package derives this, "
                "under the same numbers."
            ),
        ],
    )


PAPER = Paper(
    title="Coefficient of restitution of rough spheres: figures, claims checked",
    reference="M. Montaine, M. Heckel, C. Kruelle, T. Schwager, T. Pöschel, Phys. Rev. E 84, 041306 (2011), "
    "DOI 10.1103/PhysRevE.84.041306; N. Gunkelmann, M. Montaine, T. Pöschel, Phys. Rev. E 89, 022205 "
    "(2014), DOI 10.1103/PhysRevE.89.022205",
    command="restitution rough --out rough",
    settings=Settings(),
    least=10_000,
    usual=10_000_000,  # in the map of restitution and impact velocity
    number=number(Settings()),
    simulate=simulate,
    about=_about,
    columns={
        "body": lambda run: str(run["body"]),
        "law": lambda run: str(run["law"]),
        "height (mm)": lambda run: f"{1e3 * run['release_height']:g}",
    },
    figures=FIGURES,
    claims=CLAIMS,
    sections=lambda runs, settings: [_closed_form()],
)
redraw = partial(machinery.redraw, PAPER)
"""As `restitution.papers.redraw.redraw`, of this paper."""
