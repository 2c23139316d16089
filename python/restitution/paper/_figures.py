"""All redrawn figures: what each is made of, and its files."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure
from tqdm import tqdm

from restitution import figures as fg
from restitution.paper import _captions as captions
from restitution.paper import _data as data
from restitution.paper import _drawings as drawings
from restitution.paper._runs import Runs
from restitution.paper._settings import Settings


@dataclass(frozen=True)
class SavedFigure:
    """A figure on disk: its short name, its title, its files and its caption."""

    name: str
    title: str
    png: Path
    pdf: Path
    data: Path
    caption: str


@dataclass(frozen=True)
class PaperFigure:
    """How one figure comes about: reduce the runs, draw what is left, say what it is."""

    name: str
    title: str
    reduce: Callable[[Runs, Settings], xr.Dataset]
    draw: Callable[[xr.Dataset], Figure]
    caption: Callable[[xr.Dataset, Settings], str]

    def save(self, runs: Runs, settings: Settings, folder: Path) -> SavedFigure:
        """Write the figure (``name.png``, ``name.pdf``), its caption (``.txt``) and its data (``.nc``)."""
        drawn = self.reduce(runs, settings)
        caption = self.caption(drawn, settings)
        png, pdf = fg.save(self.draw(drawn), folder / self.name, self.title, caption)
        png.with_suffix(".txt").write_text(caption + "\n", encoding="utf-8")
        nc = png.with_suffix(".nc")
        packed = {str(name): {"zlib": True} for name, value in drawn.variables.items() if value.ndim > 0}
        drawn.assign_attrs(title=self.title, caption=caption).to_netcdf(nc, engine="netcdf4", encoding=packed)
        return SavedFigure(self.name, self.title, png, pdf, nc, caption)


def draw_all(runs: Runs, settings: Settings, folder: Path, progress: bool) -> list[SavedFigure]:
    """Draw and save every figure into the existing `folder`, in the paper's order."""
    bar = tqdm(FIGURES, desc="figures", unit="figure", leave=False, disable=not progress)
    return [figure.save(runs, settings, folder) for figure in bar]


FIGURES = (
    PaperFigure(
        "figure-2",
        "Fig. 2: restitution against impact velocity",
        data.restitution_map,
        drawings.restitution_map,
        captions.restitution_map,
    ),
    PaperFigure(
        "figure-3",
        "Fig. 3: rotational energy against impact velocity",
        data.fraction_map,
        drawings.fraction_map,
        captions.fraction_map,
    ),
    PaperFigure(
        "figure-4",
        "Fig. 4: histograms of restitution",
        data.restitution_histograms,
        drawings.restitution_histograms,
        captions.restitution_histograms,
    ),
    PaperFigure(
        "figure-5",
        "Fig. 5: histograms of the rotational energy",
        data.fraction_histograms,
        drawings.fraction_histograms,
        captions.fraction_histograms,
    ),
    PaperFigure(
        "figure-6",
        "Fig. 6: standard deviation of restitution",
        data.bead_deviation,
        drawings.bead_deviation,
        captions.bead_deviation,
    ),
    PaperFigure(
        "figure-7",
        "Fig. 7: negative restitution",
        data.low_velocity_map,
        drawings.low_velocity_map,
        captions.low_velocity_map,
    ),
    PaperFigure(
        "figure-9",
        "Fig. 9: first impact from rest",
        data.first_impact,
        drawings.first_impact,
        captions.first_impact,
    ),
    PaperFigure(
        "figure-2-sensitivity",
        "Fig. 2 for other radii and release heights",
        data.map_sensitivity,
        drawings.map_sensitivity,
        captions.map_sensitivity,
    ),
    PaperFigure(
        "figure-6-sensitivity",
        "Fig. 6 for other radii and release heights",
        data.deviation_sensitivity,
        drawings.deviation_sensitivity,
        captions.deviation_sensitivity,
    ),
)
