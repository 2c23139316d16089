"""Calibration of posteriors: synthetic experiments whose truth is drawn from the prior.

``python -m benchmarks.calibration OUT [EXPERIMENTS]`` writes ``calibration.png``, ``calibration.md`` and
``calibration.csv`` into the folder OUT; 120 experiments take some five minutes on one core. If the posterior
is right, the rank of the truth among its draws is uniform, and an interval of 90 % covers it in 90 %
(Talts et al., arXiv:1804.06788). ``python -m benchmarks.calibration friction [EXPERIMENTS]`` prints a table
over the friction of the true ball, which the posterior does not know.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.figure import Figure
from scipy import stats
from tqdm import tqdm

import restitution as rs
from restitution import figures as fg
from restitution.figures.style import SITE, Style, colors, ink

Array = npt.NDArray[np.float64]

DIAMETER, DROP, IMPACTS, ERROR = 6e-3, 0.1, 17, 2e-5
NORMAL, ELONGATION, SCATTER = (0.85, 0.97), (2e-3, 0.2), (1e-4, 0.02)
"""Of these the truth is drawn: uniform, and uniform in the logarithm."""
NAMES = ("normal", "elongation", "scatter")
LAWS: dict[str, Callable[..., rs.laws.Law]] = {
    "Coulomb, $\\mu = 0$": rs.Frictionless,
    **{f"Coulomb, $\\mu = {mu:g}$": partial(rs.Coulomb, friction=mu) for mu in (0.02, 0.2, 1.0)},
    "the paper's, $\\varepsilon_t = 1$": partial(rs.TangentialRestitution, tangential=1.0),
}
"""Of true balls, by what the table calls them; the normal coefficient is left open."""


@dataclass(frozen=True)
class Calibration:
    """Ranks of the truth among the draws, over their number; one row for each experiment.

    Attributes
    ----------
    truth, rank : ndarray, shape (experiments, 3)
        Of ε_n, L/R and the scatter of ε_n.
    told : ndarray of bool, shape (experiments,)
        Whether the verdict was that the surface is not that of a sphere.
    limit : ndarray, shape (experiments,)
        The upper limit of L/R.
    """

    truth: Array
    rank: Array
    told: npt.NDArray[np.bool_]
    limit: Array


def experiment(
    seed: int, kind: Callable[..., rs.laws.Law] | None = None
) -> tuple[tuple[float, float, float], xr.DataTree]:
    """Drop a ball of the prior, time it, and infer what it was: ε_n, L/R and scatter, and the posterior.

    Without a kind of law contacts are known to be without friction; with one the posterior does not know it.
    """
    rng = np.random.default_rng(seed)
    while True:
        normal = rng.uniform(*NORMAL)
        elongation = float(np.exp(rng.uniform(*np.log(ELONGATION))))
        scatter = float(np.exp(rng.uniform(*np.log(SCATTER))))
        run = rs.simulate(
            rs.from_roundness(DIAMETER, 0.25 * elongation * DIAMETER, form="dumbbell"),
            (kind or rs.Frictionless)(normal=rs.Scattered(normal=normal, deviation=scatter)),
            particles=1,
            impacts=IMPACTS,
            release_height=DROP + DIAMETER / 2.0,
            seed=int(rng.integers(2**40)),
        )
        times = run.time.values[0] + rng.normal(0.0, ERROR, IMPACTS)
        flights = np.diff(times)
        # An impact soon after another would have been heard as one with it.
        if np.all(flights > 0.0) and np.all(flights[1:] > 0.1 * flights[:-1]):
            break
    exact: dict[str, Any] = {"gravity_uncertainty": 0.0, "clock_uncertainty": 0.0}
    data = rs.flight.restitution(times, ERROR, drop_height=DROP, **exact)
    found = rs.posterior(
        data,
        rs.Frictionless(normal=normal) if kind is None else None,
        diameter=DIAMETER,
        elongation=ELONGATION,
        scatter=SCATTER,
        particles=200,
        draws=640,
        seed=seed,
    )
    return (normal, elongation, scatter), found


def calibrate(
    experiments: int, first: int = 1, kind: Callable[..., rs.laws.Law] | None = None
) -> Calibration:
    """Make experiments with the seeds from `first`."""
    truths, ranks, told, limits = [], [], [], []
    for seed in tqdm(range(first, first + experiments), disable=not sys.stderr.isatty()):
        truth, found = experiment(seed, kind)
        truths.append(truth)
        drawn = [found["posterior"].to_dataset()[name].values.ravel() for name in NAMES]
        ranks.append([float(np.mean(one < true)) for one, true in zip(drawn, truth, strict=True)])
        told.append(found.attrs["explained_by"] in ("shape", "roughness", "surface", "both"))
        limits.append(float(found.attrs["elongation_upper_limit"]))
    return Calibration(np.array(truths), np.array(ranks), np.array(told), np.array(limits))


_COLUMNS = "normal,elongation,scatter,rank_normal,rank_elongation,rank_scatter,told,limit"


def written(found: Calibration) -> str:
    """Write a line for each experiment, in the order of their seeds."""
    rows = np.column_stack([found.truth, found.rank, found.told, found.limit])
    lines = [",".join(f"{value:.6g}" for value in row) for row in rows]
    return "\n".join([_COLUMNS, *lines]) + "\n"


def read(path: Path) -> Calibration:
    """Read what was written."""
    rows = np.loadtxt(path, delimiter=",", skiprows=1)
    return Calibration(rows[:, :3], rows[:, 3:6], rows[:, 6].astype(np.bool_), rows[:, 7])


def covered(rank: Array, share: float) -> float:
    """Share of experiments whose truth is inside the central interval."""
    return float(np.mean(np.abs(rank - 0.5) < 0.5 * share))


def table(found: Calibration) -> str:
    """Write how often intervals cover, and whether ranks are uniform."""
    lines = [
        "| parameter | 50 % covers | 90 % covers | 95 % covers | p, ranks uniform |",
        "|---|---|---|---|---|",
    ]
    for name, rank in zip(("ε_n", "L/R", "scatter of ε_n"), found.rank.T, strict=True):
        shares = [f"{100 * covered(rank, share):.1f} %" for share in (0.5, 0.9, 0.95)]
        p = stats.kstest(rank, "uniform").pvalue
        lines.append(f"| {name} | {' | '.join(shares)} | {p:.2g} |")
    return "\n".join(lines) + "\n"


def sentence(found: Calibration) -> str:
    """Say what the verdicts were worth."""
    small = found.truth[:, 1] < 0.008
    below = found.truth[:, 1] < found.limit
    return (
        f"{len(found.rank)} experiments. A surface that is not that of a sphere was found in "
        f"{100 * found.told.mean():.0f} % of all, in {100 * found.told[small].mean():.0f} % where "
        f"$L/R < 0.008$, and in {100 * found.told[~small].mean():.0f} % above. Where none was found, $L/R$ "
        f"was below the upper limit in {100 * below[~found.told].mean():.0f} %.\n"
    )


@fg.styled
def draw(found: Calibration, *, style: Style | None = None) -> Figure:
    """Draw histograms of the ranks with the band of 95 % for uniform ones."""
    figure, [row] = fg.panels(fg.PAGE, 2.4, 1, 3)
    n, bins = len(found.rank), 10
    low, high = stats.binom(n, 1.0 / bins).ppf([0.025, 0.975])
    for axes, rank, name in zip(row, found.rank.T, (r"$\varepsilon_n$", "$L/R$", "scatter"), strict=True):
        axes.axhspan(low, high, color=ink(0.15))
        axes.hist(rank, bins=bins, range=(0.0, 1.0), color=colors()[0], histtype="step")
        axes.set_xlabel(f"rank of the true {name}")
        axes.set_ylabel("experiments")
        axes.set_xlim(0.0, 1.0)
    return figure


def frictions(experiments: int) -> None:
    """Print how often intervals of 90 % and limits of L/R hold, and how often a surface is found wrongly."""
    print(
        "| law of the ball | $\\varepsilon_n$ held | L/R held | below its limit | a surface, if L/R < 0.008 |"
    )
    print("|---|---|---|---|---|")
    for name, kind in LAWS.items():
        found = calibrate(experiments, kind=kind)
        small = found.truth[:, 1] < 0.008
        shares = [covered(found.rank[:, 0], 0.9), covered(found.rank[:, 1], 0.9)]
        shares += [float(np.mean(found.truth[:, 1] < found.limit))]
        cells = " | ".join(f"{100 * share:.0f} %" for share in shares)
        print(f"| {name} | {cells} | {found.told[small].sum()} of {small.sum()} |", flush=True)


def main(out: Path, experiments: int) -> None:
    """Write figure and table."""
    found = calibrate(experiments)
    out.mkdir(parents=True, exist_ok=True)
    text = "Ranks of the truth among draws of the posterior"
    for style in SITE:
        fg.save(draw(found, style=style), out / f"calibration{style[4:]}.png", "Calibration", text)
    (out / "calibration.md").write_text(f"{table(found)}\n{sentence(found)}", encoding="utf-8")
    (out / "calibration.csv").write_text(written(found), encoding="utf-8")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit("usage: python -m benchmarks.calibration OUT [EXPERIMENTS]")
    number = int(sys.argv[2]) if len(sys.argv) == 3 else 120
    if sys.argv[1] == "friction":
        frictions(number)
    else:
        main(Path(sys.argv[1]), number)
