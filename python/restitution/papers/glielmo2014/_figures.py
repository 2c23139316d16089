"""All redrawn figures: what each is made of, and its files."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from restitution import figures as fg
from restitution._internal.resources import bar
from restitution.papers.glielmo2014 import _captions as captions
from restitution.papers.glielmo2014 import _data as data
from restitution.papers.glielmo2014 import _drawings as drawings
from restitution.papers.glielmo2014._runs import Runs
from restitution.papers.glielmo2014._settings import Settings


@dataclass(frozen=True)
class SavedFigure:
    """A figure on disk: name, title, what can be seen, files, caption, and where the explorer shows it."""

    name: str
    title: str
    shows: str
    png: Path
    pdf: Path
    data: Path
    caption: str
    stop: int


@dataclass(frozen=True)
class PaperFigure:
    """How one figure comes about: reduce the runs, draw what is left, say what it is."""

    name: str
    title: str
    shows: str  # for those who cannot see it
    reduce: Callable[[Runs, Settings], xr.Dataset]
    draw: Callable[[xr.Dataset], Figure]
    caption: Callable[[xr.Dataset, Settings], str]
    stop: int  # of the explorer's tour, where such a figure fills up

    def save(self, runs: Runs, settings: Settings, folder: Path) -> SavedFigure:
        """Write the figure (``name.png``, ``name.pdf``), its caption (``.txt``) and its data (``.nc``)."""
        drawn = self.reduce(runs, settings)
        caption = self.caption(drawn, settings)
        png, pdf = fg.save(self.draw(drawn), folder / self.name, self.title, caption)
        png.with_suffix(".txt").write_text(caption + "\n", encoding="utf-8")
        nc = png.with_suffix(".nc")
        packed = {str(name): {"zlib": True} for name, value in drawn.variables.items() if value.ndim > 0}
        drawn.assign_attrs(title=self.title, caption=caption).to_netcdf(nc, engine="netcdf4", encoding=packed)
        return SavedFigure(self.name, self.title, self.shows, png, pdf, nc, caption, self.stop)


def draw_all(runs: Runs, settings: Settings, folder: Path, progress: bool) -> list[SavedFigure]:
    """Draw and save every figure into the existing `folder`, in the paper's order."""
    figures = bar(FIGURES, show=progress, desc="figures", unit="figure", leave=False)
    return [figure.save(runs, settings, folder) for figure in figures]


FIGURES = (
    PaperFigure(
        "figure-2",
        "Fig. 2: restitution against impact velocity",
        "Map of ε against impact velocity. At the velocity of the first impacts all ε lie close below "
        "0.98; towards lower velocities they fan out on both sides of it, to between 0.6 and 1.4 and "
        "beyond.",
        data.restitution_map,
        drawings.restitution_map,
        captions.restitution_map,
        stop=2,
    ),
    PaperFigure(
        "figure-3",
        "Fig. 3: rotational energy against impact velocity",
        "Map of the rotational share of the energy against impact velocity. It is close to 0 at the "
        "velocity of the first impacts; towards lower velocities it spreads over a growing range, up "
        "to about 0.3.",
        data.fraction_map,
        drawings.fraction_map,
        captions.fraction_map,
        stop=4,
    ),
    PaperFigure(
        "figure-4",
        "Fig. 4: histograms of restitution",
        "Four histograms of ε on a logarithmic axis, with asymmetric Laplace densities. At 0.8, 0.4 "
        "and 0.2 m/s each is a peak at 0.98 with nearly straight flanks, narrower at higher velocity; "
        "at 0.1 m/s the histogram is broad, with shoulders, and leaves the straight lines.",
        data.restitution_histograms,
        drawings.restitution_histograms,
        captions.restitution_histograms,
        stop=5,
    ),
    PaperFigure(
        "figure-5",
        "Fig. 5: histograms of the rotational energy",
        "Densities of the rotational share of the energy at four velocities, on a logarithmic axis. "
        "At 0.8 m/s the density falls steeply from 0 to 0.08; at lower velocities it reaches farther "
        "and is flatter; at 0.2 and 0.1 m/s it rises again towards its upper end near 0.28.",
        data.fraction_histograms,
        drawings.fraction_histograms,
        captions.fraction_histograms,
        stop=4,
    ),
    PaperFigure(
        "figure-6",
        "Fig. 6: standard deviation of restitution",
        "Standard deviation of ε against impact velocity for L/R = 0.01 and 0.02, both axes "
        "logarithmic: it falls as the velocity grows, faster near the velocity of the first impacts, "
        "and is larger for 0.02.",
        data.bead_deviation,
        drawings.bead_deviation,
        captions.bead_deviation,
        stop=6,
    ),
    PaperFigure(
        "figure-7",
        "Fig. 7: negative restitution",
        "Map of ε from −3 to 4 at velocities below 0.1 m/s. The slower the impact, the wider the "
        "range of ε. It reaches below 0 at velocities below 0.02 m/s; at negative velocities all ε "
        "are below −1.",
        data.low_velocity_map,
        drawings.low_velocity_map,
        captions.low_velocity_map,
        stop=7,
    ),
    PaperFigure(
        "figure-9",
        "Fig. 9: first impact from rest",
        "Density of ε at the first impact, a curve that falls from −0.01 to 0.15 and rises steeply "
        "towards 0.4: simulated points lie on the corrected Eq. 21 and well above Eq. 21 as printed. "
        "Below, the differences between simulation and corrected equation scatter about 0 by a few "
        "standard errors.",
        data.first_impact,
        drawings.first_impact,
        captions.first_impact,
        stop=8,
    ),
    PaperFigure(
        "figure-2-sensitivity",
        "Fig. 2 for other radii and release heights",
        "Median and outer quantiles of ε against impact velocity, in two panels: for three radii and "
        "for three release heights. The medians nearly agree; the quantiles of the radii differ at "
        "low velocity, and those of the heights differ at all velocities, wider for higher releases.",
        data.map_sensitivity,
        drawings.map_sensitivity,
        captions.map_sensitivity,
        stop=2,
    ),
    PaperFigure(
        "figure-6-sensitivity",
        "Fig. 6 for other radii and release heights",
        "Standard deviation of ε against impact velocity, both axes logarithmic, in two panels. The "
        "curves for three radii lie close together; those for three release heights lie well apart, "
        "higher for higher releases.",
        data.deviation_sensitivity,
        drawings.deviation_sensitivity,
        captions.deviation_sensitivity,
        stop=6,
    ),
)
