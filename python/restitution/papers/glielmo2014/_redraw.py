"""From nothing to the report: simulate, draw, judge, write, and only then put the files in place."""

import os
from contextlib import suppress
from pathlib import Path

from restitution._internal.arrays import flag, whole
from restitution._internal.files import FOLDER, check_folder, path_for, whole_folder
from restitution._internal.resources import bar, checked_threads
from restitution.explorer import page
from restitution.papers.glielmo2014._claims import judge
from restitution.papers.glielmo2014._figures import FIGURES, draw_all
from restitution.papers.glielmo2014._report import write_report
from restitution.papers.glielmo2014._runs import simulate_all
from restitution.papers.glielmo2014._settings import Settings

PAGES = ("report.html", "explorer.html")


def redraw(
    out: str | os.PathLike[str],
    impacts: int = 100_000_000,
    seed: int = 1,
    threads: int | None = None,
    progress: bool = True,
    *,
    overwrite: bool = False,
) -> Path:
    """Redraw Figs. 2-7 and 9, with two figures of what the paper leaves open, and judge the paper's claims.

    Parameters
    ----------
    out : path
        Folder for the report, the explorer that its figures are linked to, and for each figure its PNG, PDF,
        caption and data; made if it does not exist. Nothing appears there before all is done.
    impacts : int
        Impacts to count for each of Figs. 2-5 and 7 and each curve of Fig. 6, at least 400 000, the number
        in the paper's Fig. 2. At most 4 000 000 of them are recorded, for the claims and the standard errors.
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
        The report, an HTML file that needs no other. Its links to the explorer are left out if the package
        was installed from a checkout where that page was not built.

    Raises
    ------
    ValueError
        If `impacts` or `seed` is out of range.
    OSError
        If `out` cannot be written to, or holds anything and is not to be overwritten; found out before
        anything is computed.
    """
    settings = Settings()
    impacts = whole("impacts", impacts, settings.least_impacts, 2**53)
    seed = whole("seed", seed, 0, 2**64 - 1)
    checked_threads(threads)
    overwrite, progress = flag("overwrite", overwrite), flag("progress", progress)
    folder = path_for("out", out, FOLDER)
    stages = bar(show=progress, total=4, desc="paper", unit="stage")
    check_folder(folder, replace=overwrite)
    names = [f"{figure.name}.{kind}" for figure in FIGURES for kind in ("png", "pdf", "nc", "txt")]
    with stages, whole_folder(folder, replace=overwrite, names=[*names, *PAGES]) as draft:
        runs = simulate_all(settings, impacts, seed, threads, progress)
        stages.update()
        figures = draw_all(runs, settings, draft, progress)
        stages.update()
        claims = judge(runs, settings)
        stages.update()
        report, explorer = PAGES
        with suppress(FileNotFoundError):
            (draft / explorer).write_text(page(), encoding="utf-8")
        linked = explorer if (draft / explorer).exists() else ""
        write_report(draft / report, figures, claims, runs, settings, explorer=linked)
        stages.update()
    return folder / report
