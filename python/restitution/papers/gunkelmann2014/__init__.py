"""Rough spheres, as in PRE 84, 041306 (2011) and PRE 89, 022205 (2014): simulated, drawn, and judged."""

import os
from pathlib import Path

from restitution.figures.report import grouped
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


PAPER = Paper(
    title="Coefficient of restitution of rough spheres: figures, claims checked",
    reference="M. Montaine, M. Heckel, C. Kruelle, T. Schwager, T. Pöschel, Phys. Rev. E 84, 041306 (2011), "
    "DOI 10.1103/PhysRevE.84.041306; N. Gunkelmann, M. Montaine, T. Pöschel, Phys. Rev. E 89, 022205 "
    "(2014), DOI 10.1103/PhysRevE.89.022205",
    command="restitution rough --out rough",
    settings=Settings(),
    least=10_000,
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
)


def redraw(
    out: str | os.PathLike[str],
    impacts: int = 10_000_000,
    seed: int = 1,
    threads: int | None = None,
    progress: bool = True,
    *,
    overwrite: bool = False,
) -> Path:
    """Simulate rough spheres, draw four figures, and judge what the papers say of them.

    So many impacts are counted in the map of restitution and impact velocity, and at most 1 000 000 of them
    recorded. All else is as in `restitution.papers.redraw.redraw`.
    """
    return machinery.redraw(PAPER, out, impacts, seed, threads, progress, overwrite=overwrite)
