"""Measure the flanks of p(ε | v), where their form ends, and why: docs/images/fits.png and its table.

Run ``python examples/fits.py OUT`` to write ``fits.png``, ``fits-dark.png``, ``fits.txt`` (the caption) and
``fits.md`` (the tables of docs/fits.md) into the folder OUT. A second argument is the number of particles,
4000 unless given: less than a minute on two cores.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

import restitution as rs
from restitution import figures as fg
from restitution import fit
from restitution.figures.style import SITE, Style, colors, ink

RADIUS, ELONGATION, NORMAL, HEIGHT, GRAVITY = 3e-3, 0.1, 0.98, 0.06, 9.81
RELEASE_SPEED = float(np.sqrt(2 * GRAVITY * (HEIGHT - RADIUS - ELONGATION * RADIUS / np.pi)))
"""Of the first impact: the mean of |cos θ| over a uniform angle is 2/π."""
EDGES = np.geomspace(0.03, 1.04, 91)
"""Velocity bins in m/s, each as wide as two impacts at ε = 0.98; narrower ones tell early impacts apart."""
GROWTH = (0.27, 0.9)
"""Range of the growth law in m/s: from where the form holds to the eighth impact or so."""
SPEEDS = {0.4: (0.38, 0.42), 0.1: (0.095, 0.105)}
"""Speeds of the histograms and of the table of families, with their windows, in m/s."""
HIGHEST = 0.9
"""Speed in m/s up to which the distance of the fit is judged: the first impacts have their own density."""
RETURNED = 0.7
"""An impact at v is of a particle that has returned if an earlier one was slower than this times v."""
BODIES = (0.01, 0.02, 0.1, 0.5, 2.0)
"""L/R of the bodies of the paper, and one between."""
REPEATED = (0.1, 0.28, 0.4)
"""Speeds in m/s at which the fit is repeated with other ensembles."""
SHOWN = (0.04, 0.06, 0.08, 0.1, 0.12, 0.15, 0.18, 0.21, 0.24, 0.26, 0.28, 0.4, 0.6, 0.8)
"""Speeds of the rows of the table in m/s: of each the velocity bin nearest to it."""
FAMILIES: dict[str, Callable[..., fit.Fit]] = {
    "asymmetric Laplace": partial(fit.asymmetric_laplace, location=NORMAL),
    "asymmetric power": partial(fit.asymmetric_power, location=NORMAL),
    "cusp mixture": partial(fit.cusp_mixture, location=NORMAL),
    "symmetric Laplace": fit.laplace,
    "Gaussian": fit.gaussian,
}


@dataclass(frozen=True)
class Measured:
    """The contents of the figure and the tables."""

    particles: int
    judged: int  # of them, behind the table of families and its p-values
    impacts: int
    slopes: fit.Slopes
    dependence: xr.Dataset
    parts: dict[str, tuple[fit.Slopes, xr.Dataset]]  # on the way down, returned: bins twice as wide
    samples: dict[float, np.ndarray[Any, np.dtype[np.float64]]]
    boots: dict[float, dict[str, fit.Bootstrap]]
    goodness: dict[float, dict[str, fit.Goodness]]

    @property
    def end(self) -> float:
        """Speed below which the form fails, in m/s."""
        return self.slopes.fails_below(high=HIGHEST)

    @property
    def end_down(self) -> float:
        """Speed below which it fails for particles on the way down, in m/s."""
        return self.parts["down"][0].fails_below(high=HIGHEST)

    def law(self, side: str, *, reservoir: bool = True) -> fit.PowerLaw:
        """Growth in √(v₀²/v² − 1), or in v."""
        return self.slopes.power_law(side, *GROWTH, release_speed=RELEASE_SPEED if reservoir else None)


def drop(particles: int, seed: int, elongation: float = ELONGATION, slowest: float = 0.0) -> xr.Dataset:
    """Drop the particles of the paper's Fig. 2, or dumbbells of another L/R."""
    return rs.simulate(
        rs.Dumbbell(radius=RADIUS, separation=elongation * RADIUS),
        rs.TangentialRestitution(normal=NORMAL),
        particles=particles,
        impacts=1200,
        release_height=HEIGHT,
        gravity=GRAVITY,
        minimum_speed=slowest,
        seed=seed,
    )


def catalogue(particles: int = 4000, seed: int = 1) -> str:
    """Fit a and b as functions of v for the bodies of the paper, and write the table of docs/fits.md."""
    head = "| L/R | a: 10³ A | p | scatter | b: 10³ A | p | scatter | largest D |"
    lines = [head, "|---" * 8 + "|"]
    for elongation in BODIES:
        data = drop(particles, seed, elongation, slowest=0.8 * GROWTH[0])
        found = fit.slopes(data, np.geomspace(*GROWTH, 17), location=NORMAL, resamples=49, seed=seed)
        fastest = float(data.impact_velocity[:, 0].mean())
        cells = []
        for side in ("above", "below"):
            law = found.power_law(side, release_speed=fastest)
            cells += [
                f"{1e3 * law.amplitude:.3f} ± {1e3 * law.amplitude_error:.3f}",
                f"{law.exponent:.3f} ± {law.exponent_error:.3f}",
                f"{100 * law.scatter:.1f} %",
            ]
        distance = float(found.table["ks_distance"].max())
        lines.append(f"| {elongation:g} | {' | '.join(cells)} | {distance:.3f} |")
    return "\n".join(lines)


def repeat(particles: int = 4000, ensembles: int = 14) -> str:
    """Fit a and b at some speeds to one ensemble after another, and write the table of docs/fits.md."""
    found: dict[float, list[list[float]]] = {v: [] for v in REPEATED}
    for seed in range(2, 2 + ensembles):
        data = drop(particles, seed)
        for v, values in found.items():
            k = int(np.searchsorted(EDGES, v)) - 1
            one = fit.asymmetric_laplace(data, location=NORMAL, velocity=(EDGES[k], EDGES[k + 1]))
            values.append([one.parameters["above"], one.parameters["below"]])
    lines = ["| v (m/s) | a: mean | of one | b: mean | of one | ensembles |", "|---" * 6 + "|"]
    for v, values in found.items():
        k = int(np.searchsorted(EDGES, v)) - 1
        mean, single = np.mean(values, axis=0), np.std(values, axis=0, ddof=1)
        pairs = zip(mean, single / np.sqrt(ensembles), single, strict=True)
        cells = [cell for m, e, s in pairs for cell in (f"{m:.4f} ± {e:.4f}", f"± {s:.4f}")]
        lines.append(f"| {EDGES[k]:.4f} to {EDGES[k + 1]:.4f} | {' | '.join(cells)} | {ensembles} |")
    return "\n".join(lines)


def measure(
    particles: int = 4000,
    *,
    judged: int = 1000,
    resamples: int = 99,
    seed: int = 1,
) -> Measured:
    """Drop the particles of the paper's Fig. 2 and fit."""
    data = drop(particles, seed)
    some = data.isel(particle=slice(judged))
    slow: dict[str, Any] = {"resamples": resamples // 2, "seed": seed}
    velocity, restitution = data.impact_velocity.to_numpy(), data.restitution.to_numpy()
    slowest = np.minimum.accumulate(np.where(np.isfinite(velocity), velocity, np.inf), axis=1)
    before = np.hstack([np.full((particles, 1), np.inf), slowest[:, :-1]])
    down = xr.DataArray(before >= RETURNED * velocity, dims=data.impact_velocity.dims)
    parts = {
        name: data.assign(restitution=data.restitution.where(chosen))
        for name, chosen in (("down", down), ("returned", ~down))
    }
    return Measured(
        particles=particles,
        judged=judged,
        impacts=int(data.impacts.sum()),
        slopes=fit.slopes(data, EDGES, location=NORMAL, resamples=resamples, seed=seed),
        dependence=fit.dependence(data, EDGES, lags=3),
        parts={
            name: (
                fit.slopes(part, EDGES[::2], location=NORMAL, resamples=2),
                fit.dependence(part, EDGES[::2], lags=1),
            )
            for name, part in parts.items()
        },
        samples={v: restitution[(velocity >= w[0]) & (velocity < w[1])] for v, w in SPEEDS.items()},
        boots={
            v: {name: fit.bootstrap(family, some, velocity=w, **slow) for name, family in FAMILIES.items()}
            for v, w in SPEEDS.items()
        },
        goodness={
            v: {name: fit.goodness(family, some, velocity=w, **slow) for name, family in FAMILIES.items()}
            for v, w in SPEEDS.items()
        },
    )


def tables(found: Measured) -> str:
    """Write the tables of docs/fits.md."""
    lines = ["| flank | law | exponent | amplitude | scatter |", "|---|---|---|---|---|"]
    for side in ("above", "below"):
        for text, reservoir in (("√(v₀²/v² − 1)", True), ("v/(1 m/s)", False)):
            law = found.law(side, reservoir=reservoir)
            lines.append(
                f"| {side} | power of {text} | {law.exponent:.3f} ± {law.exponent_error:.3f} "
                f"| {law.amplitude:.5f} ± {law.amplitude_error:.5f} | {100 * law.scatter:.1f} % |"
            )
    head = "| v (m/s) | a | b | D | lag 1 | lag 2 | alternation | run | impacts |"
    lines += ["", head, "|---" * 9 + "|"]
    for v in SHOWN:
        one = found.slopes.table.sel(velocity=v, method="nearest")
        near = found.dependence.sel(velocity=v, method="nearest")
        lags = [(float(near.autocorrelation[k]), float(near.autocorrelation_error[k])) for k in (0, 1)]
        cells = [
            *(f"{float(one[side]):.4f} ± {float(one[f'{side}_error']):.4f}" for side in ("above", "below")),
            f"{float(one.ks_distance):.3f}",
            *(f"{value:.3f} ± {error:.3f}" for value, error in lags),
            f"{float(near.alternation):.3f} ± {float(near.alternation_error):.3f}",
            f"{float(near.run):.2f} ± {float(near.run_error):.2f}",
            f"{int(one.samples)}",
        ]
        lines.append(f"| {float(one.velocity):.3f} | " + " | ".join(cells) + " |")
    head = "| v (m/s) | share returned | D, down | D, returned | alternation, down | alternation, returned |"
    lines += ["", head, "|---" * 6 + "|"]
    for v in SHOWN[1:12]:
        slopes, pairs = zip(*(found.parts[name] for name in ("down", "returned")), strict=True)
        near = [one.table.sel(velocity=v, method="nearest") for one in slopes]
        other = [one.sel(velocity=v, method="nearest") for one in pairs]
        share = float(near[1].samples) / float(near[0].samples + near[1].samples)
        cells = [f"{share:.2f}", *(f"{float(one.ks_distance):.3f}" for one in near)]
        cells += [f"{float(one.alternation):.3f} ± {float(one.alternation_error):.3f}" for one in other]
        lines.append(f"| {float(near[0].velocity):.3f} | " + " | ".join(cells) + " |")
    lines += ["", "| v (m/s) | family | ΔAIC | ΔBIC | D | p (D) | p (A²) | tr J H⁻¹ (k) |", "|---" * 8 + "|"]
    for v, boots in found.boots.items():
        best = [min(getattr(boot, what) for boot in boots.values()) for what in ("aic", "bic")]
        for name, boot in boots.items():
            good = found.goodness[v][name]
            lines.append(
                f"| {v:g} | {name} | {boot.aic - best[0]:.0f} | {boot.bic - best[1]:.0f} "
                f"| {good.kolmogorov_smirnov:.3f} | {good.kolmogorov_smirnov_p:.2f} "
                f"| {good.anderson_darling_p:.2f} "
                f"| {boot.effective_parameters:.1f} ({boot.fit.free_parameters}) |"
            )
    return "\n".join(lines) + "\n"


@fg.styled
def draw(found: Measured, *, style: Style | None = None) -> Figure:
    """Draw the six panels."""
    figure, ((flanks, law, fast), (distance, dependence, slow)) = fg.panels(fg.PAGE, 4.5, 2, 3)
    v = found.slopes.table["velocity"].to_numpy()
    x = np.sqrt(np.maximum((RELEASE_SPEED / v) ** 2 - 1.0, 0.0))
    fitted = (v >= GROWTH[0]) & (v <= GROWTH[1])
    for side, symbol, color, marker in (("above", "a", colors()[1], "o"), ("below", "b", colors()[0], "s")):
        y = found.slopes.table[side].to_numpy()
        low, high = np.quantile(found.slopes.resampled[side].to_numpy(), [0.025, 0.975], axis=0)
        power = found.law(side)
        for axes, abscissa in ((flanks, v), (law, x)):
            axes.fill_between(abscissa, low, high, color=color, alpha=0.35, linewidth=0)
            every = slice(None, None, 3)
            axes.plot(abscissa[every], y[every], marker, color=color, markersize=2.2, label=f"${symbol}$")
        flanks.plot(v, power.amplitude * x**power.exponent, color=color, linewidth=0.7, linestyle="--")
        text = rf"${symbol}\propto x^{{{power.exponent:.2f}\pm{power.exponent_error:.2f}}}$"
        law.plot(x[fitted], power.amplitude * x[fitted] ** power.exponent, color=color, label=text)
    for axes in (flanks, law):
        axes.set_yscale("log")
        axes.set_ylim(1.5e-3, 0.6)
    flanks.set_ylabel("decay lengths $a$, $b$")
    flanks.legend(loc="lower left")
    law.set_xscale("log")
    law.set_xlim(0.25, 40)
    law.set_xlabel(r"$x=(v_0^2/v^2-1)^{1/2}$")
    law.legend(handles=law.lines[1::2], loc="lower right")
    _distance(distance, found, v)
    _dependence(dependence, found, v)
    for axes in (flanks, distance, dependence):
        fg.plain_log(axes, (0.03, 0.1, 0.3, 1.0))
        axes.set_xlim(0.03, 1.06)
        axes.axvspan(0.03, found.end, color=ink(0.1), linewidth=0)
        axes.set_xlabel("impact velocity $v$ (m/s)")
    law.axvspan(float(np.sqrt((RELEASE_SPEED / found.end) ** 2 - 1)), 40, color=ink(0.1), linewidth=0)
    for axes, speed in ((fast, 0.4), (slow, 0.1)):
        _density(axes, found, speed)
    for axes, text in zip((flanks, law, fast, distance, dependence, slow), "abcdef", strict=True):
        fg.letter(axes, f"({text})", left=axes is not flanks)
    return figure


_PARTS = (("down", "on the way down", 0, "--"), ("returned", "returned", 1, "-."))


def _distance(axes: Axes, found: Measured, v: np.ndarray[Any, np.dtype[np.float64]]) -> None:
    axes.plot(v, found.slopes.table["ks_distance"], color=colors()[2], label="all impacts")
    for part, label, color, style in _PARTS:
        table = found.parts[part][0].table
        axes.plot(
            table["velocity"], table["ks_distance"], color=colors()[color], linestyle=style, label=label
        )
    axes.axhline(0.03, color="0.4", linewidth=0.7, linestyle=":")
    axes.set_ylim(-0.02, 0.32)
    axes.set_ylabel("distance $D$ of the fit")
    axes.legend(loc="upper right")


def _dependence(axes: Axes, found: Measured, v: np.ndarray[Any, np.dtype[np.float64]]) -> None:
    first = found.dependence.isel(lag=0)
    values, error = first.autocorrelation.to_numpy(), first.autocorrelation_error.to_numpy()
    fg.line(axes, v, values, error, color=colors()[5], label=r"lag 1 of $\varepsilon$")
    swaps = [("all impacts", 2, "-", found.dependence)]
    swaps += [(label, color, style, found.parts[part][1]) for part, label, color, style in _PARTS]
    for label, color, style, data in swaps:
        speed = data["velocity"].to_numpy()
        values, error = data.alternation.to_numpy(), data.alternation_error.to_numpy()
        seen = (speed < 0.4) | (label != "returned")  # few return to higher speeds
        fg.line(axes, speed[seen], values[seen], error[seen], color=colors()[color], linestyle=style)
    for level in (0.0, 0.5):
        axes.axhline(level, color="0.4", linewidth=0.7, linestyle=":")
    axes.set_ylim(-0.85, 1.15)
    axes.set_ylabel("correlation; alternation")
    axes.legend(loc="lower right")


def _density(axes: Axes, found: Measured, speed: float) -> None:
    x = found.samples[speed]
    low, high = np.quantile(x, [0.0005, 0.9995])
    edges = np.linspace(low, high, 61)
    count, scale = np.histogram(x, edges)[0], 1.0 / (x.size * (edges[1] - edges[0]))
    error = scale * np.sqrt(count)
    fg.histogram(axes, edges, scale * count, error, fmt="o", color=ink(0.65), markersize=1.6)
    points = np.unique(np.append(np.linspace(low, high, 400), NORMAL))
    one = found.boots[speed]["asymmetric Laplace"]
    axes.fill_between(points, *one.band(points), color=colors()[1], alpha=0.4, linewidth=0)
    for name, color, style in (
        ("asymmetric Laplace", colors()[1], "-"),
        ("asymmetric power", colors()[0], "--"),
        ("cusp mixture", colors()[2], ":"),
    ):
        axes.plot(points, found.boots[speed][name].fit.pdf(points), color=color, linestyle=style, label=name)
    top = scale * float(count.max())
    axes.set_yscale("log")
    axes.set_ylim(2e-4 * top, 30 * top)
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel(rf"$\varepsilon$ at $v={speed:g}$ m/s")
    axes.set_ylabel(r"$p(\varepsilon\,|\,v)$")
    axes.legend(loc="upper right", fontsize=7)


def caption(found: Measured) -> str:
    """Caption of the figure."""
    return " ".join(
        [
            "The exponential flanks of p(ε | v). (a) Decay lengths a above and b below the cusp at ε_n, by",
            "maximum likelihood, with bands of 95 % confidence over redrawn particles; dashed: the lines of",
            f"(b). (b) The same against x, with the speed v₀ = {RELEASE_SPEED:.4f} m/s of the first impact;",
            f"lines: power laws fitted from {GROWTH[0]:g} to {GROWTH[1]:g} m/s. (c), (f) Densities at two",
            "speeds; points: histogram; band: 95 % confidence of the asymmetric Laplace fit. (d)",
            "Kolmogorov–Smirnov distance between impacts and fit; dotted: 0.03. Grey but in (c), (f): all",
            f"impacts exceed it, below {found.end:.3f} m/s; near v₀ the first impacts show. Returned: an",
            f"earlier impact of the particle was slower than {RETURNED:g}v; on the way down: none was, and",
            f"0.03 is exceeded below {found.end_down:.3f} m/s. (e) Rank autocorrelation of successive ε, of",
            "all impacts, and share of impacts after which the other sphere touches (alternation; lines as",
            "in (d)); bands: ± one standard error over particles; dotted: independent impacts.",
            f"The paper's law with ε_n = {NORMAL:g}; L/R = {ELONGATION:g}, R = {1e3 * RADIUS:g} mm,",
            f"centre of mass released at {1e3 * HEIGHT:g} mm, θ uniform in [0, π), g = {GRAVITY:g} m/s²;",
            f"{found.particles} particles, {found.impacts / 1e6:.2f} million impacts;",
            f"in (c) and (f) fits to {found.judged} particles; restitution {rs.__version__}.",
        ]
    )


def main(out: Path, particles: int = 4000) -> None:
    """Measure, draw and write."""
    found = measure(particles)
    out.mkdir(parents=True, exist_ok=True)
    text = caption(found)
    for style in SITE:
        figure = draw(found, style=style)
        fg.save(figure, out / f"fits{style[4:]}.png", "The exponential flanks of p(ε | v)", text)
    (out / "fits.txt").write_text(text + "\n", encoding="utf-8")
    (out / "fits.md").write_text(tables(found), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), *(int(x) for x in sys.argv[2:]))
