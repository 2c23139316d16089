"""The paper PRE 90, 052204 (2014), redrawn and judged claim by claim."""

from functools import partial

from restitution.figures.report import grouped
from restitution.papers import redraw as machinery
from restitution.papers.glielmo2014._claims import CLAIMS
from restitution.papers.glielmo2014._figures import FIGURES
from restitution.papers.glielmo2014._misprints import MISPRINTS
from restitution.papers.glielmo2014._runs import Runs, number, simulate
from restitution.papers.glielmo2014._sections import sections
from restitution.papers.glielmo2014._settings import Settings
from restitution.papers.paper import Paper
from restitution.papers.runs import impacts_of

__all__ = ["PAPER", "redraw"]


def _about(runs: Runs) -> str:
    counted, recorded = impacts_of(runs.lattice), impacts_of(runs.main)
    of = "them" if recorded == counted else f"the first {grouped(recorded)} of them"
    return (
        f"Figures 2 to 7 and 9 are simulated anew, with {grouped(counted)} impacts behind Fig. 2. Unless "
        f"stated otherwise, the numbers are of {of}."
    )


PAPER = Paper(
    title="Coefficient of restitution of aspherical particles: figures redrawn, claims checked",
    reference="A. Glielmo, N. Gunkelmann, T. Pöschel, “Coefficient of restitution of aspherical particles”, "
    "Phys. Rev. E 90, 052204 (2014), DOI 10.1103/PhysRevE.90.052204",
    command="restitution paper --out paper",
    settings=Settings(),
    least=Settings.least_impacts,
    usual=100_000_000,  # for each of Figs. 2-5 and 7, and each curve of Fig. 6
    number=number(Settings()),
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
    sections=sections,
)
redraw = partial(machinery.redraw, PAPER)
"""As `restitution.papers.redraw.redraw`, of this paper."""
