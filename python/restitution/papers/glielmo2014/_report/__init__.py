"""The report: one HTML file that needs nothing else."""

from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

from restitution.figures.report import section, style, text
from restitution.papers.glielmo2014._claims import Claim
from restitution.papers.glielmo2014._report import _sections as sections
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings

__all__ = ["Figure", "write_report"]


class Figure(Protocol):
    """What the report needs of a figure."""

    @property
    def name(self) -> str:
        """Short name, the anchor."""

    @property
    def title(self) -> str:
        """Heading."""

    @property
    def png(self) -> Path:
        """The picture."""

    @property
    def shows(self) -> str:
        """What can be seen in it, for those who cannot see it."""

    @property
    def caption(self) -> str:
        """What it shows, with all parameters."""

    @property
    def stop(self) -> int:
        """Stop of the explorer's tour that shows it."""


def write_report(
    path: str | Path,
    figures: Sequence[Figure],
    claims: Sequence[Claim],
    runs: Runs,
    settings: Settings,
    *,
    explorer: str = "",
) -> None:
    """Write the redrawn and judged paper as one self-contained HTML file.

    Parameters
    ----------
    path : path
        Where to; an existing file is replaced.
    figures : sequence of Figure
        Figures on disk, embedded in this order.
    claims : sequence of Claim
        From `restitution.papers.glielmo2014._claims.judge`.
    runs : Runs
        The simulations.
    settings : Settings
        What was simulated.
    explorer : str
        Address of the explorer as seen from the report, to which each figure is then linked.

    Raises
    ------
    ValueError
        If a figure is not a PNG file.
    OSError
        If a file cannot be read or written.
    """
    parts = {
        "claims": ("The claims of the paper, checked", sections.summary(claims)),
        "figures": ("The figures, redrawn", sections.figures(figures, explorer)),
        "numbers": ("The numbers behind each verdict", sections.details(claims)),
        "misprints": ("Misprints", sections.misprints()),
        "sensitivity": ("What radius and release height change", sections.sensitivity(runs, settings)),
        "energy": ("Not in the paper: impacts that create energy", sections.energy(runs)),
        "parameters": ("Parameters", sections.parameters(settings)),
        "runs": ("Simulations", sections.simulations(runs)),
        "reproduce": ("How to reproduce this report", sections.reproduce(runs)),
        "cite": ("How to cite", sections.citation(runs)),
    }
    contents = "\n".join(
        f'<li><a href="#{anchor}">{text(title)}</a></li>' for anchor, (title, _) in parts.items()
    )
    body = "\n".join(section(anchor, title, content) for anchor, (title, content) in parts.items())
    Path(path).write_text(
        f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{text(sections.TITLE)}</title>
<style>
{style()}</style>
</head>
<body>
<header id="top">
{sections.heading(claims, runs)}
</header>
<nav aria-label="Contents">
<ol>
{contents}
</ol>
</nav>
<main>
{body}
</main>
<footer>
<p>{text(sections.source(runs))}</p>
</footer>
</body>
</html>
""",
        encoding="utf-8",
    )
