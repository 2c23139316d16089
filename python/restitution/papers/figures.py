"""The figures of a redrawn paper: what each is made of, its files, and its caption with every parameter."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Generic, NamedTuple

import xarray as xr
from matplotlib.figure import Figure

from restitution.figures.report import grouped, save_with_data
from restitution.figures.style import Style, styled
from restitution.papers.claims import R, S
from restitution.papers.runs import impacts_of


class Caption(NamedTuple):
    """Caption of a figure, with the parameters that the paper states and those that we chose."""

    text: str
    paper: list[str]
    ours: list[str]
    each: str = ""  # what every one of several runs is for, such as "for each curve"
    recorded: str = "the standard errors"  # what impacts are recorded for where others are counted

    def parameters(self, about: dict[str, Any]) -> str:
        """Write whose each parameter is, and the run, from attributes as of `recorded` or `counted`."""
        paper = f"Stated in the paper: {'; '.join(self.paper)}. " if self.paper else ""
        run = f"{self.run(about)}; restitution {about['version']}"
        return f"{paper}Our choice: {'; '.join(self.ours)}. Run: {run}."

    def run(self, about: dict[str, Any]) -> str:
        """Write the numbers of particles and impacts, and the seeds."""
        each = f" {self.each}" if self.each else ""
        impacts = about["impacts_counted" if "impacts_counted" in about else "impacts_recorded"]
        most = about["impacts"]
        run = (
            f"{grouped(about['particles'])} particles{each}, each followed for at most "
            f"{grouped(most)} impact{'s' if most > 1 else ''} (ours), {grouped(impacts)} in all"
        )
        if about.get("impacts_recorded", impacts) < impacts:
            run += (
                f"; recorded, for {self.recorded}, the first {grouped(about['particles_recorded'])} "
                f"particles{each}, {grouped(about['impacts_recorded'])} impacts in all"
            )
        seeds = ", ".join(map(str, about["seeds"]))
        order = "seed " + seeds if len(about["seeds"]) == 1 else f"seeds {seeds} in the order of the legend"
        return f"{run}; {order}"


def recorded(*runs: xr.Dataset) -> dict[str, Any]:
    """Return attributes for a caption: what all runs have in common, their seeds, and what was recorded."""
    common = {
        name: value
        for name, value in runs[0].attrs.items()
        if name not in ("seed", "run") and all(run.attrs[name] == value for run in runs)
    }
    return {
        **common,
        "seeds": [int(run.attrs["seed"]) for run in runs],
        "particles_recorded": runs[0].sizes["particle"],
        "impacts_recorded": sum(map(impacts_of, runs)),
    }


def counted(*ensembles: xr.Dataset) -> dict[str, Any]:
    """Return attributes for a caption: seeds, particles (of each) and counted impacts (of all)."""
    return {
        "seeds": [int(found.attrs["seed"]) for found in ensembles],
        "particles": ensembles[0].attrs["particles"],
        "impacts_counted": sum(map(impacts_of, ensembles)),
    }


def listing(values: Iterable[float], factor: float = 1.0) -> str:
    """Write numbers as a sentence lists them, each times a factor."""
    *most, last = (f"{factor * value:g}" for value in values)
    return f"{', '.join(most)} and {last}" if most else last


@dataclass(frozen=True)
class PaperFigure(Generic[R, S]):
    """Steps that make one figure: reduce the runs, draw the reduced data, write the caption."""

    name: str
    title: str
    pictured: str  # what is drawn, for those who cannot see it
    shows: str  # what there is to see
    reduce: Callable[[R, S], xr.Dataset]  # with the attributes of `recorded` or `counted`
    panels: Callable[[xr.Dataset], Figure]  # of the reduced data
    caption: Callable[[xr.Dataset, S], Caption]
    stop: int | None = None  # of the explorer's tour, where such a figure fills up

    @styled
    def draw(self, drawn: xr.Dataset, *, style: Style | None = None) -> Figure:
        """Draw the reduced data; `style` as in `restitution.figures`."""
        return self.panels(drawn)

    def save(self, runs: R, settings: S, folder: Path) -> "SavedFigure":
        """Write the figure (``name.png``, ``name.pdf``), its caption (``.txt``) and its data (``.nc``)."""
        drawn = self.reduce(runs, settings)
        caption = self.caption(drawn, settings)
        path = (folder / self.name).with_suffix(".png")
        saved = SavedFigure(self, path, caption.text, caption.parameters(drawn.attrs))
        save_with_data(self.draw(drawn), drawn, folder / self.name, self.title, saved.caption)
        return saved


@dataclass(frozen=True)
class SavedFigure:
    """A figure on disk, and the two parts of its caption."""

    of: PaperFigure[Any, Any]
    png: Path
    text: str
    parameters: str

    @property
    def caption(self) -> str:
        """The whole of it, as in the files."""
        return f"{self.text} {self.parameters}"
