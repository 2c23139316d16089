"""Figure of a learned distribution: quantiles over impact velocity, densities, confidence bands."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from matplotlib.ticker import FixedLocator, NullFormatter, StrMethodFormatter

from restitution.distribution._store import in_gaps
from restitution.distribution._table import Floats
from restitution.distribution._tabulated import TabulatedDistribution
from restitution.figures import pieces
from restitution.figures import style as fg

_LEVELS = (0.05, 0.25, 0.5, 0.75, 0.95)
_CONFIDENCE = 1.96
"""Standard errors to either side of a band that holds the truth with probability 0.95."""


def _ticks(low: float, high: float) -> list[float]:
    """Return round numbers for a logarithmic axis and a little beyond: more of them where it is short."""
    steps = (1, 2, 3, 4, 6) if high < 10.0 * low else (1, 2, 5) if high < 1000.0 * low else (1,)
    ticks = (step * 10.0**power for power in range(-9, 7) for step in steps)
    return [tick for tick in ticks if 0.1 * low < tick < 10.0 * high]


@fg.styled
def draw(dist: TabulatedDistribution, *, style: fg.Style | None = None) -> Figure:
    """Draw quantiles, densities at four speeds, standard deviation and distance to fresh impacts.

    Shaded are pointwise 95 % confidence bands: 1.96 standard errors, over batches of particles, either way.
    """
    rows = 2 if dist.given is None else 3
    figure, [[quantiles, densities], [deviation, distance], *conditional] = fg.panels(
        fg.PAGE, 2.5 * rows, rows, 2
    )
    speeds = dist.data["velocity"].to_numpy()
    _quantiles(quantiles, dist)
    met = np.geomspace(speeds[0], speeds[-1], 251)
    met = met[~in_gaps(dist.data, met)]
    for k in range(4):
        _density(densities, dist, float(met[(k + 1) * (met.size - 1) // 5]), fg.colors()[k])
    densities.set_yscale("log")
    densities.set_xlabel(fg.RESTITUTION)
    densities.set_ylabel(r"$p(\varepsilon\,|\,v)$")
    # What all but touches ε = -1, where chattering bodies are, may leave the panel at the top.
    middle = max(0.5 / np.ptp(dist.clamped().ppf([0.25, 0.75], v)) for v in speeds)
    densities.set_ylim(top=min(densities.get_ylim()[1], 100.0 * middle))
    low, high = densities.get_xlim()
    densities.set_xlim(low - 0.1 * (high - low), high + 0.25 * (high - low))  # for the letter, the legend
    densities.legend(title="$v$ (m/s)", loc="upper right")
    v, known = _shown(dist)
    sigma = known * dist.clamped().std(v)
    band = _CONFIDENCE * dist.clamped().std_error(v) if dist.has_errors else np.zeros_like(sigma)
    (drawn,) = deviation.plot(v, sigma, label=r"$\sigma(\varepsilon)$")
    below = np.where(band < sigma, sigma - band, sigma)
    deviation.fill_between(v, below, sigma + band, color=drawn.get_color(), alpha=0.3, linewidth=0)
    if dist.has_errors:
        patch = Patch(color=drawn.get_color(), alpha=0.3, linewidth=0, label="95 % band")
        deviation.legend(handles=[drawn, patch], loc="lower left")
    deviation.set_yscale("log")
    low, high = deviation.get_ylim()
    deviation.yaxis.set_major_locator(FixedLocator(_ticks(low, high)))
    deviation.yaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
    deviation.yaxis.set_minor_formatter(NullFormatter())
    deviation.set_ylim(low, high)
    deviation.set_ylabel(r"standard deviation $\sigma(\varepsilon)$")
    if "ks_distance" in dist.data:
        distance.stairs(dist.data["ks_distance"].to_numpy(), speeds, baseline=None, label="fresh impacts")
        scatter = dist.data["ks_scatter"].to_numpy()
        distance.stairs(scatter, speeds, baseline=None, linestyle="--", label="their own scatter")
        distance.set_ylim(0.0, 1.3 * distance.get_ylim()[1])
        distance.legend(loc="upper left")
    distance.set_ylabel("Kolmogorov–Smirnov distance")
    for axes, name in ((quantiles, "a"), (densities, "b"), (deviation, "c"), (distance, "d")):
        fg.letter(axes, f"({name})", left=axes in (quantiles, densities))
        if axes is not densities:
            axes.set_xlabel(fg.VELOCITY)
            pieces.plain_log(axes, _ticks(speeds[0], speeds[-1]))
            axes.set_xlim(speeds[0], speeds[-1])
    for row in conditional:
        _given(row, dist)
    return figure


def _shown(dist: TabulatedDistribution) -> tuple[Floats, Floats]:
    """Return the speeds of a curve, and 1 for each, NaN in gaps, where the curve is interrupted."""
    inside = dist.gaps.mean(axis=1)
    v = np.unique(np.concatenate([dist.data["velocity"].to_numpy(), dist.gaps.ravel(), inside]))
    return v, np.where(in_gaps(dist.data, v), np.nan, 1.0)


def _given(row: list[Axes], dist: TabulatedDistribution) -> None:
    """Draw the middle half of ε at a small, a middle and a great condition, over v and over ε at one v."""
    names = {
        "rotational_fraction": r"$E_\mathrm{rot}/E_\mathrm{tot}$",
        "previous": "level of the last impact",
    }
    speeds = dist.data["velocity"].to_numpy()
    middle = float(np.sqrt(speeds[0] * speeds[-1]))
    first = np.concatenate([[0], np.cumsum(dist.data["given_components"].to_numpy())])
    conditions = dist.data["given"].to_numpy()
    near = int(np.argmin(np.abs(speeds - middle)))
    there = conditions[first[near] : first[near + 1]]
    for k, z in enumerate((there[0], there[there.size // 2], there[-1])):
        seen = (speeds >= 0) & (dist.data["given_lowest"] <= z) & (z <= dist.data["given_highest"]).to_numpy()
        seen = seen & ~in_gaps(dist.data, speeds)
        v = speeds[seen.to_numpy()]
        low, half, high = (dist.ppf(q, v, given=z) for q in (0.25, 0.5, 0.75))
        label = f"{z:.2g}"
        (drawn,) = row[0].plot(v, half, color=fg.colors()[k], label=label)
        row[0].fill_between(v, low, high, color=drawn.get_color(), alpha=0.2, linewidth=0)
        ends = dist.ppf([1e-3, 1.0 - 1e-3], speeds[near], given=z)
        x = np.linspace(ends[0], ends[1], 300)
        density = dist.pdf(x, speeds[near], given=z)
        row[1].plot(
            x,
            np.where(density > 0, density, np.nan),
            color=fg.colors()[k],
            label=label,
            linewidth=fg.points(0.7),
        )
    row[0].set_xlabel(fg.VELOCITY)
    row[0].set_ylabel(fg.RESTITUTION)
    pieces.plain_log(row[0], _ticks(speeds[0], speeds[-1]))
    row[0].set_xlim(speeds[0], speeds[-1])
    row[1].set_xlabel(fg.RESTITUTION)
    row[1].set_ylabel(rf"$p(\varepsilon\,|\,v, z)$ at {speeds[near]:.3g} m/s")
    row[1].set_yscale("log")
    for axes, name in zip(row, "ef", strict=True):
        low, high = axes.get_ylim()
        axes.set_ylim(top=high * 10 if axes is row[1] else high + 0.35 * (high - low))
        axes.legend(title=f"given {names[str(dist.given)]}", loc="upper right", ncols=3)
        fg.letter(axes, f"({name})")


def _quantiles(axes: Axes, dist: TabulatedDistribution) -> None:
    v, known = _shown(dist)
    for q in _LEVELS:
        x = known * dist.clamped().ppf(q, v)
        (drawn,) = axes.plot(v, x, label=f"{100 * q:g} %")
        if dist.has_errors:
            band = _CONFIDENCE * dist.clamped().ppf_error(q, v)
            axes.fill_between(v, x - band, x + band, color=drawn.get_color(), alpha=0.3, linewidth=0)
    axes.set_ylabel(fg.RESTITUTION)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.45 * (high - low))  # room for the panel's letter and the legend
    axes.legend(loc="upper right", ncols=3, title="quantiles" + (", 95 % bands" if dist.has_errors else ""))


def _density(axes: Axes, dist: TabulatedDistribution, v: float, color: str) -> None:
    low, high = dist.ppf([1e-4, 1.0 - 1e-4], v)
    x = np.linspace(low, high, 400)
    density = np.where(dist.pdf(x, v) > 0, dist.pdf(x, v), np.nan)
    axes.plot(x, density, color=color, label=f"{v:.2g}", linewidth=fg.points(0.7))
    if not dist.has_errors:
        return
    band = _CONFIDENCE * dist.pdf_error(x, v)
    below = np.where(band < density, density - band, density)  # a logarithmic axis has no room for zero
    axes.fill_between(x, below, density + band, color=color, alpha=0.3, linewidth=0, step="mid")
