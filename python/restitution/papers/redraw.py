"""From nothing to the report: simulate, draw, judge, write, and only then put the files in place."""

import os
from pathlib import Path

from restitution._internal.arrays import flag, whole
from restitution._internal.files import FOLDER, check_folder, path_for, whole_folder
from restitution._internal.resources import bar, checked_threads
from restitution.explorer import page
from restitution.papers.claims import R, S
from restitution.papers.paper import Paper
from restitution.papers.report import report
from restitution.papers.runs import Runner

PAGES = ("report.html", "explorer.html")


def redraw(
    paper: Paper[R, S],
    out: str | os.PathLike[str],
    impacts: int | None = None,
    seed: int = 1,
    threads: int | None = None,
    progress: bool = True,
    *,
    overwrite: bool = False,
) -> Path:
    """Redraw the figures of a paper and judge its claims.

    Parameters
    ----------
    paper : Paper
        What is redrawn.
    out : path
        Folder for the report, the explorer that its figures are linked to, and for each figure its PNG, PDF,
        caption and data; made if it does not exist. Nothing appears there before all is done.
    impacts : int, optional
        Impacts to simulate, or what else `Paper.size` says, as the paper's `simulate` counts them;
        `Paper.usual` unless given.
    seed : int
        Seed that those of all runs derive from, in [0, 2⁶⁴).
    threads : int, optional
        As in `restitution.simulate`. The same seed gives the same figures with any number.
    progress : bool
        Whether to show progress bars.
    overwrite : bool
        Whether files of an earlier call are replaced; others are left alone.

    Returns
    -------
    Path
        The report, an HTML file that needs no other.

    Raises
    ------
    ValueError
        If the number or `seed` is out of range.
    OSError
        If `out` cannot be written to, or holds anything and is not to be overwritten; found out before
        anything is computed.
    """
    settings = paper.settings
    impacts = whole(paper.size, paper.usual if impacts is None else impacts, paper.least, 2**53)
    seed = whole("seed", seed, 0, 2**64 - 1)
    checked_threads(threads)
    overwrite, progress = flag("overwrite", overwrite), flag("progress", progress)
    folder = path_for("out", out, FOLDER)
    stages = bar(show=progress, total=4, desc="paper", unit="stage")
    check_folder(folder, replace=overwrite)
    names = [f"{figure.name}.{kind}" for figure in paper.figures for kind in ("png", "pdf", "nc", "txt")]
    with stages, whole_folder(folder, replace=overwrite, names=[*names, *PAGES]) as draft:
        with bar(show=progress, total=paper.number, desc="simulations", unit="run", leave=False) as each:
            runs = paper.simulate(settings, impacts, Runner(seed, threads, each.update))
        stages.update()
        drawn = bar(paper.figures, show=progress, desc="figures", unit="figure", leave=False)
        figures = [figure.save(runs, settings, draft) for figure in drawn]
        stages.update()
        claims = paper.claims.judge(runs, settings)
        stages.update()
        html, explorer = PAGES
        (draft / explorer).write_text(page(), encoding="utf-8")
        (draft / html).write_text(report(paper, runs, figures, claims, explorer=explorer), encoding="utf-8")
        stages.update()
    return folder / html
